// Command lines that cannot be served: one line on stderr, to the letter, and the exit code.

#include "tests/cli/support.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace noether::test {
namespace {

struct Wrong {
  const char* line;
  int exit_code;
  std::string message;   ///< the whole line on stderr
  bool has_json = true;  ///< whether --json may be added
};

const std::vector<Wrong> wrong_lines = {
    {"", 2, "no command is given; see `noether --help`"},
    {"rnu scene.toml", 2, "unknown command 'rnu'; did you mean 'run'?"},
    {"integrate scene.toml", 2,
     "unknown command 'integrate'; expected one of: run, evaluate, explain, compare, advise, stability, ensemble, "
     "merge, list, describe, info, verify, convert, frequencies, plot, view, help, version"},
    {"build", 2, "'build' is a command of the launcher in a checkout: ./noether build"},
    {"test forces", 2, "'test' is a command of the launcher in a checkout: ./noether test"},
    {"help rnu", 2, "there is no command 'rnu'; did you mean 'run'?", false},
    {"help yoshida_4", 2,
     "there is no command 'yoshida_4'; `noether describe yoshida_4` describes the method of that name", false},
    {"help run plot", 2, "unexpected argument 'plot' of 'help'", false},
    {"version 2", 2, "unexpected argument '2' of 'version'"},
    {"version --jsn", 2, "unknown option '--jsn' of 'version'; did you mean '--json'?"},
    {"--vresion", 2, "unknown option '--vresion' before a command; did you mean '--version'?"},
    {"-x run scene.toml", 2, "unknown option '-x' before a command; expected one of: --help, --version"},
    {"run", 2, "scene is required; see `noether run --help`"},
    {"run nothing.toml", 3, "nothing.toml: cannot be read: No such file or directory"},
    {"run secne.toml", 3, "secne.toml: cannot be read: No such file or directory; did you mean 'scene.toml'?"},
    {"run .", 3, ".: cannot be read: Is a directory; did you mean './scene.toml'?"},
    {"run table.csv", 2, "table.csv:1: this is not TOML: expected '=', saw ',' (in a key-value pair)"},
    {"run scene.toml other.toml", 2, "unexpected argument 'other.toml' of 'run'"},
    {"run scene.toml --thread 2", 2, "unknown option '--thread' of 'run'; did you mean '--threads'?"},
    {"run scene.toml --threads 0", 2,
     "--threads: '0' is not a valid number of threads; give one from 1 to 65536; see `noether run --help`"},
    {"run scene.toml --threads two", 2,
     "--threads: 'two' is not a valid number of threads; give one from 1 to 65536; see `noether run --help`"},
    {"run scene.toml --threads 1.5", 2,
     "--threads: '1.5' is not a valid number of threads; give one from 1 to 65536; see `noether run --help`"},
    {"run scene.toml --threads 99999999999999999999", 2,
     "--threads: '99999999999999999999' is not a valid number of threads; give one from 1 to 65536; see `noether run "
     "--help`"},
    {"run scene.toml --threads 1 --threads 2", 2, "--threads can be given only once; see `noether run --help`"},
    {"run scene.toml --out", 2, "--out needs a value; see `noether run --help`", false},
    {"run scene.toml --out ''", 2, "--out: the name of the folder is empty; see `noether run --help`"},
    {"run --version", 2,
     "unknown option '--version' of 'run'; expected one of: --help, --out, --threads, --simd, --until, --set, "
     "--resume, --fresh, --cost, --quiet, --json"},
    {"run --foo", 2,
     "unknown option '--foo' of 'run'; expected one of: --help, --out, --threads, --simd, --until, --set, "
     "--resume, --fresh, --cost, --quiet, --json"},
    {"run scene.toml --simd ''", 2, "unknown SIMD level ''; expected one of: base, avx2, avx512"},
    {"run scene.toml --simd avx3", 2, "unknown SIMD level 'avx3'; did you mean 'avx2'?"},
    {"run scene.toml --set integrator.steps", 2,
     "--set integrator.steps: expected key=value, such as integrator.step=\"50 day\""},
    {"run scene.toml --set =3", 2, "--set =3: expected key=value, such as integrator.step=\"50 day\""},
    {"run scene.toml --set integrator.stp=3", 2,
     "--set integrator.stp=3: unknown key 'stp' in [integrator]; did you mean 'step'?"},
    {"run scene.toml --set 'integrator.method=yoshda_4'", 2,
     "--set integrator.method=yoshda_4: unknown method 'yoshda_4'; did you mean 'yoshida_4'?"},
    {"info ''", 2, "file: the name of the file is empty; see `noether info --help`"},
    {"run scene.toml --set every.9.steps=3", 2,
     "--set every.9.steps=3: there is no element 9; the last one is number 3, and every.4={...} adds one"},
    {"run scene.toml --resume --fresh", 2, "--resume excludes --fresh; see `noether run --help`"},
    {"run scene.toml --quiet --json", 2, "--quiet excludes --json; see `noether run --help`"},
    {"run scene.toml --quiet=7", 2, "--quiet takes no value; see `noether run --help`"},
    {"run scene.toml --until later", 2,
     "--until later: until: 'later' does not begin with a number; a time is expected, such as '1'"},
    {"run scene.toml --until ''", 2,
     "--until: the time is empty; give one, such as \"1 Myr\"; see `noether run --help`"},
    {"run scene.toml --until '3 day'", 2,
     "--until 3 day: until: '3 day' has a unit; reduced units are plain numbers, such as '3'"},
    {"run scene.toml --set integrator.exact=true --until 0.505", 2,
     "--until 0.505: until = \"0.505\" is 50.5 steps of 0.01; the nearest whole numbers are "
     "0.5 (50 steps) and 0.51 (51 steps)"},
    {"evaluate scene.toml --forces nowhere/forces.csv", 3, "nowhere/forces.csv: the forces could not be written"},
    {"evaluate scene.toml --forces scene.toml", 2, "the table of forces 'scene.toml' must end in .csv"},
    {"evaluate nothing.toml", 3, "nothing.toml: cannot be read: No such file or directory"},
    {"explain scene.toml --threads 2", 2,
     "unknown option '--threads' of 'explain'; expected one of: --help, --set, --all, --json"},
    {"list", 2, "what is required; see `noether list --help`"},
    {"list forces --measured", 2, "only methods are measured, not forces; leave --measured out"},
    {"list method", 2, "there is no list of 'method'; did you mean 'methods'?"},
    {"list everything", 2,
     "there is no list of 'everything'; expected one of: methods, hamiltonians, forces, fields, thermostats, "
     "constraints, "
     "systems, "
     "decorators, monitors, builders, units"},
    {"describe yoshda_4", 2, "there is nothing called 'yoshda_4'; did you mean 'yoshida_4'?"},
    {"describe qqqqqq", 2, "there is nothing called 'qqqqqq'; see `noether list`"},
#if NOETHER_HDF5
    {"info nothing.h5", 3, "nothing.h5: there is no such file"},
    {"info .", 3, ".: this is not a regular file"},
    {"info scene.toml", 3,
     "scene.toml: this is a scene, and a file of a run is expected; `noether run scene.toml` makes a run of it"},
    {"verify nothing.h5", 3, "nothing.h5: there is no such file"},
    {"convert scene.toml frames.xyz", 3,
     "scene.toml: this is a scene, and a file of a run is expected; `noether run scene.toml` makes a run of it"},
    {"convert scene.toml frames.pdb", 2,
     "cannot convert to 'frames.pdb': unknown extension '.pdb'; expected one of: .xyz, .csv, .vtu"},
    {"convert scene.toml frames.xyz --unwraped", 2,
     "unknown option '--unwraped' of 'convert'; did you mean '--unwrapped'?"},
    {"plot nothing.h5", 3, "nothing.h5: there is no such file"},
#endif
    {"convert run.h5", 2, "out is required; see `noether convert --help`"},
    {"plot ''", 2, "FILE: the name of the file is empty; see `noether plot --help`"},
    {"plot run.h5 --out a.jpg", 2,
     "a picture 'a.jpg' has no supported format; give a name that ends in .svg, .png or .pdf"},
};

/// The message in the JSON of an error.
std::string message_of(const std::string& json) {
  std::string text = json_member(json, "message");
  if (!text.starts_with('"')) return "no message";
  std::erase(text, '\\');
  return text.substr(1, text.size() - 2);
}

TEST_CASE("what cannot be written to the terminal is exit 3, and no crash", "[cli][messages]") {
  const SceneFolder folder;
  const auto shell = [&](const std::string& line) {
    return run_process({"/bin/sh", "-c", std::string(NOETHER_PROGRAM) + " " + line}, folder.path());
  };
  std::vector<std::string> commands = {"list units", "explain scene.toml", "evaluate scene.toml --json", "--help"};
  if (NOETHER_HDF5 != 0) commands.insert(commands.end(), {"run scene.toml", "run scene.toml --fresh --json"});
  for (const std::string& command : commands) {
    INFO(command);
    const ProcessResult result = shell(command + " > /dev/full");
    CHECK(result.exit_code == 3);
    CHECK(result.err == "standard output: no space left on device\n");
    std::filesystem::remove_all(folder / "scene.out");
  }
  CHECK(shell("run --foo 2> /dev/full").exit_code == 2);
  CHECK(shell("run --foo 2>&-").exit_code == 2);
}

TEST_CASE("a name that no file can have is exit 3", "[cli][messages]") {
  const SceneFolder folder;
  const std::string name(300, 'n');
  const ProcessResult result = noether(folder, "run scene.toml --out " + name);
  CHECK(result.exit_code == 3);
  CHECK(result.err == name + ": file name too long\n");
}

TEST_CASE("wrong command lines are told in one line", "[cli][messages]") {
  const SceneFolder folder;
  write_text(folder / "table.csv", "name,mass\n");
  const std::string promised = "| " + std::to_string(wrong_lines.size()) + " command lines |";
  CHECK(has(read_text(std::filesystem::path(NOETHER_SOURCE_DIR) / "docs/promises.md"), promised));
  for (const Wrong& wrong : wrong_lines) {
    INFO("noether " << wrong.line);
    const ProcessResult result = noether(folder, wrong.line);
    CHECK(result.err == wrong.message + "\n");
    CHECK(result.exit_code == wrong.exit_code);
    CHECK_FALSE(std::filesystem::exists(folder / "scene.out"));
    if (words(wrong.line).empty() || words(wrong.line).back() != "--json") CHECK(result.out.empty());
  }
}

TEST_CASE("with --json a wrong command line is told in JSON too", "[cli][messages][json]") {
  const SceneFolder folder;
  write_text(folder / "table.csv", "name,mass\n");
  for (const Wrong& wrong : wrong_lines) {
    if (!wrong.has_json || wrong.line[0] == '\0') continue;
    INFO("noether " << wrong.line << " --json");
    const ProcessResult result = noether(folder, std::string(wrong.line) + " --json");
    INFO(result.out);
    CHECK(result.err == wrong.message + "\n");
    CHECK(result.exit_code == wrong.exit_code);
    CHECK(is_json_line(result.out));
    CHECK(json_member(result.out, "schema") == "\"noether.error/1\"");
    CHECK(json_member(result.out, "exit_code") == std::to_string(wrong.exit_code));
    const std::string message = message_of(result.out);
    CHECK(wrong.message.ends_with(message));
    // What stands before the message is the file, where there is one.
    CHECK((json_member(result.out, "file") == "null") == (message == wrong.message));
  }
}

TEST_CASE("the JSON of an error says where it is", "[cli][messages][json]") {
  const SceneFolder folder;
  std::string text = two_bodies;
  write_text(folder / "scene.toml", text.replace(text.find("step = 0.01"), 11, "stop = 0.01"));
  const ProcessResult result = noether(folder, "run scene.toml --json");
  CHECK(result.exit_code == 2);
  CHECK(result.err == "scene.toml:19: unknown key 'stop' in [integrator]; did you mean 'step'?\n");
  CHECK(result.out ==
        R"({"schema":"noether.error/1","exit_code":2,"file":"scene.toml","line":19,"key":"integrator.stop",)"
        R"("value":"0.01","message":"unknown key 'stop' in [integrator]; did you mean 'step'?"})"
        "\n");
}

#if NOETHER_HDF5

TEST_CASE("files that are cut off are told apart from sound ones", "[cli][messages]") {
  const SceneFolder folder;
  REQUIRE(noether(folder, "run scene.toml --quiet").exit_code == 0);
  const std::string whole = read_text(folder / "scene.out/run.h5");
  write_text(folder / "cut.h5", whole.substr(0, 3000));
  for (const char* line : {"verify cut.h5", "info cut.h5", "convert cut.h5 a.csv", "plot cut.h5"}) {
    INFO(line);
    const ProcessResult result = noether(folder, line);
    CHECK(result.exit_code == 3);
    const bool verified = std::string(line).starts_with("verify");
    CHECK(result.err ==
          "cut.h5: cut short: only 3000 of " + std::to_string(whole.size()) + " bytes are there" +
              (verified ? "; 'noether verify --repair cut.h5' repairs it if only frames or samples are missing\n"
                        : "\n"));
  }
  const ProcessResult plot = noether(folder, "plot scene.out/checkpoint.h5");
  CHECK(plot.exit_code == 2);
  CHECK(plot.err ==
        "scene.out/checkpoint.h5 is a checkpoint, which contains one moment only; plot the run.h5 beside it\n");
  const ProcessResult convert = noether(folder, "convert scene.out/checkpoint.h5 a.csv");
  CHECK(convert.exit_code == 3);
  CHECK(convert.err.starts_with("scene.out/checkpoint.h5: this is not a trajectory of noether: "));
}

#endif

}  // namespace
}  // namespace noether::test
