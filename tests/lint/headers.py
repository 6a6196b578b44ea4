"""Headers: each has `#pragma once`; with --compiler, each header and each source also compiles alone.

Builds compile several sources at a time and behind a precompiled header, which hides what one of them forgot to include.
Tests are never compiled in another way, and lanes stand alone in every build, as does the module for Python, which needs
nanobind. A header that the source of its name includes first is tried with that source."""

import argparse
import concurrent.futures
import os
import pathlib
import subprocess

import tree

FLAGS = ["-std=c++20", "-fsyntax-only", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror"]


def headers(root):
    return [path for path in tree.cpp_files(root) if path.suffix == ".hpp"]


def pragma_problems(root):
    return [f"{path}: no #pragma once" for path in headers(root) if "#pragma once\n" not in tree.read(root, path)]


def has_twin(root, header):
    """Whether the source of the same name begins with this header."""
    source = header.with_suffix(".cpp")
    if not (pathlib.Path(root) / source).exists():
        return False
    first = next((line for line in tree.read(root, source).splitlines() if line.startswith("#include")), "")
    return first == f'#include "{header}"'


def compile_alone(root, compiler, flags, path):
    """The first error of a source, or of a file that includes nothing but this header, twice; or None."""
    file, text = ("-", f'#include "{path}"\n' * 2) if path.suffix == ".hpp" else (pathlib.Path(root) / path, None)
    done = subprocess.run([compiler, *FLAGS, *flags, f"-I{root}", "-x", "c++", file], text=True, capture_output=True,
                          input=text)
    if done.returncode == 0:
        return None
    errors = [line for line in done.stderr.splitlines() if "error" in line]
    return f"{path}: does not compile alone: {(errors or [done.stderr])[0]}"


def sources(root):
    return [path for path in tree.cpp_files(root) if path.suffix == ".cpp" and path.parts[0] != "tests"
            and not path.stem.endswith("_simd")]


def compile_problems(root, compiler, flags):
    alone = [header for header in headers(root) if not has_twin(root, header)] + sources(root)
    alone = [path for path in alone if path.parts[0] != "python"]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda path: compile_alone(root, compiler, flags, path), alone)
    return [result for result in results if result]


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("root")
    parser.add_argument("--compiler")
    arguments, flags = parser.parse_known_args()  # further options are the compiler's
    if arguments.compiler:
        tree.report(compile_problems(arguments.root, arguments.compiler, flags))
    tree.report(pragma_problems(arguments.root))
