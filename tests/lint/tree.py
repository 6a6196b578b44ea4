"""What all lints share: the C++ files of the tree, and C++ text without its comments or strings."""

import pathlib
import re
import sys

ROOMS = ["numbers", "engine", "neighbors", "monitors", "forces", "constraints", "io", "integrators", "scene", "study", "cli", "python", "examples", "bench", "tests"]


def cpp_files(root):
    """Paths relative to root of every header and source, in order."""
    root = pathlib.Path(root)
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix in (".hpp", ".cpp") and path.is_file():
                yield path.relative_to(root)


def read(root, path):
    return (pathlib.Path(root) / path).read_text(encoding="utf-8", errors="replace")


TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\'',
    re.DOTALL)


def blank(text, comments=True, strings=False):
    """The same text with comments (and strings) replaced by spaces; every line break and column stays."""
    def replace(match):
        token = match.group()
        if token.startswith(("//", "/*")):
            return re.sub(r"[^\n]", " ", token) if comments else token
        return token[0] + re.sub(r"[^\n]", " ", token[1:-1]) + token[-1] if strings else token
    return TOKEN.sub(replace, text)


def closing(text, opening):
    """Index of the bracket that closes the one at `opening` (text without strings and comments), or -1."""
    pairs = {"(": ")", "{": "}", "[": "]"}
    depth = 0
    for index in range(opening, len(text)):
        if text[index] == text[opening]:
            depth += 1
        elif text[index] == pairs[text[opening]]:
            depth -= 1
            if depth == 0:
                return index
    return -1


def line_of(text, index):
    return text.count("\n", 0, index) + 1


def exceptions(root):
    """Excused findings: {(lint, subject): reason} from tests/lint/exceptions.txt (`lint subject reason`)."""
    found = {}
    path = pathlib.Path(root) / "tests/lint/exceptions.txt"
    for line in path.read_text().splitlines() if path.exists() else []:
        if line.strip() and not line.startswith("#"):
            lint, subject, reason = line.split(None, 2)
            found[(lint, subject)] = reason
    return found


def report(problems):
    """Prints the findings; the exit status is 1 if there are any."""
    for problem in problems:
        print(problem)
    sys.exit(1 if problems else 0)
