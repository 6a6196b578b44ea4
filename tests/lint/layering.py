"""Layering: which folder may include which, which files may see HDF5, TOML, CLI11, OpenSSL and Highway, that files of a
room (a header with the source of its name) stand on each other in one direction, and that code in lanes sees nothing
else: an inline function that it shared with ordinary code would be linked with its instructions."""

import graphlib
import pathlib
import re
import sys

import tree

BELOW_SCENE = {"numbers", "engine", "neighbors", "monitors", "forces", "constraints", "io", "integrators"}
LIBRARIES = BELOW_SCENE | {"scene", "study"}
MAY_SEE = {
    "numbers": {"numbers"},
    "engine": {"numbers", "engine"},
    "neighbors": {"numbers", "engine", "neighbors"},
    "monitors": {"numbers", "engine", "neighbors", "monitors"},
    "forces": {"numbers", "engine", "neighbors", "forces"},
    "constraints": {"numbers", "engine", "constraints"},
    "io": {"numbers", "engine", "io"},
    "integrators": {"numbers", "engine", "neighbors", "forces", "integrators"},
    "scene": BELOW_SCENE | {"scene"},
    "study": LIBRARIES,
    "cli": LIBRARIES | {"cli"},
    "python": LIBRARIES | {"cli", "python"},
    "examples": LIBRARIES | {"examples"},
    "bench": LIBRARIES | {"bench"},
    "tests": LIBRARIES | {"cli", "examples", "tests"},
}
# Header pattern, what it is, the only folder whose .cpp files may include it.
GUARDED = [
    (re.compile(r"(hdf5(_hl)?|H5\w*)\.h$"), "HDF5", "io"),
    (re.compile(r"toml\+\+|^toml\.hpp$"), "TOML", "scene"),
    (re.compile(r"^CLI/"), "CLI11", "cli"),
    (re.compile(r"^openssl/"), "OpenSSL", "io"),
]
IN_LANES = re.compile(r"_simd\.[ch]pp$")
FOR_LANES = re.compile(r"_simd\.hpp$|_row\.hpp$|^numbers/simd\.hpp$")  # *_row.hpp: plain numbers, installed too
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def problems(root):
    found, beneath = [], {}
    for path in tree.cpp_files(root):
        text = tree.blank(tree.read(root, path))
        # An example that stands on an installed copy lives outside the rooms.
        for match in INCLUDE.finditer(text):
            where = f"{path}:{tree.line_of(text, match.start())}"
            quoted, header = match.group(1) == '"', match.group(2)
            if quoted:
                found += room_problems(root, path, where, header)
                note_neighbor(beneath, path, header)
            if header.startswith("hwy/") and not IN_LANES.search(path.name):
                found.append(f"{where}: Highway header '{header}' may be included only in *_simd.cpp and *_simd.hpp")
            if quoted and IN_LANES.search(path.name) and not FOR_LANES.search(header):
                found.append(f"{where}: code in lanes may include only *_simd.hpp, *_row.hpp and numbers/simd.hpp, not \"{header}\"")
            if quoted and header.endswith("_simd.hpp") and is_installed(path):
                found.append(f"{where}: \"{header}\" is not installed, and this header is; put what it needs into a *_row.hpp")
            for pattern, name, room in GUARDED:
                if pattern.search(header) and not (path.parts[0] == room and path.suffix == ".cpp"):
                    found.append(f"{where}: {name} header '{header}' may be included only in {room}/*.cpp")
    return found + circles(beneath)


def is_installed(path):
    return path.suffix == ".hpp" and not IN_LANES.search(path.name) and path.parts[0] in LIBRARIES


def stem_of(path):
    """What a header, its source and its templates (`_impl`, in parts `_impl_...`) are together."""
    return re.sub(r"_impl(_\w+)?$", "", str(path.with_suffix("")))


def note_neighbor(beneath, path, header):
    """Remembers what a file of a room stands on in the same room."""
    above, below = stem_of(path), stem_of(pathlib.PurePath(header))
    if path.parts[0] in LIBRARIES and pathlib.PurePath(header).parts[0] == path.parts[0] and above != below:
        beneath.setdefault(above, set()).add(below)


def circles(beneath):
    try:
        graphlib.TopologicalSorter(beneath).prepare()
    except graphlib.CycleError as circle:
        return [f"{circle.args[1][0]}: includes lead round: {' <- '.join(circle.args[1])}; "
                "put what both need into a header of its own"]
    return []


def room_problems(root, path, where, header):
    room, target = path.parts[0], pathlib.PurePath(header).parts[0]
    if header == "noether.hpp" and room in ("examples", "bench", "tests"):
        return []  # the one header for programs
    if target not in MAY_SEE:
        return [f"{where}: \"{header}\" does not start with a folder of the tree; write the path from the root"]
    if target not in MAY_SEE[room]:
        return [f"{where}: {room} may not include {target} (\"{header}\"); it sees {', '.join(sorted(MAY_SEE[room]))}"]
    if not (pathlib.Path(root) / header).exists():
        return [f"{where}: there is no file \"{header}\""]
    return []


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
