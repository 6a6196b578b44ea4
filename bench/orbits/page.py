"""The data of the fronts as files, pictures and the tables of docs/orbits.md."""

import csv
import datetime
import os
import pathlib
import subprocess
import sys
import tempfile
from dataclasses import dataclass

from orbits import systems

COLUMNS = ("program", "method", "family", "setting", "value", "seconds", "rounds", "looks", "energy_error", "position_error",
           "outcome")
PEERS = ("rebound", "heyoka")
HOME = pathlib.Path(__file__).resolve().parents[2] / "docs"
OPEN = ("left out", "not finished")  # outcomes of rows that might be on a front
BEATEN = ("not near a front", "beaten in the scan")  # of those that another row of their program beat in the scan
ABOVE_FLOOR = 3  # the least level of energy errors, in units of what the rounding of states to doubles makes
SAME = 0.1  # within which errors of the same map agree
LEVELS = [10.0**-k for k in range(6, 15)]
SHARE = 0.5  # of the time of the best other program is asked at each error
SMALL_SHARE = {"outer": (1e-13, 0.1)}  # systems where less is asked from an error on
BEGIN, END = "<!-- begin {}: written by bench/fronts.py -->", "<!-- end {} -->"
METRICS = (("energy_error", "energy"), ("position_error", "positions"))

# The series of a picture: its name, and what belongs to it.
SERIES = (
    ("noether: Wisdom-Holman", "noether", ("Wisdom-Holman",), "#1b6ca8", 7),
    ("noether: ABA, SABA", "noether", ("ABA",), "#3aa0d8", 5),
    ("noether: Gauss", "noether", ("Gauss",), "#0b3d5c", 9),
    ("noether: exact", "noether", ("exact",), "#000000", 11),
    ("noether: others", "noether", ("drift and kick", "adaptive", "multistep"), "#9cc4dc", 13),
    ("REBOUND: WHFast", "rebound", ("WHFast",), "#c0392b", 6),
    ("REBOUND: WHFast512", "rebound", ("WHFast512",), "#7b241c", 3),
    ("REBOUND: SABA", "rebound", ("SABA",), "#e67e22", 4),
    ("REBOUND: IAS15", "rebound", ("IAS15",), "#8e44ad", 8),
    ("REBOUND: others", "rebound", ("Leapfrog", "EOS", "JANUS", "Mercurius", "TRACE", "BS"), "#e6b0aa", 12),
    ("heyoka", "heyoka", ("Taylor",), "#27ae60", 10),
)


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def write_data(out, system, rows, programs, samples, processor, note, compiled=""):
    """All rows. Those with 0 rounds have the errors of the scan, and the time that the whole span should take."""
    out.mkdir(parents=True, exist_ok=True)
    ended = [name for name in programs if any(row.outcome == "ok" and row.entry.program == name for row in rows)]
    versions = "; ".join(f"{name} {programs[name].version} ({programs[name].build})" for name in ended)
    head = {"system": system.title, "span": f"{system.end(samples)} days, {samples} samples", "programs": versions,
            "commit": programs["noether"].commit, "processor": processor, "date": datetime.date.today().isoformat(),
            "compiled": compiled, "note": note}
    order = {"noether": 0, "rebound": 1, "heyoka": 2}
    rows = sorted(rows, key=lambda row: (order[row.entry.program], row.entry.label, row.tolerance or 0, row.step or 0))
    path = out / f"{system.name}.csv"
    with open(f"{path}.new", "w", encoding="utf-8", newline="") as file:
        file.write("".join(f"# {key}: {value}\n" for key, value in head.items() if value))
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for row in rows:
            figures = [""] * 5
            if row.seconds is not None:
                figures = [f"{row.seconds:.4g}", len(row.times), row.looks * samples, f"{row.energy:.2e}",
                           f"{row.position:.2e}"]
            writer.writerow([row.entry.program, row.entry.label, row.entry.family, "step" if row.divisions else "tolerance",
                             repr(row.step or row.tolerance), *figures, row.outcome])
    os.replace(f"{path}.new", path)


def read_table(path):
    """The head, and the rows as text."""
    head, lines = {}, []
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("# "):
            key, _, value = line[2:].partition(": ")
            head[key] = value
        else:
            lines.append(line)
    return head, list(csv.DictReader(lines))


def read_data(path):
    """The head, and the rows; what a row has no figure for is None."""
    head, rows = read_table(path)
    for row in rows:
        for key in ("value", "seconds", "rounds", "looks", "energy_error", "position_error"):
            row[key] = float(row[key]) if row[key] else None
    return head, rows


def done(rows):
    return [row for row in rows if row["outcome"] == "ok"]


def best(rows, metric, level):
    """The quickest row whose error is at most the level."""
    good = [row for row in done(rows) if row[metric] <= level]
    return min(good, key=lambda row: row["seconds"]) if good else None


def unknown(rows, metric, level, measured):
    """Rows without a measurement that might be quicker at this level than the best of those with one. What beat a row in the scan
    may have lost the level over the whole span, so rows that were beaten there count too."""
    found = [row for row in rows if row["outcome"].startswith(OPEN + BEATEN)]
    if measured is None:
        return [row for row in found if row[metric] is None or row[metric] <= level]
    slower = [row for row in found if row["outcome"].startswith("not finished")]  # than the longest run that is made
    return [row for row in found if row not in slower and
            (row[metric] is None or row[metric] <= level and row["seconds"] < measured["seconds"])]


def levels(system, metric):
    """Those at which errors can be told."""
    floor, difference = systems.resolution(system)
    least = ABOVE_FLOOR * floor if metric == "energy_error" else difference
    return [level for level in LEVELS if level >= least]


def plain_number(value):
    return f"{value:.4g}" if 1e-3 <= value < 1e5 else f"{value:.0e}"


def name_of(row):
    unit = "d" if row["setting"] == "step" else "tolerance"
    value = f"{plain_number(row['value'])} d" if unit == "d" else f"tolerance {row['value']:.0e}"
    method = f"`{row['method']}`" if row["program"] == "noether" else row["method"]
    return f"{method}, {value}"


def reason(miss):
    """What the data say of a miss."""
    if miss.open:
        names = sorted({row["method"] for row in miss.open})
        return "open: not measured " + ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
    ours, theirs = miss.ours, miss.theirs
    if ours is None:
        return "no method of noether's that was measured reaches this error here"
    if not ours["setting"] == theirs["setting"] == "step":
        return f"noether's best is {name_of(ours)}"
    step = ours["value"] / theirs["value"]
    if step == 1 and all(abs(ours[metric] / theirs[metric] - 1) <= SAME for metric, _ in METRICS if theirs[metric]):
        return f"the same step and, within 10 %, the same errors: a step takes {miss.ratio:.2f} times as long"
    return f"noether's best is {name_of(ours)}: {step:.2f} times the step, {miss.ratio * step:.2f} times the time of one"


@dataclass
class Miss:
    """Where half of the time is missed, or not known to be held."""

    level: float
    ratio: float  # or None
    ours: dict  # or None
    theirs: dict  # or None
    open: list  # rows that were not measured and may be quicker


def cells_of(row, missing):
    if row is None:
        return ["not measured" if missing else "none", ""]
    return [name_of(row), f"{row['seconds']:.3g}"]


def asked(system, level):
    """The part of the best other program's time that is asked at an error."""
    small, share = SMALL_SHARE.get(system, (0, SHARE))
    return share if level <= small else SHARE


def table(rows, metric, at, system=""):
    """Lines of a table for the levels `at`, and the misses."""
    own = [row for row in rows if row["program"] == "noether"]
    other = [row for row in rows if row["program"] != "noether"]
    lines = ["| error at most | noether | s | best other | s | ratio |", "|---|---|---|---|---|---|"]
    misses = []
    for level in at:
        ours, theirs = best(own, metric, level), best(other, metric, level)
        hidden = unknown(other, metric, level, theirs)
        own_hidden = unknown(own, metric, level, None) if ours is None else []
        if ours is None and theirs is None and not hidden and not own_hidden:
            continue
        ratio = ours["seconds"] / theirs["seconds"] if ours and theirs else None
        held = not hidden and (theirs is None or (ratio is not None and ratio <= asked(system, level)))
        if not held:
            misses.append(Miss(level, ratio, ours, theirs, hidden or own_hidden))
        last = "open" if hidden or (theirs and own_hidden) else "" if ratio is None else f"{ratio:.2f}"
        cells = [f"{level:.0e}", *cells_of(ours, own_hidden), *cells_of(theirs, hidden)]
        cells.append(last if held or not last else f"**{last}**")
        lines.append("| " + " | ".join(cells) + " |")
    return lines, misses


def all_data(out):
    for system in systems.SYSTEMS.values():
        path = out / f"{system.name}.csv"
        if path.exists():
            yield system, *read_data(path)


def between(values):
    least, most = min(values), max(values)
    return f"{least:.0f}" if least == most else f"{least:.0f} to {most:.0f}"


def without(rows):
    """Which of the other programs these rows do not compare with."""
    absent = [name for name in PEERS if not any(row["program"] == name for row in done(rows))]
    return f"No run of {' or '.join(absent)} ended" if absent else ""


def about(system, head, rows):
    """What was run, in words."""
    kept = done(rows)
    counts = [(n, sum(row["rounds"] == n for row in kept)) for n in (3, 2, 1)]
    rounds = ", ".join(f"{count} timed {('once', 'twice', 'three times')[n - 1]}" for n, count in counts if count)
    behind = sum(row["outcome"].startswith(BEATEN) for row in rows)
    hidden = sum(row["outcome"].startswith(OPEN) for row in rows)
    floor, difference = systems.resolution(system)
    return [f"{len(kept)} runs over {head['span']}: {rounds}; errors of energy from {between([row['looks'] for row in kept])} looks. "
            f"Rows beaten in the scan: {behind}; left out: {hidden}.",
            f"{head['programs']}; noether's commit {head['commit']}; {head['processor']}, one core; {head['date']}."
            + "".join(f" {text}." for text in (without(rows), head.get("compiled"), head.get("note")) if text),
            f"Rounding to doubles alone makes an error of energy of {floor:.1e}, and positions of the truth are known to "
            f"{difference:.1e}.", f"All rows: [orbits/{system.name}.csv](orbits/{system.name}.csv).", ""]


def fronts(out):
    """Lines of the section of all systems, and the misses, each behind its system and error."""
    lines, missed, found = [], [], set()
    for system, head, rows in all_data(out):
        if not done(rows):
            continue
        found.add(system.name)
        lines += [f"### {system.title}", "", f"![errors against time](orbits/{system.name}.png)", "", *about(system, head, rows)]
        for metric, words in METRICS:
            more, misses = table(rows, metric, levels(system, metric), system.name)
            lines += [f"Errors of {words}:", "", *more, ""]
            missed += [(system, words, miss) for miss in misses]
    absent = [name for name in systems.SYSTEMS if name not in found]
    return lines + ([f"Not measured yet: {', '.join(absent)}."] if absent else []), missed


def misses_table(missed, data):
    """Of `data`, the rows of all systems: where no run of another program ended, nothing was won."""
    compared = [system.name for system, rows in data if any(row["program"] != "noether" for row in done(rows))]
    if not compared:
        return ["Not measured yet."]
    if not missed:
        return [f"Nowhere in {', '.join(compared)}: at every error above that another program reaches, noether takes at most "
                "half its time."]
    lines = ["| system | error of | at most | ratio | against | why |", "|---|---|---|---|---|---|"]
    for system, words, miss in missed:
        ratio = "open" if miss.open else "" if miss.ratio is None else f"{miss.ratio:.2f}"
        against = name_of(miss.theirs) if miss.theirs else "not measured"
        lines.append(f"| {system.name} | {words} | {miss.level:.0e} | {ratio} | {against} | {reason(miss)} |")
    return lines


def refused(out):
    """What did not end, once for each method and message."""
    lines = ["| system | program | method | what it said |", "|---|---|---|---|"]
    for system, _, rows in all_data(out):
        said = [(row["program"], row["method"], row["outcome"]) for row in rows
                if row["outcome"] != "ok" and not row["outcome"].startswith(OPEN + BEATEN)]
        lines += [f"| {system.name} | {program} | {method} | {text.replace('|', '/')} |"
                  for program, method, text in dict.fromkeys(said)]
    return lines if len(lines) > 2 else ["Nothing of the sort was seen."]


def blocks(out):
    lines, missed = fronts(out)
    data = [(system, rows) for system, _, rows in all_data(out)]
    measured = any(done(rows) for _, rows in data)
    return {"fronts": lines, "misses": misses_table(missed, data),
            "refusals": refused(out) if measured else ["Not measured yet."]}


def page_path(out):
    """Data elsewhere have a page beside them."""
    return HOME / "orbits.md" if out.resolve() == HOME / "orbits" else out / "orbits.md"


def filled(text, parts, begin_mark=BEGIN, end_mark=END):
    for name, lines in parts.items():
        begin, end = begin_mark.format(name), end_mark.format(name)
        if begin not in text or end not in text:
            raise SystemExit(f"docs/orbits.md has no lines '{begin}' and '{end}'")
        before, after = text.split(begin)[0], text.split(end)[1]
        text = before + begin + "\n" + "\n".join(lines).strip("\n") + "\n" + end + after
    return text


def plot_script(path, rows, title):
    """gnuplot's commands for a picture of two panels."""
    text = [f"set terminal pngcairo size 1200,640 font 'sans,11'\nset output '{path}'",
            f"set multiplot layout 1,2 title '{title}' font ',14'",
            "set logscale xy\nset format x '1e%T'\nset format y '%g'\nset xrange [*:*] reverse\nset grid lc '#dddddd'",
            "set ylabel 'seconds'\nset key outside top center horizontal maxcols 4 samplen 1 font ',9'"]
    rows = done(rows)
    for metric, words in METRICS:
        curves = []
        for name, program, families, color, point in SERIES:
            own = [row for row in rows if row["program"] == program and row["family"] in families and row[metric] > 0]
            if own:
                data = "\n".join(f"{row[metric]!r} {row['seconds']!r}" for row in own)
                text.append(f"$points{len(curves)}{metric} << EOD\n{data}\nEOD")
                curves.append(f"$points{len(curves)}{metric} with points pt {point} ps 0.7 lc '{color}' title '{name}'")
        for program, color in (("noether", "#1b6ca8"), ("rebound", "#c0392b"), ("heyoka", "#27ae60")):
            own = sorted((row for row in rows if row["program"] == program and row[metric] > 0), key=lambda row: row[metric])
            line, least = [], float("inf")
            for row in own:
                if row["seconds"] < least:
                    least = row["seconds"]
                    line.append(f"{row[metric]!r} {row['seconds']!r}")
            if line:
                text.append(f"$front_{program}_{metric} << EOD\n" + "\n".join(line) + "\nEOD")
                curves.append(f"$front_{program}_{metric} with lines lw 2 lc '{color}' notitle")
        text.append(f"set xlabel 'largest error of {words}'\nplot " + ", \\\n ".join(curves))
    return "\n".join(text) + "\nunset multiplot\n"


def draw(out):
    """The tables of the page, then pictures; returns how many of these gnuplot did not make."""
    text = filled((HOME / "orbits.md").read_text(encoding="utf-8"), blocks(out))
    path = page_path(out)
    path.write_text(text if path.parent == HOME else text.replace("](orbits/", "]("), encoding="utf-8")
    failed = 0
    for system, _, rows in all_data(out):
        if not done(rows):
            continue
        with tempfile.NamedTemporaryFile("w", suffix=".gp", encoding="utf-8") as script:
            picture = out / f"{system.name}.png"
            script.write(plot_script(f"{picture}.new", rows, system.title))
            script.flush()
            try:
                subprocess.run(["gnuplot", script.name], check=True)
                os.replace(f"{picture}.new", picture)
            except FileNotFoundError:
                print("gnuplot is not installed: the pictures are left as they are", file=sys.stderr)
                break
            except subprocess.CalledProcessError as error:
                pathlib.Path(f"{picture}.new").unlink(missing_ok=True)
                print(f"gnuplot failed with {error.returncode}: {picture} is left as it is", file=sys.stderr)
                failed += 1
    return failed


def check(out):
    """0 where the page has what the data say."""
    text = page_path(out).read_text(encoding="utf-8")
    if filled(text, blocks(out)) == text:
        return 0
    print("docs/orbits.md is not what the data of docs/orbits/*.csv say: run python3 bench/fronts.py --draw", file=sys.stderr)
    return 1
