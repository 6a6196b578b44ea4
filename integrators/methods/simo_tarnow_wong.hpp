#pragma once
/// The method of Simo, Tarnow and Wong: energy, momentum and angular momentum of particles, all exact.

#include "forces/secant_tangent.hpp"
#include "integrators/methods/mean_force_step.hpp"

namespace noether {

/// The midpoint rule with secant forces in the place of those of the middle, pair by pair, for q'' = a(q), with fixed
/// steps.
///
///     q1 = q + h (v + v1) / 2,   v1 = v + h a(q, q1),   m a . (q1 - q) = U(q) - U(q1)
///
/// Every term of the energy gives secants of its own (`forces/secant.hpp`), which have neither a sum nor a torque where
/// its forces have none: energy, momentum and angular momentum are kept to rounding at any step, for which the map is
/// not symplectic. Symmetric, of order 2.
/// @cost as `ContinuedRoot`: an evaluation is one of the secants
/// @source SimoTarnowWong1992, LaBuddeGreenspan1976
template <class Real> class SimoTarnowWong final : public Method<Real> {
 public:
  SimoTarnowWong(const MethodInfo& info, const MethodOptions& options) : name_(info.name), form_(options.jacobian) {}

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<SimoTarnowWong>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::string_view name_;
  std::optional<JacobianForm> form_;
  MeanForceStep<Real> step_;
  SecantTangent<Real> tangent_;
};

extern template class SimoTarnowWong<double>;
extern template class SimoTarnowWong<Quad>;

}  // namespace noether
