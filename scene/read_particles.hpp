#pragma once
/// The table `[particles]` of a scene.

#include "engine/particle_system.hpp"
#include "scene/reader.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Reads the bodies of a scene, in the frame it asks for, and writes the effective table.
/// @param folder  paths in the scene are relative to it  @param notes  what its files hold and nobody reads, a line
/// each
/// @throws SceneError, FileError
ParticleSystem<double> read_particles(const SceneContext& context, const SceneValue& table,
                                      const std::filesystem::path& folder, SceneValue& effective,
                                      std::vector<std::string>& notes);

/// Two particles, one of them massive, in exactly one place; empty if there are none.
/// @cost O(n log n)
std::optional<std::pair<Index, Index>> coincident_bodies(const ParticleSystem<double>& s);

}  // namespace noether
