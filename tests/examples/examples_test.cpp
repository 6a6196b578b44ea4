/// Every example, as a program and as a scene: both end in the same bits, do what [expect] says, and print what the
/// README prints.

#include "scene/minimize.hpp"
#include "tests/examples/programs.hpp"
#include "tests/examples/readme.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>

namespace examples {
namespace {

/// How long a whole run takes: below a second, below half a minute, more.
enum class Length : std::uint8_t { quick, slow, nightly };

struct Example {
  std::string name;
  int (*program)();
  Length length;
  Bits bits = Bits::everywhere;
  std::int64_t few_steps = 1000;  ///< enough to tell program from scene; 0: it chooses its steps, and is run whole
  bool twice = true;              ///< else a whole run takes minutes, and the scene alone makes one
};

const std::vector<Example> all = {
    {"accelerator", accelerator::program, Length::quick, Bits::of_this_machine},
    {"alkane_liquid", alkane_liquid::program, Length::slow, Bits::of_this_machine, 100},
    {"argon_crystal", argon_crystal::program, Length::quick, Bits::of_this_machine, 250},
    {"asteroid_binary", asteroid_binary::program, Length::slow, Bits::of_this_machine, 100},
    {"bead_on_wire", bead_on_wire::program, Length::quick, Bits::of_this_machine, 100},
    {"beads_on_sphere", beads_on_sphere::program, Length::quick, Bits::everywhere, 250},
    {"butane", butane::program, Length::nightly, Bits::of_this_machine, 250},
    {"chain", chain::program, Length::quick},
    {"chain_of_10000", chain_of_10000::program, Length::nightly, Bits::everywhere, 10},
    {"cyclohexane", cyclohexane::program, Length::nightly, Bits::of_this_machine, 50},
    {"decane", decane::program, Length::nightly, Bits::of_this_machine, 50},
    {"double_pendulum", double_pendulum::program, Length::quick},
    {"driven_oscillator", driven_oscillator::program, Length::quick, Bits::of_this_machine},
    {"fene_melt", fene_melt::program, Length::quick, Bits::of_this_machine, 100},
    {"fermi_pasta_ulam", fermi_pasta_ulam::program, Length::quick, Bits::everywhere, 100},
    {"figure_eight", figure_eight::program, Length::quick},
    {"heat_line", heat_line::program, Length::quick, Bits::of_this_machine, 0},
    {"heavy_top", heavy_top::program, Length::quick, Bits::of_this_machine},
    {"henon_heiles", henon_heiles::program, Length::quick},
    {"ion_pair", ion_pair::program, Length::nightly, Bits::of_this_machine, 50},
    {"kepler", kepler::program, Length::quick},
    {"kepler_projected", kepler_projected::program, Length::quick},
    {"lj_melt", lj_melt::program, Length::slow, Bits::of_this_machine, 100},
    {"moonlet", moonlet::program, Length::slow, Bits::of_this_machine, 40},
    {"oblate_saturn", oblate_saturn::program, Length::slow, Bits::of_this_machine},
    {"outer_solar_system", outer_solar_system::program, Length::nightly, Bits::everywhere, 4000},
    {"pendulum", pendulum::program, Length::quick},
    {"pendulum_by_its_action", pendulum_by_its_action::program, Length::quick, Bits::of_this_machine, 100},
    {"penning_trap", penning_trap::program, Length::quick, Bits::of_this_machine},
    {"pythagorean", pythagorean::program, Length::nightly, Bits::everywhere, 20'000, false},
    {"rigid_water", rigid_water::program, Length::quick, Bits::of_this_machine, 100},
    {"robertson", robertson::program, Length::quick, Bits::of_this_machine, 0},
    {"saturn_rings", saturn_rings::program, Length::slow, Bits::of_this_machine, 10},
    {"schwarzschild", schwarzschild::program, Length::quick, Bits::of_this_machine},
    {"sleeping_top", sleeping_top::program, Length::quick, Bits::of_this_machine},
    {"sodium_chloride", sodium_chloride::program, Length::nightly, Bits::of_this_machine, 50},
    {"solar_system", solar_system::program, Length::slow},
    {"spce_water", spce_water::program, Length::nightly, Bits::of_this_machine, 20},
    {"spherical_pendulum", spherical_pendulum::program, Length::quick},
    {"spin_orbit", spin_orbit::program, Length::slow, Bits::of_this_machine},
    {"template_project", template_project::program, Length::quick},
    {"tennis_racket", tennis_racket::program, Length::quick, Bits::of_this_machine},
    {"tokamak_banana", tokamak_banana::program, Length::quick, Bits::of_this_machine},
    {"tumbling_block", tumbling_block::program, Length::slow, Bits::of_this_machine, 20},
    {"two_phase_slab", two_phase_slab::program, Length::slow, Bits::of_this_machine, 100},
    {"van_allen", van_allen::program, Length::quick, Bits::of_this_machine},
    {"water_box", water_box::program, Length::nightly, Bits::of_this_machine, 50},
    {"weber_pair", weber_pair::program, Length::quick, Bits::of_this_machine},
};

/// Programs write trajectories: without HDF5 they cannot run.
constexpr bool programs_can_run = NOETHER_HDF5 != 0;

bool has_scene(const std::string& example) { return std::filesystem::exists(folder / example / "scene.toml"); }

noether::Scene scene_of(const std::string& example) {
  noether::Parts parts = noether::standard_parts();
  if (example == "bead_on_wire") parts.add_constraint<OnCycloid>();
  if (example == "beads_on_sphere") parts.add_force<SphereAttraction>();
  if (example == "oblate_saturn") parts.add_force<Oblateness>();
  if (example == "robertson") parts.add_system<Kinetics>();
  return noether::load_scene("scene.toml", parts);
}

/// Works in a copy of an example's folder, and goes back at the end.
class ExampleFolder {
 public:
  explicit ExampleFolder(const std::string& example) : before_(std::filesystem::current_path()) {
    std::filesystem::copy(folder / example, scratch_.path());
    std::filesystem::current_path(scratch_.path());
  }
  ExampleFolder(const ExampleFolder&) = delete;
  ExampleFolder& operator=(const ExampleFolder&) = delete;
  ~ExampleFolder() {
    std::error_code ignored;
    std::filesystem::current_path(before_, ignored);
  }

 private:
  noether::test::ScratchFolder scratch_;
  std::filesystem::path before_;
};

/// What a program prints to stdout, after `steps` steps or at its end.
std::string output_of(int (*program)(), std::optional<std::int64_t> steps = std::nullopt) {
  std::fflush(stdout);
  const int screen = dup(STDOUT_FILENO), file = open("stdout.txt", O_CREAT | O_WRONLY | O_TRUNC, 0600);
  REQUIRE(screen >= 0);
  REQUIRE(file >= 0);
  dup2(file, STDOUT_FILENO);
  close(file);
  shortened = steps;
  const int code = program();
  shortened.reset();
  std::fflush(stdout);
  dup2(screen, STDOUT_FILENO);
  close(screen);
  CHECK(code == 0);
  return noether::test::read_text("stdout.txt");
}

/// What [expect] says of a scene holds: `first` and `last` to 1e-12, all other figures as upper bounds.
void check_expectations(const noether::Scene& scene, const noether::RunReport& report) {
  std::map<std::string, std::optional<double>> figures;
  for (const auto& [name, monitor] : report.monitors) {
    figures[name + ".first"] = monitor.first;
    figures[name + ".last"] = monitor.last;
    figures[name + ".worst"] = monitor.worst;
    figures[name + ".rms"] = monitor.rms;
  }
  CHECK(!scene.expect.empty());
  CHECK(scene.unread.empty());
  for (const auto& [key, value] : scene.expect) {
    CAPTURE(key);
    const auto* const whole = value.get<std::int64_t>();
    REQUIRE((whole != nullptr || value.get<double>() != nullptr));
    const double expected = whole != nullptr ? static_cast<double>(*whole) : *value.get<double>();
    REQUIRE(figures[key]);
    const double figure = *figures[key];
    const bool exact = key.ends_with(".first") || key.ends_with(".last");
    if (exact) CHECK(std::abs(figure - expected) <= 1e-12 * std::max(1.0, std::abs(expected)));
    if (!exact) CHECK(std::abs(figure) <= expected);
  }
}

/// Program and scene of an example, to their ends.
void check_whole(const Example& example) {
  CAPTURE(example.name);
  const auto expected = outputs_in(readme_of(example.name));
  const ExampleFolder copy(example.name);
  REQUIRE(!expected.empty());
  const std::string output = example.twice ? output_of(example.program) : expected[0];
  if (example.twice) CHECK(physics(output, example.bits) == physics(expected[0], example.bits));
  if (!has_scene(example.name)) return;
  REQUIRE(expected.size() == 2);
  const noether::Scene scene = scene_of(example.name);
  const noether::RunReport report = run(scene, {.handle_signals = false});
  CHECK(physics(to_text(report), example.bits) == physics(expected[1], example.bits));
  CHECK(digest_in(output) == report.digest);
  check_expectations(scene, report);
}

void check_whole(Length length) {
  if (!programs_can_run) return;
  for (const Example& example : all) {
    if (example.length == length) check_whole(example);
  }
}

/// The program that reads an example's scene, beside the scene itself.
void check_from_scene(const std::string& example, int (*program)(), Bits bits) {
  if (!programs_can_run) return;
  CAPTURE(example);
  const ExampleFolder copy(example);
  const std::string output = output_of(program);
  CHECK(physics(output, bits) == physics(outputs_in(readme_of(example)).at(1), bits));
  const noether::Scene scene = scene_of(example);
  noether::Simulation<double> sim = assemble(scene);
  const bool in_time = scene.integrator.until.has_value();
  CHECK((in_time ? sim.run_until(*scene.integrator.until) : sim.run(*scene.integrator.steps)).ok());
  CHECK(digest_in(output) == noether::io::digest(sim.particles()));
  CHECK(std::filesystem::exists("scene.out/run.h5"));
}

}  // namespace

TEST_CASE("every example is tested, and has a README that names its scene and shows what both print", "[examples]") {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    // Those without a program are ensembles (ensembles_test.cpp).
    if (std::filesystem::exists(entry.path() / "main.cpp")) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  REQUIRE(names.size() == all.size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& example = names[k];
    CAPTURE(example);
    CHECK(all[k].name == example);
    const std::string readme = readme_of(example);
    CHECK(readme.starts_with("# "));
    if (has_scene(example)) CHECK(readme.find("./noether run examples/" + example + "/scene.toml") != readme.npos);
    const auto outputs = outputs_in(readme);
    CHECK(outputs.size() == (has_scene(example) ? 2 : 1));
    for (const std::string& output : outputs) CHECK(digest_in(output) == digest_in(outputs[0]));
  }
}

TEST_CASE("program and scene of every example end in the same digest", "[examples]") {
  if (!programs_can_run) return;
  for (const Example& example : all) {
    if (!has_scene(example.name) || example.few_steps == 0) continue;
    CAPTURE(example.name);
    const ExampleFolder copy(example.name);
    const std::string output = output_of(example.program, example.few_steps);
    CAPTURE(output);
    CHECK(output.starts_with(fmt::format("completed at step {}", example.few_steps)));
    CHECK(digest_in(output).size() == 7 + 64);
    noether::Scene scene = scene_of(example.name);
    if (scene.minimize) CHECK(minimize_start(scene).converged());
    noether::Simulation<double> sim = assemble(scene);
    CHECK(sim.run(example.few_steps).ok());
    CHECK(digest_in(output) == noether::io::digest(sim.particles()));
  }
}

TEST_CASE("quick examples do what they expect and print what their READMEs print", "[examples]") {
  check_whole(Length::quick);
}
TEST_CASE("slow examples do what they expect and print what their READMEs print", "[examples][slow]") {
  check_whole(Length::slow);
}
TEST_CASE("long examples do what they expect and print what their READMEs print", "[examples][.][nightly]") {
  check_whole(Length::nightly);
}

TEST_CASE("what READMEs say ends by name does", "[examples]") {
  const std::regex row(R"(\n\| `(--set [^|]*)` \| [^\n]*`(overlap|overstretch|diverged)`)");
  const std::regex set(R"(--set ('[^']*'|[^ "`]*"[^"]*"|[^ `]+))");
  int rows = 0;
  for (const Example& example : all) {
    if (!has_scene(example.name)) continue;
    const std::string readme = readme_of(example.name);
    const ExampleFolder copy(example.name);
    for (std::sregex_iterator at(readme.begin(), readme.end(), row), end; at != end; ++at, ++rows) {
      const std::string line = (*at)[1].str();
      CAPTURE(example.name, line);
      std::vector<std::string> sets;
      for (std::sregex_iterator one(line.begin(), line.end(), set); one != end; ++one) {
        const std::string written = (*one)[1].str();  // as for a shell
        sets.push_back(std::regex_replace(written, std::regex(written.starts_with("'") ? "'" : "\""), ""));
      }
      const noether::Scene scene = noether::load_scene("scene.toml", noether::standard_parts(), sets);
      const noether::RunReport report = run(scene, {.existing = noether::Existing::fresh, .handle_signals = false});
      CHECK(noether::name(report.outcome.kind) == (*at)[2].str());
      CHECK(report.exit_code() == 1);
    }
  }
  CHECK(rows >= 3);
}

TEST_CASE("three lines of program run the user's force, constraint or system from the scene file", "[examples]") {
  check_from_scene("bead_on_wire", bead_on_wire_from_scene::program, Bits::of_this_machine);
  check_from_scene("beads_on_sphere", beads_on_sphere_from_scene::program, Bits::everywhere);
  check_from_scene("robertson", robertson_from_scene::program, Bits::of_this_machine);
}
TEST_CASE("three lines of program run the user's force on the moons of Saturn", "[examples][slow]") {
  check_from_scene("oblate_saturn", oblate_saturn_from_scene::program, Bits::of_this_machine);
}

TEST_CASE("a stale figure in a README is seen, times of the machine are not", "[examples]") {
  const auto outputs = outputs_in(readme_of("kepler"));
  REQUIRE(outputs.size() == 2);
  const auto changed = [&](const char* from, const char* to) {
    return physics(std::regex_replace(outputs[1], std::regex(from), to), Bits::everywhere) !=
           physics(outputs[1], Bits::everywhere);
  };
  CHECK(changed("sha256:.", "sha256:x"));
  CHECK(changed("worst .", "worst x"));
  CHECK_FALSE(changed("steps in [^:]*", "steps in 9 s"));
}

}  // namespace examples
