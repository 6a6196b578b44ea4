#pragma once
/// Backward differentiation formulas: of variable step and order, and of fixed step and order.

#include "integrators/methods/jacobian.hpp"
#include "integrators/methods/rosenbrock.hpp"
#include "integrators/step_control.hpp"

#include <array>
#include <vector>

namespace noether {

/// Backward differences of the solution, D_j = grad^j y_n, at equal distances h in the past.
///
///     p(t_n + s h) = sum_j D_j s (s + 1) ... (s + j - 1) / j!
template <class Real> class BackwardDifferences {
 public:
  void bind(Index n, std::size_t count);
  Vector<Real>& operator[](std::size_t j) { return d_[j]; }
  const Vector<Real>& operator[](std::size_t j) const { return d_[j]; }
  /// The polynomial of degree `order` at t_n + s h.
  void evaluate(std::size_t order, const Real& s, Vector<Real>& y) const;
  /// The differences of the same polynomial at distances `factor` h. @cost n order^2
  void respace(std::size_t order, const Real& factor);
  /// Puts the next value behind the present ones, differences up to `last`: D_last is that of the new value already.
  void append(std::size_t last);

  /// Takes another y for the last one: every difference up to number `last` changes by as much as it.
  void replace(std::size_t last, const Vector<Real>& y);
  void save(SavedState& saved, const std::string& prefix) const;
  void load(const SavedState& saved, const std::string& prefix);

 private:
  std::vector<Vector<Real>> d_;
  std::vector<Real> work_;
};

/// BDF of variable step and order 1 to 5, in backward differences that are respaced when the step changes.
///
///     sum_{j=1}^{q} grad^j y_{n+1} / j = h f(t_{n+1}, y_{n+1}),   error = grad^{q+1} y_{n+1} / (q + 1)
///
/// J and its factors are kept as long as Newton's iteration converges with them and h stays; h and q change after at
/// least q + 1 equal steps, where another choice is faster by a fifth. The whole past is state.
/// @cost two to three evaluations a step, a Jacobian every ten to fifty steps, an LU when h or J changes
/// @source ShampineReichelt1997, HairerWanner1996
template <class Real> class Bdf final : public Method<Real> {
 public:
  static constexpr std::size_t highest = 5;

  Bdf(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Bdf>(*this); }
  MethodClaims claims() const override { return {.name = name_, .order = highest, .adaptive = true}; }
  void bind(const VectorField<Real>& f) override;
  double next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  bool dense() const override { return true; }
  void interpolate(VectorField<Real>& f, const Real& theta, Vector<Real>& y) override;
  Memory memory() const override { return Memory::history; }
  void moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) override;
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  enum class Solved { yes, slowly, singular };
  void space(double h);
  Solved iterate(VectorField<Real>& f, const Real& end);
  bool solve(VectorField<Real>& f, const Real& end);
  double error(std::size_t order, const Vector<Real>& y);
  void choose(double now, const Vector<Real>& y);

  std::string_view name_;
  Tolerance tolerance_;
  const ParticleScales* scales_ = nullptr;  ///< of the field, where a step begins
  std::optional<JacobianForm> form_;
  double first_, newton_tolerance_;
  std::array<Real, highest + 1> harmonic_{};  ///< 1 + 1/2 + ... + 1/q
  Jacobian<Real> jacobian_;
  BackwardDifferences<Real> d_;
  std::size_t order_ = 1, next_order_ = 1;
  double h_ = 0, next_h_ = 0;  ///< distance of the differences; of the next step [time]
  double factorized_for_ = 0;  ///< h / (1 + ... + 1/q) of the present factors; 0: none
  std::int64_t equal_ = 0;     ///< steps made with this h and order
  bool started_ = false, have_jacobian_ = false;
  Vector<Real> predicted_, past_, correction_, y1_, update_;
};

/// BDF of fixed step and order k, started by Rodas5P, each step solved to rounding.
/// @cost one Jacobian, one LU and two to four evaluations a step
/// @source HairerWanner1996
template <class Real> class FixedBdf final : public Method<Real> {
 public:
  FixedBdf(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<FixedBdf>(*this); }
  MethodClaims claims() const override { return {.name = name_, .order = static_cast<int>(order_)}; }
  void bind(const VectorField<Real>& f) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::history; }
  void moved(VectorField<Real>& f, const Real& t, const Vector<Real>& y) override;
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  std::optional<Failure> solve(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  void remember(const Vector<Real>& y);

  std::string_view name_;
  std::size_t order_;
  std::optional<JacobianForm> form_;
  Rosenbrock<Real> starter_;
  Jacobian<Real> jacobian_;
  BackwardDifferences<Real> d_;
  std::size_t known_ = 0;  ///< values of the past, the present one among them
  double h_ = 0;           ///< their distance [time]
  bool second_order_ = false;
  Vector<Real> predicted_, past_, correction_, y1_, update_;
};

extern template class BackwardDifferences<double>;
extern template class BackwardDifferences<Quad>;
extern template class Bdf<double>;
extern template class Bdf<Quad>;
extern template class FixedBdf<double>;
extern template class FixedBdf<Quad>;

}  // namespace noether
