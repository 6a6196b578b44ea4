#pragma once
/// Planets as small departures from Kepler orbits, by collocation, on states of double-doubles.

#include "integrators/kepler_tangent.hpp"
#include "integrators/method.hpp"
#include "integrators/methods/encke_row.hpp"
#include "numbers/double_double.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Encke's method with Gauss's collocation of order 16, for point masses about a heavy one.
///
/// In a step a body moves along the Kepler orbit k(t) that it has at the beginning about the heaviest body, and departs
/// from it by d(t), which is carried in the frame of the flow, d = P y_x + Q y_v with the derivative of the Kepler arc
/// by its start, Phi = (P, Q; R, S):
///
///     q = k + d,  y' = Phi^-1 (0, p),  p = g(t, q) - mu (q/|q|^3 - k/|k|^3) + mu (d/|k|^3 - 3 k (k . d)/|k|^5)
///
/// q is relative to the heaviest body, g what others and other forces add to it. y is zero at the beginning and found
/// by Gauss's method with 8 stages, whose sweeps contract by the ratio of the perturbation to the attraction. Then the
/// arc is added in double-double. Everything else is smaller than the motion by that ratio, and computed in doubles: so
/// the state, of double-doubles, has errors far below the rounding of doubles, and they do not add up to a drift.
///
/// A step that perturbations are too rough for, as in an encounter that it jumps over, ends the run: their last
/// Legendre coefficient tells. One in which bodies are so near to each other that doubles do not tell their pull well
/// enough is counted (`Evaluations::unsettled`).
///
/// The centre of mass goes on evenly, or as the forces beside gravity push it. State: both words of y, which particles
/// keep; the perturbations of the last step, where the next one begins its sweeps.
/// @cost per step and body 9 Kepler arcs in doubles and one in double-double; 8 sums over pairs for each of 3 to 6
/// sweeps
/// @source Encke1852, HairerLubichWanner2006, ReinTamayo2015, Dekker1971
class EnckeGauss final : public Method<double> {
 public:
  explicit EnckeGauss(std::string_view name);

  std::unique_ptr<Method<double>> clone() const override { return std::make_unique<EnckeGauss>(*this); }
  MethodClaims claims() const override {
    return {.name = name_,
            .order = 16,
            .second_order_only = true,
            .positions_only = true,
            .gravity_only = true,
            .second_words = true};
  }
  void bind(const VectorField<double>& f) override;
  StepResult step(VectorField<double>& f, const double& t, Vector<double>& y, double h) override;
  Vector<double>* low_words() override { return &low_; }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  static constexpr std::size_t stages = 8;
  using Lanes = std::array<double, stages>;
  using LaneVector = std::array<Lanes, 3>;
  using WideVector = Vec3<DoubleDouble>;

  /// A body that moves about the heaviest one.
  struct Body {
    Index particle = 0;
    DoubleDouble mu, share;  ///< G (M + m), and m / (sum of all masses)
    WideVector x, v;         ///< relative to the heaviest body, at the beginning of the step
    Vec3<double> x0 = Vec3<double>::Zero(), v0 = Vec3<double>::Zero();  ///< the same, rounded
  };

  /// The largest change of perturbations by a sweep: relative to the largest of the body, and how far it moves the
  /// body, relative to its distance from the heaviest one.
  struct Change {
    double relative = 0, moves = 0;
  };

  void refuse_equals() const;
  std::optional<Failure> open(const Vector<double>& y, double h);
  std::optional<Failure> find_orbits(const Body& body, EnckeBody& rows, double h) const;
  void predict();
  void add_forces_beside(VectorField<double>& f, double t, double h);
  Change take_perturbations(double h);
  std::optional<Failure> sweep(VectorField<double>& f, double t, double h);
  std::optional<Failure> unresolved(double h) const;
  std::optional<Failure> close(Vector<double>& y, double h);
  Failure no_arc(const Body& body, double h) const;

  WideVector wide(const Vector<double>& y, Index particle, Index half) const;
  void put(const WideVector& value, Vector<double>& y, Index particle, Index half);

  std::string_view name_;
  Lanes c_{}, b_{}, b_low_{};
  Lanes last_{};  ///< weights of the last Legendre coefficient
  /// By columns: a_[8 j + i] is a_ij, ahead_[8 j + i] the weight of stage j of the last step in its polynomial at 1 +
  /// c_i.
  std::array<double, stages * stages> a_{}, ahead_{};
  std::array<Lanes, 2> twice_{};  ///< b a, and what rounding has taken
  Index n_ = 0, primary_ = 0;
  bool beside_ = false;
  std::vector<Body> bodies_;
  std::vector<EnckeBody> rows_;        ///< of the same bodies
  KeplerChange center_{};              ///< of mass, at the beginning of the step, where there are forces beside
  LaneVector drift_{};                 ///< its accelerations at the stages
  Vector<double> stage_, stage_push_;  ///< a stage as fields see it, and what forces beside gravity add to it
  Vector<double> low_;                 ///< second words of y
  double h_ = 0;                       ///< of the perturbations at hand; 0: there are none
  double strongest_ = 0;               ///< largest G (m + m') / r^3 of two bodies in the last sweep
  Vector<double> masses_;
};

}  // namespace noether
