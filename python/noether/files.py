"""Files that runs leave, by the program itself: verify, convert, info, view."""

import json
import os
import subprocess
import sys

from . import _core


def program():
    """The path of the program `noether` that belongs to this package."""
    here = os.path.dirname(os.path.abspath(__file__))
    for path in (os.environ.get("NOETHER_PROGRAM", ""), os.path.join(here, "bin", "noether"),
                 os.path.join(here, "..", "..", "cli", "noether")):
        if path and os.access(path, os.X_OK):
            return os.path.realpath(path)
    raise FileNotFoundError("the program noether is not in this package; it was built without it")


def main():
    """The command `noether` of an installed package."""
    path = program()
    os.execv(path, ["noether", *sys.argv[1:]])


_ERRORS = {2: _core.Error, 3: _core.FileError}


def _ask(*arguments):
    """What the program prints as JSON. @raise Error or FileError with its message"""
    done = subprocess.run([program(), *[os.fspath(one) for one in arguments], "--json"], capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    told = json.loads(lines[-1]) if lines else {}
    if lines and told["schema"] != "noether.error/1":
        return told, done.returncode
    message = done.stderr.strip() or f"noether {arguments[0]} ended with code {done.returncode}"
    if "message" in told:
        message = ": ".join(str(one) for one in (told["file"], told["message"]) if one)
    raise _ERRORS.get(done.returncode, RuntimeError)(message)


def verify(run, *, against=None, repair=False):
    """Whether every number of a run.h5 is as it was written: a dict; with `against`, where two runs differ first."""
    from .reports import _figures

    options = (["--against", against] if against is not None else []) + (["--repair"] if repair else [])
    told, code = _ask("verify", run, *options)
    return _figures({**told, "ok": code == 0})


def info(file):
    """What is in a file: run.h5, a checkpoint, bodies or a structure."""
    from .reports import _figures

    return _figures(_ask("info", file)[0])


def convert(file, out, **options):
    """Converts a run to another format, by the ending of `out`: .xyz, .csv, .vtu, ...; options as of `noether convert`."""
    from .reports import _figures

    given = []
    for key, value in options.items():
        given += ["--" + key.replace("_", "-")] + ([] if value is True else [str(value)])
    return _figures(_ask("convert", file, out, *given)[0])


def view(run, out=None):
    """A page that plays a run in a browser: the path of the page, which is beside the run unless `out` says where.

    run : a Report, a RunFile, or the path of a run.h5; of a Simulation the page goes to a temporary folder unless told. In a
        notebook use `nt.viewer.show`.
    """
    from .reports import Report, RunFile

    if hasattr(run, "record_frames"):
        from .viewer import page

        return page(run, out)
    if isinstance(run, Report):
        run = run.run
    told, _ = _ask("view", run.path if isinstance(run, RunFile) else run, *(["--out", out] if out is not None else []))
    return told["file"]
