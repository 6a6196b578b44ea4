#pragma once
/// Invariants that line integral methods keep beside the energy.

#include "engine/description.hpp"
#include "integrators/hamiltonian_system.hpp"
#include "integrators/methods/line_table.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// What a motion keeps, as its gradient: of y = (q, v) of particles, all x before all y before all z, or of y = (q, p).
struct NamedInvariant {
  std::string name;
  std::function<void(const Vector<double>& y, Vector<double>& gradient)> gradient;
  std::function<void(const Vector<Quad>& y, Vector<Quad>& gradient)> wide_gradient;
};

namespace detail {
/// A function of q and p in the place of a Hamiltonian, so that its slopes are found as those are.
template <class F> struct AsHamiltonian {
  F function;
  template <class Real> Real value(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& p) const {
    return function(q, p);
  }
};

template <class Real, class F> auto gradient_of(F function) {
  return [as = AsHamiltonian<F>{std::move(function)}, rates = CanonicalRates<AsHamiltonian<F>, Real>()](
             const Vector<Real>& y, Vector<Real>& gradient) mutable {
    const Index n = y.size() / 2;
    Vector<Real> canonical(y.size());
    rates.find(as, Real(0), y, canonical);
    gradient.head(n) = -canonical.tail(n);
    gradient.tail(n) = canonical.head(n);
  };
}
}  // namespace detail

/// A user's own: `invariant("laplace_x", f)` of a function `template <class Real> Real operator()(const Vector<Real>&
/// q, const Vector<Real>& v) const`, whose derivatives are found by dual numbers.
template <class F> NamedInvariant invariant(std::string name, F function) {
  return {std::move(name), detail::gradient_of<double>(function), detail::gradient_of<Quad>(function)};
}

/// What a line integral method keeps: by default the energy alone.
struct LineInvariants {
  std::optional<std::string> invariants = {};  ///< names, parted by commas: energy, momentum, angular_momentum
  std::vector<NamedInvariant> own = {};        ///< and a program's own

  static constexpr auto describe() {
    return part<LineInvariants>(
        "line_integral", "what a line integral method keeps",
        field<&LineInvariants::invariants>("invariants", "1",
                                           "what is kept: energy, momentum, angular_momentum, parted by commas; "
                                           "default: the energy"));
  }
  /// @throws Error  for a name that is not known
  void check() const;
  std::vector<std::string> names() const;
};

/// The coefficients of a step, changed so that invariants I are kept:
///
///     g_j <- g_j - sum_a alpha_a W phi_aj,   phi_aj = (2 j + 1) int P_j grad I_a,   sum_j phi_aj g_j / (2 j + 1) = 0
///
/// W is 1, of particles 1/m. The change is of order h^(2 S), so that the order of the method stays.
/// @cost a gradient of each invariant at each node, in a sweep
/// @source BrugnanoSun2014
template <class Real> class KeptInvariants {
 public:
  explicit KeptInvariants(const LineInvariants& wanted);

  /// Whether there is anything to do beyond what the method keeps as it is.
  bool any() const { return any_; }
  bool keeps(std::string_view name) const;
  /// @throws SchemeMismatch  for an invariant that the field does not have
  void bind(const VectorField<Real>& f, std::string_view method, int coefficients);

  void begin();
  /// Takes gradients at eight nodes, of states and rates of all variables, shape (n, 8).
  void add(const typename LineTable<Real>::Eight& nodes, const Real* states, const Real* rates);
  /// Changes the coefficients, shape (n, 8).
  void correct(Real* g);

 private:
  enum class Kind : std::uint8_t { energy, momentum, angular_momentum, own };
  /// One number that is kept: of a vector the component along an axis, of a program's own one of them.
  struct Kept {
    Kind kind = Kind::energy;
    std::size_t index = 0;
  };

  void find_gradient(const Kept& one);
  void solve();

  LineInvariants wanted_;
  bool any_;
  std::vector<Kept> kept_;
  bool second_order_ = false;
  int coefficients_ = 1;
  Index particles_ = 0;
  Vector<Real> masses_, weights_;          ///< of each q; of each variable in what is changed
  std::vector<AlignedVector<Real>> phi_;   ///< of each invariant, shape (n, 8)
  Vector<Real> y_, f_, gradient_, alpha_;  ///< at one node; how much each invariant takes away
  Matrix<Real> gram_;
};

extern template class KeptInvariants<double>;
extern template class KeptInvariants<Quad>;

}  // namespace noether
