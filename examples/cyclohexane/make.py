"""Writes cyclohexane.data: 96 rings of cyclohexane at the density of the liquid, united atoms, for LAMMPS and for noether.

    python3 make.py > cyclohexane.data

Every ring is a boat, with all bonds at their length, and flat on its site of a lattice, turned by some angle in its
plane. The same seed writes the same file.
"""

import math
import random

RINGS, LAYERS = 4, 6  # along two edges, and along the third
DENSITY = 0.7739  # g/cm^3, of cyclohexane at 298 K
MASS, DEPTH, SIGMA = 14.0266, 46.0, 3.95  # of CH2: u, epsilon/k_B in K, angstrom
BOND, ANGLE = 1.54, math.radians(111.4)  # angstrom; TraPPE's angle of 114 degrees is what a ring cannot have
KELVIN = 0.00831446261815324 / 4.184  # kcal/mol
TORSION = (355.03, -68.19, 791.32)  # c1, c2, c3 in K of c1 (1 + cos phi) + c2 (1 - cos 2 phi) + c3 (1 + cos 3 phi)
BEND = 62500.0  # K/rad^2, of k/2 (theta - theta0)^2
STRETCH = 268.0  # kcal/mol/angstrom^2, of K (r - r0)^2, as OPLS-AA has it: of no effect where bonds are rigid


def boat(turn):
    """Places of the six carbons about their middle: four in a plane, bow and stern above it."""
    half = BOND / 2  # of the two sides of the boat
    # The ends lie so far out and up that bonds have their length and the angle at the ends is ANGLE.
    width = 2 * BOND * math.sin(ANGLE / 2)  # between the particles beside an end
    reach = BOND * math.cos(ANGLE / 2)  # from the middle of these to the end
    tilt = math.acos((math.cos(ANGLE) * -BOND) / reach)  # makes the angles at the sides ANGLE too
    out, up = reach * math.cos(tilt), reach * math.sin(tilt)
    flat = [(half + out, 0, up), (half, width / 2, 0), (-half, width / 2, 0), (-half - out, 0, up),
            (-half, -width / 2, 0), (half, -width / 2, 0)]
    c, s = math.cos(turn), math.sin(turn)
    return [(c * x - s * y, s * x + c * y, z - up / 3) for x, y, z in flat]


def section(title, rows):
    print(f"\n{title}\n")
    for number, row in enumerate(rows, 1):
        print(number, *row)


def tuples(size):
    """Carbons, by number, that stand in a row in a ring."""
    return [[6 * ring + (first + k) % 6 + 1 for k in range(size)]
            for ring in range(RINGS * RINGS * LAYERS) for first in range(6)]


count = RINGS * RINGS * LAYERS
EDGE = (count * 6 * MASS / (0.602214076 * DENSITY)) ** (1 / 3)
dice = random.Random(1)
carbons = []
for ring in range(count):
    site = [EDGE * (ring % RINGS + 0.5) / RINGS, EDGE * (ring // RINGS % RINGS + 0.5) / RINGS,
            EDGE * (ring // RINGS ** 2 + 0.5) / LAYERS]
    for place in boat(dice.uniform(0, 2 * math.pi)):
        carbons.append((ring + 1, 1, *(f"{x + s:.10f}" for x, s in zip(place, site))))

print(f"{count} rings of cyclohexane, TraPPE united atoms; written by make.py\n")
print(len(carbons), "atoms")
for size, name in ((2, "bonds"), (3, "angles"), (4, "dihedrals")):
    print(len(tuples(size)), name)
print("\n1 atom types\n1 bond types\n1 angle types\n1 dihedral types\n")
for axis in "xyz":
    print(f"0 {EDGE:.6f} {axis}lo {axis}hi")
print("\nAtom Type Labels\n\n1 CH2")
section("Masses", [(MASS,)])
section("Pair Coeffs # lj/cut", [(f"{DEPTH * KELVIN:.8f}", SIGMA)])
section("Bond Coeffs # harmonic", [(STRETCH, BOND)])
section("Angle Coeffs # harmonic", [(f"{BEND / 2 * KELVIN:.6f}", 114)])
section("Dihedral Coeffs # opls", [[f"{2 * c * KELVIN:.8f}" for c in TORSION] + [0]])
section("Atoms # molecular", carbons)
for size, name in ((2, "Bonds"), (3, "Angles"), (4, "Dihedrals")):
    section(name, [(1, *row) for row in tuples(size)])
