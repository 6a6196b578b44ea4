"""Scenes from Python: the bits of the program, reports, studies, signals."""

import json
import os
import signal
import struct
import subprocess
import sys

import pytest

import noether as nt

# What the example's README shows; the same on every machine.
FIGURE_EIGHT = "sha256:d11e8def73cbfd5e91d3afcca2bfe7c3539c8909d637bf8338cfae50f6040f16"

# How much is run of examples that would take more than half a second.
SHORTENED = {
    "alkane_liquid": 20, "asteroid_binary": 100, "butane": 250, "chain_of_10000": 10, "cyclohexane": 50, "decane": 50, "lj_melt": 50,
    "moonlet": 40, "saturn_rings": 221,
    "oblate_saturn": 1000, "outer_solar_system": 4000, "pythagorean": 10_000, "tumbling_block": 20, "two_phase_slab": 20,
    "water_box": 20, "fene_melt": 50, "weber_pair": 500, "solar_system": 1000, "kirkwood_gaps": 1000, "trappist_1": 1000,
    "trojans_and_plutinos": 1000}
# These name parts that their own programs bring.
OWN_PARTS = [one for one in nt.examples() if "\nprogram = " in open(nt.example(one)).read()]


def digest_by_the_program(scene, *options):
    done = subprocess.run([*nt.files.program(), "run", scene, *options, "--out", "by_the_program", "--json"],
                          capture_output=True, text=True)
    return json.loads(done.stdout)["digest"]


@pytest.mark.parametrize("example", [one for one in nt.examples() if one not in OWN_PARTS])
def test_an_example_has_the_digest_of_the_program(example):
    steps = SHORTENED.get(example)
    changes = {"integrator.steps": steps} if steps else {}
    report = nt.run(example, set=changes, out="from_python")
    assert report.digest == digest_by_the_program(nt.example(example), *[f"--set={k}={v}" for k, v in changes.items()])


@pytest.mark.parametrize("example", OWN_PARTS)
def test_an_example_with_parts_of_its_own_is_refused_by_name(example):
    with pytest.raises(nt.Error, match="unknown .* the program of this scene has more parts"):
        nt.Scene(example)


def test_a_dict_is_a_scene_to_the_bit():
    tree = nt.Scene("figure_eight").tree
    assert nt.run(tree, out="a").digest == FIGURE_EIGHT


def test_changes_and_the_end_are_those_of_the_command_line():
    told = subprocess.run([*nt.files.program(), "run", nt.example("figure_eight"), "--set", "integrator.method=gauss_8",
                           "--set", "integrator.steps=100", "--out", "program", "--json"], capture_output=True, text=True)
    ours = nt.run("figure_eight", set={"integrator.method": "gauss_8", "integrator.steps": 100}, out="python")
    assert json.loads(told.stdout)["digest"] == ours.digest
    assert nt.run("figure_eight", until=1.581478495, out="until").step == 100


@pytest.mark.parametrize("changes", [{"integrator.method": "gauss_8"}, ["integrator.method=gauss_8"]])
def test_a_scene_of_a_scene_keeps_its_changes_and_its_end(changes):
    first = nt.Scene("figure_eight", set=changes, until=3)
    second = nt.Scene(first, set=["integrator.rtol=1e-9"])
    assert second.tree["integrator"]["method"] == "gauss_8" and second.tree["integrator"]["rtol"] == 1e-9
    assert second.tree["integrator"]["until"] == first.tree["integrator"]["until"]
    assert nt.Scene(first, until=2).tree["integrator"]["until"] != first.tree["integrator"]["until"]


def test_what_a_report_has():
    report = nt.run("figure_eight", out="out")
    assert report.outcome == "completed" and report.step == 4000
    assert report.monitors.energy.worst < 2e-14
    assert report.frames.positions.shape == (401, 3, 3)
    assert report.frames.names == ["red", "green", "blue"]
    energy = report.series("energy")
    assert len(energy.time) == 401 and abs(energy.relative_error).max() == report.monitors.energy.worst
    assert "completed at step 4000" in repr(report)


def test_tables():
    pandas = pytest.importorskip("pandas")
    xarray = pytest.importorskip("xarray")
    report = nt.run("figure_eight", out="out")
    table = report.to_dataframe("energy")
    assert isinstance(table, pandas.DataFrame) and list(table.index[:2]) == [0.0, 0.1581478495]
    assert "energy.total" in report.to_dataframe().columns
    frames = report.to_xarray()
    assert isinstance(frames, xarray.Dataset) and frames.position.sel(particle="red").shape == (401, 3)


def test_a_run_is_resumed():
    whole = nt.run("figure_eight", out="whole").digest
    nt.run("figure_eight", set={"integrator.steps": 1000}, out="parts")
    assert nt.run("figure_eight", out="parts", existing="resume").digest == whole


def test_studies():
    pytest.importorskip("pandas")
    comparison = nt.compare("figure_eight", methods=["verlet", "yoshida_4"], until=6.32591398, budget=1)
    assert comparison.truth.name == "gragg_bulirsch_stoer in quad"
    order = {one.method: one.order for one in comparison.orders}
    assert abs(order["verlet"] - 2) < 0.1 and abs(order["yoshida_4"] - 4) < 0.2
    assert len(comparison.rows) >= 8 and comparison.front["position_error_max"].is_monotonic_decreasing
    advice = nt.advise("figure_eight", 1e-5, methods=["verlet", "yoshida_4"])
    assert advice.method in ("verlet", "yoshida_4")
    assert nt.run("figure_eight", set=advice.sets, out="advised", until=6.32591398).ok
    limit = nt.stability({**nt.Scene("henon_heiles").tree}, methods=["verlet"], budget=2).rows
    assert limit.method[0] == "verlet" and abs(limit.theory[0] - 2) < 1e-6
    assert abs(nt.evaluate("figure_eight")["energy"]["total"] + 1.2871419917663263) < 1e-12
    assert nt.explain("figure_eight")["force_evaluations_per_step"] == 14


def test_files():
    report = nt.run("figure_eight", out="out")
    checked = nt.verify(report.files.trajectory)
    assert checked.ok and checked.digest == report.digest
    assert nt.info(report.files.trajectory).frames == 401
    nt.convert(report.files.trajectory, "frames.xyz")
    assert os.path.getsize("frames.xyz") > 10000


def test_a_flipped_bit_is_found():
    path = nt.run("figure_eight", out="out").files.trajectory
    data = bytearray(open(path, "rb").read())
    place = data.find(struct.pack("<d", nt.open_run(path).frames.positions[200, 0, 0]))
    data[place] ^= 1
    open("flipped.h5", "wb").write(data)
    assert not nt.verify("flipped.h5").ok


INTERRUPTED = """
import noether as nt, threading, os, signal, time
def interrupt():
    while not begun():
        time.sleep(0.01)
    time.sleep(0.2)
    os.kill(os.getpid(), signal.SIGINT)
def begun():
    return {}
threading.Thread(target=interrupt, daemon=True).start()
try:
    {}
except KeyboardInterrupt as stopped:
    print("interrupted", flush=True)
    {}
"""


def interrupt(run, begun, then):
    done = subprocess.run([sys.executable, "-c", INTERRUPTED.format(begun, run, then)], capture_output=True, text=True, timeout=300,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))  # where it was ignored
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_control_c_ends_a_scene_after_a_step_and_it_goes_on():
    told = interrupt("nt.run('figure_eight', set={'integrator.steps': 10**9}, out='out')", "os.path.exists('out/run.h5')",
                     "print(nt.info('out/checkpoint.h5').last_step)")
    assert told[0] == "interrupted" and int(told[1]) > 0
    end = int(told[1]) + 10
    resumed = nt.run("figure_eight", set={"integrator.steps": end}, out="out", existing="resume")
    assert resumed.ok and resumed.resumed_from_step == int(told[1]) and resumed.step == end


BODIES = """bodies = nt.Particles(); bodies.add(m=1, x=[0, 0, 0], v=[0, 0, 0]); bodies.add(m=1e-3, a=1, e=0.1)
    sim = nt.Simulation(bodies, method="verlet", step=1e-3); sim.add_force(nt.Gravity())
    sim.run(10**11)"""


def test_control_c_ends_a_simulation_which_goes_on():
    told = interrupt(BODIES, "'sim' in globals() and sim._held and sim._held.step > 0",
                     "step = sim.step; sim.run(1); print(step > 0 and sim.step == step + 1)")
    assert told == ["interrupted", "True"]


def test_runs_in_threads_have_the_bits_of_runs_one_by_one():
    from concurrent.futures import ThreadPoolExecutor

    def one(k):
        return nt.run("figure_eight", set={"integrator.step": 0.01 + 0.001 * k, "integrator.steps": 300}, out=f"out{k}", existing="fresh").digest

    alone = [one(k) for k in range(8)]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(one, range(8, 16)))
    assert len(set(alone)) == 8
    assert together == [one(k) for k in range(8, 16)]
