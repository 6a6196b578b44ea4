#pragma once
/// Tops, free bodies and their Hamiltonians, as several tests of rigid bodies use them.

#include "engine/bodies.hpp"
#include "engine/simulation.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity_of_bodies.hpp"
#include "forces/on_sites.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace noether::test {

/// The heavy top A of the studies: I = (2, 1, 2/3), m g = 1, its centre at (0.2, 0.3, 0.5).
inline ParticleSystem<double> heavy_top() {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, top("top", 1, {2, 1, 2. / 3}, {0.2, 0.3, 0.5}), {.spin = Vec3<double>(0.6, -0.4, 0.9)});
  return s;
}

/// Forces on the sites of bodies.
template <class... Fs> ForceField<double> on_sites(const Fs&... forces) {
  ForceField<double> sum, outer;
  (sum.add(forces), ...);
  outer.add(OnSites<double>(std::move(sum)));
  return outer;
}
inline ForceField<double> weight_on_sites(double g = 1) { return on_sites(UniformField{{0, 0, -g}}); }

/// Bodies under forces on themselves.
inline Rotating<AnyHamiltonian<double>> turning(ForceField<double> forces, RotatingOptions options = {}) {
  return Rotating<AnyHamiltonian<double>>(KineticPotential<ForceField<double>>(std::move(forces)), std::move(options));
}

inline Mat3<double> matrix_of(const ParticleSystem<double>& s, Index i = 0) {
  return rotation_matrix<double>(s.column<BodyOrientation>()[i]);
}
inline Vec3<double> in_body_of(const ParticleSystem<double>& s, Index i = 0) {
  return spin_in_body<double>(s.column<BodyOrientation>()[i], s.column<BodySpin>()[i]);
}

}  // namespace noether::test
