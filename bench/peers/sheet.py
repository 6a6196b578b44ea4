"""Steps of REBOUND's symplectic epicycle (SEI) in a shearing sheet: sheet.py. Greets with its version, then answers each
case, one a line, with the processor seconds of the steps alone, or with `-` where this version cannot do it; ends at once
where the program is absent. Peers are never needed: the benchmark continues without. A case with "steps": 0 is answered with the
error of its pulls beside direct sums over nine boxes: root mean squares, of the differences by those of the sums.

A case: {"gravity": "none" | "basic" | "tree", "Omega": ..., "step": ..., "steps": ..., "edges": [x, y, z] or [] in open
space, "softening": ..., "bodies": [[m, x, y, z, vx, vy, vz], ...], "radius": ... of elastic spheres, 0: no spheres}, G = 1. In a box the pull
is that of nine boxes. Contacts are looked for as pulls are, directly or by the tree."""

import json
import sys
import time


def start(case, rebound):
    sim = rebound.Simulation()
    sim.G = 1.0
    sim.integrator = "sei"
    sim.OMEGA = case["Omega"]
    sim.gravity = case["gravity"]
    sim.softening = case["softening"]
    sim.dt = case["step"]
    sim.exact_finish_time = 0
    if case["edges"]:
        across, along, _ = case["edges"]
        if across != along:
            raise ValueError("roots of its tree are cubes")
        sim.root_size = across
        sim.boundary = "shear"
        sim.N_ghost_x = sim.N_ghost_y = 1
        sim.opening_angle2 = 0.25
    if case["radius"]:
        sim.collision = "tree" if case["gravity"] == "tree" else "direct"
        sim.collision_resolve = "hardsphere"
    for m, x, y, z, vx, vy, vz in case["bodies"]:
        sim.add(m=m, r=case["radius"], x=x, y=y, z=z, vx=vx, vy=vy, vz=vz)
    return sim


def error_of(case, rebound):
    pulls = []
    for gravity in (case["gravity"], "basic"):
        sim = start({**case, "gravity": gravity, "radius": 0}, rebound)
        sim.steps(1)  # which leaves those of its middle; by the tree particles change their order
        found = sorted((round(p.x, 9), round(p.y, 9), p.ax, p.ay, p.az) for p in sim.particles)
        pulls.append([one[2:] for one in found])
    squares = [sum((a - b) ** 2 for one, other in zip(*pulls) for a, b in zip(one, other)),
               sum(b * b for other in pulls[1] for b in other)]
    return (squares[0] / squares[1]) ** 0.5


def seconds_of(case, rebound):
    try:
        if case["steps"] == 0:
            return error_of(case, rebound)
        sim = start(case, rebound)
        sim.steps(1)
        begin = time.process_time()
        sim.steps(case["steps"])
        return time.process_time() - begin
    except (AttributeError, RuntimeError, ValueError) as error:
        print(f"rebound {case['gravity']}: {error}", file=sys.stderr)
        return None


def main():
    try:
        import rebound
    except ImportError as error:
        print(f"rebound: {error}", file=sys.stderr)
        return
    print(rebound.__version__, flush=True)
    for line in sys.stdin:
        seconds = seconds_of(json.loads(line), rebound)
        print("-" if seconds is None else repr(seconds), flush=True)


if __name__ == "__main__":
    main()
