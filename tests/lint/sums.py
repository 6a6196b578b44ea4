"""Sums over particles: numbers that loops over particles add up go through engine/sums.hpp or a WideSum, so that order
never matters.

Found is every `x += ...` or `x -= ...` of a loop `for (Index i = ...)`, or over another index where masses, positions or
velocities are added, if `x` is declared outside of the loop and is no element of anything. Whole numbers have one sum in
any order: counts that add `? 1 : 0` pass, and so do lengths. exceptions.txt lists the files with rules of their own, and why.
Constraints and methods sum over equations.
"""

import re
import sys

import tree

ROOMS = ("numbers", "engine", "neighbors", "monitors", "forces", "io", "integrators", "scene", "study", "cli")
METHODS = (("integrators", "methods"), ("integrators", "lie"))
LOOP = re.compile(r"\bfor \((?P<type>Index|auto|std::size_t|int) (?P<index>\w+) = ")
OF_PARTICLES = re.compile(r"mass|position|velocit")
ADDED = re.compile(r"(?<![\w.\])>])(?P<to>[A-Za-z_]\w*(?:\.\w+)*) [+-]= (?P<what>[^;]*)")
COUNT = re.compile(r"\? \d+ : \d+$|\.size\(\)$|\bstatic_cast<(?:Index|std::size_t)>\(|^\d+$|^\w*(?:stride|size|count)\w*$")


def body_of(text, opening):
    """Begin and end of what a loop repeats; `opening` is the index of its round bracket."""
    begin = tree.closing(text, opening) + 1
    while text[begin].isspace():
        begin += 1
    if text[begin] == "{":
        return begin, tree.closing(text, begin)
    depth, end = 0, begin
    while end < len(text) and not (text[end] == ";" and depth == 0):
        depth += (text[end] in "({[") - (text[end] in ")}]")
        end += 1
        if text[end - 1] == "}" and depth == 0:  # a loop in a loop
            break
    return begin, end


def declared_in(body, name):
    """Whether the first mention of a name in a body makes it."""
    first = re.search(rf"(?:[\w>]&?&? |, ){name}\b(?! [+-]=)", body)
    return bool(first) and not re.search(rf"\breturn {name}\b", first.group())


def is_wide(text, name):
    """Whether a sum keeps what its rounding leaves out (numbers/wide_sum.hpp): so do members of that name."""
    return bool(re.search(rf"\bWide(?:Sum|Tensor)<[^;>]*> {name.split('.')[-1]}\b", text))


def sums_in(text):
    """(index, name) of every sum over particles; `text` is without comments and strings."""
    for loop in LOOP.finditer(text):
        begin, end = body_of(text, text.index("(", loop.start()))
        body = text[begin:end + 1]
        for added in ADDED.finditer(body):
            what, root = added.group("what").strip(), added.group("to").split(".")[0]
            over_particles = loop.group("type") == "Index" or OF_PARTICLES.search(what)
            if over_particles and root != loop.group("index") and not COUNT.search(what) and \
                    not declared_in(body[:added.start()], root) and not is_wide(text, added.group("to")):
                yield begin + added.start(), added.group("to")


def problems(root):
    excused, used, found = tree.exceptions(root), set(), []
    for path in tree.cpp_files(root):
        if path.parts[0] not in ROOMS or path.parts[:2] in METHODS or path.stem.endswith("_simd"):
            continue
        text = tree.blank(tree.read(root, path), strings=True)
        for index, name in sorted(set(sums_in(text))):
            if ("sums", str(path)) in excused:
                used.add(str(path))
            else:
                found.append(f"{path}:{tree.line_of(text, index)}: '{name}' is summed over particles in their order; "
                             "use sum_over of engine/sums.hpp, or a WideSum")
    for lint, subject in excused:
        if lint == "sums" and subject not in used:
            found.append(f"tests/lint/exceptions.txt: '{subject}' has no sum over particles; remove the line")
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
