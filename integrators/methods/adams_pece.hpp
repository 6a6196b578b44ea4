#pragma once
/// Adams methods of variable step and variable order.

#include "integrators/methods/history.hpp"
#include "integrators/step_control.hpp"

#include <array>

namespace noether {

/// Predict, evaluate, correct, evaluate: orders 1 to 12, the corrector one order higher, on any grid of times.
///
/// The rates of the past stand as modified divided differences; with s = (t - t_n) / h in the step from t_n,
///
///     f(t) = sum_(j < k) B_j(s) d*_j + B_k(s) d_k,
///     B_j(s) = prod_(i < j) (s h + t_n - t_(n-i)) / (h + t_n - t_(n-i)),
///
/// where d_k is that difference with the predicted rate at the end. The integral of this polynomial is the corrected
/// step, and its dense output: the same at both ends of every step as the run itself. Step and order follow Shampine
/// and Gordon: the order moves by one at most, to where the estimated error is least; the step doubles, stays, or
/// shrinks.
/// @cost two evaluations a step, one for a rejected trial
/// @source HairerNoersettWanner1993, III.5; ShampineGordon1975
template <class Real> class AdamsPece final : public Method<Real> {
 public:
  AdamsPece(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<AdamsPece>(*this); }
  MethodClaims claims() const override { return {.name = name_, .order = most_order, .adaptive = true}; }
  void bind(const VectorField<Real>& f) override;
  double next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  bool dense() const override { return true; }
  void interpolate(VectorField<Real>& f, const Real& theta, Vector<Real>& y) override;
  Memory memory() const override { return Memory::history; }
  void moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) override;
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

  static constexpr int most_order = 12;
  /// Order of the predictor of the next step.
  int order() const { return static_cast<int>(k_); }

 private:
  static constexpr std::size_t most = most_order + 2;  ///< room for differences

  /// Norms of the errors that a trial would have at orders k, k - 1 and k - 2 if all steps had its length.
  struct Errors {
    double here = 0, below = 0, far_below = 0;
  };

  void prepare(double h);
  void differences(std::size_t last);
  void predict(const Vector<Real>& y, double h);
  Errors estimate(double h) const;
  bool lower_is_better(const Errors& errors) const;
  void reject(double h, const Errors& errors);
  void accept(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h, const Errors& errors);
  void choose(double h, Errors errors);
  double norm(const Vector<Real>& e) const { return tolerance_.norm(*scales_, e, y0_, y1_); }
  Real integral(std::size_t j, const Real& s) const;

  std::string_view name_;
  Tolerance tolerance_;
  double first_;
  std::array<double, most> moulton_;  ///< absolute coefficients of Adams-Moulton: errors with steps of one length

  // What is kept from step to step.
  std::size_t k_ = 1;         ///< order of the predictor
  std::size_t known_ = 0;     ///< differences 0 to known_ - 1 are there
  std::size_t constant_ = 0;  ///< steps of one length that led here
  std::vector<double> past_;  ///< lengths of the last steps, the newest first
  std::vector<Vector<Real>> d_;
  double next_ = 0;
  bool rising_ = true;  ///< at the start order and step rise together

  // The trial, which is the last step once it has passed.
  std::array<std::array<Real, most>, most> basis_;  ///< B_j by powers of s
  std::array<Real, most> g_, since_;                ///< integrals of B_j; h + t_n - t_(n-i)
  std::vector<Vector<Real>> star_, trial_;          ///< d*, and the differences at the new point
  const ParticleScales* scales_ = nullptr;          ///< of the field, at y0
  Vector<Real> y0_, y1_, last_;                     ///< both ends, and d_k of the step
  double h_ = 0;
  std::size_t used_ = 0;  ///< its order
  int failed_ = 0;        ///< trials before it
};

extern template class AdamsPece<double>;
extern template class AdamsPece<Quad>;

}  // namespace noether
