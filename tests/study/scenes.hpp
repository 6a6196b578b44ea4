#pragma once
/// Small scenes that comparisons are tested on.

#include "scene/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace noether::test {

/// Two bodies about each other, semi-major axis 1, period 2 pi, at pericenter.
inline Scene kepler(double e, const std::string& integrator, const std::vector<std::string>& sets = {}) {
  const double x = 1 - e, v = std::sqrt((1 + e) / (1 - e));
  return read_scene(fmt::format(R"(units = "reduced"
[particles]
frame = "barycenter"
[[particles.body]]
name = "star"
mass = 0.75
x = [0, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "planet"
mass = 0.25
x = [{}, 0, 0]
v = [0, {}, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
{}
)",
                                x, v, integrator),
                    "kepler.toml", standard_parts(), sets);
}

/// One body on a spring, x'' = -x; [integrator] is still to come.
inline const std::string spring = R"(title = "A spring"
units = "reduced"
[particles]
body = [{ name = "bob", mass = 1, x = [1, 0, 0], v = [0, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "harmonic_field"
k = 1
)";

/// The same, perhaps with drag.
inline Scene oscillator(const std::string& integrator, double rate = 0) {
  std::string text = spring;
  if (rate > 0) text += fmt::format("[[hamiltonian.force]]\ntype = \"linear_drag\"\nrate = {}\n", rate);
  return read_scene(text + "[integrator]\n" + integrator + "\n", "spring.toml");
}

/// A star with two planets; [integrator] is still to come.
inline Scene two_planets(const std::string& integrator) {
  return read_scene(R"(units = "reduced"
[particles]
frame = "barycenter"
body = [{ name = "star", mass = 1, x = [0, 0, 0], v = [0, 0, 0] },
        { name = "inner", mass = 1e-3, x = [1, 0, 0], v = [0, 1.02, 0.05] },
        { name = "outer", mass = 5e-4, x = [0, -2.1, 0.1], v = [0.68, 0, 0] }]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
)" + integrator + "\n",
                    "planets.toml");
}

/// The outer Solar System of the examples.
inline Scene outer_solar_system(const std::vector<std::string>& sets = {}) {
  return load_scene(std::string(NOETHER_SOURCE_DIR) + "/examples/outer_solar_system/scene.toml", standard_parts(),
                    sets);
}

}  // namespace noether::test
