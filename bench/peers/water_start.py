"""What scripts of bench/peers share that run the water of bench/water.cpp: its start, and how far forces are from exact ones.

A start is JSON: the edge of its box, cutoff, sigma and epsilon of oxygen, the charge of hydrogen, and for each atom, O H H molecule by
molecule, x and v in nm and ps. Exact forces are {"unit": ..., "forces": [[atom, fx, fy, fz], ...]} in kJ/mol/nm, all that acts on
some atoms but constraints; errors are root mean squares over these, in that unit."""

import json
import pathlib
import sys

OXYGEN, HYDROGEN = 15.9994, 1.008  # u
BOND, ACROSS = 0.1, 0.1632980861845278  # nm: H-O-H 109.47 degrees


def read(path):
    return json.loads(pathlib.Path(path).read_text())


def error(path, force_of):
    """force_of(i): the force on an atom, kJ/mol/nm."""
    exact = read(path)
    squares = [(f - e) ** 2 for i, *known in exact["forces"] for f, e in zip(force_of(i), known)]
    return (sum(squares) / len(exact["forces"])) ** 0.5 / exact["unit"]


def serve(version, seconds, error_of):
    """Greets, then answers numbers of steps with processor seconds, and a file of exact forces with an error."""
    print(version, flush=True)
    for line in sys.stdin:
        word = line.strip()
        print(repr(seconds(int(word)) if word.isdigit() else error_of(word)), flush=True)
