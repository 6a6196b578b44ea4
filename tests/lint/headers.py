"""Headers: each has `#pragma once`; with --compiler, each header and each source also compiles alone.

Builds compile several sources at a time and behind a precompiled header, which hides what one of them forgot to include.
Tests are never compiled in another way, and lanes stand alone in every build, as does the module for Python, which needs
nanobind. A header that the source of its name includes first is tried with that source. With --passed FILE, what compiled
alone the last time, from the same text of itself and of all that it includes of ours, is not compiled again."""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
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


class States:
    """Of each file, what decides whether it compiles alone: a hash of the compiler, its options, and the text of the file and
    of all of the tree that it includes, however deep. The system's headers are taken to change with the compiler."""

    INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)

    def __init__(self, root, compiler, flags):
        version = subprocess.run([compiler, "--version"], text=True, capture_output=True).stdout
        self.root, self.common, self.files = root, [compiler, version, *FLAGS, *flags], {}

    def of(self, path):
        found, waiting = set(), [path]
        while waiting:
            file = waiting.pop()
            if file not in found:
                found.add(file)
                waiting += self.read(file)[1]
        texts = [f"{file} {self.read(file)[0]}" for file in sorted(found)]
        return hashlib.sha256("\n".join([*self.common, *texts]).encode()).hexdigest()

    def read(self, path):
        """The hash of a file, and what it includes."""
        if path not in self.files:
            text = tree.read(self.root, path)
            names = self.INCLUDE.findall(text)
            places = [path.parent / name for name in names] + [pathlib.Path(name) for name in names]
            self.files[path] = (hashlib.sha256(text.encode()).hexdigest(),
                                [one for one in places if (pathlib.Path(self.root) / one).is_file()])
        return self.files[path]


def compile_problems(root, compiler, flags, passed=None):
    """@param passed  a file of what has compiled; read, and written anew"""
    alone = [header for header in headers(root) if not has_twin(root, header)] + sources(root)
    alone = [path for path in alone if path.parts[0] != "python"]
    known = json.loads(passed.read_text()) if passed and passed.exists() else {}
    states = States(root, compiler, flags)
    now = {str(path): states.of(path) for path in alone}
    tried = [path for path in alone if known.get(str(path)) != now[str(path)]]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = dict(zip(tried, pool.map(lambda path: compile_alone(root, compiler, flags, path), tried)))
    if passed:
        passed.write_text(json.dumps({str(path): now[str(path)] for path in alone if not results.get(path)}))
    return [result for result in results.values() if result]


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("root")
    parser.add_argument("--compiler")
    parser.add_argument("--passed", type=pathlib.Path)
    arguments, flags = parser.parse_known_args()  # further options are the compiler's
    if arguments.compiler:
        tree.report(compile_problems(arguments.root, arguments.compiler, flags, arguments.passed))
    tree.report(pragma_problems(arguments.root))
