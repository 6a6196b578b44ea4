"""Symbols: an object compiled for one SIMD level shares nothing by name with other objects: simd_symbols.py BUILD_FOLDER.

A weak symbol (an inline function, a template) outside the namespace of the level could be the copy that the linker keeps
for the whole program, and a processor without those instructions would meet them. `DW.ref.` is the compiler's pointer to a
function of the runtime, in data.

Loops over pairs that the compiler is to turn into lanes call nothing: a call that is not made part of them would go pair by
pair."""

import pathlib
import re
import subprocess
import sys

import tree

LEVEL = re.compile(r"_(base|avx2|avx512)\w*\.dir/")
SHARED = set("WwVvu")


def problems_of(symbols, level):
    """What is wrong with lines of `nm --demangle` of an object of this level."""
    found = []
    for line in symbols.splitlines():
        match = re.match(r"[0-9a-f ]{16} (\w) (.*)", line)
        if match and match.group(2).startswith("DW.ref."):
            continue
        if match and match.group(1) in SHARED and not re.match(rf"(.* )?(noether::|hwy_){level}\w*::", match.group(2)):
            found.append(f"the weak symbol '{match.group(2)}' belongs to no namespace of level {level}")
    return found


def calls_of(disassembly):
    """Loops over pairs that call something, in what `objdump --disassemble --demangle` prints."""
    loop, found = None, []
    for line in disassembly.splitlines():
        head = re.match(r"[0-9a-f]+ <(.*)>:", line)
        if head:
            loop = re.search(r"SimdLoop<.*loop_over_pairs<(.*?), \(noether::Cutoff\)\d>.*::(\w+)\(", head.group(1))
        elif loop and re.search(r"\tcall", line):
            found.append(f"the loop over pairs of {loop.group(1)} calls '{line.split('<')[-1].rstrip('>')}' at level {loop.group(2)}")
    return found


def problems(build):
    objects = [path for path in pathlib.Path(build).rglob("*_simd.cpp.o") if LEVEL.search(str(path))]
    if not objects:
        return [f"{build}: there are no objects of *_simd.cpp"]
    found = []
    for path in sorted(objects):
        symbols = subprocess.run(["nm", "--demangle", path], text=True, capture_output=True, check=True).stdout
        level = LEVEL.search(str(path)).group(1)
        found += [f"{path.relative_to(build)}: {problem}" for problem in problems_of(symbols, level)]
    for path in sorted(pathlib.Path(build).glob("CMakeFiles/noether_forces.dir/**/*.o")):
        command = ["objdump", "--disassemble", "--demangle", "--no-show-raw-insn", path]
        disassembly = subprocess.run(command, text=True, capture_output=True, check=True).stdout
        found += [f"{path.relative_to(build)}: {problem}" for problem in calls_of(disassembly)]
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
