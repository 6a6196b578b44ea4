"""Errors of IAS15 (rebound) at the ends of the files of this folder: what tests/methods/orbits_to_rounding_test.cpp asks.

    python3 ias15.py                # the median of every file, of all its starts
    python3 ias15.py triple.txt     # of one file, with the error of every start

Settings are rebound's defaults. With exact_finish_time, which is one of them, the last step is shortened to end where
the file does.
"""

import math
import pathlib
import statistics
import sys

import rebound


def read(path):
    """G, the end, the body that errors are measured from, masses, and the starts as (begin, end) body by body."""
    lines = [line.split() for line in path.read_text().splitlines() if not line.startswith("#")]
    G, until = float(lines[0][0]), float(lines[0][1])
    bodies, about, count = (int(word) for word in lines[0][3:])
    masses = [float(line[0]) for line in lines[1:1 + bodies]]
    rows = [[float(word) for word in line] for line in lines[1 + bodies:]]
    starts = []
    for k in range(count):
        of_start = rows[2 * bodies * k:2 * bodies * (k + 1)]
        starts.append((of_start[0::2], of_start[1::2]))
    return G, until, about, masses, starts


def error(G, until, about, masses, begin, end):
    """Root of sums of squares of distances from the truth, divided by that of positions, as in the test."""
    sim = rebound.Simulation()
    sim.G = G
    for m, (x, y, z, vx, vy, vz) in zip(masses, begin):
        sim.add(m=m, x=x, y=y, z=z, vx=vx, vy=vy, vz=vz)
    sim.integrator = "ias15"
    sim.integrate(until)
    right = [words[0::2] for words in end]
    off = [[(reached - words[2 * axis]) - words[2 * axis + 1] for axis, reached in enumerate(particle.xyz)]
           for particle, words in zip(sim.particles, end)]
    if about >= 0:
        right = [[x - of for x, of in zip(one, right[about])] for one in right[about + 1:]]
        off = [[x - of for x, of in zip(one, off[about])] for one in off[about + 1:]]
    return math.sqrt(sum(x * x for one in off for x in one) / sum(x * x for one in right for x in one))


def main():
    folder = pathlib.Path(__file__).parent
    named = [pathlib.Path(name) for name in sys.argv[1:]]
    print(f"IAS15 of rebound {rebound.__version__}")
    for path in named or sorted(folder.glob("*.txt")):
        G, until, about, masses, starts = read(path)
        errors = [error(G, until, about, masses, begin, end) for begin, end in starts]
        print(f"{path.stem:15} {statistics.median(errors):.2e} over {len(errors)} starts", flush=True)
        if named:
            print("  " + " ".join(f"{one:.2e}" for one in errors))


if __name__ == "__main__":
    main()
