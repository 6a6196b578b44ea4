"""Writes butane.data: 64 molecules of n-butane, united atoms, for LAMMPS and for noether.

    python3 make.py > butane.data

The molecules stand on a lattice, each turned at random, with bonds and angles at their lengths of least energy. Half of
them are trans, a quarter gauche on each side: not what a bath makes of them. The same seed writes the same file.
"""

import math
import random

PER_EDGE, SPACING = 4, 9.0  # molecules along an edge, angstrom
BOND, ANGLE = 1.54, math.radians(114)  # angstrom
DIHEDRALS = (math.pi, math.pi, math.radians(65), -math.radians(65))
MASSES = (15.0345, 14.0266)
KELVIN = 0.00831446261815324 / 4.184  # kcal/mol
TORSION = (355.03, -68.19, 791.32)  # c1, c2, c3 in K of c1 (1 + cos phi) + c2 (1 - cos 2 phi) + c3 (1 + cos 3 phi)
BEND = 62500.0  # K/rad^2, of k/2 (theta - theta0)^2
STRETCH = 268.0  # kcal/mol/angstrom^2, of K (r - r0)^2, as OPLS-AA has it: of no effect where bonds are rigid


def molecule(dihedral):
    """Places of the four carbons: the second at the origin, the third on the axis of x."""
    out, up = BOND * math.cos(ANGLE), BOND * math.sin(ANGLE)
    return [(out, up, 0), (0, 0, 0), (BOND, 0, 0), (BOND - out, up * math.cos(dihedral), up * math.sin(dihedral))]


def turned(dice, places):
    """The same molecule, turned by a random rotation: that of a unit quaternion."""
    q = [dice.gauss(0, 1) for _ in range(4)]
    w, x, y, z = (c / math.sqrt(sum(c * c for c in q)) for c in q)
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
    return [tuple(sum(a * b for a, b in zip(row, place)) for row in rows) for place in places]


def section(title, rows):
    print(f"\n{title}\n")
    for number, row in enumerate(rows, 1):
        print(number, *row)


def tuples(size):
    """Carbons, by number, that stand in a row in a molecule."""
    return [[4 * k + first + i + 1 for i in range(size)] for k in range(PER_EDGE ** 3) for first in range(5 - size)]


dice = random.Random(1)
carbons = []
for k in range(PER_EDGE ** 3):
    site = [SPACING * (k // PER_EDGE ** axis % PER_EDGE + 0.5) for axis in range(3)]
    for number, place in enumerate(turned(dice, molecule(DIHEDRALS[k % 4]))):
        kind = 1 if number in (0, 3) else 2
        carbons.append((k + 1, kind, *(f"{x + s:.10f}" for x, s in zip(place, site))))

print("64 n-butane molecules, TraPPE united atoms; written by make.py\n")
print(len(carbons), "atoms")
for size, name in ((2, "bonds"), (3, "angles"), (4, "dihedrals")):
    print(len(tuples(size)), name)
print("\n2 atom types\n1 bond types\n1 angle types\n1 dihedral types\n")
for axis in "xyz":
    print(f"0 {PER_EDGE * SPACING} {axis}lo {axis}hi")
print("\nAtom Type Labels\n\n1 CH3\n2 CH2")
section("Masses", [(mass,) for mass in MASSES])
section("Bond Coeffs # harmonic", [(STRETCH, BOND)])
section("Angle Coeffs # harmonic", [(f"{BEND / 2 * KELVIN:.6f}", 114)])
section("Dihedral Coeffs # opls", [[f"{2 * c * KELVIN:.8f}" for c in TORSION] + [0]])
section("Atoms # molecular", carbons)
for size, name in ((2, "Bonds"), (3, "Angles"), (4, "Dihedrals")):
    section(name, [(1, *row) for row in tuples(size)])
