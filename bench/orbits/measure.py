"""Runs of all programs for the error fronts: which rows there are, and their errors and times."""

import json
import os
import pathlib
import select
import statistics
import subprocess
import time

import numpy

from orbits import errors, systems
from orbits.ours import ADAPTIVE_LOOKS, Failed, Program
from orbits.page import OPEN, PEERS

ROOT = pathlib.Path(__file__).resolve().parents[2]
LONG = 1.5  # seconds; a longer run is timed once
ROUNDS = 3
NEAR = 1.3  # times as long as the front of a program
USELESS = (1e-4, 1e-1)  # errors of energy and position from which on a run is good for nothing
OVERHEAD = 0.1  # seconds to start a run
SCAN = 1  # samples
STARTING = 20  # seconds that a program may take to greet
COMPILING = {"heyoka": 300}  # seconds that a program may take to compile for a row
FAILURES = (Failed, ValueError, TypeError, LookupError, OSError)  # of a run; they end no others
# Parts of a system's time: the scan, the fronts of the other programs, those and noether's, all rows.
SCANNING, OTHERS, FRONTS, ALL = 0.6, 0.7, 0.95, 0.85


class Absent(Exception):
    """A program that is not there, or of a version that is not known; the text says why."""


class Peer:
    """Another program, behind bench/peers/orbits.py; it is started again where it was ended."""

    def __init__(self, python, name):
        self.command = [python, str(ROOT / "bench/peers/orbits.py"), name]
        self.gone = ""  # why it could not be started again
        self.compiled = {}  # for what it has compiled, and why where it has not
        self.start()

    def start(self):
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        try:
            self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                            bufsize=1, env=environment)
        except OSError as error:
            raise Absent(f"{self.command[0]} cannot be started: {error.strerror}") from error
        try:
            ready = select.select([self.process.stdout], [], [], STARTING)[0]
            greeting = json.loads(self.process.stdout.readline()) if ready else {"absent": f"no word in {STARTING} s"}
        except ValueError:
            greeting = {"absent": "its first line cannot be read"}
        if "absent" in greeting:
            self.close()
            raise Absent(greeting["absent"])
        self.version, self.build = greeting["version"], greeting["build"]
        self.forget()

    def forget(self):
        """What was compiled is gone; what could not be compiled is not tried again."""
        self.compiled = {key: why for key, why in self.compiled.items() if why}

    def close(self):
        self.process.kill()
        self.process.wait()

    def again(self, why):
        """Starts anew after a failure, which is returned; where that cannot be done, each question to come fails at once."""
        self.close()
        try:
            self.start()
        except Absent as absent:
            self.gone = f"left out: it could not be started again: {absent}"
        return Failed(why)

    def ask(self, question, timeout):
        if self.gone:
            raise Failed(self.gone)
        try:
            self.process.stdin.write(json.dumps(question) + "\n")
            self.process.stdin.flush()
            if not select.select([self.process.stdout], [], [], timeout)[0]:
                raise self.again(f"not finished after {timeout:.0f} s")
            line = self.process.stdout.readline()
            if not line:
                raise self.again("the program ended")
            answer = json.loads(line)
        except (ValueError, OSError) as error:  # an answer that is none, or a program that has gone
            raise self.again(f"no answer: {error}") from error
        if "error" in answer:
            raise Failed(answer["error"])
        return answer["seconds"], answer["states"]

    def compile(self, question, timeout):
        """Has it compile for a question of no samples, once. A row for which there was no time is left out, not slow."""
        key = json.dumps([question["bodies"], question["method"]])
        if key not in self.compiled:
            try:
                self.ask(question, timeout)
                self.compiled[key] = ""
            except Failed as failure:
                late = str(failure).startswith("not finished")
                self.compiled[key] = f"left out: not compiled after {timeout:.0f} s" if late else str(failure)
        if self.compiled[key]:
            raise Failed(self.compiled[key])


class Row:
    """One method with one step or tolerance on one system."""

    def __init__(self, system, entry, divisions=None, tolerance=None):
        self.system, self.entry, self.divisions, self.tolerance = system, entry, divisions, tolerance
        self.seconds = self.energy = self.position = None
        self.times, self.outcome = [], ""
        self.rank = 0  # as by_merit has it
        self.whole = False  # whether seconds and errors are those of the whole span

    @property
    def step(self):
        return self.system.sample / self.divisions if self.divisions else None

    @property
    def looks(self):
        return systems.looks_of(self.divisions) if self.divisions else ADAPTIVE_LOOKS

    @property
    def looks_are_free(self):
        """Whether a long run is as quick with looks as without: they are outside REBOUND's time, and end few of the steps that a
        method chooses. (Steps of one length are synchronized at looks, by correctors with many steps; heyoka's time has the
        series that it evaluates at looks.)"""
        return self.entry.program == "rebound" and not self.divisions

    def spec(self):
        if self.tolerance is None:
            return self.entry.spec
        return self.entry.with_tolerance(self.entry.spec, self.tolerance)

    def question(self, samples, watched):
        """A run, as bench/peers/orbits.py has it."""
        system = self.system
        return {"G": system.G, "bodies": system.bodies, "sample": system.sample, "samples": samples,
                "divisions": self.divisions, "first": system.divisions(system.step / 20), "looks": self.looks,
                "watched": watched, "method": self.spec()}

    def compile(self, programs, timeout):
        """What a program has to do before its first run of this row, and again where it was started again."""
        if self.entry.program in COMPILING:
            programs[self.entry.program].compile(self.question(0, False), timeout)

    def run(self, programs, samples, watched, timeout):
        """Seconds, and states of the looks."""
        program, system = programs[self.entry.program], self.system
        if isinstance(program, Program):
            method = dict(self.spec())
            if self.divisions:
                method["divisions"] = self.divisions
            return program.run(system, method, samples, watched, timeout)[1:]
        seconds, states = program.ask(self.question(samples, watched), timeout)
        return seconds, numpy.array(states).reshape(-1, len(system.bodies), 6)

    def measure_errors(self, programs, samples, limits, wanted):
        """Errors, and the time of a run that is looked at. One that is not finished after the `wanted` seconds is slow; one that
        had less of them is left out, for nothing is known of it."""
        timeout = wanted
        try:
            self.compile(programs, limits.timeout(COMPILING.get(self.entry.program, 0)))
            timeout = limits.timeout(wanted)
            seconds, states = self.run(programs, samples, True, timeout)
            if len(states) != self.looks * samples + 1:
                raise Failed(f"{len(states)} states instead of {self.looks * samples + 1}")
            if not numpy.isfinite(states).all():
                raise Failed("states that are not finite")
            masses = numpy.array([body[0] for body in self.system.bodies])
            self.seconds = seconds
            self.energy = errors.energy_error(self.system.G, masses, states)
            self.position = errors.position_error(states[self.looks :: self.looks], systems.read_truth(self.system)[1:])
            self.outcome = "ok"
        except FAILURES as failure:
            self.seconds = self.energy = self.position = None
            self.outcome = said(failure)
            if self.outcome.startswith("not finished") and timeout < wanted:
                self.outcome = f"left out: {self.outcome}, when the time was over"

    def measure_time(self, programs, samples, limits, wanted):
        """One more time of a run without looks; none where it has no end in time."""
        try:
            self.compile(programs, limits.timeout(COMPILING.get(self.entry.program, 0)))
            self.times.append(self.run(programs, samples, False, limits.timeout(wanted))[0])
        except FAILURES as failure:
            tell(f"{self.entry.label} has not been timed: {said(failure)}")

    def leave_out(self, why):
        """Not run over the whole span; where it is on no front, another row of its program was better in the scan."""
        self.outcome = f"{'beaten in the scan' if self.rank else 'left out'}: {why.removeprefix('left out: ')}"


def said(failure):
    """What a failure says, in one line."""
    text = str(failure) if isinstance(failure, Failed) else f"{type(failure).__name__}: {failure}"
    return " ".join(text.split())[:200]


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
    family; of each rank those of other programs first, and the quickest of them. The rest is marked as beaten."""
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
    for row in rows:
        if row.outcome == "ok" and row not in ranks:
            row.outcome = "not near a front"
    return sorted(ranks.items(), key=lambda item: (item[1], item[0].entry.program == "noether", item[0].seconds))


def cost(row, times):
    """Seconds that a row should take, in all, over a span `times` as long as that of its scan."""
    expected = row.seconds * times + OVERHEAD
    return expected * (1 + ROUNDS if expected <= LONG else 1 if row.looks_are_free else 2)


def chosen(rows, times, limits):
    """The rows that are run over a span `times` as long as that of the scan, in their order. The others keep the errors of the
    scan, and the reason. The fronts of other programs come first: without them nothing can be said."""
    kept, total = [], 0.0
    left = limits.left()
    for row, row.rank in by_merit(rows):
        expected = row.seconds * times + OVERHEAD
        part = ALL if row.rank > 0 else FRONTS if row.entry.program == "noether" else OTHERS
        if expected > limits.row:
            row.leave_out("longer than the longest run that is made")
        elif total + cost(row, times) > part * left:
            row.leave_out("no time for it")
        else:
            total += cost(row, times)
            kept.append(row)
    return kept, total


def alternating(rows):
    """The programs take turns, each as often as it has rows."""
    order = []
    for program in {row.entry.program: 0 for row in rows}:
        own = [row for row in rows if row.entry.program == program]
        order += [((k + 0.5) / len(own), row) for k, row in enumerate(own)]
    return [row for _, row in sorted(order, key=lambda item: item[0])]


def tell(text):
    print(f"{time.strftime('%H:%M:%S')} {text}", flush=True)


class Limits:
    """Seconds: of the longest run that is made, and of all runs of a system from now on."""

    def __init__(self, row, system):
        self.row, self.system = row, system
        self.end = time.monotonic() + system

    def left(self, part=1.0):
        """Of a part of the time for the system, from its beginning."""
        return self.end - (1 - part) * self.system - time.monotonic()

    def timeout(self, wanted):
        """Of a run: no run outlasts the time for the system."""
        return max(0.0, min(wanted, self.left()))


def scan(rows, programs, samples, limits, part):
    """Errors and times over the first samples. What there is no time for is not finished."""
    for row in alternating(rows):
        if limits.left(SCANNING) <= 0:
            row.outcome = "left out: no time to look at it"
        else:
            row.measure_errors(programs, part, limits, limits.row * part / samples + 5)


def run_over_span(kept, programs, samples, times, limits):
    """Errors of all rows, and times of the long ones; then times of the others, where the programs take turns."""
    longest = 3 * limits.row + 10
    reserved = 0.0  # for the times to come
    for row in kept:
        expected = row.seconds * times + OVERHEAD
        if limits.left() < reserved + cost(row, times):
            row.leave_out("the time was over")
            continue
        found = row.seconds, row.energy, row.position
        row.measure_errors(programs, samples, limits, longest)
        row.whole = not row.outcome.startswith(OPEN)
        if not row.whole:
            row.seconds, row.energy, row.position = found
            row.leave_out(row.outcome)
        if row.outcome == "ok" and row.seconds > LONG:
            if row.looks_are_free:
                row.times.append(row.seconds)
            else:
                row.measure_time(programs, samples, limits, longest)
        elif row.outcome == "ok":
            reserved += ROUNDS * (row.seconds + OVERHEAD)
    for _ in range(ROUNDS):
        for row in alternating([row for row in kept if row.outcome == "ok" and row.seconds <= LONG]):
            if limits.left() > row.seconds + OVERHEAD:
                row.measure_time(programs, samples, limits, longest)
    for row in kept:
        if row.times:
            row.seconds = statistics.median(row.times)
        elif row.outcome == "ok":
            row.leave_out("not timed without looks")


def measure(system, programs, entries, samples, limits):
    """All rows: those of the whole span, and the others with the errors of the scan or without any."""
    begin = time.monotonic()
    part = min(SCAN, samples)
    rows = rows_of(system, [entry for entry in entries if entry.program in programs])
    scan(rows, programs, samples, limits, part)
    failed = sum(row.outcome != "ok" for row in rows)
    kept, total = chosen(rows, samples / part, limits)
    tell(f"{system.name}: {len(rows)} rows over {part} of {samples} samples in {time.monotonic() - begin:.0f} s, {failed} "
         f"without an end; {len(kept)} go on, about {total:.0f} s")
    run_over_span(kept, programs, samples, samples / part, limits)
    for row in rows:
        if row.seconds is not None and not row.whole:
            row.seconds *= samples / part
    tell(f"{system.name}: {time.monotonic() - begin:.0f} of {limits.system:.0f} s")
    return rows


def compile_ahead(programs, system, entries):
    """What programs compile for a system, outside the budget. Returns what is to be said of it, or nothing."""
    texts = []
    for name in COMPILING:
        rows = rows_of(system, [entry for entry in entries if entry.program == name and name in programs])
        begin, done = time.monotonic(), 0
        for row in rows:
            try:
                row.compile(programs, COMPILING[name])
                done += 1
            except FAILURES as failure:
                tell(f"{system.name}: {name}: {said(failure)}")
        if rows:
            texts.append(f"{name} compiled {done} of {len(rows)} integrators in {time.monotonic() - begin:.0f} s")
            tell(f"{system.name}: {texts[-1]}, outside the budget")
    return "; ".join(texts)


def start_programs(program, python):
    programs = {"noether": Program(program)}
    for name in PEERS:
        try:
            programs[name] = Peer(python, name)
        except Absent as absent:
            tell(f"{name} is left out: {absent}")
    return programs


def stop_programs(programs):
    for program in programs.values():
        if isinstance(program, Peer):
            program.close()
