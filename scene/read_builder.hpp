#pragma once
/// `type = "lattice"` and other builders of `[particles]`.

#include "engine/particle_system.hpp"
#include "scene/fields.hpp"

#include <functional>
#include <vector>

namespace noether {

/// A builder as scenes name it.
struct BuilderKind {
  PartInfo info;
  std::function<ParticleSystem<double>(TableReader&, SceneValue&)>
      build;  ///< reads its fields, keeps the effective ones
};

/// All builders.
const std::vector<BuilderKind>& builders();

/// Reads `type` of `[particles]` and the fields of that builder, and builds the particles.
/// @throws SceneError
ParticleSystem<double> build_particles(TableReader& reader, SceneValue& effective);

}  // namespace noether
