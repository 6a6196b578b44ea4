#pragma once
/// Steps over forces that contain second derivatives, as Weber's does.

#include "integrators/method.hpp"
#include "integrators/methods/history.hpp"
#include "integrators/variational/lagrangian_field.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// A drift for half a step, a kick, a drift for another half, over m q'' = F(q, q', w), where F contains second
/// derivatives w of functions of q, such as r'' in Weber's force.
///
///     q = q0 + h v0/2,   v1 = v0 + h a(q, (v0 + v1)/2, w),   q1 = q + h v1/2
///
/// w is that of q'' itself (`weber_implicit`), which is linear: L_vv(q) a = f - L_vq v - L_vt; or that which the two
/// steps before extrapolate to the middle of this one (`weber_extrapolated`), whose first two steps are of the other
/// kind. Forces along pairs keep momentum and angular momentum to rounding, either way. Neither is symplectic;
/// the first is symmetric, so that the energy swings without drift, the second is not. Over particles under forces both
/// are the drift-kick-drift of Verlet, and symplectic as it is; `claims` are those of the field once it is bound.
/// @cost four to eight evaluations for the velocity in the force; over a Lagrangian two to three Jacobians and LU of n
///       rows
/// @source Assis1994
template <class Real> class WeberStep final : public Method<Real> {
 public:
  explicit WeberStep(const MethodInfo& info);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<WeberStep>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return remembers() ? Memory::history : Memory::none; }
  /// What r'' was stays.
  void moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/) override {}
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  bool remembers() const { return extrapolates_ && over_lagrangian_; }
  std::optional<Failure> find_start(VectorField<Real>& f, const Real& t, const Vector<Real>& y);
  std::optional<Failure> kick(VectorField<Real>& f, const Real& t, double h);
  std::optional<Failure> accelerate(VectorField<Real>& f, const Real& t, bool renew);
  std::optional<Failure> finish(VectorField<Real>& f, const Real& t, Vector<Real>& y);

  std::string_view name_;
  bool extrapolates_, over_lagrangian_ = false, velocity_dependent_ = true;
  Index n_ = 0;                       ///< coordinates
  Vector<Real> q_, v0_, mean_, v1_;   ///< in the middle; velocities
  Vector<Real> a_, before_, update_;  ///< work of the kick
  Vector<Real> state_, p_, w_;        ///< (q, v) in the middle; at the end; of this step
  bool given_ = false;                ///< w is, for this step
  History<Real> rates_;               ///< w of the steps before, in their middles
  double h_ = 0;                      ///< of these steps [time]
  LagrangianTerms<Real> terms_;       ///< at the end
};

extern template class WeberStep<double>;
extern template class WeberStep<Quad>;

}  // namespace noether
