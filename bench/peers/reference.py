"""One reference run by another program: reference.py PEER < case.json prints one line of JSON, or nothing without it.

The case: {"G": ..., "end": ..., "bodies": [[m, x, y, z, vx, vy, vz], ...]}. The answer: version, processor seconds of the
run alone, and positions at the end, which is the one asked for. Peers are never needed: the benchmark goes on without."""

import json
import sys
import time


def rebound_ias15(case):
    import rebound

    def start():
        sim = rebound.Simulation()
        sim.G = case["G"]
        sim.integrator = "ias15"
        for m, x, y, z, vx, vy, vz in case["bodies"]:
            sim.add(m=m, x=x, y=y, z=z, vx=vx, vy=vy, vz=vz)
        sim.dt = case["first_step"]
        return sim

    start().integrate(case["end"] / 100)
    sim = start()
    begin = time.process_time()
    sim.integrate(case["end"])
    seconds = time.process_time() - begin
    return rebound.__version__, seconds, [[p.x, p.y, p.z] for p in sim.particles]


def heyoka_taylor(case):
    import heyoka

    masses = [body[0] for body in case["bodies"]]
    system = heyoka.model.nbody(len(masses), masses=masses, Gconst=case["G"])
    state = [value for body in case["bodies"] for value in body[1:]]
    compiled = heyoka.taylor_adaptive(system, state, high_accuracy=True)
    start = compiled.state.copy()
    compiled.propagate_until(case["end"] / 100)
    compiled.state[:] = start
    compiled.time = 0.0
    begin = time.process_time()
    compiled.propagate_until(case["end"])
    seconds = time.process_time() - begin
    return heyoka.__version__, seconds, compiled.state.reshape(-1, 6)[:, :3].tolist()


PEERS = {"ias15": rebound_ias15, "heyoka": heyoka_taylor}

if __name__ == "__main__":
    try:
        version, seconds, positions = PEERS[sys.argv[1]](json.load(sys.stdin))
    except ImportError:
        sys.exit(0)
    flat = " ".join(repr(x) for position in positions for x in position)
    print(version, repr(seconds), flat)
