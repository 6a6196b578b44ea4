#pragma once
/// Parts by name and values, without a scene: what bindings for other languages stand on.
///
///     SceneValue values = SceneValue::table();
///     values.put("G", SceneValue::of(1.0));
///     const SceneHamiltonian h =
///         make_hamiltonian("kinetic_potential", SceneValue::table(), {make_force("gravity", values)});
///     Simulation sim(particles, make_integrator(h, make_method("verlet")), Clock<double>::fixed(0, 0.01));
///
/// Values are those that a table of a scene may have, its `type` left out (`noether describe NAME`). What is wrong is
/// told as of a scene, without file and line.

#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace noether {

/// Where names and values are looked up.
struct NamedFrom {
  const Parts* parts = nullptr;  ///< null: those of `standard_parts`
  const UnitSystem* units = &unit_system("reduced");
  /// Whom forces tie by their names, and what forces are checked with; null: only forces on all particles are made.
  const ParticleSystem<double>* particles = nullptr;
};

/// A force; its `force` is one for `ForceField<double>`.
/// @throws SceneError  for a name or a key that nobody knows, or a value that the force refuses
SceneForce make_force(const std::string& name, const SceneValue& values = SceneValue::table(),
                      const NamedFrom& from = {});

/// A monitor, for `Simulation::attach`.
/// @param constraints  those of the run
/// @throws SceneError
AnyMonitor<double> make_monitor(const std::string& name, const SceneValue& values = SceneValue::table(),
                                const NamedFrom& from = {}, const ConstraintSet& constraints = ConstraintSet());

/// A Hamiltonian with these forces; its `make(particles)` is one for compositions.
/// @throws SceneError  for a force that it has in itself, too, or that stands twice where it must not
SceneHamiltonian make_hamiltonian(const std::string& name, const SceneValue& values = SceneValue::table(),
                                  std::vector<SceneForce> forces = {}, const NamedFrom& from = {});

/// A scheme, a word or a method for y' = f, with its options and without a step.
/// @throws SceneError
SceneIntegrator make_method(const std::string& name, const SceneValue& values = SceneValue::table(),
                            const NamedFrom& from = {});

/// The integrator that a scene of this Hamiltonian and this method has, for `Simulation`.
/// @throws SchemeMismatch
AnyIntegrator<double> make_integrator(SceneHamiltonian hamiltonian, SceneIntegrator method);

}  // namespace noether
