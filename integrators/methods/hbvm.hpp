#pragma once
/// Line integral methods that keep the energy: Hamiltonian boundary value methods of any order to 16, and the average
/// vector field.

#include "integrators/methods/kept_invariants.hpp"
#include "integrators/methods/line_table.hpp"
#include "integrators/methods/newton.hpp"
#include "integrators/methods/rounding_change.hpp"
#include "integrators/methods/stage_system.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// HBVM(K, S) over y' = f = J grad H or q'' = a(q), by sweeps over its nodes.
///
///     u(c h) = y + h sum_j int_0^c P_j g_j,   g_j = (2 j + 1) sum_k b_k P_j(c_k) f(u(c_k h)),   y1 = u(h)
///
/// with j < S and k < K. What is solved for are the S coefficients g_j, whatever the number of nodes, and y1 has order
/// 2 S. The energy changes by h int u' grad H, which is 0 where the K nodes integrate it exactly: for a polynomial H of
/// degree nu if 2 K >= nu S. With K = S it is Gauss's method.
///
/// Where K is not given, it is 8, 16, 24, 32, 48 or 64: so many that what the last two coefficients of the rates that
/// K nodes know leave in the others is below rounding; a step that needs more goes on from where it stands. K of the
/// last step is state. A step for which 64 nodes are not enough, as past a kink of the force, is counted
/// (`Evaluations::unsettled`).
///
/// With other invariants than the energy (`LineInvariants`), coefficients are of all of y, q and v, and changed in
/// every sweep so that these are kept too.
///
/// Coefficients begin where those of the last step lead. Where sweeps do not converge, Newton's iteration finds them,
/// with a matrix of S n rows, that of the coefficients before they are changed. Sums are compensated.
/// @cost 4 to 10 sweeps of K evaluations, eight at once where the field has lanes; by Newton's iteration one Jacobian,
///       one factorization of S n rows and four to eight sweeps
/// @source BrugnanoIavernaroTrigiante2010, QuispelMcLaren2008
template <class Real> class Hbvm final : public Method<Real> {
 public:
  /// @param nodes  K; 0: as many as rounding asks for
  Hbvm(const MethodInfo& info, const MethodOptions& options, int nodes, int coefficients);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Hbvm>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/) override {
    std::fill(low_.begin(), low_.end(), Real(0));
  }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

  /// Rows of the matrix of Newton's iteration, S n; 0 where no step has asked for one.
  Index matrix_rows() const { return system_ ? system_->rows() : 0; }

 private:
  /// Where a step is: what sweeps work on.
  struct Place {
    VectorField<Real>& f;
    const Real& t;
    const Vector<Real>& y;
    double h;
  };

  void use_nodes(int nodes);
  void predict(const Place& at);
  bool solve(const Place& at, bool by_newton);
  bool sweep(const Place& at);
  bool iterate(const Place& at);
  void evaluate(const Place& at);
  std::array<Real, 2> take(const Place& at);
  const Real* rates_at(const Place& at, std::size_t eight);
  void form_states(const Place& at, std::size_t eight, Real* q);
  void add_update();
  UpdateSize size_of_update(const Place& at);
  void take_state(const Place& at, std::size_t eight, std::size_t lane, Vector<Real>& state);
  RatesOf rates_of() const {
    return second_order_ ? RatesOf::velocities : two_kinds_ ? RatesOf::two_kinds : RatesOf::one_kind;
  }
  int nodes_needed(int most) const;
  bool has_enough(int nodes) const;
  double coefficient_size(int m) const;
  double coefficient_size(int m, Index begin, Index end) const;
  void finish(Vector<Real>& y, double h);

  std::string_view name_;
  int coefficients_, fixed_nodes_;
  std::optional<JacobianForm> form_;
  const LineTable<Real>* table_ = nullptr;

  KeptInvariants<Real> kept_;
  bool second_order_ = false;
  bool halves_ = false;     ///< coefficients of both q and v
  bool two_kinds_ = false;  ///< the halves of what has coefficients are of two kinds
  Index n_ = 0;             ///< variables that have coefficients
  StageArithmetic<Real> sums_;
  AlignedVector<Real> g_, fresh_, part_;  ///< coefficients, shape (n, 8): at hand, after a sweep, of eight nodes
  AlignedVector<Real> rates_;             ///< of all nodes, shape (eights, n, 8)
  AlignedVector<Real> q_, v_;             ///< states of eight nodes, shape (n, 8)
  AlignedVector<Real> low_;               ///< rounding errors of y
  AlignedVector<Real> previous_;          ///< coefficients of the last step, also beyond S
  std::vector<const Real*> at_nodes_;     ///< where the rates of each eight are
  double h_ = 0;                          ///< of the last step; 0 for none
  StageMatrix<Real> ahead_{};
  double ahead_ratio_ = 0;
  bool swept_ = true;  ///< the last step was solved by sweeps

  std::optional<StageSystem<Real>> system_;  ///< once a step has asked for it
  Vector<Real> update_, state_, moved_, from_;
};

extern template class Hbvm<double>;
extern template class Hbvm<Quad>;

}  // namespace noether
