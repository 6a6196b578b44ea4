#include "study/stability_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace noether {

namespace {

constexpr std::int64_t blocks = 20;

/// The slope of log A over steps through the largest of each block, and its standard error.
void fit_growth(const std::vector<double>& largest, double steps_a_block, Trial& trial) {
  const double n = static_cast<double>(largest.size()), middle = (n - 1) / 2;
  double sxx = 0, sxy = 0, mean = 0;
  for (const double a : largest) mean += std::log(a) / n;
  for (std::size_t k = 0; k < largest.size(); ++k) {
    const double x = static_cast<double>(k) - middle;
    sxx += x * x;
    sxy += x * (std::log(largest[k]) - mean);
  }
  const double slope = sxy / sxx;
  double left = 0;
  for (std::size_t k = 0; k < largest.size(); ++k) {
    const double d = std::log(largest[k]) - mean - slope * (static_cast<double>(k) - middle);
    left += d * d;
  }
  trial.growth = slope / steps_a_block;
  trial.growth_error = std::sqrt(left / (n - 2) / sxx) / steps_a_block;
}

Bounded verdict_of(const Outcome& outcome) {
  switch (outcome.kind) {
    case Outcome::Kind::solver_failure:
    case Outcome::Kind::constraint_failure:
      return Bounded::solver;
    default:
      return Bounded::unbounded;
  }
}

}  // namespace

std::string_view name(Bounded verdict) {
  switch (verdict) {
    case Bounded::bounded:
      return "bounded";
    case Bounded::unbounded:
      return "unbounded";
    case Bounded::solver:
      return "solver";
    case Bounded::unsettled:
      break;
  }
  return "unsettled";
}

Trial follow(Simulation<double>& sim, const RunLength& length, const Amplitude& amplitude, const Bounds& bounds,
             double budget, const std::function<void(Simulation<double>&)>& look) {
  const auto begin = std::chrono::steady_clock::now();
  const double start = amplitude(sim.particles()), begun_at = sim.time();
  // What a symplectic method does to a linear problem is bounded, or grows by far more than rounding.
  const bool creeps = bounds.linear && !sim.claims().symplectic && length.until == 0;
  Trial trial;
  const std::int64_t cut = length.between_looks();
  const std::int64_t looks_a_block =
      std::max<std::int64_t>(1, (length.until > 0 ? RunLength::looks : length.steps / cut) / blocks);
  const auto done = [&](int looks) {
    return length.until > 0 ? looks >= RunLength::looks : trial.steps >= length.steps;
  };
  std::vector<double> largest;
  for (int looks = 0; !done(looks);) {
    double most = 0;
    for (std::int64_t k = 0; k < looks_a_block && !done(looks); ++k) {
      ++looks;
      const Outcome outcome = length.until > 0 ? sim.run_until(begun_at + length.until * looks / RunLength::looks)
                                               : sim.run(std::min(cut, length.steps - trial.steps));
      trial.steps = sim.step();
      const double a = outcome.ok() ? amplitude(sim.particles()) : 0;
      most = std::max(most, a);
      trial.largest = std::max(trial.largest, a / start);
      if (outcome.ok() && look) look(sim);
      if (outcome.ok() && trial.largest <= bounds.most) continue;
      trial.verdict = outcome.ok() ? Bounded::unbounded : verdict_of(outcome);
      trial.message =
          outcome.ok() ? fmt::format("{:g} times as large as at the start after {} steps", trial.largest, trial.steps)
                       : to_text(outcome);
      return trial;
    }
    largest.push_back(most);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (spent.count() < budget || done(looks)) continue;
    trial.verdict = Bounded::unsettled;
    trial.message = fmt::format("time ran out after {} steps", trial.steps);
    return trial;
  }
  if (!creeps || largest.size() < 10) return trial;
  fit_growth(largest, static_cast<double>(cut * looks_a_block), trial);
  if (trial.growth - 3 * trial.growth_error > growth_threshold && trial.growth > told_growth(trial.steps)) {
    trial.verdict = Bounded::unbounded;
    trial.message = fmt::format("grows by {:.2g} per step", trial.growth);
  }
  return trial;
}

Trial try_step(const Scene& scene, const Candidate& who, double step, std::int64_t steps, const Bounds& bounds,
               double budget) {
  if (bounds.until < static_cast<double>(steps) * std::abs(step)) {
    steps = static_cast<std::int64_t>(bounds.until / std::abs(step));
    if (steps < 1) return {};  // nothing is left to be judged
  }
  Simulation<double> sim = assemble(variant(scene, who, {.step = step, .tolerance = 0}));
  return follow(sim, {.steps = steps, .until = 0}, Amplitude(scene, bounds.frequency), bounds, budget);
}

}  // namespace noether
