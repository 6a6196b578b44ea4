#pragma once
/// What the tests of ensembles share: scenes, and ensembles made in a folder.

#include "study/ensemble.hpp"
#include "study/ensemble_lanes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <cmath>
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

/// The rows of members, made in one call.
inline std::vector<io::EnsembleRow> rows_together(const EnsembleScene& scene,
                                                  const std::vector<std::int64_t>& members) {
  std::vector<io::EnsembleRow> rows;
  for (EnsembleMember& one : run_members(scene, members, true, nullptr)) rows.push_back(std::move(*one.row));
  return rows;
}

/// Each member alone, and in two companies, in other lanes.
inline void check_company(const EnsembleScene& scene, std::int64_t members) {
  for (std::int64_t k = 0; k < members; ++k) {
    CAPTURE(k);
    const io::EnsembleRow alone = rows_together(scene, {k})[0];
    std::vector<std::int64_t> company = {k}, other;
    for (std::int64_t j = 1; j < 8; ++j) company.push_back((k + j) % members);
    for (std::int64_t j = 3; j > 0; --j) other.push_back((k + 5 * j) % members);
    other.push_back(k);
    CHECK(rows_together(scene, company)[0].bytes() == alone.bytes());
    CHECK(rows_together(scene, other)[3].bytes() == alone.bytes());
  }
}

/// The columns of a row whose names begin so.
inline std::vector<double> values_of(const EnsembleScene& scene, const io::EnsembleRow& row, const std::string& begin) {
  std::vector<double> values;
  std::size_t at = scene.definition().keys.size();
  for (const io::EnsembleColumn& column : scene.definition().columns) {
    const auto end = at + static_cast<std::size_t>(column.width());
    for (; at < end; ++at) {
      if (column.name.starts_with(begin)) values.push_back(row.values[at]);
    }
  }
  return values;
}

/// The largest difference at the end between members in lanes and one by one, of positions or of other columns, and
/// that all end alike.
inline double difference(const EnsembleScene& scene, const std::vector<std::int64_t>& members,
                         const std::string& columns = "position") {
  const std::vector<io::EnsembleRow> rows = rows_together(scene, members);
  double most = 0;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const auto alone = run_members(scene, {&members[k], 1}, false, nullptr);
    const io::EnsembleRow& one = *alone[0].row;
    CHECK(rows[k].outcome == one.outcome);
    CHECK(rows[k].step == one.step);
    CHECK(rows[k].particle == one.particle);
    const std::vector<double> here = values_of(scene, rows[k], columns), there = values_of(scene, one, columns);
    REQUIRE_FALSE(here.empty());
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (!std::isnan(there[i])) most = std::max(most, std::abs(here[i] - there[i]));
    }
  }
  return most;
}

/// Among these are near-parabolic arcs, close encounters, and bodies that escape.
inline const std::vector<std::string> near = {"particles.body.c.a=1.15:1.8:4", "particles.body.b.e=0:0.9995:4"};
/// None of that.
inline const std::vector<std::string> calm = {"particles.body.c.a=1.6:2.2:4", "particles.body.c.mass=1e-4:1e-3:2"};

}  // namespace noether::test
