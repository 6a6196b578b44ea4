#pragma once
/// `structure = "file"` of a scene.

#include "engine/particle_system.hpp"
#include "scene/reader.hpp"

#include <filesystem>

namespace noether {

/// Reads the structure that `[particles]` names, with the keys beside it, and writes the effective table.
/// @throws SceneError, FileError
ParticleSystem<double> read_structure_particles(TableReader& reader, const std::filesystem::path& folder,
                                                SceneValue& effective);

}  // namespace noether
