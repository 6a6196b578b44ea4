"""The error fronts of docs/orbits.md: fronts_test.py ROOT [PROGRAM]. The page is what its data say, steps divide spans without
rounding, errors that are planted are found, other programs that misbehave do no harm, the time for a system is not exceeded, and a run of
the program is measured as its monitor measures it. No other program is needed. What needs numpy is left out without it."""

import fractions
import importlib.util
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

from orbits import page, systems  # noqa: E402
from orbits.methods import all_methods  # noqa: E402

FAILED = []


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
                expect(k % systems.looks_of(k) == 0, f"{system.name}: looks do not divide {k} steps")


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
        expect(min(page.levels(system, "energy_error")) >= 3 * floor, f"{system.name}: levels below rounding")
        expect(min(page.levels(system, "position_error")) >= difference, f"{system.name}: levels below the truth's error")
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
            row("noether", 0.1, 1e-30, page.BEATEN[0])]
    lines, misses = page.table(rows, "energy_error", at)
    found = {round(miss.level, 20): miss.ratio for miss in misses}
    expect(set(found) == {1e-6, 1e-7, 1e-8, 1e-9, 1e-13}, f"misses at {sorted(found)}")
    expect(abs(found[1e-9] - 1 / 1.9) < 1e-12, f"ratio {found[1e-9]}")
    expect(found[1e-13] is None, "what only another program reaches has no ratio")
    expect(sum("**" in line for line in lines) == 5, "\n".join(lines))
    expect("none" in lines[-1] and "not measured" not in lines[-1], lines[-1])
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
    """What is written is read again; programs without a row that ended are not named."""

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
        page.write_data(out, systems.SYSTEMS["outer"], rows, programs, 20, "a processor", "a note")
        head, read = page.read_data(out / "outer.csv")
        parts = page.blocks(out)
    expect(len(read) == 4 and read[0]["rounds"] == 3 and read[0]["looks"] == 200, f"rows read: {read}")
    expect(head["programs"] == "noether 1.2 (b); rebound 1.2 (b)", head["programs"])
    text = "\n".join(parts["fronts"])
    expect("heyoka" not in text and "Not measured yet: solar" in text and "2 timed three times" in text, text)
    expect("0.20" in text and "**" not in text, text)
    expect("Nowhere" in parts["misses"][0], f"{parts['misses']}")
    expect(len(parts["refusals"]) == 3 and "it failed" in parts["refusals"][2], f"{parts['refusals']}")


def pages():
    out = page.HOME / "orbits"
    expect(page.check(out) == 0, "docs/orbits.md is not what its data say")
    text = page.page_path(out).read_text(encoding="utf-8")
    data = list(page.all_data(out))
    expect(bool(data) or "Not measured yet" in text, "docs/orbits.md does not say that nothing has been measured")
    for system, head, rows in data:
        expect(len(page.done(rows)) > 20, f"{system.name}: {len(page.done(rows))} rows")
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

    def ask(self, question, timeout):
        from orbits.ours import Failed

        self.longest = max(self.longest, timeout)
        needed = 0.002 if question["samples"] == 1 else 0.25
        time.sleep(min(needed, timeout))
        if timeout < needed:
            raise Failed("not finished after a while")
        looks = question["looks"] * question["samples"] + 1
        return needed / 100 if question["samples"] == 1 else needed, self.start * looks if question["watched"] else []


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
        expect(all(found.times and found.whole for found in measured), "a row without a time is said to be measured")
        expect(bool(measured) == (whole > 1), f"{whole} s: {len(measured)} rows measured")
    measure.OVERHEAD = overhead


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
    if importlib.util.find_spec("numpy") is None:
        print("numpy is not installed: errors are not tested")
    else:
        for test in (planted_errors, selection, budget, other_programs):
            test()
        if len(sys.argv) > 2:
            real_run(sys.argv[2])
    for text in FAILED:
        print(text)
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
