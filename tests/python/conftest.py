"""What all tests of the Python package share."""

import os
import pathlib

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
NIGHTLY = bool(os.environ.get("NOETHER_NIGHTLY"))

nightly = pytest.mark.skipif(not NIGHTLY, reason="nightly: set NOETHER_NIGHTLY=1")


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path, monkeypatch):
    """Runs write where the test stands."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def two_bodies():
    import noether as nt

    bodies = nt.Particles()
    bodies.add("star", m=0.75, x=[0, 0, 0], v=[0, 0, 0])
    bodies.add("planet", m=0.25, x=[1, 0, 0], v=[0, 1, 0])
    return bodies
