#pragma once
/// Runs an example as a program and as a scene. A test includes the program's main.cpp with `main` renamed and its call
/// of `run` shortened: the headers it names must have been included before.

#include "io/digest.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

namespace noether {

/// Programs write trajectories: without HDF5 they cannot run.
constexpr bool programs_can_run = NOETHER_HDF5 != 0;

/// Works in a copy of an example's folder, and goes back at the end.
class ExampleFolder {
 public:
  explicit ExampleFolder(const std::string& example) : before_(std::filesystem::current_path()) {
    std::filesystem::copy(std::filesystem::path(NOETHER_SOURCE_DIR) / "examples" / example, scratch_.path());
    std::filesystem::current_path(scratch_.path());
  }
  ExampleFolder(const ExampleFolder&) = delete;
  ExampleFolder& operator=(const ExampleFolder&) = delete;
  ~ExampleFolder() {
    std::error_code ignored;
    std::filesystem::current_path(before_, ignored);
  }

 private:
  test::ScratchFolder scratch_;
  std::filesystem::path before_;
};

/// What a program prints to stdout.
inline std::string output_of(int (*program)()) {
  std::fflush(stdout);
  const int screen = dup(STDOUT_FILENO), file = open("stdout.txt", O_CREAT | O_WRONLY | O_TRUNC, 0600);
  REQUIRE(screen >= 0);
  REQUIRE(file >= 0);
  dup2(file, STDOUT_FILENO);
  close(file);
  const int code = program();
  std::fflush(stdout);
  dup2(screen, STDOUT_FILENO);
  close(screen);
  CHECK(code == 0);
  std::ifstream in("stdout.txt");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The word that begins with "sha256:"; empty if there is none.
inline std::string digest_in(const std::string& output) {
  const std::size_t begin = output.find("sha256:");
  return begin == std::string::npos ? "" : output.substr(begin, output.find_first_of(" \n", begin) - begin);
}

/// The digest after so many steps of a scene.
inline std::string digest_of_scene(std::int64_t steps, const Parts& parts = standard_parts()) {
  Simulation<double> sim = assemble(load_scene("scene.toml", parts));
  CHECK(sim.run(steps).ok());
  return io::digest(sim.particles());
}

/// Program and scene of an example end in the same digest after so many steps.
inline void check_same_digest(const std::string& example, int (*program)(), std::int64_t steps,
                              const Parts& parts = standard_parts()) {
  if (!programs_can_run) return;
  const ExampleFolder folder(example);
  const std::string output = output_of(program);
  INFO(output);
  CHECK(digest_in(output) == digest_of_scene(steps, parts));
  CHECK(digest_in(output).size() == 7 + 64);
  CHECK(output.find("completed at step " + std::to_string(steps)) == 0);
}

/// Runs a scene to its end; what [expect] says holds: `first` and `last` to 1e-12, all other figures as upper bounds.
inline void check_expectations(const std::string& example, const Parts& parts = standard_parts()) {
  const ExampleFolder folder(example);
  const Scene scene = load_scene("scene.toml", parts);
  Simulation<double> sim = assemble(scene);
  REQUIRE(scene.integrator.steps);
  CHECK(sim.run(*scene.integrator.steps).ok());

  std::map<std::string, std::optional<double>> figures;
  sim.for_each_monitor([&](const std::string& name, AnyMonitor<double>& monitor) {
    const auto report = monitor.report();
    if (!report) return;
    figures[name + ".first"] = report->first;
    figures[name + ".last"] = report->last;
    figures[name + ".worst"] = report->worst;
    figures[name + ".rms"] = report->rms;
  });
  CHECK(!scene.expect.empty());
  for (const auto& [key, value] : scene.expect) {
    CAPTURE(key);
    const double* expected = value.get<double>();
    REQUIRE(expected != nullptr);
    REQUIRE(figures[key]);
    const double figure = *figures[key];
    const bool exact = key.ends_with(".first") || key.ends_with(".last");
    if (exact) CHECK(std::abs(figure - *expected) <= 1e-12 * std::max(1.0, std::abs(*expected)));
    if (!exact) CHECK(std::abs(figure) <= *expected);
  }
}

}  // namespace noether
