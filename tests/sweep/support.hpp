#pragma once
/// Files as other programs and people write them, read by a scene and evaluated as `noether evaluate` does.

#include "numbers/error.hpp"
#include "scene/evaluate.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace noether::test {

/// What a file is read as, or why it is refused: the message from the name of the file on.
struct Seen {
  Evaluation energy;
  ParticleSystem<double> particles;
  std::vector<std::string> warnings;
  std::string effective, refusal;
};

/// Reads a scene of this text with a file beside it.
inline Seen seen(const std::string& scene_text, const std::string& file, const std::string& content) {
  const ScratchFolder folder;
  if (!file.empty()) write_text(folder / file, content);
  Seen result;
  try {
    const Scene scene = read_scene(scene_text, folder / "scene.toml");
    result.particles = scene.particles;
    result.energy = evaluate(scene);
    result.warnings = scene.warnings;
    result.effective = scene.effective_toml;
  } catch (const Error& error) {
    const std::string message = error.what(), path = (folder / "").string();
    result.refusal = message.starts_with(path) ? message.substr(path.size()) : message;
  }
  return result;
}

/// Whether a number is another one to a relative error.
inline bool near(double found, double expected, double error) {
  return std::abs(found - expected) <= error * std::abs(expected);
}

/// One particle's position and velocity, next to those of another program.
inline bool is_at(const ParticleSystem<double>& s, Index i, const std::array<double, 6>& expected, double error) {
  const Vec3<double> x(expected[0], expected[1], expected[2]), v(expected[3], expected[4], expected[5]);
  return (Vec3<double>(s.positions()[i]) - x).norm() <= error * x.norm() &&
         (Vec3<double>(s.velocities()[i]) - v).norm() <= error * v.norm();
}

/// Gravity among bodies, of these keys of [particles].
inline std::string gravity_scene(const std::string& particles, const std::string& units = "solar") {
  return "units = '" + units + "'\n[particles]\n" + particles +
         "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity'\n[integrator]\nmethod = "
         "'gauss_8'\nuntil = '1 day'\n";
}

inline const std::string argon_parameters = "epsilon = '0.996 kJ/mol'\nsigma = '0.34 nm'\n";

/// A structure under Lennard-Jones forces that end at 0.9 nm.
inline std::string structure_scene(const std::string& file, const std::string& keys = "",
                                   const std::string& parameters = argon_parameters, const std::string& more = "") {
  return "units = 'molecular'\n[particles]\nstructure = '" + file + "'\n" + keys +
         "[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'lennard_jones'\ncutoff = '0.9 nm'\n"
         "cutoff_style = 'plain'\n" +
         parameters + more + "[integrator]\nmethod = 'verlet'\nstep = '1 fs'\nsteps = 1\n";
}

}  // namespace noether::test
