"""Water that GROMACS has equilibrated, run on by GROMACS and by noether from the same state: temperature, pressure and g(r).

    python3 bench/peers/water_from_gromacs.py PROGRAM OUT [--span 200]     # ps of each run; minutes of one core

PROGRAM is noether, OUT a folder in which the runs stay. 512 SPC/E waters at 0.997 g/cm^3 that noether has placed are equilibrated by
gmx_d (20 ps at 300 K, v-rescale); from there both run without a bath: velocity Verlet with rigid molecules (md-vv), 2 fs, smooth PME
with a cutoff of 0.9 nm, Lennard-Jones cut there. The energy is then the same, so T is predicted, not set. Printed are means with errors
from blocks of ten, and the difference in units of its error. GROMACS runs in double precision; without gmx_d the script says so and ends."""

import argparse
import math
import pathlib
import re
import shutil
import sys

import h5py
import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import gromacs_water  # noqa: E402
import water_nanoseconds  # noqa: E402
import water_start  # noqa: E402

SIGMA, EPSILON, CHARGE, CUTOFF = 0.316555789, 0.65016944, 0.4238, 0.9  # SPC/E in nm, kJ/mol, e
BINS, RANGE = 180, 0.9  # nm
BAR = 16.605390666  # bar of one u/(nm ps^2)
PARAMETERS = """integrator = md-vv
dt = 0.002
nsteps = {steps}
cutoff-scheme = Verlet
coulombtype = PME
rcoulomb = 0.9
fourierspacing = 0.1
pme-order = 6
ewald-rtol = 1e-6
vdwtype = cutoff
vdw-modifier = Potential-shift
rvdw = 0.9
DispCorr = no
nstcalcenergy = 1
nstenergy = 25
nstxout-compressed = 100
compressed-x-precision = 100000
nstlog = 0
nstcomm = 0
comm-mode = none
verlet-buffer-tolerance = 1e-6
gen-vel = no
continuation = no
"""
BATH = """tcoupl = v-rescale
tc-grps = System
tau-t = 0.1
ref-t = 300
"""
DATA = """SPC/E that GROMACS has equilibrated, units = real

{atoms} atoms
{bonds} bonds
{angles} angles
2 atom types
1 bond types
1 angle types

0 {edge!r} xlo xhi
0 {edge!r} ylo yhi
0 {edge!r} zlo zhi

Masses

1 15.9994
2 1.008

Pair Coeffs # lj/cut/coul/long

1 {epsilon!r} {sigma!r}
2 0 0

Bond Coeffs # harmonic

1 450 1.0

Angle Coeffs # harmonic

1 55 109.47122063449069

"""
SCENE = """units = "molecular"
[particles]
structure = "start.data"
special = [0, 0, 0]
[hamiltonian]
type = "kinetic_potential"
[[hamiltonian.force]]
type = "lennard_jones"
cutoff = "0.9 nm"
cutoff_style = "shifted"
[[hamiltonian.force]]
type = "particle_mesh_ewald"
cutoff = "0.9 nm"
relative_error = 1e-5
[[hamiltonian.constraint]]
type = "rigid_molecules"
[integrator]
method = "verlet"
step = "2 fs"
until = "{span!r} ps"
[[every]]
type = "energy"
steps = 25
[[every]]
type = "temperature"
steps = 25
[[every]]
type = "pressure"
steps = 25
[[every]]
type = "radial_distribution"
steps = 100
types = ["1", "1"]
bins = {bins}
range = "{range!r} nm"
"""


def placed(program, folder):
    """The start of GROMACS: noether's last frame of 8 ps under a bath."""
    name = water_nanoseconds.warm(program, folder, "particle_mesh_ewald", 2, None, 0.01)
    with h5py.File(folder / f"{name}.out" / "run.h5", "r") as file:
        of = file["particles/system"]
        edge = float(of["box/edges/value"][-1][0])
        x, v, image = (of[key + "/value"][-1] for key in ("position", "velocity", "image"))
    return {"x": (x + edge * image).tolist(), "v": v.tolist(), "edge": edge}


class Runs:
    def __init__(self, folder):
        self.folder = folder

    program = "gmx_d"
    call = gromacs_water.Gromacs.call

    def run(self, name, start, steps, bath=""):
        """Runs from a start, and leaves NAME.edr, NAME.xtc and NAME.g96."""
        (self.folder / f"{name}.gro").write_text("\n".join(gromacs_water.coordinates(start)) + "\n")
        (self.folder / f"{name}.mdp").write_text(PARAMETERS.format(steps=steps) + bath)
        self.call("grompp", "-f", f"{name}.mdp", "-c", f"{name}.gro", "-p", "water.top", "-maxwarn", "9", "-o", f"{name}.tpr",
                  "-po", f"{name}.out.mdp")
        self.call("mdrun", "-deffnm", name, "-ntmpi", "1", "-ntomp", "1", "-nb", "cpu", "-pme", "cpu", "-pin", "off", "-notunepme",
                  "-c", f"{name}.g96")

    def last(self, name):
        """Places and velocities at the end, to nine decimals."""
        text = (self.folder / f"{name}.g96").read_text()

        def table(word):
            lines = re.search(rf"^{word}\n(.*?)^END", text, re.M | re.S).group(1).splitlines()
            return [[float(c) for c in line.split()[-3:]] for line in lines]

        return {"x": table("POSITION"), "v": table("VELOCITY")}

    def series(self, name, *terms):
        """{term: [...]} of the energy file."""
        self.call("energy", "-f", f"{name}.edr", "-o", f"{name}.xvg", "-dp", answers="\n".join(terms) + "\n\n")
        lines = (self.folder / f"{name}.xvg").read_text().splitlines()
        names = [re.search('"(.*)"', line).group(1) for line in lines if re.match(r"@ s\d+ legend", line)]
        columns = list(zip(*(map(float, line.split()) for line in lines if line[0] not in "@#")))[1:]
        return dict(zip(names, columns))

    def frames(self, name):
        """The oxygens of each frame, nm."""
        self.call("select", "-s", f"{name}.tpr", "-select", "name OW", "-on", "oxygens.ndx")
        self.call("trjconv", "-f", f"{name}.xtc", "-s", f"{name}.tpr", "-n", "oxygens.ndx", "-o", f"{name}.frames.g96")
        text = (self.folder / f"{name}.frames.g96").read_text()
        for block in re.findall(r"^POSITIONRED\n(.*?)^END", text, re.M | re.S):
            yield numpy.array(block.split(), dtype=float).reshape(-1, 3)


def whole(start, edge):
    """Molecules whose hydrogens are beside their oxygen."""
    x = [list(p) for p in start["x"]]
    for i, p in enumerate(x):
        if i % 3:
            p[:] = [c - edge * round((c - o) / edge) for c, o in zip(p, x[i - i % 3])]
    return {**start, "x": x, "edge": edge}


def data_file(start):
    """A LAMMPS data file, in angstrom and fs."""
    molecules, edge = len(start["x"]) // 3, 10 * start["edge"]
    text = DATA.format(atoms=3 * molecules, bonds=2 * molecules, angles=molecules, edge=edge, epsilon=EPSILON / 4.184, sigma=10 * SIGMA)
    text += "Atoms # full\n\n"
    for i, x in enumerate(start["x"]):
        charge = CHARGE if i % 3 else -2 * CHARGE
        text += f"{i + 1} {i // 3 + 1} {2 if i % 3 else 1} {charge!r} " + " ".join(repr(10 * c) for c in x) + "\n"
    text += "\nVelocities\n\n"
    for i, v in enumerate(start["v"]):
        text += f"{i + 1} " + " ".join(repr(c / 100) for c in v) + "\n"
    text += "\nBonds\n\n"
    text += "".join(f"{k + 1} 1 {3 * (k // 2) + 1} {3 * (k // 2) + 2 + k % 2}\n" for k in range(2 * molecules))
    text += "\nAngles\n\n"
    return text + "".join(f"{k + 1} 1 {3 * k + 2} {3 * k + 1} {3 * k + 3}\n" for k in range(molecules))


def blocks_of_frames(frames, edge):
    """g(r) of oxygens in ten blocks of the frames, shape (10, bins)."""
    frames = list(frames)[1:]
    ends = numpy.linspace(0, RANGE, BINS + 1)
    shells = 4 / 3 * math.pi * numpy.diff(ends**3)
    n = len(frames[0])
    upper = numpy.triu_indices(n, 1)

    def counts(x):
        d = x[upper[0]] - x[upper[1]]
        d -= edge * numpy.round(d / edge)
        return numpy.histogram(numpy.sqrt((d * d).sum(1)), ends)[0]

    return numpy.array([2 * sum(counts(frames[k]) for k in block) / (len(block) * n * (n - 1) * shells / edge**3)
                        for block in numpy.array_split(numpy.arange(len(frames)), 10)])


def blocks_of_averages(average):
    """The same from averages over the samples so far, shape (samples, bins)."""
    ends = [round(k * (len(average) - 1) / 10) for k in range(11)]
    return numpy.array([((b + 1) * average[b] - (a + 1) * average[a]) / (b - a) for a, b in zip(ends, ends[1:])])


def mean(values):
    """Mean and its error by ten blocks."""
    size = len(values) // 10
    blocks = [sum(values[k * size:(k + 1) * size]) / size for k in range(10)]
    centre = sum(blocks) / 10
    return centre, math.sqrt(sum((b - centre) ** 2 for b in blocks) / 90)


def beside(name, unit, ours, theirs):
    (a, ea), (b, eb) = ours, theirs
    print(f"{name:24} noether {a:10.4f} +- {ea:.4f}   GROMACS {b:10.4f} +- {eb:.4f} {unit:4}  {(a - b) / math.hypot(ea, eb):+.1f} errors", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--span", type=float, default=200, help="ps of each run")
    given = parser.parse_args()
    if not shutil.which("gmx_d"):
        sys.exit("skipped: GROMACS in double precision (gmx_d) is not there")
    given.out.mkdir(parents=True, exist_ok=True)
    steps = round(given.span / 0.002)

    begun = placed(given.program, given.out)
    edge = begun["edge"]
    (given.out / "water.top").write_text(gromacs_water.topology({**begun, "sigma": SIGMA, "epsilon": EPSILON, "charge": CHARGE}))
    gromacs = Runs(given.out)
    gromacs.run("bath", begun, round(20 / 0.002), BATH)
    start = whole(gromacs.last("bath"), edge)
    (given.out / "start.data").write_text(data_file(start))
    gromacs.run("on", start, steps)
    (given.out / "on.toml").write_text(SCENE.format(span=given.span, bins=BINS, range=RANGE))
    water_nanoseconds.run(given.program, given.out, "ours", (given.out / "on.toml").read_text().split("\n", 1)[1])

    theirs = gromacs.series("on", "Temperature", "Pressure", "Total-Energy")
    with h5py.File(given.out / "ours.out" / "run.h5", "r") as file:
        monitors = file["noether/monitors"]
        ours = {key: numpy.asarray(monitors[key]) for key in ("temperature/value", "pressure/value", "energy/total")}
        g = blocks_of_averages(numpy.asarray(monitors["radial_distribution/value"]))
    beside("temperature", "K", mean(ours["temperature/value"]), mean(theirs["Temperature"]))
    beside("pressure", "bar", mean(BAR * ours["pressure/value"]), mean(theirs["Pressure"]))
    beside("energy, atom", "kJ/mol", mean(ours["energy/total"] / 1536), mean(numpy.array(theirs["Total Energy"]) / 1536))
    other = blocks_of_frames(gromacs.frames("on"), edge)
    r = RANGE / BINS * (numpy.arange(BINS) + 0.5)
    for place in (0.265, 0.275, 0.285, 0.335, 0.45, 0.565, 0.685):  # both sides of the first peak, minima and later peaks
        k = int(numpy.argmin(abs(r - place)))
        beside(f"g({r[k]:.4f} nm)", "", mean(g[:, k]), mean(other[:, k]))
    error = numpy.hypot(g.std(0), other.std(0)) / 3  # of means of ten blocks
    seen = (g.mean(0) > 0.01) & (error > 0)
    chi = ((g.mean(0) - other.mean(0))[seen] / error[seen]) ** 2
    print(f"g(r) in {seen.sum()} bins: mean square of the difference in errors {chi.mean():.2f}, largest {math.sqrt(chi.max()):.1f}")


if __name__ == "__main__":
    main()
