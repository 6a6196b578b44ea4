"""The error fronts of docs/orbits.md: fronts_test.py ROOT [PROGRAM]. The page is what its data say, steps divide spans without
rounding, planted errors are found, other programs that misbehave do no harm, the time for a system is not exceeded, what was not
measured is not taken for slow, and a run of the program is measured as its monitor measures it. No other program is needed.
Without numpy the test is skipped, if nothing else fails."""

import contextlib
import fractions
import importlib.util
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import types

ROOT = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(ROOT / "bench"))
sys.dont_write_bytecode = True

import fronts  # noqa: E402
from orbits import page, systems  # noqa: E402
from orbits.methods import all_methods  # noqa: E402

FAILED = []
SKIPPED = 77


def expect(condition, text):
    if not condition:
        FAILED.append(text)


def steps():
    for system in systems.SYSTEMS.values():
        for entry in all_methods(avx512=True):
            for ratio in entry.ratios:
                k = system.divisions(ratio * system.step)
                h = system.sample / k
                expect(fractions.Fraction(h) * k == system.sample, f"{system.name}: {k} steps of {h!r} are not {system.sample}")
                expect(fractions.Fraction(h).numerator < 1 << 24, f"{system.name}: {h!r} has too many digits")
                expect(0.7 < h / (ratio * system.step) < 1.4, f"{system.name}: {h!r} is far from {ratio * system.step}")
    for k, looks in ((7, 7), (23, 1), (40, 20), (34, 17), (9216, 18)):
        expect(systems.looks_of(k) == looks, f"{systems.looks_of(k)} looks divide {k} steps")


def settings():
    """The truth is not measured against itself, and defaults are among the tolerances."""
    found = {}
    for entry in all_methods(avx512=True):
        expect(entry.label not in found, f"two methods are called {entry.label}")
        found[entry.label] = entry
    for system in systems.SYSTEMS.values():
        truth = system.divisions(system.truth_step)
        own = [ratio for ratio in found["wide_gauss_8"].ratios if system.divisions(ratio * system.step) == truth]
        expect(not own, f"{system.name}: wide_gauss_8 has the step of the truth at {own}")
        floor, difference = systems.resolution(system)
        expect(1e-17 < floor < 1e-13 and 1e-17 < difference < 1e-12, f"{system.name}: resolution {floor}, {difference}")
    resolution, systems.resolution = systems.resolution, lambda system: (4e-14, 2e-12)
    found_levels = page.levels(None, "energy_error"), page.levels(None, "position_error")
    systems.resolution = resolution
    expect([len(found) for found in found_levels] == [7, 6], f"levels that can be told: {found_levels}")
    expect([found[-1] for found in found_levels] == [1e-12, 1e-11], f"levels that can be told: {found_levels}")
    for integrator in ("whfast", "saba", "eos", "mercurius"):
        own = [entry.spec["options"] for entry in found.values() if entry.spec.get("integrator") == integrator]
        expect(own and all(options.get("safe_mode") == 0 for options in own), f"REBOUND's {integrator} in its safe mode")
    for label, default in (("gauss_8", 1e-16), ("gauss_radau_15", 1e-16), ("IAS15", 1e-9), ("Taylor", 2**-52),
                           ("Taylor high accuracy", 2**-52)):
        expect(default in found[label].tolerances, f"{label} is not measured at its default of {default}")
    for words in ("compensated", "corrector 17", "kernel composed", "kernel lazy", "kernel modified", "saba_2 kernel modified"):
        expect(any(words in label for label in found), f"no method of noether's with {words}")


def row(program, seconds, energy, outcome="ok", **more):
    return {"program": program, "method": "m", "family": "f", "setting": "step", "value": 2.0, "seconds": seconds,
            "energy_error": energy, "position_error": energy, "outcome": outcome, "rounds": 3.0, "looks": 200.0, **more}


def tables():
    """Half of the time is asked, of rows that hold the error, and of no others."""
    at = page.LEVELS
    rows = [row("noether", 1.0, 1e-9), row("rebound", 1.9, 5e-10), row("heyoka", 4.0, 1e-13), row("noether", 1.5, 1e-12),
            row("noether", 0.1, 1e-30, "it failed")]
    lines, misses = page.table(rows, "energy_error", at)
    found = {round(miss.level, 20): miss.ratio for miss in misses}
    expect(set(found) == {1e-6, 1e-7, 1e-8, 1e-9, 1e-13}, f"misses at {sorted(found)}")
    expect(abs(found[1e-9] - 1 / 1.9) < 1e-12, f"ratio {found[1e-9]}")
    expect(found[1e-13] is None, "what only another program reaches has no ratio")
    expect(sum("**" in line for line in lines) == 4, "\n".join(lines))
    expect("none" in lines[-1] and "not measured" not in lines[-1] and lines[-1].endswith("|  |"), lines[-1])
    # a row that was left out, with the errors of the scan: only where it might be best
    more = [row("rebound", 30.0, 1e-14, "left out: no time for it", method="slow")]
    lines, misses = page.table(rows + more, "energy_error", at)
    hidden = [miss for miss in misses if miss.open]
    expect([miss.level for miss in hidden] == [at[-1]] and "slow" in page.reason(hidden[0]), f"open: {hidden}")
    expect("not measured" in lines[-1] and "open" in lines[-1], lines[-1])
    more[0]["seconds"] = 3.0
    hidden = [miss.level for miss in page.table(rows + more, "energy_error", at)[1] if miss.open]
    expect(hidden == at[-5:], f"a quicker row that was left out leaves {hidden} open")
    more = [row("rebound", None, None, "not finished after 9 s")]
    hidden = [miss.level for miss in page.table(rows + more, "energy_error", at)[1] if miss.open]
    expect(hidden == [at[-1]], f"a row that did not finish leaves {hidden} open")
    more = [row("rebound", None, None, "left out: no time to look at it")]
    hidden = [miss.level for miss in page.table(rows + more, "energy_error", at)[1] if miss.open]
    expect(hidden == at, f"a row that was never run leaves {hidden} open")
    # rows that others beat in the scan: the others may have drifted, so these are open, but only below the time that was measured
    for outcome in ("beaten in the scan: no time for it", "not near a front"):
        for seconds, expected in ((1.0, at[:7]), (1.9, at[4:7]), (4.0, [])):
            more = [row("rebound", seconds, 1e-12, outcome)]
            hidden = [miss.level for miss in page.table(rows + more, "energy_error", at)[1] if miss.open]
            expect(hidden == expected, f"a row of {seconds} s, {outcome}, leaves {hidden} open")
        lines, misses = page.table(rows + [row("noether", 1.0, 1e-13, outcome)], "energy_error", at)
        expect([miss.level for miss in misses if miss.open] == at[7:8] and "**open**" in lines[-1], f"{outcome}: {lines[-1]}")


def reasons():
    """They come from steps, errors and times alone."""

    def miss(ours, theirs):
        return page.Miss(1e-9, ours["seconds"] / theirs["seconds"], ours, theirs, [])

    theirs = row("rebound", 1.0, 1e-9, family="WHFast")
    same = page.reason(miss(row("noether", 0.8, 1.05e-9, family="Wisdom-Holman"), theirs))
    expect("same step" in same and "0.80 times as long" in same, same)
    other = page.reason(miss(row("noether", 0.8, 1.2e-9, family="Wisdom-Holman"), theirs))
    expect("same" not in other, other)
    longer = page.reason(miss(row("noether", 0.8, 1e-9, value=3.0), theirs))
    expect("1.50 times the step, 1.20 times the time of one" in longer, longer)
    expect("times" not in page.reason(miss(row("noether", 0.8, 1e-9, setting="tolerance"), theirs)), "a step of no length")


def data_and_page():
    """What is written is read again; programs without a row that ended are not named, and nothing is won without them."""

    def made(program, seconds, outcome, tolerance=None):
        entry = types.SimpleNamespace(program=program, label="m of " + program, family="f")
        return types.SimpleNamespace(entry=entry, tolerance=tolerance, divisions=None if tolerance else 4,
                                     step=None if tolerance else 0.5, looks=10, seconds=seconds, energy=1e-9, position=1e-8,
                                     times=[seconds] * 3 if outcome == "ok" else [], outcome=outcome)

    programs = {name: types.SimpleNamespace(version="1.2", build="b", commit="0123abc") for name in ("noether", "rebound", "heyoka")}
    rows = [made("noether", 0.2, "ok"), made("rebound", 1.0, "ok"), made("heyoka", None, "it failed", 1e-9),
            made("rebound", 2.0, "beaten in the scan: no time for it")]
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        page.write_data(out, systems.SYSTEMS["outer"], rows, programs, 20, "a processor", "a note", "h compiled in 7 s")
        head, read = page.read_data(out / "outer.csv")
        parts = page.blocks(out)
        before = (out / "outer.csv").read_bytes()
        try:
            page.write_data(out, systems.SYSTEMS["outer"], [*rows, made("rebound", "no number", "ok")], programs, 20, "", "")
            expect(False, "a row of no number is written")
        except ValueError:
            expect((out / "outer.csv").read_bytes() == before, "data that could not be written took the place of others")
        drawn(out)
        page.write_data(out, systems.SYSTEMS["outer"], rows[:1] + rows[2:], programs, 20, "a processor", "a note")
        alone = page.blocks(out)
    expect(len(read) == 4 and read[0]["rounds"] == 3 and read[0]["looks"] == 200, f"rows read: {read}")
    expect(head["programs"] == "noether 1.2 (b); rebound 1.2 (b)", head["programs"])
    text = "\n".join(parts["fronts"])
    expect("No run of heyoka ended. h compiled in 7 s. a note." in text, text)
    expect("heyoka 1.2" not in text and "Not measured yet: solar" in text and "2 timed three times" in text, text)
    expect("0.20" in text and "**" not in text, text)
    expect("Nowhere in outer:" in parts["misses"][0], f"{parts['misses']}")
    expect(alone["misses"] == ["Not measured yet."], f"won against nobody: {alone['misses']}")
    expect("No run of rebound or heyoka ended." in "\n".join(alone["fronts"]), f"{alone['fronts']}")
    expect(len(parts["refusals"]) == 3 and "it failed" in parts["refusals"][2], f"{parts['refusals']}")


def drawn(out):
    """A gnuplot that fails is said to fail, and loses neither page nor pictures."""
    program, picture = out / "gnuplot", out / "outer.png"
    program.write_text("#!/bin/sh\necho half > \"$(sed -n \"s/^set output '\\(.*\\)'/\\1/p\" \"$1\")\"\nexit 3\n", encoding="utf-8")
    program.chmod(0o755)
    picture.write_text("a picture", encoding="utf-8")
    path, os.environ["PATH"] = os.environ["PATH"], str(out) + os.pathsep + os.environ["PATH"]
    said = io.StringIO()
    with contextlib.redirect_stderr(said):
        failed = page.draw(out)
    os.environ["PATH"] = path
    expect(failed == 1 and "gnuplot failed with 3" in said.getvalue(), f"gnuplot failed, and {failed} pictures are missing")
    expect(picture.read_text(encoding="utf-8") == "a picture", "a picture that failed took the place of another")
    expect("Nowhere in outer:" in (out / "orbits.md").read_text(encoding="utf-8"), "no page where gnuplot fails")


def pages():
    out = page.HOME / "orbits"
    expect(page.check(out) == 0, "docs/orbits.md is not what its data say")
    text = page.page_path(out).read_text(encoding="utf-8")
    data = list(page.all_data(out))
    expect(bool(data) or "Not measured yet" in text, "docs/orbits.md does not say that nothing has been measured")
    for system, head, rows in data:
        expect({found["program"] for found in page.done(rows)} == {"noether", *page.PEERS}, f"{system.name}: a program is missing")
        expect(head["processor"] in text and head["commit"] in text, f"{system.name}: the page lacks processor or commit")
        expect(head["span"].endswith(f"{systems.SAMPLES} samples"), f"{system.name}: the data are those of a trial")


def trials():
    """They do not replace what is published."""
    for given in (["--span", "0.1"], ["--methods", "gauss"]):
        ended = subprocess.run([sys.executable, "-B", str(ROOT / "bench/fronts.py"), "no_program", *given], capture_output=True,
                               text=True, check=False)
        expect(ended.returncode == 2 and "--out FOLDER" in ended.stderr, f"{given}: {ended.stderr}")


def planted_errors():
    import numpy

    from orbits import errors

    for system in systems.SYSTEMS.values():
        bodies, truth = numpy.array(system.bodies), systems.read_truth(system)
        expect(truth.shape == (systems.SAMPLES + 1, len(bodies), 3), f"{system.name}: truth of shape {truth.shape}")
        start = bodies[:, 1:4] - bodies[0, 1:4]
        expect(abs(truth[0] - start).max() < 1e-15 * abs(start).max(), f"{system.name}: truth does not begin at the start")
        states = numpy.zeros((systems.SAMPLES, len(bodies), 6))
        states[:, :, :3] = truth[1:]
        expect(errors.position_error(states, truth[1:]) == 0, f"{system.name}: the truth has an error")
        mean = numpy.sqrt((truth[1:, 2] ** 2).sum(axis=1).mean())
        states[7, 2, 1] += 1e-6 * mean
        found = errors.position_error(states, truth[1:])
        expect(abs(found / 1e-6 - 1) < 1e-6, f"{system.name}: a position error of 1e-6 is measured as {found}")
        moving = numpy.stack([bodies[:, 1:], bodies[:, 1:]])
        moving[1, :, 3:] *= 1 + 1e-9
        kinetic = (bodies[:, 0] * (bodies[:, 4:] ** 2).sum(axis=1)).sum() / 2
        total = float(errors.energy(system.G, bodies[:, 0], moving)[0])
        found = errors.energy_error(system.G, bodies[:, 0], moving)
        expect(abs(found / (2e-9 * kinetic / abs(total)) - 1) < 1e-5, f"{system.name}: energy error measured as {found}")


def selection():
    """What is on a front goes before what is near one, and other programs' before noether's; what is slow and wrong does not go."""
    from orbits import measure

    def scanned(program, family, seconds, error):
        found = measure.Row(None, types.SimpleNamespace(program=program, family=family), divisions=4)
        found.seconds, found.energy, found.position, found.outcome = seconds, error, error, "ok"
        return found

    def all_rows():
        return [scanned("noether", "a", 0.5, 1e-9), scanned("noether", "a", 0.12, 1e-9), scanned("noether", "a", 0.1, 1e-9),
                scanned("noether", "b", 0.4, 1e-8), scanned("noether", "a", 0.001, 0.5), scanned("rebound", "c", 0.9, 1e-9)]

    rows = slow, close, best, other, rough, peer = all_rows()
    kept, total = measure.chosen(rows, 10, measure.Limits(row=20, system=100))
    expect(kept == [peer, best, close, other], "rows in another order than that of their merit")
    expect(slow.outcome == rough.outcome == "not near a front", f"{slow.outcome}, {rough.outcome}")
    expect(abs(total - (2 * 9.1 + 4 * 1.1 + 4 * 1.3 + 2 * 4.1)) < 1e-9, f"expected to take {total} s")
    peer.divisions = None
    expect(abs(measure.cost(peer, 10) - 9.1) < 1e-9, "a long run that no look disturbs is made twice")
    peer.entry.program = "heyoka"
    expect(abs(measure.cost(peer, 10) - 18.2) < 1e-9, "a long run whose time has its looks is made once")
    rows = slow, close, best, other, rough, peer = all_rows()
    kept, _ = measure.chosen(rows, 10, measure.Limits(row=5, system=100))
    expect(kept == [best, close, other] and peer.outcome.startswith("left out"), f"a run beyond the limit: {peer.outcome}")
    rows = slow, close, best, other, rough, peer = all_rows()
    kept, _ = measure.chosen(rows, 10, measure.Limits(row=20, system=34))
    expect(kept == [peer, best, close] and other.outcome.startswith("beaten in the scan"), f"no time: {other.outcome}")


class Slow:
    """A program whose runs take longer over the whole span than they should after the scan, and that heeds its limit."""

    version = build = commit = ""

    def __init__(self, system):
        import numpy

        self.system = system
        self.start = numpy.array(system.bodies)[:, 1:].ravel().tolist()
        self.longest = 0.0
        self.timed = 0

    def ask(self, question, timeout):
        from orbits.ours import Failed

        self.longest = max(self.longest, timeout)
        needed = 0.002 if question["samples"] == 1 else 0.25
        time.sleep(min(needed, timeout))
        if timeout < needed:
            raise Failed("not finished after a while")
        self.timed += question["samples"] > 1 and not question["watched"]
        looks = question["looks"] * question["samples"] + 1
        seconds = needed / 100 if question["samples"] == 1 else 0.26 if question["watched"] else needed
        return seconds, self.start * looks if question["watched"] else []


def budget():
    """The time for a system holds for the scan, the errors and the times, and what it ends is said."""
    from orbits import measure
    from orbits.methods import Entry

    system = systems.SYSTEMS["outer"]
    entries = [Entry("rebound", f"m{k}", f"f{k}", {}, ratios=(1, 0.5)) for k in range(12)]
    overhead, measure.OVERHEAD = measure.OVERHEAD, 0.0
    for whole in (0.05, 1.5):  # over before the scan is; over before all rows are
        begin, program = time.monotonic(), Slow(system)
        rows = measure.measure(system, {"rebound": program}, entries, 20, measure.Limits(row=90, system=whole))
        took = time.monotonic() - begin
        expect(took < whole + 1, f"{whole} s became {took:.2f} s")
        expect(program.longest <= whole, f"{whole} s: a run might have taken {program.longest:.2f} s")
        expect(len(rows) == 24 and all(found.outcome for found in rows), "rows without an outcome")
        expect(any("time" in found.outcome for found in rows), f"{whole} s: no row says that it had no time")
        measured = [found for found in rows if found.outcome == "ok"]
        expect(all(found.seconds == 0.25 for found in measured), "a time that is not that of the whole span")
        expect(sum(len(found.times) for found in rows) == program.timed, "times that were not taken")
        expect(bool(measured) == (whole > 1), f"{whole} s: {len(measured)} rows measured")
        expect(not any(found.outcome.startswith("not finished") for found in rows), "the end of the time made a row slow")
    measure.OVERHEAD = overhead


def failures():
    """A limit that was cut short, a compilation and a program that is gone leave rows out: only one that had all of its time is
    slow. What a program answers beside the point ends its row alone."""
    from orbits import measure
    from orbits.methods import Entry
    from orbits.ours import Failed

    class Other:
        def __init__(self, failure):
            self.failure = failure

        def ask(self, question, timeout):
            raise self.failure

    system = systems.SYSTEMS["outer"]

    def outcome(failure, seconds, wanted):
        found = measure.Row(system, Entry("rebound", "m", "f", {}), divisions=4)
        found.measure_time({"rebound": Other(failure)}, 1, measure.Limits(90, seconds), wanted)
        found.measure_errors({"rebound": Other(failure)}, 1, measure.Limits(90, seconds), wanted)
        return found.outcome

    late = Failed("not finished after 9 s")
    with contextlib.redirect_stdout(io.StringIO()):
        expect(outcome(late, 100, 9) == str(late), outcome(late, 100, 9))
        expect(outcome(late, 5, 9).startswith("left out: not finished"), outcome(late, 5, 9))
        for failure in (ValueError("a"), KeyError("a"), TypeError("a"), OSError("a")):
            expect(outcome(failure, 100, 9).startswith(type(failure).__name__), f"{failure!r}: {outcome(failure, 100, 9)}")

    for failure in ("not finished after 9 s", "left out: it could not be started again"):
        found = measure.Row(system, Entry("rebound", "m", "f", {}), divisions=4)
        found.seconds, found.energy, found.position, found.outcome, found.rank = 0.1, 1e-9, 1e-8, "ok", 1
        measure.run_over_span([found], {"rebound": Other(Failed(failure))}, 20, 20, measure.Limits(90, 1000))
        expect((found.seconds, found.energy, found.position, found.whole) == (0.1, 1e-9, 1e-8, False), f"{failure}: {vars(found)}")
        expect(found.outcome == "beaten in the scan: " + failure.removeprefix("left out: "), found.outcome)

    class Compiler(measure.Peer):
        """Compiles what has an even tolerance, and is too slow with others."""

        def start(self):
            self.asked = []
            self.version = self.build = ""
            self.forget()

        def ask(self, question, timeout):
            self.asked.append(question["samples"])
            if question["method"]["tolerance"] % 2:
                raise Failed("not finished after a while")
            return 0.5, system_states(question)

    def system_states(question):
        import numpy

        start = numpy.array(system.bodies)[:, 1:].ravel().tolist()
        return start * (question["looks"] * question["samples"] + 1)

    entry = Entry("heyoka", "m", "f", {}, tolerances=(1, 2), with_tolerance=lambda spec, tolerance: {"tolerance": tolerance})
    programs = {"heyoka": Compiler("python", "heyoka")}
    with contextlib.redirect_stdout(io.StringIO()):
        said = measure.compile_ahead(programs, system, [entry])
    expect(said.startswith("heyoka compiled 1 of 2 integrators in 0 s"), said)
    expect(measure.compile_ahead({}, system, [entry]) == "", "an absent program compiles")
    late, good = measure.rows_of(system, [entry])
    for found in (late, good):
        found.measure_errors(programs, 1, measure.Limits(90, 100), 9)
    expect(late.outcome == "left out: not compiled after 300 s", late.outcome)
    expect(good.outcome == "ok" and programs["heyoka"].asked == [0, 0, 1], f"{good.outcome}, {programs['heyoka'].asked}")
    programs["heyoka"].start()
    good.measure_errors(programs, 1, measure.Limits(90, 100), 9)
    expect(programs["heyoka"].asked == [0, 1], f"started again, it was asked {programs['heyoka'].asked}")


def other_programs():
    """Those that are absent, old, or answer nonsense are said to be so, and go on or are left out."""
    from orbits import measure
    from orbits.ours import Failed

    def absent(python):
        try:
            measure.Peer(python, "rebound").close()
        except measure.Absent as why:
            return str(why)
        return "present"

    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)

        def script(name, text):
            path = folder / name
            path.write_text("#!/bin/sh\n" + text, encoding="utf-8")
            path.chmod(0o755)
            return str(path)

        said = absent(str(folder / "nothing"))
        expect("cannot be started" in said, said)
        said = absent(script("bare", f'exec {sys.executable} -I -S "$@"\n'))
        expect("numpy is not installed" in said, said)
        expect("cannot be read" in absent(script("silent", "exit 0\n")), "a program that ends at once")
        (folder / "rebound.py").write_text("__version__ = '4.4.1'\n", encoding="utf-8")
        os.environ["PYTHONPATH"] = str(folder)
        said = absent(sys.executable)
        del os.environ["PYTHONPATH"]
        expect("4.4.1 is too old; expected 5" in said, said)
        greeting = 'echo \'{"version": "5.0", "build": "b"}\'\n'
        for name, answer in (("nonsense", "read a; echo nonsense; read b\n"), ("deaf", ""), ("mute", "read a; exec sleep 60\n")):
            peer = measure.Peer(script(name, greeting + answer), "rebound")
            for _ in range(2):
                try:
                    peer.ask({}, 0.3)
                    expect(False, f"an answer of {name}")
                except Failed as failure:
                    expect(str(failure) != "", f"{name} fails without a reason")
            peer.close()
        peer = measure.Peer(script("once", greeting), "rebound")
        script("once", "exit 0\n")
        found = measure.Row(systems.SYSTEMS["outer"], types.SimpleNamespace(program="rebound", spec={}), divisions=4)
        for _ in range(2):
            found.measure_errors({"rebound": peer}, 1, measure.Limits(90, 100), 5)
        expect(found.outcome.startswith("left out: it could not be started again"), f"a program that is gone: {found.outcome}")


def safe_mode():
    """Mercurius has its safe mode in runs that are looked at, and in no run that is timed."""
    from peers import orbits

    class Simulation:
        def add(self, **_):
            pass

        def __setattr__(self, name, value):
            super().__setattr__(name, types.SimpleNamespace(name=value) if name == "integrator" else value)

    for watched, expected in ((True, 1), (False, 0)):
        for name in ("mercurius", "eos"):
            run = {"G": 1.0, "bodies": [], "sample": 1, "divisions": 4, "watched": watched,
                   "method": {"integrator": name, "options": {"safe_mode": 0}}}
            mode = orbits.Rebound(types.SimpleNamespace(Simulation=Simulation)).start(run).integrator.safe_mode
            expect(mode == (expected if name == "mercurius" else 0), f"safe mode {mode} of {name}, watched: {watched}")


def missing_programs():
    """Without them the published data are not replaced."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        program, peers = folder / "noether", folder / "python"
        program.write_text("#!/bin/sh\necho noether 1 commit 0123abc level avx2\n", encoding="utf-8")
        peers.write_text("#!/bin/sh\necho '{\"absent\": \"none\"}'\n", encoding="utf-8")
        for path in (program, peers):
            path.chmod(0o755)
        given = types.SimpleNamespace(program=str(program), peers=str(peers), out=None, methods="verlet_aba$", systems="outer",
                                      span=1, budget=0.01, row=1, note="")
        said = ""
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                fronts.run(given, folder)
        except SystemExit as end:
            said = str(end)
        expect("there is no rebound and no heyoka" in said and "--out FOLDER" in said, f"without other programs: '{said}'")


def real_run(program):
    """A sample of the outer planets: errors are those of the method, and the energy's that of the monitor."""
    import numpy

    from orbits import errors, ours

    system = systems.SYSTEMS["outer"]
    method = {"method": "aba_10_6_4", "hamiltonian": "wisdom_holman", "divisions": system.divisions(400)}
    report, seconds, states = ours.Program(program).run(system, method, 1, True, 300)
    expect(seconds == report["wall_s"] > 0, f"{seconds} s are not those of the steps")
    looks = systems.looks_of(method["divisions"])
    expect(len(states) == looks + 1, f"{len(states)} states")
    masses = numpy.array([body[0] for body in system.bodies])
    energy = errors.energy_error(system.G, masses, states)
    expect(abs(energy / report["monitors"]["energy"]["worst"] - 1) < 1e-3, f"energy error {energy}, the monitor's differs")
    expect(1e-13 < energy < 1e-11, f"energy error {energy}")
    position = errors.position_error(states[looks::looks], systems.read_truth(system)[1:])
    expect(1e-12 < position < 1e-8, f"position error {position}")
    refused = {"method": "encke_gauss_8", "hamiltonian": "kinetic_potential", "divisions": 9216}
    try:
        ours.Program(program).run(systems.SYSTEMS["hierarchy"], refused, 1, True, 300)
        expect(False, "encke_gauss_8 is not refused where no body dominates")
    except ours.Failed as failure:
        expect("wide_gauss_8" in str(failure), f"refused with '{failure}'")


def main():
    for test in (steps, settings, tables, reasons, data_and_page, pages, trials):
        test()
    has_numpy = importlib.util.find_spec("numpy") is not None
    if has_numpy:
        for test in (planted_errors, selection, budget, failures, other_programs, safe_mode, missing_programs):
            test()
        if len(sys.argv) > 2:
            real_run(sys.argv[2])
    else:
        print("numpy is not installed: how errors are measured is not tested")
    for text in FAILED:
        print(text)
    return 1 if FAILED else 0 if has_numpy else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
