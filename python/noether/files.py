"""Files that runs leave, by the program itself: verify, convert, info, view."""

import json
import os
import signal
import subprocess
import sys

from . import _core


def program():
    """The words that start the program `noether`: that of this package, or the one that NOETHER_PROGRAM names.

    The program is in the package's module, which a Python of its own becomes. It takes 0.1 s to start.
    @raise FileNotFoundError if NOETHER_PROGRAM names no program
    """
    given = os.environ.get("NOETHER_PROGRAM")
    if given:
        if os.access(given, os.X_OK):
            return [given]
        raise FileNotFoundError(f"NOETHER_PROGRAM is {given!r}, which is no program")
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    start = f"import sys; sys.path.append({root!r}); from noether.files import main; main()"
    return [sys.executable, "-I", "-c", start]  # -I: no folder of the user's is searched before this package


def main():
    """The command `noether` of an installed package: the program, with the arguments of this process."""
    # As programs start. Python holds an interrupt back until its own code runs on, and makes errors of closed pipes.
    for number in (signal.SIGINT, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)
    sys.exit(_core.program(["noether", *sys.argv[1:]]))


_ERRORS = {2: _core.Error, 3: _core.FileError}


def _ask(*arguments):
    """What the program prints as JSON, and its exit code. Ctrl-C ends the program as it ends by itself: by its first signal, with
    what it has done kept. @raise Error or FileError with its message"""
    command = [*program(), *[os.fspath(one) for one in arguments], "--json"]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as asked:
        try:
            out, said = asked.communicate()
        except KeyboardInterrupt:
            try:
                asked.wait(0.3)  # a terminal has told it too
            except subprocess.TimeoutExpired:
                asked.send_signal(signal.SIGINT)
            asked.communicate()
            raise
    lines = [line for line in out.splitlines() if line.startswith("{")]
    told = json.loads(lines[-1]) if lines else {}
    if lines and told["schema"] != "noether.error/1":
        return told, asked.returncode
    message = said.strip() or f"noether {arguments[0]} ended with code {asked.returncode}"
    if "message" in told:
        message = ": ".join(str(one) for one in (told["file"], told["message"]) if one)
    raise _ERRORS.get(asked.returncode, RuntimeError)(message)


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
