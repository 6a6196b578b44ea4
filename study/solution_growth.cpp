#include "study/solution_growth.hpp"

#include "engine/bodies.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

void SolutionGrowth::look(double time, double budget, const Bounds& bounds) {
  if (leaves_ || !(time > known_)) return;
  known_ = time;  // asked once: what takes too long, or has no reference, explains nothing
  try {
    // Bodies that turn have no y' = f: a splitting of order 8 follows them, with steps an eighth as long
    // as the scene's; with tides, which cannot go back, nothing does.
    const bool turns = has_bodies(scene_.particles);
    const double step = turns ? std::abs(scene_.integrator.step) / 8 : 0;
    const Candidate who = candidate(scene_, turns ? "kahan_li_8_s17" : "dop853");
    Simulation<double> sim = assemble(
        variant(scene_, who, turns ? Setting{.step = step, .tolerance = 0} : Setting{.step = 0, .tolerance = 1e-12}));
    const double most = bounds.most / 10;
    const RunLength length = turns ? RunLength{.steps = static_cast<std::int64_t>(time / step) + 1, .until = 0}
                                   : RunLength{.steps = 0, .until = time};
    const Trial trial = follow(sim, length, Amplitude(scene_, frequency_),
                               {.frequency = frequency_, .linear = false, .most = most}, budget);
    largest_ = std::max(largest_, trial.largest);
    if (trial.verdict == Bounded::unbounded && trial.largest > most) leaves_ = sim.time() - scene_.integrator.start;
  } catch (const Error&) {
    return;
  }
}

bool SolutionGrowth::explains(const Trial& run, double time, double budget, Bounds& bounds) {
  if (run.verdict != Bounded::unbounded) return false;
  look(time, budget, bounds);
  bool changed = false;
  if (leaves_ && *leaves_ < bounds.until) {
    bounds.until = *leaves_;
    changed = true;
  }
  const double grown = run.growth * static_cast<double>(run.steps);  // of the logarithm; 0: it left at once
  if (bounds.linear && grown > 0 && largest_ > 1.01 && std::log(largest_) > grown / 2) {
    bounds.linear = false;
    changed = true;
  }
  return changed;
}

}  // namespace noether
