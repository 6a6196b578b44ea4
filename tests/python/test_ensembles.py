"""Ensembles: the same table by the program and by any map, read as it was written, and drawn."""

import concurrent.futures
import os
import pathlib
import runpy
import shutil
import subprocess
import sys

import numpy
import pytest

import noether as nt
from conftest import nightly

pytest.importorskip("h5py")
pytest.importorskip("xarray")

SCENE = """units = "solar"
[particles]
frame = "barycenter"
[[particles.body]]
name = "Sun"
mass = "1 Msun"
x = ["0 au", "0 au", "0 au"]
v = ["0 au/day", "0 au/day", "0 au/day"]
[[particles.body]]
name = "b"
mass = "1e-3 Msun"
a = "1 au"
e = 0.05
[[particles.body]]
name = "c"
mass = "1e-3 Msun"
a = "1.7 au"
e = 0.05
M = "80 deg"
[hamiltonian]
type = "wisdom_holman"
[integrator]
method = "verlet_aba"
step = "6 day"
steps = 50
[[every]]
type = "energy"
steps = 10
[[every]]
type = "elements"
steps = 25
[[every]]
type = "resonance_angle"
bodies = ["b", "c"]
steps = 5
[[stop]]
type = "escape"
distance = "2.4 au"
steps = 10
"""
# Of 18 members 6 have an eccentricity beyond 1, and are refused.
VARY = {"particles.body.c.a": ("1.2 au", "1.8 au", 6), "particles.body.c.e": (0, 1.2, 3)}


@pytest.fixture
def scene(tmp_path):
    (tmp_path / "planets.toml").write_text(SCENE)
    return "planets.toml"


@pytest.fixture
def whole(scene):
    """The table of one process, and the bytes of its file."""
    table = nt.ensemble(scene, VARY, out="whole.h5")
    return table, open("whole.h5", "rb").read()


def check_same(whole, table):
    assert (table["digest"] == whole[0]["digest"]).all()
    assert open(table.attrs["file"], "rb").read() == whole[1]
    assert not [one for one in os.listdir(os.path.dirname(table.attrs["file"])) if "-of-" in one]


def test_grids_are_dimensions_and_members_are_their_runs(scene, whole):
    table = whole[0]
    assert dict(table.sizes) == {"particles.body.c.a": 6, "particles.body.c.e": 3, "body": 3, "axis": 3,
                                 "elements_value_column": 6}
    assert table["particles.body.c.a"].values[[0, -1]] == pytest.approx([1.2, 1.8], rel=0, abs=0)
    assert table["particles.body.c.a"].attrs["units"] == table["position"].attrs["units"] == "au"
    assert table["energy_kinetic"].dims == ("particles.body.c.a", "particles.body.c.e")
    one = table.sel({"particles.body.c.a": 1.2, "particles.body.c.e": 0.6})
    report = nt.run(scene, set={"particles.body.c.a": "1.2 au", "particles.body.c.e": 0.6}, out="one")
    assert one["outcome"] == report.outcome == "completed"
    assert float(one["energy_worst"]) == pytest.approx(report.monitors["energy"].worst, rel=1e-6)
    value = one["elements_value"].sel(body="c", elements_value_column="a")
    assert float(value) == pytest.approx(report.series("elements").value[-1][2][0], rel=1e-12)
    assert (table["outcome"].sel({"particles.body.c.e": 1.2}) == "refused").all()
    assert table.attrs["outcome_refused"] == 6


def test_draws_are_members_with_their_values(scene):
    table = nt.ensemble(scene, {"particles.body.c.M": "uniform(0,360)"}, members=5, seed=3)
    assert table.attrs["file"] == os.path.abspath("planets.ensemble.h5")
    assert table["outcome"].dims == ("member",) and list(table["member"]) == [0, 1, 2, 3, 4]
    drawn = table["particles.body.c.M"]
    assert drawn.dims == ("member",) and drawn.attrs["units"] == "deg" and len(numpy.unique(drawn)) == 5
    both = nt.ensemble(scene, ["particles.body.c.a=1.2:1.8:2", "particles.body.c.M=uniform(0,360)"], members=3, out="both.h5")
    assert both["particles.body.c.M"].dims == both["digest"].dims == ("particles.body.c.a", "member")
    shape = both["position"].shape
    assert shape == (2, 3, 3, 3)


def test_a_member_has_the_digest_of_its_state(scene):
    # An adaptive method goes member by member, with the bits of a run.
    tree = nt.Scene(scene).tree
    tree["hamiltonian"] = {"type": "kinetic_potential", "force": [{"type": "gravity"}]}
    tree["integrator"] = {"method": "gauss_radau_15", "until": "100 day"}
    table = nt.ensemble(tree, {"particles.body.c.a": ("1.5 au", "1.8 au", 2)})
    tree["particles"]["body"][2]["a"] = "1.8 au"
    assert "sha256:" + str(table["digest"].values[1]) == nt.run(tree, out="one").digest
    assert os.listdir(".").count("scene.ensemble.h5.scene.toml") == 0


def test_any_map_makes_the_same_file(scene, whole):
    check_same(whole, nt.ensemble(scene, VARY, out="serial.h5", map=map, shards=3))
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        check_same(whole, nt.ensemble(scene, VARY, out="threads.h5", map=pool.map, shards=5))
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        check_same(whole, nt.ensemble(scene, VARY, out="processes.h5", map=pool.map))


def test_joblib_makes_the_same_file(scene, whole):
    joblib = pytest.importorskip("joblib")

    def by_joblib(make, shards):
        return joblib.Parallel(n_jobs=2)(joblib.delayed(make)(one) for one in shards)

    check_same(whole, nt.ensemble(scene, VARY, out="map.h5", map=by_joblib))


def test_two_workers_of_dask_make_the_same_file(scene, whole):
    pytest.importorskip("dask")
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            check_same(whole, nt.ensemble(scene, VARY, out="futures.h5", map=client.map, shards=2))
            check_same(whole, nt.ensemble(scene, VARY, out="gathered.h5", shards=2,
                                          map=lambda make, shards: client.gather(client.map(make, shards))))


MPI_SCRIPT = """
import noether as nt
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    with MPIPoolExecutor() as pool:
        nt.ensemble("planets.toml", {vary!r}, out="mpi.h5", map=pool.map, shards=3)
"""
# As any user, on as many processors as there are; MPICH asks for neither.
MPI_ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}


@pytest.mark.parametrize("mpi", ["openmpi", "mpich"])
def test_mpi4py_makes_the_same_file(mpi, scene, whole, tmp_path):
    pytest.importorskip("mpi4py")
    mpiexec = shutil.which(f"mpiexec.{mpi}")
    if mpiexec is None:
        pytest.skip(f"mpiexec.{mpi} is not installed")
    environment = {**os.environ, **MPI_ENVIRONMENT, "MPI4PY_MPIABI": mpi}
    probe = subprocess.run([mpiexec, "-n", "1", sys.executable, "-c", "from mpi4py import MPI"], capture_output=True, text=True,
                           env=environment)
    if probe.returncode != 0:
        why = [line for line in probe.stderr.splitlines() if "Error" in line]
        pytest.skip(f"mpi4py cannot use {mpi}: {(why or ['it tells no reason'])[-1]}")
    (tmp_path / "script.py").write_text(MPI_SCRIPT.format(vary=VARY))
    done = subprocess.run([mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", "script.py"], env=environment,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    check_same(whole, nt.open_ensemble("mpi.h5"))


def test_a_finished_table_is_read_and_an_unfinished_one_goes_on(scene, whole):
    def fails_at_the_second(make, shards):
        yield make(shards[0])
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        nt.ensemble(scene, VARY, out="map.h5", map=fails_at_the_second, shards=3)
    assert os.listdir(".").count("map.h5.0-of-3") == 1
    check_same(whole, nt.ensemble(scene, VARY, out="map.h5", map=map, shards=3))

    def never(make, shards):
        raise AssertionError("there is nothing to make")

    check_same(whole, nt.ensemble(scene, VARY, out="map.h5", map=never))
    other = {"particles.body.c.a": ("1.3 au", "1.4 au", 2)}
    with pytest.raises(nt.Error, match="the file is of another ensemble"):
        nt.ensemble(scene, other, out="map.h5", map=map)
    assert nt.ensemble(scene, other, out="map.h5", map=map, shards=2, fresh=True).sizes["particles.body.c.a"] == 2


def test_shards_are_tables_too_and_are_merged(scene, whole):
    words, _, made = nt.ensembles._words(scene, VARY, None, 0, None, None, None, "map.h5")
    files = [nt.ensembles._make([*words, "--shard", f"{k}/2"])["file"] for k in range(2)]
    shard = nt.open_ensemble(files[1])
    assert list(shard["member"]) == list(range(1, 18, 2)) and shard.attrs["shards"] == 2
    assert shard["particles.body.c.e"].dims == ("member",)
    with pytest.raises(nt.Error, match="of 2 shards 0 is missing"):
        nt.merge(files[1], "map.h5")
    assert (nt.merge(files[::-1], "map.h5")["digest"] == whole[0]["digest"]).all()
    assert open(made, "rb").read() == whole[1]


def test_what_is_wrong_is_one_line(scene):
    with pytest.raises(nt.Error, match="unknown key 'aa' in body 'c'; did you mean 'a'"):
        nt.ensemble(scene, {"particles.body.c.aa": (1, 2, 3)})
    with pytest.raises(nt.Error, match="unknown key 'aa'"):
        nt.ensemble(scene, {"particles.body.c.aa": (1, 2, 3)}, map=map)
    with pytest.raises(TypeError, match=r"varies by \(1, 2\); \(first, last, points\)"):
        nt.ensemble(scene, {"particles.body.c.a": (1, 2)})
    with pytest.raises(ValueError, match="one unit for both"):
        nt.ensemble(scene, {"particles.body.c.a": ("1 au", "2 km", 3)})
    with pytest.raises(ValueError, match="shards = 0; a whole number of 1 or more"):
        nt.ensemble(scene, {"particles.body.c.a": (1, 2, 3)}, map=map, shards=0)
    with pytest.raises(nt.FileError, match="planets.toml: "):
        nt.open_ensemble("planets.toml")
    with pytest.raises(nt.FileError, match="this is not the table of an ensemble"):
        nt.open_ensemble(nt.run(scene, out="one").files.trajectory)


EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


@nightly
@pytest.mark.parametrize("example", sorted(one.parent.name for one in EXAMPLES.glob("*/draw.py")))
def test_scripts_of_examples_print_what_their_pages_say_and_draw(example, matplotlib, capsys):
    runpy.run_path(str(EXAMPLES / example / "draw.py"))
    told = capsys.readouterr().out
    assert told and f"\n```\n{told}```\n" in (EXAMPLES / example / "README.md").read_text()
    assert os.path.getsize(f"{example}.png") > 10_000


# ---- pictures ---------------------------------------------------------------------------------------------------------

@pytest.fixture
def matplotlib():
    plotting = pytest.importorskip("matplotlib")
    plotting.use("agg")
    with plotting.rc_context():  # scripts set a style for all that they draw
        yield plotting
    plotting.pyplot.close("all")


def test_a_map_has_the_figures_of_its_members(scene, whole, matplotlib):
    ax = nt.plots.ensemble(whole[0], "energy_worst", log=False)
    mesh, = ax.collections
    drawn = numpy.ma.filled(mesh.get_array(), numpy.nan).reshape(3, 6)
    expected = whole[0]["energy_worst"].values.T
    assert numpy.array_equal(drawn[:2], expected[:2]) and numpy.isnan(drawn[2]).all()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("a of c (au)", "e of c")
    turned = nt.plots.ensemble("whole.h5", "elements_value.c.e", x="particles.body.c.e")
    assert turned.get_xlabel() == "e of c"
    values = whole[0]["elements_value"].sel(body="c", elements_value_column="e").values
    assert numpy.array_equal(numpy.ma.filled(turned.collections[0].get_array(), numpy.nan).reshape(6, 3), values, equal_nan=True)


def test_draws_are_points_and_one_key_is_an_axis(scene, matplotlib):
    drawn = nt.ensemble(scene, {"particles.body.c.M": "uniform(0,360)", "particles.body.b.a": "uniform(0.9,1.1)"}, members=5)
    points = nt.plots.ensemble(drawn).collections[0]
    assert numpy.array_equal(points.get_offsets()[:, 0], drawn["particles.body.c.M"].values)
    assert numpy.array_equal(points.get_array(), drawn["resonance_angle_amplitude"].values)
    line, = nt.plots.ensemble(drawn.isel(member=slice(3)), "time", x="particles.body.b.a", y="particles.body.b.a").get_lines()
    assert len(line.get_xdata()) == 3


def test_what_a_table_lacks_is_told(scene, whole, matplotlib):
    with pytest.raises(KeyError, match="did you mean 'energy_worst'"):
        nt.plots.ensemble(whole[0], "energy_wurst")
    with pytest.raises(KeyError, match="elements_value.d has no 'd'; it has: Sun, b, c"):
        nt.plots.ensemble(whole[0], "elements_value.d")
    with pytest.raises(KeyError, match="does not vary; did you mean 'particles.body.c.a'"):
        nt.plots.ensemble(whole[0], x="particles.body.a")
    with pytest.raises(TypeError, match="int is not an ensemble"):
        nt.plots.ensemble(7)


def test_resonances_and_chaos_against_time(scene, matplotlib):
    more = SCENE + '[[every]]\ntype = "megno"\nsteps = 5\n[[every]]\ntype = "lyapunov"\nvectors = 2\nsteps = 5\n'
    open("chaos.toml", "w").write(more)
    report = nt.run("chaos.toml", out="chaos")
    line, = nt.plots.resonance_angles(report).get_lines()
    told = numpy.degrees(report.series("resonance_angle").value)
    assert numpy.allclose((line.get_ydata() - told + 180) % 360, 180) and line.get_label() == "2 : 1 of b and c"
    assert nt.plots.megno(report).get_lines()[1].get_ydata() == pytest.approx(report.series("megno")["mean"])
    exponents = nt.plots.lyapunov(report)
    assert exponents.get_ylabel() == "Lyapunov exponent (1/day)" and exponents.get_xscale() == "log"
    labels = [one.get_ylabel() for one in report.plot(what=["resonance_angles", "megno", "lyapunov"])]
    assert labels == ["resonance angle (deg)", "MEGNO <Y>", "Lyapunov exponent (1/day)"]
    with pytest.raises(nt.Error, match="the run has no monitor megno"):
        nt.plots.megno(nt.run(scene, out="plain"))
