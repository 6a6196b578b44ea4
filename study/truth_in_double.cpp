#include "study/truth_in_double.hpp"

#include "study/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace noether {

namespace {

using States = std::vector<Vector<double>>;

using SteadyClock = std::chrono::steady_clock;

/// What one run may take, and what all have taken.
struct RunLimits {
  SteadyClock::time_point deadline;
  double most = 0;         ///< evaluations of forces of all runs
  double evaluations = 0;  ///< made so far
};

/// States at the moments of a sampling; empty where the run has failed, or would take more than it may.
States states_along(const Scene& scene, const Candidate& who, const Setting& setting, const Sampling& sampling,
                    RunLimits& limits) {
  Simulation<double> sim = assemble(variant(scene, who, setting));
  const std::int64_t steps = who.adaptive ? 0 : sampling.steps_for(setting.step);
  States states = {state_of(sim.particles())};
  for (int j = 1; j <= sampling.samples; ++j) {
    const Outcome outcome = who.adaptive ? sim.run_until(sampling.start + sampling.time(j)) : sim.run(steps);
    const auto made = static_cast<double>(sim.evaluations().force);
    const bool too_many = limits.evaluations + made * sampling.samples / j > limits.most;
    if (!outcome.ok() || too_many || SteadyClock::now() > limits.deadline) {
      limits.evaluations += made;
      return {};
    }
    states.push_back(state_of(sim.particles()));
  }
  limits.evaluations += static_cast<double>(sim.evaluations().force);
  return states;
}

std::optional<Candidate> reference_method(const Scene& scene) {
  for (const std::string& name : {std::string("dop853"), std::string("kahan_li_8_s17"), scene.integrator.method}) {
    try {
      Candidate who = candidate(scene, name);
      if (who.adaptive || name != "dop853") return who;
    } catch (const Error&) {
      continue;  // it cannot serve this scene
    }
  }
  return {};
}

/// Settings from coarse to fine, each about twice as costly as the one before.
std::vector<Setting> refinements(const Scene& scene, const Candidate& who, const Sampling& sampling) {
  std::vector<Setting> all;
  if (who.adaptive) {
    for (const double one : {1e-10, 1e-12, 1e-14}) all.push_back({.step = 0, .tolerance = one});
    return all;
  }
  const double own = scene.integrator.step > 0 ? scene.integrator.step : sampling.interval;
  for (double step = own; all.size() < 6; step /= 2) {
    all.push_back({.step = sampling.interval / static_cast<double>(sampling.steps_for(step)), .tolerance = 0});
  }
  return all;
}

std::vector<Vector<Quad>> widened(const States& states) {
  std::vector<Vector<Quad>> wide;
  for (const Vector<double>& y : states) wide.push_back(y.cast<Quad>());
  return wide;
}

double largest_distance(const States& run, const std::vector<Vector<Quad>>& finer, const PositionError& error) {
  double worst = 0;
  for (std::size_t j = 0; j < run.size(); ++j) worst = std::max(worst, error(run[j].cast<Quad>(), finer[j]));
  return worst;
}

std::string text_of_setting(const Candidate& who, const Setting& setting) {
  return who.adaptive ? fmt::format("rtol {:.0e}", setting.tolerance) : fmt::format("a step of {:.4g}", setting.step);
}

}  // namespace

Truth truth_in_double(const Scene& scene, const Sampling& sampling, const TruthOptions& options, PositionError& error) {
  Truth truth{.name = "invariants", .note = "two runs in double precision take longer than the budget"};
  const auto who = reference_method(scene);
  if (!who) return truth;
  const double budget = options.budget;
  const auto begin = SteadyClock::now();
  RunLimits limits{
      .deadline = begin + std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(budget)),
      .most = options.most_evaluations};
  const auto spent = [&] { return std::chrono::duration<double>(SteadyClock::now() - begin).count(); };
  States before;
  double last_took = 0;
  for (const Setting& setting : refinements(scene, *who, sampling)) {
    if (spent() + 1.5 * last_took > budget) break;
    const double at = spent();
    if (options.tell) options.tell(at / budget);
    States run = states_along(scene, *who, setting, sampling, limits);
    if (run.empty()) break;
    last_took = spent() - at;
    if (!before.empty()) {
      std::vector<Vector<Quad>> wide = widened(run);
      error.set_scale(wide);
      const double apart = largest_distance(before, wide, error);
      if (truth.error && !(apart < *truth.error)) break;  // rounding: it gets no better
      truth.error = apart;
      truth.y = std::move(wide);
      truth.note =
          fmt::format("double precision, {}, beside a run of twice the step or more", text_of_setting(*who, setting));
    }
    before = std::move(run);
  }
  truth.seconds = spent();
  truth.evaluations = limits.evaluations;
  if (truth.error && *truth.error < 1e-3) {
    truth.kind = TruthKind::doubles;
    truth.name = who->label + " in double";
    return truth;
  }
  const std::string why =
      truth.error ? fmt::format("two runs in double precision, by {}, differ by {:.1e}", who->label, *truth.error)
                  : truth.note;
  return {.name = truth.name, .note = why, .seconds = truth.seconds, .evaluations = truth.evaluations};
}

}  // namespace noether
