#include "study/kepler_steps.hpp"

#include "engine/orbital_elements.hpp"

#include <cmath>

namespace noether {

namespace {

void keep_shorter(double time, std::string_view name, double& shortest, std::string& of) {
  if (!std::isfinite(time) || !(time > 0) || (shortest > 0 && shortest <= time)) return;
  shortest = time;
  of = name;
}

}  // namespace

std::optional<KeplerSteps> kepler_steps(const Scene& scene) {
  if (!scene.hamiltonian.is_keplerian()) return {};
  KeplerSteps found;
  const ParticleSystem<double>& s = scene.particles;
  const double G = scene.hamiltonian.G.value_or(scene.units->G);
  for (Index i = 1; i < s.size(); ++i) {
    const double mu = G * (s.masses()[0] + s.masses()[i]);
    if (!(mu > 0)) continue;
    const Vec3<double> x = s.positions()[i] - s.positions()[0], v = s.velocities()[i] - s.velocities()[0];
    const auto orbit = elements_from_state<double>(x, v, mu);
    const double a = orbit.a, q = a * (1 - orbit.e);
    if (a > 0) keep_shorter(2 * M_PI * std::sqrt(a * a * a / mu), s.name(i), found.period, found.period_of);
    keep_shorter(2 * M_PI * std::sqrt(q * q * q / (mu * (1 + orbit.e))), s.name(i), found.passage, found.passage_of);
  }
  if (!(found.passage > 0)) return {};
  return found;
}

}  // namespace noether
