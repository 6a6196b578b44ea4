"""Wrong calls: each raises one exception of a fitting class, with the message that a scene would get."""

import numpy
import pytest

import noether as nt


def bodies():
    made = nt.Particles()
    made.add("star", m=1, x=[0, 0, 0], v=[0, 0, 0])
    made.add("planet", m=1e-3, a=1, e=0.1)
    return made


def solar():
    made = nt.Particles(units="solar")
    made.add("Sun", m=1)
    made.add("Earth", m=3e-6, a=1)
    return made


def simulation(**options):
    given = {"method": "verlet", "step": 0.01, **options}
    sim = nt.Simulation(bodies(), **given)
    sim.add_force(nt.Gravity())
    return sim


WRONG = [
    (lambda: nt.run("nothing.toml"), nt.FileError, "nothing.toml: cannot be read"),
    (lambda: nt.run("figure_eight", set={"integrator.metod": "verlet"}), nt.Error, "did you mean 'method'"),
    (lambda: nt.run("figure_eight", set={"integrator.method": "verlett"}), nt.Error, "did you mean 'verlet'"),
    (lambda: nt.run("figure_eight", set={"integrator.step": "fast"}), nt.Error, "'fast'"),
    (lambda: nt.run("figure_eight", until="10 day"), nt.Error, "day"),
    (lambda: nt.run("figure_eight", existing="overwrite"), ValueError, "'keep', 'resume', 'fresh'"),
    (lambda: nt.run({"units": "imperial"}), nt.Error, "imperial"),
    (lambda: nt.run({"units": "solar", 3: 4}), TypeError, "the key 3 is not a text"),
    (lambda: nt.run({"units": "reduced", "particles": {"body": object()}}), TypeError, "particles.body"),
    (lambda: nt.run({}), nt.Error, "units"),
    (lambda: nt.example("figur_eight"), FileNotFoundError, "did you mean 'figure_eight'"),
    (lambda: nt.LennardJons, AttributeError, "did you mean 'LennardJones'"),
    (lambda: nt.forces.LennardJons, AttributeError, "did you mean 'LennardJones'"),
    (lambda: nt.LennardJones(cutof=1), TypeError, "did you mean 'cutoff'"),
    (lambda: nt.LennardJones(), TypeError, "needs cutoff"),
    (lambda: nt.Particles(units="imperial"), nt.Error, "imperial"),
    (lambda: nt.Particles(boxx=[1, 1, 1]), TypeError, "did you mean 'box'"),
    (lambda: nt.Particles("nothing.csv").positions, nt.FileError, "nothing.csv"),
    (lambda: wrong_body(m=1, a=-1, e=0.5), nt.Error, "expected a > 0"),
    (lambda: wrong_body(), TypeError, "says nothing about the body"),
    (lambda: wrong_body(m=-1, a=2), nt.Error, "mass"),
    (lambda: wrong_body(m=1, a=2, ecc=0.1), TypeError, "did you mean 'e'"),
    (lambda: wrong_body("star", m=1, a=2), nt.Error, "star"),
    (lambda: wrong_body(m=1, x=[1, 2], v=[0, 0, 0]), nt.Error, "x"),
    (lambda: wrong_body(m=1, a=2, about="stra"), nt.Error, "did you mean 'star'"),
    (lambda: wrong_body(m=float("nan"), a=2), nt.Error, "nan"),
    (lambda: bodies()["plant"], KeyError, "did you mean 'planet'"),
    (lambda: nt.Simulation(method="verlet"), TypeError, "particles, or a system"),
    (lambda: nt.Simulation([1, 2], method="verlet"), TypeError, "nt.Particles, not list"),
    (lambda: nt.Simulation(bodies(), method="verlet", stp=0.1), TypeError, "did you mean 'step'"),
    (lambda: nt.Simulation(bodies(), method="verlet", hamiltonian="wisdom_holmann"), ValueError, "did you mean 'wisdom_holman'"),
    (lambda: nt.Simulation(bodies(), method="verlet", hamiltonian=nt.Gravity()), TypeError, "Gravity is a force"),
    (lambda: simulation(method="verlett").run(1), nt.Error, "did you mean 'verlet'"),
    (lambda: simulation(step=0).run(1), nt.Error, "a step of 0 is not valid"),
    (lambda: simulation(step="5 day").run(1), nt.Error, "day"),
    (lambda: simulation(step=None).run(1), nt.Error, "step"),
    (lambda: simulation(corrector=4).run(1), nt.Error, "corrector"),
    (lambda: simulation().run(), TypeError, "steps, or until"),
    (lambda: simulation().run(10, until=1), TypeError, "steps, or until"),
    (lambda: simulation().run(until=0.0123), nt.Error, "whole number"),
    (lambda: simulation().run(until="1 day"), nt.Error, "day"),
    (lambda: simulation().run(-1), nt.Error, "-1"),
    (lambda: simulation().run(2.5), ValueError, "2.5 is not a whole number of steps"),
    (lambda: simulation().run("1 yr"), ValueError, "a time is given by until"),
    (lambda: simulation().every(1, lambda t, x, v, m: (1, 2), names=["a", "a"]), ValueError, "a name twice"),
    (lambda: simulation().add_force("gravitation"), ValueError, "did you mean 'gravity'"),
    (lambda: simulation().add_force(nt.Energy()), TypeError, "Energy is a monitor"),
    (lambda: simulation().add_force(3), TypeError, "3 is not a force"),
    (lambda: simulation().every(0, nt.Energy()).run(1), nt.Error, "0"),
    (lambda: simulation().every(10, "energi"), ValueError, "did you mean 'energy'"),
    (lambda: simulation().every("1 day", nt.Energy()).run(1), nt.Error, "day"),
    (lambda: simulation().every(1, nt.Pressure()).run(1), nt.Error, "pressure"),
    (lambda: simulation().every(1, nt.ShadowHamiltonian(orders=[3])).run(1), nt.Error, "orders"),
    (lambda: begun().add_force(nt.Gravity()), RuntimeError, "the run has begun"),
    (lambda: begun().edit(lambda x, v, m: x.fill(numpy.nan)), nt.Error, "not finite"),
    (lambda: nt.compare("figure_eight", methods=["verlett"]), nt.Error, "did you mean 'verlet'"),
    (lambda: nt.advise("figure_eight", -1), nt.Error, "-1"),
    (lambda: nt.advise("figure_eight", 1e-3, metric="speed"), ValueError, "'position' or 'energy'"),
    (lambda: nt.stability("figure_eight", methods=["verlett"]), nt.Error, "did you mean 'verlet'"),
    (lambda: nt.verify("nothing.h5"), nt.FileError, "there is no such file"),
    (lambda: nt.open_run("nothing.h5"), nt.FileError, "nothing.h5"),
    (lambda: nt.threads(0), nt.Error, "0"),
]



def wrong_body(name=None, **values):
    made = bodies()
    made.add(name, **values)
    return made.positions


def begun():
    sim = simulation()
    sim.run(1)
    return sim


@pytest.mark.parametrize("call, kind, message", WRONG, ids=[f"{k}-{one[2]}" for k, one in enumerate(WRONG)])
def test_a_wrong_call_raises_one_line(call, kind, message):
    with pytest.raises(kind) as raised:
        call()
    text = str(raised.value)
    assert message in text
    assert "\n" not in text and not text.endswith(".")


def test_there_are_as_many_as_promised():
    assert len(WRONG) >= 40
    assert issubclass(nt.Error, ValueError) and issubclass(nt.FileError, OSError) and issubclass(nt.FileError, nt.Error)
