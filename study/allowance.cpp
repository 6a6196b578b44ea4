#include "study/allowance.hpp"

#include <cmath>

namespace noether {

namespace {

constexpr double least_work = 4e9;

/// Evaluations of the scene's own run over a time, measured on its first part; 0: not known.
double evaluations_over(const Scene& scene, const Sampling& sampling, double length, double& spent) {
  if (!scene.integrator.adaptive()) {
    const Candidate self{scene.integrator.method, scene.integrator.method, false, false};
    const double step = std::abs(scene.integrator.step);
    return evaluations_per_step(scene, self, scene.integrator.step, &spent) * length / step;
  }
  Scene alone = scene;
  alone.watches.clear();
  alone.stops.clear();
  Simulation<double> sim = assemble(alone);
  const bool ok = sim.run_until(sampling.start + sampling.interval).ok();
  const auto made = static_cast<double>(sim.evaluations().force);
  spent += made;
  return ok ? made * length / sampling.interval : 0;
}

}  // namespace

Allowance allowance_of(const Scene& scene, const Sampling& sampling) {
  Allowance work;
  const auto length = scene.integrator.length();
  const auto n = static_cast<double>(scene.particles.size());
  if (!(n > 0) || !length || !(*length > 0)) return work;
  const double own = evaluations_over(scene, sampling, *length, work.spent);
  if (!(own > 0)) return work;
  work.own_run = own;
  work.most = std::max(own, least_work / (n * (n + 100)));
  return work;
}

double StepCosts::of(const Candidate& who, double step) {
  const auto [at, is_new] = known_.try_emplace(who.label, 0.0);
  if (is_new) at->second = evaluations_per_step(scene_, who, step, &spent_);
  return at->second;
}

}  // namespace noether
