#!/usr/bin/env python3
"""Writes peptide.data: an alpha helix of sixteen residues of twelve kinds, all atoms, as a LAMMPS data file.

    python3 bench/structures/peptide.py > bench/structures/peptide.data

Atoms are placed one after the other by a bond [angstrom], an angle and a dihedral [deg] from three that are there:
backbone angles phi = -57 and psi = -47, usual lengths and angles, side chains stretched. There are no charges, no
dihedral terms and no pairs; lengths and strengths of bonds and angles are about those of common force fields. What the
bench needs of it is which atom hangs where, with what mass, and how far away.
"""

import math

SEQUENCE = "ALA LYS GLY PHE SER VAL ASP LEU ASN TRP THR MET GLY ALA LYS SER".split()
PHI, PSI, OMEGA = -57, -47, 180
MASSES = {"C": 12.011, "H": 1.008, "N": 14.007, "O": 15.999, "S": 32.06}
# Lengths [angstrom] and strengths [kcal/mol/angstrom^2] of bonds of the side chains where a row below names none.
LENGTHS = {("C", "C"): (1.53, 310), ("C", "H"): (1.09, 340), ("C", "N"): (1.46, 330), ("C", "O"): (1.42, 320),
           ("C", "S"): (1.81, 230), ("H", "N"): (1.01, 434), ("H", "O"): (0.96, 553)}
ANGLE_STRENGTH = {True: 45, False: 65}  # with a hydrogen at an end, or none [kcal/mol/rad^2]


def methyl(carbon, behind, before):
    """Three hydrogens."""
    return [("H" + carbon + str(k), "H", carbon, behind, before, 1.09, 109.5, turn)
            for k, turn in enumerate((60, 180, 300))]


def methylene(carbon, behind, before):
    """Two hydrogens beside what comes next, which stands at 180 degrees."""
    return methyl(carbon, behind, before)[::2]


def side_chains():
    """Of each kind: name, element, the three atoms it is placed by, bond, angle, dihedral; ring bonds besides."""
    sides = {"GLY": [("HA2", "H", "CA", "N", "C", 1.09, 109.5, 120)]}

    def chain(kind, atoms):
        rows = [("CB", "C", "CA", "N", "C", 1.53, 110.5, -122)]
        names, behind = ["N", "CA", "CB"], "C"
        for name, element in atoms:
            rows.append((name, element, names[-1], names[-2], names[-3], None, 112, 180))
            names.append(name)
        for k in range(2, len(names)):
            hydrogens = methylene if k + 1 < len(names) else methyl
            if rows[k - 2][1] == "C":
                rows += hydrogens(names[k], names[k - 1], names[k - 2])
        sides[kind] = rows

    chain("ALA", [])
    chain("LYS", [("CG", "C"), ("CD", "C"), ("CE", "C"), ("NZ", "N")])
    sides["LYS"] += [(f"HZ{k}", "H", "NZ", "CE", "CD", 1.01, 109.5, turn) for k, turn in enumerate((60, 180, 300))]
    chain("SER", [("OG", "O")])
    sides["SER"] += [("HG", "H", "OG", "CB", "CA", 0.96, 107, 180)]
    chain("MET", [("CG", "C"), ("SD", "S"), ("CE", "C")])
    beta = [("CB", "C", "CA", "N", "C", 1.53, 110.5, -122)]
    two = methylene("CB", "CA", "N")
    sides["VAL"] = beta + [("CG1", "C", "CB", "CA", "N", None, 110.5, 180),
                           ("CG2", "C", "CB", "CA", "N", None, 110.5, -60),
                           ("HB", "H", "CB", "CA", "N", None, 109.5, 60)]
    sides["VAL"] += methyl("CG1", "CB", "CA") + methyl("CG2", "CB", "CA")
    sides["THR"] = beta + [("CG2", "C", "CB", "CA", "N", None, 110.5, 180),
                           ("OG1", "O", "CB", "CA", "N", None, 109.5, -60),
                           ("HB", "H", "CB", "CA", "N", None, 109.5, 60),
                           ("HG1", "H", "OG1", "CB", "CA", None, 107, 180)] + methyl("CG2", "CB", "CA")
    sides["LEU"] = beta + two + [("CG", "C", "CB", "CA", "N", None, 114, 180),
                                 ("CD1", "C", "CG", "CB", "CA", None, 110.5, 180),
                                 ("CD2", "C", "CG", "CB", "CA", None, 110.5, 60),
                                 ("HG", "H", "CG", "CB", "CA", None, 109.5, -60)]
    sides["LEU"] += methyl("CD1", "CG", "CB") + methyl("CD2", "CG", "CB")
    sides["ASP"] = beta + two + [("CG", "C", "CB", "CA", "N", 1.52, 113, 180),
                                 ("OD1", "O", "CG", "CB", "CA", 1.25, 118, 0),
                                 ("OD2", "O", "CG", "CB", "CA", 1.25, 118, 180)]
    sides["ASN"] = beta + two + [("CG", "C", "CB", "CA", "N", 1.52, 113, 180),
                                 ("OD1", "O", "CG", "CB", "CA", 1.23, 121, 0),
                                 ("ND2", "N", "CG", "CB", "CA", 1.33, 116, 180),
                                 ("HD21", "H", "ND2", "CG", "CB", 1.01, 120, 0),
                                 ("HD22", "H", "ND2", "CG", "CB", 1.01, 120, 180)]
    # A ring of six in a plane: each atom by the two before it.
    ring = [("CG", "C", "CB", "CA", "N", 1.51, 114, 180), ("CD1", "C", "CG", "CB", "CA", 1.39, 120, 90),
            ("CE1", "C", "CD1", "CG", "CB", 1.39, 120, 180), ("CZ", "C", "CE1", "CD1", "CG", 1.39, 120, 0),
            ("CE2", "C", "CZ", "CE1", "CD1", 1.39, 120, 0), ("CD2", "C", "CE2", "CZ", "CE1", 1.39, 120, 0)]
    around = ["CG", "CD1", "CE1", "CZ", "CE2", "CD2"]
    for k in range(1, 6):
        ring.append(("H" + around[k], "H", around[k], around[k - 1], around[k - 2], 1.08, 120, 180))
    sides["PHE"] = beta + two + ring
    sides["TRP"] = beta + two + [
        ("CG", "C", "CB", "CA", "N", 1.50, 114, 180), ("CD1", "C", "CG", "CB", "CA", 1.37, 127, 90),
        ("NE1", "N", "CD1", "CG", "CB", 1.38, 110, 180), ("CE2", "C", "NE1", "CD1", "CG", 1.38, 109, 0),
        ("CD2", "C", "CE2", "NE1", "CD1", 1.41, 107, 0), ("CE3", "C", "CD2", "CE2", "NE1", 1.40, 119, 180),
        ("CZ3", "C", "CE3", "CD2", "CE2", 1.39, 119, 0), ("CH2", "C", "CZ3", "CE3", "CD2", 1.40, 121, 0),
        ("CZ2", "C", "CH2", "CZ3", "CE3", 1.37, 121, 0),
        ("HD1", "H", "CD1", "CG", "CD2", 1.08, 125, 180), ("HE1", "H", "NE1", "CD1", "CG", 1.01, 125, 180),
        ("HE3", "H", "CE3", "CD2", "CE2", 1.08, 120, 180), ("HZ3", "H", "CZ3", "CE3", "CD2", 1.08, 120, 180),
        ("HH2", "H", "CH2", "CZ3", "CE3", 1.08, 120, 180), ("HZ2", "H", "CZ2", "CH2", "CZ3", 1.08, 120, 180)]
    return sides


RING_BONDS = {"PHE": [("CD2", "CG")], "TRP": [("CD2", "CG"), ("CZ2", "CE2")]}


def placed(a, b, c, bond, angle, dihedral):
    """The point at `bond` from a, at `angle` to b, at `dihedral` to c."""
    def minus(p, q):
        return [p[k] - q[k] for k in range(3)]

    def unit(p):
        size = math.sqrt(sum(x * x for x in p))
        return [x / size for x in p]

    def cross(p, q):
        return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]

    along = unit(minus(a, b))
    normal = unit(cross(minus(b, c), along))
    across = cross(normal, along)
    theta, phi = math.radians(angle), math.radians(dihedral)
    parts = (-bond * math.cos(theta), bond * math.sin(theta) * math.cos(phi), bond * math.sin(theta) * math.sin(phi))
    return [a[k] + parts[0] * along[k] + parts[1] * across[k] + parts[2] * normal[k] for k in range(3)]


class Peptide:
    def __init__(self):
        self.elements, self.places, self.bonds = [], [], []
        self.residue = {}

    def add(self, name, element, at):
        self.residue[name] = len(self.elements)
        self.elements.append(element)
        self.places.append(at)
        return self.residue[name]

    def hang(self, name, element, on, second, third, bond, angle, dihedral):
        """Adds an atom with its bond."""
        a, b, c = self.residue[on], self.residue[second], self.residue[third]
        kinds = tuple(sorted((element, self.elements[a])))
        bond = bond if bond is not None else LENGTHS[kinds][0]
        at = self.add(name, element, placed(self.places[a], self.places[b], self.places[c], bond, angle, dihedral))
        self.bonds.append((a, at))

    def build(self):
        sides = side_chains()
        for k, kind in enumerate(SEQUENCE):
            if k == 0:
                self.add("N", "N", [0.0, 0.0, 0.0])
                self.add("CA", "C", [1.46, 0.0, 0.0])
                self.bonds.append((0, 1))
                angle = math.radians(111)
                at = [1.46 - 1.53 * math.cos(angle), 1.53 * math.sin(angle), 0.0]
                self.add("C", "C", at)
                self.bonds.append((self.residue["CA"], self.residue["C"]))
                for turn in range(3):
                    self.hang(f"H{turn}", "H", "N", "CA", "C", 1.01, 109.5, 60 + 120 * turn)
            else:
                before = dict(self.residue)
                self.residue = {"C-": before["C"], "CA-": before["CA"], "N-": before["N"]}
                self.hang("N", "N", "C-", "CA-", "N-", 1.33, 117, PSI)
                self.hang("CA", "C", "N", "C-", "CA-", 1.46, 122, OMEGA)
                self.hang("C", "C", "CA", "N", "C-", 1.53, 111, PHI)
                self.hang("H", "H", "N", "C-", "CA-", 1.01, 119, 0)
            self.hang("HA", "H", "CA", "N", "C", 1.09, 109.5, 120 if kind != "GLY" else -120)
            for row in sides[kind]:
                self.hang(*row)
            for one, other in RING_BONDS.get(kind, []):
                self.bonds.append((self.residue[one], self.residue[other]))
            last = k + 1 == len(SEQUENCE)
            self.hang("O", "O", "C", "CA", "N", 1.25 if last else 1.23, 120, PSI + 180)
            if last:
                self.hang("OXT", "O", "C", "CA", "N", 1.25, 118, PSI)

    def angles(self):
        tied = [[] for _ in self.elements]
        for a, b in self.bonds:
            tied[a].append(b)
            tied[b].append(a)
        return [(one, middle, other) for middle, around in enumerate(tied)
                for n, one in enumerate(sorted(around)) for other in sorted(around)[n + 1:]]


def numbered(values):
    """Numbers of the different ones, from 1, and the number of each."""
    kinds = sorted(set(values))
    return kinds, [1 + kinds.index(value) for value in values]


def main():
    peptide = Peptide()
    peptide.build()
    elements, places = peptide.elements, peptide.places

    def distance(a, b):
        return math.dist(places[a], places[b])

    def angle(one, middle, other):
        p = [places[one][k] - places[middle][k] for k in range(3)]
        q = [places[other][k] - places[middle][k] for k in range(3)]
        return math.degrees(math.acos(sum(p[k] * q[k] for k in range(3)) / (math.hypot(*p) * math.hypot(*q))))

    def strength(a, b):
        return LENGTHS.get(tuple(sorted((elements[a], elements[b]))), (0, 450))[1]

    types, type_of = numbered(elements)
    bonds, bond_of = numbered([(strength(a, b), round(distance(a, b), 2)) for a, b in peptide.bonds])
    angles = peptide.angles()
    kinds, angle_of = numbered([(ANGLE_STRENGTH["H" in (elements[a], elements[c])], round(angle(a, b, c)))
                                for a, b, c in angles])
    low = [math.floor(min(p[k] for p in places)) - 8 for k in range(3)]
    high = [math.ceil(max(p[k] for p in places)) + 8 for k in range(3)]
    lines = ["LAMMPS data file of bench/structures/peptide.py: " + " ".join(SEQUENCE).title(), "",
             f"{len(elements)} atoms", f"{len(peptide.bonds)} bonds", f"{len(angles)} angles", "",
             f"{len(types)} atom types", f"{len(bonds)} bond types", f"{len(kinds)} angle types", ""]
    lines += [f"{low[k]} {high[k]} {axis}lo {axis}hi" for k, axis in enumerate("xyz")]
    lines += ["", "Masses", ""] + [f"{k + 1} {MASSES[element]} # {element}" for k, element in enumerate(types)]
    lines += ["", "Bond Coeffs # harmonic", ""] + [f"{k + 1} {s} {d:.2f}" for k, (s, d) in enumerate(bonds)]
    lines += ["", "Angle Coeffs # harmonic", ""] + [f"{k + 1} {s} {a}" for k, (s, a) in enumerate(kinds)]
    lines += ["", "Atoms # full", ""]
    for k, (kind, at) in enumerate(zip(type_of, places)):
        lines.append(f"{k + 1} 1 {kind} 0 " + " ".join(f"{x:.6f}" for x in at))
    lines += ["", "Bonds", ""] + [f"{k + 1} {bond_of[k]} {a + 1} {b + 1}" for k, (a, b) in enumerate(peptide.bonds)]
    lines += ["", "Angles", ""] + [f"{k + 1} {angle_of[k]} {a + 1} {b + 1} {c + 1}"
                                   for k, (a, b, c) in enumerate(angles)]
    print("\n".join(lines))


if __name__ == "__main__":
    main()
