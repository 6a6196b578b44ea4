#pragma once
/// `structure = "file"` of a scene.

#include "engine/particle_system.hpp"
#include "scene/reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace noether {

/// Reads the structure that `[particles]` names, with the keys beside it, and writes the effective table.
/// @param notes  what the files hold and nobody reads is put there, a line each
/// @throws SceneError, FileError
ParticleSystem<double> read_structure_particles(TableReader& reader, const std::filesystem::path& folder,
                                                SceneValue& effective, std::vector<std::string>& notes);

}  // namespace noether
