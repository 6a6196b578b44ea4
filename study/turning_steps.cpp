#include "study/turning_steps.hpp"

#include "engine/bodies.hpp"

#include <cmath>

namespace noether {

std::optional<double> TurningSteps::limit() const {
  return rotor == Rotor::variational ? std::optional(period / (2 * std::acos(-1.0))) : std::nullopt;
}

std::optional<TurningSteps> turning_steps(const Scene& scene) {
  const ParticleSystem<double>& s = scene.particles;
  if (!has_bodies(s) || !scene.hamiltonian.rotating) return {};
  double fastest = 0;
  TurningSteps steps{.rotor = rotor_of(scene)};
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> in_body = spin_in_body<double>(s.column<BodyOrientation>()[i], s.column<BodySpin>()[i]);
    const double rate = std::sqrt(norm2(rate_in_body<double>(in_body, s.column<BodyInertia>()[i])));
    if (!(rate > fastest)) continue;
    fastest = rate;
    steps.body = s.name(i);
  }
  if (!(fastest > 0)) return {};
  steps.period = 2 * std::acos(-1.0) / fastest;
  return steps;
}

}  // namespace noether
