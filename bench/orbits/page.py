"""The data of the fronts as files, pictures and the tables of docs/orbits.md."""

import csv
import datetime
import pathlib
import subprocess
import sys
import tempfile

from orbits import systems

COLUMNS = ("program", "method", "family", "setting", "value", "seconds", "rounds", "energy_error", "position_error",
           "outcome")
LEVELS = [10.0**-k for k in range(6, 15)]
SHARE = 0.5  # of the time of the best other program is asked at each error
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


def write_data(out, system, rows, programs, samples, processor, note):
    out.mkdir(parents=True, exist_ok=True)
    versions = ", ".join(f"{name} {program.version}" for name, program in programs.items())
    head = {"system": system.title, "span": f"{system.end(samples)} days, {samples} samples", "programs": versions,
            "commit": programs["noether"].commit, "level": programs["noether"].level, "processor": processor,
            "date": datetime.date.today().isoformat(), "note": note}
    order = {"noether": 0, "rebound": 1, "heyoka": 2}
    rows = sorted(rows, key=lambda row: (order[row.entry.program], row.entry.label, row.tolerance or 0, row.step or 0))
    with open(out / f"{system.name}.csv", "w", encoding="utf-8", newline="") as file:
        file.write("".join(f"# {key}: {value}\n" for key, value in head.items() if value))
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for row in rows:
            done = row.outcome == "ok"
            writer.writerow([row.entry.program, row.entry.label, row.entry.family, "step" if row.divisions else "tolerance",
                             repr(row.step or row.tolerance), f"{row.seconds:.4g}" if done else "",
                             len(row.times) if done else "", f"{row.energy:.2e}" if done else "",
                             f"{row.position:.2e}" if done else "", row.outcome])


def read_data(path):
    """The head, and the rows that have figures."""
    head, lines = {}, []
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("# "):
            key, _, value = line[2:].partition(": ")
            head[key] = value
        else:
            lines.append(line)
    rows = list(csv.DictReader(lines))
    for row in rows:
        for key in ("value", "seconds", "energy_error", "position_error"):
            row[key] = float(row[key]) if row[key] else None
    return head, rows


def done(rows):
    return [row for row in rows if row["outcome"] == "ok"]


def best(rows, metric, level):
    """The quickest row whose error is at most the level."""
    good = [row for row in rows if row[metric] <= level]
    return min(good, key=lambda row: row["seconds"]) if good else None


def plain_number(value):
    return f"{value:.4g}" if 1e-3 <= value < 1e5 else f"{value:.0e}"


def name_of(row):
    unit = "d" if row["setting"] == "step" else "tolerance"
    value = f"{plain_number(row['value'])} d" if unit == "d" else f"tolerance {row['value']:.0e}"
    method = f"`{row['method']}`" if row["program"] == "noether" else row["method"]
    return f"{method}, {value}"


def reason(ours, theirs):
    """Why ours is not twice as fast."""
    if ours is None:
        return "no method of noether's reaches this error here"
    return REASONS.get((ours["family"], theirs["family"]), REASONS.get(theirs["family"], UNEXPLAINED))


UNEXPLAINED = "not explained yet"
SAME_MAP = ("the same map: steps and errors agree, and its step takes less time; noether computes arcs and kicks planet by planet, "
            "not yet in SIMD lanes")
LONG_STEPS = "at this error a splitting with a long step is enough, and a step of noether's splittings takes more time than its own"
# By families: ours and theirs, or theirs alone.
REASONS = {
    ("Wisdom-Holman", "WHFast"): SAME_MAP,
    ("ABA", "SABA"): SAME_MAP,
    "WHFast": LONG_STEPS,
    "SABA": LONG_STEPS,
    "WHFast512": "eight planets share an AVX-512 register there; noether computes them one by one",
}


def table(rows, metric):
    """Lines of a table, and the misses: level, ratio, ours, theirs."""
    own = [row for row in done(rows) if row["program"] == "noether"]
    other = [row for row in done(rows) if row["program"] != "noether"]
    lines = ["| error at most | noether | s | best other | s | ratio |", "|---|---|---|---|---|---|"]
    misses = []
    for level in LEVELS:
        ours, theirs = best(own, metric, level), best(other, metric, level)
        if ours is None and theirs is None:
            continue
        ratio = ours["seconds"] / theirs["seconds"] if ours and theirs else None
        if theirs and (ratio is None or ratio > SHARE):
            misses.append((level, ratio, ours, theirs))
        cells = [f"{level:.0e}"]
        for row in (ours, theirs):
            cells += [name_of(row), f"{row['seconds']:.3g}"] if row else ["none", ""]
        cells.append("" if ratio is None else f"{ratio:.2f}" if ratio <= SHARE else f"**{ratio:.2f}**")
        lines.append("| " + " | ".join(cells) + " |")
    return lines, misses


def all_data(out):
    for system in systems.SYSTEMS.values():
        path = out / f"{system.name}.csv"
        if path.exists():
            yield system, *read_data(path)


def fronts(out):
    """Lines of the section of all systems."""
    lines, missed = [], []
    for system, head, rows in all_data(out):
        lines += [f"### {system.title}", "", f"![errors against time](orbits/{system.name}.png)", ""]
        kept = done(rows)
        lines += [f"{len(kept)} runs over {head['span']}; {head['programs']}, noether's commit {head['commit']} ({head['level']}); "
                  f"{head['processor']}, one core; {head['date']}." + (f" {head['note']}." if head.get("note") else ""),
                  f"All of them: [orbits/{system.name}.csv](orbits/{system.name}.csv).", ""]
        for metric, words in METRICS:
            more, misses = table(rows, metric)
            lines += [f"Errors of {words}:", "", *more, ""]
            missed += [(system, words, *miss) for miss in misses]
    return lines, missed


def misses_table(missed):
    if not missed:
        return ["At every error from 1e-6 to 1e-14 that another program reaches, noether takes at most half its time."]
    lines = ["| system | error of | at most | ratio | against | why |", "|---|---|---|---|---|---|"]
    for system, words, level, ratio, ours, theirs in missed:
        lines.append(f"| {system.name} | {words} | {level:.0e} | {'' if ratio is None else f'{ratio:.2f}'} | {name_of(theirs)} | "
                     f"{reason(ours, theirs)} |")
    return lines


def refused(out):
    """What did not end, once for each method and message."""
    lines = ["| system | program | method | what it said |", "|---|---|---|---|"]
    for system, _, rows in all_data(out):
        seen = set()
        for row in rows:
            key = (row["program"], row["method"], row["outcome"])
            if row["outcome"] != "ok" and not row["outcome"].startswith(("left out", "not finished")) and key not in seen:
                seen.add(key)
                lines.append(f"| {system.name} | {row['program']} | {row['method']} | {row['outcome'].replace('|', '/')} |")
    return lines


def blocks(out):
    lines, missed = fronts(out)
    return {"fronts": lines, "misses": misses_table(missed), "refusals": refused(out)}


def page_path(out):
    return out.parent / "orbits.md"


def filled(text, parts):
    for name, lines in parts.items():
        begin, end = BEGIN.format(name), END.format(name)
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
    """Pictures, and the tables of the page."""
    for system, _, rows in all_data(out):
        if not done(rows):
            continue
        with tempfile.NamedTemporaryFile("w", suffix=".gp", encoding="utf-8") as script:
            script.write(plot_script(out / f"{system.name}.png", rows, system.title))
            script.flush()
            try:
                subprocess.run(["gnuplot", script.name], check=True)
            except FileNotFoundError:
                print("gnuplot is not installed: the pictures are left as they are", file=sys.stderr)
                break
    page = page_path(out)
    if page.exists():
        page.write_text(filled(page.read_text(encoding="utf-8"), blocks(out)), encoding="utf-8")


def check(out):
    """0 where the page has what the data say."""
    text = page_path(out).read_text(encoding="utf-8")
    if filled(text, blocks(out)) == text:
        return 0
    print("docs/orbits.md is not what the data of docs/orbits/*.csv say: run python3 bench/fronts.py --draw", file=sys.stderr)
    return 1
