"""Orbits by other programs: orbits.py rebound | heyoka. Greets with one line, {"version", "build": how it was compiled} or
{"absent": why it cannot be asked}, then answers each line, a run, with one line. bench/fronts.py asks.

A run: {"G", "bodies": [[m, x, y, z, vx, vy, vz], ...], "sample": time from one sample to the next, "samples": how many (of
none, a run is only compiled), "divisions": steps from one sample to the next, or null where the method chooses them, "looks": how
many from one sample to the next, "watched": whether states of looks are wanted, "method": {...}}. The answer: {"seconds": of the
steps alone, by the clock (heyoka's with its series at the looks), "states": those of the looks, the start among them, in one list}
or {"error": why there are none}."""

import importlib
import importlib.metadata
import json
import math
import sys
import time

try:
    import numpy
except ImportError:
    numpy = None


class Watch:
    """Adds up the time of the pieces of a run."""

    def __init__(self):
        self.seconds = 0.0

    def __enter__(self):
        self.begin = time.perf_counter()

    def __exit__(self, *_):
        self.seconds += time.perf_counter() - self.begin


class Rebound:
    """A method: {"integrator": its name, "options": its attributes}."""

    def __init__(self, program):
        self.program = program

    @staticmethod
    def unit(run):
        """Of velocities, in those of the run: WHFast512 makes whole steps only, with G = 1, so that time is scaled for it."""
        return math.sqrt(run["G"]) if run["method"]["integrator"] == "whfast512" else 1.0

    def start(self, run):
        sim, unit = self.program.Simulation(), self.unit(run)
        sim.G = run["G"]
        if run["method"]["integrator"] == "whfast512":
            sim.G, sim.exact_finish_time = 1.0, 0
        for m, x, y, z, vx, vy, vz in run["bodies"]:
            sim.add(m=m, x=x, y=y, z=z, vx=vx / unit, vy=vy / unit, vz=vz / unit)
        sim.integrator = run["method"]["integrator"]
        for name, value in run["method"].get("options", {}).items():
            setattr(sim.integrator, name, value)
        if run["watched"] and run["method"]["integrator"] == "mercurius":
            # Without its safe mode, version 5.2.2 goes on from a synchronized state with wrong coordinates. Its steps are the same.
            sim.integrator.safe_mode = 1
        sim.dt = run["sample"] / (run["divisions"] or run["first"]) * unit
        return sim

    def advance(self, sim, run, steps, until):
        """So many steps, or up to a time where the method chooses them; ends with a synchronized state."""
        if not run["divisions"]:
            sim.integrate(until)
            return
        if run["method"]["integrator"] == "whfast512":  # one of its steps is `concatenate_steps` of the method's
            sim.integrator.concatenate_steps = steps
            steps = 1
        sim.steps(steps)
        sim.synchronize()

    def run(self, run):
        watch, sim, bodies, unit = Watch(), self.start(run), len(run["bodies"]), self.unit(run)
        end, pieces = run["sample"] * run["samples"], run["looks"] * run["samples"] if run["watched"] else 1
        per_piece = (run["divisions"] or 0) * run["samples"] // pieces
        states = numpy.zeros((pieces + 1, bodies, 6))

        def look(k):
            own = numpy.zeros((bodies, 6))
            sim.serialize_particle_data(xyzvxvyvz=own)
            own[:, 3:] *= unit
            states[k] = own

        look(0)
        for k in range(1, pieces + 1):
            with watch:
                self.advance(sim, run, per_piece, end * k / pieces)
            look(k)
        if abs(sim.t / unit - end) > 1e-9 * end:
            raise RuntimeError(f"ended at {sim.t / unit}, not at {end}")
        return watch.seconds, states


class Heyoka:
    """A method: {"tolerance": ..., "high_accuracy": ...}. What was compiled is kept."""

    def __init__(self, program):
        self.program = program
        self.compiled = {}

    def integrator(self, run):
        key = json.dumps([run["G"], run["bodies"], run["method"]])
        if key not in self.compiled:
            bodies, method = run["bodies"], run["method"]
            equations = self.program.model.nbody(len(bodies), masses=[body[0] for body in bodies], Gconst=run["G"])
            state = [value for body in bodies for value in body[1:]]
            self.compiled[key] = self.program.taylor_adaptive(equations, state, tol=method["tolerance"],
                                                              high_accuracy=method["high_accuracy"])
        own = self.compiled[key]
        own.state[:] = [value for body in run["bodies"] for value in body[1:]]
        own.time = 0.0
        return own

    def run(self, run):
        watch, own, bodies = Watch(), self.integrator(run), len(run["bodies"])
        if not run["samples"]:  # compiled now, in time of its own
            return 0.0, numpy.zeros(0)
        end, pieces = run["sample"] * run["samples"], run["looks"] * run["samples"]
        if run["watched"]:
            with watch:
                states = own.propagate_grid([end * k / pieces for k in range(pieces + 1)])[5]
            if len(states) != pieces + 1:
                raise RuntimeError(f"ended at {own.time}, not at {end}")
            return watch.seconds, numpy.asarray(states).reshape(-1, bodies, 6)
        with watch:
            own.propagate_until(end)
        return watch.seconds, own.state.reshape(1, bodies, 6)


PROGRAMS = {"rebound": Rebound, "heyoka": Heyoka}
OLDEST = {"rebound": 5, "heyoka": 7}  # whose names and results are those used here


def build(name):
    """How the package was compiled: a wheel for many systems serves the oldest processors."""
    try:
        wheel = importlib.metadata.distribution(name).read_text("WHEEL") or ""
    except importlib.metadata.PackageNotFoundError:
        return "of unknown build"
    return "PyPI's wheel" if "manylinux" in wheel else "built from source"


def greeting(name):
    """The program, if it can be asked, and the first line."""
    if numpy is None:
        return None, {"absent": f"numpy is not installed for {sys.executable}"}
    try:
        program = importlib.import_module(name)
    except ImportError as error:
        return None, {"absent": f"{name} cannot be imported: {error}"}
    version = program.__version__
    if int(version.split(".")[0]) < OLDEST[name]:
        return None, {"absent": f"{name} {version} is too old; expected {OLDEST[name]} or newer"}
    return program, {"version": version, "build": build(name)}


def main(name):
    program, first = greeting(name)
    print(json.dumps(first), flush=True)
    if program is None:
        return
    peer = PROGRAMS[name](program)
    for line in sys.stdin:
        run = json.loads(line)
        try:
            seconds, states = peer.run(run)
            answer = {"seconds": seconds, "states": states.ravel().tolist() if run["watched"] else []}
        except Exception as error:  # whatever a program says is the answer
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
