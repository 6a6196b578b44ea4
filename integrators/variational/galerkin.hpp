#pragma once
/// Variational methods: the action of a step over polynomials, made stationary.

#include "integrators/methods/dense_factors.hpp"
#include "integrators/methods/jacobian.hpp"
#include "integrators/methods/newton.hpp"
#include "integrators/variational/galerkin_table.hpp"
#include "integrators/variational/lagrangian_field.hpp"

#include <optional>
#include <vector>

namespace noether {

/// Galerkin's variational methods over a Lagrangian, or over particles under forces.
///
///     L_d(q0, q1) = ext over Q of  h sum_i b_i L(t + c_i h, q(c_i), q'(c_i)/h),   q(c) = sum_k l_k(c) Q_k
///     p0 = -D1 L_d,   p1 = D2 L_d
///
/// with Q_0 = q0 and Q_s = q1. One node of Gauss gives L_d = h L((q0 + q1)/2, (q1 - q0)/h), the midpoint rule; two of
/// Lobatto the trapezoidal rule, over q'' = a(q) velocity Verlet. Forces f beside the Lagrangian enter as d'Alembert
/// has it, with their virtual work h sum_i b_i f_i . delta q(c_i). All equations together give p1 = p0 + h sum_i b_i
/// (dL/dq + f)_i, so that the momentum of a cyclic coordinate stays, bit for bit.
///
/// The points are found to rounding: over a Lagrangian by Newton's iteration with exact second derivatives, over forces
/// by sweeps with the matrix of the kinetic energy, and where these do not converge by Newton's iteration too. A root
/// that is not near its guess is followed from a step of no length; where it ends, D1 D2 L_d is singular, and the
/// failure names the place. Nothing is kept from step to step.
/// @cost over a Lagrangian r Jacobians, one LU of s n rows and three to six times r evaluations; over forces 3 to 8
///       sweeps of r evaluations
/// @source MarsdenWest2001, HairerLubichWanner2006
template <class Real> class Galerkin final : public Method<Real> {
 public:
  Galerkin(const MethodInfo& info, const GalerkinTable& table);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Galerkin>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  bool has_action() const override { return true; }
  Real action(VectorField<Real>& f, const Real& t, const Vector<Real>& y) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::optional<Failure> find_points(VectorField<Real>& f, const Real& t, double h);
  std::optional<Failure> solve(VectorField<Real>& f, const Real& t, double h, bool& near);
  void guess(double h);
  void stretch(double by);
  void form_states(double h);
  void evaluate(VectorField<Real>& f, const Real& t, double h);
  void form_residual(double h);
  bool renew_matrix(VectorField<Real>& f, const Real& t, double h);
  void find_tangent(VectorField<Real>& f, const Real& at, std::size_t node);
  void add_tangent(std::size_t node, double h);
  void form_update(double h);

  std::string_view name_;
  GalerkinTable wide_;
  int order_;
  std::size_t nodes_, degree_;
  std::vector<Real> c_, b_;                       ///< shape (r)
  std::vector<std::vector<Real>> value_, slope_;  ///< shape (r, s + 1)
  std::vector<std::vector<Real>> inverse_;        ///< shape (s, s)
  Index n_ = 0;                                   ///< coordinates
  bool second_order_ = false, velocity_dependent_ = false;
  bool by_sweeps_ = false;  ///< with the matrix of the kinetic energy
  double h_ = 0;            ///< of the points at hand [time]

  Vector<Real> q0_, p0_, v0_;
  std::vector<Vector<Real>> q_, v_;           ///< at the nodes
  std::vector<LagrangianTerms<Real>> terms_;  ///< there
  Vector<Real> points_, guess_, before_;      ///< Q_k - q0, k = 1 to s in a row; shape (s n)
  Vector<Real> residual_, update_;            ///< shape (s n)
  LagrangianTangent<Real> tangent_;
  Matrix<Real> matrix_;
  Vector<Real> ended_, q_end_, p_end_, v1_;  ///< where the last step ended, and its velocity
  Real ended_at_ = Real(0);
  DenseFactors<Real> factors_;
  std::optional<Jacobian<Real>> jacobian_;  ///< of forces, once a step has asked for it
  Vector<Real> state_;                      ///< (q, v) of one node
};

extern template class Galerkin<double>;
extern template class Galerkin<Quad>;

}  // namespace noether
