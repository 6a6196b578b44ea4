#pragma once
/// Charges for tests: one of mass 1 and charge 1 in reduced units, and fields that are not the library's.

#include "engine/charge.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/composition.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace noether::test {

/// B = R e_z, E = 1e-2 x/R^3 in the plane (HeEtAl2015).
struct RingField {
  template <class Real> void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const {
    using std::sqrt;
    const Real R2 = x[0] * x[0] + x[1] * x[1], R = sqrt(R2);
    field.E = Vec3<Real>(x[0] / Real(100) / (R2 * R), x[1] / Real(100) / (R2 * R), Real(0));
    field.B[2] = R;
    field.A = Vec3<Real>(-R * x[1] / Real(3), R * x[0] / Real(3), Real(0));
    field.phi = Real(1) / Real(100) / R;
  }
};

/// Starts in this field, and of a banana in a tokamak of B0 = 1, R0 = 1.
inline const Vec3<double> ring_x(0, -1, 0), ring_v(0.1, 0.01, 0), banana_x(1.05, 0, 0),
    banana_v(0, 4.816e-4, -2.059e-3);
/// The trap of Winkel and others: wE = 4.9, wB = 25.
inline const PenningTrap trap{.B0 = 25, .gradient = 4.9 * 4.9};

template <class Real = double>
ParticleSystem<Real> one_charge(const Vec3<double>& x, const Vec3<double>& v, double charge = 1, double mass = 1) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add_column<Charge>();
  s.add("charge", mass, x, v);
  s.column<Charge>()[0] = charge;
  return s.as<Real>();
}

/// Charges in fields as scenes have them: over an erased sum.
template <class Field> AnyHamiltonian<double> in_field(Field field, ChargedParticlesOptions options = {}) {
  ForceField<double> forces;
  forces.add(InField(std::move(field)));
  return ChargedParticles<ForceField<double>>(std::move(forces), options);
}

}  // namespace noether::test
