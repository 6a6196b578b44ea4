#!/usr/bin/env python3
"""Measures the Python package: import, loading, steps, functions of one's own, memory, other OpenMP runtimes beside it.

    PYTHONPATH=build/release/python build/python/bin/python bench/python_package.py [PART...]

Parts: load steps functions memory runtimes. Times are those of the processor, of all threads together, so that other work
on the machine counts little; they are medians. What is compared runs in turn, and a ratio is the median of those of the
turns. The program is the one that NOETHER_PROGRAM names, or that of the package. numba and scikit-learn are peers: where one
is absent, its rows are left out with a word.
"""

import gc
import math
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

TURNS = 9


def row(what, value, unit, note=""):
    print(f"python_package   {what:40s} {value:10.4g} {unit:8s} {note}", flush=True)


def in_turn(turns=TURNS, **measures):
    """Medians of what each measure returns, and of its ratio to the first."""
    told = {name: [] for name in measures}
    for _ in range(turns):
        for name, measure in measures.items():
            told[name].append(measure())
    first = next(iter(told.values()))
    return {name: (statistics.median(one), statistics.median(mine / other for mine, other in zip(one, first)))
            for name, one in told.items()}


def in_new_python(code):
    """What the code prints, in a Python of its own: a number."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return float(done.stdout)


def load(nt):
    timed = "import time{0}; t = time.process_time(); import noether; print(time.process_time() - t)"
    for beside in ("numpy", "numpy, h5py"):
        taken = statistics.median(in_new_python(timed.format(", " + beside)) for _ in range(TURNS))
        row(f"import beside {beside}", taken * 1e3, "ms")
    for name in ("figure_eight", "outer_solar_system"):
        times = []
        for _ in range(200):
            begin = time.process_time()
            nt.Scene(name)
            times.append(time.process_time() - begin)
        row(f"the scene {name} loaded", statistics.median(times) * 1e3, "ms")


def two_bodies(nt, force=None, **claims):
    bodies = nt.Particles()
    bodies.add("star", m=0.75, x=[0, 0, 0], v=[0, 0, 0])
    bodies.add("planet", m=0.25, x=[1, 0, 0], v=[0, 1, 0])
    sim = nt.Simulation(bodies, method="verlet", step=0.001)
    sim.add_force(force or nt.Gravity(), **claims)
    return sim


def planets(nt):
    return nt.Simulation(nt.bodies.outer_solar_system(), method="aba_10_6_4", hamiltonian=nt.WisdomHolman(), step="100 day")


def liquid(nt):
    atoms = nt.Particles(nt.builders.Lattice(cells=[10, 10, 10], density=0.8442, mass=1), temperature=1.44)
    sim = nt.Simulation(atoms, method="verlet", step=0.005)
    return sim.add_force(nt.LennardJones(epsilon=1, sigma=1, cutoff=2.5, cutoff_style="switch_c4"))


def per_step(sim, steps):
    """A measure of a step by objects [ns]."""
    sim.run(100)

    def measure():
        begin = time.process_time()
        sim.run(steps)
        return (time.process_time() - begin) / steps * 1e9
    return measure


def per_step_of_program(nt, scene, steps):
    """The same of the program, less what it takes to start and to end."""
    def taken(count):
        scene["integrator"]["steps"] = count
        with open("scene.toml", "w") as out:
            out.write(nt.Scene(scene).toml)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([*nt.files.program(), "run", "scene.toml", "--out", "of_the_program", "--fresh", "--threads",
                        str(nt.threads())], check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return lambda: (taken(steps + 100) - taken(100)) / steps * 1e9


def steps(nt):
    """A step by objects and by the program, on one thread: a loop over two bodies, Wisdom-Holman, pairs in lanes."""
    threads = nt.threads()
    nt.threads(1)
    for name, make, count in (("two bodies by leapfrog", two_bodies, 8_000_000), ("planets by aba_10_6_4", planets, 100_000),
                              ("lj_melt", liquid, 2000)):
        told = in_turn(program=per_step_of_program(nt, make(nt).tree(), count), objects=per_step(make(nt), count))
        row(f"{name}, by the program", told["program"][0], "ns")
        row(f"{name}, by objects", told["objects"][0], "ns", f"{told['objects'][1]:.3f} of the program's")
    nt.threads(threads)


def functions(nt):
    def empty(t, x, v, m, a):
        return 0.0

    measures = {"the built-in gravity": per_step(two_bodies(nt), 4_000_000)}
    try:
        import numba
    except ImportError:
        print("python_package   numba is absent: no row of a compiled force")
    else:
        @numba.cfunc(nt.force_signature())
        def gravity(n, stride, t, x, v, m, a, user):
            dx, dy, dz = x[1] - x[0], x[1 + stride] - x[stride], x[1 + 2 * stride] - x[2 * stride]
            r = math.sqrt(dx * dx + dy * dy + dz * dz)
            w = 1.0 / (r * r * r)
            a[0], a[stride], a[2 * stride] = m[1] * w * dx, m[1] * w * dy, m[1] * w * dz
            a[1], a[1 + stride], a[1 + 2 * stride] = -m[0] * w * dx, -m[0] * w * dy, -m[0] * w * dz
            return -m[0] * m[1] / r

        measures["gravity by numba"] = per_step(two_bodies(nt, gravity), 4_000_000)
    measures["an empty function of Python"] = per_step(two_bodies(nt, empty), 200_000)
    for name, (taken, ratio) in in_turn(**measures).items():
        row(f"a step with {name}", taken, "ns", "" if name == "the built-in gravity" else f"{ratio:.2f} of the built-in one")


def memory(nt):
    """What stays of simulations that were made, run and dropped."""
    def make(count):
        for _ in range(count):
            sim = planets(nt)
            sim.every(10, nt.Energy())
            sim.every(10, lambda t, x, v, m: x[0, 0])
            sim.run(20)
            sim.positions
        gc.collect()
        with open("/proc/self/statm") as told:
            return int(told.read().split()[1]) * resource.getpagesize() / 1024

    before = make(200)
    begin = time.process_time()
    grown = make(1000) - before
    row("memory after 1000 simulations", grown, "kB", f"made, run and dropped in {time.process_time() - begin:.2f} s")


LIQUID = """
import time
{first}
import noether as nt
{last}
scene = nt.Scene("lj_melt", set={{"integrator.steps": 200, "every": []}})
scene.run(out="a", existing="fresh")
begin = {clock}
scene.run(out="b", existing="fresh")
print({clock} - begin)
"""


def runtimes(nt):
    """Steps on all threads beside other libraries: those that wait for work must not take processors away."""
    learn = ("import numpy; from sklearn.cluster import KMeans; "
             "KMeans(2, n_init=1).fit(numpy.random.default_rng(1).normal(size=(20000, 4)))")
    cases = {"alone": ("", "")}
    for name, code in (("h5py", "import h5py; f = h5py.File('open.h5', 'w'); f['x'] = [1.0]"), ("scikit-learn", learn)):
        if subprocess.run([sys.executable, "-c", code], capture_output=True).returncode:
            print(f"python_package   {name} is absent: no row of it")
        else:
            cases[f"{name} before"], cases[f"{name} after"] = (code, ""), ("", code)
    for clock, what in (("time.process_time()", "of the processor"), ("time.perf_counter()", "of the clock")):
        told = in_turn(5, **{name: (lambda first=first, last=last: in_new_python(
            LIQUID.format(first=first, last=last, clock=clock))) for name, (first, last) in cases.items()})
        for name, (taken, ratio) in told.items():
            row(f"200 steps of lj_melt, {name}", taken * 1e3, "ms", f"{what}, {ratio:.2f} of it alone")


PARTS = {one.__name__: one for one in (load, steps, functions, memory, runtimes)}


def main():
    import noether as nt

    wanted = sys.argv[1:] or list(PARTS)
    if set(wanted) - set(PARTS):
        sys.exit(f"{' '.join(wanted)}: parts are {' '.join(PARTS)}")
    print(f"python_package on Python {sys.version.split()[0]}, {nt.threads()} threads")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name in wanted:
            PARTS[name](nt)
        os.chdir("/")


if __name__ == "__main__":
    main()
