"""Text of C++ files: ASCII, at most 120 columns, no tabs, no blanks at line ends, nothing left to do."""

import re
import sys

import tree

COLUMNS = 120
UNFINISHED = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X)\b")


def line_problems(line):
    if not line.isascii():
        yield "not ASCII"
    if len(line) > COLUMNS:
        yield f"{len(line)} columns, at most {COLUMNS}"
    if "\t" in line:
        yield "a tab; indent by two blanks"
    if line != line.rstrip():
        yield "blanks at the end of the line"
    if UNFINISHED.search(line):
        yield f"'{UNFINISHED.search(line).group()}': finish it or open an issue"


def problems(root):
    found = []
    for path in tree.cpp_files(root):
        for number, line in enumerate(tree.read(root, path).split("\n"), 1):
            found += [f"{path}:{number}: {problem}" for problem in line_problems(line)]
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
