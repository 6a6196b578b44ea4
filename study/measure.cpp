#include "study/measure.hpp"

#include "engine/bodies.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>

namespace noether {

namespace {

/// Keeps every state it sees.
class Recorder {
 public:
  Recorder(std::shared_ptr<Track> kept, bool with_energy, bool states, double step, double start)
      : track_(std::move(kept)), energy_(with_energy), states_(states), dt_(step), start_(start) {}

  static constexpr auto describe() { return part<Recorder>("recorder", "states for a comparison"); }
  Request wanted() const { return {.energy = energy_}; }
  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    track_->times.push_back(dt_ != 0 ? Quad(dt_) * Quad(now.step()) : Quad(now.time()) - Quad(start_));
    if (states_) track_->y.push_back(state_of(s));
    const auto* low = s.low_words();
    if (states_ && low != nullptr && now.claims().second_words) track_->low.push_back(low_state_of(*low, s.size()));
    if (energy_) {
      const auto& with_all_digits = now.wide_energy();
      track_->energy.push_back(with_all_digits ? with_all_digits->total() : Quad(now.energy().total()));
    }
    if (energy_ && track_->energy_scale == 0) {
      const EnergyTerms<double>& e = now.energy();
      track_->energy_scale = std::max(std::abs(e.total()), 1e-3 * (e.kinetic + std::abs(e.potential)));
    }
  }

 private:
  std::shared_ptr<Track> track_;
  bool energy_, states_;
  double dt_;     ///< of a fixed clock [time]; 0: the time of the snapshot
  double start_;  ///< what the clock shows at step 0 [time]
};

/// Raises a flag, which ends the run, and one that says why, when a run has made so many evaluations.
class Meter {
 public:
  Meter(const Simulation<double>& run, double most, std::atomic<bool>& over, bool& why)
      : run_(&run), over_(&over), why_(&why), most_(most) {}

  static constexpr auto describe() { return part<Meter>("meter", "evaluations of a comparison"); }
  void observe(const Snapshot<double>& /*now*/) {
    if (static_cast<double>(run_->evaluations().force) > most_) *over_ = *why_ = true;
  }

 private:
  const Simulation<double>* run_;
  std::atomic<bool>* over_;
  bool* why_;
  double most_;
};

/// Ends a run at the end of its budget.
class Budget {
 public:
  Budget(Simulation<double>& sim, double seconds) {
    sim.stop_on(&over_);
    sim.on_progress([this, seconds](const Progress& now) {
      if (now.seconds > seconds) over_ = true;
    });
  }
  std::atomic<bool>& flag() { return over_; }

 private:
  std::atomic<bool> over_{false};
};

/// Whole steps between two moments; 0 for adaptive methods.
std::int64_t steps_between(const Setting& setting, const Sampling& sampling) {
  return setting.step > 0 ? sampling.steps_for(setting.step) : 0;
}

Outcome run_whole(Simulation<double>& sim, const Setting& setting, const Sampling& sampling) {
  if (setting.step > 0) return sim.run(steps_between(setting, sampling) * sampling.samples);
  return sim.run_until(sampling.start + sampling.end());
}

template <class M> M* watch(Simulation<double>& sim, const Setting& setting, const Sampling& sampling, M monitor) {
  if (setting.step > 0) return &sim.every(steps_between(setting, sampling), std::move(monitor));
  return &sim.every_time(sampling.interval, std::move(monitor));
}

/// Least fluctuation of the orders that were watched.
std::optional<double> least_fluctuation(const ShadowHamiltonian<double>* monitor) {
  if (monitor == nullptr) return {};
  const MonitorReport report = monitor->report();
  if (report.fluctuation.empty()) return {};
  const double best = *std::min_element(report.fluctuation.begin(), report.fluctuation.end());
  return std::isfinite(best) ? std::optional(best) : std::nullopt;
}

/// A monitor of the shadow, where the run can have one: it watches every sample's first steps.
ShadowHamiltonian<double>* watch_shadow(Simulation<double>& sim, const Scene& alone, const Setting& setting,
                                        const Sampling& sampling) {
  const bool serves = setting.step > 0 && sim.claims().symplectic && sim.claims().energy;
  const ShadowHamiltonian<double> monitor;
  if (!serves || steps_between(setting, sampling) < monitor.steps_in_a_row()) return nullptr;
  try {
    Simulation<double> trial = assemble(alone);  // what refuses the monitor is no run any more
    watch(trial, setting, sampling, monitor);
  } catch (const Error&) {
    return nullptr;
  }
  return watch(sim, setting, sampling, monitor);
}

std::string too_many_evaluations(bool quick) {
  return quick ? "it takes more evaluations of forces than advice may"
               : "it takes more evaluations of forces than measuring may; --until compares without that limit";
}

/// The run as others are compared with it. @return whether it was within the budget
bool watched_run(Row& row, const Scene& alone, const Sampling& sampling, const MeasureOptions& options) {
  Simulation<double> sim = assemble(alone);
  const IntegratorClaims claims = sim.claims();
  const bool particles = alone.particles.size() > 0, energy = claims.energy;
  auto track = std::make_shared<Track>();
  watch(sim, row.setting, sampling,
        Recorder(track, energy, options.states || alone.particles.size() <= most_bodies, row.setting.step,
                 sampling.start));
  const Energy* watched = energy ? watch(sim, row.setting, sampling, Energy()) : nullptr;
  const Momentum* momentum =
      particles && claims.keeps_momentum ? watch(sim, row.setting, sampling, Momentum()) : nullptr;
  const AngularMomentum* spin = nullptr;
  bool kept =
      particles && alone.hamiltonian.splitting.claims()
                       .keeps_angular_momentum;  // by the equations; whether the method keeps it is what is measured
  for (const SceneForce& force : alone.hamiltonian.forces) {
    kept = kept && force.force.claims().keeps_angular_momentum;
  }
  if (kept && alone.hamiltonian.constraints.empty()) spin = watch(sim, row.setting, sampling, AngularMomentum());
  const ShadowHamiltonian<double>* fluctuation =
      options.shadow ? watch_shadow(sim, alone, row.setting, sampling) : nullptr;
  Budget budget(sim, options.budget);
  bool too_many = false;
  if (std::isfinite(options.most_evaluations))
    watch(sim, row.setting, sampling, Meter(sim, options.most_evaluations, budget.flag(), too_many));
  const Outcome outcome = run_whole(sim, row.setting, sampling);
  const bool over = outcome.kind == Outcome::Kind::interrupted;  // nothing else ends it early
  row.outcome = over ? "over_budget" : std::string(name(outcome.kind));
  row.message = !over ? outcome.message : too_many ? too_many_evaluations(options.quick) : "";
  row.outcome_time = outcome.time;
  row.steps = sim.step();
  row.evaluations = sim.evaluations();
  row.work = static_cast<double>(row.evaluations.force);
  row.wall_s = sim.seconds();
  row.digest = io::digest(sim.particles());
  if (watched != nullptr) track->energy_report = watched->report();
  if (momentum != nullptr) track->momentum = momentum->report();
  if (spin != nullptr) track->angular_momentum = spin->report();
  track->shadow_fluctuation = least_fluctuation(fluctuation);
  row.track = std::move(*track);
  return !over;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

/// Runs that are over sooner are repeated up to five times as often: one interruption must not decide their median [s].
constexpr double soon_over = 0.05;
/// Runs as long as that together are not repeated: their time is known well enough [s].
constexpr double long_enough = 2;
/// Of a run as long as that what watches it takes little, where a rough time will do [s].
constexpr double long_enough_watched = 0.1;

/// The same run with nobody watching, as often as asked for or as the budgets allow: what other rows leave is not
/// touched, so that no row depends on how often the ones before it were timed.
void timed_runs(Row& row, const Scene& alone, const Sampling& sampling, const MeasureOptions& options) {
  std::vector<double> seconds;
  double spent = 0, drawn = 0;
  const int needed = needed_runs(options.quick) - 1;
  const auto again = [&](int done) {
    if (done < needed) return true;
    if (drawn + static_cast<double>(row.evaluations.force) > options.repeat_evaluations) return false;
    if (done == 0) return true;
    return spent < std::min(options.budget, long_enough) &&
           (done < options.repeats || (spent < soon_over && done < 5 * options.repeats));
  };
  for (int k = 0; again(k); ++k) {
    Simulation<double> sim = assemble(alone);
    static_cast<void>(run_whole(sim, row.setting, sampling));
    const auto made = static_cast<double>(sim.evaluations().force);
    row.work += made;
    if (k >= needed) drawn += made;
    seconds.push_back(sim.seconds());
    spent += seconds.back();
  }
  row.repeats = std::max(1, static_cast<int>(seconds.size()));
  if (seconds.empty()) return;  // the watched run has told its time
  const Spread spread = spread_of(seconds);
  row.wall_s = spread.median;
  row.wall_mad_s = spread.mad;
}

std::optional<double> finite(const std::optional<double>& x) { return x && std::isfinite(*x) ? x : std::nullopt; }

std::optional<double> worst_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  double worst = 0;
  for (const double x : values) worst = std::isfinite(x) ? std::max(worst, std::abs(x)) : x;
  return finite(worst);
}

std::optional<double> rms_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  double squares = 0;
  for (const double x : values) squares += x * x;
  return finite(std::sqrt(squares / static_cast<double>(values.size())));
}

/// Calls a run that has grown out of all proportion what it is, though its numbers have stayed finite.
void mark_diverged(Row& row, const Truth& truth, const Sampling& sampling, const PositionError& error) {
  const Track& track = row.track;
  if (!row.completed() || track.y.empty()) return;
  double scale = truth.has_states() ? 0 : error.size(track.state(0));
  for (const Vector<Quad>& y : truth.y) scale = std::max(scale, error.size(y));
  if (!(scale > 0)) return;
  const double most = truth.has_states() ? lost_beyond_truth : lost_beyond_start;
  for (std::size_t j = 0; j < track.y.size(); ++j) {
    const double times = error.size(track.state(j)) / scale;
    if (times <= most) continue;
    row.outcome = name(Outcome::Kind::diverged);
    row.outcome_time = static_cast<double>(Quad(sampling.start) + track.times[j]);
    row.message = fmt::format("{:.2g} times as large as {} at t = {:.6g}", times,
                              truth.has_states() ? "the reference ever is" : "at the start", row.outcome_time);
    return;
  }
}

}  // namespace

Vector<double> state_of(const ParticleSystem<double>& s) {
  const auto n = s.size();
  Vector<double> y(n == 0 ? static_cast<Index>(s.variables().size()) : has_bodies(s) ? 10 * n : 6 * n);
  for (int k = 0; k < 3 && n > 0; ++k) {
    for (Index i = 0; i < n; ++i) y[k * n + i] = s.unwrapped(i)[k];
    std::copy_n(s.velocities().component(k), n, y.data() + (3 + k) * n);
  }
  for (int k = 0; k < 4 && has_bodies(s); ++k) {
    std::copy_n(s.column<BodyOrientation>().component(k), n, y.data() + (6 + k) * n);
  }
  if (n == 0) std::copy(s.variables().begin(), s.variables().end(), y.data());
  return y;
}

Vector<double> low_state_of(const ParticleSystem<double>::LowWords& low, Index n) {
  Vector<double> y(6 * n);
  for (int k = 0; k < 3; ++k) {
    std::copy_n(low.x.component(k), n, y.data() + k * n);
    std::copy_n(low.v.component(k), n, y.data() + (3 + k) * n);
  }
  return y;
}

Vector<Quad> Track::state(std::size_t j) const {
  Vector<Quad> whole = y[j].cast<Quad>();
  if (j < low.size()) whole += low[j].cast<Quad>();
  return whole;
}

Spread spread_of(std::vector<double> values) {
  Spread spread{.median = median(values)};
  for (double& one : values) one = std::abs(one - spread.median);
  spread.mad = median(std::move(values));
  return spread;
}

Row measure(const Scene& scene, const Candidate& who, const Setting& setting, const Sampling& sampling,
            const MeasureOptions& options) {
  Row row{.who = who, .setting = setting};
  if (!who.adaptive) {
    row.setting.step = sampling.interval / static_cast<double>(sampling.steps_for(setting.step));
  }
  const Scene alone = variant(scene, who, row.setting);
  const bool whole = watched_run(row, alone, sampling, options);
  const bool timed = whole && options.quick && row.wall_s.value_or(0) > long_enough_watched;
  row.repeats = timed ? 1 : 0;
  if (whole && !timed) timed_runs(row, alone, sampling, options);
  return row;
}

Vector<Quad> truth_at(const Truth& truth, const Sampling& sampling, std::size_t j, const Quad& time) {
  Vector<Quad> y = truth.y[j];
  if (truth.rate.empty()) return y;
  const Quad late = time - sampling.exact_time(static_cast<int>(j));
  for (Index i = 0; i < y.size(); ++i) y[i] += late * truth.rate[j][i];
  return y;
}

std::vector<double> energy_errors(const Track& track, const Truth& truth) {
  std::vector<double> errors;
  if (track.energy.empty() || track.energy_scale == 0) return errors;
  const bool kept = track.energy_report.reason.empty();
  if (!kept && truth.energy.empty()) return errors;
  for (std::size_t j = 0; j < track.energy.size(); ++j) {
    if (!kept && j >= truth.energy.size()) break;
    const Quad right = kept ? track.energy[0] : truth.energy[j];
    errors.push_back(static_cast<double>(track.energy[j] - right) / track.energy_scale);
  }
  return errors;
}

void set_errors(Row& row, const Truth& truth, const Sampling& sampling, const PositionError& error) {
  const Track& track = row.track;
  mark_diverged(row, truth, sampling, error);
  row.truth = truth.name;
  row.truth_error = truth.error;
  std::vector<double> errors;
  for (std::size_t j = 1; j < track.y.size() && j < truth.y.size(); ++j) {
    errors.push_back(error(track.state(j), truth_at(truth, sampling, j, track.times[j])));
  }
  row.position_errors = {0.0};
  row.position_errors.insert(row.position_errors.end(), errors.begin(), errors.end());
  row.position_error_max = worst_of(errors);
  row.position_error_rms = rms_of(errors);
  if (error.any_turns()) {
    std::vector<double> turned;
    for (std::size_t j = 1; j < track.y.size() && j < truth.y.size(); ++j) {
      turned.push_back(error.turned_apart(track.state(j), truth.y[j]));
    }
    row.orientation_error_max = worst_of(turned);
  }
  row.position_error_end = errors.empty() || !row.completed() ? std::nullopt : finite(errors.back());
  const std::vector<double> energies = energy_errors(track, truth);
  row.energy_error_max = worst_of(energies);
  row.energy_error_rms = rms_of(energies);
  row.energy_slope = finite(track.energy_report.slope);
  row.energy_slope_error = finite(track.energy_report.slope_error);
  row.momentum_error_max = finite(track.momentum.worst);
  row.angular_momentum_error_max = finite(track.angular_momentum.worst);
  row.shadow_fluctuation = track.shadow_fluctuation;
}

}  // namespace noether
