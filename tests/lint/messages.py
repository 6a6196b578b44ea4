"""Messages of exceptions: lower case at the start, no full stop at the end.

Names in single quotes ('J2') and names in capitals (HDF5) may stand first; a lone word is an argument, not a message.
"""

import re
import sys

import tree

THROWN = re.compile(r"\bthrow\s+[\w:]+\s*(?:<[^;{}()]*>)?\s*([({])|\b(?:NOETHER_EXPECTS|\w+Error|SchemeMismatch|MissingColumn)(\()")
LITERAL = re.compile(r'"((?:\\.|[^"\\\n])*)"')
BEFORE_MESSAGE = re.compile(r"(^|,)\s*((std::)?string\s*[({]|fmt::format\(|format\()?\s*$")
AFTER_MESSAGE = re.compile(r"^\s*([,)}]|$)")


def messages(text):
    """(index, text, is at the start of an argument, is at its end) of every group of adjacent literals in a throw."""
    plain = tree.blank(text, strings=True)
    for match in THROWN.finditer(plain):
        opening = match.end() - 1
        end = tree.closing(plain, opening)
        if end < 0:
            continue
        groups = []
        for literal in LITERAL.finditer(text, opening + 1, end):
            if groups and not text[groups[-1][1]:literal.start()].strip():
                groups[-1] = (groups[-1][0], literal.end(), groups[-1][2] + literal.group(1))
            else:
                groups.append((literal.start(), literal.end(), literal.group(1)))
        for first, last, message in groups:
            before, after = plain[opening + 1:first], plain[last:end]
            yield first, message, bool(BEFORE_MESSAGE.search(before)), bool(AFTER_MESSAGE.match(after))


def problems(root):
    found = []
    for path in tree.cpp_files(root):
        if path.parts[0] == "tests":
            continue
        text = tree.blank(tree.read(root, path))
        for index, message, starts, ends in messages(text):
            where = f"{path}:{tree.line_of(text, index)}"
            if re.fullmatch(r"[\w.]*", message):
                continue
            first = re.match(r"[\w]+", message)
            name = first and len(first.group()) > 1 and first.group().upper() == first.group()
            if starts and first and message[0].isupper() and not name:
                found.append(f"{where}: message starts with a capital: \"{message}\"")
            if ends and message.endswith(".") and not message.endswith(".."):
                found.append(f"{where}: message ends with a full stop: \"{message}\"")
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
