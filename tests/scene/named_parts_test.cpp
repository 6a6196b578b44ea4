// Parts by name and values are those of scenes: the same bits, the same messages.

#include "scene/named_parts.hpp"
#include "engine/simulation.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/refusal.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {
namespace {

using test::refusal_of;

SceneValue values(std::vector<std::pair<std::string, SceneValue>> entries) {
  SceneValue table = SceneValue::table();
  for (auto& [key, value] : entries) table.put(key, std::move(value));
  return table;
}
SceneValue number(double value) { return SceneValue::of(value); }
SceneValue text(const std::string& value) { return SceneValue::of(value); }

const std::string damped_pair = R"(
units = "reduced"
[[particles.body]]
name = "a"
mass = 1
x = [1, 0, 0]
v = [0, 0.5, 0]
[[particles.body]]
name = "b"
mass = 2
x = [-0.5, 0, 0.25]
v = [0, -0.25, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
G = 2
softening = 0.125
[[hamiltonian.force]]
type = "linear_drag"
rate = 0.0625
[integrator]
method = "METHOD"
step = 0.0078125
steps = 200
[[every]]
type = "energy"
steps = 10
)";

Scene scene_of(const std::string& method) {
  std::string scene = damped_pair;
  return read_scene(scene.replace(scene.find("METHOD"), 6, method), "pair.toml");
}

}  // namespace

TEST_CASE("parts by name and values make the run of the scene that names them", "[named]") {
  for (const char* method : {"verlet", "mclachlan_2_s2", "DABAD", "dop853", "gauss_4"}) {
    INFO(method);
    const Scene scene = scene_of(method);
    const auto step = [&](Simulation<double>& sim) {
      return scene.integrator.adaptive() ? sim.run_until(1.5625) : sim.run(200);
    };
    Simulation<double> of_scene = assemble(scene);
    const SceneHamiltonian hamiltonian =
        make_hamiltonian("kinetic_potential", SceneValue::table(),
                         {make_force("gravity", values({{"G", number(2)}, {"softening", number(0.125)}})),
                          make_force("linear_drag", values({{"rate", number(0.0625)}}))});
    SceneIntegrator chosen = make_method(method);
    if (chosen.adaptive()) chosen.classical->options.first = 0.0078125;
    Simulation<double> named(scene.particles, make_integrator(hamiltonian, chosen), clock_of(scene.integrator));
    named.attach(make_monitor("energy"), {.steps = 10});
    REQUIRE(step(of_scene).ok());
    REQUIRE(step(named).ok());
    CHECK(io::digest(named.particles()) == io::digest(of_scene.particles()));
    std::vector<std::optional<double>> last;  // of a run with drag there is no error
    for (Simulation<double>* sim : {&of_scene, &named}) {
      sim->for_each_monitor([&](const std::string&, AnyMonitor<double>& one) {
        if (const auto report = one.report()) last.push_back(report->last);
      });
    }
    REQUIRE(last.size() == 2);
    REQUIRE(last[0].has_value());
    CHECK(last[0] == last[1]);
  }
}

TEST_CASE("values by name have units, particles and kicks as in a scene", "[named]") {
  const UnitSystem& solar = unit_system("solar");
  const NamedFrom in_solar{.units = &solar};
  const SceneForce field = make_force("harmonic_field", values({{"k", text("2 Msun/day^2")}}), in_solar);
  CHECK(to_text(*field.effective.find("k")) == "\"2 Msun/day^2\"");
  CHECK(refusal_of([&] { return make_force("harmonic_field", values({{"k", text("2 kg")}}), in_solar); }) != "");
  const Scene scene = scene_of("verlet");
  const SceneValue bond =
      values({{"k", number(3)},
              {"length", number(1)},
              {"pairs", SceneValue::of(SceneValue::Array{SceneValue::of(SceneValue::Array{text("a"), text("b")})})}});
  const NamedFrom with_particles{.particles = &scene.particles};
  const SceneForce made = make_force("harmonic_bond", bond, with_particles);
  CHECK(made.effective.find("pairs") != nullptr);
  CHECK(refusal_of([&] { return make_force("harmonic_bond", bond); }) ==
        "force 'harmonic_bond' ties particles, which it finds by their names; give the particles with it");
  const SceneForce slow = make_force("gravity", values({{"G", number(1)}, {"kick", text("C")}}));
  CHECK(slow.force.claims().kicks == "C");
  // A composition makes its word of the letters that are there; a word of its own has others.
  const auto over_slow = [&](const char* method) {
    return make_integrator(make_hamiltonian("kinetic_potential", SceneValue::table(), {slow}), make_method(method));
  };
  CHECK_NOTHROW(over_slow("verlet"));
  CHECK(refusal_of([&] { return over_slow("srkn6b"); }) ==
        "scheme 'srkn6b' uses the letter B, but 'kinetic_potential' has only AC");
}

TEST_CASE("what names and values get wrong is told as in a scene", "[named]") {
  CHECK(refusal_of([] { return make_force("gravty"); }) == "unknown force 'gravty'; did you mean 'gravity'?");
  CHECK(refusal_of([] {
          return make_force("gravity", values({{"softning", number(1)}}));
        }) == "unknown key 'softning' in force 'gravity'; did you mean 'softening'?");
  CHECK(refusal_of([] { return make_force("gravity", number(1)); }) ==
        "the values of 'gravity' are a number; a table is expected");
  CHECK(refusal_of([] {
          return make_force("gravity", values({{"type", text("gravity")}}));
        }) == "the values of 'gravity' have the key 'type', which is its name; take it out");
  CHECK(refusal_of([] { return make_monitor("enrgy"); }) == "unknown monitor 'enrgy'; did you mean 'energy'?");
  CHECK(refusal_of([] { return make_hamiltonian("kinetic_potential"); }) ==
        "kinetic_potential has no force, so nothing would move anything; give it one");
  CHECK(refusal_of([] { return make_hamiltonian("wisdom_holman", SceneValue::table(), {make_force("gravity")}); }) ==
        "wisdom_holman already includes gravity; take this force out, or use kinetic_potential");
  CHECK(refusal_of([] { return make_method("dopri853"); }).starts_with("unknown method 'dopri853'"));
  CHECK(refusal_of([] { return make_method("verlet", values({{"rtol", number(1e-9)}})); }) != "");
  CHECK(make_method("dop853", values({{"rtol", number(1e-9)}})).classical->options.rtol == 1e-9);
  CHECK(refusal_of([] { return make_method("dop853", values({{"rtol", number(-1)}})); }) != "");
}

}  // namespace noether
