"""The lints' own test: each must find what is planted for it and nothing in a clean file."""

import argparse
import json
import pathlib
import tempfile

import headers
import layering
import messages
import named_tests
import part_names
import simd_symbols
import sizes
import sources
import stand_ins
import sums
import text
import words

CLEAN_HEADER = """#pragma once
#include <vector>
/// A thing. @source Author2001, eq. 3
namespace a {
struct Thing {
  int x = 0;
  Thing(int y) : x{y} {}
};
}
"""


def long_function(lines):
    return "int f(int x) {\n" + "  x += 1;\n" * (lines - 3) + "  return x;\n}\n"


def sum_over_particles(before, added):
    return before + "for (Index i = 0; i < s.size(); ++i)\n  " + added + "\n"


# file, content, lint, what the finding must say; "" where the lint must stay silent
SAMPLES = [
    ("engine/a.hpp", '#include "forces/b.hpp"\n', layering.problems, "engine may not include forces"),
    ("io/a.cpp", '#include "forces/b.hpp"\n', layering.problems, "io may not include forces"),
    ("integrators/a.hpp", '#include "io/b.hpp"\n', layering.problems, "integrators may not include io"),
    ("forces/a.hpp", '#include "forces/b_simd.hpp"\n', layering.problems, "is not installed, and this header is"),
    ("engine/a.hpp", '#include "b.hpp"\n', layering.problems, "does not start with a folder"),
    ("engine/a.hpp", '#include "engine/absent.hpp"\n', layering.problems, "there is no file"),
    ("io/a.hpp", "#include <hdf5.h>\n", layering.problems, "HDF5 header"),
    ("tests/a.cpp", "#include <H5public.h>\n", layering.problems, "HDF5 header"),
    ("scene/a.hpp", "#include <toml++/toml.h>\n", layering.problems, "TOML header"),
    ("scene/a.cpp", "#include <CLI/CLI.hpp>\n", layering.problems, "CLI11 header"),
    ("scene/a.cpp", "  #  include <openssl/evp.h>\n", layering.problems, "OpenSSL header"),
    ("forces/a.cpp", "#include <hwy/highway.h>\n", layering.problems, "Highway header"),
    ("forces/a_simd.cpp", '#include "engine/clean.hpp"\n', layering.problems, "code in lanes may include only"),
    ("forces/a_simd.cpp", "#include <hwy/highway.h>\n", layering.problems, ""),
    ("io/a.cpp", '#include <hdf5.h>\n// #include "forces/b.hpp"\n', layering.problems, ""),
    ("forces/a.cpp", '#include "engine/clean.hpp"\n', layering.problems, ""),
    ("engine/clean.cpp", '#include "engine/above.hpp"\n', layering.problems, "includes lead round: "),
    ("engine/clean_impl.hpp", '#include "engine/clean.hpp"\n', layering.problems, ""),
    ("engine/clean_impl_part.hpp", '#include "engine/clean.hpp"\n', layering.problems, ""),
    ("engine/a.cpp", "int x;\n" * 601, sizes.problems, "601 lines"),
    ("engine/a.cpp", "int x;\n" * 600, sizes.problems, ""),
    ("engine/a.cpp", long_function(81), sizes.problems, "'f' has 81 lines"),
    ("engine/a.cpp", long_function(80), sizes.problems, ""),
    ("engine/a.hpp", "namespace n {\nstruct S {\n S() : a{1}, b(2) {\n" + "  ++a;\n" * 80 + "}\nint a, b;\n};\n}\n",
     sizes.problems, "'S' has 82 lines"),
    ("engine/a.cpp", "template <class T>\n  requires C<T>\nauto g(T t) -> int {\n" + "t('}');\n" * 80 + "}\n",
     sizes.problems, "'g' has 84 lines"),
    ("engine/a.cpp", "const auto t = table({\n" + "{1, 2},\n" * 90 + "});\n" + long_function(10), sizes.problems, ""),
    ("tests/a.cpp", 'TEST_CASE("}{", "[a]") {\n' + "  x();\n" * 90 + "}\n", sizes.problems, "'TEST_CASE' has 92 lines"),
    ("tests/lint/exceptions.txt", "sizes engine/clean.hpp a reason\n", sizes.problems, "is within its limit"),
    ("io/a.cpp", 'void f() { throw Error("Cannot open it"); }\n', messages.problems, "starts with a capital"),
    ("io/a.cpp", 'void f() { throw Error(fmt::format("cannot open "\n "{}.", x)); }\n', messages.problems, "full stop"),
    ("io/a.cpp", 'void f() { throw SceneError{file, 3, "cannot open it."}; }\n', messages.problems, "full stop"),
    ("io/a.cpp", 'void f() { NOETHER_EXPECTS(n > 0, "No particles"); }\n', messages.problems, "starts with a capital"),
    ("io/a.cpp", 'void f() { throw Error("\'J2\' is " + x + ", it is wrong"); }\n', messages.problems, ""),
    ("io/a.cpp", 'void f() { throw Error("J2", "HDF5 says no", "unknown: " + a + ". B"); }\n', messages.problems, ""),
    ("io/a.cpp", 'void f() { throw Error("a step of 0 is no step"); }\n', words.problems, '"is no s" in a message'),
    ("io/a.cpp", 'void f() { throw Error("rk4 knows "\n "no noise"); }\n', words.problems, '1: "knows no" in a message'),
    ("cli/a.cpp", 'auto s = "pairs = \\"bonds\\" ties nobody: name them";\n', words.problems, '"nobody" in a message'),
    ("forces/a.hpp", 'f("rate", "1/time", "flows of the drag"); g("it means nothing to it");\n', words.problems, "has no effect"),
    ("tests/scenes/bad/scenes.txt", "= x = 0  #! 'a' and 'b' stand in one place\n", words.problems, '1: "stand in one"'),
    ("io/a.cpp", 'f("there is no step", "x = 0 is no longer right", "`wanted()`", "nobody");  // nobody knows no step\n',
     words.problems, ""),
    ("tests/a.cpp", 'TEST_CASE("nobody is in range") {}\n', words.problems, ""),
    ("cli/a.cpp", 'auto s = R"page(a\nknown are b)page";\n', words.problems, 'a.cpp:2: "known are" in a message'),
    ("noether", 'fail "a preset of 0 is no preset"  # nobody\n', words.problems, '1: "is no p" in a message'),
    ("noether", "# nobody\ncat <<END\nThe program knows no tests.\nEND\n", words.problems, '3: "knows no" in a message'),
    ("cli/view/a.js", "// nobody\nsay(`no one`, 'https://it means nothing to')\n", words.problems, '2: "means nothing to" in'),
    ("cli/view/a.js", "/* nobody */ say('there is no step') // nobody\n", words.problems, ""),
    ("cli/view/a.html", '<p title="what stands still">\n', words.problems, '1: "stands still" in a message'),
    ("cmake/a.cmake", 'message(FATAL_ERROR "${x} is no number")  # nobody\n', words.problems, '1: "is no n" in a message'),
    ("bench/peers/a.py", '"""Nobody, nobody."""\nprint(f"{x} evaluations a step")\n', words.problems, '2: "evaluations a step"'),
    ("bench/peers/a.py", '"""A: nobody."""\nprint(__doc__)\n', words.problems, '1: "nobody" in a message'),
    ("docs/a.md", "It is what\nnobody knows.\n", words.problems, '2: "nobody"; better'),
    ("docs/a.md", "This unit\nis no\nunit.\n", words.problems, '2: "is no u"; better'),
    ("docs/a.md", "```\nknown are\n```\n`nobody`, what is behind it, and there is no unit.\n", words.problems, ""),
    ("engine/a.hpp", "int x;\n", headers.pragma_problems, "no #pragma once"),
    ("engine/a.cpp", "/// @source Nobody1999, table 1\n", sources.problems, "'Nobody1999' is not in"),
    ("engine/a.cpp", "/// @source Author2001 and Nobody1999\n", sources.problems, "'Nobody1999' is not in"),
    ("integrators/a.hpp", 'x = {"name", "Nobody1999", 4};\n', sources.problems, "'Nobody1999' is not in"),
    ("integrators/a.hpp", 'x = {.source = "somebody"};\n', sources.problems, "'somebody' is not in"),
    ("docs/references.bib", "@book{A2001,}\n@book{A2001,}\n", sources.problems, "stands there 2 times"),
    ("docs/claims.md", "| `tests/a_test.cpp` |\n", named_tests.problems, "there is no tests/a_test.cpp"),
    ("docs/claims.md", '| `tests/lint/b_test.cpp` "one", "two" |\n', named_tests.problems, "has no case 'two'"),
    ("docs/promises.md", '| "two" | `tests/lint/b_test.cpp`, `tests/lint`: "one", "a\\|b" |\n', named_tests.problems, ""),
    ("engine/a.cpp", sum_over_particles("double m = 0;\n", "m += s.masses()[i];"), sums.problems, "3: 'm' is summed"),
    ("engine/a.cpp", sum_over_particles("WideSum<double> m;\n", "m += s.masses()[i];"), sums.problems, ""),
    ("io/a.cpp", sum_over_particles("Motion c;\n", "{ if (i > 2) { c.x -= p; } }"), sums.problems, "'c.x' is summed"),
    ("study/a.cpp", sum_over_particles("", "for (int k = 0; k < 3; ++k) v[k] = 0, t += v;"), sums.problems, "'t' is summed"),
    ("scene/a.cpp", "for (std::size_t k = 0; k < n; ++k) p += k * masses[k];\n", sums.problems, "'p' is summed"),
    ("scene/a.cpp", "for (std::size_t k = 0; k < n; ++k) p += k * lags[k];\n", sums.problems, ""),
    ("engine/a.cpp", sum_over_particles("int n = 0;\n", "n += s.masses()[i] > 0 ? 1 : 0;"), sums.problems, ""),
    ("engine/a.cpp", sum_over_particles("", "{ Real t = v[i]; t += 2 * a[i]; x[i] += h * t; }"), sums.problems, ""),
    ("tests/a.cpp", sum_over_particles("", "t += s.masses()[i];"), sums.problems, ""),
    ("integrators/methods/a.cpp", sum_over_particles("", "t += y[i];"), sums.problems, ""),
    ("tests/lint/exceptions.txt", "sums engine/clean.hpp a reason\n", sums.problems, "has no sum over particles"),
    ("engine/a.cpp", "// caf\u00e9\n", text.problems, "not ASCII"),
    ("engine/a.cpp", "//" + "x" * 119 + "\n", text.problems, "121 columns"),
    ("engine/a.cpp", "\tint x;\n", text.problems, "a tab"),
    ("engine/a.cpp", "int x; \n", text.problems, "blanks at the end"),
    ("engine/a.cpp", "// TO" "DO: later\n", text.problems, "finish it"),
    ("cli/a.cpp", 'bool b = name == "pull";\n', part_names.problems, 'a decision by "pull", the name of a part of forces/'),
    ("cli/a.cpp", 'bool b = text_at(f).starts_with("pull");\n', part_names.problems, 'cli/a.cpp:1: a decision by "pull"'),
    ("cli/a.cpp", 'f("pull");  // name == "pull"\n', part_names.problems, ""),
    ("io/no_store.cpp", "int Store::size() const { fail(); }\n", stand_ins.problems, "does not define Store::open, which other"),
    ("io/no_store.cpp", "int Store::size() { fail(); }\nvoid Store::open() { fail(); }\n", stand_ins.problems, ""),
]


def planted(name, content, parts=True):
    """A small clean tree with one file planted in it; without `parts` all that stands there compiles."""
    folder = tempfile.TemporaryDirectory()
    root = pathlib.Path(folder.name)
    tree = {"engine/clean.hpp": CLEAN_HEADER, "engine/above.hpp": '#pragma once\n#include "engine/clean.hpp"\n',
            "docs/references.bib": "@article{Author2001,\n}\n",
            "tests/lint/b_test.cpp": 'TEST_CASE("o" "ne") {}\nTEST_CASE("a|b",\n "[x]") {}\n', name: content}
    if parts:
        tree["scene/parts.cpp"] = "auto p = [] { parts.add_force<Pull>(); };\n"
        tree["forces/pull.hpp"] = '#pragma once\ninline auto d = part<Pull>("pull", "pulls", name == "pull");\n'
        tree["io/store.hpp"] = "#pragma once\nclass Store {\n public:\n  int size();\n  void open();\n\n private:\n  void fill();\n};\n"
        tree["io/store.cpp"] = "int Store::size() {}\nvoid Store::open() {}\nvoid Store::fill() {}\n"
    for path, text_of_file in tree.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text_of_file)
    return folder


def failures():
    for name, content, lint, expected in SAMPLES:
        with planted(name, content) as root:
            found = lint(root)
            if (expected and not any(expected in problem for problem in found)) or (not expected and found):
                yield f"{lint.__module__}: planted {content[:60]!r}, expected {expected!r}, found {found}"


def compiler_failures(compiler):
    for name in ("engine/bad.hpp", "engine/bad.cpp"):
        with planted(name, "#pragma once\ninline std::vector<int> f() { return {}; }\n", parts=False) as root:
            found = headers.compile_problems(root, compiler, [])
            if len(found) != 1 or f"{name}: does not compile alone" not in found[0]:
                yield f"headers: planted {name}, which lacks <vector>, found {found}"
    # What has compiled is tried again when what it includes has changed, what has not compiled every time.
    with planted("engine/bad.hpp", "#pragma once\ninline std::vector<int> f() { return {}; }\n", parts=False) as root:
        passed = pathlib.Path(root) / "passed.json"
        found = [headers.compile_problems(root, compiler, [], passed) for _ in range(2)]
        (pathlib.Path(root) / "engine/clean.hpp").write_text("#pragma once\ninline std::vector<int> g() { return {}; }\n")
        found.append(headers.compile_problems(root, compiler, [], passed))
        if [len(one) for one in found] != [1, 1, 3]:
            yield f"headers: with what has passed, found {found}"
        if headers.compile_problems(root, "/bin/true", [], passed) or len(json.loads(passed.read_text())) != 3:
            yield "headers: what has passed is not written"
        tried = pathlib.Path(root) / "tried"
        (pathlib.Path(root) / "compiler").write_text(f"#!/bin/sh\n[ $# = 1 ] && exit\necho >>{tried}\n")
        (pathlib.Path(root) / "compiler").chmod(0o755)
        for _ in range(2):
            headers.compile_problems(root, f"{root}/compiler", [], passed)
        if tried.read_text().count("\n") != 3:
            yield "headers: what has passed is tried again"


def symbol_failures():
    symbols = """0000000000000000 T noether::avx2::f()
0000000000000010 W noether::avx2::g<int>()
                 w __gmon_start__
0000000000000020 W int const& std::max<int>(int const&, int const&)
0000000000000030 V guard variable for noether::avx2::f()::x
0000000000000040 W noether::base::h()
"""
    found = simd_symbols.problems_of(symbols, "avx2")
    if [problem.split("'")[1] for problem in found] != ["__gmon_start__", "int const& std::max<int>(int const&, int const&)", "noether::base::h()"]:
        yield f"simd_symbols: found {found}"
    disassembly = """0000 <noether::detail::SimdLoop<&(void noether::detail::loop_over_pairs<noether::Wca, (noether::Cutoff)3>(x)), void (*)(x)>::avx512(x)>:
      10:\tcall   20 <noether::detail::switched(double)>
0020 <noether::detail::switched(double)>:
      20:\tcall   30 <f()>
"""
    calls = simd_symbols.calls_of(disassembly)
    if calls != ["the loop over pairs of noether::Wca calls 'noether::detail::switched(double)' at level avx512"]:
        yield f"simd_symbols: found {calls}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--compiler", default="c++")
    every_failure = [*failures(), *symbol_failures(), *compiler_failures(parser.parse_args().compiler)]
    print("\n".join(every_failure) or f"{len(SAMPLES) + 2} planted files, each found or passed as it should be")
    raise SystemExit(bool(every_failure))
