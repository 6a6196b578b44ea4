#pragma once
/// Collocation with six to eight stages, in a form of its own for gravity.

#include "integrators/methods/collocation.hpp"
#include "integrators/methods/stage_control.hpp"
#include "integrators/methods/step_ladder.hpp"
#include "integrators/methods/step_predictor.hpp"

#include <array>

namespace noether {

struct AttractingBodies;

/// `Collocation` with six to eight stages of Gauss, or eight of Radau, in doubles; of point masses alone it computes
/// the same map with less rounding, in fewer sweeps, and chooses its steps by `StageControl`.
///
/// - Separations are kept apart from positions: positions X and velocities V on grids common to all bodies, so that
///   differences are exact, and displacements d; a pair is (d_j - d_i) + (X_j - X_i) + c h (V_j - V_i). What two bodies
///   have in common, far from the origin or in fast motion, takes no digits from what is between them.
/// - Pairs of massive bodies have G m_i m_j in two words, and bodies 1 / m_i: both feel the same vector.
/// - The update is that of a stage in the middle and of differences from it.
/// - Coefficients have two words, those of the update and those of displacements: one that is off by 1e-17 is a drift
///   of the energy, some 1e-19 of it a step.
/// - Stages begin where a polynomial of degree 12 through the 16 nodes of the last two steps leads, by least squares,
///   of whatever lengths these are. With s stages its degree is 3 s / 2, and lanes beyond s repeat the first.
/// - Convergence is looked at once a step, after as many sweeps as the last step has taken: some body's rate has
///   changed by more than 1e-14 of itself (a hundredth of rtol, where that is more), or none has.
///
/// Bodies up to 64; with six or seven stages adaptive steps only. Everything else, and steps of one length in which
/// sweeps do not converge, and all after these, are steps of `Collocation`.
/// @cost 3 to 7 sweeps of eight evaluations in lanes, 4 to 5 with steps of its own choice
/// @source HairerLubichWanner2006
class GravityGauss final : public Method<double> {
 public:
  GravityGauss(const MethodInfo& info, const MethodOptions& options, const CollocationTable& table, bool symplectic);

  std::unique_ptr<Method<double>> clone() const override { return std::make_unique<GravityGauss>(*this); }
  MethodClaims claims() const override { return general_.claims(); }
  void bind(const VectorField<double>& f) override;
  double next_step(VectorField<double>& f, const double& t, const Vector<double>& y, double h) override;
  StepResult step(VectorField<double>& f, const double& t, Vector<double>& y, double h) override;
  bool has_action() const override { return general_.has_action(); }
  double action(VectorField<double>& f, const double& t, const Vector<double>& y) override;
  Memory memory() const override { return Memory::none; }
  void moved(VectorField<double>& f, const double& t, const Vector<double>& y) override;
  void save(SavedState& saved, const std::string& prefix) const override;
  void load(const SavedState& saved, const std::string& prefix) override;

 private:
  static constexpr std::size_t stages = 8;
  using Numbers = AlignedVector<double>;

  bool bind_masses(const VectorField<double>& f);
  StepResult adaptive_step(VectorField<double>& f, const double& t, Vector<double>& y, double most);
  void set_length(double h);
  void widen_grids(const Vector<double>& y);
  void begin(const Vector<double>& y);
  void predict();
  bool solve(VectorField<double>& f, const Vector<double>& y);
  bool attract(VectorField<double>& f, Numbers& rates);
  void displace(const Numbers& rates);
  void complete_known(const Numbers& rates);
  bool is_rounding();
  void finish(Vector<double>& y);
  AttractingBodies bodies() const;

  Collocation<double> general_;
  StageTable<double> table_;
  int order_;
  bool mirrored_, adaptive_;
  double rtol_, first_, tolerance_;
  StageControl control_;
  StepPredictor predictor_;
  StageLanes<double> odd_{}, odd_low_{};                 ///< b (1/2 - c), and what rounding has taken
  StageMatrix<double> unit_twice_{}, unit_twice_low_{};  ///< a a, the same
  bool in_use_ = false;                                  ///< for the field at hand
  Index n_ = 0, pairs_ = 0;                              ///< bodies, and pairs of them that attract each other
  std::vector<std::ptrdiff_t> massive_, tracers_;
  std::vector<double> weight_, weight_low_, inverse_, inverse_low_;

  Numbers low_;                           ///< rounding errors of y
  std::array<Numbers, 2> made_;           ///< rates of the last two steps, shape (3 n, 8)
  double h_ = 0, h_before_ = 0;           ///< their lengths; 0 for none
  double next_ = 0;                       ///< to be tried
  StepLadder ladder_;                     ///< of the steps that follow the first one
  double longer_ = 0;                     ///< a step becomes longer if it may have more than so many times its length
  std::array<double, 2> grids_{};         ///< powers of two above all positions, and all velocities, so far
  int sweeps_ = 0;                        ///< asked for in the next step
  Numbers now_, before_;                  ///< rates of the last two sweeps
  Numbers known_, d_, on_grid_, apart_;   ///< of the step at hand
  std::vector<double> sizes_;             ///< of pulls on each body
  double length_ = 0;                     ///< that the table below is made for
  StageMatrix<double> twice_{};           ///< h^2 a a
  StageMatrix<double> twice_low_{};       ///< what rounding has taken from it
  StageLanes<double> c_h_{}, c_h_low_{};  ///< c h
  StageMatrix<double> extrapolation_{};   ///< a a times the polynomial of the last step
  double ratio_ = 0;                      ///< of the steps that it is made for
};

}  // namespace noether
