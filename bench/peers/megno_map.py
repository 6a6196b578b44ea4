"""REBOUND's example map of MEGNO over two planets, 64 x 64, beside the same map by `noether ensemble`.

    megno_map.py NOETHER SCENE [POINTS]      needs rebound 5 and h5py

A star, Jupiter, and a Saturn whose semi-major axis goes from 7 to 10 and whose eccentricity from 0 to 0.5, for 500 years by
Wisdom-Holman's map with a step of 5 (years over 2 pi), as in REBOUND's notebook Megno.ipynb. Both begin with the same change of
the state, made by the random numbers of the monitor `megno` with seed 1, whose length is that of REBOUND: time_scale = 1. REBOUND
weighs the growth in a step by the time at the end of the step, noether by that at its middle, which makes MEGNO smaller by some
0.014 here; so the growth in REBOUND's steps is added up in noether's way too. A
system that leaves 20 astronomical units counts as chaotic, with 10 in the place of its MEGNO, as in the notebook. Prints how
many points there are of which both say less than 2.5, and how far they differ there, by both ways of adding; and how many are on
the same side of 4.
"""

import math
import os
import subprocess
import sys
import tempfile

import h5py
import rebound

A, E, ESCAPED, LIMIT, SIDE = (7.0, 10.0), (0.0, 0.5), 10.0, 2.5, 4.0
BODIES, STREAM = 3, 16


def philox(counter, key):
    """Ten rounds of Philox4x32 (Salmon and others 2011)."""
    c, k = list(counter), list(key)
    for _ in range(10):
        high, low = divmod(c[0] * 0xD2511F53, 1 << 32)
        high2, low2 = divmod(c[2] * 0xCD9E8D57, 1 << 32)
        c = [high2 ^ c[1] ^ k[0], low2, high ^ c[3] ^ k[1], low]
        k = [(k[0] + 0x9E3779B9) % (1 << 32), (k[1] + 0xBB67AE85) % (1 << 32)]
    return c


def start_of_change(seed=1):
    """Deviates of the monitor: all x, all y, all z, then the velocities likewise."""
    change = []
    for i in range(6 * BODIES):
        bits = philox([0, i, 0, STREAM], [seed, 0])
        u = [((bits[k + 1] << 32 | bits[k]) >> 12) + 0.5 for k in (0, 2)]
        u = [one * 2.0 ** -52 for one in u]
        change.append(math.sqrt(-2 * math.log(u[0])) * math.cos(2 * math.pi * u[1]))
    length = math.sqrt(sum(one * one for one in change))
    return [one / length for one in change]


def start(a, e):
    sim = rebound.Simulation()
    sim.integrator = "whfast"
    sim.dt = 5.0
    sim.add(m=1.0)
    sim.add(m=0.000954, a=5.204, M=0.600, omega=0.257, e=0.048)
    sim.add(m=0.000285, a=a, M=0.871, omega=1.616, e=e)
    sim.move_to_com()
    sim.init_megno()
    change = start_of_change()
    for i, one in enumerate(sim.particles_var):
        one.x, one.y, one.z = change[i], change[BODIES + i], change[2 * BODIES + i]
        one.vx, one.vy, one.vz = change[3 * BODIES + i], change[4 * BODIES + i], change[5 * BODIES + i]
    return sim


def megno_of_rebound(a, e):
    sim = start(a, e)
    sim.exit_max_distance = 20.0
    try:
        sim.integrate(500 * 2 * math.pi, exact_finish_time=0)
        return sim.megno()
    except rebound.Escape:
        return ESCAPED


def megno_by_middles(a, e):
    """The same of the same steps, with growth at the middle of each, and the mean by the trapezoidal rule."""
    sim = start(a, e)
    steps, weighted, value, integral, before = math.ceil(500 * 2 * math.pi / sim.dt), 0.0, 0.0, 0.0, 0.0
    for n in range(steps):
        sim.steps(1)
        squares = sum(p.x**2 + p.y**2 + p.z**2 + p.vx**2 + p.vy**2 + p.vz**2 for p in sim.particles_var)
        now = math.log(squares) / 2
        weighted += (now - before) * (n + 0.5)
        following, before = weighted * 2 / (n + 1), now
        integral += (value + following) / 2
        value = following
    return integral / steps


def point(ends, k, points):
    return (ends[0] * (points - 1 - k) + ends[1] * k) / (points - 1)


def maps(noether, scene, points):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "map.h5")
        subprocess.run([noether, "ensemble", scene, "--out", out, "--shard", "0/1",
                        "--vary", f"particles.body.Saturn.a={A[0]}:{A[1]}:{points}",
                        "--vary", f"particles.body.Saturn.e={E[0]}:{E[1]}:{points}"], check=True, stdout=subprocess.DEVNULL)
        with h5py.File(out) as file:
            rows = file["ensemble"]
            ours = [y if outcome == 0 else ESCAPED for y, outcome in zip(rows["megno_mean"][:], rows["outcome"][:])]
    places = [(point(A, i, points), point(E, j, points)) for i in range(points) for j in range(points)]
    return places, ours, [megno_of_rebound(*place) for place in places]


def main():
    noether, scene = sys.argv[1:3]
    points = int(sys.argv[3]) if len(sys.argv) > 3 else 64
    places, ours, theirs = maps(noether, scene, points)
    regular = [k for k in range(len(places)) if ours[k] < LIMIT and theirs[k] < LIMIT]
    apart = sorted((abs(ours[k] - theirs[k]) for k in regular), reverse=True)
    beyond = [f"{one:.4f}" for one in apart if one > 0.02]
    same = sum((a < SIDE) == (b < SIDE) for a, b in zip(ours, theirs))
    print(f"rebound {rebound.__version__}: {len(places)} points, {same} of them on the same side of {SIDE:g}; {len(regular)} "
          f"below {LIMIT} in both, which differ by at most {apart[0]:.4f}, {len(beyond)} by more than 0.02: "
          f"{', '.join(beyond) or 'none'}")
    middles = [abs(ours[k] - megno_by_middles(*places[k])) for k in regular]
    print(f"added up at the middle of steps, REBOUND's differ by at most {max(middles):.1e}")


if __name__ == "__main__":
    main()
