"""Reference runs by another program: reference.py PEER. Greets with its version, then answers each case, one a line, with
one line; ends at once where the program is absent. Peers are never needed: the benchmark goes on without.

A case: {"G": ..., "end": ..., "first_step": ..., "watched": ..., "bodies": [[m, x, y, z, vx, vy, vz], ...]}. The answer: processor
seconds of the run alone, the largest relative energy error of a second run that is looked at every ten of its own steps (0 of a
case that is not to be watched), and positions at the end, which is the one asked for."""

import importlib
import json
import sys
import time

import numpy


class EnergyError:
    """The largest change of the energy, relative to that at the start, worked out in more digits than the states have."""

    def __init__(self, case):
        self.G = numpy.longdouble(case["G"])
        self.m = numpy.array([body[0] for body in case["bodies"]], dtype=numpy.longdouble)
        self.pairs = numpy.triu_indices(len(self.m), 1)
        self.first = None
        self.worst = 0.0

    def look(self, states):
        """states: x, y, z, vx, vy, vz of each body."""
        states = numpy.asarray(states, dtype=numpy.longdouble)
        i, j = self.pairs
        kinetic = (self.m * (states[:, 3:] ** 2).sum(axis=1)).sum() / 2
        r = numpy.sqrt(((states[i, :3] - states[j, :3]) ** 2).sum(axis=1))
        energy = kinetic - (self.G * self.m[i] * self.m[j] / r).sum()
        if self.first is None:
            self.first = energy
        self.worst = max(self.worst, float(abs((energy - self.first) / self.first)))


def rebound_ias15(case, rebound):
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
    error = EnergyError(case)
    positions = [[p.x, p.y, p.z] for p in sim.particles]
    if not case["watched"]:
        return seconds, error.worst, positions
    watched = start()
    states = numpy.zeros((len(case["bodies"]), 6))

    def look():
        watched.serialize_particle_data(xyzvxvyvz=states)
        error.look(states)

    look()
    while watched.t < case["end"]:
        watched.steps(10)
        look()
    return seconds, error.worst, positions


def heyoka_taylor(case, heyoka):
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
    positions = compiled.state.reshape(-1, 6)[:, :3].tolist()
    compiled.state[:] = start
    compiled.time = 0.0
    error = EnergyError(case)
    steps = 0
    while case["watched"] and compiled.time < case["end"]:
        if steps % 10 == 0:
            error.look(compiled.state.reshape(-1, 6))
        compiled.step()
        steps += 1
    return seconds, error.worst, positions


PEERS = {"ias15": ("rebound", rebound_ias15), "heyoka": ("heyoka", heyoka_taylor)}


def main(peer):
    module, run = PEERS[peer]
    try:
        program = importlib.import_module(module)
    except ImportError as error:
        print(f"{module}: {error}", file=sys.stderr)
        return
    print(program.__version__, flush=True)
    for line in sys.stdin:
        seconds, energy_error, positions = run(json.loads(line), program)
        print(repr(seconds), repr(energy_error), *(repr(x) for position in positions for x in position), flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
