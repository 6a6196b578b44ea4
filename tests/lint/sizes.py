"""Sizes: files up to 600 lines, functions up to 80; exceptions.txt lists those that may be longer, and why."""

import re
import sys

import tree

FILE_LIMIT = 600
FUNCTION_LIMIT = 80

SCOPE = re.compile(r"^(inline\s+)?(namespace|class|struct|enum|union|extern)\b")
NAME = re.compile(r"([~\w:]+|operator\s*\S+?)\s*\(")
MEMBER_INITIALIZER = re.compile(r"[,:]\s*[\w:]+(<[^()]*>)?\s*$")


def without_template(head):
    """A head without its leading `template <...>` and `[[...]]`."""
    head = re.sub(r"^\s*(#[^\n]*\n\s*)*", "", head)
    while head.startswith("template"):
        depth = 0
        for index, letter in enumerate(head):
            depth += (letter == "<") - (letter == ">")
            if letter == ">" and depth == 0:
                head = head[index + 1:].lstrip()
                break
        else:
            break
    return re.sub(r"^\[\[[^\]]*\]\]\s*", "", head)


def functions(text):
    """(name, first line, number of lines) of every function; `text` is without comments and strings."""
    found, start, index = [], 0, 0
    while index < len(text):
        letter = text[index]
        if letter in ";}":
            start = index + 1
        elif letter == "{":
            head = text[start:index]
            plain = without_template(head)
            balanced = head.count("(") == head.count(")")
            if SCOPE.match(plain) or ")" not in plain or not balanced:
                if balanced:
                    start = index + 1
                else:  # a braced argument inside a call: skip it, the head goes on
                    index = max(tree.closing(text, index), index)
            else:
                end = tree.closing(text, index)
                if end < 0:
                    break
                if not (":" in plain and MEMBER_INITIALIZER.search(plain)):
                    first = tree.line_of(text, start + len(head) - len(head.lstrip()))
                    named = NAME.search(plain)
                    name = named.group(1) if named else "?"
                    found.append((name, first, tree.line_of(text, end) - first + 1))
                    start = end + 1
                index = end
        index += 1
    return found


def problems(root):
    excused, used, found = tree.exceptions(root), set(), []

    def check(subject, size, limit, message):
        if size <= limit:
            return
        if ("sizes", subject) in excused:
            used.add(subject)
        else:
            found.append(message)

    for path in tree.cpp_files(root):
        text = tree.read(root, path)
        lines = text.count("\n")
        check(str(path), lines, FILE_LIMIT, f"{path}: {lines} lines, at most {FILE_LIMIT}; split the file")
        for name, line, size in functions(tree.blank(text, strings=True)):
            if name.startswith("TEST_CASE"):
                name = "TEST_CASE"
            check(f"{path}:{name}", size, FUNCTION_LIMIT,
                  f"{path}:{line}: '{name}' has {size} lines, at most {FUNCTION_LIMIT}; split the function")
    for lint, subject in excused:
        if lint == "sizes" and subject not in used:
            found.append(f"tests/lint/exceptions.txt: '{subject}' is within its limit; remove the line")
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
