"""Names of parts: only the file of a Hamiltonian, a force, a thermostat, a constraint or a system and the list of parts
(scene/parts.cpp) decide by its name. Other code that did so would be wrong about parts from outside the library, so it
asks for claims. Messages and tables may propose a name."""

import re
import sys

import tree

LIBRARY = {"numbers", "engine", "neighbors", "monitors", "forces", "constraints", "io", "integrators", "scene", "study",
           "cli"}
LIST = "scene/parts.cpp"
ADDED = re.compile(r"parts\.add_(?:hamiltonian|force|thermostat|constraint|system)(?:<(\w+)>|\(\{part_info<(\w+)>)")
DESCRIBED = re.compile(r'\bpart<(\w+)>\(\s*"([^"]+)"')
# Each is something else too: a dimension, a quantity, a kind of bonds. Only of a `type` it is the name of a part.
SHARED = {"angle", "distance", "morse"}
COMPARED = re.compile(r'(\btype\s*)?(?:[=!]=\s*|\b(?:starts_with|ends_with|contains)\()"([a-z][a-z0-9_]*)"|"([a-z][a-z0-9_]*)"\s*[=!]=')
ALIAS = re.compile(r"\busing (\w+) = \w+<(\w+)[,>]")


def names_of_parts(root, texts):
    """{name: the file that describes it} of every part in the list."""
    listed = {one or other for one, other in ADDED.findall(texts.get(LIST, ""))}
    for text in texts.values():
        listed |= {inner for alias, inner in ALIAS.findall(text) if alias in listed}
    found = {}
    for path, text in texts.items():
        for kind, name in DESCRIBED.findall(text):
            if kind in listed:
                found[name] = path
    return found


def problems(root):
    texts = {}
    for path in tree.cpp_files(root):
        if path.parts[0] in LIBRARY:
            texts[str(path)] = tree.blank(tree.read(root, path))
    names, found = names_of_parts(root, texts), []
    for path, text in texts.items():
        if path == LIST:
            continue
        for match in COMPARED.finditer(text):
            name = match.group(2) or match.group(3)
            home = names.get(name)
            if home is None or stem(path) == stem(home) or (name in SHARED and not match.group(1)):
                continue
            found.append(f'{path}:{tree.line_of(text, match.start())}: a decision by "{name}", the name of a part of '
                         f"{home}; ask for what the part claims")
    return found


def stem(path):
    return path.rsplit(".", 1)[0].removesuffix("_impl")


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
