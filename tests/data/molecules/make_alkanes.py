"""Writes butane.data and hexane.data: alkanes in trans, with every atom and as united atoms. See README.md."""

import itertools
import math
import pathlib

CC, CH, CCC = 1.529, 1.09, math.radians(112.7)  # of OPLS-AA
UNITED_CC, UNITED_CCC = 1.54, math.radians(114)  # of TraPPE
PER_EDGE = 2

BUTANE_COEFFICIENTS = """Masses

1 12.011
2 1.008

Pair Coeffs # lj/cut

1 0.066 3.5
2 0.030 2.5

Bond Coeffs # harmonic

1 268.0 1.529
2 340.0 1.09

Angle Coeffs # harmonic

1 58.35 112.7
2 37.5 110.7
3 33.0 107.8

Dihedral Coeffs # opls

1 1.3 -0.05 0.2 0.0
2 0.0 0.0 0.3 0.0
"""

HEXANE_COEFFICIENTS = """Masses

1 15.0345
2 14.0266

Pair Coeffs # lj/cut

1 0.19474602 3.75
2 0.09141140 3.95

Bond Coeffs # harmonic

1 268.0 1.54

Angle Coeffs # harmonic

1 62.100133 114

Dihedral Coeffs # opls

1 1.41103426 -0.27101492 3.14502895 0
"""


def zigzag(count, bond, angle):
    """Carbons in the plane z = 0, in trans along x."""
    step, rise = bond * math.sin(angle / 2), bond * math.cos(angle / 2)
    return [(k * step, (k % 2) * rise, 0.0) for k in range(count)]


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def plus(a, *more):
    return tuple(a[c] + sum(factor * b[c] for factor, b in more) for c in range(3))


def hydrogens(carbons, k):
    """Those of carbon k: two aside of a CH2, three about the axis of a CH3, each 1.09 away."""
    here = carbons[k]
    if 0 < k < len(carbons) - 1:
        out = unit([2 * here[c] - carbons[k - 1][c] - carbons[k + 1][c] for c in range(3)])
        half = math.radians(107.8) / 2
        return [plus(here, (CH * math.cos(half), out), (sign * CH * math.sin(half), (0, 0, 1))) for sign in (1, -1)]
    next_one = carbons[1 if k == 0 else k - 1]
    axis = unit([here[c] - next_one[c] for c in range(3)])
    aside = unit([-axis[1], axis[0], 0.0])
    tilt = math.radians(180 - 110.7)
    places = []
    for turn in (0, 2 * math.pi / 3, -2 * math.pi / 3):
        side = plus((0, 0, 0), (math.cos(turn), aside), (math.sin(turn), (0, 0, 1)))
        places.append(plus(here, (CH * math.cos(tilt), axis), (CH * math.sin(tilt), side)))
    return places


class Molecule:
    """Atoms as (type, charge, place), and bonds by places in this list."""

    def __init__(self):
        self.atoms, self.bonds = [], []

    def terms(self):
        """Bonded triples and quadruples, of the bonds."""
        near = {i: [] for i in range(len(self.atoms))}
        for i, j in self.bonds:
            near[i].append(j)
            near[j].append(i)
        angles = [(i, j, k) for j in near for i, k in itertools.combinations(sorted(near[j]), 2)]
        dihedrals = [(i, j, k, l) for j, k in self.bonds for i in near[j] for l in near[k] if i != k and l != j]
        return angles, dihedrals


def butane():
    molecule, carbons = Molecule(), zigzag(4, CC, CCC)
    for k, place in enumerate(carbons):
        molecule.atoms.append((1, -0.18 if k in (0, 3) else -0.12, place))
    molecule.bonds += [(k, k + 1) for k in range(3)]
    for k in range(4):
        for place in hydrogens(carbons, k):
            molecule.bonds.append((k, len(molecule.atoms)))
            molecule.atoms.append((2, 0.06, place))
    return molecule


def hexane():
    molecule = Molecule()
    for k, place in enumerate(zigzag(6, UNITED_CC, UNITED_CCC)):
        molecule.atoms.append((1 if k in (0, 5) else 2, 0.0, place))
    molecule.bonds += [(k, k + 1) for k in range(5)]
    return molecule


def butane_type(molecule, term):
    """By how many of the particles are hydrogens; of dihedrals, whether any is."""
    of_hydrogens = sum(molecule.atoms[i][0] == 2 for i in term)
    return min(of_hydrogens, 1) + 1 if len(term) != 3 else of_hydrogens + 1


def text_of(title, molecule, spacing, coefficients, type_of):
    angles, dihedrals = molecule.terms()
    lists = {"Bonds": molecule.bonds, "Angles": angles, "Dihedrals": dihedrals}
    copies, size = PER_EDGE ** 3, len(molecule.atoms)
    lines = [title, "", f"{copies * size} atoms"]
    lines += [f"{copies * len(terms)} {name.lower()}" for name, terms in lists.items()]
    lines += ["", f"{len({atom[0] for atom in molecule.atoms})} atom types"]
    for name, terms in lists.items():
        lines.append(f"{max(type_of(molecule, term) for term in terms)} {name.lower()[:-1]} types")
    lines += [""] + [f"0 {PER_EDGE * spacing[c]} {axis}lo {axis}hi" for c, axis in enumerate("xyz")]
    lines += ["", coefficients, "Atoms # full", ""]
    cells = list(itertools.product(range(PER_EDGE), repeat=3))
    for m, cell in enumerate(cells):
        for k, (kind, charge, place) in enumerate(molecule.atoms):
            at = [place[c] + (cell[c] + 0.3) * spacing[c] for c in range(3)]
            at = " ".join(f"{x:.15g}" for x in at)
            lines.append(f"{m * size + k + 1} {m + 1} {kind} {charge} {at}")
    for name, terms in lists.items():
        lines += ["", name, ""]
        for m in range(copies):
            for k, term in enumerate(terms):
                ids = " ".join(str(m * size + i + 1) for i in term)
                lines.append(f"{m * len(terms) + k + 1} {type_of(molecule, term)} {ids}")
    return "\n".join(lines) + "\n"


def main():
    here = pathlib.Path(__file__).parent
    (here / "butane.data").write_text(
        text_of("Butane, OPLS-AA, all atoms; written by make_alkanes.py", butane(), (8.0, 5.5, 5.5),
                BUTANE_COEFFICIENTS, butane_type))
    (here / "hexane.data").write_text(
        text_of("Hexane, TraPPE united atoms with springs for bonds; written by make_alkanes.py", hexane(),
                (10.5, 5.0, 5.0), HEXANE_COEFFICIENTS, lambda molecule, term: 1))


main()
