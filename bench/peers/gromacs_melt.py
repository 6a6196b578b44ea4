"""GROMACS on the Lennard-Jones melt of LAMMPS's bench/in.lj, as argon: 32 000 atoms, one core.

    gromacs_melt.py gmx_d|gmx     in double, in mixed precision

A list every 20 steps with a buffer of 0.3 sigma, a plain cutoff at 2.5 sigma, energies every 100 steps. Greets with version
and SIMD instructions, which packages choose with care for old processors; then reads numbers of steps, one per line, and
answers with the processor seconds of so many, as the system counts them for the process, less those of a run of no steps;
each time from the same melt, 200 steps after the lattice. (The log cannot be asked: its "Core t" of one thread is wall time
in the packages of Debian.) Ends at once without GROMACS."""

import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

SIGMA, EPSILON, MASS = 0.34, 0.997, 39.948  # nm, kJ/mol, u
CELLS = 20
TIME = SIGMA * (MASS / EPSILON) ** 0.5  # ps

TOPOLOGY = f"""[ defaults ]
1 2 no 1.0 1.0
[ atomtypes ]
AR 18 {MASS} 0.0 A {SIGMA} {EPSILON}
[ moleculetype ]
argon 0
[ atoms ]
1 AR 1 AR AR 1 0.0 {MASS}
[ system ]
melt
[ molecules ]
argon {4 * CELLS**3}
"""

PARAMETERS = f"""integrator = md
dt = {0.005 * TIME}
nsteps = -1
cutoff-scheme = Verlet
nstlist = 20
verlet-buffer-tolerance = -1
rlist = {2.8 * SIGMA}
coulombtype = cutoff
rcoulomb = {2.5 * SIGMA}
vdwtype = cutoff
vdw-modifier = none
rvdw = {2.5 * SIGMA}
nstcalcenergy = 100
nstenergy = 100
nstlog = 0
nstcomm = 100
gen-vel = no
"""


def atoms():
    """Lines of the .gro file: a face-centred lattice at temperature 1.44."""
    edge = (4 / 0.8442) ** (1 / 3) * SIGMA
    speed = (1.44 * EPSILON / MASS) ** 0.5  # nm/ps
    number = random.Random(87287).gauss
    yield "melt"
    yield str(4 * CELLS**3)
    corners = [(x, y, z) for z in range(CELLS) for y in range(CELLS) for x in range(CELLS)]
    places = [[c + b for c, b in zip(corner, base)] for corner in corners
              for base in ((0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5))]
    for i, place in enumerate(places, 1):
        at = "".join(f"{edge * x:12.7f}" for x in place)
        yield f"{i % 100000:5d}argon   AR{i % 100000:5d}{at}" + "".join(f"{number(0, speed):12.8f}" for _ in range(3))
    yield " ".join([f"{CELLS * edge:.7f}"] * 3)


def call(folder, *command):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stderr[-2000:])


def prepare(program, folder):
    """Writes molten.tpr."""
    (folder / "melt.gro").write_text("\n".join(atoms()) + "\n")
    (folder / "melt.top").write_text(TOPOLOGY)
    (folder / "melt.mdp").write_text(PARAMETERS)
    begin = (program, "grompp", "-f", "melt.mdp", "-c", "melt.gro", "-p", "melt.top", "-maxwarn", "9", "-o")
    call(folder, *begin, "lattice.tpr")
    run(program, folder, "lattice", 200)
    call(folder, *begin, "molten.tpr", "-t", "lattice.cpt")


def run(program, folder, start, steps):
    """The processor seconds of a whole run, setup and all."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    call(folder, program, "mdrun", "-s", start + ".tpr", "-g", start + ".log", "-cpo", start + ".cpt", "-ntmpi", "1",
         "-ntomp", "1", "-nsteps", str(steps), "-nb", "cpu", "-pin", "off", "-confout" if start == "lattice" else "-noconfout")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main(program):
    if not shutil.which(program):
        return
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(program, folder)
        setup = sorted(run(program, folder, "molten", 0) for _ in range(5))[2]
        log = (folder / "molten.log").read_text()
        version, lanes = (re.search(rf"{key}:\s*(\S+)", log).group(1) for key in ("GROMACS version", "SIMD instructions"))
        print(f"{version}/{lanes}", flush=True)
        for steps in sys.stdin:
            print(repr(run(program, folder, "molten", int(steps)) - setup), flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
