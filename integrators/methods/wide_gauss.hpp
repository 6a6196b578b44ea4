#pragma once
/// Gauss's collocation with 8 stages on states of double-doubles, for point masses none of which has to be heavy.

#include "engine/column.hpp"
#include "integrators/method.hpp"
#include "integrators/methods/wide_gauss_row.hpp"
#include "numbers/double_double.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Gauss's method of order 16 for gravity, right to 1e-20 of a step.
///
///     F_i = a(q + c_i h v + h^2 sum (a a)_ij F_j),   q1 = q + h v + h^2 sum (b a)_j F_j,   v1 = v + h sum b_j F_j
///
/// The first sweeps are made in doubles, until they stand still; then two or three more in double-double: positions,
/// distances, attractions and sums. Each of these gains two digits beyond what doubles tell. Stages are side by side in
/// lanes.
///
/// Inside a step, states are those of a step that ends there, whose sweeps begin with the polynomial of the last step.
///
/// State: both words of y, which particles keep; the rates of the last step, where the next one begins its sweeps.
/// @cost per step 4 to 6 sweeps over pairs in doubles, 2 or 3 in double-double, which take ten times as long; a look
/// inside a step costs another one, with 1 or 2 sweeps in doubles
/// @source HairerLubichWanner2006, Dekker1971
class WideGauss final : public Method<double> {
 public:
  explicit WideGauss(std::string_view name);

  std::unique_ptr<Method<double>> clone() const override { return std::make_unique<WideGauss>(*this); }
  MethodClaims claims() const override {
    return {.name = name_,
            .order = 16,
            .symplectic = true,
            .reversible = true,
            .keeps_angular_momentum = true,
            .second_order_only = true,
            .positions_only = true,
            .gravity_only = true,
            .second_words = true};
  }
  void bind(const VectorField<double>& f) override;
  StepResult step(VectorField<double>& f, const double& t, Vector<double>& y, double h) override;
  Vector<double>* low_words() override { return &low_; }
  bool dense() const override { return true; }
  void interpolate(VectorField<double>& f, const double& theta, Vector<double>& y) override;
  const Vector<double>* interpolated_low_words() const override { return &inside_low_; }
  Memory memory() const override { return Memory::none; }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  static constexpr std::size_t stages = 8;
  template <class Real> using Lanes = std::array<Real, stages>;

  void begin(const Vector<double>& y, double h);
  void add_forces_beside(VectorField<double>& f, double t, double h);
  bool sweep(VectorField<double>& f, double t, double h);
  bool sweep_wide(VectorField<double>& f, double h);
  void finish(Vector<double>& y, double h);

  std::string_view name_;
  WideGaussWeights weights_ = {};
  Lanes<double> c_{};
  Lanes<DoubleDouble> b_{}, twice_end_{};  ///< weights of the end of the step
  Lanes<Lanes<double>> ahead_{};           ///< ahead_[i][j]: weights of the last stages in their polynomial at 1 + c_i
  Index n_ = 0, coordinates_ = 0;
  bool beside_ = false;
  std::vector<double> gm_, gm_low_;
  std::vector<double> x_, x_low_, v_, v_low_;  ///< at the beginning of the step
  /// Eight numbers of each coordinate, all x before all y before all z; pushes: accelerations by forces beside gravity.
  AlignedVector<double> rates_, fresh_, q_, pushes_;
  AlignedVector<double> wide_rates_, wide_fresh_, wide_q_;  ///< eight high words, eight low ones
  Vector<double> stage_, stage_push_;
  Vector<double> low_;                ///< second words of y
  double t_ = 0;                      ///< where the last step began
  Vector<double> start_, start_low_;  ///< both words there
  Vector<double> inside_low_;         ///< second words inside the step
  double h_ = 0;                      ///< of the rates at hand; 0: there are none
};

}  // namespace noether
