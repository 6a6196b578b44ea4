#pragma once
/// Invariants that line integral methods keep beside the energy.

#include "engine/description.hpp"
#include "integrators/methods/line_table.hpp"
#include "integrators/named_invariant.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// What a line integral method keeps: by default the energy alone.
struct LineInvariants {
  std::vector<std::string> invariants = {};  ///< energy, momentum, angular_momentum, and what a system names
  std::vector<NamedInvariant> own = {};      ///< and a program's own

  static constexpr auto describe() {
    return part<LineInvariants>(
        "line_integral", "what a line integral method keeps",
        field<&LineInvariants::invariants>("invariants", "1",
                                           "what is kept: energy, momentum, angular_momentum, and what a system "
                                           "names; default: the energy"));
  }
  /// @throws Error  for a name that is given twice
  void check() const;
  bool has(std::string_view name) const;
};

/// The coefficients of a step, changed so that invariants I are kept:
///
///     g_j <- g_j - sum_a alpha_a W phi_aj,   phi_aj = (2 j + 1) int P_j grad I_a,   sum_j phi_aj g_j / (2 j + 1) = 0
///
/// W is 1, of particles 1/m. The change is of order h^(2 S), so that the order of the method stays.
/// @cost an evaluation a step, and in a sweep a gradient of each invariant at each node
/// @source BrugnanoSun2014
template <class Real> class KeptInvariants {
 public:
  explicit KeptInvariants(const LineInvariants& wanted);

  /// Whether there is anything to do beyond what the method keeps as it is.
  bool any() const { return any_; }
  bool keeps(std::string_view name) const;
  /// @throws SchemeMismatch  for an invariant that the field does not have, or does not keep
  void bind(const VectorField<Real>& f, std::string_view method, int coefficients);

  /// At the beginning of a step: an invariant whose gradient there is a combination of those before it, as that of the
  /// energy of an orbit is of those of its angular momentum and Laplace's vector, is kept by them and left out.
  void start(VectorField<Real>& f, const Real& t, const Vector<Real>& y);
  /// At the beginning of a sweep.
  void begin();
  /// Takes gradients at eight nodes, of states and rates of all variables, shape (n, 8).
  void add(const typename LineTable<Real>::Eight& nodes, const Real* states, const Real* rates);
  /// Changes the coefficients, shape (n, 8).
  void correct(Real* g);

 private:
  enum class Kind : std::uint8_t { energy, momentum, angular_momentum, named };
  /// One number that is kept: of a vector the component along an axis, of `named_` one of them.
  struct Kept {
    Kind kind = Kind::energy;
    std::size_t index = 0;
  };

  void take_named(const VectorField<Real>& f, std::string_view method);
  void find_gradient(const Kept& one);
  void factorize_row(Index a);
  void solve();

  LineInvariants wanted_;
  bool any_;
  std::vector<Kept> kept_;
  std::vector<FieldInvariant<Real>> named_;  ///< of the field, and a program's own
  bool second_order_ = false;
  int coefficients_ = 1;
  Index particles_ = 0;
  Vector<Real> masses_, weights_;          ///< of each q; of each variable in what is changed
  std::vector<AlignedVector<Real>> phi_;   ///< of each invariant, shape (n, 8)
  Vector<Real> y_, f_, gradient_, alpha_;  ///< at one node; how much each invariant takes away
  Matrix<Real> gram_, gradients_;
  std::vector<bool> counts_;  ///< of each invariant: those before it do not determine it
};

extern template class KeptInvariants<double>;
extern template class KeptInvariants<Quad>;

}  // namespace noether
