"""Pictures: each shows the numbers that it is about, and says what it lacks."""

import math

import numpy
import pytest

import noether as nt

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("agg")

plots = nt.plots


@pytest.fixture(autouse=True)
def no_figures_left():
    yield
    matplotlib.pyplot.close("all")


def planets():
    bodies = nt.Particles(units="solar")
    bodies.add("Sun", m=1)
    bodies.add("Jupiter", m=9.5e-4, a=5.2, e=0.05, inc="1.3 deg")
    bodies.add("Saturn", m=2.9e-4, a=9.55, e=0.06, inc="2.5 deg", M="115 deg")
    return bodies


@pytest.fixture(scope="module")
def solar():
    sim = nt.Simulation(planets(), method="verlet", step="20 day")
    sim.add_force(nt.Gravity())
    sim.every(10, nt.Energy())
    sim.every(10, nt.ShadowHamiltonian(orders=[4, 12]))
    sim.record_frames(10)
    sim.run(1000)
    return sim


@pytest.fixture(scope="module")
def liquid():
    atoms = nt.Particles(nt.builders.Lattice(cells=[4, 4, 4], density=0.8, mass=1, temperature=1.5))
    sim = nt.Simulation(atoms, method="verlet", step=0.005)
    sim.add_force(nt.LennardJones(cutoff=2.5, cutoff_style="switch_c4", epsilon=1, sigma=1))
    for monitor in (nt.Energy(), nt.Temperature(), nt.RadialDistribution(), nt.MeanSquareDisplacement(length=30),
                    nt.VelocityAutocorrelation(length=30)):
        sim.every(5, monitor)
    sim.record_frames(100)
    sim.run(400)
    return sim


def lines_by_name(ax):
    return {line.get_label(): line for line in ax.get_lines() if not line.get_label().startswith("_")}


def test_orbits_have_ellipses_that_touch_bodies(solar):
    ax = plots.orbits(solar)
    assert ax.get_aspect() == 1
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["Sun", "Jupiter", "Saturn"]
    assert ax.get_xlabel() == "x from Sun (au)"
    place = solar.positions[1] - solar.positions[0]
    conic = max((line for line in ax.get_lines() if line.get_color() == plots.COLOURS[0] and len(line.get_xdata()) == 361),
                key=lambda line: line.get_linewidth())
    points = numpy.array(conic.get_data()).T
    assert numpy.hypot(*(points - place[:2]).T).min() < 0.05
    elements = solar.elements("Jupiter")
    radii = numpy.hypot(*points.T)
    assert radii.max() == pytest.approx(elements["a"] * (1 + elements["e"]), rel=1e-3)


def test_orbits_of_frames_run_through_them(solar):
    ax = plots.orbits(solar.frames, about=None, bodies="Saturn")
    path = numpy.array(max(ax.get_lines(), key=lambda line: len(line.get_xdata())).get_data()).T
    for frame in solar.frames.positions[::7, 2, :2]:
        assert numpy.hypot(*(path - frame).T).min() < 1e-12


def test_frames_far_apart_are_dots_and_not_joined(solar):
    sim = nt.Simulation(planets(), method="verlet", step="20 day")
    sim.add_force(nt.Gravity())
    sim.record_frames(200)
    sim.run(4000)
    longest = [line for line in plots.orbits(sim, ellipses=False).get_lines() if len(line.get_xdata()) > 1]
    assert {line.get_linestyle() for line in longest if line.get_color() == plots.COLOURS[0]} == {"None"}


def test_orbits_in_three_dimensions(solar):
    ax = plots.orbits(solar, projection="3d")
    assert ax.name == "3d" and ax.get_zlabel() == "z (au)"


def test_particles_have_ellipses_before_they_run():
    ax = plots.orbits(planets())
    assert sum(len(line.get_xdata()) == 361 for line in ax.get_lines()) == 2


def test_hyperbolas_are_drawn_as_far_as_they_matter():
    bodies = nt.Particles(units="solar")
    bodies.add("Sun", m=1)
    bodies.add("comet", m=0, q=1, e=1.2, T=0)
    conic = max(plots.orbits(bodies).get_lines(), key=lambda line: len(line.get_xdata()))
    radii = numpy.hypot(*conic.get_data())
    assert radii.min() == pytest.approx(1, rel=1e-3) and radii.max() == pytest.approx(4, rel=1e-3)


def test_equal_masses_have_no_primary():
    ax = plots.orbits(nt.open_run(run_of("figure_eight")))
    assert ax.get_xlabel() == "x"
    assert not any(len(line.get_xdata()) == 361 for line in ax.get_lines())


@pytest.fixture(scope="module", autouse=True)
def folder(tmp_path_factory):
    run_of.folder = tmp_path_factory.mktemp("runs")


def run_of(example):
    folder = run_of.folder / example
    if not folder.exists():
        nt.run(example, out=folder)
    return folder


def test_elements_are_those_of_the_frames(solar):
    a, e = plots.elements(solar, "Saturn", quantities=("a", "e"))
    assert a.get_ylabel() == "semi-major axis a (au)"
    line = a.get_lines()[0]
    assert line.get_ydata() == pytest.approx(solar.frames.elements("Saturn")["a"])
    assert line.get_xdata()[-1] == pytest.approx(20000 / 365.25)
    assert e.get_xlabel() == "time (yr)"
    inclination = plots.elements(solar, "Jupiter", quantities="inc").get_lines()[0].get_ydata()
    assert inclination[0] == pytest.approx(1.3)


def test_energies_show_the_shadow_below(solar):
    ax = plots.energies(solar)
    energy, shadow = ax.get_lines()
    assert ax.get_yscale() == "log"
    assert energy.get_ydata().max() == pytest.approx(solar.monitors["energy"]["worst"], rel=1e-6)
    assert shadow.get_ydata().max() < 1e-4 * energy.get_ydata().max()
    assert "order 12" in shadow.get_label()


def test_liquid_pictures(liquid):
    ax = plots.radial_distribution(liquid)
    r, g = lines_by_name(ax).get("_", ax.get_lines()[1]).get_data()
    assert 1.0 < r[numpy.argmax(g)] < 1.2 and g.max() > 2
    ax = plots.mean_square_displacement(liquid)
    lag, value = ax.get_lines()[0].get_data()
    assert lag[0] == 0 and value[0] == 0 and value[-1] > value[3] > 0
    ax = plots.velocity_autocorrelation(liquid)
    assert ax.get_lines()[1].get_ydata()[0] == 1
    ax = plots.positions(liquid)
    assert len(ax.collections[0].get_offsets()) == 256
    assert ax.collections[0].get_offsets().min() >= 0


def test_lines_of_two_runs_share_axes(liquid):
    figure, ax = matplotlib.pyplot.subplots()
    assert plots.radial_distribution(liquid, ax=ax, label="hot", color="k") is ax
    assert "hot" in lines_by_name(ax)


def test_plot_chooses_by_what_there_is(solar, liquid):
    labels = [ax.get_ylabel() for ax in solar.plot()]
    assert labels == ["y from Sun (au)", "relative error", "semi-major axis a (au)", "eccentricity e", "inclination (deg)"]
    labels = [ax.get_ylabel() for ax in liquid.plot()]
    assert labels == ["y", "relative error", "g(r)", "mean square displacement", "velocity autocorrelation", "temperature"]
    assert len(solar.plot(what=["energies"])) == 1


def test_stiff_variables_have_logarithmic_time_and_are_magnified():
    ax, = nt.open_run(run_of("robertson")).plot()
    assert ax.get_xscale() == "log"
    lines = lines_by_name(ax)
    assert list(lines) == ["A", r"$10^{4}$ B", "C"]
    assert 0.3 < lines[r"$10^{4}$ B"].get_ydata().max() < 0.4
    assert lines["A"].get_ydata()[0] == pytest.approx(1, abs=1e-3)


def test_comparison_marks_the_front():
    comparison = nt.compare("figure_eight", methods=["verlet", "yoshida_4"], until=1, repeats=1, budget=1)
    ax = comparison.plot()
    assert ax.get_xscale() == ax.get_yscale() == "log"
    assert list(lines_by_name(ax)) == ["verlet", "yoshida_4"]
    rings = [line for line in ax.get_lines() if line.get_markerfacecolor() == "none"]
    assert len(rings[0].get_xdata()) == len(comparison.front)
    assert plots.plot_comparison(comparison, against="evaluations").get_xlabel() == "evaluations of forces"


@pytest.mark.parametrize("draw, message", [
    (lambda sim: plots.radial_distribution(sim), r"no monitor radial_distribution; add sim.every\(..., nt.RadialDistribution"),
    (lambda sim: plots.mean_square_displacement(sim), "nt.MeanSquareDisplacement"),
    (lambda sim: plots.velocity_autocorrelation(sim), "nt.VelocityAutocorrelation"),
    (lambda sim: plots.variables(sim), "no monitor variables"),
    (lambda sim: plots.orbits(sim, bodies="Jupitre"), "did you mean 'Jupiter'"),
    (lambda sim: plots.orbits(sim, projection="xx"), "projection = 'xx'; one of"),
    (lambda sim: plots.elements(sim, quantities="b"), "quantities has 'b'"),
    (lambda sim: plots.orbits(7), "int is not a run"),
    (lambda sim: plots.elements(planets()), "no frames; add sim.record_frames"),
])
def test_what_is_missing_is_told(solar, draw, message):
    with pytest.raises((nt.Error, KeyError, ValueError, TypeError), match=message):
        draw(solar)


def test_a_simulation_without_frames_says_how_to_get_them():
    sim = nt.Simulation(planets(), method="verlet", step="20 day")
    sim.add_force(nt.Gravity())
    with pytest.raises(nt.Error, match="record_frames"):
        plots.elements(sim)
    assert math.isfinite(plots.orbits(sim).get_xlim()[0])


def test_boxes_and_frames_alone_are_enough(liquid, solar):
    still = nt.Simulation(nt.Particles(nt.builders.Lattice(cells=[3, 3, 3], density=0.8, mass=1, temperature=1)),
                          method="verlet", step=0.004)
    still.add_force(nt.LennardJones(cutoff=2, cutoff_style="switch_c4", epsilon=1, sigma=1))
    still.run(200)
    ax = plots.positions(still)
    edge = (108 / 0.8) ** (1 / 3)
    assert ax.patches[0].get_width() == pytest.approx(edge)
    assert 0 <= ax.collections[0].get_offsets().min() and ax.collections[0].get_offsets().max() <= edge
    assert [one.get_ylabel() for one in plots.plot(solar.frames)][0] == "y from Sun (au)"
    assert len(plots.plot(liquid.frames)) == 1


def test_paths_and_reports_are_runs_too():
    folder = run_of("figure_eight")
    one, other = plots.plot(folder), plots.plot(nt.open_run(folder))
    assert [ax.get_ylabel() for ax in one] == [ax.get_ylabel() for ax in other] == ["y", "relative error"]


def test_users_axes_keep_their_style_and_other_figures_theirs(solar):
    before = dict(matplotlib.rcParams)
    figure, (left, right) = matplotlib.pyplot.subplots(1, 2)
    plots.orbits(solar, ax=left)
    plots.energies(solar, ax=right)
    plots.energies(solar)
    assert left.spines["top"].get_visible()
    assert dict(matplotlib.rcParams) == before


def test_boxes_and_units_come_from_files_too(tmp_path):
    report = nt.run("water_box", out=tmp_path / "water", until="0.02 ps")
    assert len(report.frames.box) == 3 and 1.5 < report.frames.box[0] < 2.5
    ax = plots.positions(report)
    assert ax.patches[0].get_width() == pytest.approx(report.frames.box[0])
    assert plots.monitor(report, "temperature").get_ylabel() == "temperature (K)"


def test_what_systems_lack_is_told():
    sim = nt.Simulation(system=nt.Robertson(), method="rodas_5p", rtol=1e-6)
    with pytest.raises(nt.Error, match="no monitor variables"):
        sim.plot()
