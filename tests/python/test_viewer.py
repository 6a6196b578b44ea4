"""Runs that play: pages, and the widget around them."""

import json
import os
import re
import sys

import pytest

import noether as nt

pytest.importorskip("h5py")


def about(path):
    """What the page says of its run."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    return json.loads(re.search(r'<script id="about" type="application/json">(.*?)</script>', text, re.S).group(1)), text


@pytest.fixture(scope="module")
def eight(tmp_path_factory):
    return nt.run("figure_eight", out=tmp_path_factory.mktemp("eight"), existing="fresh")


def liquid():
    atoms = nt.Particles(nt.builders.Lattice(cells=[3, 3, 3], density=0.8, mass=1, temperature=1.5))
    sim = nt.Simulation(atoms, method="verlet", step=0.004)
    sim.add_force(nt.LennardJones(cutoff=2, cutoff_style="switch_c4", epsilon=1, sigma=1))
    return sim


def test_view_is_the_page_of_the_program(eight):
    path = nt.view(eight)
    assert path == os.path.splitext(eight.run.path)[0] + ".html"
    told, _ = about(path)
    assert "red" in json.dumps(told)
    other = os.path.join(os.path.dirname(path), "other.html")
    assert nt.view(eight.run.path, out=other) == other and os.path.exists(other)


def test_show_returns_a_page_outside_of_notebooks(eight):
    told, text = about(nt.viewer.show(eight, frames=20))
    assert "location.hash" in text
    assert about(nt.viewer.show(eight.run, frames=20))[0] == told


def test_options_are_those_of_the_address(eight):
    _, text = about(nt.viewer.page(eight, light=True, paused=True, frame=10, names=False, trails="none"))
    assert 'new URLSearchParams("#light&paused&frame=10&names=off&trails=none".slice(1))' in text
    with pytest.raises(TypeError, match="no option 'lihgt'; did you mean 'light'"):
        nt.viewer.page(eight, lihgt=True)


def test_frames_in_memory_play_too(tmp_path):
    sim = liquid()
    with pytest.raises(nt.Error, match="record_frames"):
        nt.viewer.page(sim)
    sim = liquid()
    sim.record_frames(10)
    sim.run(100)
    told, _ = about(nt.viewer.page(sim, tmp_path / "liquid.html"))
    assert "108" in json.dumps(told)


def test_names_of_bodies_stand_in_the_page():
    bodies = nt.Particles(units="solar")
    bodies.add("Sun", m=1)
    bodies.add("Juno", m=0, a=2.67, e=0.26)
    sim = nt.Simulation(bodies, method="verlet", step=5)
    sim.add_force(nt.Gravity())
    sim.record_frames(10)
    sim.run(300)
    told, _ = about(nt.viewer.page(sim))
    assert "Juno" in json.dumps(told)


def test_in_notebooks_it_is_a_widget(eight, monkeypatch):
    pytest.importorskip("anywidget")
    monkeypatch.setattr(nt.viewer, "_in_notebook", lambda: True)
    viewer = nt.viewer.show(eight, height=300, light=True)
    assert viewer.height == 300 and "#light" in viewer.page and viewer.moment == 0
    assert isinstance(viewer, nt.viewer.viewer_class())


def test_without_anywidget_it_is_a_frame_of_html(eight, monkeypatch):
    monkeypatch.setattr(nt.viewer, "_in_notebook", lambda: True)
    nt.viewer.viewer_class.cache_clear()
    monkeypatch.setitem(sys.modules, "anywidget", None)
    text = nt.viewer.show(eight, height=333)._repr_html_()
    assert text.startswith("<iframe srcdoc=") and "height:333px" in text and "<canvas" not in text


def test_files_that_cannot_be_shown_are_told(tmp_path):
    with pytest.raises(nt.FileError, match="no such file"):
        nt.viewer.page(tmp_path / "run.h5")
    sim = liquid()
    sim.record_frames(10)
    sim.run(10)
    with pytest.raises(nt.FileError, match="nowhere"):
        nt.viewer.page(sim, tmp_path / "nowhere" / "view.html")


def test_view_takes_a_simulation(tmp_path):
    sim = liquid()
    sim.record_frames(10)
    sim.run(50)
    told, _ = about(nt.view(sim, out=tmp_path / "view.html"))
    assert about(nt.view(sim))[0] == told
