"""Wisdom-Holman steps of REBOUND: wisdom_holman.py. Greets with its version, then answers each case, one a line, with the
processor seconds of the steps alone, or with `-` where this machine or this version cannot do it; ends at once where the
program is absent. Peers are never needed: the benchmark continues without.

A case: {"G": ..., "method": "whfast512" | "whfast" | "whfast KERNEL" | "saba(10,6,4)",
"relativity": whether as a potential, "step": ..., "steps": ..., "bodies": [[m, x, y, z, vx, vy, vz], ...]}."""

import json
import math
import sys
import time


def has_avx512():
    try:
        with open("/proc/cpuinfo") as info:
            return " avx512f " in info.read()
    except OSError:
        return False


def start(case, rebound):
    sim = rebound.Simulation()
    # WHFast512 makes whole steps only, in units in which G is 1: those of length and mass stay, and time is scaled.
    second = math.sqrt(case["G"]) if case["method"] == "whfast512" else 1.0
    sim.exact_finish_time = 0
    sim.G = 1.0 if case["method"] == "whfast512" else case["G"]
    for m, x, y, z, vx, vy, vz in case["bodies"]:
        sim.add(m=m, x=x, y=y, z=z, vx=vx / second, vy=vy / second, vz=vz / second)
    massive = sum(1 for body in case["bodies"] if body[0] > 0)
    if massive < len(case["bodies"]):
        sim.N_active = massive
    name, _, kernel = case["method"].partition(" ")
    sim.integrator = "saba" if name == "saba(10,6,4)" else name
    sim.dt = case["step"] * second
    if case["method"] == "whfast512":
        sim.integrator.concatenate_steps = case["steps"]
        sim.integrator.gr_potential = int(case["relativity"])
    else:
        if case["relativity"]:
            raise ValueError("only WHFast512 has the potential of relativity in itself")
        sim.integrator.safe_mode = 0
        if case["method"] == "saba(10,6,4)":
            sim.integrator.type = "10_6_4"
        if kernel:
            sim.integrator.kernel = kernel
    return sim


def seconds_of(case, rebound):
    if case["method"] == "whfast512" and not has_avx512():
        return None
    try:
        sim = start(case, rebound)
        steps = 1 if case["method"] == "whfast512" else case["steps"]
        begin = time.process_time()
        sim.steps(steps)
        return time.process_time() - begin
    except (AttributeError, RuntimeError, ValueError) as error:
        print(f"rebound {case['method']}: {error}", file=sys.stderr)
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
