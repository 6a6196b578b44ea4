#pragma once
/// What methods sit for: small problems in any precision, and the shortest way to run a method on them.

#include "engine/erasure.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/henon_heiles.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "study/known_method.hpp"

#include <cmath>
#include <memory>
#include <string>

namespace noether::traits {

/// x'' = -x, and until `end` a rough force that no smooth start can follow: it wakes all that a method remembers.
struct ShakenSpring {
  double end = 0;  ///< [time]

  std::string name() const { return "shaken_spring"; }
  static ForceClaims claims() {
    return {.energy = false, .time_dependent = true, .keeps_momentum = false, .keeps_angular_momentum = false};
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    using std::sin;
    const Real t = s.time();
    const Real rough = t < Real(end) ? sin(Real(1e4) * t) : Real(0);
    for (Index i = 0; i < s.size(); ++i) {
      out.acceleration(i, Vec3<Real>(rough - s.positions()[i][0], Real(0), Real(0)));
    }
  }
};

/// A particle of mass 1 in the plane.
inline ParticleSystem<double> one_particle(double x, double y, double u, double v) {
  ParticleSystem<double> s;
  s.add("particle", 1.0, {x, y, 0}, {u, v, 0});
  return s;
}

/// A star and two planets that move as a whole on eccentric, inclined orbits far apart (G = 1).
inline ParticleSystem<double> three_bodies() {
  ParticleSystem<double> s;
  s.add("star", 1.0, {0.01, -0.02, 0.005}, {0.03, 0.01, -0.02});
  s.add("inner", 0.1, {1.0, 0.1, 0.05}, {-0.1, 0.98, 0.08});
  s.add("outer", 0.05, {-0.3, 3.2, -0.2}, {-0.6, 0.05, 0.1});
  return s;
}

template <class Real, class F> ForceField<Real> field_of(F force) {
  return std::move(ForceField<Real>().add(std::move(force)));
}

/// A method over forces, with steps of one length where it has them. All of them are in force fields, whose assemblies
/// the libraries have compiled.
template <class Real> AnyIntegrator<Real> integrator_over(const KnownMethod& known, ForceField<Real> forces) {
  if (known.scheme != nullptr) {
    return compose(AnyHamiltonian<Real>(KineticPotential<ForceField<Real>, Real>(std::move(forces))), *known.scheme);
  }
  MethodOptions options;
  if (known.info->fixed && known.info->adaptive) options.adaptive = false;
  return Classical<Real>(std::make_unique<ForceMotion<ForceField<Real>, Real>>(std::move(forces)),
                         {known.info, options});
}
template <class Real, class F> AnyIntegrator<Real> integrator_of(const KnownMethod& known, const F& force) {
  return integrator_over<Real>(known, field_of<Real>(force));
}

/// A run without the machinery of a simulation: no monitors, no files.
template <class Real> class Walk {
 public:
  /// @param h  step [time]; not looked at where the method chooses its steps
  Walk(AnyIntegrator<Real> integrator, ParticleSystem<Real> start, double h)
      : integrator_(std::move(integrator)), raw_(std::move(start)), settled_(raw_) {
    const bool free = integrator_.claims().clock == ClockMode::free;
    raw_.clock() = free ? Clock<Real>::free(0) : Clock<Real>::fixed(0, h);
    integrator_.bind(raw_);
  }

  /// Goes on for so many steps. @return whether all of them could be made
  bool go(std::int64_t steps) {
    const Advance done = integrator_.advance(raw_, {.steps = steps});
    return done.failure == nullptr && done.steps == steps;
  }
  const ParticleSystem<Real>& particles() {
    integrator_.settle(raw_, settled_, {}, std::nullopt, true);
    return settled_;
  }
  Real energy() { return integrator_.energy(particles()).total(); }
  std::int64_t evaluations() const { return integrator_.evaluations().force; }

 private:
  AnyIntegrator<Real> integrator_;
  ParticleSystem<Real> raw_, settled_;
};

}  // namespace noether::traits
