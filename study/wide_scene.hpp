#pragma once
/// A scene in extended precision.

#include "integrators/vector_field.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <optional>
#include <string>

namespace noether {

/// What a scene is integrated as by y' = f(t, y), in extended precision.
struct WideScene {
  std::unique_ptr<VectorField<Quad>> field = {};       ///< null: there is none
  std::optional<AnyHamiltonian<Quad>> splitting = {};  ///< in its place, of a Hamiltonian that no y' = f tells
  ParticleSystem<Quad> start;                          ///< the run's doubles, widened
  std::string reason = {};                             ///< why there is none
};

/// The motion of a scene in extended precision: all its forces together, those that its Hamiltonian has in itself among
/// them, drag as the force a = -rate v; of a Hamiltonian that is more than forces, the accelerations that it tells; of
/// one that moves columns of its own, the splitting.
/// @throws never  a scene that has none says why
WideScene wide_scene(const Scene& scene);

/// Ends a question that a scene with noise cannot answer.
/// @throws SceneError  if the scene has a bath
void refuse_noise(const Scene& scene);

}  // namespace noether
