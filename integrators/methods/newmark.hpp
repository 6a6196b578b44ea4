#pragma once
/// Newmark's method for q'' = a(t, q, v).

#include "integrators/method.hpp"
#include "integrators/methods/jacobian.hpp"
#include "integrators/methods/newton.hpp"

namespace noether {

/// The two weights of Newmark's family.
struct NewmarkOptions {
  double beta = 0.25;  ///< of the new acceleration in the positions [1]
  double gamma = 0.5;  ///< and in the velocities [1]

  static constexpr auto describe() {
    return part<NewmarkOptions>(
        "newmark", "the weights of Newmark's method",
        field<&NewmarkOptions::beta>("beta", "1", "weight of the new acceleration in the positions, 0 or more"),
        field<&NewmarkOptions::gamma>("gamma", "1",
                                      "weight of the new acceleration in the velocities; above 0.5 it damps"));
  }
  void check() const;
};

/// Newmark's family with fixed steps.
///
///     q1 = q + h v + h^2 ((1/2 - beta) a + beta a1)
///     v1 = v + h ((1 - gamma) a + gamma a1),           a1 = a(t + h, q1, v1)
///
/// beta = 1/4 and gamma = 1/2 (the default) is the trapezoidal rule for q and v, unconditionally stable for linear
/// springs; beta = 0 and gamma = 1/2 is velocity Verlet. Order 2 where gamma = 1/2, else 1, with damping above 1/2.
/// a1 is found to rounding: of many particles by sweeps a1 <- a(q1, v1) where these shrink to a tenth, else by Newton's
/// iteration with I - h gamma da/dv - h^2 beta da/dq.
/// @cost sweeps: 5 to 16 evaluations; else one Jacobian, one LU of half the size of y, and three to seven evaluations
/// @source Newmark1959, SimoTarnowWong1992
template <class Real> class Newmark final : public Method<Real> {
 public:
  Newmark(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Newmark>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::optional<Failure> solve(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  bool sweep(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  UpdateSize take(const Vector<Real>& y, double h);
  void place(const Vector<Real>& y, double h);

  std::string_view name_;
  double beta_, gamma_;
  std::optional<JacobianForm> form_;
  bool explicit_ = false;  ///< a1 depends on nothing unknown
  Jacobian<Real> jacobian_;
  Vector<Real> a0_, a1_, y1_, update_;
};

extern template class Newmark<double>;
extern template class Newmark<Quad>;

}  // namespace noether
