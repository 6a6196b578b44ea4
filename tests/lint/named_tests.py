"""Documents: every test that docs/promises.md and docs/claims.md name is there, and every case that stands behind it."""

import pathlib
import re
import sys

import tree

PAGES = ["docs/promises.md", "docs/claims.md"]
# `tests/folder/name_test.cpp` "a case", "another": cases belong to the file before them.
NAMED = re.compile(r'`(tests/[^`]+)`|"((?:\\.|[^"\\])+)"')
CASE = re.compile(r'TEST_CASE\(\s*((?:"(?:\\.|[^"\\])*"\s*)+)')
LITERAL = re.compile(r'"((?:\\.|[^"\\])*)"')


def cases(text):
    """Names of all cases of a test's text; a name may be written in several pieces."""
    return {"".join(LITERAL.findall(name)) for name in CASE.findall(text)}


def problems(root):
    root = pathlib.Path(root)
    found = []
    for page in PAGES:
        if not (root / page).exists():
            continue
        for number, line in enumerate((root / page).read_text(encoding="utf-8").split("\n"), 1):
            path = None
            for file, case in NAMED.findall(line):
                if file:
                    path = file
                    if not list(root.glob(path)):
                        found.append(f"{page}:{number}: there is no {path}")
                elif path and path.endswith(".cpp") and (root / path).exists():
                    if case.replace("\\|", "|") not in cases(tree.read(root, path)):
                        found.append(f"{page}:{number}: {path} has no case '{case}'")
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
