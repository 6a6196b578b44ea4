"""What `pip install` brings: the module, the program, the scenes of the suite and of the examples."""

import os
import subprocess
import sys

import pytest

import noether as nt
from noether import files


def run(*arguments, **settings):
    return subprocess.run([sys.executable, "-B", *arguments], capture_output=True, text=True, timeout=60, **settings)


def test_the_program_is_of_the_same_version():
    told = subprocess.run([files.program(), "--version"], capture_output=True, text=True, timeout=60)
    assert told.returncode == 0
    assert told.stdout.split()[:2] == ["noether", nt.__version__]


def test_the_command_becomes_the_program_and_keeps_its_exit_code():
    command = ["-c", "import sys; from noether.files import main; sys.argv[0] = 'noether'; main()"]
    assert run(*command, "--version").stdout == run(*command, "--version").stdout != ""
    wrong = run(*command, "rnu")
    assert wrong.returncode == 2
    assert "rnu" in wrong.stderr


def test_every_example_has_what_its_scene_reads():
    names = nt.examples()
    assert {"figure_eight", "outer_solar_system", "butane", "rigid_water"} <= set(names)
    for name in names:
        told = subprocess.run([files.program(), "explain", nt.example(name), "--json"], capture_output=True, text=True,
                              timeout=120)
        assert told.returncode == 0, f"{name}: {told.stderr}"


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
