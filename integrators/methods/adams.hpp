#pragma once
/// Adams methods with steps of one length: Bashforth, Moulton, and both as predictor and corrector.

#include "integrators/method.hpp"
#include "integrators/methods/starter.hpp"

namespace noether {

enum class AdamsKind {
  bashforth,  ///< explicit: k rates of the past for order k
  moulton,    ///< implicit: k - 1 rates of the past and the new one for order k, iterated to rounding
  pece        ///< predict by Bashforth, evaluate, correct by Moulton, evaluate, both of order k
};

/// Iterations after which the step of an implicit one counts as not solved.
inline constexpr int adams_iterations = 200;

/// Adams methods of order k, 1 to 12, with fixed steps.
///
///     Bashforth  y_1 = y_0 + h sum_(j<k) w_j f_-j,    Moulton  y_1 = y_0 + h sum_(j<k) w_j f_(1-j)
///
/// A change of the step starts again. The first steps are made by a `Starter`.
/// @cost 1 (Bashforth), 2 (PECE) evaluations a step, as many as it takes (Moulton); each step of the start 96 more
/// @source HairerNoersettWanner1993, III.1
template <class Real> class Adams final : public Method<Real> {
 public:
  Adams(std::string_view name, AdamsKind kind, int order);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Adams>(*this); }
  MethodClaims claims() const override;
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::history; }
  void moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) override;
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

  AdamsKind kind() const { return kind_; }
  /// Weights of f_0, f_-1, ... of the explicit formula, and of f_1, f_0, ... of the implicit one.
  const std::vector<Real>& explicit_weights() const { return explicit_; }
  const std::vector<Real>& implicit_weights() const { return implicit_; }
  /// Why a step of h from time t has none: what fixed-point iteration still changed, relative to the size of the
  /// solution, and by what rate that shrank.
  Failure not_solved(double t, double h, double change, int iterations, double rate) const;
  static constexpr int parts_of_start = 8;  ///< of each of the first steps

 private:
  void start(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h);
  std::optional<Failure> iterate(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h);
  double correct(const Vector<Real>& y, double h);

  std::string_view name_;
  AdamsKind kind_;
  int order_;
  std::vector<Real> explicit_, implicit_;
  Starter<Real> starter_{parts_of_start};
  History<Real> rates_;
  bool have_rate_ = false;  ///< the newest rate is the one at the present point
  double h_ = 0;
  Vector<Real> known_, y1_, f1_;  ///< y_0 and all terms of the past; the new point and its rate
  CompensatedVector<Real> begin_;
};

extern template class Adams<double>;
extern template class Adams<Quad>;

}  // namespace noether
