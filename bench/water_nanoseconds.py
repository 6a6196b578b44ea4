"""Nanoseconds of 512 rigid SPC/E waters at 0.997 g/cm^3: the drift of the energy, and the dielectric constant. Hours, on one core.

    python3 bench/water_nanoseconds.py PROGRAM OUT drift         # 1 ns each
    python3 bench/water_nanoseconds.py PROGRAM OUT dielectric    # 5 ns
    python3 bench/water_nanoseconds.py PROGRAM OUT large         # 7754 waters, 0.1 ns
    python3 bench/water_nanoseconds.py PROGRAM OUT mixed         # 0.5 ns each
    python3 bench/water_nanoseconds.py PROGRAM OUT drift dielectric --span 0.01

PROGRAM is noether, OUT a folder in which its runs stay; what was begun there goes on. A start is 8 ps under BAOAB at 300 K (of a
trial of less than 0.01, less).

**drift**: `verlet` without a bath, charges in a reaction field (0.9 nm, switched by switch_c4 from 0.7 nm) and by particle mesh Ewald, at 2 fs and,
with hydrogens of 3 u, at 4 fs. The drift is that of the report, from the slope through block means, in kT/ns/atom with its error. Asked: below 1e-3,
known to 1e-3. **large** is the same of 7754 waters in a reaction field at 2 fs, **mixed** that of both with `precision = "mixed"` at 2 fs.

**dielectric**: under a bath of 0.2/ps, by particle mesh Ewald in mixed precision, from the fluctuations of the dipole moment; at 4 fs with hydrogens
of 3 u, since masses do not change what an ensemble tells of places."""

import argparse
import json
import pathlib
import subprocess

PARTICLES = """[particles]
type = "water_box"
model = "spce"
molecules = {molecules}
density = "0.997 g/cm^3"
temperature = "300 K"
seed = 7
{hydrogens}
"""
FORCES = """[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = "0.9 nm"
cutoff_style = "switch_c4"
switch_from = "0.7 nm"
[[hamiltonian.force]]
type = "{kind}"
cutoff = "0.9 nm"
{keys}
[[hamiltonian.constraint]]
type = "rigid_molecules"
"""
BATH = """[hamiltonian.thermostat]
type = "langevin"
temperature = "300 K"
friction = "{friction}/ps"
seed = 3
"""
RUN = """[integrator]
method = "{method}"
step = "{step} fs"
until = "{until!r} ps"
"""
LOOK = """[[every]]
type = "{what}"
steps = {steps}
{keys}
"""
CHARGES = {"reaction_field": 'switch_from = "0.7 nm"', "particle_mesh_ewald": "relative_error = 1e-5"}


def run(program, folder, name, text):
    """The report of a run, which goes on where it was begun."""
    scene = folder / f"{name}.toml"
    scene.write_text('units = "molecular"\n' + text)
    out = folder / f"{name}.out"
    command = [program, "run", str(scene), "--out", str(out), "--json"] + (["--resume"] if out.exists() else [])
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(done.stderr or done.stdout)
    return json.loads(done.stdout.splitlines()[-1])


def warm(program, folder, kind, step, hydrogens, span, molecules=512):
    """The name of a run whose last frame is a start at 300 K."""
    name = f"warm_{kind}_{step}fs" + ("" if molecules == 512 else f"_{molecules}")
    keys = f'hydrogen_mass = "{hydrogens} u"' if hydrogens else ""
    run(program, folder, name, PARTICLES.format(hydrogens=keys, molecules=molecules) + FORCES.format(kind=kind, keys=CHARGES[kind]) +
        BATH.format(friction=5) + '[minimize]\nmax_force = "100 kJ/mol/nm"\n' +
        RUN.format(method="BAOAB", step=step, until=min(8.0, 800 * span)) + LOOK.format(what="trajectory", steps=500, keys=""))
    return name


def start_of(name):
    """[particles] from the last frame of a run."""
    return f'[particles]\nbodies = "{name}.out/run.h5"\n'


def without_bath(program, folder, name, begun, kind, step, until, more=""):
    report = run(program, folder, name,
                 start_of(begun) + FORCES.format(kind=kind, keys=CHARGES[kind] + more) + RUN.format(method="verlet", step=step, until=until) +
                 LOOK.format(what="energy", steps=10, keys="") + LOOK.format(what="temperature", steps=10, keys=""))
    print(kind, f"{step} fs:", json.dumps(report["monitors"]), flush=True)


def drift(program, folder, span):
    for kind in CHARGES:
        for step, hydrogens in ((2, None), (4, 3)):
            begun = warm(program, folder, kind, step, hydrogens, span)
            without_bath(program, folder, f"drift_{kind}_{step}fs", begun, kind, step, 1000 * span)


def mixed(program, folder, span):
    for kind in CHARGES:
        begun = warm(program, folder, kind, 2, None, span)
        without_bath(program, folder, f"mixed_{kind}_2fs", begun, kind, 2, 500 * span, '\nprecision = "mixed"')


def large(program, folder, span):
    begun = warm(program, folder, "reaction_field", 2, None, span, molecules=7754)
    without_bath(program, folder, "large", begun, "reaction_field", 2, 100 * span)


def dielectric(program, folder, span):
    kind = "particle_mesh_ewald"
    begun = warm(program, folder, kind, 4, 3, span)
    report = run(program, folder, "dielectric",
                 start_of(begun) + FORCES.format(kind=kind, keys=CHARGES[kind] + '\nprecision = "mixed"') +
                 BATH.format(friction=0.2) + RUN.format(method="BAOAB", step=4, until=5000 * span) +
                 LOOK.format(what="dielectric_constant", steps=25, keys='temperature = "300 K"') +
                 LOOK.format(what="temperature", steps=25, keys=""))
    print("dielectric constant:", json.dumps(report["monitors"]), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("what", nargs="+", choices=["drift", "large", "mixed", "dielectric"])
    parser.add_argument("--span", type=float, default=1.0, help="of the spans above, for a trial")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    for what in given.what:
        {"drift": drift, "large": large, "mixed": mixed, "dielectric": dielectric}[what](given.program, given.out, given.span)


if __name__ == "__main__":
    main()
