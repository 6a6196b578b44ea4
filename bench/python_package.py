#!/usr/bin/env python3
"""Measures the Python package: import, loading, steps and functions of one's own, and other OpenMP runtimes beside it.

    PYTHONPATH=build/release/python build/python/bin/python bench/python_package.py

Times are medians; steps are those of two bodies by leapfrog, from Python and by the program in turn. numba and scikit-learn are
peers: where one is absent, its rows are left out with a word.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

STEPS = 1_000_000


def row(what, value, unit, note=""):
    print(f"python_package   {what:34s} {value:10.4g} {unit:8s} {note}", flush=True)


def in_new_python(code, repeats=9):
    """Median of what the code prints, each time in a Python of its own."""
    told = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)
            for _ in range(repeats)]
    return statistics.median(told)


def two_bodies(nt, force=None, **claims):
    bodies = nt.Particles()
    bodies.add("star", m=0.75, x=[0, 0, 0], v=[0, 0, 0])
    bodies.add("planet", m=0.25, x=[1, 0, 0], v=[0, 1, 0])
    sim = nt.Simulation(bodies, method="verlet", step=0.001)
    sim.add_force(force or nt.Gravity(), **claims)
    return sim


def per_step(sim, steps):
    sim.run(1000)
    times = []
    for _ in range(7):
        begin = time.perf_counter()
        sim.run(steps)
        times.append((time.perf_counter() - begin) / steps * 1e9)
    return statistics.median(times)


def steps(nt):
    """A step by objects and by the program, in turn."""
    scene = two_bodies(nt).tree()
    scene["integrator"]["steps"] = STEPS
    scene["every"] = [{"type": "momentum", "steps": STEPS}]
    file = "two_bodies.toml"
    with open(file, "w") as out:
        out.write(nt.Scene(scene).toml)
    sim, ours, theirs = two_bodies(nt), [], []
    sim.run(1000)
    for turn in range(9):
        begin = time.perf_counter()
        sim.run(STEPS)
        ours.append((time.perf_counter() - begin) / STEPS * 1e9)
        told = subprocess.run([*nt.files.program(), "run", file, "--out", f"program{turn}", "--json"], capture_output=True,
                              text=True, check=True)
        theirs.append(json.loads(told.stdout)["wall_s"] / STEPS * 1e9)
    mine, program = statistics.median(ours), statistics.median(theirs)
    row("step by objects", mine, "ns")
    row("step by the program", program, "ns", f"objects take {mine / program:.3f} of it")


def functions(nt):
    def empty(t, x, v, m, a):
        return 0.0

    row("step with an empty Python force", per_step(two_bodies(nt, empty), 100_000), "ns")
    try:
        import numba
    except ImportError:
        print("python_package   numba is absent: no row of a compiled force")
        return
    signature = nt.force_signature()

    @numba.cfunc(signature)
    def gravity(n, stride, t, x, v, m, a, user):
        dx, dy, dz = x[1] - x[0], x[1 + stride] - x[stride], x[1 + 2 * stride] - x[2 * stride]
        r = (dx * dx + dy * dy + dz * dz)**0.5
        w = 1.0 / (r * r * r)
        a[0], a[stride], a[2 * stride] = m[1] * w * dx, m[1] * w * dy, m[1] * w * dz
        a[1], a[1 + stride], a[1 + 2 * stride] = -m[0] * w * dx, -m[0] * w * dy, -m[0] * w * dz
        return -m[0] * m[1] / r

    row("step with gravity by numba", per_step(two_bodies(nt, gravity), STEPS), "ns")
    row("step with the built-in gravity", per_step(two_bodies(nt), STEPS), "ns")


LIQUID = """
import time
{first}
import noether as nt
{last}
scene = nt.Scene("lj_melt", set={{"integrator.steps": 20, "every": []}})
scene.run(out="a", existing="fresh")
begin = time.perf_counter()
scene.run(out="b", existing="fresh")
print(time.perf_counter() - begin)
"""


def runtimes():
    learn = ("import numpy; from sklearn.cluster import KMeans; "
             "KMeans(2, n_init=1).fit(numpy.random.default_rng(1).normal(size=(20000, 4)))")
    alone = in_new_python(LIQUID.format(first="", last=""), 5)
    row("20 steps of lj_melt, alone", alone * 1e3, "ms")
    for name, code in (("h5py", "import h5py"), ("scikit-learn", learn)):
        try:
            subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
        except subprocess.CalledProcessError:
            print(f"python_package   {name} is absent: no row of it")
            continue
        for first, last, when in ((code, "", "before"), ("", code, "after")):
            beside = in_new_python(LIQUID.format(first=first, last=last), 5)
            row(f"the same, {name} {when}", beside * 1e3, "ms", f"{beside / alone:.2f} of it")


def main():
    import noether as nt

    print(f"python_package on Python {sys.version.split()[0]}, {nt.threads()} threads")
    timed = "import time{0}; t = time.perf_counter(); import noether; print(time.perf_counter() - t)"
    row("import beside NumPy", in_new_python(timed.format(", numpy")) * 1e3, "ms")
    nt.Scene("figure_eight")
    times = []
    for _ in range(200):
        begin = time.perf_counter()
        nt.Scene("figure_eight")
        times.append(time.perf_counter() - begin)
    row("a scene loaded", statistics.median(times) * 1e3, "ms")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        steps(nt)
        functions(nt)
        runtimes()
        os.chdir("/")


if __name__ == "__main__":
    main()
