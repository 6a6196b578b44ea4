#pragma once
/// What the tests of extreme cases share: runs that must end with a name, and scenes put together in one call.

#include "engine/simulation.hpp"
#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/inspect.hpp"
#include "monitors/monitors.hpp"
#include "tests/cli/support.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

namespace noether::test {

/// Half a unit in the last place of 1: the largest relative error of one operation.
constexpr double rounding = 0x1p-53;

inline bool is_finite(const ParticleSystem<double>& s) {
  for (Index i = 0; i < s.size(); ++i) {
    const Vec3<double> x = s.positions()[i], v = s.velocities()[i];
    if (!x.allFinite() || !v.allFinite()) return false;
  }
  return true;
}

/// Whether a report has numbers only, or says why it has none.
inline bool explains_itself(const MonitorReport& report) {
  for (const auto& figure : {report.first, report.last, report.worst, report.rms}) {
    if (figure && !std::isfinite(*figure) && report.reason.empty()) return false;
  }
  return true;
}

/// A simulation that the monitors of all invariants watch at every step.
struct WatchedRun {
  template <class I>
  WatchedRun(ParticleSystem<double> s, I integrator, double dt, std::int64_t cadence = 1)
      : simulation(std::move(s), std::move(integrator), dt),
        energy(simulation.every(cadence, Energy{})),
        momentum(simulation.every(cadence, Momentum{})),
        angular(simulation.every(cadence, AngularMomentum{})) {}

  Simulation<double> simulation;
  Energy& energy;
  Momentum& momentum;
  AngularMomentum& angular;
};

/// What holds at the end of every run, whatever happened: it has a name, a place in time and a finite state.
inline void check_named_end(Simulation<double>& simulation, const Outcome& outcome, double dt) {
  INFO(to_text(outcome));
  CHECK(outcome.step == simulation.step());
  CHECK(outcome.time == static_cast<double>(outcome.step) * dt);
  CHECK(is_finite(simulation.particles()));
  if (outcome.kind == Outcome::Kind::completed) {
    CHECK(outcome.message.empty());
    return;
  }
  CHECK_FALSE(outcome.message.empty());
  REQUIRE(outcome.particle);
  CHECK(has(outcome.message, outcome.particle->name));
}

/// A scene of the reduced system; every line of `bodies` is a table such as `mass = 1, x = [0, 0, 0], v = [0, 0, 0]`.
struct ExtremeScene {
  std::vector<std::string> bodies;
  std::string hamiltonian = "type = \"kinetic_potential\"\nforce = [{ type = \"gravity\" }]\n";
  std::string method = "verlet";
  double step = 1;
  std::int64_t steps = 0;
  std::string rest = "";  ///< stops and further monitors

  std::string text() const {
    std::string list;
    for (const std::string& body : bodies) list += "  { " + body + " },\n";
    std::string watches;
    for (const char* type : {"energy", "momentum", "angular_momentum"}) {
      watches += fmt::format("[[every]]\ntype = \"{}\"\nsteps = 1\n", type);
    }
    if (NOETHER_HDF5 != 0) watches += "[[every]]\ntype = \"trajectory\"\nsteps = 1\n";
    return fmt::format(
        "units = \"reduced\"\n[particles]\nbody = [\n{}]\n[hamiltonian]\n{}[integrator]\nmethod = \"{}\"\n"
        "step = {}\nsteps = {}\n{}{}",
        list, hamiltonian, method, step, steps, watches, rest);
  }
};

inline const std::string wisdom_holman_table = "type = \"wisdom_holman\"\n";

/// A state as a scene writes it, with all digits.
inline std::string body_text(const ParticleSystem<double>& s, Index i) {
  const Vec3<double> x = s.positions()[i], v = s.velocities()[i];
  return fmt::format("name = \"{}\", mass = {}, x = [{}, {}, {}], v = [{}, {}, {}]", s.name(i), s.masses()[i], x[0],
                     x[1], x[2], v[0], v[1], v[2]);
}

/// Whether a figure that every monitor has is missing from a report of the program.
inline bool lacks_figures(const std::string& json) {
  const std::string monitors = json_member(json, "monitors");
  for (const char* key : {"first", "last", "worst", "rms"}) {
    if (has(monitors, std::string("\"") + key + "\":null")) return true;
  }
  return false;
}

/// Whether all samples in a run's file are finite; the direction of an angular momentum of 0 need not be.
inline bool has_finite_samples(const std::filesystem::path& file) {
  for (const io::MonitorSeries& series : io::read_monitors(file)) {
    for (const auto& [name, quantity] : series.quantities) {
      if (name == "direction_error") continue;
      for (const double value : quantity.second) {
        if (!std::isfinite(value)) return false;
      }
    }
  }
  return true;
}

/// Runs a scene by the program; what it leaves must be whole, and full of numbers if all went well.
inline ProcessResult run_scene(const SceneFolder& folder) {
  const ProcessResult result = noether(folder, "run scene.toml --json");
  INFO(result.out << result.err);
  if (result.exit_code > 1) {
    CHECK(result.err.find('\n') == result.err.size() - 1);  // one line says why
    return result;
  }
  REQUIRE(is_json_line(result.out));
  CHECK(json_member(result.out, "exit_code") == std::to_string(result.exit_code));
  CHECK((json_member(result.out, "message") == "\"\"") == (json_member(result.out, "outcome") == "\"completed\""));
  if (result.exit_code == 0) CHECK_FALSE(lacks_figures(result.out));
  if (NOETHER_HDF5 != 0) {
    const auto file = folder / "scene.out/run.h5";
    const io::FileInfo info = io::verify(file);
    CHECK(info.damaged.empty());
    CHECK(info.complete == (result.exit_code == 0));
    CHECK(info.digest == json_member(result.out, "digest").substr(1, info.digest.size()));
    if (result.exit_code == 0) CHECK(has_finite_samples(file));
  }
  return result;
}

inline std::string outcome_of(const ProcessResult& result) { return json_member(result.out, "outcome"); }

}  // namespace noether::test
