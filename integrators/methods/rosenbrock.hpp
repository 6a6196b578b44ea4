#pragma once
/// Rosenbrock methods: implicit Runge-Kutta methods that solve linear systems only.

#include "integrators/methods/jacobian.hpp"
#include "integrators/step_control.hpp"

#include <vector>

namespace noether {

/// A Rosenbrock method in the form without products by J:
///
///     (I/(h g) - J) u_i = f(t + c_i h, y + sum_j a_ij u_j) + sum_j (C_ij/h) u_j + h d_i df/dt,   y1 = y + sum b_i u_i
///
/// The last u estimates the error; rows of `dense` give the polynomial of a step.
struct RosenbrockTable {
  Quad g;
  std::vector<std::vector<Quad>> a, c;
  std::vector<Quad> b, nodes, d;
  std::vector<std::vector<Quad>> dense;
  int order = 0, embedded_order = 0;
};

namespace tableaus {
/// @source HairerWanner1996
const RosenbrockTable& rodas_4();
/// @source Steinebach2023
const RosenbrockTable& rodas_5p();
}  // namespace tableaus

/// Rodas4 and Rodas5P, with steps of their own choice, or fixed.
///
/// Both are L-stable and stiffly accurate. J and df/dt are found once a step; a rejected trial keeps them.
/// @cost one Jacobian, one df/dt, and for each trial one LU and as many solutions as stages, with one evaluation each
/// @source HairerWanner1996, Steinebach2023
template <class Real> class Rosenbrock final : public Method<Real> {
 public:
  Rosenbrock(const MethodInfo& info, const MethodOptions& options, const RosenbrockTable& table);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Rosenbrock>(*this); }
  MethodClaims claims() const override { return {.name = name_, .order = order_, .adaptive = adaptive_}; }
  void bind(const VectorField<Real>& f) override;
  double next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  bool dense() const override { return true; }
  void interpolate(VectorField<Real>& f, const Real& theta, Vector<Real>& y) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& saved, const std::string& prefix) const override { control_.save(saved, prefix + "control/"); }
  void load(const SavedState& saved, const std::string& prefix) override { control_.load(saved, prefix + "control/"); }

 private:
  std::optional<Failure> trial(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);

  std::string_view name_;
  int order_;
  bool adaptive_;
  std::optional<JacobianForm> form_;
  Tolerance tolerance_;
  double first_;
  Real g_;
  std::vector<std::vector<Real>> a_, c_, dense_;
  std::vector<Real> b_, nodes_, d_;
  StepController control_;
  Jacobian<Real> jacobian_;
  std::vector<Vector<Real>> u_;
  Vector<Real> f0_, slope_, stage_, rate_;  ///< f and df/dt at the beginning; work
  Vector<Real> y0_, y1_;                    ///< begin and end of the last step
};

extern template class Rosenbrock<double>;
extern template class Rosenbrock<Quad>;

/// Rodas5P with fixed steps, to start methods that need a past.
template <class Real> Rosenbrock<Real> starting_rosenbrock(std::optional<JacobianForm> form);

}  // namespace noether
