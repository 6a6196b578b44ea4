"""The error fronts of docs/orbits.md: fronts_test.py ROOT [PROGRAM]. The page is what its data say, steps divide spans without
rounding, errors that are planted are found, and a run of the program is measured as its monitor measures it. What needs numpy is
left out without it."""

import fractions
import importlib.util
import pathlib
import sys
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


def row(program, seconds, energy, outcome="ok"):
    return {"program": program, "method": "m", "family": "f", "setting": "step", "value": 2.0, "seconds": seconds,
            "energy_error": energy, "position_error": energy, "outcome": outcome}


def tables():
    """Half of the time is asked, of rows that hold the error, and of no others."""
    rows = [row("noether", 1.0, 1e-9), row("rebound", 1.9, 5e-10), row("heyoka", 4.0, 1e-13), row("noether", 1.5, 1e-12),
            row("noether", 0.1, 1e-30, "left out")]
    lines, misses = page.table(rows, "energy_error")
    found = {round(miss[0], 20): miss[1] for miss in misses}
    expect(set(found) == {1e-6, 1e-7, 1e-8, 1e-9, 1e-13}, f"misses at {sorted(found)}")
    expect(abs(found[1e-9] - 1 / 1.9) < 1e-12, f"ratio {found[1e-9]}")
    expect(found[1e-13] is None, "what only another program reaches has no ratio")
    expect(sum("**" in line for line in lines) == 4, "\n".join(lines))


def pages():
    out = ROOT / "docs/orbits"
    expect(page.check(out) == 0, "docs/orbits.md is not what its data say")
    text = page.page_path(out).read_text(encoding="utf-8")
    for system, head, rows in page.all_data(out):
        expect(len(page.done(rows)) > 20, f"{system.name}: {len(page.done(rows))} rows")
        expect(head["processor"] in text and head["commit"] in text, f"{system.name}: the page lacks processor or commit")
    expect(page.UNEXPLAINED not in text, "docs/orbits.md has a miss without a reason: bench/orbits/page.py")


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
    """What is on a front goes before what is near one; what is slow and wrong does not go at all."""
    from orbits import measure

    def scanned(program, family, seconds, error):
        found = measure.Row(None, types.SimpleNamespace(program=program, family=family))
        found.seconds, found.energy, found.position, found.outcome = seconds, error, error, "ok"
        return found

    best, close, slow = (scanned("noether", "a", seconds, 1e-9) for seconds in (0.1, 0.12, 0.5))
    other = scanned("noether", "b", 0.4, 1e-8)
    rough, peer = scanned("noether", "a", 0.001, 0.5), scanned("rebound", "c", 3.0, 1e-9)
    found = dict(measure.by_merit([slow, close, best, other, rough, peer]))
    expect(found == {best: 0, close: 1, other: 2, peer: 0}, "rows in another order than that of their merit")
    kept, dropped, total = measure.chosen([slow, close, best, other, rough, peer], 10, measure.Limits(row=20, system=100))
    expect(kept == [best, close, other] and dropped == [peer], "a run beyond the limit is not left out")
    expect(abs(total - (4 * 1.1 + 4 * 1.3 + 4.1)) < 1e-9, f"expected to take {total} s")


def real_run(program):
    """A sample of the outer planets: errors are those of the method, and the energy's that of the monitor."""
    import numpy

    from orbits import errors, ours

    system = systems.SYSTEMS["outer"]
    method = {"method": "aba_10_6_4", "hamiltonian": "wisdom_holman", "divisions": system.divisions(400)}
    report, _, states = ours.Program(program).run(system, method, 1, True, 300)
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
    steps()
    tables()
    pages()
    if importlib.util.find_spec("numpy") is None:
        print("numpy is not installed: errors are not tested")
    else:
        planted_errors()
        selection()
        if len(sys.argv) > 2:
            real_run(sys.argv[2])
    for text in FAILED:
        print(text)
    return 1 if FAILED else 0


if __name__ == "__main__":
    sys.exit(main())
