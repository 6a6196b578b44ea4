"""Writes a sodium and a chloride ion that touch, and 214 molecules of SPC/E around them, as a LAMMPS data file.

    python3 make.py > pair.data

Oxygens stand on a simple cubic lattice of 216 places, of which the ions have two, each molecule turned its own way. The ions have
the parameters of Joung and Cheatham (2008) for SPC/E."""

import math
import random

SIDE, EDGE = 6, 18.62  # places along an edge, and its length in angstrom: 0.997 g/cm^3
BOND, HALF_ANGLE = 1.0, math.radians(109.47) / 2
NA, CL = (2, 2, 2), (3, 2, 2)

HEAD = """Na+ and Cl- in SPC/E water; written by make.py

{atoms} atoms
{bonds} bonds
{angles} angles

4 atom types
1 bond types
1 angle types

0 {edge} xlo xhi
0 {edge} ylo yhi
0 {edge} zlo zhi

Atom Type Labels

1 O
2 H
3 Na
4 Cl

Masses

O 15.9994
H 1.008
Na 22.98977
Cl 35.453

Pair Coeffs # lj/cut/coul/long

O 0.15539421 3.16555789
H 0 0
Na 0.3526418 2.159538
Cl 0.0127850 4.830453

Bond Coeffs # harmonic

1 412.28 1.0

Angle Coeffs # harmonic

1 45.77 109.47
"""


def direction(number):
    z, turn = number.uniform(-1, 1), number.uniform(0, 2 * math.pi)
    return (math.sqrt(1 - z * z) * math.cos(turn), math.sqrt(1 - z * z) * math.sin(turn), z)


def across(axis, other):
    x = [axis[1] * other[2] - axis[2] * other[1], axis[2] * other[0] - axis[0] * other[2],
         axis[0] * other[1] - axis[1] * other[0]]
    length = math.sqrt(sum(c * c for c in x))
    return [c / length for c in x]


def main():
    number = random.Random(1)
    atoms, bonds, angles = [], [], []
    step = EDGE / SIDE
    molecule = 0

    def add(kind, charge, place):
        atoms.append(f"{len(atoms) + 1} {molecule} {kind} {charge} " + " ".join(f"{x:.8f}" for x in place))
        return len(atoms)

    for place in ((x, y, z) for x in range(SIDE) for y in range(SIDE) for z in range(SIDE)):
        molecule += 1
        center = [step * x for x in place]
        if place == NA:
            add("Na", 1, [center[0] + 0.15, *center[1:]])
        elif place == CL:
            add("Cl", -1, [center[0] - 0.15, *center[1:]])
        else:
            axis = direction(number)
            aside = across(axis, direction(number))
            o = add("O", -0.8476, center)
            for sign in (1, -1):
                add("H", 0.4238, [c + BOND * (math.cos(HALF_ANGLE) * a + sign * math.sin(HALF_ANGLE) * b)
                                  for c, a, b in zip(center, axis, aside)])
            bonds += [(o, o + 1), (o, o + 2)]
            angles.append((o + 1, o, o + 2))
    print(HEAD.format(atoms=len(atoms), bonds=len(bonds), angles=len(angles), edge=EDGE))
    print("Atoms # full\n", *atoms, "\nBonds\n", *(f"{k} 1 {i} {j}" for k, (i, j) in enumerate(bonds, 1)),
          "\nAngles\n", *(f"{k} 1 {i} {j} {l}" for k, (i, j, l) in enumerate(angles, 1)), sep="\n")


if __name__ == "__main__":
    main()
