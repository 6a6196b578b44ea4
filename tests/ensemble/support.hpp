#pragma once
/// What the tests of ensembles share: scenes, and ensembles made in a folder.

#include "study/ensemble.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether::test {

/// A star and two planets under a Hamiltonian and a method; the outer one may come near the inner one.
inline std::string planets(const std::string& hamiltonian = "type = \"wisdom_holman\"",
                           const std::string& method = "verlet_aba", int steps = 200) {
  return R"(units = "reduced"
[particles]
frame = "barycenter"
[[particles.body]]
name = "Sun"
mass = 1
x = [0, 0, 0]
v = [0, 0, 0]
[[particles.body]]
name = "b"
mass = 1e-3
a = 1
e = 0.05
[[particles.body]]
name = "c"
mass = 1e-3
a = 1.7
e = 0.05
M = 1.5
[hamiltonian]
)" + hamiltonian +
         "\n[integrator]\nmethod = \"" + method + "\"\nstep = 0.1\nsteps = " + std::to_string(steps) + R"(
[[every]]
type = "energy"
steps = 20
[[every]]
type = "elements"
steps = 50
[[stop]]
type = "escape"
distance = 2.4
steps = 10
)";
}

inline EnsemblePlan plan_of(const std::vector<std::string>& texts, std::optional<std::int64_t> draws = {},
                            std::int64_t seed = 0) {
  std::vector<Variation> variations;
  for (const std::string& text : texts) variations.push_back(Variation::parse(text));
  return {std::move(variations), draws, seed};
}

/// The rows of an ensemble of `scene.toml` in a folder, which it writes to `name`.
inline io::EnsembleTable rows_of(const ScratchFolder& folder, const EnsemblePlan& plan, const std::string& name,
                                 EnsembleOptions options = {}) {
  options.out = folder / name;
  const EnsembleReport report = run_ensemble(folder / "scene.toml", plan, options);
  REQUIRE_FALSE(report.interrupted);
  return io::read_ensemble(report.file);
}

/// The rows differ in no bit.
inline void check_same_rows(const std::vector<io::EnsembleRow>& one, const std::vector<io::EnsembleRow>& other) {
  REQUIRE(one.size() == other.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    INFO("row " << k);
    CHECK(one[k].bytes() == other[k].bytes());
  }
}

}  // namespace noether::test
