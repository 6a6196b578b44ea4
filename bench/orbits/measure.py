"""Runs of all programs for the error fronts: which rows there are, and their errors and times."""

import json
import os
import pathlib
import select
import statistics
import subprocess
import time
from dataclasses import dataclass

import numpy

from orbits import errors, systems
from orbits.ours import ADAPTIVE_LOOKS, Failed, Program

ROOT = pathlib.Path(__file__).resolve().parents[2]
LONG = 1.5  # seconds; a longer run is made once, for errors and time
ROUNDS = 3
NEAR = 1.3  # times as long as the front of a program
USELESS = (1e-4, 1e-1)  # errors of energy and position from which on a run is good for nothing
OVERHEAD = 0.1  # seconds to start a run
SCAN = 1  # samples
COMPILING = {"heyoka": 300}  # seconds that a program may take before a run


class Peer:
    """Another program, behind bench/peers/orbits.py; it is started again where it was ended."""

    def __init__(self, python, name):
        self.command = [python, str(ROOT / "bench/peers/orbits.py"), name]
        self.version = None
        self.start()

    def start(self):
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1,
                                        env=environment)
        self.version = self.process.stdout.readline().strip()

    def close(self):
        self.process.kill()
        self.process.wait()

    def ask(self, question, timeout):
        self.process.stdin.write(json.dumps(question) + "\n")
        self.process.stdin.flush()
        if not select.select([self.process.stdout], [], [], timeout)[0]:
            self.close()
            self.start()
            raise Failed(f"not finished after {timeout:.0f} s")
        line = self.process.stdout.readline()
        if not line:
            self.close()
            self.start()
            raise Failed("the program ended")
        answer = json.loads(line)
        if "error" in answer:
            raise Failed(answer["error"])
        return answer["seconds"], answer["states"]


class Row:
    """One method with one step or tolerance on one system."""

    def __init__(self, system, entry, divisions=None, tolerance=None):
        self.system, self.entry, self.divisions, self.tolerance = system, entry, divisions, tolerance
        self.seconds = self.energy = self.position = None
        self.times, self.outcome = [], ""

    @property
    def step(self):
        return self.system.sample / self.divisions if self.divisions else None

    @property
    def looks(self):
        return systems.looks_of(self.divisions) if self.divisions else ADAPTIVE_LOOKS

    def spec(self):
        if self.tolerance is None:
            return self.entry.spec
        return self.entry.with_tolerance(self.entry.spec, self.tolerance)

    def run(self, programs, samples, watched, timeout):
        """Seconds, states of the looks, and the energy error that the program itself reports, if it counts."""
        program, system = programs[self.entry.program], self.system
        if isinstance(program, Program):
            method = dict(self.spec())
            if self.divisions:
                method["divisions"] = self.divisions
            report, seconds, states = program.run(system, method, samples, watched, timeout)
            own = report["monitors"]["energy"]["worst"] if watched and self.entry.family == "exact" else None
            return seconds, states, own
        question = {"G": system.G, "bodies": system.bodies, "sample": system.sample, "samples": samples,
                    "divisions": self.divisions, "first": system.divisions(system.step / 20), "looks": self.looks,
                    "watched": watched, "method": self.spec()}
        seconds, states = program.ask(question, timeout + COMPILING.get(self.entry.program, 0))
        return seconds, numpy.array(states).reshape(-1, len(system.bodies), 6), None

    def measure_errors(self, programs, samples, timeout):
        """Errors, and the time of a run that is looked at."""
        try:
            seconds, states, energy = self.run(programs, samples, True, timeout)
            if len(states) != self.looks * samples + 1:
                raise Failed(f"{len(states)} states instead of {self.looks * samples + 1}")
            if not numpy.isfinite(states).all():
                raise Failed("states that are not finite")
            masses = numpy.array([body[0] for body in self.system.bodies])
            self.seconds = seconds
            self.energy = energy if energy is not None else errors.energy_error(self.system.G, masses, states)
            self.position = errors.position_error(states[self.looks :: self.looks], systems.read_truth(self.system)[1:])
            self.outcome = "ok"
        except Failed as failure:
            self.seconds = self.energy = self.position = None
            self.outcome = " ".join(str(failure).split())[:200]


def rows_of(system, entries):
    rows = []
    for entry in entries:
        divisions = sorted({system.divisions(ratio * system.step) for ratio in entry.ratios})
        rows += [Row(system, entry, divisions=k) for k in divisions]
        rows += [Row(system, entry, tolerance=tolerance) for tolerance in entry.tolerances]
    return rows


def front(rows, error):
    """The rows that no other one beats in both time and error."""
    best, found = float("inf"), []
    for row in sorted(rows, key=lambda row: (getattr(row, error), row.seconds)):
        if row.seconds < best:
            best = row.seconds
            found.append(row)
    return found


def by_merit(rows):
    """Rows that are good for something, with their ranks: 0 on the front of their program, 1 near it, 2 on the front of their
    family; of each rank the quickest first."""
    good = [row for row in rows if row.outcome == "ok" and (row.energy < USELESS[0] or row.position < USELESS[1])]
    ranks = {}
    for error in ("energy", "position"):
        for program in {row.entry.program for row in good}:
            own = [row for row in good if row.entry.program == program]
            for row in front(own, error):
                ranks[row] = 0
            for row in own:
                best = min(other.seconds for other in own if getattr(other, error) <= getattr(row, error))
                if row.seconds <= NEAR * best:
                    ranks[row] = min(ranks.get(row, 2), 1)
            for family in {row.entry.family for row in own}:
                for row in front([row for row in own if row.entry.family == family], error):
                    ranks.setdefault(row, 2)
    return sorted(ranks.items(), key=lambda item: (item[1], item[0].seconds))


def chosen(rows, times, limits):
    """The rows that are run over a span `times` as long as that of the scan, those that are left out for their time, and what
    the former should take."""
    kept, dropped, total = [], [], 0.0
    for row, rank in by_merit(rows):
        expected = row.seconds * times + OVERHEAD
        cost = expected if expected > LONG else (1 + ROUNDS) * expected
        if expected > limits.row:
            row.outcome = f"left out: about {expected:.0f} s"
            dropped.append(row)
        elif total + cost <= 0.75 * limits.system:
            total += cost
            kept.append(row)
        elif rank == 0:
            row.outcome = f"left out: about {expected:.0f} s, and no time for it"
            dropped.append(row)
    return kept, dropped, total


def alternating(rows):
    """The programs take turns."""
    lists = [[row for row in rows if row.entry.program == name] for name in ("noether", "rebound", "heyoka")]
    order = []
    while any(lists):
        longest = max(lists, key=len)
        order.append(longest.pop(0))
        for other in lists:
            if other is not longest and other and len(other) * 2 > len(longest):
                order.append(other.pop(0))
    return order


def tell(text):
    print(f"{time.strftime('%H:%M:%S')} {text}", flush=True)


@dataclass
class Limits:
    """Seconds."""

    row: float  # of the longest run that is made
    system: float  # of all runs of a system

    def left(self, begin, fraction=1.0):
        return fraction * self.system - (time.monotonic() - begin)


def measure(system, programs, entries, samples, limits):
    """Rows of the whole span, the refused and failed ones among them."""
    begin = time.monotonic()
    scan = min(SCAN, samples)
    rows = rows_of(system, [entry for entry in entries if entry.program in programs])
    for row in rows:
        row.measure_errors(programs, scan, limits.row * scan / samples + 5)
    failed = [row for row in rows if row.outcome != "ok"]
    kept, dropped, total = chosen(rows, samples / scan, limits)
    tell(f"{system.name}: {len(rows)} rows over {scan} of {samples} samples in {time.monotonic() - begin:.0f} s, {len(failed)} "
         f"without an end; {len(kept)} go on, about {total:.0f} s")
    for row in kept:
        if limits.left(begin, 0.8) < 0:
            row.outcome = "left out: the time for this system was over"
        else:
            row.measure_errors(programs, samples, 3 * limits.row + 10)
    going = [row for row in kept if row.outcome == "ok"]
    timed = alternating([row for row in going if row.seconds < LONG])
    for _ in range(ROUNDS):
        for row in timed:
            if limits.left(begin) > 0:
                row.times.append(row.run(programs, samples, False, 3 * limits.row + 10)[0])
    for row in timed:
        row.seconds = statistics.median(row.times) if row.times else row.seconds
    tell(f"{system.name}: {time.monotonic() - begin:.0f} s")
    return kept + dropped + failed


def start_programs(program, python):
    programs = {"noether": Program(program)}
    for name in ("rebound", "heyoka"):
        peer = Peer(python, name)
        if peer.version:
            programs[name] = peer
        else:
            tell(f"{name} is not installed: it is left out")
    return programs


def stop_programs(programs):
    for program in programs.values():
        if isinstance(program, Peer):
            program.close()
