// Charges in fields: Boris's step beside methods over momenta m v + q A, on one scene.

#include "scene/scene.hpp"
#include "study/compare.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace noether::test {
namespace {

double measured_order(const Comparison& c, const std::string& label) {
  const auto found =
      std::find_if(c.orders.begin(), c.orders.end(), [&](const OrderFit& fit) { return fit.label == label; });
  REQUIRE(found != c.orders.end());
  return found->order.value();
}

TEST_CASE("Boris, Gauss, Tao and an energy-exact method stand side by side on a charge in a field", "[compare]") {
  const std::string text = R"(units = "reduced"
[[particles.body]]
name = "ion"
mass = 1
charge = 1
x = [1.05, 0, 0]
v = [0, 0.2, -0.3]
[hamiltonian]
type = "charged_particles"
rotation = "boris"
canonical = true
[[hamiltonian.field]]
type = "magnetic_gradient"
B0 = 1
gradient = 0.3
[integrator]
method = "verlet_aba"
step = 0.1
steps = 200
)";
  const Scene scene = read_scene(text, "scene.toml");
  CompareOptions options;
  options.methods = {"verlet_aba", "gauss_2", "tao_2", "semiexplicit_2", "avf", "boris_sdc"};
  options.steps = {0.1, 0.05, 0.025};
  options.repeats = 1;
  const Comparison c = compare(scene, options);
  REQUIRE(c.position_measured);
  CHECK(c.rows.size() == 6 * 3);
  for (const Row& row : c.rows) {
    INFO(row.who.label << " " << row.setting.step << " " << row.message);
    CHECK(row.completed());
    CHECK(row.truth_error.value() < 1e-15);
  }
  for (const auto& [label, order] : {std::pair("verlet_aba", 2), std::pair("gauss_2", 4), std::pair("tao_2", 2),
                                     std::pair("semiexplicit_2", 2), std::pair("avf", 2)}) {
    INFO(label);
    CHECK(std::abs(measured_order(c, label) - order) < 0.3);
  }
  // Without the key Gauss's method moves velocities, and boris_sdc always does: the key leaves it alone.
  const auto end_of = [&](const std::string& key, const std::string& method) {
    Simulation<double> sim = assemble(read_scene(text, "scene.toml", standard_parts(),
                                                 {"hamiltonian.canonical=" + key, "integrator.method=" + method}));
    REQUIRE(sim.run(200).ok());
    return Vec3<double>(sim.particles().positions()[0]);
  };
  CHECK(end_of("true", "gauss_2") != end_of("false", "gauss_2"));
  CHECK((end_of("true", "gauss_2") - end_of("false", "gauss_2")).norm() < 1e-5);
  CHECK(end_of("true", "boris_sdc") == end_of("false", "boris_sdc"));
  CHECK(end_of("true", "verlet_aba") == end_of("false", "verlet_aba"));
}

}  // namespace
}  // namespace noether::test
