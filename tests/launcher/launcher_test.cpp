// The launcher, in a tree of its own with a cmake, a ninja and a ctest that only note down how they were called.

#include "tests/support/catch.hpp"
#include "tests/support/process.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <regex>
#include <string>
#include <vector>

namespace noether::test {
namespace {

namespace fs = std::filesystem;

/// Makes what stands in for a tool.
void write_tool(const fs::path& file, const std::string& script) {
  write_text(file, "#!/bin/bash\n" + script);
  fs::permissions(file, fs::perms::owner_all);
}

/// A checkout of three sources, nothing built, on a system where all packages are installed.
struct Checkout : ScratchFolder {
  Checkout() {
    for (const char* folder :
         {"tree/cli", "tree/numbers", "tree/cmake", "tree/docs", "tree/bench", "tree/examples/kepler", "tree/tests/io",
          "tree/tests/forces", "tree/tests/lint", "bin"}) {
      fs::create_directories(path() / folder);
    }
    fs::copy_file(NOETHER_SOURCE_DIR "/noether", tree("noether"));
    fs::copy_file(NOETHER_SOURCE_DIR "/cli/commands.hpp", tree("cli/commands.hpp"));
    fs::copy_file(NOETHER_SOURCE_DIR "/cmake/nightly.py", tree("cmake/nightly.py"));
    fs::create_directories(tree("python"));
    fs::copy_file(NOETHER_SOURCE_DIR "/python/wheel.sh", tree("python/wheel.sh"));
    write_text(tree("CMakeLists.txt"), "noether_library(numbers)\n  noether_library(cli ROOMS numbers)\n");
    write_text(tree("tests/CMakeLists.txt"),
               "  add_test(NAME lint.${name} COMMAND true)\nadd_test(NAME tsan COMMAND)\n");
    for (const char* file :
         {"CMakePresets.json", "cmake/compiler.cmake", "docs/references.bib", "numbers/sums.cpp", "numbers/sums.hpp",
          "bench/CMakeLists.txt", "bench/lj_melt.cpp", "bench/kepler.cpp", "examples/CMakeLists.txt",
          "examples/kepler/scene.toml", "tests/io/files_test.cpp", "tests/forces/gravity_test.cpp", "README.md"}) {
      write_text(tree(file), "\n");
    }
    write_tool(path() / "bin/cmake", R"(echo "cmake $*" >>"$CALLS"
[ -z "${MISCONFIGURED:-}" ] || { echo "CMake Error: no compiler"; exit 1; }
mkdir -p build/release && echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >build/release/CMakeCache.txt
)");
    write_tool(path() / "bin/ninja", R"(echo "ninja ${*:3}" >>"$CALLS"
[ -z "${BROKEN:-}" ] || { echo "FAILED: sums.o"; echo "sums.cpp:1: error: no"; exit 1; }
echo "[0/3] Re-checking globbed directories..."
for k in 1 2 3; do echo "[$k/3] Building CXX object sums.o"; done
[ ! -x "$2/cli/noether" ] || exit 0
mkdir -p "$2/cli"
printf '%s\n' '#!/bin/sh' 'echo "program $*"' >"$2/cli/noether"
chmod +x "$2/cli/noether"
)");
    write_tool(path() / "bin/ctest", R"(case " $* " in *" -N "*) echo "Total Tests: 7" ;; *) echo "ctest ${*:3}" ;; esac
)");
    write_tool(path() / "bin/dpkg-query",
               "[ -n \"${BARE:-}\" ] || [ \"${!#}\" = \"${LACKED:-}\" ] || echo installed\n");
    write_tool(path() / "bin/apt-cache", "exit 0\n");
    write_tool(path() / "bin/sudo", "exec \"$@\"\n");
    write_tool(path() / "bin/apt-get", "echo \"apt-get $*\" >>\"$CALLS\"; exit 1\n");
  }

  fs::path tree(const std::string& name = "") const { return path() / "tree" / name; }

  std::vector<std::string> command(const std::string& line, const std::vector<std::string>& settings = {}) const {
    std::vector<std::string> all{
        "env", "-u", "NOETHER_WERROR", "-u", "NOETHER_UNITY", "-u", "NOETHER_TELL_EVERY", "-u", "NOETHER_PYTHON"};
    all.push_back("PATH=" + (path() / "bin").string() + ":/usr/sbin:/usr/bin:/sbin:/bin");
    all.push_back("CALLS=" + (path() / "calls").string());
    all.insert(all.end(), settings.begin(), settings.end());
    all.insert(all.end(), {"bash", "-c", "exec timeout 60 \"$0\" " + line, tree("noether").string()});
    return all;
  }
  ProcessResult launch(const std::string& line, const std::vector<std::string>& settings = {}) const {
    return run_process(command(line, settings), path());
  }
  std::string calls() const { return fs::exists(path() / "calls") ? read_text(path() / "calls") : ""; }

  /// What cmake and ninja were called for by one more `./noether run`, which must become the program.
  std::string built(const std::vector<std::string>& settings = {}) const {
    fs::remove(path() / "calls");
    const ProcessResult result = launch("run scene.toml", settings);
    INFO(result.err);
    CHECK(result.exit_code == 0);
    CHECK(result.out == "program run scene.toml\n");
    return calls();
  }
  std::string git(const std::string& line) const {
    return run_process({"bash", "-c", "cd tree && git -c user.name=a -c user.email=a@b.c " + line}, path()).out;
  }
};

TEST_CASE("the launcher's help is answered at once: nothing is built, and nothing installed", "[launcher]") {
  const Checkout checkout;
  for (const char* line :
       {"build --help", "test --help", "bench --help", "help build", "help test", "help bench", "test forces -h",
        "wheel --help", "help wheel", "build asan --help", "--help", "-h", "help", "help run", "bench kepler --help"}) {
    const ProcessResult result = checkout.launch(line);
    INFO(line << "\n" << result.out << result.err);
    CHECK(result.exit_code == 0);
    CHECK(result.out.starts_with("Usage: ./noether "));
    CHECK(result.err.empty());
  }
  CHECK(has(checkout.launch("test --help").out, "Folders: forces io lint tsan\n"));
  CHECK(has(checkout.launch("bench --help").out, "Benchmarks: kepler lj_melt\n"));
  const std::string help = checkout.launch("--help").out;
  for (const char* part :
       {"\n  build ", "\n  test ", "\n  bench ", "\n  wheel ", " run ", " explain ", "about eight minutes"}) {
    CHECK(has(help, part));
  }
  CHECK_FALSE(fs::exists(checkout.tree("build")));
  CHECK(checkout.calls().empty());
}

TEST_CASE("what the launcher cannot serve is refused before anything is built", "[launcher]") {
  const Checkout checkout;
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"build relase", "unknown preset 'relase'; did you mean 'release'?"},
      {"build fast", "unknown preset 'fast'; expected one of: release, dev, asan, minimal"},
      {"build dev asan", "build takes one preset, not 'dev asan'; see ./noether build --help"},
      {"test force", "there is no folder of tests 'force'; did you mean 'forces'?"},
      {"test io engine", "there is no folder of tests 'engine'; expected one of: forces, io, lint, tsan"},
      {"test --nigthly", "unknown option '--nigthly' of test; expected one of: --nightly, --failed, --help"},
      {"test --failed", "--failed goes with --nightly: ./noether test --nightly --failed"},
      {"test --nightly --failed io", "--failed cannot be combined with folders; it runs what docs/nightly.md lists"},
      {"bench lj_metl", "unknown benchmark 'lj_metl'; did you mean 'lj_melt'?"},
      {"wheel python3 python3.12", "wheel takes one Python, not 'python3 python3.12'; see ./noether wheel --help"},
      {"wheel python9.9", "there is no Python 'python9.9'; a program is expected, such as python3.12"},
      {"whele", "unknown command 'whele'; did you mean 'wheel'?"},
      {"rnu scene.toml", "unknown command 'rnu'; did you mean 'run'?"},
      {"tset", "unknown command 'tset'; did you mean 'test'?"},
      {"--vresion", "unknown option '--vresion' before a command; did you mean '--version'?"},
  };
  for (const auto& [line, message] : wrong) {
    const ProcessResult result = checkout.launch(line);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(result.err == "noether: " + message + "\n");
  }
  const ProcessResult nothing = checkout.launch("");
  CHECK(nothing.exit_code == 2);
  CHECK(nothing.err.starts_with("Usage: ./noether "));
  CHECK_FALSE(fs::exists(checkout.tree("build")));
  CHECK(checkout.calls().empty());
}

TEST_CASE("where nothing is to be built the launcher takes no lock and calls neither cmake nor ninja", "[launcher]") {
  const Checkout checkout;
  CHECK(checkout.built() == "cmake --preset release\nninja noether\n");
  const fs::path lock = checkout.tree("build/release.lock");
  const Process holder({"flock", lock.string(), "sleep", "120"}, checkout.path());
  REQUIRE(wait_until([&] {
    return run_process({"flock", "-n", lock.string(), "true"}, checkout.path()).exit_code != 0;
  }));
  CHECK(checkout.built() == "");
  CHECK(checkout.launch("version").err.empty());
}

TEST_CASE("whatever may change the program is built again, once, and nothing else", "[launcher]") {
  const Checkout checkout;
  checkout.built();
  const auto again = [&](const char* what, const std::vector<std::string>& settings = {}) {
    INFO(what);
    CHECK(has(checkout.built(settings), "ninja noether\n"));
    CHECK(checkout.built(settings) == "");
  };
  const fs::path source = checkout.tree("numbers/sums.cpp");
  write_text(source, "// longer\n");
  again("a source is edited");
  const auto before = fs::last_write_time(source);
  write_text(source, "// others\n");
  fs::last_write_time(source, before);
  again("a source is replaced, with the time of the old one");
  write_text(checkout.tree("numbers/new.cpp"), "\n");
  fs::create_directories(checkout.tree("numbers/view"));
  again("a source is new");
  write_text(checkout.tree("numbers/view/view.js"), "// shorter\n");
  again("a file of the page of view is edited");
  fs::rename(checkout.tree("numbers/new.cpp"), checkout.tree("numbers/newer.cpp"));
  again("a source has another name");
  fs::remove(checkout.tree("numbers/newer.cpp"));
  again("a source is gone");
  fs::last_write_time(checkout.tree("CMakePresets.json"), fs::file_time_type::clock::now());
  again("the presets are touched");
  again("an option is given", {"NOETHER_WERROR=OFF"});
  again("the option is gone");
  fs::remove(checkout.tree("build/release/cli/noether"));
  again("the program is gone");
  write_text(checkout.tree("build/release/CMakeCache.txt"), "other\n");
  again("the build is configured otherwise");

  fs::create_directories(checkout.tree("numbers/scene.out"));
  write_text(checkout.tree("numbers/scene.out/copy.cpp"), "\n");
  fs::create_directories(checkout.tree("examples/kepler/kepler.out"));
  write_text(checkout.tree("examples/kepler/scene.toml"), "title = \"mine\"\n");
  write_text(checkout.tree("tests/io/files_test.cpp"), "// longer\n");
  write_text(checkout.tree("README.md"), "longer\n");
  CHECK(checkout.built() == "");
}

TEST_CASE("a commit is built again, for the program tells it", "[launcher]") {
  const Checkout checkout;
  if (run_process({"git", "--version"}, checkout.path()).exit_code != 0) {
    WARN("skipped: there is no git");
    return;
  }
  checkout.built();
  checkout.git("init -q");
  write_text(checkout.tree(".gitignore"), "/build/\n");
  checkout.git("add -A");
  for (const char* line : {"commit -q -m one", "commit -q --allow-empty -m two", "reset -q --hard HEAD~1"}) {
    checkout.git(line);
    INFO(line);
    CHECK(has(checkout.built(), "ninja noether\n"));
    CHECK(checkout.built() == "");
  }
}

TEST_CASE("of programs that start together one builds, and the others wait for it", "[launcher]") {
  const Checkout checkout;
  std::vector<std::unique_ptr<Process>> jobs;
  for (int k = 0; k < 5; ++k) jobs.push_back(std::make_unique<Process>(checkout.command("list"), checkout.path()));
  for (const auto& job : jobs) CHECK(job->wait().out == "program list\n");
  CHECK(checkout.calls() == "cmake --preset release\nninja noether\n");
}

TEST_CASE("a build that failed is told, and is tried again", "[launcher]") {
  const Checkout checkout;
  checkout.built();
  write_text(checkout.tree("numbers/sums.cpp"), "no\n");
  for (int k = 0; k < 2; ++k) {
    const ProcessResult result = checkout.launch("run scene.toml", {"BROKEN=1"});
    CHECK(result.exit_code == 4);
    CHECK(has(result.err, "sums.cpp:1: error: no\n"));
    CHECK(has(result.err, "noether: the build of release failed; its whole output is in "));
  }
  CHECK(has(checkout.built(), "ninja noether\n"));
}

TEST_CASE("where packages cannot be installed, or cmake fails, that is told and the code is that of a fault",
          "[launcher]") {
  const Checkout checkout;
  for (const char* line : {"run scene.toml", "build", "test io"}) {
    INFO(line);
    const ProcessResult bare = checkout.launch(line, {"BARE=1"});
    CHECK(bare.exit_code == 4);
    CHECK(bare.out.empty());
    CHECK(has(bare.err, "noether: installing with apt: g++ cmake ninja-build "));
    CHECK(has(bare.err, "noether: apt could not install: g++ cmake ninja-build "));
    CHECK(has(checkout.calls(), "apt-get install -y --no-install-recommends g++ cmake "));
    CHECK_FALSE(has(checkout.calls(), "cmake --preset"));
  }
  for (int k = 0; k < 2; ++k) {
    const ProcessResult result = checkout.launch("run scene.toml", {"MISCONFIGURED=1"});
    CHECK(result.exit_code == 4);
    CHECK(has(result.err, "CMake Error: no compiler\nnoether: cmake failed; its output is above and in "));
    CHECK_FALSE(has(checkout.calls(), "ninja noether"));
  }
  CHECK(has(checkout.built(), "ninja noether\n"));
}

TEST_CASE("a checkout that was copied with its build is configured and built where it now is", "[launcher]") {
  const Checkout checkout;
  checkout.built();
  CHECK(run_process({"cp", "-a", "tree", "original"}, checkout.path()).exit_code == 0);
  fs::remove_all(checkout.tree());
  fs::create_directories(checkout.path() / "elsewhere");
  fs::rename(checkout.path() / "original", checkout.path() / "elsewhere/tree");
  fs::remove(checkout.path() / "calls");
  const auto launch = [&](const fs::path& tree) {
    std::vector<std::string> words = checkout.command("run scene.toml");
    words.back() = (tree / "noether").string();
    const ProcessResult result = run_process(words, checkout.path());
    INFO(result.err);
    CHECK(result.out == "program run scene.toml\n");
    const std::string calls = checkout.calls();
    fs::remove(checkout.path() / "calls");
    return calls;
  };
  const std::string anew = "cmake --preset release --fresh\nninja noether\n";
  CHECK(launch(checkout.path() / "elsewhere/tree") == anew);
  CHECK(launch(checkout.path() / "elsewhere/tree") == "");
  // Back at the old place, where the build was for the new one.
  fs::rename(checkout.path() / "elsewhere/tree", checkout.tree());
  CHECK(launch(checkout.tree()) == anew);
  CHECK(launch(checkout.tree()) == "");
}

TEST_CASE("a build says how far it is: now and then in a pipe, in one line on a terminal", "[launcher]") {
  const Checkout checkout;
  const auto without_times = [](const std::string& text) {  // a busy machine takes longer
    return std::regex_replace(text, std::regex(", [0-9]+ s"), ", 0 s");
  };
  const std::string said = checkout.launch("version", {"NOETHER_TELL_EVERY=0"}).err;
  CHECK(without_times(said) ==
        "noether: configuring release\nnoether: building release: 3 steps\nnoether: building release: 1/3, 0 s\n"
        "noether: building release: 2/3, 0 s\nnoether: building release: 3/3, 0 s\n");
  fs::remove_all(checkout.tree("build"));
  CHECK(checkout.launch("version").err == "noether: configuring release\nnoether: building release: 3 steps\n");

  if (run_process({"script", "--version"}, checkout.path()).exit_code != 0) return;
  write_text(checkout.tree("numbers/sums.cpp"), "// longer\n");
  const std::string terminal = "-qec '" + checkout.tree("noether").string() + " version' /dev/null";
  std::vector<std::string> words = checkout.command("version");
  words.back() = "/usr/bin/script";
  words[words.size() - 2] = "exec timeout 60 \"$0\" " + terminal;
  const std::string shown = without_times(run_process(words, checkout.path()).out);
  INFO(shown);
  CHECK(has(shown, "\r\033[Knoether: building release: 1/3, 0 s\r\033[Knoether: building release: 2/3, 0 s"));
  CHECK(has(shown, "\r\033[Kprogram version"));
}

TEST_CASE("nightly tests run where the bare system of the packages cannot be had", "[launcher]") {
  const Checkout checkout;
  const ProcessResult result = checkout.launch("test --nightly io", {"LACKED=debootstrap"});
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(has(result.err, "noether: apt could not install: debootstrap\n"));
  CHECK(has(result.err, "noether: the packages will be tried in a folder, not on a bare system\n"));
  CHECK(has(result.out, " -L nightly -R ^(io)"));
  const Checkout other;
  CHECK(other.launch("test --nightly io", {"LACKED=ccache"}).exit_code == 4);  // nothing is built without it
}

TEST_CASE("the Python package is built where a virtual environment can be had for it, and left out elsewhere",
          "[launcher]") {
  const Checkout checkout;
  write_text(checkout.tree("python/CMakeLists.txt"), "\n");
  write_tool(checkout.path() / "bin/python3", R"([ "$1 $2" = "-m venv" ] || exec /usr/bin/python3 "$@"
mkdir -p "${!#}/bin"
printf '%s\n' '#!/bin/sh' 'echo "pip $*" >>"$CALLS"' '[ -z "$OFFLINE" ] || { echo no route; exit 1; }' >"${!#}/bin/pip"
printf '%s\n' '#!/bin/sh' 'exit 0' >"${!#}/bin/python"
chmod +x "${!#}"/bin/*
)");
  const ProcessResult offline = checkout.launch("test io", {"OFFLINE=1"});
  CHECK(offline.exit_code == 0);
  CHECK(has(offline.err, "noether: the Python package is left out: no route (all of it is in "));
  CHECK(has(checkout.calls(), "\ncmake --preset release\nninja test_io\n"));
  CHECK(checkout.built() == "ninja noether\n");  // running a scene needs no Python, and asks for none

  fs::remove(checkout.path() / "calls");
  const ProcessResult again = checkout.launch("test io", {"OFFLINE=1"});
  CHECK(has(again.err, "noether: the Python package is left out: no route"));
  CHECK(has(again.err, "to try again before tomorrow: rm build/.no-python\n"));
  CHECK(checkout.calls() == "ninja test_io\n");  // no attempt that would fail as the last one did

  const std::string python = checkout.tree("build/python/bin/python").string();
  const std::string with = "cmake --preset release -U _Python* -DNOETHER_PYTHON:BOOL=ON -DPython_EXECUTABLE=" + python;
  fs::last_write_time(checkout.tree("build/.no-python"), fs::file_time_type::clock::now() - std::chrono::hours(25));
  CHECK(checkout.launch("test io").exit_code == 0);
  CHECK(has(checkout.calls(), "pip install --disable-pip-version-check "));
  CHECK(has(checkout.calls(), with + "\nninja test_io\n"));
  CHECK_FALSE(fs::exists(checkout.tree("build/.no-python")));
  fs::remove(checkout.path() / "calls");
  CHECK(checkout.launch("test io").exit_code == 0);
  CHECK(checkout.calls() == "ninja test_io\n");  // it is there: nothing is asked again

  // Another Python in the place of the one that it was made for: it is made anew, and CMake forgets the old headers.
  fs::rename(python, python + "3.13");
  fs::create_symlink(python + "3.13", python);
  CHECK(checkout.launch("test io").exit_code == 0);
  CHECK(has(checkout.calls(), "pip install --disable-pip-version-check "));
  CHECK(has(checkout.calls(), with + "\nninja test_io\n"));

  // The whole suite has tests of the package, which use more; what cannot be had is named, and asked for again after a
  // day.
  const ProcessResult lacking = checkout.launch("test", {"OFFLINE=1"});
  CHECK(has(lacking.err, "noether: tests that need matplotlib pandas "));
  CHECK_FALSE(has(checkout.launch("test").err, "matplotlib"));
  fs::last_write_time(checkout.tree("build/python/.peers"), fs::file_time_type::clock::now() - std::chrono::hours(25));
  CHECK(
      has(checkout.launch("test").err, "noether: installing what tests of the Python package use: matplotlib pandas "));
  CHECK(has(checkout.calls(), " --timeout 15 matplotlib pandas "));
  CHECK_FALSE(has(checkout.launch("test").err, "matplotlib"));

  fs::remove(checkout.path() / "calls");
  const std::string without = "cmake --preset release -DNOETHER_PYTHON:BOOL=OFF\nninja test_io\n";
  CHECK(checkout.launch("test io", {"NOETHER_PYTHON=OFF"}).exit_code == 0);
  CHECK(checkout.calls() == without);
  CHECK(checkout.launch("test io", {"NOETHER_PYTHON=OFF"}).exit_code == 0);
  CHECK(checkout.calls() == without + "ninja test_io\n");
}

TEST_CASE("a folder's tests are run alone, and only what they need is built", "[launcher]") {
  const Checkout checkout;
  const ProcessResult two = checkout.launch("test tests/forces/ io");
  INFO(two.err);
  CHECK(two.exit_code == 0);
  CHECK(has(checkout.calls(), "ninja test_forces test_io\n"));
  CHECK(two.out == "ctest --output-on-failure -j2 --no-tests=error -LE nightly -R ^(forces|io)(\\.|$)\n");
  CHECK(has(two.err, "noether: running 7 tests\n"));
  CHECK(has(checkout.launch("test forces io").err, "noether: running 7 tests, 0 s the last time\n"));

  const ProcessResult nightly = checkout.launch("test --nightly io");
  CHECK(nightly.exit_code == 0);
  CHECK(lines_of(nightly.out) ==
        std::vector<std::string>{"ctest --output-on-failure -j2 --no-tests=error -LE nightly -R ^(io)(\\.|$)",
                                 "ctest --output-on-failure -j2 --no-tests=error -L nightly -R ^(io)(\\.|$)"});
  CHECK_FALSE(fs::exists(checkout.tree("docs/nightly.md")));

  write_tool(checkout.path() / "bin/ctest",
             "case \" $* \" in *\" -LE \"*) echo 'Total Tests: 0' ;; *' -N '*) "
             "echo 'Total Tests: 1' ;; *) exit 8 ;; esac\n");
  const ProcessResult slow = checkout.launch("test tsan");
  CHECK(slow.exit_code == 2);
  CHECK(has(slow.err, "noether: all tests of tsan are nightly; run ./noether test tsan --nightly\n"));
  CHECK(checkout.launch("test tsan --nightly").exit_code == 1);

  checkout.launch("test");
  CHECK(has(checkout.calls(), "ninja all\n"));
}

TEST_CASE("--nightly --failed runs what the page does not list as passed, and leaves out tests that are gone",
          "[launcher]") {
  const Checkout checkout;
  write_tool(checkout.path() / "bin/ctest", R"(case " $* " in
  *" -N -L nightly ") printf '  Test  #%s\n' '3: cli.nightly' '14: fuzz.scene' '15: package' '7: tsan (Disabled)' ;;
  *" -N "*"-R ^$ "*) echo "Total Tests: 0" ;;
  *" -N "*) echo "Total Tests: 3" ;;
  *" -L nightly "*)
    echo "ctest $*"
    while [ "$1" != --output-junit ]; do shift; done
    printf '<testsuite>%s%s</testsuite>' '<testcase name="package" time="2.5" status="run"><system-out>
tried: unpacked into a folder
both packages work</system-out></testcase>' \
      '<testcase name="fuzz.scene" time="1" status="fail"/>' >"$2"
    exit 8 ;;
esac
)");
  const std::string head = "| test | result | seconds | commit | date |\n|---|---|---|---|---|\n";
  const std::string passed = "| cli.nightly | passed | 9.0 | abc | 2026-01-01 |\n";
  const std::string tsan = "| tsan | passed | 9.0 | abc | 2026-01-01 |\n";
  const auto rows = [&] {
    const std::string page = read_text(checkout.tree("docs/nightly.md"));
    return page.substr(page.find(head) + head.size());
  };
  const std::string gone = "| fuzz.scenes | FAILED | 1.0 | abc | 2026-01-01 |\n";
  write_text(checkout.tree("docs/nightly.md"),
             head + passed + "| fuzz.scene | FAILED | 1.0 | abc | 2026-01-01 |\n" + gone + tsan);
  const ProcessResult failed = checkout.launch("test --nightly --failed");
  INFO(failed.out << failed.err);
  CHECK(failed.exit_code == 1);
  CHECK(has(failed.out, "-L nightly -R ^(fuzz\\.scene|package)$ --output-junit "));
  CHECK(has(failed.err,
            "noether: docs/nightly.md: left out the row of fuzz.scenes, which is not a nightly test any more\n"));
  CHECK(rows().starts_with(passed + "| fuzz.scene | FAILED | 1.0 | "));
  CHECK(has(rows(), "\n| package | passed, unpacked into a folder | 2.5 | "));
  CHECK(rows().ends_with(tsan));
  CHECK_FALSE(has(rows(), "fuzz.scenes"));

  // All that there are have passed; a row of one that is gone is left out, and nothing is run.
  const std::string others = passed + "| fuzz.scene | passed | 1.0 | abc | 2026-01-01 |\n" +
                             "| package | passed, installed on a bare system | 2.0 | abc | 2026-01-01 |\n" + tsan;
  write_text(checkout.tree("docs/nightly.md"), head + gone + others);
  const ProcessResult left = checkout.launch("test --nightly --failed");
  CHECK(left.exit_code == 0);
  CHECK_FALSE(has(left.out, "-L nightly"));
  CHECK(has(left.err, "left out the row of fuzz.scenes"));
  CHECK(rows() == others);
  const ProcessResult none = checkout.launch("test --nightly --failed");
  CHECK(none.exit_code == 2);
  CHECK(has(
      none.err,
      "noether: docs/nightly.md lists every nightly test as passed; ./noether test --nightly runs them all again\n"));
}

}  // namespace
}  // namespace noether::test
