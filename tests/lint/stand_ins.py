"""Sources that stand in for others in a build without a library: ROOM/no_NAME.cpp defines every member of the classes in
ROOM/NAME.hpp that other sources of the room define and that is not private. (Overloads count as one.) A build without
the library would link wherever such a member is not used, and break where somebody begins to use it."""

import pathlib
import re
import sys

import tree

MEMBER = re.compile(r"\b([A-Z]\w*)::(~?\w+)\(")


def members(text):
    return set(MEMBER.findall(tree.blank(text, strings=True)))


def private_names(header):
    """Names that occur in a private part of a class."""
    parts = re.findall(r"\bprivate:(.*?)\n(?:};| public:)", tree.blank(header), re.DOTALL)
    return {name for part in parts for name in re.findall(r"(\w+)\(", part)}


def problems(root):
    found = []
    for path in tree.cpp_files(root):
        if path.suffix != ".cpp" or not path.name.startswith("no_"):
            continue
        other = path.with_name(path.name[3:])
        header = other.with_suffix(".hpp")
        if not all((pathlib.Path(root) / file).exists() for file in (other, header)):
            continue
        text = tree.read(root, header)
        classes = set(re.findall(r"^class (\w+) {", text, re.MULTILINE))
        theirs = set().union(*(members(tree.read(root, file)) for file in tree.cpp_files(root)
                               if file.parent == path.parent and file.suffix == ".cpp" and not file.name.startswith("no_")))
        for name, member in sorted(theirs - members(tree.read(root, path))):
            if name in classes and member not in private_names(text):
                found.append(f"{path}: does not define {name}::{member}, which other sources do")
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
