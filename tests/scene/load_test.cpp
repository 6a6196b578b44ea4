// From text to parts: defaults, --set, units, a user's own part, the same bits as a program.

#include "forces/gravity.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "scene/evaluate.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace noether::test {
namespace {

const std::string two_bodies = R"(
units = "solar"
[[particles.body]]
name = "Sun"
mass = "1 Msun"
[[particles.body]]
name = "Earth"
mass = "3e-6 Msun"
x = ["1 au", "0 au", "0 au"]
v = ["0 au/day", "30 km/s", "0 au/day"]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "gravity"
[integrator]
method = "yoshida_4"
step = "5 day"
until = "1000 day"
[[every]]
type = "energy"
every = "100 day"
[[every]]
type = "momentum"
steps = 7
)";

Scene read(const std::string& text, const std::vector<std::string>& sets = {}) {
  return read_scene(text, "scene.toml", standard_parts(), sets);
}

std::string refusal(const std::string& text, const std::vector<std::string>& sets = {}) {
  try {
    read(text, sets);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string digest_of(const Scene& scene) {
  Simulation<double> sim = assemble(scene);
  CHECK(sim.run(*scene.integrator.steps).kind == Outcome::Kind::completed);
  return io::digest(sim.particles());
}

/// The same scene as another language would put it together: no text, no lines.
SceneValue tree_of_two_bodies() {
  const auto text = [](const char* of) { return SceneValue::of(std::string(of)); };
  const auto table = [](SceneValue::Table entries) { return SceneValue::of(std::move(entries)); };
  const auto list = [](SceneValue::Array values) { return SceneValue::of(std::move(values)); };
  const SceneValue sun = table({{"name", text("Sun")}, {"mass", text("1 Msun")}});
  const SceneValue earth = table({{"name", text("Earth")},
                                  {"mass", text("3e-6 Msun")},
                                  {"x", list({text("1 au"), text("0 au"), text("0 au")})},
                                  {"v", list({text("0 au/day"), text("30 km/s"), text("0 au/day")})}});
  const SceneValue gravity = table({{"type", text("gravity")}});
  return table(
      {{"units", text("solar")},
       {"particles", table({{"body", list({sun, earth})}})},
       {"hamiltonian", table({{"type", text("kinetic_potential")}, {"force", list({gravity})}})},
       {"integrator", table({{"method", text("yoshida_4")}, {"step", text("5 day")}, {"until", text("1000 day")}})},
       {"every", list({table({{"type", text("energy")}, {"every", text("100 day")}}),
                       table({{"type", text("momentum")}, {"steps", SceneValue::of(std::int64_t{7})}})})}});
}

TEST_CASE("a scene from a tree of values is the one from text, and its errors name the key", "[scene]") {
  const Scene from_tree = read_scene(tree_of_two_bodies()), from_text = read(two_bodies);
  CHECK(from_tree.effective_toml == from_text.effective_toml);
  CHECK(digest_of(from_tree) == digest_of(from_text));
  SceneValue wrong = tree_of_two_bodies();
  wrong.find("integrator")->put("method", SceneValue::of(std::string("yoshida4")));
  try {
    read_scene(std::move(wrong));
    FAIL("a wrong method was taken");
  } catch (const SceneError& error) {
    CHECK(error.key() == "integrator.method");
    CHECK(error.value() == "\"yoshida4\"");
    CHECK_THAT(std::string(error.what()), Catch::Contains("unknown method 'yoshida4'; did you mean 'yoshida_4'?"));
  }
}

TEST_CASE("a tree of values is held to what texts grant: keys once, UTF-8, no endless depth", "[scene][load]") {
  const auto message = [](const std::function<void(SceneValue&)>& change) {
    SceneValue root = tree_of_two_bodies();
    change(root);
    try {
      read_scene(root);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message([](SceneValue& root) { root.get<SceneValue::Table>()->emplace_back("units", SceneValue::of(true)); }) ==
        "scene: the key 'units' appears twice; give it once");
  CHECK(message([](SceneValue& root) { root.put("title", SceneValue::of(std::string("\xFF"))); }) ==
        "scene: title is not UTF-8; give text in that encoding");
  CHECK(message([](SceneValue& root) {
          SceneValue deep = SceneValue::of(true);
          for (int k = 0; k < 100; ++k) deep = SceneValue::of(SceneValue::Array{deep});
          root.put("expect", deep);
        }).find("more than 64 levels deep") != std::string::npos);
}

TEST_CASE("a scene and a program end in the same digest", "[scene][determinism]") {
  using namespace noether::units::solar;
  ParticleSystem<double> s(unit_system("solar"));
  s.add("Sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("Earth", 3e-6, {1 * au, 0, 0}, {0, 30 * km / second, 0});
  Simulation sim(s, compose(KineticPotential(Gravity{}), schemes::yoshida_4), 5 * day);
  REQUIRE(sim.run_until(1000 * day).ok());
  CHECK(digest_of(read(two_bodies)) == io::digest(sim.particles()));

  Simulation arcs(s, compose(WisdomHolman({.coordinates = Coordinates::democratic}), schemes::verlet_aba), 5 * day);
  REQUIRE(arcs.run_until(1000 * day).ok());
  std::string text = two_bodies;
  text.replace(text.find("kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\""), 57, "wisdom_holman\"");
  CHECK(digest_of(read(text, {"hamiltonian.coordinates=democratic", "integrator.method=verlet_aba"})) ==
        io::digest(arcs.particles()));
}

TEST_CASE("the effective scene holds every default", "[scene]") {
  const std::string toml = read(two_bodies).effective_toml;
  for (const char* line : {"title = \"\"", "frame = \"as_given\"", "softening = \"0 au\"", "compensated = false",
                           "G = 0.0002959122082855911", "method = \"yoshida_4\"", "until = \"1000 day\""}) {
    INFO(line << "\n" << toml);
    CHECK(toml.find(line) != std::string::npos);
  }
}

TEST_CASE("an alias and its scheme are one method in the effective scene", "[scene]") {
  CHECK(read(two_bodies, {"integrator.method=forest_ruth"}).effective_toml == read(two_bodies).effective_toml);
}

TEST_CASE("--set reaches keys by table, index, type and name", "[scene][set]") {
  const Scene scene =
      read(two_bodies, {"title=A new title", "every.1.steps=3", "every.energy.steps=5",
                        "hamiltonian.force.gravity.softening=0.01 au", "particles.body.Earth.mass=\"6e24 kg\"",
                        "particles.body.0.name=Sol", "expect.energy.worst=1e-3", "hamiltonian.G=3e-4",
                        "particles.body.Earth.x=[\"2 au\", \"0 au\", \"0 au\"]"});
  CHECK(scene.title == "A new title");
  CHECK(scene.watches.at(1).cadence.steps == 3);
  CHECK(scene.watches.at(0).cadence.steps == 5);
  CHECK(scene.particles.masses()[1] == 6e24 * units::solar::kg);
  CHECK(scene.particles.name(0) == "Sol");
  CHECK(scene.particles.positions()[1][0] == 2.0);
  CHECK(scene.hamiltonian.G == 3e-4);
  CHECK(scene.effective_toml.find("softening = \"0.01 au\"") != std::string::npos);
  CHECK(scene.expect.at("energy.worst").get<double>() != nullptr);
}

TEST_CASE("--set replaces the key that it excludes", "[scene][set]") {
  CHECK(read(two_bodies, {"integrator.steps=11"}).integrator.steps == 11);
  CHECK(read(two_bodies, {"integrator.steps=11", "integrator.until=50 day"}).integrator.steps == 10);
  CHECK(read(two_bodies, {"every.0.steps=4"}).watches.at(0).cadence.steps == 4);
  CHECK(read(two_bodies, {"every.1.every=50 day"}).watches.at(1).cadence.steps == 10);
}

TEST_CASE("--set replaces lists of tables, and one table, and adds one", "[scene][set]") {
  const auto watched = [](const std::vector<std::string>& sets) {
    std::string names;
    for (const SceneWatch& watch : read(two_bodies, sets).watches) {
      names += fmt::format("{} {}; ", watch.monitor.name, watch.cadence.steps);
    }
    return names;
  };
  const std::string momentum = "{type=\"momentum\", steps=7}";
  CHECK(watched({"every=[" + momentum + "]"}) == "momentum 7; ");
  CHECK(watched({"every=[]"}).empty());
  const std::string before = watched({});
  const auto tables = static_cast<std::size_t>(std::count(before.begin(), before.end(), ';'));
  CHECK(watched({fmt::format("every.{}={}", tables, momentum)}) == before + "momentum 7; ");
  CHECK(watched({"every.0=" + momentum}) == "momentum 7; " + before.substr(before.find("; ") + 2));
  CHECK(watched({"every=[]", "every.0=" + momentum, "every.momentum.steps=8"}) == "momentum 8; ");
}

TEST_CASE("--set with nothing behind the sign takes a key out, or a table of a list", "[scene][set]") {
  const std::vector<std::string> adaptive = {"integrator.method=dop853", "integrator.rtol=1e-9", "integrator.step="};
  CHECK(read(two_bodies, adaptive).effective_toml.find("rtol = 1e-09\n") != std::string::npos);
  std::vector<std::string> without = adaptive;
  without.emplace_back("integrator.rtol=");
  CHECK(read(two_bodies, without).effective_toml.find("rtol = 1e-06\n") != std::string::npos);  // the default
  const auto watches = read(two_bodies).watches.size();
  CHECK(read(two_bodies, {"every.energy="}).watches.size() == watches - 1);
  CHECK(read(two_bodies, {"every.0=", "every.0="}).watches.size() == watches - 2);
  CHECK(read(two_bodies, {"every=[]"}).watches.empty());
  CHECK(read(two_bodies, {"every="}).default_watches);
  CHECK(refusal(two_bodies, {"integrator.stp="}) ==
        "--set integrator.stp=: there is no 'stp' to take out of the scene; did you mean 'step'?");
  CHECK(refusal(two_bodies, {"every.9="}) ==
        "--set every.9=: there is no element 9; the last one is number 1");
  CHECK(refusal(two_bodies, {"integrator.method="}).find("method") != std::string::npos);
}

TEST_CASE("a value of --set is TOML, or else a text", "[scene][set]") {
  CHECK(read(two_bodies, {"integrator.compensated=true"}).integrator.composition.compensated);
  CHECK(read(two_bodies, {"integrator.step=10 day"}).integrator.step == 10);
  CHECK(read(two_bodies, {"integrator.step=\"10 day\""}).integrator.step == 10);
  CHECK(read(two_bodies, {"title=1979-05-27"}).title == "1979-05-27");
  CHECK(refusal(two_bodies, {"title=3"}) == "--set title=3: title = 3 is a whole number; a text in quotes is expected");
}

TEST_CASE("G of the Hamiltonian is the G of its forces and of elements", "[scene]") {
  using namespace noether::units::solar;
  ParticleSystem<double> s(unit_system("solar"));
  s.add("Sun", 1, {0, 0, 0}, {0, 0, 0});
  s.add("Earth", 3e-6, {1 * au, 0, 0}, {0, 30 * km / second, 0});
  Simulation sim(s, compose(KineticPotential(Gravity{.G = 2.9e-4}), schemes::yoshida_4), 5 * day);
  REQUIRE(sim.run(200).ok());
  const std::string digest = digest_of(read(two_bodies, {"hamiltonian.G=2.9e-4"}));
  CHECK(digest == io::digest(sim.particles()));
  CHECK(digest != digest_of(read(two_bodies)));
  // In the force alone it is that of the scene.
  const Scene of_force = read(two_bodies, {"hamiltonian.force.gravity.G=2.9e-4"});
  CHECK(digest == digest_of(of_force));
  CHECK(of_force.hamiltonian.G == 2.9e-4);
  const double* told = of_force.effective.find("hamiltonian")->find("G")->get<double>();
  REQUIRE(told != nullptr);
  CHECK(*told == 2.9e-4);
}

TEST_CASE("an escape is looked for at every step that a method chooses", "[scene][stop]") {
  // a = 1, e = 1/2 from the pericenter: beyond 1.4 from cos E = -4/5 on, back within it before the end.
  const std::string eccentric =
      "units = 'reduced'\n[particles]\n[[particles.body]]\nname = 'S'\nmass = 1\n[[particles.body]]\nname = 't'\n"
      "mass = 0\na = 1\ne = 0.5\n[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = "
      "'gravity'\n";
  const std::string stop = "[[stop]]\ntype = 'escape'\ndistance = 1.4\n";
  const double E = std::acos(-0.8), since = E - 0.5 * std::sin(E);
  for (const std::string method : {"dop853", "gauss_8", "dormand_prince_5"}) {
    CAPTURE(method);
    const Scene scene = read(eccentric + "[integrator]\nmethod = '" + method + "'\nuntil = 30\n" + stop);
    CHECK(scene.stops.at(0).steps == 1);
    Simulation<double> sim = assemble(scene);
    const Outcome outcome = sim.run_until(30);
    REQUIRE(outcome.kind == Outcome::Kind::stopped);
    CHECK(outcome.time < 4);  // it is beyond 1.4 until 2 pi - since = 4.08
    CHECK(std::abs(test::number_after(outcome.message, "since time ") - since) < 1e-3);
  }
  const Scene seldom = read(eccentric + "[integrator]\nmethod = 'dop853'\nuntil = 30\n" + stop + "steps = 7\n");
  CHECK(seldom.stops.at(0).steps == 7);
  CHECK(read(eccentric + "[integrator]\nmethod = 'verlet'\nstep = 0.1\nuntil = 30\n" + stop).stops.at(0).steps == 100);
}

TEST_CASE("a collision is said to leave out pairs of tracers", "[scene][stop]") {
  const auto notes = [](const std::string& third) {
    return read(
               "units = 'reduced'\n[particles]\n[[particles.body]]\nname = 'S'\nmass = 1\n[[particles.body]]\n"
               "name = 't'\nmass = 0\na = 1\n[[particles.body]]\nname = 'u'\nmass = " +
               third +
               "\na = 2\n[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity'\n"
               "[integrator]\nmethod = 'verlet'\nstep = 0.1\nsteps = 2\n[[stop]]\ntype = 'collision'\ndistance = "
               "0.1\n")
        .notes;
  };
  CHECK(notes("1e-6").empty());
  REQUIRE(notes("0").size() == 1);
  CHECK(notes("0")[0].ends_with(
      ":22: pairs of the 2 tracers, whose mass is 0, do not stop the run; give them masses if they may"));
}

TEST_CASE("bodies by elements go round by the G of the force", "[scene]") {
  // Half a turn of a circle in 4 pi^2 = G M takes half a year.
  const std::string circle =
      "units = 'reduced'\n[particles]\n[[particles.body]]\nname = 'S'\nmass = 1.0\n[[particles.body]]\nname = 'p'\n"
      "mass = 1e-3\na = 1.0\n[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\ntype = 'gravity'\n"
      "G = 39.47841760435743\n[integrator]\nmethod = 'gauss_8'\nuntil = 0.5\n";
  Simulation<double> sim = assemble(read(circle));
  REQUIRE(sim.run_until(0.5).ok());
  const ParticleSystem<double>& s = sim.particles();
  const Vec3<double> apart = s.positions()[1] - s.positions()[0];
  CHECK(std::abs(std::sqrt(norm2(apart)) - 1) < 1e-12);
  const std::string watched = "[[every]]\ntype = 'elements'\nevery = 0.5\nG = 1\n";
  CHECK(refusal(circle + watched)
            .ends_with("G = 1 differs from the G = 39.47841760435743 in line 14; a scene has only one gravitational "
                       "constant: give it once, as G in [hamiltonian]"));
  CHECK(refusal(circle + watched, {"hamiltonian.force.0.G="}) == "");
}

TEST_CASE("until is a whole number of steps to 1e-9, and not to 1e-8", "[scene]") {
  const Scene whole = read(two_bodies, {"integrator.until=\"1000.000000004 day\""});
  CHECK(whole.integrator.steps == 200);
  CHECK(whole.notes.empty());
  CHECK(read(two_bodies, {"integrator.until=\"1000.00000005 day\""}).integrator.steps == 201);
  CHECK(refusal(two_bodies, {"integrator.exact=true", "integrator.until=\"1000.00000005 day\""}) ==
        "--set integrator.until=\"1000.00000005 day\": until = \"1000.00000005 day\" is 200.00000001 steps of \"5 "
        "day\"; the "
        "nearest whole numbers are \"1000 day\" (200 steps) and \"1005 day\" (201 steps)");
}

/// Twice a spring, and a choice, as a user writes it.
struct Spring {
  enum class Kind { soft, hard };
  double k = 1;
  Kind kind = Kind::soft;
  std::vector<double> tail;
  std::array<double, 3> center = {0, 0, 0};
  bool twice = false;
  int power = 1;
  std::optional<double> cap;
  std::string label = "none";

  static constexpr auto describe();
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Real strength = Real(k) * (twice ? Real(2) : Real(1)) * (kind == Kind::hard ? Real(10) : Real(1));
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Real> x = s.positions()[i];
      out.force(i, -strength * x);
      out.energy(strength * norm2(x) / Real(2));
    }
  }
};

}  // namespace
}  // namespace noether::test

template <> struct noether::EnumNames<noether::test::Spring::Kind> {
  static constexpr std::array<std::pair<noether::test::Spring::Kind, std::string_view>, 2> values = {
      {{noether::test::Spring::Kind::soft, "soft"}, {noether::test::Spring::Kind::hard, "hard"}}};
};

namespace noether::test {
namespace {

constexpr auto Spring::describe() {
  return part<Spring>("spring", "a user's spring", field<&Spring::k>("k", "mass/time^2"),
                      field<&Spring::kind>("kind", "1"), field<&Spring::tail>("tail", "length"),
                      field<&Spring::center>("center", "length"), field<&Spring::twice>("twice", "1"),
                      field<&Spring::power>("power", "1"), field<&Spring::cap>("cap", "length"),
                      field<&Spring::label>("label", "1"));
}

/// A part that gives particles a column "spin", of which another one means something else.
template <int width> struct Spinner {
  struct Spin {
    template <class Real> using type = RowColumn<Real, width>;
    static constexpr std::string_view name = "spin", dimension = "1";
    static constexpr ColumnRole role = ColumnRole::parameter;
  };
  using columns = ColumnList<Spin>;
  static constexpr auto describe() {
    return part<Spinner>(width == 3 ? "spinner" : "twister", "a force that looks at a column");
  }
  template <class Real> void add_to(ForceSink<Real>&, const ParticleSystem<Real>&) const {}
};

TEST_CASE("two forces whose columns of one name mean different things are refused at the second", "[scene]") {
  Parts parts = standard_parts();
  parts.add_force<Spinner<3>>().add_force<Spinner<4>>();
  std::string text = two_bodies;
  text.replace(text.find("type = \"gravity\""), 16, "type = \"spinner\"\n[[hamiltonian.force]]\ntype = \"twister\"");
  std::string message;
  try {
    read_scene(text, "scene.toml", parts);
  } catch (const SceneError& error) {
    message = error.what();
  }
  CHECK(message.find("scene.toml:") == 0);
  CHECK(message.find("column 'spin' is declared twice, as a parameter of 3 numbers in [1] that start at 0 0 0 and as a "
                     "parameter of 4 numbers") != std::string::npos);
}

TEST_CASE("a user's force is known after one line, with every kind of field", "[scene]") {
  Parts parts = standard_parts();
  parts.add_force<Spring>();
  std::string text = two_bodies;
  text.replace(
      text.find("type = \"gravity\""), 16,
      "type = \"spring\"\nk = \"2 Msun/day^2\"\nkind = \"hard\"\ntail = [\"1 au\", \"2 au\"]\ntwice = true\npower = 3");
  const Scene scene = read_scene(text, "scene.toml", parts, {"integrator.step=0.01 day", "integrator.steps=10"});
  const Evaluation e = evaluate(scene, true);
  CHECK(e.terms.size() == 1);
  CHECK(e.terms.at(0).first == "spring");
  CHECK(e.potential == 20.0);  // 2 x 10 x 2 / 2 at 1 au
  CHECK(*e.gradient_error < 1e-20);
  for (const char* line : {"k = \"2 Msun/day^2\"", "kind = \"hard\"", "tail = [\"1 au\", \"2 au\"]", "twice = true",
                           "power = 3", "center = [\"0 au\", \"0 au\", \"0 au\"]", "label = \"none\""}) {
    INFO(line << "\n" << scene.effective_toml);
    CHECK(scene.effective_toml.find(line) != std::string::npos);
  }
  CHECK(scene.effective_toml.find("cap") == std::string::npos);
  CHECK(refusal(text).find("unknown force 'spring'") != std::string::npos);
  std::string message;
  try {
    read_scene(text, "scene.toml", parts, {"hamiltonian.force.spring.kind=herd"});
  } catch (const SceneError& error) {
    message = error.message();
  }
  CHECK(message ==
        "--set hamiltonian.force.spring.kind=herd: unknown kind 'herd' in force 'spring'; did you mean 'hard'?");
}

TEST_CASE("a part in a scene is described field by field", "[scene]") {
  const PartInfo info = part_info<Spring>();
  REQUIRE(info.fields.size() == 8);
  const std::vector<std::string> kinds = {"number", "choice",       "list",   "vector",
                                          "flag",   "whole number", "number", "text"};
  const std::vector<std::string> defaults = {"1.0", "\"soft\"", "[]", "[0.0, 0.0, 0.0]", "false", "1", "", "\"none\""};
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    CHECK(info.fields[k].kind == kinds[k]);
    CHECK(info.fields[k].default_value == defaults[k]);
  }
  CHECK(info.fields[1].choices == std::vector<std::string>{"soft", "hard"});
}

TEST_CASE("a perfect crystal without forces is no reason to doubt them, nor are many particles", "[scene]") {
  const auto crystal = [](int cells, const std::string& precision) {
    return read(
        fmt::format("units = 'reduced'\n[particles]\ntype = 'lattice'\ncells = [{0}, {0}, {0}]\ndensity = 0.85\n"
                    "mass = 1\n[hamiltonian]\ntype = 'kinetic_potential'\n[[hamiltonian.force]]\n"
                    "type = 'lennard_jones'\ncutoff = 2\nepsilon = 1\nsigma = 1\nprecision = '{1}'\n"
                    "[integrator]\nmethod = 'verlet'\nstep = 0.01\nsteps = 1\n",
                    cells, precision));
  };
  for (const int cells : {2, 5}) {
    Scene scene = crystal(cells, "double");
    CHECK(*evaluate(scene, true).gradient_error < 1e-9);
    CHECK(evaluate(scene, true).gradient_asked == (cells == 2 ? 32 : 16));
    for (Index i = 0; i < scene.particles.size(); i += 3) {
      scene.particles.positions().component(0)[i] += 0.05 * std::sin(static_cast<double>(i));
    }
    CHECK(*evaluate(scene, true).gradient_error < 1e-6);
    Scene mixed = crystal(cells, "mixed");
    mixed.particles = scene.particles;
    const double error = *evaluate(mixed, true).gradient_error;
    CHECK((cells == 2 ? error < 1e-9 : error > 1e-9 && error < 1e-5));  // a few are asked in extended precision
  }
}

TEST_CASE("evaluate adds up the terms of a scene", "[scene]") {
  const Scene scene = read(two_bodies);
  const Evaluation e = evaluate(scene, true);
  const double r = 1, m = 3e-6, v = 30 * units::solar::km / units::solar::second, G = units::solar::G;
  CHECK(e.kinetic == m * (v * v) / 2);
  CHECK(e.potential == -G * 1 * m / r);
  CHECK(e.virial(0, 0) == -e.force_max);
  CHECK(e.virial(1, 1) == 0);
  CHECK(*e.gradient_error < 1e-15);
  CHECK(e.forces[1][0] == -e.force_max);

  std::string text = two_bodies;
  text.replace(text.find("kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\""), 57, "wisdom_holman\"");
  CHECK(evaluate(read(text, {"integrator.method=verlet_aba"})).potential == e.potential);
}

}  // namespace
}  // namespace noether::test
