#pragma once
/// Diagonally implicit Runge-Kutta methods with fixed steps: backward Euler, the trapezoidal rule, SDIRK.

#include "integrators/method.hpp"
#include "integrators/methods/jacobian.hpp"
#include "integrators/methods/tableau.hpp"

namespace noether {

/// Any tableau that is lower triangular with one number g on its diagonal; the first stage may be explicit.
///
///     z_i = h g f(t + c_i h, y + h sum_{j<i} a_ij k_j + z_i),   k_i = z_i / (h g),   y1 = y + h sum b_i k_i
///
/// Each stage is solved by Newton's iteration to rounding, with I - h g J, J at the beginning of the step.
/// @cost one Jacobian, one factorization and two to five evaluations a stage, more where the matrix has to be renewed
/// @source HairerWanner1996
template <class Real> class DiagonallyImplicit final : public Method<Real> {
 public:
  /// What only a particular tableau has.
  struct Keeps {
    bool reversible = false;
  };
  DiagonallyImplicit(const MethodInfo& info, const MethodOptions& options, const Tableau& table, Keeps keeps);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<DiagonallyImplicit>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::optional<Failure> solve_stage(VectorField<Real>& f, const Real& t, std::size_t stage, double h);
  void combine(const std::vector<Real>& w, std::size_t count, double h, const Vector<Real>& y, Vector<Real>& out) const;

  std::string_view name_;
  int order_;
  Keeps keeps_;
  std::optional<JacobianForm> form_;
  std::vector<std::vector<Real>> a_;
  std::vector<Real> b_, c_;
  Real diagonal_;
  bool explicit_first_, ends_at_last_;  ///< a_11 = 0; b is the last row of a
  bool second_order_ = false;
  Jacobian<Real> jacobian_;
  std::vector<Vector<Real>> k_;
  Vector<Real> base_, z_, guess_, stage_, update_;
};

extern template class DiagonallyImplicit<double>;
extern template class DiagonallyImplicit<Quad>;

}  // namespace noether
