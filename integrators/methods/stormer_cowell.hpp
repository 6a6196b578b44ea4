#pragma once
/// Stoermer's and Cowell's multistep method for q'' = a(t, q), in summed form.

#include "integrators/method.hpp"
#include "integrators/methods/starter.hpp"

namespace noether {

/// Order k with steps of one length; positions from sums of accelerations, not from positions.
///
///     D_n = D_(n-1) + h^2 a_n,  S_n = S_(n-1) + D_n,
///     q_(n+1) = S_n + sum_(i < k-2) g_i h^2 a_(n-i),   h v_n = D_n + sum_(i < k) w_i h^2 a_(n-i)
///
/// The positions are Stoermer's (explicit), the velocities Adams's from the same sums. Only S and D carry their
/// rounding errors along: positions are rounded once each, not over and over. The sums are set up by Cowell's and
/// Adams's implicit formulas at the end of a start of k - 1 steps. A change of the step starts again.
/// @cost 1 evaluation a step and n (2 k) multiplications; each step of the start 193 evaluations
/// @source HairerNoersettWanner1993, III.10
template <class Real> class StormerCowell final : public Method<Real> {
 public:
  StormerCowell(std::string_view name, int order);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<StormerCowell>(*this); }
  MethodClaims claims() const override {
    return {.name = name_, .order = order_, .second_order_only = true, .positions_only = true};
  }
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::history; }
  void moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) override;
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

  /// Weights of the present and earlier accelerations in the next position, in the present one, and in its velocity.
  const std::vector<Real>& position_weights() const { return next_position_; }
  const std::vector<Real>& present_position_weights() const { return position_; }
  const std::vector<Real>& velocity_weights() const { return velocity_; }
  static constexpr int parts_of_start = 16;  ///< of each of the first steps

 private:
  void set_up_sums(double h);
  void past(const std::vector<Real>& weights);

  std::string_view name_;
  int order_;
  std::vector<Real> next_position_, position_, velocity_;  ///< weights of a_n, a_(n-1), ...
  Starter<Real> starter_{parts_of_start};
  History<Real> pulls_;                 ///< h^2 a, the newest is a_n
  CompensatedVector<Real> sum_, sums_;  ///< D_n and S_n
  CompensatedVector<Real> y_;           ///< during the start
  Vector<Real> a_, past_;
  Real h2_ = Real(0);
  double h_ = 0;
};

extern template class StormerCowell<double>;
extern template class StormerCowell<Quad>;

}  // namespace noether
