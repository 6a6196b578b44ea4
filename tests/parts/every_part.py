"""Every part works in every command, or docs/parts.md says that it is refused and why.

    every_part.py PROGRAM SOURCE_DIR [--write]

The program tells its parts, `scenes.py` has a short scene for each. What comes of every command over it is the page
docs/parts.md: the test fails where they differ, and `--write` writes it anew. A part without a scene, a crash, an exit
code other than 0 and 2, other bits, and a refusal without a reason fail it too, with the part and the command.
"""

import argparse
import concurrent.futures
import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap

import scenes

TIMEOUT = 120      # seconds of one command, which takes some hundredths of one
COLUMNS = 120      # of the page
HALF = 31          # steps before a restart: at no moment of any watcher
LONGER = 200       # steps in comparisons, which look at 200 moments
FLOW_STEPS = 20    # of a method that chooses its steps

# Kinds of parts that `explain` does not name.
UNTOLD = {"builders", "solvers"}

# What a row says, in this order; the first is the part's name.
HEADS = {"run": "run", "threads": "threads, cadences", "restart": "restart", "flow": "y' = f", "truth": "truth",
         "stability": "stability", "shadow": "shadow", "advise": "advise", "evaluate": "evaluate"}

INTRODUCTION = """\
# Parts, walked through every command

Written by `python3 tests/parts/every_part.py build/cli/noether . --write`; the test `parts.every_part` walks the parts
that `noether list` names again and fails where one differs from this page. Each has a short scene in
`tests/parts/scenes.py`. A number stands where the program refuses, with exit code 2, and leads to its message below,
with NAME in the place of the part's own, and N in the place of seconds that it measured.

- **run**: the run itself, and `explain`, `info`, `verify`, `convert`, `plot` and `view` of it.
- **threads, cadences**: the same bits, by digest, with two threads, and with other cadences of whatever looks on.
- **restart**: the same bits, and the same reports of monitors, after a stop half way and `--resume`.
- **y' = f**: the same forces under a method that chooses its steps (`dop853`; `bdf` where the system is stiff), with
  the same bits after a restart.
- **truth**: what `compare` measures errors against: a reference in 113 bits, the finest of the runs compared, or none.
- **stability**, **advise**, **evaluate**: the commands of these names, `evaluate` with `--check`.
- **shadow**: a run under the eyes of `shadow_hamiltonian`, with the same bits.

Methods are parts too: [methods.md](methods.md) measures each of them.
"""


class Fault(Exception):
    """What no command may do."""


class Refusal(Exception):
    """The program's reason for not doing what it is asked."""


class Program:
    """The commands of the program, run in one folder."""

    def __init__(self, path, folder):
        self.path, self.folder = str(path), folder

    def __call__(self, *arguments):
        """The report of a command. Raises Refusal or Fault where there is none."""
        shown = "noether " + " ".join(arguments)
        environment = dict(os.environ, OMP_NUM_THREADS="1")
        try:
            done = subprocess.run([self.path, *arguments], cwd=self.folder, env=environment, capture_output=True,
                                  text=True, timeout=TIMEOUT)
        except subprocess.TimeoutExpired:
            raise Fault(f"`{shown}` takes more than {TIMEOUT} seconds") from None
        said = done.stderr.strip()
        if done.returncode == 0:
            return report_of(done.stdout, shown)
        if done.returncode != 2:
            raise Fault(f"`{shown}` ends with {done.returncode}: {said or 'without a message'}")
        if "\n" in said or not said:
            raise Fault(f"`{shown}` refuses in {len(said.splitlines())} lines instead of one: {said}")
        message = report_of(done.stdout, shown)["message"] if "--json" in arguments else said
        if len(message.split()) < 4 or "LogicError" in message:
            raise Fault(f"`{shown}` refuses without a reason: '{message}'")
        raise Refusal(message)


def report_of(text, shown):
    """JSON where a command wrote it, else the text."""
    if "--json" not in shown:
        return text
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        raise Fault(f"`{shown}` writes what is no JSON: {text[:200]!r}") from None


def expect(holds, message):
    if not holds:
        raise Fault(message)


def scene_text(case, cadences, method=None, steps=scenes.STEPS):
    """The scene with watchers at these cadences; `method` is one that chooses its steps."""
    look, frame, save = cadences
    text = f'units = "{case.units}"\n' + case.place + case.motion
    if method:
        text += f'[integrator]\nmethod = "{method}"\nrtol = 1e-6\nsteps = {steps}\n'
    else:
        text += f'[integrator]\nmethod = "{case.method}"\nstep = {json.dumps(case.time())}\nsteps = {steps}\n'
    text += case.around
    watched = [("energy", look)] if case.energy else []
    watched += [("trajectory", frame), ("checkpoint", save)]
    for kind, cadence in watched:
        text += f'[[every]]\ntype = "{kind}"\nsteps = {cadence}\n'
    return text + case.watch.replace("{cadence}", str(look)) + case.stop


class Walk:
    """One part in all commands; each column's function returns what its cell says."""

    def __init__(self, program, kind, name, folder):
        self.kind, self.name, self.case = kind, name, scenes.KINDS[kind][0][name]
        case = self.case
        self.program = Program(program, folder)
        for file, text in case.files.items():
            (folder / file).write_bytes(text if isinstance(text, bytes) else text.encode())
        self.scene = scene_text(case, (3, 10, 50))
        for file, text in [("scene.toml", self.scene), ("other.toml", scene_text(case, (7, 4, 23))),
                           ("flow.toml", scene_text(case, (3, 10, 15), case.flow, FLOW_STEPS)),
                           ("watched.toml", self.scene + '[[every]]\ntype = "shadow_hamiltonian"\nsteps = 1\n')]:
            (folder / file).write_text(text)
        self.whole = None

    def run_once(self, scene, out, *more):
        return self.program("run", scene, "--out", out, "--json", *more)

    def run(self):
        self.whole = self.run_once("scene.toml", "whole", "--threads", "1")
        ended = "stopped" if self.case.stop else "completed"
        expect(self.whole["outcome"] == ended, f"`run` ends as {self.whole['outcome']}, not as {ended}")
        explained = self.program("explain", "scene.toml", "--json")
        uses = [explained["hamiltonian"], *(part.split(",")[0].split()[-1] for part in explained["parts"])]
        expect(self.name in uses or self.kind in UNTOLD, "`explain` does not tell of it")
        told = self.program("info", "whole/run.h5", "--json")
        expect(told["complete"] and told["frames"] > 1, "`info` finds no whole trajectory")
        told = self.program("info", "whole/checkpoint.h5", "--json")
        expect(told["digest"] == self.whole["digest"], "`info` tells other bits than `run`")
        self.program("verify", "whole/run.h5", "--json")
        self.program("verify", "whole/checkpoint.h5", "--json")
        self.program("convert", "whole/run.h5", "run.csv", "--json")
        if self.case.particles:
            self.program("convert", "whole/run.h5", "run.xyz", "--json")
            self.program("view", "whole/run.h5", "--out", "run.html", "--json")
        if shutil.which("gnuplot"):
            self.program("plot", "whole/run.h5", "--out", "run.svg", "--json")
        return "yes"

    def threads(self):
        for scene in ("scene.toml", "other.toml"):
            again = self.run_once(scene, "again", "--threads", "2", "--fresh")
            expect(again["threads"] == 2, f"`--threads 2` gives {again['threads']}")
            expect(again["digest"] == self.whole["digest"], f"{scene} with 2 threads ends in other bits")
        return "yes"

    def restart(self):
        end = str(self.case.time(HALF))
        part = self.run_once("scene.toml", "half", "--until", end, "--threads", "1")
        expect(part["step"] == HALF, f"a run until {end} ends at step {part['step']} instead of {HALF}")
        rest = self.run_once("scene.toml", "half", "--resume", "--threads", "2")
        expect(rest["resumed_from_step"] == HALF, f"a run goes on from step {rest['resumed_from_step']}")
        self.same(rest, self.whole)
        return "yes"

    def same(self, rest, whole):
        expect(rest["digest"] == whole["digest"], "a run that was restarted ends in other bits")
        for monitor, told in whole["monitors"].items():
            expect(rest["monitors"][monitor] == told,
                   f"monitor '{monitor}' of a run that was restarted tells {rest['monitors'][monitor]}, not {told}")

    def flow(self):
        whole = self.run_once("flow.toml", "flow", "--threads", "1")
        expect(whole["outcome"] in ("completed", "stopped"), f"{self.case.flow} ends as {whole['outcome']}")
        self.run_once("flow.toml", "flow_half", "--set", f"integrator.steps={FLOW_STEPS // 2}")
        self.same(self.run_once("flow.toml", "flow_half", "--resume", "--threads", "2"), whole)
        return "yes"

    def study(self, command, methods, *more):
        return self.program(command, "scene.toml", "--methods", ",".join(methods), "--json", *more)

    def truth(self):
        case = self.case
        found = self.study("compare", case.rivals, "--steps", f"{case.time()},{case.time(0.5)}", "--until",
                           str(case.time(LONGER)), "--repeat", "1", "--out", "compared")
        expect(len(found["rows"]) == 2 * len(case.rivals), f"`compare` has {len(found['rows'])} rows")
        for row in found["rows"]:
            expect(row["outcome"] == "completed", f"`compare` runs {row['method']} to {row['outcome']}")
        truth = found["truth"]
        if not truth["name"].endswith("in quad"):
            reason = truth["note"].split("; errors are")[0]
            return truth["name"], re.sub(r"\b\d+ s\b", "N s", reason)
        for what in ("position_error_max", "energy_error_max"):
            errors = [row[what] for row in found["rows"] if row[what] is not None]
            expect(not errors or min(errors) < 0.1,
                   f"beside a truth of 113 bits the least {what} of `compare` is {min(errors, default=0):.2g}")
        return "113 bits"

    def stability(self):
        found = self.study("stability", self.case.rivals[:1], "--steps", "1000", "--budget", "0.1")
        expect(len(found["rows"]) == 1, "`stability` has no row")
        return "yes"

    def shadow(self):
        watched = self.run_once("watched.toml", "watched")
        expect(watched["digest"] == self.whole["digest"], "a run under the shadow ends in other bits")
        return "yes"

    def advise(self):
        found = self.study("advise", self.case.rivals, "--error", "0.01", "--budget", "1",
                           "--set", f"integrator.steps={LONGER}")
        expect(found["method"] in self.case.rivals, f"`advise` proposes {found['method']}: {found['reason']}")
        return "yes"

    def evaluate(self):
        found = self.program("evaluate", "scene.toml", "--check", "--json")
        error = found["gradient_error"]
        expect(error is None or error < 1e-6, f"`evaluate --check` finds forces wrong by {error}")
        return "yes"


def row_of(program, kind, name):
    """The cells of a row, (word, reason) each, and what is wrong with it."""
    cells, faults = {}, []
    with tempfile.TemporaryDirectory(prefix="every_part.") as folder:
        walk = Walk(program, kind, name, pathlib.Path(folder))
        for column in HEADS:
            if column != "run" and walk.whole is None:
                break
            try:
                told = getattr(walk, column)()
                cells[column] = told if isinstance(told, tuple) else (told, None)
            except Refusal as refusal:
                cells[column] = (None, str(refusal).replace(f"'{name}'", "'NAME'"))
            except Fault as fault:
                faults.append(f"{column}: {fault}")
                cells[column] = ("FAULT", None)
            except (KeyError, TypeError) as error:
                faults.append(f"{column}: a report is not as expected: {error!r}")
                cells[column] = ("FAULT", None)
    return cells, faults


def listed(program, what):
    return [item["name"] for item in program("list", what, "--json")["items"]]


def known_after(program, *arguments):
    """Names that the program gives where it is asked for one that is none."""
    try:
        program(*arguments)
    except Refusal as refusal:
        return str(refusal).partition("expected one of: ")[2].split(", ")
    raise Fault(f"`noether {' '.join(arguments)}` is not refused")


def known_instead(program, case, name):
    """Names that the program gives where a scene has another word in the place of `name`."""
    changed = dataclasses.replace(case, motion=case.motion.replace(f"'{name}'", "'nothing'"))
    (program.folder / "asked.toml").write_text(scene_text(changed, (3, 10, 50)))
    return known_after(program, "explain", "asked.toml")


def lists(program):
    """Every list of parts, as the program tells it; solvers have none, but messages name them."""
    names = [what for what in known_after(program, "list", "nothing") if what not in scenes.OTHER_LISTS]
    return {"solvers": known_instead(program, scenes.SOLVERS["newton"], "newton"),
            **{what: listed(program, what) for what in names}}


def missing(parts):
    """Parts without a scene, and scenes without a part."""
    for kind, names in parts.items():
        if kind not in scenes.KINDS:
            yield f"`noether list {kind}` is a list that tests/parts/scenes.py does not know"
            continue
        cases = scenes.KINDS[kind][0]
        for name in names:
            if name not in cases:
                yield f"{name}: it has no scene in tests/parts/scenes.py"
        for name in cases:
            if name not in names:
                yield f"{name}: tests/parts/scenes.py has a scene for what is not in the list of {kind}"


def page_of(tables):
    """The page: {kind: {name: cells}} in the order of the lists."""
    notes = []

    def cell(entry):
        if entry is None:
            return "-"
        word, reason = entry
        if reason is None:
            return word
        if reason not in notes:
            notes.append(reason)
        return f"{word or ''} [{notes.index(reason) + 1}]".lstrip()

    text = INTRODUCTION
    for kind, (_, title) in scenes.KINDS.items():
        if not tables.get(kind):
            continue
        text += f"\n## {title}\n\n| part | {' | '.join(HEADS.values())} |\n|{'---|' * (len(HEADS) + 1)}\n"
        for name, cells in tables[kind].items():
            text += f"| {name} | {' | '.join(cell(cells.get(column)) for column in HEADS)} |\n"
    text += "\n## What is refused, and why\n\n"
    for number, note in enumerate(notes, 1):
        text += textwrap.fill(note, COLUMNS, initial_indent=f"- [{number}] ", subsequent_indent="  ",
                              break_long_words=False, break_on_hyphens=False) + "\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("source_dir", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="write docs/parts.md anew")
    parser.add_argument("--only", help="one part: its row is printed")
    given = parser.parse_args()

    with tempfile.TemporaryDirectory(prefix="every_part.") as folder:
        parts = lists(Program(given.program, pathlib.Path(folder)))
    problems = list(missing(parts))
    order = [(kind, name) for kind in scenes.KINDS for name in parts.get(kind, []) if name in scenes.KINDS[kind][0]]
    if given.only:
        order = [(kind, name) for kind, name in order if name == given.only]
    tables = {}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        rows = pool.map(lambda part: row_of(given.program, *part), order)
        for (kind, name), (cells, faults) in zip(order, rows):
            tables.setdefault(kind, {})[name] = cells
            problems += [f"{name}: {fault}" for fault in faults]

    page, path = page_of(tables), given.source_dir / "docs/parts.md"
    if given.only:
        print(page[len(INTRODUCTION):])
    elif given.write:
        path.write_text(page)
    elif not path.exists() or path.read_text() != page:
        problems.append("docs/parts.md is not what the program does; after a look at what has changed, write it by\n"
                        "    python3 tests/parts/every_part.py build/cli/noether . --write")
    for problem in problems:
        print(problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
