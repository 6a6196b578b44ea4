#pragma once
/// Extrapolation of the modified midpoint rule to step 0: Gragg, Bulirsch and Stoer.

#include "integrators/step_control.hpp"

#include <limits>

namespace noether {

/// Column after column of Aitken and Neville's tableau until two of a row agree; step and order of least work.
///
///     T_(j,0) = the step in n_j parts,  T_(j,k) = T_(j,k-1) + (T_(j,k-1) - T_(j-1,k-1)) / ((n_j / n_(j-k))^2 - 1)
///
/// The parts are Gragg's midpoint rule with a smoothing step, n_j = 2, 4, 6, ...; where forces depend on positions
/// only, Stoermer's rule (the leapfrog), n_j = 1, 2, 3, ...: its errors are even powers of the step, too, and it needs
/// half the evaluations. Up to 8 rows in double, 12 in Quad: orders up to 16 and 24. (The weights of 8 rows have an
/// absolute sum of 120, of 12 rows 2600, of 20 rows a million: with more rows rounding errors would win.) What is
/// extrapolated is the change of y, so that they stay small against y.
/// @cost 1 + n_1 + ... + n_j evaluations a step, one less for a trial after a rejected one
/// @source HairerNoersettWanner1993, II.9 and II.14
template <class Real> class Extrapolation final : public Method<Real> {
 public:
  Extrapolation(const MethodInfo& info, const MethodOptions& options);

  std::unique_ptr<Method<Real>> clone() const override { return std::make_unique<Extrapolation>(*this); }
  MethodClaims claims() const override {
    return {.name = name_, .order = 2 * static_cast<int>(most), .adaptive = true};
  }
  void bind(const VectorField<Real>& f) override;
  double next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) override;
  StepResult step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) override;
  Memory memory() const override { return Memory::none; }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

  /// Rows of the tableau that are there at most.
  static constexpr std::size_t most = std::numeric_limits<Real>::digits > 64 ? 12 : 8;

 private:
  enum class Verdict { passed, go_on, rejected, hopeless };

  Verdict trial(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h);
  Verdict judge(std::size_t row, double error, double before) const;
  double add_row(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h, std::size_t row);
  void midpoint(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h, int parts, Vector<Real>& change);
  void leapfrog(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h, int parts, Vector<Real>& change);
  void after_success();
  void after_rejection();

  std::string_view name_;
  Tolerance tolerance_;
  double first_;

  // What is kept from step to step.
  double next_ = 0;         ///< length of the next step
  std::size_t target_ = 2;  ///< row it is expected to pass with, counted from 1
  bool begun_ = false, rejected_ = false;

  bool leapfrog_ = false;
  std::size_t rows_ = 0;                    ///< of the last trial
  std::vector<int> parts_, work_;           ///< n_j, and evaluations up to row j
  std::vector<double> length_, per_time_;   ///< of steps that would pass with row j, and their work per time
  std::vector<Vector<Real>> t_;             ///< the last row, from its end
  Vector<Real> f0_, f1_, y1_, past_, sum_;  ///< rate at the begin, and work
};

extern template class Extrapolation<double>;
extern template class Extrapolation<Quad>;

}  // namespace noether
