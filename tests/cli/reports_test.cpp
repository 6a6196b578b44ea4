// Hostile text, failed runs, and what explain, describe, convert and plot tell: one line where one line is promised.

#include "numbers/text.hpp"
#include "tests/cli/support.hpp"

#include <string>
#include <vector>

namespace noether::test {
namespace {

TEST_CASE("an error is one line, whatever stands in it", "[cli][messages]") {
  const SceneFolder folder;
  for (const std::string text :
       {"every.a\nb.steps=1", "integrator.a\rb\x1B[2J=1", "integrator.step=\xFF", "ti\ttle.x=1"}) {
    const ProcessResult result =
        run_process({NOETHER_PROGRAM, "run", "scene.toml", "--json", "--set", text}, folder.path());
    INFO(result.err << result.out);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.err) == 1);
    CHECK(escaped(result.err) == result.err.substr(0, result.err.size() - 1) + "\\n");
    CHECK(is_json_line(result.out));
    CHECK(is_utf8(result.out));
    CHECK(json_member(result.out, "file") == "null");
  }
  const ProcessResult file = run_process({NOETHER_PROGRAM, "run", "no\nsuch.toml"}, folder.path());
  CHECK(file.err == "no\\nsuch.toml: cannot be read: No such file or directory\n");
}

TEST_CASE("what is empty or wrong on the command line is called as it was typed", "[cli][messages]") {
  const SceneFolder folder;
  const std::vector<std::pair<std::string, std::string>> lines = {
      {"run scene.toml --until ''",
       "--until: the time is empty; give one, such as \"1 Myr\"; see `noether run --help`"},
      {"run ''", "the name of the scene file is empty; give one, such as scene.toml"},
      {"evaluate ''", "the name of the scene file is empty; give one, such as scene.toml"},
      {"info ''", "file: the name of the file is empty; see `noether info --help`"},
      {"run scene.toml --set integrator.exact=true --until 0.505",
       "--until 0.505: until = \"0.505\" is 50.5 steps of 0.01; the nearest whole numbers are 0.5 (50 steps) and 0.51 "
       "(51 steps)"},
      {"run scene.toml --until later",
       "--until later: until: 'later' does not begin with a number; a time is expected, such as '1'"},
  };
  for (const auto& [line, message] : lines) {
    INFO(line);
    const ProcessResult result = noether(folder, line + " --json");
    CHECK(result.exit_code == 2);
    CHECK(result.err == message + "\n");
    CHECK(is_json_line(result.out));
    CHECK(json_member(result.out, "file") == "null");
  }
  const SceneFolder plain(unwritten);
  const ProcessResult result = noether(plain, "run scene.toml --quiet --until 0.5");
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
}

TEST_CASE("a run that the physics stops says so on stderr, also with --quiet", "[cli][run]") {
  const SceneFolder folder(exploding);
  for (const char* option : {" --quiet", " --json", ""}) {
    INFO(option);
    const ProcessResult result = noether(folder, std::string("run scene.toml --fresh") + option);
    CHECK(result.exit_code == 1);
    CHECK(line_count(result.err) == 1);
    CHECK(result.err.starts_with("diverged"));
    CHECK(has(result.err, "velocity of ball is not finite"));
    CHECK(has(result.out, "not finite") == (std::string(option) == " --json"));  // told once, but to machines
    std::filesystem::remove_all(folder / "scene.out");
  }
}

TEST_CASE("the shadow Hamiltonian reports each order, the best and a verdict, and what it costs", "[cli][run][json]") {
  const SceneFolder folder(unwritten + "[[every]]\ntype = \"shadow_hamiltonian\"\nsteps = 20\norders = [4, 8]\n");
  const std::string json = output(folder, "run scene.toml --json");
  CHECK(has(json, "\"shadow_hamiltonian\":{\"first\":"));
  CHECK(has(json, "\"orders\":[4,8],\"fluctuation\":["));
  CHECK(has(json, "\"best_order\":8,\"verdict\":\"kept"));
  CHECK(has(output(folder, "run scene.toml --out again"), "; kept"));
  CHECK(has(
      output(folder, "explain scene.toml"),
      "\n  monitor shadow_hamiltonian, every 20 steps: 4 products of 6 numbers and the energies of the kicks at each "
      "of 5 steps in 20; keeps 60 numbers\n"));
}

TEST_CASE("the message of a completed run holds no notes", "[cli][run][json]") {
  const SceneFolder folder(unwritten +
                           "[[every]]\ntype = \"elements\"\nsteps = 10\n[[every]]\ntype = "
                           "\"closest_approach\"\nsteps = 10\n");
  const std::string json = output(folder, "run scene.toml --json");
  CHECK(json_member(json, "message") == "\"\"");
  CHECK(has(json, "\"note\":\"six numbers for each particle: see the trajectory file\""));
}

TEST_CASE("explain knows what is inside, what is used again, and when a run is stopped", "[cli][explain]") {
  std::string text = two_bodies;
  text.replace(text.find("kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"gravity\""), 57, "wisdom_holman\"");
  text.replace(text.find("yoshida_4"), 9, "aba_10_6_4");
  const SceneFolder arcs(text +
                         "[[stop]]\ntype = \"escape\"\ndistance = 50\n[[stop]]\ntype = \"collision\"\ndistance = "
                         "0.5\nsteps = 7\n");
  const std::string inside = output(arcs, "explain scene.toml --all");
  CHECK_FALSE(has(inside, "force gravity\n"));
  CHECK_FALSE(has(inside, "order 2"));
  CHECK(has(inside, "\n  force oblateness\n"));
  CHECK(has(inside, "\n  stop escape, beyond 50, every 100 steps\n"));
  CHECK(has(inside, "\n  stop collision, below 0.5, every 7 steps\n"));

  const SceneFolder damped(two_bodies.substr(0, two_bodies.find("[integrator]")) +
                           "[[hamiltonian.force]]\ntype = \"linear_drag\"\nrate = 0.1\n" +
                           two_bodies.substr(two_bodies.find("[integrator]")));
  const std::string drag = output(damped, "explain scene.toml --set integrator.method=verlet");
  CHECK(has(drag, "\n  2 x B: kicks, 1 force evaluation: a kick where nothing has moved uses the forces again\n"));
  CHECK(has(output(damped, "explain scene.toml --json --set integrator.method=verlet"),
            "\"force_evaluations_per_step\":1,"));
  CHECK(has(output(damped, "explain scene.toml --set integrator.method=BABDBAB"),
            "\n  3 x B: kicks, 2 force evaluations:"));
#if NOETHER_HDF5
  const std::string ran = output(damped, "run scene.toml --json --set integrator.method=verlet");
  CHECK(json_member(json_member(ran, "evaluations"), "force") == "101");  // the first kick, and one for each step
#endif
}

TEST_CASE("describe knows quantities, stops, required fields and the letter of drag", "[cli][describe]") {
  const ScratchFolder folder;
  CHECK(has(output(folder, "describe energy"),
            "\n  quantities: total, kinetic, potential [energy], relative_error [1]; with a bath that counts its heat: "
            "conserved "
            "[energy]\n"));
  CHECK(has(output(folder, "describe trajectory"), "\n@article{DeBuyl2014,"));
  CHECK(has(output(folder, "describe oblateness"), "number [length], required, such as \"60330 km\""));
  CHECK(
      has(output(folder, "describe oblateness --json"), R"("required":true,"example":"\"60330 km\"","default":null)"));
  CHECK(has(output(folder, "describe escape"), "\n  steps          whole number [1], default 100"));
  CHECK(output(folder, "describe collision").starts_with("collision (stop): "));
  CHECK(has(output(folder, "describe damped"), "linear_drag"));
  CHECK(has(output(folder, "describe aba_10_6_4"), "\n\n@article{BlanesEtAl2013,"));
  CHECK(has(output(folder, "list monitors"), "\nescape "));
}

#if NOETHER_HDF5

TEST_CASE("convert and plot tell in JSON what they wrote", "[cli][convert][plot][json]") {
  std::string text = two_bodies;
  const SceneFolder folder(text.replace(text.find("Two bodies"), 10, "Two\\nbodies \\u001b'x'"));
  output(folder, "run scene.toml --quiet");
  CHECK(output(folder, "convert scene.out/run.h5 a.csv --json") ==
        "{\"schema\":\"noether.convert/1\",\"frames\":6,\"file\":\"a.csv\"}\n");
  CHECK(output(folder, "explain scene.toml").starts_with("Two bodies  'x': yoshida_4 over"));
  if (run_process({"gnuplot", "--version"}, folder.path()).exit_code != 0) {
    WARN("gnuplot is not installed: nothing is drawn");
    return;
  }
  CHECK(output(folder, "plot scene.out/run.h5 --json") ==
        "{\"schema\":\"noether.plot/1\",\"file\":\"scene.out/run.svg\"}\n");
  const std::string svg = read_text(folder / "scene.out/run.svg");
  CHECK(has(svg, "Two bodies"));
  CHECK_FALSE(has(svg, "\x1B"));
}

#endif

}  // namespace
}  // namespace noether::test
