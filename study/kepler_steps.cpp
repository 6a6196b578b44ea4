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

/// Time of one turn at the angular speed of the pericenter.
double passage_of(const OrbitalElements<double>& orbit, double mu) {
  const double q = orbit.a * (1 - orbit.e);
  return 2 * M_PI * std::sqrt(q * q * q / (mu * (1 + orbit.e)));
}

/// Moons, and what else goes round another body than the first: bound to it, and within its Hill radius.
void look_at_moons(const ParticleSystem<double>& s, double G, KeplerSteps& found) {
  for (Index j = 1; j < s.size(); ++j) {
    const double m = s.masses()[j];
    if (!(m > 0)) continue;
    const double far2 = norm2(Vec3<double>(s.positions()[j] - s.positions()[0]));
    for (Index i = 1; i < s.size(); ++i) {
      const double of_moon = s.masses()[i];
      if (i == j || of_moon > m || (of_moon == m && i < j)) continue;
      const Vec3<double> x = s.positions()[i] - s.positions()[j];
      const double hill = std::cbrt((m + of_moon) / (3 * s.masses()[0]));
      if (!(norm2(x) < hill * hill * far2)) continue;
      const double mu = G * (m + of_moon);
      const auto orbit = elements_from_state<double>(x, s.velocities()[i] - s.velocities()[j], mu);
      if (!(orbit.a > 0)) continue;
      const std::string name = s.name(i) + " about " + s.name(j);
      keep_shorter(passage_of(orbit, mu), name, found.passage, found.passage_of);
    }
  }
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
    const double a = orbit.a;
    if (a > 0) keep_shorter(2 * M_PI * std::sqrt(a * a * a / mu), s.name(i), found.period, found.period_of);
    keep_shorter(passage_of(orbit, mu), s.name(i), found.passage, found.passage_of);
  }
  look_at_moons(s, G, found);
  if (!(found.passage > 0)) return {};
  return found;
}

}  // namespace noether
