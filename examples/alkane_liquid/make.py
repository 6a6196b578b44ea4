"""Writes decane.data: 64 molecules of n-decane at the density of the liquid, united atoms, for LAMMPS and for noether.

    python3 make.py > decane.data
    python3 make.py 10 > ../decane/decane.data      # the same places with so many decimals, for rigid bonds

Each chain grows carbon by carbon: of a few places for the next one, trans or gauche, it takes the place farthest from
all carbons that stand already. Some still overlap; a minimizer parts them. The same seed writes the same file.
"""

import math
import random
import sys

CHAINS, CARBONS = 64, 10
DECIMALS = int(sys.argv[1]) if len(sys.argv) > 1 else 4
DENSITY = 0.726  # g/cm^3, of decane at 298 K
BOND, ANGLE = 1.54, math.radians(114)  # angstrom
TRANS, GAUCHE = math.pi, math.radians(65)
TRIALS = 24
CH3, CH2 = (15.0345, 98.0, 3.75), (14.0266, 46.0, 3.95)  # mass, epsilon/k_B in K, sigma in angstrom
KELVIN = 0.00831446261815324 / 4.184  # kcal/mol
TORSION = (355.03, -68.19, 791.32)  # c1, c2, c3 in K of c1 (1 + cos phi) + c2 (1 - cos 2 phi) + c3 (1 + cos 3 phi)
BEND = 62500.0  # K/rad^2, of k/2 (theta - theta0)^2
STRETCH = 268.0  # kcal/mol/angstrom^2, of K (r - r0)^2: the bonds of TraPPE are rigid, these are those of OPLS-AA


def add(a, b, factor=1.0):
    return tuple(x + factor * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def any_direction(dice):
    return unit(tuple(dice.gauss(0, 1) for _ in range(3)))


def next_place(dice, chain):
    """One place for the next carbon of a chain, at the length of a bond."""
    if not chain:
        return tuple(dice.uniform(0, EDGE) for _ in range(3))
    if len(chain) == 1:
        return add(chain[0], any_direction(dice), BOND)
    along = unit(add(chain[-1], chain[-2], -1))
    if len(chain) == 2:
        side, phi = unit(cross(along, any_direction(dice))), 0.0
    else:
        back = add(chain[-3], chain[-2], -1)  # cis is on this side of the last bond
        side = unit(add(back, along, -sum(x * y for x, y in zip(back, along))))
        phi = dice.choice((TRANS, TRANS, GAUCHE, -GAUCHE)) + dice.gauss(0, 0.15)
    third = cross(along, side)
    place = chain[-1]
    place = add(place, along, -BOND * math.cos(ANGLE))
    place = add(place, side, BOND * math.sin(ANGLE) * math.cos(phi))
    return add(place, third, BOND * math.sin(ANGLE) * math.sin(phi))


def room(place, others):
    """Square of the distance to the nearest image of the others."""
    nearest = EDGE * EDGE
    for other in others:
        d = [x - y for x, y in zip(place, other)]
        nearest = min(nearest, sum((x - EDGE * round(x / EDGE)) ** 2 for x in d))
    return nearest


def grow(dice):
    chains = []
    for _ in range(CHAINS):
        chain = []
        while len(chain) < CARBONS:
            others = [place for done in chains for place in done] + chain[:-3]
            trials = [next_place(dice, chain) for _ in range(TRIALS)]
            chain.append(max(trials, key=lambda place: room(place, others)))
        chains.append(chain)
    return chains


def section(title, rows):
    print(f"\n{title}\n")
    for number, row in enumerate(rows, 1):
        print(number, *row)


def tuples(size):
    """Carbons, by number, that stand in a row in a chain."""
    return [[CARBONS * chain + first + k + 1 for k in range(size)]
            for chain in range(CHAINS) for first in range(CARBONS - size + 1)]


chain_mass = 2 * CH3[0] + (CARBONS - 2) * CH2[0]
EDGE = (CHAINS * chain_mass / (0.602214076 * DENSITY)) ** (1 / 3)
chains = grow(random.Random(1))

print("64 n-decane molecules, TraPPE united atoms with springs for bonds; written by make.py\n")
print(CHAINS * CARBONS, "atoms")
for size, name in ((2, "bonds"), (3, "angles"), (4, "dihedrals")):
    print(len(tuples(size)), name)
print("\n2 atom types\n1 bond types\n1 angle types\n1 dihedral types\n")
for axis in "xyz":
    print(f"0 {EDGE:.6f} {axis}lo {axis}hi")
section("Masses", [(CH3[0],), (CH2[0],)])
section("Pair Coeffs # lj/cut", [(f"{kind[1] * KELVIN:.8f}", kind[2]) for kind in (CH3, CH2)])
section("Bond Coeffs # harmonic", [(STRETCH, BOND)])
section("Angle Coeffs # harmonic", [(f"{BEND / 2 * KELVIN:.6f}", 114)])
section("Dihedral Coeffs # opls", [[f"{2 * c * KELVIN:.8f}" for c in TORSION] + [0]])
section("Atoms # molecular",
        [(chain + 1, 1 if k in (0, CARBONS - 1) else 2, *(f"{x % EDGE:.{DECIMALS}f}" for x in chains[chain][k]))
         for chain in range(CHAINS) for k in range(CARBONS)])
for size, name in ((2, "Bonds"), (3, "Angles"), (4, "Dihedrals")):
    section(name, [(1, *row) for row in tuples(size)])
