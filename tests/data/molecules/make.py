"""Writes wrapped.data: rigid molecules of three sites in a box whose faces cut some of them. See README.md."""

import itertools
import math
import pathlib

EDGE, PER_EDGE, BOND, ANGLE = 6.0, 3, 0.6, 104.0
MASSES = (2.0, 1.0, 1.0)

state = 12345


def uniform():
    """From -1 to 1; the same numbers every time."""
    global state
    state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
    return (state >> 11) / 2**53 * 2 - 1


def rotation():
    """Of a quaternion from the inside of the unit ball."""
    while True:
        q = [uniform() for _ in range(4)]
        size = sum(x * x for x in q)
        if 0.05 < size < 1:
            break
    w, x, y, z = (c / math.sqrt(size) for c in q)
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]


def main():
    half = math.radians(ANGLE) / 2
    sites = [(0, 0, 0)] + [(sign * BOND * math.sin(half), BOND * math.cos(half), 0) for sign in (1, -1)]
    atoms, velocities, bonds, angles = [], [], [], []
    for molecule, cell in enumerate(itertools.product(range(PER_EDGE), repeat=3), 1):
        turned = rotation()
        first = len(atoms) + 1
        for kind, site in enumerate(sites):
            place = [cell[a] * EDGE / PER_EDGE + sum(turned[a][b] * site[b] for b in range(3)) for a in range(3)]
            atoms.append((molecule, 1 if kind == 0 else 2, [round(c % EDGE, 12) for c in place]))
            velocities.append((MASSES[kind], [uniform() for _ in range(3)]))
        bonds += [(first, first + 1), (first, first + 2)]
        angles.append((first + 1, first, first + 2))
    mass = sum(m for m, _ in velocities)
    drift = [sum(m * v[a] for m, v in velocities) / mass for a in range(3)]
    lines = ["molecules of three sites, atoms wrapped into the box, no images", ""]
    lines += [f"{len(atoms)} atoms", "2 atom types", f"{len(bonds)} bonds", "1 bond types"]
    lines += [f"{len(angles)} angles", "1 angle types", ""]
    lines += [f"0 {EDGE:g} {axis}lo {axis}hi" for axis in "xyz"]
    lines += ["", "Masses", "", "1 2", "2 1", "", "Pair Coeffs # lj/cut", "", "1 1 1", "2 0.5 0.9"]
    lines += ["", "Bond Coeffs # harmonic", "", f"1 500 {BOND}", "", "Angle Coeffs # harmonic", "", f"1 50 {ANGLE:g}"]
    lines += ["", "Atoms # molecular", ""]
    for k, (molecule, kind, place) in enumerate(atoms, 1):
        lines.append(f"{k} {molecule} {kind} " + " ".join(f"{c:.12g}" for c in place))
    lines += ["", "Velocities", ""]
    for k, (_, v) in enumerate(velocities, 1):
        lines.append(f"{k} " + " ".join(f"{v[a] - drift[a]:.10f}" for a in range(3)))
    lines += ["", "Bonds", ""] + [f"{k} 1 {a} {b}" for k, (a, b) in enumerate(bonds, 1)]
    lines += ["", "Angles", ""] + [f"{k} 1 {a} {b} {c}" for k, (a, b, c) in enumerate(angles, 1)]
    pathlib.Path(__file__).with_name("wrapped.data").write_text("\n".join(lines) + "\n")


main()
