#pragma once
/// One run of a comparison: what it costs, and where it was at the moments of the sampling.

#include "study/candidate.hpp"
#include "study/position_error.hpp"
#include "study/sampling.hpp"
#include "study/truth.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// States and invariants of a run at the moments of a sampling, the start among them.
struct Track {
  std::vector<Quad> times = {};          ///< of the states from the start on, exact products of the step
  std::vector<Vector<double>> y = {};    ///< as in `Truth`
  std::vector<Vector<double>> low = {};  ///< further digits of y, of methods that have them; empty for others
  std::vector<Quad> energy = {};         ///< total [energy]; empty where no force tells it
  double energy_scale = 0;               ///< what energy errors are relative to
  MonitorReport energy_report = {}, momentum = {}, angular_momentum = {};
  std::optional<double> shadow_fluctuation = {};

  /// The state at moment `j`, with all its digits.
  Vector<Quad> state(std::size_t j) const;
};

/// One row of a comparison: columns as in `compare.csv`. Empty: not measured.
struct Row {
  Candidate who = {};
  Setting setting = {};
  std::string outcome = {};  ///< of the run, or "over_budget"
  std::string message = {};
  double outcome_time = 0;  ///< by the clock [time]
  std::int64_t steps = 0;
  Evaluations evaluations = {};
  double work = 0;  ///< evaluations of forces by all runs of the row, the timed ones too
  std::optional<double> wall_s = {}, wall_mad_s = {};  ///< of the run alone, nobody watching
  int repeats = 0;
  std::optional<double> position_error_max = {}, position_error_rms = {}, position_error_end = {};
  std::optional<double> orientation_error_max = {};  ///< angle of the worst body, where some turn [rad]
  std::optional<double> energy_error_max = {}, energy_error_rms = {}, energy_slope = {}, energy_slope_error = {};
  std::optional<double> momentum_error_max = {}, angular_momentum_error_max = {}, shadow_fluctuation = {};
  std::optional<double> truth_error = {};  ///< of the reference this row was measured against
  std::string truth = {};
  bool pareto_time = false, pareto_evaluations = false;
  std::string digest = {};
  Track track = {};
  std::vector<double> position_errors = {};  ///< at the moments of the track, the start among them

  bool completed() const { return outcome == "completed"; }
};

/// What is told of repeated measurements.
struct Spread {
  double median = 0;
  double mad = 0;  ///< median of the distances from the median
};
/// @param values  at least one
Spread spread_of(std::vector<double> values);

/// All coordinates of a run as they are compared: positions as if never wrapped, x then y then z, and velocities, of
/// rigid bodies orientations too, w, x, y, z; or the variables of a first-order system.
Vector<double> state_of(const ParticleSystem<double>& s);
/// Further digits of the same, of particles that have second words.
Vector<double> low_state_of(const ParticleSystem<double>::LowWords& low, Index n);

struct MeasureOptions {
  int repeats = 3;     ///< of the timed run; more for short ones, fewer where the budget does not allow them
  double budget = 10;  ///< seconds of wall time for one run
  bool states = true;  ///< whether the states of more than `most_bodies` are kept
  bool quick = false;  ///< whether the time of the watched run is enough where it is long
  double most_evaluations = std::numeric_limits<double>::infinity();    ///< of forces, by one run; beyond, it ends
  double repeat_evaluations = std::numeric_limits<double>::infinity();  ///< by all runs beyond the `needed_runs`
  bool shadow = true;  ///< whether the shadow Hamiltonian is watched, which takes several evaluations at each moment
};

/// Runs of every row: the one that is watched, and one for its time, unless a rough time will do. How many there are
/// beyond these depends on the clock.
constexpr int needed_runs(bool quick) { return quick ? 1 : 2; }

/// Runs one candidate with one setting: once watched, then `repeats` times alone, for the time, as far as
/// `repeat_evaluations` go.
///
/// A run that fails is a row as any other. One beyond the budget, or beyond `most_evaluations`, ends there, outcome
/// "over_budget"; of the latter the message says so. One that comes to
/// its end, but has left the motion behind, is told by `set_errors`.
Row measure(const Scene& scene, const Candidate& who, const Setting& setting, const Sampling& sampling,
            const MeasureOptions& options = {});

/// A run whose positions (or variables) come to so many times the largest of the truth has diverged, finite or not.
inline constexpr double lost_beyond_truth = 1e10;
/// The same where there is no truth: of what they were at the start.
inline constexpr double lost_beyond_start = 1e100;

/// Puts the errors of positions and energies into a row.
///
/// Energy is compared with that of the truth where the equations themselves do not keep it. A run that was completed
/// beyond `lost_beyond_truth`, without a truth beyond `lost_beyond_start`, becomes one that has diverged.
void set_errors(Row& row, const Truth& truth, const Sampling& sampling, const PositionError& error);

/// Relative errors of the energy at the moments of a track, signed.
std::vector<double> energy_errors(const Track& track, const Truth& truth);

/// The exact state at the moment of a track: the truth at moment `j`, moved to `time`.
Vector<Quad> truth_at(const Truth& truth, const Sampling& sampling, std::size_t j, const Quad& time);

}  // namespace noether
