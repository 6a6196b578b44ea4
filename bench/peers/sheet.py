"""Steps of REBOUND's symplectic epicycle (SEI) in a shearing sheet: sheet.py. Greets with its version, then answers each
case, one a line, with the processor seconds of the steps alone, or with `-` where this version cannot do it; ends at once
where the program is absent. Peers are never needed: the benchmark continues without.

A case: {"gravity": "none" | "basic" | "tree", "Omega": ..., "step": ..., "steps": ..., "edges": [x, y, z] or [] in open
space, "softening": ..., "bodies": [[m, x, y, z, vx, vy, vz], ...]}, G = 1. In a box the pull is that of nine boxes."""

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
    for m, x, y, z, vx, vy, vz in case["bodies"]:
        sim.add(m=m, x=x, y=y, z=z, vx=vx, vy=vy, vz=vz)
    return sim


def seconds_of(case, rebound):
    try:
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
