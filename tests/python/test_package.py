"""What `pip install` brings: the module, the program, the scenes of the suite and of the examples."""

import errno
import os
import signal
import subprocess
import sys
import time

import pytest

import noether as nt
from noether import files


def run(*arguments, **settings):
    return subprocess.run([sys.executable, "-B", *arguments], capture_output=True, text=True, timeout=60, **settings)


@pytest.fixture
def program(monkeypatch):
    """The program as a wheel has it, whatever program the tests are run with."""
    monkeypatch.delenv("NOETHER_PROGRAM", raising=False)
    return lambda *words, **settings: subprocess.run([*files.program(), *words], capture_output=True, text=True, timeout=120,
                                                     **settings)


def test_the_program_is_of_the_same_version(program):
    told = program("--version")
    assert told.returncode == 0
    assert told.stdout.split()[:2] == ["noether", nt.__version__]


def test_the_command_is_the_program_with_its_exit_codes_and_signals(program, tmp_path):
    wrong = program("rnu")
    assert wrong.returncode == 2
    assert "unknown command 'rnu'; did you mean 'run'?" in wrong.stderr
    assert program("run", "nowhere.toml", cwd=tmp_path).returncode == 3


def test_a_reader_that_has_seen_enough_ends_the_command_silently(program):
    pipe = '"$@" describe --all | head -n 1; echo "${PIPESTATUS[0]}"'
    told = subprocess.run(["bash", "-c", pipe, "-", *files.program()], capture_output=True, text=True, timeout=60)
    assert told.stderr == ""
    assert int(told.stdout.splitlines()[-1]) in (0, 128 + signal.SIGPIPE)  # 0: the pipe held all of it


def writing_end(fifo, reader, seconds=60):
    """The writing end of a FIFO, once a program has opened the other one; None if it ended, or has not after these seconds."""
    limit = time.monotonic() + seconds
    while reader.poll() is None and time.monotonic() < limit:
        try:
            return os.open(fifo, os.O_WRONLY | os.O_NONBLOCK)
        except OSError as wrong:
            if wrong.errno != errno.ENXIO:  # ENXIO: nobody reads it yet
                raise
            time.sleep(0.01)
    return None


def test_an_interrupt_ends_a_command_that_has_no_way_of_its_own_to_end(program, tmp_path):
    scene = tmp_path / "scene.toml"
    os.mkfifo(scene)
    with subprocess.Popen([*files.program(), "explain", scene], stderr=subprocess.PIPE, cwd=tmp_path) as running:
        try:
            end = writing_end(scene, running)
            assert end is not None, "the program did not read its scene"
            running.send_signal(signal.SIGINT)
            assert running.wait(timeout=60) == -signal.SIGINT  # it waited for what is to be written
            os.close(end)
        finally:
            running.kill()
        assert running.stderr.read() == b""


def test_the_program_and_the_function_end_in_the_same_bits(program, tmp_path):
    told = program("run", nt.example("figure_eight"), "--until", "1", "--out", str(tmp_path / "out"))
    assert told.returncode == 0, told.stderr
    report = nt.run(nt.example("figure_eight"), until="1")
    assert told.stdout.splitlines()[-1] == report.digest


def test_a_program_that_is_not_there_is_refused(monkeypatch):
    monkeypatch.setenv("NOETHER_PROGRAM", "/nowhere/noether")
    with pytest.raises(FileNotFoundError, match="NOETHER_PROGRAM is '/nowhere/noether'"):
        files.program()


def test_the_scenes_of_the_suite_are_found():
    assert os.path.exists(os.path.join(nt._core.suite_folder(), "kepler.toml"))


def test_every_example_has_what_its_scene_reads():
    names = nt.examples()
    assert {"figure_eight", "outer_solar_system", "butane", "rigid_water"} <= set(names)
    for name in set(names) - {"bead_on_wire", "beads_on_sphere", "oblate_saturn"}:  # these need programs of their own
        nt.Scene(nt.example(name))  # or raises what is wrong with it


def test_an_example_that_is_not_there_is_refused_by_name():
    with pytest.raises(FileNotFoundError, match="no example 'figure_eigth'.*figure_eight"):
        nt.example("figure_eigth")


def test_import_loads_nothing_that_is_slow():
    slow = {"h5py", "matplotlib", "pandas", "xarray", "astropy", "numba", "pint", "subprocess"}
    loaded = run("-c", "import sys, noether; print(*sorted(sys.modules))").stdout.split()
    assert "noether._core" in loaded
    assert not slow & set(loaded)


def test_threads_wait_passively_unless_told_otherwise():
    code = "import os, noether; print(os.environ['OMP_WAIT_POLICY'])"
    settings = {key: value for key, value in os.environ.items() if key != "OMP_WAIT_POLICY"}
    assert run("-c", code, env=settings).stdout == "passive\n"
    assert run("-c", code, env={**settings, "OMP_WAIT_POLICY": "active"}).stdout == "active\n"
