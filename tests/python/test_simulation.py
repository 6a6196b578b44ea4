"""Simulations object by object: the bits of scenes, views without copies, edits, functions of one's own, lifetimes."""

import ctypes
import gc
import resource
import subprocess
import sys
import weakref

import numpy
import pytest

import noether as nt


def kepler(bodies, method="verlet", step=0.01, **options):
    sim = nt.Simulation(bodies, method=method, step=step, **options)
    sim.add_force(nt.Gravity())
    return sim


def test_a_simulation_has_the_bits_of_its_scene(two_bodies):
    sim = kepler(two_bodies, "yoshida_4")
    sim.every(10, nt.Energy())
    assert sim.run(500).ok
    report = nt.run(sim, set={"integrator.steps": 500}, out="out")
    assert report.digest == sim.digest
    assert report.monitors.energy.worst == sim.monitors["energy"]["worst"]


def test_figure_eight_by_objects():
    bodies = nt.Particles()
    bodies.add("red", m=1, x=[0.97000436, -0.24308753, 0], v=[0.466203685, 0.43236573, 0])
    bodies.add("green", m=1, x=[-0.97000436, 0.24308753, 0], v=[0.466203685, 0.43236573, 0])
    bodies.add("blue", m=1, x=[0, 0, 0], v=[-0.93240737, -0.86473146, 0])
    sim = kepler(bodies, "srkn14a", 0.01581478495)
    sim.every(10, "energy")
    sim.run(1000)
    sim.run(3000)
    # What the example's README shows.
    assert sim.digest == "sha256:d11e8def73cbfd5e91d3afcca2bfe7c3539c8909d637bf8338cfae50f6040f16"


def test_solar_units_and_texts():
    bodies = nt.Particles(units="solar")
    bodies.add("Sun", m=1)
    bodies.add("Jupiter", m="1 Mjup", a=5.2, e=0.05)
    sim = nt.Simulation(bodies, method="aba_10_6_4", hamiltonian=nt.WisdomHolman(), step="5 day", compensated=True)
    sim.add_force(nt.Oblateness(J2=2e-7, radius="695700 km"))
    sim.every("1 yr", nt.Energy())
    assert sim.run(until="100 day").step == 20
    assert sim.time == 100
    again = nt.Particles(units="solar")
    again.add("Sun", m=1)
    again.add("Jupiter", m="1 Mjup", a=5.2, e=0.05)
    plain = nt.Simulation(again, method="aba_10_6_4", hamiltonian="wisdom_holman", step=5, compensated=True)
    plain.add_force(nt.forces.Oblateness(J2=2e-7, radius=695700 / 149597870.7))
    plain.run(20)
    assert numpy.allclose(plain.positions, sim.positions, rtol=1e-14)


def test_positions_are_views_of_the_run(two_bodies):
    sim = kepler(two_bodies)
    x, before = sim.positions, sim.positions.copy()
    assert x.shape == (2, 3) and not x.flags.writeable and x.strides == (8, 64)
    sim.run(100)
    assert (x != before).any() and numpy.shares_memory(x, sim.positions)
    with pytest.raises(ValueError, match="read-only"):
        x[0, 0] = 1
    gone = weakref.ref(sim)
    del sim
    gc.collect()
    assert gone() is None and numpy.isfinite(x).all()  # the view keeps what it shows alive


def test_edits(two_bodies):
    sim = kepler(two_bodies)
    sim.run(10)
    with sim.edit() as state:
        state.velocities[1] *= 2
    speed = sim.velocities[1].copy()
    sim.edit(lambda x, v, m: numpy.multiply(v, 0.5, out=v))
    assert (sim.velocities[1] == 0.5 * speed).all()
    held = sim.digest
    with pytest.raises(ZeroDivisionError):
        sim.edit(lambda x, v, m: (x.fill(9), 1 / 0))
    assert sim.digest == held
    sim.change_step(0.001)
    assert sim.run(10).step == 20


def test_series_and_frames_in_memory(two_bodies):
    sim = kepler(two_bodies, "gauss_8", 0.05, adaptive=False)
    sim.every(2, nt.Energy())
    sim.every(4, lambda t, x, v, m: (x[1, 0] - x[0, 0], t), names=["distance", "when"])
    sim.every(5, lambda t, x, v, m: m.sum())
    sim.record_frames(10)
    sim.run(40)
    assert list(sim.series("energy").time) == pytest.approx([0.1 * k for k in range(21)])
    own = sim.series("user_monitor")
    assert own.distance[0] == 1 and (own.when == own.time).all()
    assert sim.frames.positions.shape == (5, 2, 3) and (sim.frames.positions[-1] == sim.positions).all()
    assert sim.frames.elements(1, 0)["a"] == pytest.approx(1, abs=1e-9)
    with pytest.raises(KeyError, match="did you mean 'energy'"):
        sim.series("energi")


def test_files_of_a_simulation(two_bodies):
    with kepler(two_bodies) as sim:
        sim.every(10, nt.Trajectory(file="mine.h5"))
        sim.every(10, nt.Energy())
        sim.run(100)
    run = nt.open_run("mine.h5")
    assert len(run.frames) == 11 and (run.frames.positions[-1] == sim.positions).all()
    assert nt.verify("mine.h5").complete and run.monitors == ["energy"]


# ---- functions of one's own -----------------------------------------------------------------------------------------


def gravity(t, x, v, m, a):
    r = x[1] - x[0]
    cube = numpy.dot(r, r) ** 1.5
    a[0], a[1] = m[1] * r / cube, -m[0] * r / cube
    return -m[0] * m[1] / numpy.sqrt(numpy.dot(r, r))


def test_a_force_in_python(two_bodies):
    own = nt.Simulation(two_bodies, method="yoshida_8", step=0.01)
    own.add_force(gravity, keeps_momentum=True, keeps_angular_momentum=True)
    own.every(10, nt.Energy())
    built_in = kepler(two_bodies, "yoshida_8")
    own.run(628)
    built_in.run(628)
    assert abs(own.positions - built_in.positions).max() < 1e-13
    assert own.monitors["energy"]["worst"] < 1e-12
    told = own.compare(methods=["verlet"], until=1.0, budget=1)
    assert "113" in told.truth.note or "double" in told.truth.note


SIGNATURE = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_int64, ctypes.c_int64, ctypes.c_double,
                             *[ctypes.POINTER(ctypes.c_double)] * 4, ctypes.c_void_p)


def test_a_force_by_its_address(two_bodies):
    @SIGNATURE
    def spring(n, stride, t, x, v, m, a, user):
        energy = 0.0
        for i in range(n):
            for k in range(3):
                a[i + k * stride] = -x[i + k * stride] / m[i]
                energy += x[i + k * stride] ** 2 / 2
        return energy

    own = nt.Simulation(two_bodies, method="verlet", step=0.01)
    own.add_force(spring)
    own.every(1, nt.Energy())
    built_in = nt.Simulation(two_bodies, method="verlet", step=0.01)
    built_in.add_force(nt.HarmonicField(k=1))
    own.run(100)
    built_in.run(100)
    assert own.digest == built_in.digest
    assert own.monitors["energy"]["worst"] < 1e-4


def test_what_a_force_raises_comes_out_and_the_state_is_the_last_whole_step(two_bodies):
    broken = [True]

    def breaks(t, x, v, m, a):
        if broken[0] and t > 0.075:
            raise ZeroDivisionError("my force broke")
        return gravity(t, x, v, m, a)

    sim = nt.Simulation(two_bodies, method="verlet", step=0.01)
    sim.add_force(breaks)
    with pytest.raises(ZeroDivisionError, match="my force broke"):
        sim.run(100)
    assert sim.step == 7 and numpy.isfinite(sim.velocities).all()
    broken[0] = False
    reference = nt.Simulation(two_bodies, method="verlet", step=0.01)
    reference.add_force(gravity)
    reference.run(sim.step)
    assert reference.digest == sim.digest
    sim.run(10)
    reference.run(10)
    assert reference.digest == sim.digest


def test_a_monitor_that_raises(two_bodies):
    sim = kepler(two_bodies)
    sim.every(5, lambda t, x, v, m: {}["nothing"])
    with pytest.raises(KeyError, match="nothing"):
        sim.run(10)


def test_a_force_that_returns_no_energy(two_bodies):
    sim = nt.Simulation(two_bodies, method="verlet", step=0.01)
    sim.add_force(lambda t, x, v, m, a: None)
    with pytest.raises(TypeError, match="energy=False"):
        sim.run(1)
    fine = nt.Simulation(two_bodies, method="verlet", step=0.01)
    fine.add_force(lambda t, x, v, m, a: None, energy=False)
    assert fine.run(1).ok


def test_a_force_cannot_touch_the_run_that_calls_it(two_bodies):
    sim = nt.Simulation(two_bodies, method="verlet", step=0.01)
    sim.add_force(lambda t, x, v, m, a: sim.positions.sum())
    with pytest.raises(RuntimeError, match="the simulation is running"):
        sim.run(1)


def pendulum(constrain):
    bodies = nt.Particles()
    bodies.add("bob", m=1, x=[0.6, 0, -0.8], v=[0, 1, 0])
    sim = nt.Simulation(bodies, method="yoshida_4", step=0.02)
    sim.add_force(nt.UniformField(acceleration=[0, 0, -1]))
    constrain(sim)
    sim.every(1, nt.Energy())
    sim.run(200)
    return sim


def test_a_constraint_in_python():
    built_in = pendulum(lambda sim: sim.add_constraint(nt.OnSphere(bodies=["bob"], radius=1)))
    own = pendulum(lambda sim: sim.add_constraint(lambda x: (x[0] @ x[0] - 1) / 2, ["bob"]))
    assert abs(own.positions - built_in.positions).max() < 1e-13
    rooted = pendulum(lambda sim: sim.add_constraint(lambda x: numpy.sqrt(x[0, 0]**2 + x[0, 1]**2 + x[0, 2]**2) - 1, "bob"))
    assert abs(rooted.positions - built_in.positions).max() < 1e-12
    assert own.monitors["energy"]["worst"] < 1e-6


def test_a_constraint_that_raises():
    import math

    with pytest.raises(TypeError, match="NumPy's functions, not those of math"):
        pendulum(lambda sim: sim.add_constraint(lambda x: math.sqrt(x[0, 0]**2 + x[0, 1]**2 + x[0, 2]**2) - 1, "bob"))
    with pytest.raises(ValueError, match="one to four particles"):
        pendulum(lambda sim: sim.add_constraint(lambda x: 0.0, ["bob"] * 5))


def test_dual_numbers():
    from noether.duals import Dual

    x = Dual(Dual(0.7, [1.0]), [Dual(1.0, [0.0])])
    for f, d, dd in [(lambda x: numpy.sin(x) * x, lambda x: numpy.cos(x) * x + numpy.sin(x), lambda x: 2 * numpy.cos(x) - numpy.sin(x) * x),
                     (lambda x: 1 / (1 + x**2), lambda x: -2 * x / (1 + x**2)**2, lambda x: (6 * x**2 - 2) / (1 + x**2)**3),
                     (lambda x: numpy.exp(2 * x), lambda x: 2 * numpy.exp(2 * x), lambda x: 4 * numpy.exp(2 * x)),
                     (lambda x: numpy.arctan2(x, 2.0), lambda x: 2 / (4 + x**2), lambda x: -4 * x / (4 + x**2)**2),
                     (lambda x: numpy.sqrt(x), lambda x: 0.5 * x**-0.5, lambda x: -0.25 * x**-1.5)]:
        y = f(numpy.array([x], dtype=object))[0]
        assert abs(y.value.value - f(0.7)) < 1e-15
        assert abs(y.slopes[0].value - d(0.7)) < 1e-14 and abs(y.slopes[0].slopes[0] - dd(0.7)) < 1e-13


# ---- lifetimes ------------------------------------------------------------------------------------------------------


def test_a_file_that_was_closed_stays_complete_when_its_simulation_is_gone(two_bodies):
    sim = kepler(two_bodies)
    sim.every(1, nt.Trajectory(file="closed.h5"))
    sim.run(10)
    sim.close()
    sim.run(10)  # which goes on with the file
    sim.close()
    del sim
    gc.collect()
    assert nt.info("closed.h5").complete


def test_cycles_are_collected(two_bodies):
    class Force:
        def __call__(self, t, x, v, m, a):
            return 0.0

    force = Force()
    sim = nt.Simulation(two_bodies, method="verlet", step=0.01)
    force.sim = sim  # a cycle through C++
    sim.add_force(force)
    sim.run(3)
    gone = weakref.ref(force)
    del sim, force
    gc.collect()
    assert gone() is None


def test_a_cycle_of_a_simulation_that_has_not_begun_is_collected(two_bodies):
    def made():
        held = []
        sim = nt.Simulation(two_bodies, method="verlet", step=0.01)
        sim.add_force(lambda t, x, v, m, a: float(len(held)))
        held.append(sim)
        return weakref.ref(sim)

    gone = made()
    gc.collect()
    assert gone() is None


def test_a_scene_that_is_collected_leaves_its_functions_to_the_simulation(two_bodies):
    sim = nt.Simulation(two_bodies, method="verlet", step=0.01)
    sim.add_force(lambda t, x, v, m, a: 0.0)
    sim.run(1)
    held = sim.scene._held
    cycle = [held]
    cycle.append(cycle)  # the collector takes it apart
    del held, cycle
    gc.collect()
    assert sim.run(1).ok


def test_nothing_is_left_at_the_end():
    code = """
import noether as nt
bodies = nt.Particles(); bodies.add(m=1, x=[0,0,0], v=[0,0,0]); bodies.add(m=1, x=[1,0,0], v=[0,1,0])
sim = nt.Simulation(bodies, method="verlet", step=0.01)
sim.add_force(lambda t, x, v, m, a: 0.0); sim.every(1, lambda t, x, v, m: t); sim.run(10)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr == ""


def test_a_thousand_simulations_leave_no_memory(two_bodies):
    def one():
        sim = kepler(two_bodies)
        sim.every(1, nt.Energy())
        sim.add_force(lambda t, x, v, m, a: 0.0)
        sim.run(2)

    for _ in range(200):
        one()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(1000):
        one()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 2000  # kB


# ---- outcomes -------------------------------------------------------------------------------------------------------


def test_a_run_that_fails_warns_and_tells():
    bodies = nt.Particles()
    bodies.add(m=1, x=[0, 0, 0], v=[0, 0, 0])
    bodies.add(m=1e-3, x=[1, 0, 0], v=[0, 0, 0])  # falls into the other
    sim = kepler(bodies, "dormand_prince_5", None)
    with pytest.warns(nt.RunWarning, match="step_underflow"):
        outcome = sim.run(until=10)
    assert not outcome and outcome.kind == "step_underflow" and outcome.time < 1.2


def test_stops():
    bodies = nt.Particles()
    bodies.add("a", m=1, x=[0, 0, 0], v=[0, 0, 0])
    bodies.add("b", m=1e-3, x=[1, 0, 0], v=[0, 2, 0])
    sim = kepler(bodies)
    sim.stop_when(nt.Escape(distance=3))
    outcome = sim.run(10_000)
    assert outcome.ok and outcome.kind == "stopped" and outcome.particle == "b"


def test_systems():
    sim = nt.Simulation(system=nt.Lorenz(), method="dop853", rtol=1e-10)
    sim.run(until=1.0)
    assert sim.variables.shape == (3,) and sim.time == 1.0


def test_progress(two_bodies):
    told = []
    sim = kepler(two_bodies)
    sim.run(2_000_000, progress=lambda step, time, seconds: told.append(step))
    assert told == sorted(told)
    sim.run(10, progress=True)
