"""GROMACS on the water of bench/water.cpp: rigid SPC/E by SETTLE, 2 fs, a list with the buffer that GROMACS chooses.

    gromacs_water.py gmx_d|gmx pme|reaction_field START [THREADS]     in double, in mixed precision

PME as the defaults have it: 0.12 nm, order 4, and not tuned while it runs. Greets with version and SIMD instructions, which packages
choose with care for old processors; then answers as `water_start.serve` says: processor seconds of one thread, wall seconds of more,
less those of a run of no steps, each time from the same start. Ends at once without GROMACS."""

import os
import pathlib
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True

import water_start  # noqa: E402

PARAMETERS = """integrator = md
dt = 0.002
nsteps = -1
cutoff-scheme = Verlet
coulombtype = {charges}
rcoulomb = {cutoff}
epsilon-rf = 0
fourierspacing = {spacing}
pme-order = {order}
ewald-rtol = {rtol}
vdwtype = cutoff
vdw-modifier = Potential-shift
rvdw = {cutoff}
nstcalcenergy = 100
nstenergy = 100
nstfout = 1000000
nstlog = 0
nstcomm = 100
gen-vel = no
continuation = yes
"""


def topology(start):
    molecules = len(start["x"]) // 3
    return f"""[ defaults ]
1 2 no 1.0 1.0
[ atomtypes ]
OW 8 {water_start.OXYGEN} 0.0 A {start["sigma"]!r} {start["epsilon"]!r}
HW 1 {water_start.HYDROGEN} 0.0 A 0.0 0.0
[ moleculetype ]
SOL 2
[ atoms ]
1 OW 1 SOL OW 1 {-2 * start["charge"]!r} {water_start.OXYGEN}
2 HW 1 SOL HW1 1 {start["charge"]!r} {water_start.HYDROGEN}
3 HW 1 SOL HW2 1 {start["charge"]!r} {water_start.HYDROGEN}
[ settles ]
1 1 {water_start.BOND} {water_start.ACROSS!r}
[ exclusions ]
1 2 3
2 1 3
3 1 2
[ system ]
water
[ molecules ]
SOL {molecules}
"""


def coordinates(start):
    yield "water"
    yield str(len(start["x"]))
    for i, (x, v) in enumerate(zip(start["x"], start["v"])):
        name = ("OW", "HW1", "HW2")[i % 3]
        yield (f"{(i // 3 + 1) % 100000:5d}SOL  {name:>5}{(i + 1) % 100000:5d}" + "".join(f"{c:18.13f}" for c in x) +
               "".join(f"{c:18.14f}" for c in v))
    yield " ".join([f"{start['edge']:.13f}"] * 3)


class Gromacs:
    def __init__(self, program, charges, start, threads, folder, spacing=0.12, order=4, rtol=1e-5):
        self.program, self.threads, self.folder = program, threads, folder
        (folder / "water.gro").write_text("\n".join(coordinates(start)) + "\n")
        (folder / "water.top").write_text(topology(start))
        kind = {"pme": "PME", "reaction_field": "Reaction-Field"}[charges]
        for name, every in (("water", "1000000"), ("forces", "1")):
            text = PARAMETERS.format(charges=kind, cutoff=start["cutoff"], spacing=spacing, order=order, rtol=rtol)
            (folder / f"{name}.mdp").write_text(text.replace("1000000", every))
            self.call("grompp", "-f", f"{name}.mdp", "-c", "water.gro", "-p", "water.top", "-maxwarn", "9", "-o",
                      f"{name}.tpr", "-po", f"{name}.out.mdp")
        self.run(0)

    def call(self, *command, answers=None):
        done = subprocess.run((self.program, *command), cwd=self.folder, input=answers, capture_output=True, text=True, check=False,
                              env={key: value for key, value in os.environ.items() if key != "OMP_NUM_THREADS"})
        if done.returncode != 0:
            sys.exit(done.stderr[-2000:])

    def mdrun(self, name, *more):
        self.call("mdrun", "-s", name + ".tpr", "-deffnm", name, "-ntmpi", "1", "-ntomp", str(self.threads), "-nb", "cpu",
                  "-pme", "cpu", "-bonded", "cpu", "-pin", "off", "-noconfout", "-notunepme", *more)

    def run(self, steps):
        """The processor seconds of a whole run, setup and all; of more threads the wall seconds."""
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        self.mdrun("water", "-nsteps", str(steps))
        if self.threads > 1:
            return time.perf_counter() - begin
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime

    def version(self):
        log = (self.folder / "water.log").read_text()
        return "/".join(re.search(rf"{key}:\s*(\S+)", log).group(1) for key in ("GROMACS version", "SIMD instructions"))

    def forces(self):
        """[[fx, fy, fz], ...] of the start."""
        self.mdrun("forces", "-nsteps", "0")
        numbers = forces_of((self.folder / "forces.trr").read_bytes())
        return [numbers[k:k + 3] for k in range(0, len(numbers), 3)]

    def error(self, exact):
        forces = self.forces()
        return water_start.error(exact, lambda i: forces[i])


def forces_of(data):
    """The forces of the first frame of a .trr file, one after the other."""
    magic, _, length = struct.unpack_from(">3i", data)
    if magic != 1993:
        sys.exit("not a .trr file")
    at = 12 + (length + 3) // 4 * 4
    sizes = struct.unpack_from(">13i", data, at)  # ir, e, box, vir, pres, top, sym, x, v, f; natoms, step, nre
    x_size, v_size, f_size, atoms = *sizes[7:10], sizes[10]
    wide = (sizes[2] or x_size // atoms * 3) == 72  # of the box: nine numbers
    at += 13 * 4 + 2 * (8 if wide else 4) + sizes[2] + sizes[3] + sizes[4] + x_size + v_size
    return struct.unpack_from(f">{3 * atoms}{'d' if f_size == 24 * atoms else 'f'}", data, at)


def main(program, charges, start, threads="1"):
    if not shutil.which(program):
        return
    with tempfile.TemporaryDirectory() as name:
        gromacs = Gromacs(program, charges, water_start.read(start), int(threads), pathlib.Path(name))
        setup = sorted(gromacs.run(0) for _ in range(3))[1]
        water_start.serve(gromacs.version(), lambda steps: gromacs.run(steps) - setup, gromacs.error)


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    main(*sys.argv[1:])
