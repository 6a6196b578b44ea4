"""1 Gyr of the outer planets: gigayear_test.py ROOT [PROGRAM]. Planted walks, oscillations and trends are found and carried on by their
laws, the page is what its data say, the command refuses what would spoil the data, and the program makes a short trial. Without numpy
(of the trial, h5py too) what is left is tested, and the test is skipped."""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(ROOT / "bench"))
sys.dont_write_bytecode = True

import gigayear  # noqa: E402

FAILED = []
SKIPPED = 77


def expect(condition, text):
    if not condition:
        FAILED.append(text)


def planted():
    """A thousand starts of a walk of 1e-15 at the end, an oscillation of 1e-12, and a trend or none."""
    import numpy

    count, looks = 1000, gigayear.LOOKS
    years = numpy.arange(1, looks + 1) * 1e6 / looks
    steps = numpy.random.default_rng(1).normal(size=(count, looks))
    walk = 1e-15 * steps.cumsum(axis=1) / looks**0.5
    wave = 1e-12 * numpy.sin(numpy.arange(1, looks + 1) * 2.4)
    for trend in (0.0, 3e-18):
        found = gigayear.figures(years, walk + wave + trend * years)
        expect(abs(found["round_off"] / 1e-15 - 1) < 0.05, f"round-off {found['round_off']}")
        expect(abs(found["exponent"] - 0.5) < 0.05, f"exponent {found['exponent']}")
        expect(abs(found["trend"] - trend) < 3 * found["trend_error"], f"trend {found['trend']} of {trend}")
        expect(found["trend_error"] < 5e-19, f"trend known to {found['trend_error']}")
        largest = 1e-12 + trend * 1e6
        expect(abs(found["truncation"] / largest - 1) < (0.7 if trend else 0.02), f"truncation {found['truncation']}")
        seen = gigayear.carried({"step": 365.25, "steps": 1e6, "seconds": 3.6, **found})
        expect(abs(seen["round_off"] / (found["round_off"] * 1000**0.5) - 1) < 1e-12, f"round-off carried on: {seen}")
        expect(abs(seen["hours"] - 1) < 1e-12, f"hours carried on: {seen}")
        expect((seen["trend"] > 0) == (trend > 0), f"a trend of {trend} is carried on as {seen['trend']}")


def starts():
    """They differ, by roundings, and the first is the system."""
    texts = [gigayear.start_table(k) for k in range(8)]
    expect(len(set(texts)) == 8, "two starts are the same")
    expect(texts[3] == gigayear.start_table(3), "a start is another one when it is made again")
    rows = [[float(value) for value in line.split(",")[1:]] for line in texts[0].splitlines()[1:]]
    expect(rows == gigayear.SYSTEM.bodies, "start 0 is not the system")
    for text in texts[1:]:
        for line, body in zip(text.splitlines()[1:], gigayear.SYSTEM.bodies):
            values = [float(value) for value in line.split(",")[1:]]
            expect(values[0] == body[0], "a mass has changed")
            expect(all(abs(a / b - 1) < 1.3e-15 for a, b in zip(values, body)), f"a start is too far away: {values}")


def steps():
    for method in gigayear.METHODS:
        for span in (1, 0.02, 1e-9):
            count = method.steps(span)
            expect(count > 0 and count % gigayear.LOOKS == 0, f"{method.name}: {count} steps")
        years = method.steps(1) * method.step / gigayear.YEAR
        expect(abs(years / method.years - 1) < 0.01, f"{method.name}: {years} years")


def table():
    """What is asked is judged by what was measured."""
    row = {"method": "exact", "scene": "encke_gauss_8", "step": 360.0, "steps": 1e7, "starts": 4.0, "truncation": 1e-17,
           "round_off": 1e-16, "exponent": 0.5, "trend": 1e-27, "trend_error": 1e-27}
    head = {"noether": "1", "processor": "P", "date": "D"}
    for seconds, more, words in ((30.0, {}, "60 minutes for 1 Gyr: held"), (40.0, {}, "60 minutes for 1 Gyr: **missed**"),
                                 (30.0, {}, "1e-13 then: held"), (30.0, {"round_off": 3e-14}, "1e-13 then: **missed**"),
                                 (30.0, {"trend": 1e-21}, "1e-13 then: **missed**")):
        text = "\n".join(gigayear.table(head, [{**row, "seconds": seconds, **more}]))
        expect(words in text, f"not '{words}' in {text}")
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "gigayear.csv"
        gigayear.write_data(path, [{**row, "seconds": 30.0}], head)
        again = gigayear.read_data(path)
        expect(again == (head, [{**row, "seconds": 30.0}]), f"data are read as {again}")
        gigayear.draw(path.parent)
        expect(gigayear.check(path.parent) == 0, "a page that was just written is not that of its data")
        path.write_text(path.read_text(encoding="utf-8").replace("1e-16", "2e-16"), encoding="utf-8")
        expect(gigayear.check(path.parent) == 1, "a page of other data passes")


def command():
    def ended(*given):
        return subprocess.run([sys.executable, "-B", str(ROOT / "bench/gigayear.py"), *given], capture_output=True, text=True)

    for given, words in ((["no_program", "--span", "0.1"], "--out FOLDER"), (["no_program", "--starts", "1", "--out", "x"], "at least 2"),
                         (["no_program", "--span", "2", "--out", "x"], "at most 1"), ([], "give the path"),
                         (["no_program", "--methods", "rk4", "--out", "x"], "no method is called so")):
        found = ended(*given)
        expect(found.returncode == 2 and words in found.stderr, f"{given}: {found.returncode}, {found.stderr}")
    found = ended("--check")
    expect(found.returncode == 0, f"docs/orbits.md: {found.stderr}")


def trial(program):
    with tempfile.TemporaryDirectory() as folder:
        for span in ("0.001", "0.01"):  # a machine may be too quick for the shorter one, or too busy
            found = subprocess.run([sys.executable, "-B", str(ROOT / "bench/gigayear.py"), program, "--span", span, "--starts", "2",
                                    "--out", folder], capture_output=True, text=True)
            if "take a longer --span" not in found.stderr:
                break
        expect(found.returncode == 0, f"a trial: {found.stderr}")
        if found.returncode != 0:
            return
        rows = {row["method"]: row for row in gigayear.read_data(pathlib.Path(folder) / "gigayear.csv")[1]}
        expect(set(rows) == {method.name for method in gigayear.METHODS}, f"measured: {list(rows)}")
        plain, gauss = (next(row for name, row in rows.items() if word in name) for word in ("plain", "Gauss"))
        expect(1e-7 < plain["truncation"] < 1e-5, f"plain Wisdom-Holman: {plain}")
        expect(gauss["truncation"] < 1e-13, f"Gauss: {gauss}")
        for row in (plain, gauss):
            expect(1e-17 < row["round_off"] < 1e-13, f"round-off: {row}")
        expect("plain Wisdom-Holman" in (pathlib.Path(folder) / "orbits.md").read_text(encoding="utf-8"), "the page has no table")


def main():
    for test in (starts, steps, table, command):
        test()
    has = {name: importlib.util.find_spec(name) is not None for name in ("numpy", "h5py")}
    if has["numpy"]:
        planted()
    if all(has.values()) and len(sys.argv) > 2:
        trial(sys.argv[2])
    for text in FAILED:
        print(text)
    return 1 if FAILED else 0 if all(has.values()) else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
