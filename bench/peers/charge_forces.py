"""Forces of charged water by other programs beside noether's, all against Ewald's sum: a table for docs/theory/long_range.md.

    charge_forces.py PROGRAM [MOLECULES [ATOM...]]     PROGRAM is noether's; 216 molecules of SPC/E unless told

One box, that of the builder water_box with seed 7, and its forces at a cutoff of 0.9 nm: Lennard-Jones, cut off plainly, and charges
with all their images. Truth is `ewald` asked for 1e-13. Errors are root mean squares over all atoms in units of C <q^2> (n/V)^(2/3).
Programs that are not installed are left out. Of ATOMs, counted from 0, it prints the forces too, in kJ/mol/nm: so the numbers of
tests/forces/charges_of_others_test.cpp were made."""

import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True

import gromacs_water  # noqa: E402
import openmm_water  # noqa: E402
import water_start  # noqa: E402

COULOMB = 138.93545764498225  # kJ/mol nm/e^2
SCENE = """units = "molecular"
[particles]
type = "water_box"
model = "spce"
molecules = {molecules}
density = "0.997 g/cm^3"
seed = 7
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = "0.9 nm"
cutoff_style = "plain"
[[hamiltonian.force]]
type = "{kind}"
cutoff = "0.9 nm"
relative_error = {error}
[[hamiltonian.constraint]]
type = "rigid_molecules"
[integrator]
method = "verlet"
step = "2 fs"
steps = 1
[[every]]
type = "trajectory"
steps = 1
"""


class Water:
    """The box, and how far forces in it are from Ewald's sum."""

    def __init__(self, program, molecules, folder):
        self.program, self.molecules, self.folder = str(pathlib.Path(program).resolve()), molecules, folder
        self.truth = self.forces("ewald", 1e-13)
        self.start = self.positions()
        atoms = 3 * molecules
        squares = 2 * self.start["charge"] ** 2  # (4 + 1 + 1)/3 of it
        self.unit = COULOMB * squares * (atoms / self.start["edge"] ** 3) ** (2 / 3)

    def call(self, command, kind, error, *more):
        (self.folder / "scene.toml").write_text(SCENE.format(molecules=self.molecules, kind=kind, error=error))
        subprocess.run((self.program, command, "scene.toml", *more), cwd=self.folder, capture_output=True, check=True)

    def forces(self, kind, error, *more):
        """[[fx, fy, fz], ...] by noether, in kJ/mol/nm."""
        self.call("evaluate", kind, error, "--forces", "forces.csv", *more)
        with (self.folder / "forces.csv").open() as file:
            return [[float(row[f"f{axis}"]) for axis in "xyz"] for row in csv.DictReader(file)]

    def positions(self):
        """The start, in the form of water_start.py: molecules whole."""
        self.call("run", "ewald", 1e-3, "--fresh", "--out", "start")
        subprocess.run((self.program, "convert", "start/run.h5", "start.csv"), cwd=self.folder, capture_output=True, check=True)
        edge = (self.molecules * (water_start.OXYGEN + 2 * water_start.HYDROGEN) / (0.997 * 602.214076)) ** (1 / 3)
        with (self.folder / "start.csv").open() as file:
            rows = [row for row in csv.DictReader(file) if row["step"] == "0"]
        x = [[float(row[f"{axis} [nm]"]) for axis in "xyz"] for row in rows]
        for i, place in enumerate(x):
            x[i] = [c - edge * round((c - o) / edge) for c, o in zip(place, x[i // 3 * 3])]
        return {"edge": edge, "cutoff": 0.9, "sigma": 0.316555789, "epsilon": 78.19743111 * 0.00831446261815324,
                "charge": 0.4238, "x": x, "v": [[0.0] * 3] * len(x)}

    def error(self, forces):
        squares = sum((f - e) ** 2 for one, exact in zip(forces, self.truth) for f, e in zip(one, exact))
        return (squares / len(self.truth)) ** 0.5 / self.unit


def by_noether(water):
    for error in (1e-3, 1e-5, 1e-7, 1e-9):
        yield f"noether, particle_mesh_ewald, asked for {error:.0e}", water.forces("particle_mesh_ewald", error)
    yield "noether, particle_mesh_ewald of order 8, asked for 1e-11", water.forces(
        "particle_mesh_ewald", 1e-11, "--set", "hamiltonian.force.particle_mesh_ewald.order=8")


def by_openmm(water):
    try:
        import openmm as mm
    except (ImportError, OSError) as error:
        print(f"openmm: {error}", file=sys.stderr)
        return
    for platform, kind, tolerance in (("CPU", "pme", 5e-4), ("Reference", "pme", 5e-4), ("Reference", "pme", 1e-6),
                                      ("Reference", "pme", 1e-8), ("Reference", "ewald", 5e-4), ("Reference", "ewald", 1e-8)):
        context = openmm_water.context_of(mm, water.start, kind, platform, "1", tolerance)
        yield (f"OpenMM {mm.version.version}, {platform} platform, {kind}, tolerance {tolerance:.0e}",
               openmm_water.forces_in(mm, context))


def by_gromacs(water):
    for program in ("gmx", "gmx_d"):
        if not shutil.which(program):
            print(f"{program} is not installed", file=sys.stderr)
            continue
        for spacing, order, rtol in ((0.12, 4, 1e-5), (0.06, 6, 1e-7), (0.03, 8, 1e-9)):
            if program == "gmx" and order > 4:
                continue
            with tempfile.TemporaryDirectory() as name:
                gromacs = gromacs_water.Gromacs(program, "pme", water.start, 1, pathlib.Path(name), spacing, order, rtol)
                yield (f"GROMACS {gromacs.version()}, {'double' if program == 'gmx_d' else 'mixed'}, {spacing} nm, order {order}, "
                       f"ewald-rtol {rtol:.0e}", gromacs.forces())


def main(program, molecules="216", *atoms):
    with tempfile.TemporaryDirectory() as name:
        water = Water(program, int(molecules), pathlib.Path(name))
        print("| forces by | error |\n|---|---|")
        for by in (by_noether, by_openmm, by_gromacs):
            for what, forces in by(water):
                print(f"| {what} | {water.error(forces):.1e} |", flush=True)
                for atom in atoms:
                    print(f"  {atom}: " + ", ".join(f"{f:.10g}" for f in forces[int(atom)]))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
