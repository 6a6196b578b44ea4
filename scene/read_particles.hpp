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
/// @param folder  paths in the scene are relative to it
/// @param warnings  gets what is to be said of them before a run
/// @throws SceneError, FileError
ParticleSystem<double> read_particles(const SceneContext& context, const SceneValue& table,
                                      const std::filesystem::path& folder, SceneValue& effective,
                                      std::vector<std::string>& warnings);

/// The moment for which the bodies of a Horizons table hold, "JD 2451545 TDB", as the effective scene has it; empty
/// where there is none.
std::string epoch_of(const SceneValue& effective);

/// Two particles, one of them massive, in exactly one place; empty if there are none.
/// @cost O(n log n)
std::optional<std::pair<Index, Index>> coincident_bodies(const ParticleSystem<double>& s);

}  // namespace noether
