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
/// the state, of double-doubles, has errors far below the rounding of doubles.
///
/// For these not to add up to a drift, what rounding takes from constants counts: weights of the end have two words,
/// and mu is a double, the same in arcs and in their derivatives, whose low word pulls as a perturbation. Two bodies
/// alone move along one orbit, whose mu has both words.
///
/// A step that perturbations are too rough for, as in an encounter that it jumps over, ends the run: their last
/// Legendre coefficient tells. One in which bodies are so near to each other that doubles do not tell their pull well
/// enough is counted (`Evaluations::unsettled`).
///
/// Inside a step, states are those of a step that ends there, whose sweeps begin with the polynomial of the last one.
/// That polynomial itself would be right to O(h^11) only: where Jupiter passes Saturn, to some 1e-14 au.
///
/// The centre of mass goes on evenly, or as the forces beside gravity push it. State: both words of y, which particles
/// keep; the perturbations of the last step, where the next one begins its sweeps. Stages are side by side in lanes,
/// and so are eight bodies at the beginning and at the end of the step, where numbers have two words.
/// @cost per step and body 9 Kepler arcs in doubles and one in double-double; 8 sums over pairs for each of 3 to 6
/// sweeps; a look inside a step costs a step of 2 or 3
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
  bool dense() const override { return true; }
  void interpolate(VectorField<double>& f, const double& theta, Vector<double>& y) override;
  const Vector<double>* interpolated_low_words() const override { return &inside_low_; }
  Memory memory() const override { return Memory::none; }
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  static constexpr std::size_t stages = 8;
  using Lanes = std::array<double, stages>;

  /// A body that moves about the heaviest one: lane `number % 8` of row `number / 8`.
  struct Body {
    Index particle = 0;
    DoubleDouble mu, share;  ///< mu of its orbits, and m / (sum of all masses)
  };

  /// The body whose numbers a lane has, counted over all rows of eight; the first of the row where there is none.
  std::size_t in_lane(std::size_t m) const { return m < bodies_.size() ? m : m / stages * stages; }
  void refuse_equals() const;
  void gather(const Vector<double>& y);
  void scatter(Vector<double>& y);
  std::optional<Failure> open(const Vector<double>& y, double h);
  std::optional<Failure> find_orbits(const Body& body, EnckeBody& rows, double h) const;
  void predict();
  void add_forces_beside(VectorField<double>& f, double t);
  std::optional<Failure> sweep(VectorField<double>& f, double t, double h);
  std::optional<Failure> end_stages(double h);
  std::optional<Failure> close(Vector<double>& y, double h);
  bool advance_one(std::size_t body, double h);
  Failure no_arc(const Body& body, double h) const;

  std::string_view name_;
  Lanes c_{}, c_low_{};
  EnckeWeights weights_;
  std::array<Lanes, 2> twice_{};     ///< b a, and what rounding has taken
  alignas(64) EightWords tau_ = {};  ///< times of stages in the step
  /// By columns: a_[8 j + i] is a_ij, ahead_[8 j + i] the weight of stage j of the last step in its polynomial at 1 +
  /// c_i.
  alignas(64) std::array<double, stages * stages> a_{}, ahead_{};
  Index n_ = 0, primary_ = 0;
  bool beside_ = false;
  std::vector<Body> bodies_;
  std::vector<EnckeBody> rows_;         ///< of the same bodies
  std::vector<EnckeEight> eights_;      ///< the same, eight by eight
  alignas(64) EightWords center_ = {};  ///< position and velocity of the heaviest body
  KeplerChange mean_{};                 ///< those of the centre of mass at the beginning of the step, for forces beside
  std::array<Lanes, 3> drift_{};        ///< its accelerations at the stages
  Vector<double> stage_, stage_push_;   ///< a stage as fields see it, and what forces beside gravity add to it
  Vector<double> low_;                  ///< second words of y
  double t_ = 0;                        ///< where the last step began
  Vector<double> start_, start_low_;    ///< both words there
  Vector<double> inside_low_;           ///< second words inside the step
  double h_ = 0;                        ///< of the perturbations at hand; 0: there are none
  double strongest_ = 0;                ///< largest G (m + m') / r^3 of two bodies in the last sweep
  Vector<double> masses_;
};

}  // namespace noether
