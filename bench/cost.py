"""Writes docs/cost.md: the front of each scene, by `noether compare`. cost.py PROGRAM ROOT [SCENE...]"""

import json
import pathlib
import subprocess
import sys
import tempfile

# Name, scene, arguments of `compare`. A scene that is not there is left out, and said to be.
SCENES = [
    ("Outer Solar System", "examples/outer_solar_system/scene.toml", ["--until", "1000 yr"]),
    ("Kepler orbit, e = 0.9", "examples/kepler/scene.toml", []),
    ("Henon-Heiles", "examples/henon_heiles/scene.toml", ["--until", "200"]),
    ("Stiff spring pendulum", "study/suite/spring_pendulum.toml", ["--until", "50"]),
    ("Heat equation on a line", "examples/heat_line/scene.toml", []),
]

HEAD = """# What accuracy costs

The cheapest runs of some scenes, found by `noether compare`: for each error the run that no other beats in both error and
time, or in both error and evaluations. Written by `python3 bench/cost.py build/release/cli/noether .`; evaluations repeat to
the last digit, times do not. Reports with all rows, plots and orders: `noether compare SCENE`.

Splittings into Kepler arcs are ahead in evaluations, by orders of magnitude over Runge-Kutta methods and leapfrog at small
errors. In seconds they are so in places only: an arc costs more than six bodies' gravity, so that on few bodies plain splittings
are ahead at large errors and eight stages in lanes at most small ones.
"""


def compare(program, scene, arguments):
    with tempfile.TemporaryDirectory() as out:
        command = [program, "compare", str(scene), *arguments, "--json", "--out", out]
        return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def number(value, digits=1):
    return "" if value is None else f"{value:.{digits}e}"


def section(title, scene, arguments, report):
    error = report["error"]
    rows = [row for row in report["rows"] if row["pareto_time"] or row["pareto_evaluations"]]
    rows.sort(key=lambda row: -row[error + "_error_max"])
    unit = "" if report["time_unit"] == "1" else " " + report["time_unit"]
    options = " ".join(f'"{one}"' if " " in one else one for one in arguments)
    truth = report["truth"]
    good = "" if truth["error"] is None else f", good to {truth['error']:.0e}"
    lines = [
        f"## {title}",
        "",
        f"`noether compare {scene}{' ' + options if options else ''}`: {len(report['rows'])} runs over "
        f"{report['end']:.6g}{unit}; truth: {truth['name']}{good}. {report['machine']}, {report['commit']}.",
        "",
        f"| method | step or rtol | {error} error | energy error | evaluations | time [s] | front |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        setting = number(row["tolerance"], 0) if row["step"] is None else f"{row['step']:.4g}{unit}"
        fronts = [name for name in ("time", "evaluations") if row["pareto_" + name]]
        lines.append(
            f"| {row['method']} | {setting} | {number(row[error + '_error_max'])} | {number(row['energy_error_max'])} | "
            f"{row['force_evaluations']} | {row['wall_s']:.3g} | {', '.join(fronts)} |"
        )
    return lines + [""]


def main(program, root, wanted):
    text = HEAD.splitlines() + [""]
    for title, scene, arguments in SCENES:
        if wanted and scene not in wanted:
            continue
        if not (root / scene).exists():
            print(f"left out: {scene} is not there", file=sys.stderr)
            continue
        text += section(title, scene, arguments, compare(program, root / scene, arguments))
    (root / "docs/cost.md").write_text("\n".join(text).rstrip() + "\n")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:])
