#pragma once
/// Implicit collocation methods, solved by iteration to rounding: Gauss of any order to 16, and Gauss-Radau of
/// order 15.

#include "integrators/methods/collocation_table.hpp"
#include "integrators/methods/moving_origin.hpp"
#include "integrators/methods/newton.hpp"
#include "integrators/methods/rounding_change.hpp"
#include "integrators/methods/stage_arithmetic.hpp"
#include "integrators/methods/stage_system.hpp"
#include "integrators/step_control.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace noether {

/// Coefficients of a collocation method in the working type, its stages side by side in eight lanes; lanes beyond the
/// stages repeat the first, and nothing is taken from them.
///
/// Each list comes with what rounding has taken from its sum: with steps of one length an error of 1e-17 in it would
/// be a drift.
template <class Real> struct StageTable {
  int stages = 0;
  StageLanes<Real> c{}, c_low{}, last{}, barycentric{};
  StageLanes<Real> resting{};  ///< x of a x = 1: rates of -x v / h leave all stages at rest; 0 for a singular a
  StageMatrix<Real> a{}, twice{};
  std::array<StageLanes<Real>, 4> ends{};  ///< b, b a, each followed by what rounding has taken

  explicit StageTable(const CollocationTable& table);
};

/// Collocation over y' = f or q'' = a(t, q, v), by fixed-point sweeps over all stages at once.
///
///     F_i = f(t + c_i h, y + h sum a_ij F_j),   y1 = y + h sum b_j F_j
///     q'' = a:  Q_i = q + c_i h v + h^2 sum (a a)_ij F_j,   q1 = q + h v + h^2 sum (b a)_j F_j
///
/// The stages begin where the polynomial of the last step leads, and are swept until they stand still. Sums are
/// compensated. Adaptive steps follow the last Legendre coefficient of F: they keep its size, relative to F, at one
/// value, each particle for itself; a step whose sweeps do not converge is halved. Of two stages it is the change of F
/// itself, as large as F where F vanishes, however short the step: they have steps of one length only.
///
/// Steps of one length cannot be: where sweeps do not converge, as on oscillations with h omega above 2 or so, the
/// rates are found by Newton's iteration over all stages at once, to rounding too. It begins anew in every step, with
/// stages and J at the beginning of the step, and nothing of it is state; the first such step allocates.
/// @cost 3 to 8 sweeps of s evaluations, in lanes where the field can; by Newton's iteration 3 sweeps in vain, one
///       Jacobian, one factorization (`StageSystem`) and three to six times s evaluations, more where the matrix has
///       to be renewed, with a Jacobian for each stage
/// @source HairerLubichWanner2006, ReinSpiegel2015
template <class Real> class Collocation final : public Method<Real> {
 public:
  Collocation(const MethodInfo& info, const MethodOptions& options, const CollocationTable& table, bool symplectic);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Collocation>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  double next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  bool has_action() const override { return symplectic_ && !adaptive_ && second_order_; }
  Real action(VectorField<Real>& f, const Real& t, const Vector<Real>& y) override;
  Memory memory() const override { return Memory::none; }
  void moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/) override {
    std::fill(low_.begin(), low_.end(), Real(0));
  }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

  /// Goes on where the same method, computed in another way, stands: rounding errors of y, shape (size), and rates of
  /// the step of `h` that led there, shape (n, 8); of 0 if nothing is to be taken from them.
  void go_on_from(const AlignedVector<Real>& low, const AlignedVector<Real>& rates, double h);
  /// Where the other way goes on from here: rounding errors of y, and rates of the last step.
  const AlignedVector<Real>& low() const { return low_; }
  const AlignedVector<Real>& rates() const { return previous_; }

 private:
  enum class Sweeps : std::uint8_t { converged, diverged };

  void predict(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  void extrapolate(double h);
  Sweeps sweep(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  bool iterate(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  void add_update(const Vector<Real>& y, double h);
  void take_stage(std::size_t k);
  UpdateSize size_of_update(const Vector<Real>& y, double h);
  bool is_straight() const;
  int unseen_sweeps() const { return std::max(0, swept_ - 3); }
  void form_positions(const Real* rates, const StageMatrix<Real>& twice, const Vector<Real>& y, double h, Real* q);
  void form_velocities(const Real* rates, const Vector<Real>& y, double h);
  void form_states(const Real* rates, const Vector<Real>& y, double h, Real* q);
  std::uint8_t stages_to_evaluate(int round, const Real* q);
  void finish(Vector<Real>& y, double h);
  double roughness(const Vector<Real>& y, double h);
  void follow(VectorField<Real>& f, Vector<Real>& y);
  RatesOf rates_of() const { return second_order_ ? RatesOf::velocities : RatesOf::one_kind; }

  std::string_view name_;
  StageTable<Real> table_;
  int order_;
  bool adaptive_, symplectic_;
  double rtol_, first_, target_, rejecting_, settled_, foreseen_;
  std::optional<JacobianForm> form_;
  bool second_order_ = false, with_velocities_ = false, in_turn_ = false;
  Index n_ = 0, particles_ = 0;  ///< variables that stages hold; particles among them

  StageArithmetic<Real> sums_;
  AlignedVector<Real> rates_, previous_, trial_, q_, v_;  ///< shape (n, 8)
  AlignedVector<Real> known_q_, known_v_;                 ///< where stages were evaluated, of fields in turn
  AlignedVector<Real> low_;                               ///< rounding errors of y
  Vector<Real> stage_;                                    ///< one of the stages
  AlignedVector<Real> last_, largest_;                    ///< last Legendre coefficients, and sizes, of the rates
  StageMatrix<Real> weights_{};                           ///< of the extrapolation over a step h after one of h_old
  StageMatrix<Real> twice_ahead_{};                       ///< and from there to positions
  bool has_twice_ahead_ = false;                          ///< of the weights at hand
  double weights_h_ = 0, weights_h_old_ = 0;
  double next_ = 0, h_ = 0;  ///< to be tried; of `previous_`, 0 for none
  MovingOrigin origin_;
  bool any_origin_ = false;  ///< whether the field allows that
  double longest_ = 0;       ///< of all steps so far, or the next one
  int swept_ = 0;            ///< sweeps of the last step; 0: it was made by Newton's iteration, or there is none

  std::optional<StageSystem<Real>> system_;  ///< once a step has asked for it
  Vector<Real> update_, moved_, from_;       ///< of rates; of positions or velocities of a stage, and where from
};

extern template class Collocation<double>;
extern template class Collocation<Quad>;

}  // namespace noether
