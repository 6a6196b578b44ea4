"""Runs of noether for the error fronts."""

import json
import pathlib
import subprocess
import tempfile
import time

import numpy

from orbits import systems

ADAPTIVE_LOOKS = 10  # looks from one sample to the next, where the method chooses its steps

SCENE = """units = "solar"
{every}
[particles]
bodies = "{table}"

[hamiltonian]
type = "{hamiltonian}"
G = {G!r}
{more}
[integrator]
method = "{method}"
until = "{end} day"
{keys}
"""

FRAMES = '[[every]]\ntype = "energy"\n{cadence}\n\n[[every]]\ntype = "trajectory"\n{cadence}\n'


class Failed(Exception):
    """A run that did not reach its end; the text says why."""


def scene_text(system, method, samples, watched):
    """A method: a dict of `method`, `hamiltonian`, `step` [day] or nothing, and `keys` of [integrator]; `coordinates`."""
    keys = dict(method.get("keys", {}))
    cadence = f'every = "{system.sample / ADAPTIVE_LOOKS!r} day"'
    if "divisions" in method:
        keys["step"] = f"{system.sample / method['divisions']!r} day"
        cadence = f"steps = {method['divisions'] // systems.looks_of(method['divisions'])}"
    more = f'coordinates = "{method["coordinates"]}"\n' if "coordinates" in method else ""
    if method["hamiltonian"] == "kinetic_potential":
        more += '\n[[hamiltonian.force]]\ntype = "gravity"\n'
    return SCENE.format(every="" if watched else "every = []", table=system.table, hamiltonian=method["hamiltonian"],
                        G=system.G, more=more, method=method["method"], end=system.end(samples),
                        keys="\n".join(f"{key} = {json.dumps(value)}" for key, value in keys.items())) + (
                            FRAMES.format(cadence=cadence) if watched else "")


class Program:
    """noether, one thread."""

    def __init__(self, path):
        self.path = str(pathlib.Path(path).resolve())
        words = self.call(["version"])[0].split()
        self.version, self.commit, self.level = words[1], words[3], words[words.index("level") + 1]
        self.build = f"{self.level}, chosen at its start"

    def call(self, arguments, timeout=600):
        """Standard output and standard error."""
        child = subprocess.Popen([self.path, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            text, errors = child.communicate(timeout=timeout)
        except subprocess.TimeoutExpired as late:
            child.kill()
            child.communicate()
            raise Failed(f"not finished after {timeout:.0f} s") from late
        if child.returncode != 0 and not text.startswith("{"):
            raise Failed(errors.strip().splitlines()[-1] if errors.strip() else f"exit code {child.returncode}")
        return text, errors

    def run(self, system, method, samples, watched, timeout):
        """The report of the run, seconds, and the states of its looks (nothing without `watched`)."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            scene = folder / "scene.toml"
            end = time.monotonic() + timeout
            scene.write_text(scene_text(system, method, samples, watched), encoding="utf-8")
            text, _ = self.call(["run", str(scene), "--json", "--threads", "1", "--out", str(folder / "out")], timeout)
            report = json.loads(text)
            if report["exit_code"] != 0:
                raise Failed(": ".join(report[key] for key in ("outcome", "message") if key in report))
            seconds = report["wall_s"]  # of the steps alone, as that of the other programs
            if not watched:
                return report, seconds, None
            self.call(["convert", str(folder / "out" / "run.h5"), str(folder / "run.csv")],
                      max(0.0, end - time.monotonic()))
            columns = numpy.loadtxt(folder / "run.csv", delimiter=",", skiprows=1, usecols=range(4, 10), ndmin=2)
            return report, seconds, columns.reshape(-1, len(system.bodies), 6)
