"""1 Gyr of the outer Solar System: hours and errors of the energy by five methods, from runs over 1 Myr (exact: 10 Myr).

    python3 bench/gigayear.py PROGRAM                                    # all, then the table in docs/orbits.md
    python3 bench/gigayear.py PROGRAM --span 0.02 --starts 3 --out /tmp/trial
    python3 bench/gigayear.py --draw                                     # the table from the data that is there
    python3 bench/gigayear.py --check                                    # whether the table is that of the data

PROGRAM is noether. Python needs numpy and h5py. Everything runs on one core, some minutes.

Each method goes from 8 starts (exact: 4) that differ by some roundings, 1e-15: what its map does to the energy is the same in all of
them, and what rounding does is not. So the mean over starts is the truncation, and the spread about it is the round-off. The truncation
is the largest mean at a look; the round-off is c t^(1/2), c from all looks, and the slope of the means over the span shows whether
rounding (or the method) has a trend.

Over 1 Gyr the truncation stays, the round-off grows as t^(1/2), and a trend of more than three standard errors as t. Times are
processor times of a run without looks, less those of a run of one step; the machine should have nothing else to do even so. Of three
runs the quickest counts; a run of more than 10 seconds is timed once.

A trial, which is shorter, has fewer starts or leaves out methods, needs a folder of its own (--out): its data and page go there."""

import argparse
import csv
import datetime
import json
import os
import pathlib
import random
import re
import resource
import sys
import tempfile
from dataclasses import dataclass, field

from orbits import page, systems

BLOCK = "gigayear"
SYSTEM = systems.SYSTEMS["outer"]
YEAR = 365.25  # days
GYR = 1e9
LOOKS = 200
NEAR = 1e-15  # relative, how far apart starts are
LONG = 10  # seconds; a longer run is timed once
SURE = 3  # standard errors from which on a trend is one

SCENE = """units = "solar"
{every}
[particles]
bodies = "{table}"

[hamiltonian]
type = "{hamiltonian}"
G = {G!r}
{force}
[integrator]
method = "{method}"
step = "{step} day"
until = "{until!r} day"
{keys}
"""
LOOK = '[[every]]\ntype = "energy"\nsteps = {steps}\n'


@dataclass(frozen=True)
class Method:
    name: str
    method: str
    step: float  # [day]
    hamiltonian: str = "wisdom_holman"
    keys: dict = field(default_factory=dict)
    years: float = 1e6
    starts: int = 8
    minutes: float = 0  # asked for 1 Gyr; 0: nothing
    error: float = 0  # asked of the energy at 1 Gyr

    def steps(self, span):
        """How many make the span, a multiple of the looks."""
        return max(1, round(span * self.years * YEAR / self.step / LOOKS)) * LOOKS


METHODS = (
    Method("plain Wisdom-Holman", "verlet_aba", 200),
    Method("ABA(10,6,4)", "aba_10_6_4", 400, keys={"compensated": True}),
    Method("lazy kernel, corrector 17", "verlet_aba", 100, keys={"corrector": 17, "kernel": "lazy"}),
    Method("Gauss", "gauss_8", 433, "kinetic_potential", {"adaptive": False}, minutes=20),
    Method("exact", "encke_gauss_8", 360, "kinetic_potential", years=1e7, starts=4, minutes=60, error=1e-13),
)


def scene_text(method, steps, table, watched):
    every = "" if watched else "every = []"
    force = '\n[[hamiltonian.force]]\ntype = "gravity"\n' if method.hamiltonian == "kinetic_potential" else ""
    keys = "\n".join(f"{key} = {json.dumps(value)}" for key, value in method.keys.items())
    return SCENE.format(every=every, table=table, hamiltonian=method.hamiltonian, G=SYSTEM.G, force=force, method=method.method,
                        step=method.step, until=float(method.step * steps), keys=keys) + (
                            LOOK.format(steps=steps // LOOKS) if watched else "")


def start_table(number):
    """The bodies of a start: 0 is the system itself."""
    draw = random.Random(number)
    lines = ["name,mass [Msun],x [au],y [au],z [au],vx [au/day],vy [au/day],vz [au/day]"]
    for k, (mass, *state) in enumerate(SYSTEM.bodies):
        moved = [value * (1 + NEAR * draw.uniform(-1, 1)) if number else value for value in state]
        lines.append(",".join([f"body {k}", repr(mass), *map(repr, moved)]))
    return "\n".join(lines) + "\n"


def energies(path):
    """Relative errors of the energy at the looks, as the monitor has them; the first is at the start."""
    import h5py

    with h5py.File(path) as file:
        return file["noether/monitors/energy/relative_error"][:]


def run(program, method, steps, number, watched):
    """Processor time of the program, and errors of the energy."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "start.csv").write_text(start_table(number), encoding="utf-8")
        scene = folder / "scene.toml"
        scene.write_text(scene_text(method, steps, folder / "start.csv", watched), encoding="utf-8")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        text, _ = program.call(["run", str(scene), "--json", "--threads", "1", "--out", str(folder / "out")], timeout=36000)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        report = json.loads(text)
        if report["exit_code"] != 0 or report.get("step") != steps:
            said = ": ".join(report[key] for key in ("outcome", "message") if report.get(key))
            raise SystemExit(f"{method.name}: {said}, step {report.get('step', 0)} of {steps}")
        seconds = (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)
        return seconds, energies(folder / "out" / "run.h5") if watched else None


def figures(years, errors):
    """What `errors` say, a row for each start, a column for each of the times `years`: truncation, round-off at the end, the exponent
    of its growth, and the trend per year with its standard error."""
    import numpy

    times, errors = numpy.asarray(years), numpy.asarray(errors)
    mean, spread = errors.mean(axis=0), errors.std(axis=0, ddof=1)
    whole, count = times[-1], len(errors)
    round_off = float(numpy.sqrt((spread**2 / times).mean() * whole))
    exponent = float("nan")
    if (spread > 0).all():
        exponent = float(numpy.polyfit(numpy.log(times), numpy.log(spread), 1)[0])
    slope, at_start = numpy.polyfit(times, mean, 1)
    # The slope of a walk that ends with a spread s over the span T is uncertain by (6/5)^(1/2) s/T.
    walk = numpy.sqrt(1.2) * round_off / whole / numpy.sqrt(count)
    left = (mean - at_start - slope * times).std() / (times.std() * numpy.sqrt(len(times)))
    return {"truncation": float(abs(mean).max()), "round_off": round_off, "exponent": exponent, "trend": float(slope),
            "trend_error": float(numpy.hypot(walk, left))}


def measure(program, method, span, starts):
    steps = method.steps(span)
    count = min(starts or method.starts, method.starts)
    found = [run(program, method, steps, number, True)[1] for number in range(count)]
    if any(len(one) != LOOKS + 1 for one in found):
        raise SystemExit(f"{method.name}: {len(found[0])} looks at the energy; expected {LOOKS + 1}, that at the start among them")
    whole, start = [], []
    while not whole or len(whole) < 3 and max(whole) < LONG:
        whole.append(run(program, method, steps, 0, False)[0])
        start.append(run(program, method, 1, 0, False)[0])
    if min(whole) <= min(start):
        raise SystemExit(f"{method.name}: {steps} steps take less time than the start of the program varies; take a longer --span")
    years = [method.step * steps / LOOKS * (k + 1) / YEAR for k in range(LOOKS)]
    return {"method": method.name, "scene": ", ".join([method.method, *(f"{key} = {json.dumps(value)}" for key, value
                                                                        in method.keys.items())]),
            "step": method.step, "steps": steps, "starts": count, "seconds": min(whole) - min(start), "rounds": len(whole),
            **figures(years, [one[1:] for one in found])}


def write_data(path, rows, head):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(f"{path}.new", "w", encoding="utf-8", newline="") as file:
        file.write("".join(f"# {key}: {value}\n" for key, value in head.items() if value))
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({key: f"{value:.4g}" if isinstance(value, float) else value for key, value in row.items()})
    os.replace(f"{path}.new", path)


def read_data(path):
    head, rows = page.read_table(path)
    return head, [{key: value if key in ("method", "scene") else float(value) for key, value in row.items()} for row in rows]


def carried(row):
    """Hours, and the parts of the energy's error, of 1 Gyr."""
    years = row["step"] * row["steps"] / YEAR
    trend = abs(row["trend"]) * GYR if abs(row["trend"]) > SURE * row["trend_error"] else 0.0
    return {"hours": row["seconds"] / years * GYR / 3600, "round_off": row["round_off"] * (GYR / years) ** 0.5, "trend": trend,
            "trend_limit": max(abs(row["trend"]), SURE * row["trend_error"]) * GYR, "years": years}


def table(head, rows):
    """Lines of the page."""
    lines = ["| method | step, d | ns a step | measured over | truncation | round-off | grows as | 1 Gyr: hours | truncation | round-off | trend |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    asked = []
    for row in rows:
        far = carried(row)
        known = {method.name: method for method in METHODS}.get(row["method"])
        # The mean of walks is a walk, too.
        walks = row["truncation"] < 2 * row["round_off"] / row["starts"] ** 0.5
        truncation = f"below {row['truncation']:.0e}" if walks else f"{row['truncation']:.1e}"
        lines.append(f"| {row['method']}: `{row['scene']}` | {row['step']:g} | {row['seconds'] / row['steps'] * 1e9:.3g} | "
                     f"{far['years'] / 1e6:.3g} Myr, {row['starts']:.0f} starts | {truncation} | {row['round_off']:.1e} | "
                     f"t^{row['exponent']:.1f} | {far['hours']:.3g} | {truncation} | {far['round_off']:.1e} | "
                     + (f"{far['trend']:.1e} |" if far["trend"] else f"below {far['trend_limit']:.0e} |"))
        if known and known.minutes:
            held = "held" if far["hours"] * 60 < known.minutes else "**missed**"
            asked.append(f"{row['method']}: less than {known.minutes:g} minutes for 1 Gyr: {held}, {far['hours'] * 60:.3g}.")
        if known and known.error:
            error = row["truncation"] + far["round_off"] + far["trend_limit"]
            asked.append(f"{row['method']}: the energy to {known.error:.0e} then: {'held' if error < known.error else '**missed**'}, "
                         f"{error:.1e}.")
    return [f"Outer Solar System; noether {head['noether']}; {head['processor']}, one core; {head['date']}."
            + (f" {head['note']}." if head.get("note") else ""), "", *lines, "", *(["Asked: " + " ".join(asked)] if asked else [])]


def block(out):
    path = out / f"{BLOCK}.csv"
    return {BLOCK: table(*read_data(path)) if path.exists() else ["Not measured yet."]}


def filled(text, out):
    begin, end = (mark.replace("fronts.py", "gigayear.py") for mark in (page.BEGIN, page.END))
    return page.filled(text, block(out), begin, end)


def draw(out):
    text = filled((page.HOME / "orbits.md").read_text(encoding="utf-8"), out)
    page.page_path(out).write_text(text, encoding="utf-8")


def check(out):
    text = page.page_path(out).read_text(encoding="utf-8")
    if filled(text, out) == text:
        return 0
    print(f"docs/orbits.md is not what docs/orbits/{BLOCK}.csv says: run python3 bench/gigayear.py --draw", file=sys.stderr)
    return 1


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", help="noether")
    parser.add_argument("--methods", default="", help="a regular expression of their names; default: all")
    parser.add_argument("--span", type=float, default=1.0, help="fraction of 1 Myr (exact: 10 Myr)")
    parser.add_argument("--starts", type=int, default=0, help="at most so many; default: 8 (exact: 4)")
    parser.add_argument("--note", default="", help="what else to say of the machine, such as that it was busy")
    parser.add_argument("--out", help="folder of the data; default: docs/orbits")
    parser.add_argument("--draw", action="store_true", help="only the table")
    parser.add_argument("--check", action="store_true", help="only whether the table is that of the data")
    given = parser.parse_args()
    if not given.program and not (given.draw or given.check):
        parser.error("give the path of the program noether")
    if not 0 < given.span <= 1:
        parser.error(f"--span {given.span:g} is not a fraction of the span; expected more than 0, at most 1")
    if given.starts and given.starts < 2:
        parser.error(f"--starts {given.starts}: the spread needs at least 2")
    if not any(re.search(given.methods, method.name) for method in METHODS):
        parser.error(f"--methods {given.methods}: no method is called so; there are: {'; '.join(one.name for one in METHODS)}")
    if given.program and not given.out and (given.span < 1 or given.starts or given.methods):
        parser.error("a trial would replace the data of docs/orbits; give it a folder of its own: --out FOLDER")
    return given


def main():
    given = arguments()
    out = pathlib.Path(given.out) if given.out else page.HOME / "orbits"
    if given.check:
        return check(out)
    if not given.draw:
        from orbits import ours  # it needs numpy

        program = ours.Program(given.program)
        rows = []
        head = {"noether": f"{program.version} ({program.build}), commit {program.commit}", "processor": page.processor(),
                "date": datetime.date.today().isoformat(), "note": given.note}
        for method in METHODS:
            if not re.search(given.methods, method.name):
                continue
            rows.append(measure(program, method, given.span, given.starts))
            write_data(out / f"{BLOCK}.csv.part", rows, head)
            far = carried(rows[-1])
            print(f"{method.name}: {rows[-1]['seconds']:.3g} s for {far['years']:.3g} years, truncation "
                  f"{rows[-1]['truncation']:.1e}, round-off {rows[-1]['round_off']:.1e}", file=sys.stderr)
        os.replace(out / f"{BLOCK}.csv.part", out / f"{BLOCK}.csv")
    draw(out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
