#pragma once
/// The keys of a scene by their whole paths: "integrator.step", "hamiltonian.force.gravity.softening".

#include "scene/parts.hpp"
#include "scene/value.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// The keys of a scene that stand in no table.
inline constexpr std::array<std::string_view, 12> top_keys = {"title",       "program", "units",    "particles",
                                                              "hamiltonian", "system",  "minimize", "integrator",
                                                              "every",       "stop",    "expect",   "verdict"};

/// Paths as `--set` takes them, of the keys that are written, and of those that the parts and the integrator of the
/// scene have beside them.
std::vector<std::string> key_paths(const SceneValue& scene, const Parts& parts);

/// The keys of a path; quotes hold a key together that has a dot in it.
std::vector<std::string> keys_of_path(std::string_view path);

/// The value at a path as `--set` takes it; null where the scene has none, or several of that name.
const SceneValue* find_path(const SceneValue& scene, std::string_view path);

/// Those paths that a shorter one may mean: they end in its last key, and have the others before it, in order. A last
/// key that other programs have is read as the one there is here: "dt" as "step".
std::vector<std::string> paths_meant(std::string_view given, const std::vector<std::string>& paths);

}  // namespace noether
