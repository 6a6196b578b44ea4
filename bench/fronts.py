"""Error fronts of orbits: seconds against errors, for noether's methods and those of REBOUND and heyoka.

    python3 bench/fronts.py PROGRAM                     # all five systems, then pictures and docs/orbits.md
    python3 bench/fronts.py PROGRAM --systems outer --span 0.1 --out /tmp/trial
    python3 bench/fronts.py --draw                      # pictures and page from the data that is there
    python3 bench/fronts.py --check                     # whether the page is that of the data

PROGRAM is noether. Python needs numpy; REBOUND and heyoka come from PyPI (`pip install rebound heyoka`, in the environment
of `--peers PYTHON` or of this Python); where one is absent only trials are made. Everything runs on one core.

First every method with every step or tolerance is run over a twentieth of the span, the scan. Those on the front of their program
there, then those near it, then those on the front of their family are run over the whole span, as many as there is time for; of
each of these, other programs' come first. Data have all rows: one that is not run over the whole span has the errors of the scan,
and the reason.

Errors and times are measured in separate runs, but for long ones whose looks cost nothing. Times are those of the steps alone by
the clock, so the machine should have nothing else to do. Timed runs of all programs alternate, and the median of three counts; a
run of more than 1.5 seconds is timed once.

heyoka compiles for each system and tolerance, before the budget begins; the log and the data say how long it took. The budget holds
for everything else: no run outlasts what is left of it. The systems that take longest come last, and have what the others leave.
Runs over a part of the span, by some methods or without the other programs are trials: they need --out, and their page is
written there."""

import argparse
import pathlib
import re
import sys
import time

from orbits import page, systems

DRAWING = 0.02  # of the budget, for pictures and page


def has_avx512():
    return "avx512dq" in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").split()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", help="noether")
    parser.add_argument("--systems", default=",".join(systems.SYSTEMS), help="a list; default: all")
    parser.add_argument("--methods", default="", help="a regular expression of methods; default: all")
    parser.add_argument("--span", type=float, default=1.0, help="fraction of the span")
    parser.add_argument("--budget", type=float, default=25, help="minutes for all systems; default 25")
    parser.add_argument("--row", type=float, default=90, help="longest run that is made, in seconds; default 90")
    parser.add_argument("--peers", default=sys.executable, help="the Python that has rebound and heyoka")
    parser.add_argument("--note", default="", help="what else to say of the machine, such as that it was busy")
    parser.add_argument("--out", help="folder of the data; default: docs/orbits")
    parser.add_argument("--draw", action="store_true", help="only pictures and page")
    parser.add_argument("--check", action="store_true", help="only whether the page is that of the data")
    given = parser.parse_args()
    reads = given.draw or given.check
    if not given.program and not reads:
        parser.error("give the path of the program noether")
    for name in given.systems.split(","):
        if name not in systems.SYSTEMS:
            parser.error(f"there is no system '{name}'; expected one of: {', '.join(systems.SYSTEMS)}")
    if not 0 < given.span <= 1:
        parser.error(f"--span {given.span:g} is not a fraction of the span; expected more than 0, at most 1")
    if not reads and not given.out and (given.span < 1 or given.methods):
        parser.error("a trial would replace the data of docs/orbits; give it a folder of its own: --out FOLDER")
    return given


def run(given, out):
    from orbits import measure  # it needs numpy, which pictures and page do not
    from orbits.methods import all_methods

    programs = measure.start_programs(given.program, given.peers)
    missing = [name for name in page.PEERS if name not in programs]
    if missing and not given.out:
        measure.stop_programs(programs)
        raise SystemExit(f"the data of docs/orbits compare with {' and '.join(page.PEERS)}, and there is no "
                         f"{' and no '.join(missing)}: install what is missing (pip install rebound heyoka; --peers PYTHON), or "
                         "give a trial a folder of its own: --out FOLDER")
    entries = [entry for entry in all_methods(has_avx512()) if re.search(given.methods, entry.label)]
    wanted = sorted((systems.SYSTEMS[name] for name in given.systems.split(",")), key=lambda system: system.share)
    samples = max(1, round(systems.SAMPLES * given.span))
    compiled = {system.name: measure.compile_ahead(programs, system, entries) for system in wanted}
    end = time.monotonic() + 60 * given.budget * (1 - DRAWING)
    for k, system in enumerate(wanted):
        share = system.share / sum(other.share for other in wanted[k:])
        limits = measure.Limits(given.row, (end - time.monotonic()) * share)
        rows = measure.measure(system, programs, entries, samples, limits)
        page.write_data(out, system, rows, programs, samples, page.processor(), given.note, compiled[system.name])
    measure.stop_programs(programs)


def main():
    given = arguments()
    out = pathlib.Path(given.out) if given.out else page.HOME / "orbits"
    if given.check:
        return page.check(out)
    if not given.draw:
        run(given, out)
    return 1 if page.draw(out) else 0


if __name__ == "__main__":
    sys.exit(main())
