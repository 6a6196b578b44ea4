"""Bodies as users write them, and their elements."""

import math

import numpy as np
import pytest

import noether as nt
from noether import _core

TURN = 2 * math.pi


def one_orbit(units="reduced", m=0.0, **elements):
    bodies = nt.Particles(units=units)
    bodies.add("star", m=1)
    return bodies.add("planet", m=m, **elements)


@pytest.mark.parametrize("size", [{"a": 1.3}, {"P": 7.0}, {"q": 0.8}])
@pytest.mark.parametrize("shape", [
    {"e": 0.2, "inc": 0.4, "Omega": 1.0, "omega": 2.0, "M": 0.7}, {"e": 0.2, "inc": 0.4, "Omega": 1.0, "pomega": 2.0, "l": 0.7},
    {"e": 0.7, "inc": 2.4, "Omega": 4.0, "omega": 2.0, "f": 3.3},
    {"e": 0.01, "inc": 0.1, "Omega": 3.0, "omega": 2.0, "theta": 1.0}])
def test_elements_that_are_given_come_back(size, shape):
    body = one_orbit(**size, **shape)
    for key, value in {**{k: v for k, v in size.items() if k != "q"}, **shape}.items():
        assert getattr(body, key) == pytest.approx(value, rel=1e-12), key
    if "q" in size:
        assert body.a * (1 - body.e) == pytest.approx(size["q"], rel=1e-12)


def test_angles_belong_together():
    body = one_orbit(a=1.3, e=0.3, inc=0.5, Omega=5.0, omega=4.0, E=2.5)
    assert body.M == pytest.approx(2.5 - 0.3 * math.sin(2.5), rel=1e-13)
    assert math.tan(body.f / 2) == pytest.approx(math.sqrt(1.3 / 0.7) * math.tan(1.25), rel=1e-12)
    assert body.pomega == pytest.approx((body.Omega + body.omega) % TURN)
    assert body.l == pytest.approx((body.pomega + body.M) % TURN) and body.theta == pytest.approx((body.pomega + body.f) % TURN)
    assert body.n * body.P == pytest.approx(TURN) and body.n**2 * body.a**3 == pytest.approx(1)


def test_a_hyperbola_has_a_true_anomaly_of_both_signs_and_no_period():
    for E in (-0.8, 0.8):
        body = one_orbit(a=-2.0, e=1.5, E=E)
        assert math.copysign(1, body.f) == math.copysign(1, E)
        assert math.tan(body.f / 2) == pytest.approx(math.sqrt(2.5 / 0.5) * math.tanh(E / 2), rel=1e-12)
        assert body.P == math.inf and body.n == pytest.approx(math.sqrt(1 / 8))


def test_on_a_circle_the_anomalies_are_equal():
    for inc in (0.0, 0.3):
        body = one_orbit(a=2.0, inc=inc, f=1.1)
        assert body.e < 1e-15 and body.theta == pytest.approx(1.1) and body.l == pytest.approx(1.1)


def test_bare_angles_are_radians_in_every_unit_system():
    for units, length in (("solar", "au"), ("si", "m"), ("reduced", "")):
        bare = one_orbit(units, a=1.0, inc=0.5, omega=1.5, M=0.25).x
        told = one_orbit(units, a=f"1 {length}".strip() if length else 1.0, inc=f"{math.degrees(0.5)!r} deg",
                         omega=f"{math.degrees(1.5)!r} deg", M=f"{math.degrees(0.25)!r} deg").x
        np.testing.assert_allclose(bare, told, rtol=1e-14)


def test_arrays_of_states_have_the_elements_of_each():
    rng = np.random.default_rng(3)
    x, v = rng.normal(size=(2, 500, 3, 3))
    masses = np.array([1.0, 0.01, 0.0])
    found = nt.particles.elements_of(x, v, masses, [1, 2], 0, "reduced")
    assert found.a.shape == (500, 2) and found["f"].shape == (500, 2)
    for k in range(500):
        for j, body in enumerate((1, 2)):
            one = _core.elements_from_state(list(x[k, body] - x[k, 0]), list(v[k, body] - v[k, 0]), float(1.0 + masses[body]))
            assert tuple(found[name][k, j] for name in ("a", "e", "inc", "Omega", "omega", "M")) == tuple(one)
    assert (found.a < 0).any() and (found.a > 0).any()
    relative, speed = x[:, 1:] - x[:, :1], v[:, 1:] - v[:, :1]
    distance = found.a * (1 - found.e**2) / (1 + found.e * np.cos(found.f))
    np.testing.assert_allclose(distance, np.linalg.norm(relative, axis=2), rtol=1e-6)
    assert (np.sign(np.sin(found.f)) == np.sign((relative * speed).sum(axis=2))).all()


def test_elements_in_jacobi_coordinates_are_those_that_were_given():
    bodies = nt.Particles(elements="jacobi")
    bodies.add("star", m=1)
    bodies.add("inner", m=0.01, a=1, e=0.1)
    bodies.add("outer", m=0.02, a=2.5, e=0.2, pomega=1.0)
    assert bodies["outer"].a == pytest.approx(2.5, rel=1e-14) and bodies["outer"].e == pytest.approx(0.2, rel=1e-13)
    assert abs(bodies["outer"].elements("star").a - 2.5) > 1e-3
    by_hand = bodies.elements("outer", about=["star", "inner"])
    assert by_hand.a == pytest.approx(2.5, rel=1e-14)
    both = bodies.elements(about="jacobi")
    assert both.a == pytest.approx([1.0, 2.5], rel=1e-14)
    with pytest.raises(nt.Error, match="first body has no elements in Jacobi"):
        bodies.elements(0)


def test_a_moon_has_elements_about_its_planet():
    bodies = nt.Particles()
    bodies.add("star", m=1)
    planet = bodies.add("planet", m=1e-3, a=1)
    moon = bodies.add("moon", a=0.01, e=0.3, primary=planet)
    assert bodies.add("other", a=0.01, primary=1).values["about"] == "planet"
    assert moon.a == pytest.approx(0.01, rel=1e-12) and moon.e == pytest.approx(0.3, rel=1e-12)
    assert abs(bodies.elements("moon", "star").a) > 0.5
    with pytest.raises(nt.Error, match="no elements about itself"):
        planet.elements("planet")


def test_positions_by_component_and_as_vectors_are_the_same():
    bodies = nt.Particles()
    bodies.add(m=1)
    one = bodies.add(m=1, x=1, vy=0.5)
    other = bodies.add(m=1, x=[1, 0, 0], v=np.array([0, 0.5, 0]))
    assert (one.xyz == other.xyz).all() and (one.vxyz == other.vxyz).all() and one.v[1] == 0.5
    with pytest.raises(AttributeError, match=r"x\[1\]"):
        one.y


def test_a_body_without_a_mass_is_a_tracer_and_names_count_on():
    bodies = nt.Particles()
    bodies.add(m=1)
    tracer = bodies.add(a=1)
    assert tracer.m == 0 and tracer.name == "body_2" and [one.name for one in bodies[:2]] == ["body_1", "body_2"]


def test_bodies_added_to_those_of_a_file_come_after_them():
    bodies = nt.bodies.solar_system()
    comet = bodies.add("comet", q=0.5, e=0.9)
    assert comet.index == 9 and bodies[9] is comet and len(bodies) == 10
    assert comet.e == pytest.approx(0.9, rel=1e-10) and bodies["Jupiter"].a == pytest.approx(5.2, abs=0.01)
    with pytest.raises(AttributeError, match="Simulation.edit"):
        bodies["Jupiter"].e = 0.1
    with pytest.raises(TypeError, match="from a file"):
        del bodies["Jupiter"]
    del bodies["comet"]
    assert len(bodies) == 9


def test_what_was_given_can_be_set():
    body = one_orbit(a=1.0, e=0.1, f=1.0)
    body.P = TURN * 8
    body.e = 0.5
    body.M = 0.2
    assert body.a == pytest.approx(4, rel=1e-14) and body.e == pytest.approx(0.5) and body.M == pytest.approx(0.2)
    with pytest.raises(TypeError, match="did you mean 'inc'"):
        body.incl = 3
    with pytest.raises(AttributeError, match="keeps its name"):
        body.name = "other"


def test_a_copy_goes_its_own_way_and_can_be_sent_to_another_process():
    import pickle

    bodies = nt.Particles()
    bodies.add("star", m=1)
    bodies.add("planet", m=1e-3, a=1, e=0.1)
    other, sent = bodies.copy(), pickle.loads(pickle.dumps(bodies))
    other["planet"].e = 0.5
    assert bodies["planet"].e == pytest.approx(0.1) and other["planet"].e == pytest.approx(0.5)
    assert (sent.positions == bodies.positions).all() and sent["planet"].a == bodies["planet"].a


def test_default_names_do_not_come_twice():
    bodies = nt.Particles()
    for _ in range(3):
        bodies.add(m=1)
    del bodies["body_1"]
    assert bodies.add(m=1, x=1).name == "body_4" and bodies["body_2"].index == 0


def test_columns_of_forces_do_not_matter_to_a_look_at_the_start():
    bodies = nt.Particles(units="solar")
    bodies.add("star", m=1, r="1 Rsun", love_number=0.03)
    assert bodies.tree()["body"][0]["radius"] == "1 Rsun" and bodies.positions.shape == (1, 3)


@pytest.mark.parametrize("wrong, kind, message", [
    ({"m": 1, "color": "red"}, TypeError, "no 'color'"),
    ({"m": 1, "incl": 0.1, "a": 1}, TypeError, "did you mean 'inc'"),
    ({"a": 1, "h": 0.1}, TypeError, "variables of Pal"),
    ({"a": 1, "M": 0.1, "f": 0.1}, TypeError, "M and f are given"),
    ({"a": 1, "E": 0.1, "theta": 0.1}, TypeError, "theta and E are given"),
    ({"x": [1, 0, 0], "y": 2}, TypeError, "x has three numbers, and y"),
    ({"q": 1, "e": 1, "E": 0.1}, ValueError, "parabola"),
    ({"a": 1, "e": "0.3 au"}, ValueError, "0.3 au"),
    ({}, TypeError, "says nothing"),
    ({"name": "Mars"}, TypeError, "nt.bodies.horizons"),
    ({"a": 1, "primary": 7}, IndexError, "no body 7"),
])
def test_a_wrong_body_raises(wrong, kind, message):
    bodies = nt.Particles()
    bodies.add("star", m=1)
    with pytest.raises(kind, match=message):
        bodies.add(**wrong)
        bodies.positions


@pytest.mark.parametrize("which, kind, message", [
    ("Jupitr", KeyError, "did you mean 'Jupiter'"), (9, IndexError, "no body 9"), (1.5, TypeError, "1.5 is not a body")])
def test_a_wrong_place_raises(which, kind, message):
    bodies = nt.bodies.solar_system()
    for look in (lambda: bodies[which], lambda: bodies.elements("Saturn", which), lambda: bodies.elements([which, "Saturn"])):
        with pytest.raises(kind, match=message):
            look()


def test_arrays_become_bodies_to_the_bit():
    rng = np.random.default_rng(5)
    m, x, v = rng.random(4), rng.normal(size=(4, 3)), rng.normal(size=(4, 3))
    for units in ("solar", "si", "reduced", "molecular"):
        bodies = nt.Particles.from_arrays(m, x, v, list("abcd"), units=units)
        assert (bodies.masses == m).all() and (bodies.positions == x).all() and (bodies.velocities == v).all()
        assert bodies.names == list("abcd")
    with pytest.raises(ValueError, match=r"\(4, 2\)"):
        nt.Particles.from_arrays(m, x[:, :2], v)
    with pytest.raises(ValueError, match="1 names for 4"):
        nt.Particles.from_arrays(m, x, v, ["a"])


def test_a_simulation_has_its_particles_where_they_stand():
    bodies = nt.Particles(frame="barycenter")
    bodies.add("star", m=1)
    bodies.add("planet", m=1e-3, a=1, e=0.3)
    bodies.add("tracer", a=3, e=0.1, f=2)
    sim = nt.Simulation(bodies, method="verlet_aba", hamiltonian="wisdom_holman", step=0.05)
    sim.record_frames(1)
    sim.run(200)
    planet, frames = sim.particles["planet"], sim.frames
    assert (planet.x == sim.positions[1]).all() and [one.name for one in sim.particles] == ["star", "planet", "tracer"]
    assert planet.a == frames.elements("planet").a[-1] == sim.elements("planet").a
    every = frames.elements()
    assert every.e.shape == (201, 2) and (every.e[:, 1] == frames.elements("tracer").e).all()
    start = bodies.elements("planet")
    assert planet.a == pytest.approx(start.a, rel=1e-2) and planet.l != start.l
    sim.run(1)
    assert (planet.x == sim.positions[1]).all()  # it moves along
    with pytest.raises(KeyError, match="did you mean 'planet'"):
        frames.elements("plnet")


def test_quantities_of_astropy_are_elements():
    u = pytest.importorskip("astropy.units")
    body = one_orbit("solar", a=778e6 * u.km, e=0.05, inc=1.3 * u.deg)
    assert body.a == pytest.approx(778e6 / 149597870.7, rel=1e-14) and body.inc == pytest.approx(math.radians(1.3), rel=1e-12)
