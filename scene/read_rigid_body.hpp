#pragma once
/// One `[[particles.rigid_body]]`: what a body is made of, and how it turns.

#include "engine/bodies.hpp"
#include "io/body_sites.hpp"
#include "scene/reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace noether {

/// Keys that rigid bodies have beside those of all bodies.
const std::vector<std::string>& rigid_body_keys();

/// A rigid body by `semi_axes`, by `inertia` (with `fixed_point` and `center` a top), or by sites of a file or of
/// tables.
/// @param mass  that the table gives, or its type; 0: none
/// @param types  for sites
/// @param effective  the table as it is kept: sites of a file become tables in it, so that the file is not needed again
/// @throws SceneError
RigidBody read_rigid_body(TableReader& body, const std::string& name, double mass, const std::filesystem::path& folder,
                          const io::SiteTypes& types, SceneValue& effective);

/// Its orientation, and how it turns; places and velocities are not its affair.
/// @throws SceneError
BodyState read_turn(TableReader& body);

}  // namespace noether
