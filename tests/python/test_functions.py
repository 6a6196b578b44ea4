"""Forces of one's own: compiled, by ctypes, in Python. They move bodies as the built-in force does."""

import ctypes
import math

import numpy
import pytest

import noether as nt

numba = pytest.importorskip("numba")


def three_bodies():
    bodies = nt.Particles(units="reduced")
    bodies.add("Sun", m=1)
    bodies.add("inner", m=1e-3, a=1, e=0.1)
    bodies.add("outer", m=3e-4, a=1.8, e=0.05, inc=0.1, M=1)
    return bodies


@pytest.fixture(scope="module")
def compiled_gravity():
    @numba.cfunc(nt.force_signature())
    def gravity(n, stride, t, x_, v_, m_, a_, user):
        x, a, m = numba.carray(x_, (3, stride)), numba.carray(a_, (3, stride)), numba.carray(m_, n)
        energy = 0.0
        for i in range(n):
            for j in range(i):
                dx, dy, dz = x[0, j] - x[0, i], x[1, j] - x[1, i], x[2, j] - x[2, i]
                r2 = dx * dx + dy * dy + dz * dz
                w = 1 / (r2 * math.sqrt(r2))
                a[0, i] += m[j] * w * dx
                a[1, i] += m[j] * w * dy
                a[2, i] += m[j] * w * dz
                a[0, j] -= m[i] * w * dx
                a[1, j] -= m[i] * w * dy
                a[2, j] -= m[i] * w * dz
                energy -= m[i] * m[j] / math.sqrt(r2)
        return energy

    return gravity


def numpy_gravity(t, x, v, m, a):
    d = x[None] - x[:, None]
    r2 = (d ** 2).sum(axis=2)
    numpy.fill_diagonal(r2, numpy.inf)
    a[:] = (m[None, :, None] * d / r2[..., None] ** 1.5).sum(axis=1)
    return -0.5 * (m[:, None] * m[None] / numpy.sqrt(r2)).sum()


def run_with(force, steps=2000):
    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    sim.add_force(force)
    sim.every(10, nt.Energy())
    sim.run(steps)
    return sim


@pytest.fixture(scope="module")
def built_in():
    return run_with(nt.Gravity())


def test_signature_is_that_of_the_documentation():
    signature = nt.force_signature()
    assert str(signature) == ("(int64, int64, float64, float64*, float64*, float64*, float64*, void*) -> float64"
                              ) or signature.return_type == numba.types.float64 and len(signature.args) == 8
    assert [str(one) for one in signature.args[:3]] == ["int64", "int64", "float64"]


def test_compiled_gravity_moves_bodies_as_the_built_in(compiled_gravity, built_in):
    sim = run_with(compiled_gravity)
    assert numpy.abs(sim.positions - built_in.positions).max() < 1e-11
    assert abs(built_in.positions[1, 0] - three_bodies().positions[1, 0]) > 1e-3  # something has moved
    mine, own = sim.monitors["energy"], built_in.monitors["energy"]
    assert mine["first"] == pytest.approx(own["first"], rel=1e-14)
    assert mine["worst"] == pytest.approx(own["worst"], rel=1e-6)


def test_python_gravity_moves_bodies_as_the_built_in(built_in):
    sim = run_with(numpy_gravity)
    assert numpy.abs(sim.positions - built_in.positions).max() < 1e-11
    assert sim.monitors["energy"]["first"] == pytest.approx(built_in.monitors["energy"]["first"], rel=1e-14)


def test_a_function_of_ctypes_is_called_by_its_address():
    calls = []

    def pull(n, stride, t, x, v, m, a, user):
        calls.append(user)
        for i in range(n):
            for k in range(3):
                a[k * stride + i] -= x[k * stride + i]
        return 0.5 * sum(m[i] * x[k * stride + i] ** 2 for i in range(n) for k in range(3))

    bodies = nt.Particles()
    bodies.add("bob", m=1, x=[1, 0.5, 0], v=[0, 0, 0])
    sim = nt.Simulation(bodies, method="verlet", step=0.01)
    sim.add_force(nt.functions.force_type()(pull))
    sim.run(314)
    assert sim.positions[0] == pytest.approx([-1, -0.5, 0], abs=1e-3)
    assert calls and calls[0] is None


class Overboard(Exception):
    pass


def test_exceptions_come_out_as_raised():
    def force(t, x, v, m, a):
        if t > 0.5:
            raise Overboard(t)
        return 0.0

    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    sim.add_force(force)
    with pytest.raises(Overboard) as raised:
        sim.run(1000)
    assert 0.5 < raised.value.args[0] < 0.53
    assert sim.time == pytest.approx(0.5, abs=0.02)  # the last whole step before


def test_a_run_goes_on_after_an_exception_that_does_not_come_again():
    patience = [40]

    def force(t, x, v, m, a):
        patience[0] -= 1
        if patience[0] == 0:
            raise KeyboardInterrupt
        a[:] = -x
        return 0.5 * float((m[:, None] * x ** 2).sum())

    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    sim.add_force(force)
    with pytest.raises(KeyboardInterrupt):
        sim.run(100)
    assert sim.step < 100
    assert sim.run(100 - sim.step).ok
    undisturbed = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    undisturbed.add_force(lambda t, x, v, m, a: (numpy.copyto(a, -x), 0.5 * float((m[:, None] * x ** 2).sum()))[1])
    undisturbed.run(100)
    assert sim.digest == undisturbed.digest


def test_of_two_functions_that_raise_none_comes_out_later():
    broken = [False]

    def force(t, x, v, m, a):
        if broken[0]:
            raise Overboard(t)
        return 0.0

    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    sim.add_force(force)
    sim.add_force(lambda *given: force(*given))
    scene = sim.scene
    broken[0] = True
    with pytest.raises(Overboard):
        scene.evaluate()
    broken[0] = False
    assert scene.evaluate()["schema"] == "noether.evaluate/1"


def test_a_monitor_may_return_an_array_of_one_number_without_dimension():
    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    sim.add_force(nt.Gravity())
    sim.every(1, lambda t, x, v, m: numpy.array(t), names="moment")
    sim.run(2)
    assert sim.series("user_monitor").moment.tolist() == [0, 0.01, 0.02]


def test_a_monitor_that_raises_ends_the_run_where_it_looked():
    def watch(t, x, v, m):
        if t > 0.5:
            raise Overboard(t)
        return x[0, 0]

    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    sim.add_force(nt.Gravity())
    sim.every(10, watch)
    with pytest.raises(Overboard):
        sim.run(100_000)
    assert sim.step == 60


def test_a_force_without_its_energy_says_so():
    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    sim.add_force(lambda t, x, v, m, a: None)
    with pytest.raises(TypeError, match="return its potential energy, or say energy=False"):
        sim.run(1)


def test_views_are_not_writable_where_the_force_must_not_write():
    def force(t, x, v, m, a):
        x[0] = 1
        return 0.0

    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    sim.add_force(force)
    with pytest.raises(ValueError, match="read-only"):
        sim.run(1)


def test_cost_of_a_step_is_told(compiled_gravity):
    compiled = nt.functions.time_per_step(compiled_gravity, three_bodies(), seconds=0.02)
    python = nt.functions.time_per_step(numpy_gravity, three_bodies(), seconds=0.02)
    assert 1e-8 < compiled < 1e-5
    assert python > 5 * compiled


def test_a_force_that_fails_cannot_be_timed():
    def force(t, x, v, m, a):
        raise Overboard

    with pytest.raises(Overboard):
        nt.functions.time_per_step(force, three_bodies())


def test_a_wrong_function_is_refused():
    sim = nt.Simulation(three_bodies(), method="verlet", step=0.01)
    with pytest.raises(TypeError, match="42 is not a force"):
        sim.add_force(42)
