"""Simulations of REBOUND taken over: by REBOUND itself where it is installed, and by stand-ins of versions 4 and 5."""

import types

import numpy as np
import pytest

import noether as nt


def planets(units=None):
    """A star and two planets in REBOUND."""
    rebound = pytest.importorskip("rebound")
    sim = rebound.Simulation()
    if units:
        sim.units = units
    sim.add(m=1, name="star")
    sim.add(m=1e-3, a=1.0, e=0.05, inc=0.02, name="inner")
    sim.add(m=3e-4, a=1.9, e=0.08, Omega=0.3, f=1.2)
    sim.move_to_com()
    sim.dt = 0.05
    return sim


def positions(sim):
    return np.array([one.xyz for one in sim.particles])


def velocities(sim):
    return np.array([one.vxyz for one in sim.particles])


def test_particles_of_rebound_are_taken_over_to_the_bit():
    sim = planets()
    bodies = nt.rebound.particles(sim)
    assert bodies.units == "reduced" and bodies.names == ["star", "inner", "body_3"]
    assert (bodies.positions == positions(sim)).all() and (bodies.velocities == velocities(sim)).all()
    assert (bodies.masses == [one.m for one in sim.particles]).all()


@pytest.mark.parametrize("units", [("au", "day", "msun"), ("au", "yr", "msun"), ("au", "yr2pi", "msun"), ("km", "s", "kg")])
def test_units_of_rebound_become_solar_ones_and_orbits_stay(units):
    sim = planets(units)
    bodies, raw = nt.rebound.particles(sim), nt.rebound.particles(sim, "reduced")
    assert bodies.units == "solar" and (raw.positions == positions(sim)).all()
    theirs = sim.particles[1].orbit(primary=sim.particles[0])
    length = {"au": 1, "km": 1 / 149597870.7}[units[0]]
    time = {"day": 1, "yr": 365.25, "s": 1 / 86400, "yr2pi": 365.25 / (2 * np.pi)}[units[1]]
    assert raw["inner"].P == pytest.approx(theirs.P, rel=1e-13)
    assert bodies["inner"].P == pytest.approx(theirs.P * time, rel=1e-4 if units[1] == "yr2pi" else 1e-12)
    assert bodies["inner"].a == pytest.approx(theirs.a * length, rel=1e-12)
    assert bodies["inner"].e == pytest.approx(theirs.e, rel=1e-9)


@pytest.mark.parametrize("integrator, settings, method", [
    ("whfast", {}, "verlet_aba"), ("whfast", {"corrector": 17}, "verlet_aba"),
    ("whfast", {"corrector": 17, "kernel": "lazy"}, "verlet_aba"),
    ("whfast", {"corrector": 11, "kernel": "modifiedkick"}, "verlet_aba"),
    ("whfast", {"corrector": 11, "kernel": "composition"}, "verlet_aba"),
    ("whfast", {"corrector": 17, "corrector2": 1, "kernel": "lazy"}, "verlet_aba"),
    ("whfast", {"coordinates": "democraticheliocentric"}, "verlet_aba"), ("whfast", {"coordinates": "whds"}, "verlet_aba"),
    ("saba", {"type": "1"}, "saba_1"), ("saba", {"type": "3"}, "saba_3"), ("saba", {"type": "CM_2"}, "saba_2"),
    ("saba", {"type": "10_4"}, "aba_10_4"), ("saba", {"type": "8_6_4"}, "aba_8_6_4"), ("saba", {"type": "10_6_4"}, "aba_10_6_4"),
    ("saba", {"type": "H_8_4_4"}, "abah_8_4_4"), ("saba", {"type": "H_10_6_4"}, "abah_10_6_4"), ("leapfrog", {}, "verlet_aba")])
def test_a_method_with_a_namesake_goes_the_same_way(integrator, settings, method):
    sim = planets()
    sim.integrator = integrator
    for key, value in settings.items():
        setattr(sim.integrator, key, value)
    ours = nt.from_rebound(sim)
    assert ours.tree()["integrator"]["method"] == method
    sim.steps(200)
    ours.run(200)
    assert np.abs(ours.positions - positions(sim)).max() < 3e-12
    assert np.abs(ours.velocities - velocities(sim)).max() < 3e-12


def test_methods_that_choose_their_steps_agree_within_their_tolerance():
    for integrator, far in (("ias15", 1e-12), ("bs", 1e-5)):
        sim = planets()
        sim.integrator = integrator
        ours = nt.from_rebound(sim)
        sim.integrate(10.0)
        ours.run(until=10.0)
        assert ours.time >= 10.0  # a whole step; for that of REBOUND a shorter one
        reference = planets()
        reference.integrator = "ias15"
        reference.integrate(ours.time)
        assert np.abs(ours.positions - positions(reference)).max() < far


@pytest.mark.parametrize("integrator", ["mercurius", "trace"])
def test_hybrid_methods_become_one_that_resolves_encounters(integrator):
    sim = planets()
    sim.integrator = integrator
    with pytest.warns(nt.RunWarning, match="gauss_8 takes its place"):
        assert nt.from_rebound(sim).tree()["integrator"]["method"] == "gauss_8"
    assert nt.from_rebound(sim, method="aba_10_6_4", hamiltonian="wisdom_holman").tree()["integrator"]["step"] == 0.05


def test_clock_softening_and_distances_to_stop_at_are_taken_over():
    sim = planets(("au", "yr", "msun"))
    sim.t, sim.softening, sim.exit_max_distance, sim.exit_min_distance = 2.0, 0.01, 50.0, 0.001
    ours = nt.from_rebound(sim)
    tree = ours.tree()
    assert ours.time == pytest.approx(730.5) and tree["integrator"]["step"] == "18.2625 day"
    assert tree["hamiltonian"]["force"] == [{"type": "gravity", "softening": "0.01 au"}]
    assert [one["type"] for one in tree["stop"]] == ["escape", "collision"] and tree["stop"][0]["distance"] == "50.0 au"


def test_particles_of_rebound_without_a_namesake_method_can_be_run_by_another():
    sim = planets()
    sim.integrator = "janus"
    with pytest.raises(nt.Error, match="'janus'.*kahan_li_8_s17"):
        nt.from_rebound(sim)
    assert nt.from_rebound(sim, method="kahan_li_8_s17").run(10).ok


# ---- stand-ins ------------------------------------------------------------------------------------------------------


def particle(m, x, vy, **more):
    return types.SimpleNamespace(m=m, x=x, y=0.0, z=0.0, vx=0.0, vy=vy, vz=0.0, **more)


def stand_in(**changes):
    """A simulation of version 4: integrators by their names, hashes in place of names, -1 for all particles."""
    given = [particle(1.0, 0.0, 0.0, hash=types.SimpleNamespace(value=0)),
             particle(1e-3, 1.0, 1.0, hash=types.SimpleNamespace(value=4217)),
             particle(1e-3, 2.0, 0.7, hash=types.SimpleNamespace(value=0))]
    sim = types.SimpleNamespace(
        particles=given, N=3, N_var=0, N_active=-1, testparticle_type=0, G=1.0, t=0.0, dt=0.01, softening=0.0, gravity="basic",
        boundary="none", collision="none", exit_max_distance=0.0, exit_min_distance=0.0, integrator="whfast",
        units={"length": None, "mass": None, "time": None},
        ri_whfast=types.SimpleNamespace(corrector=11, corrector2=0, kernel=3, coordinates=1),
        ri_saba=types.SimpleNamespace(type="(10,6,4)"), ri_ias15=types.SimpleNamespace(epsilon=0.0))
    for key, value in changes.items():
        setattr(sim, key, value)
    return sim


def test_version_4_names_its_settings_otherwise():
    ours = nt.from_rebound(stand_in())
    assert ours.tree()["particles"]["body"][1]["name"] == "hash_4217"
    assert ours.tree()["hamiltonian"]["coordinates"] == "democratic"
    assert ours.tree()["integrator"] == {"method": "verlet_aba", "step": 0.01, "corrector": 11, "kernel": "lazy"}
    for kind, method in (("(10,6,4)", "aba_10_6_4"), ("h(8,4,4)", "abah_8_4_4"), ("cm2", "saba_2"), ("3", "saba_3")):
        saba = stand_in(integrator="saba", ri_saba=types.SimpleNamespace(type=kind))
        assert nt.from_rebound(saba).tree()["integrator"]["method"] == method
    assert nt.from_rebound(stand_in(integrator="ias15")).tree()["integrator"]["adaptive"] is False


def test_what_is_kept_is_G_m():
    bodies = nt.rebound.particles(stand_in(G=4.0))
    assert (bodies.masses == [4.0, 4e-3, 4e-3]).all() and (bodies.positions[:, 0] == [0, 1, 2]).all()


def test_particles_from_N_active_on_are_tracers():
    assert (nt.rebound.particles(stand_in(N_active=2)).masses == [1, 1e-3, 0]).all()
    assert (nt.rebound.particles(stand_in(N_active=2**64 - 1)).masses == [1, 1e-3, 1e-3]).all()
    with pytest.raises(nt.Error, match="testparticle_type = 1"):
        nt.rebound.particles(stand_in(N_active=2, testparticle_type=1))


@pytest.mark.parametrize("changes, message", [
    ({"boundary": "periodic"}, "boundary = 'periodic'"), ({"collision": "direct"}, "collision = 'direct'.*nt.Collision"),
    ({"gravity": "none"}, "gravity = 'none'"), ({"N_var": 1, "N": 4}, "1 variational particles"),
    ({"_additional_forces": print}, "additional_forces.*add_force"), ({"_post_timestep_modifications": print}, "post_timestep"),
    ({"integrator": "eos"}, "'eos'.*aba_10_6_4"), ({"integrator": "sei"}, "shearing sheet"),
    ({"softening": 0.1}, "softening = 0.1"),
    ({"integrator": "new"}, "'new'.*name a method"), ({"units": {"length": "furlong", "time": "yr"}}, "unit 'furlong'"),
])
def test_what_has_no_counterpart_is_refused_by_name(changes, message):
    with pytest.raises(nt.Error, match=message):
        nt.from_rebound(stand_in(**changes))


def test_units_that_rebound_does_not_have_are_refused():
    with pytest.raises(nt.Error, match="units = 'solar'"):
        nt.from_rebound(stand_in(), units="solar")
