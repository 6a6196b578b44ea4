#pragma once
/// Explicit Runge-Kutta methods, with fixed steps or with embedded error estimates.

#include "integrators/methods/tableau.hpp"
#include "integrators/step_control.hpp"

namespace noether {

/// Any explicit tableau.
///
/// A tableau whose last stage is the first of the next step (FSAL) saves that evaluation. Pairs control their steps by
/// proportional and integral parts.
/// @cost the stages of the tableau, one less with FSAL; a rejected trial keeps its first stage
/// @source HairerNoersettWanner1993
template <class Real> class RungeKutta : public Method<Real> {
 public:
  RungeKutta(const MethodInfo& info, const MethodOptions& options, const Tableau& table);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<RungeKutta>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  double next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void moved(VectorField<Real>& /*f*/, const Real& /*t*/, const Vector<Real>& /*y*/) override { have_first_ = false; }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 protected:
  /// Norm of the error of the trial step in `y1_`.
  virtual double error(const ParticleScales& scales, double h, const Vector<Real>& y);
  /// out = y + h sum w_j k_j over the first `w.size()` stages.
  void combine(const std::vector<Real>& w, double h, const Vector<Real>& y, Vector<Real>& out) const;

  std::string_view name_;
  int order_;
  bool adaptive_, first_same_as_last_;
  Tolerance tolerance_;
  double first_;
  std::vector<std::vector<Real>> a_;
  std::vector<Real> b_, c_, e_;
  StepController control_;
  std::vector<Vector<Real>> k_;
  Vector<Real> y0_, y1_, e1_;  ///< begin and end of the last step; work
  Real t0_ = Real(0);
  double h_ = 0;
  bool have_first_ = false;  ///< k_[0] is f at the present point
};

/// Dormand and Prince's 5(4): FSAL, and dense output of order 4.
template <class Real> class DormandPrince5 final : public RungeKutta<Real> {
 public:
  DormandPrince5(const MethodInfo& info, const MethodOptions& options);
  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<DormandPrince5>(*this); }
  bool dense() const override { return true; }
  void interpolate(VectorField<Real>& f, const Real& theta, Vector<Real>& y) override;

 private:
  std::vector<Real> d_;
};

/// Dormand and Prince's 8(5,3): two error estimates, and dense output of order 7 for three more evaluations.
///
///     err = |e5|^2 / sqrt(|e5|^2 + 0.01 |e3|^2)
template <class Real> class Dop853 final : public RungeKutta<Real> {
 public:
  Dop853(const MethodInfo& info, const MethodOptions& options);
  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Dop853>(*this); }
  bool dense() const override { return true; }
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  void interpolate(VectorField<Real>& f, const Real& theta, Vector<Real>& y) override;

 private:
  double error(const ParticleScales& scales, double h, const Vector<Real>& y) override;

  std::vector<Real> e3_;
  std::vector<std::vector<Real>> more_a_, d_;
  std::vector<Real> more_c_;
  std::vector<Vector<Real>> terms_;  ///< of the polynomial of the last step
  bool have_terms_ = false;
};

extern template class RungeKutta<double>;
extern template class RungeKutta<Quad>;
extern template class DormandPrince5<double>;
extern template class DormandPrince5<Quad>;
extern template class Dop853<double>;
extern template class Dop853<Quad>;

}  // namespace noether
