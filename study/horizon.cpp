#include "study/horizon.hpp"

#include "study/candidate.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether {

namespace {

constexpr int moments_of_many = 40;

/// Wall time that the scene's own run takes for a time of its own, measured on a few steps [s/time]; 0: not known.
double own_cost(const Scene& scene, const Sampling& sampling, Allowance& work) {
  Scene alone = scene;
  alone.watches.clear();
  alone.stops.clear();
  Simulation<double> sim = assemble(alone);
  const double before = sim.time();
  const bool ok = scene.integrator.adaptive() ? sim.run_until(sampling.start + 0.01 * sampling.end()).ok()
                                              : sim.run(20).ok();  // the list of neighbors is built once or twice
  const double gone = sim.time() - before;
  work.spent += static_cast<double>(sim.evaluations().force);
  return ok && gone > 0 ? sim.seconds() / gone : 0;
}

}  // namespace

double chaotic_energy_end(const Scene& scene, const Sampling& sampling, double seconds, Allowance& work) {
  const double cost = own_cost(scene, sampling, work);
  const double least = scene.integrator.step > 0 ? 200 * scene.integrator.step : sampling.end() / 64;
  double end = sampling.end();
  while (8 * cost * end > seconds && end / 2 >= least) end /= 2;
  return end;
}

std::string time_in_words(double time, const Scene& scene) {
  return scene.units->is_reduced() ? fmt::format("{:.3g}", time) : fmt::format("{:.3g} {}", time, scene.units->time);
}

std::string tenfold_in_words(const Predictability& motion, const Scene& scene) {
  const std::string time = time_in_words(motion.tenfold(), scene);
  return motion.e_foldings > 0 ? fmt::format("{} (fitted over {:.0f} e-foldings)", time, motion.e_foldings) : time;
}

Horizon affordable_horizon(const Scene& scene, const Sampling& sampling, bool may_shorten, double row_budget,
                           Allowance& work) {
  Horizon horizon{.sampling = sampling};
  if (scene.particles.size() <= most_bodies) return horizon;
  horizon.sampling.samples = moments_of_many;
  double end = sampling.end();
  const double cost = may_shorten ? own_cost(scene, sampling, work) : 0;
  const double least = scene.integrator.step > 0 ? 2 * moments_of_many * scene.integrator.step : end / 64;
  while (8 * cost * end > row_budget && end / 2 >= least) end /= 2;
  if (end < sampling.end()) {
    horizon.told = fmt::format("{} particles are compared over {} of {}, so that each run fits its budget of {:g} s",
                               scene.particles.size(), time_in_words(end, scene), time_in_words(sampling.end(), scene),
                               row_budget);
  }
  horizon.sampling.interval = end / horizon.sampling.samples;
  return horizon;
}

Horizon predictable_horizon(const Scene& scene, const Sampling& sampling, bool may_shorten,
                            const Predictability& motion) {
  Horizon horizon{.sampling = sampling};
  double end = sampling.end();
  if (!motion.chaotic || motion.rounding(end) <= rounding_compared) return horizon;
  const std::string why =
      fmt::format("the motion is chaotic: small differences grow tenfold in {}", tenfold_in_words(motion, scene));
  if (!may_shorten) {
    horizon.told =
        fmt::format("{}, so roundings alone move positions by {:.0e} at the end; --until {} can be compared", why,
                    std::min(motion.rounding(end), 1.0), time_in_words(motion.time_of(growth_compared), scene));
    return horizon;
  }
  const double least = scene.integrator.step > 0 ? 20 * scene.integrator.step : 0;
  while (motion.factor(end) > growth_compared && end / 2 >= least) end /= 2;
  horizon.told = fmt::format("{}, so positions are compared over {} of {}", why, time_in_words(end, scene),
                             time_in_words(sampling.end(), scene));
  horizon.sampling.interval = end / sampling.samples;
  return horizon;
}

}  // namespace noether
