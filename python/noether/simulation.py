"""A run, object by object."""

import os
import warnings as _warnings
import weakref

from . import _core, parts, particles as _particles, quantities
from .progress import Progress


class RunWarning(UserWarning):
    """A run ended otherwise than asked: it diverged, a solver found nothing, particles overlapped."""


class Outcome:
    """How a run ended. `ok`: as asked, or by a stop of its own."""

    def __init__(self, told):
        self.kind, self.text, self.ok = told["outcome"], told["text"], told["ok"]
        self.message, self.step, self.time = told["message"], told["step"], told["time"]
        self.particle = told.get("particle")

    def __repr__(self):
        return f"<{self.text}>"

    def __bool__(self):
        return self.ok


def _function_of(function):
    """A function as the engine calls it: compiled, by its address, or as Python has it."""
    import ctypes

    address = getattr(function, "address", None)
    if address is None and isinstance(function, ctypes._CFuncPtr):
        address = ctypes.cast(function, ctypes.c_void_p).value
    return _core.function(function, int(address or 0))


def _whole(steps):
    """A number of steps. @raise ValueError, such as for a time"""
    try:
        whole = int(steps)
    except (TypeError, ValueError, OverflowError):
        whole = None
    if whole != steps:
        raise ValueError(f"{steps!r} is not a whole number of steps; a time is given by until, such as until='1 kyr'")
    return whole


class Simulation:
    """A simulation of particles, or of a system of first order.

    Parameters
    ----------
    particles : Particles
    method : str or nt.methods.NAME(...)
        a scheme or a method: "verlet", "aba_10_6_4", "gauss_8", ...
    hamiltonian : a Hamiltonian or its name; default: kinetic_potential, p^2/2m and all forces
    step : the length of a step, as a number in the units of the particles, or a text such as "5 day"; methods that choose
        their steps need none
    system : a system of first order, in place of the particles
    start_time, **options : further keys of [integrator]: compensated, corrector, rtol, ...

    Nothing is computed before the first `run`, or the first look at the state: then everything is checked at once, and what
    is wrong raises `nt.Error` with the message that a scene would get.
    """

    def __init__(self, particles=None, *, method, hamiltonian=None, step=None, system=None, units=None, title="",
                 thermostat=None, **options):
        if (particles is None) == (system is None):
            raise TypeError("a simulation has particles, or a system; give one of the two")
        if particles is not None and not isinstance(particles, _particles.Particles):
            raise TypeError(f"particles are nt.Particles, not {type(particles).__name__}")
        self._particles, self.title = particles, title
        self._units = particles.units if particles is not None else (units or "reduced")
        self._system = None if system is None else parts.as_part(system, "system", "systems")
        self._hamiltonian = parts.as_part("kinetic_potential" if hamiltonian is None else hamiltonian, "hamiltonian",
                                          "hamiltonians")
        self._thermostat = None if thermostat is None else parts.as_part(thermostat, "thermostat", "thermostats")
        if isinstance(method, type) and issubclass(method, parts.Method):
            method = method()
        if isinstance(method, parts.Method):
            options = {**method.options, **options}
            method = method.name
        fields = parts.table_fields("[integrator]")
        for key in options:
            if key not in fields and key not in parts.described().get("decorator", {}):
                raise TypeError(f"a simulation has no keyword {key!r}{parts._proposal(key, fields)}")
        given = {"step": step, **options}
        self._integrator = {"method": method, **{
            key: quantities.with_units(value, fields.get(key, {}).get("dimension", "1"), self._units)
            for key, value in given.items() if value is not None}}
        self._forces, self._fields, self._constraints, self._stops, self._every = [], [], [], [], []
        self._decorators, self._functions, self._files = [], [], {}
        self._frame_cadences = []
        self._held = self._scene = None

    # ---- what it is made of -----------------------------------------------------------------------------------------

    def add_force(self, force, *, energy=True, velocity_dependent=False, time_dependent=False, dissipative=False,
                  keeps_momentum=False, keeps_angular_momentum=False, periodic=False):
        """Adds a force: one of `nt.forces` or its name, or a function of your own.

        A Python function is called as `f(t, x, v, m, a)`: it fills the accelerations `a`, shape (n, 3), which are 0, and
        returns the potential energy. The arrays hold only until it returns: keep copies. It costs a microsecond a call and
        what NumPy takes. A compiled function, such as numba's `@cfunc`, costs what C++ does:

            double f(int64_t n, int64_t stride, double t, const double* x, const double* v, const double* m, double* a,
                     void* user)

        x, v and a have n numbers for x, `stride` further on n for y, and so for z. `nt.force_signature()` is this for
        numba. The keywords tell the engine what such a function keeps; what is not true of it makes reports wrong.
        Neither knows more digits than doubles have: `compare` says that there is no truth for it in 113 bits.
        """
        self._expect_not_begun("add_force")
        if callable(force) and not isinstance(force, type) or hasattr(force, "address"):
            function = _function_of(force)
            self._functions.append(function)
            claims = {"energy": energy, "velocity_dependent": velocity_dependent, "time_dependent": time_dependent,
                      "dissipative": dissipative, "keeps_momentum": keeps_momentum,
                      "keeps_angular_momentum": keeps_angular_momentum, "periodic": periodic}
            self._forces.append({"type": "user_force", "function": function.id, **claims})
        else:
            self._forces.append(parts.as_part(force, "force", "forces").tree(self._units))
        return self

    def add_field(self, field):
        """Adds a field that acts on charges: one of `nt.fields`."""
        self._expect_not_begun("add_field")
        self._fields.append(parts.as_part(field, "field", "fields").tree(self._units))
        return self

    def add_constraint(self, constraint, particles=None, *, scale=1.0, **solver):
        """Adds constraints of one kind: one of `nt.constraints`, or a function of your own.

        A function takes the positions of the particles that it ties, shape (particles, 3), and returns a number that stays
        0. Its derivatives are exact: positions are dual numbers (`noether.duals`), so write it with arithmetic and NumPy's
        functions. `particles` are their names: one to four, or a list of such tuples for as many constraints. `scale` is
        what the function's values are small beside. It costs some ten microseconds a call.

        solver, tolerance, iterations : as of every constraint
        """
        self._expect_not_begun("add_constraint")
        if callable(constraint) and not isinstance(constraint, type):
            self._constraints.append({**self._own_constraint(constraint, particles, scale), **solver})
            return self
        if particles is not None or solver:
            raise TypeError("particles and solvers of a constraint of nt.constraints are its own keywords, such as "
                            "nt.Distance(pairs=[['a', 'b']])")
        self._constraints.append(parts.as_part(constraint, "constraint", "constraints").tree(self._units))
        return self

    def _own_constraint(self, function, particles, scale):
        if particles is None:
            raise TypeError("a constraint of your own needs particles, such as particles=['a', 'b']")
        if isinstance(particles, str):
            particles = [particles]
        tuples = [list(one) for one in particles] if not all(isinstance(one, str) for one in particles) else [list(particles)]
        sizes = sorted({len(one) for one in tuples})
        if len(sizes) != 1 or not 1 <= sizes[0] <= 4:
            raise ValueError(f"a constraint of your own ties one to four particles, the same number each time; particles = "
                             f"{particles!r} has {', '.join(map(str, sizes))}")
        made = _function_of(function)
        self._functions.append(made)
        key, name = {1: ("bodies", "user_constraint"), 2: ("pairs", "user_constraint_of_pairs"),
                     3: ("triples", "user_constraint_of_triples"), 4: ("groups", "user_constraint_of_groups")}[sizes[0]]
        return {"type": name, "function": made.id, "scale": scale,
                key: [one[0] for one in tuples] if sizes[0] == 1 else tuples}

    def add_decorator(self, decorator):
        """Puts something around the method: one of `nt.decorators`, such as a projection."""
        self._expect_not_begun("add_decorator")
        self._decorators.append(parts.as_part(decorator, "decorator", "decorators").tree(self._units))
        return self

    def stop_when(self, stop, every=None):
        """Ends the run when something happens: one of `nt.stops`."""
        self._expect_not_begun("stop_when")
        table = parts.as_part(stop, "stop", "stops").tree(self._units)
        if every is not None:
            table["every"] = quantities.with_units(every, "time", self._units)
        self._stops.append(table)
        return self

    def every(self, cadence, monitor, *, after=None, names=None):
        """Looks at the run: every so many steps (a whole number), so much time ("10 yr", or a number in the units of the
        run), or at the times of a list.

        `monitor` is one of `nt.monitors`, a writer such as `nt.Trajectory(file="run.h5")`, or a function of your own,
        `f(t, x, v, m)`, which returns a number, or as many as there are `names`; its arrays hold only until then. Of what
        monitors tell, `series` has all.
        """
        when = self._cadence(cadence, after)
        if callable(monitor) and not isinstance(monitor, type):
            function = _function_of(monitor)
            names = [names] if isinstance(names, str) else list(names or [getattr(monitor, "__name__", "value")])
            if len(set(names)) < len(names):
                raise ValueError(f"names = {names!r} has a name twice; each number needs a name of its own")
            table = {"function": function.id, "names": names}
            name = "user_monitor"
        else:
            function, part = None, self._watcher(monitor)
            name, table = part.name, part.tree(self._units)
            table.pop("type")
            if part.kind == "writer":
                return self._write(name, table, when)
        if self._held is None:
            if function is not None:
                self._functions.append(function)
            self._every.append({"type": name, **table, **when})
        else:
            self._attach(name, table, when, function)
        return self

    def record_frames(self, cadence):
        """Keeps positions and velocities in memory, for `frames`: every so many steps, so much time, or at times."""
        self._frame_cadences.append(self._cadence(cadence, None))
        if self._held is not None:
            self._begin_frames(self._frame_cadences[-1])
        return self

    # ---- running ----------------------------------------------------------------------------------------------------

    def run(self, steps=None, *, until=None, progress=False):
        """Goes on by so many steps, or to a time. Returns an `Outcome`.

        A run that fails is no exception: the state is the last whole step before it, and a `RunWarning` tells of it.
        Ctrl-C ends it after a whole step, raises KeyboardInterrupt, and it can be gone on with. What a function of your
        own raises comes out as it is.

        progress : True shows a line (tqdm, where it is installed); a function is called as `f(step, time, seconds)`
        """
        if (steps is None) == (until is None):
            raise TypeError("run takes steps, or until; give one of the two")
        steps = None if steps is None else _whole(steps)
        held = self._begin()
        if self._files and not self._unfinished.alive:  # it goes on after close()
            self._unfinished = weakref.finalize(self, held.finish, "interrupted")
        end = None if until is None else quantities.number_of(until, "time", self._units)
        length = None if end is None else abs(end - held.time)
        with Progress(progress, steps=steps, time=length, begin=(held.step, held.time),
                      unit=_core.unit_names(self._units)[2]) as tell:
            outcome = Outcome(held.run(steps, end, tell))
        if not outcome.ok:
            _warnings.warn(outcome.text, RunWarning, stacklevel=2)
        return outcome

    def edit(self, change=None):
        """Changes the state between two runs.

        >>> with sim.edit() as state:
        ...     state.velocities[1] *= 1.01

        or `sim.edit(f)`, where `f(x, v, m)` writes into the arrays. Columns are those of all particles; a change that
        raises leaves the state as it was.
        """
        if change is not None:
            self._begin().edit(change)
            return None
        return _Edit(self._begin())

    def change_step(self, step):
        """Changes the length of the steps; time and step count go on."""
        self._begin().change_step(quantities.number_of(step, "time", self._units))

    # ---- what there is to see ---------------------------------------------------------------------------------------

    @property
    def positions(self):
        """Positions, shape (n, 3), as a view that cannot be written to; it shows where the run stands, always."""
        return self._begin().positions

    @property
    def velocities(self):
        """Velocities, shape (n, 3), likewise."""
        return self._begin().velocities

    @property
    def masses(self):
        """Masses, shape (n), likewise."""
        return self._begin().masses

    @property
    def variables(self):
        """The variables of a system, a copy."""
        return self._begin().variables

    @property
    def names(self):
        return self._begin().names

    @property
    def step(self):
        return self._begin().step

    @property
    def time(self):
        """By the clock of the run, in its units."""
        return self._begin().time

    @property
    def units(self):
        return self._units

    @property
    def digest(self):
        """SHA-256 of the state, as the program prints it: equal digests are equal bits."""
        return self._begin().digest

    @property
    def monitors(self):
        """What monitors report: a dict of dicts, `sim.monitors["energy"]["worst"]`."""
        return self._begin().report()

    def series(self, monitor):
        """All that a monitor has told: a `Series` with `time`, and an array for each quantity."""
        from .reports import Series

        self._begin()
        try:
            return Series(monitor, self._held.series(monitor))
        except KeyError:
            known = self._held.monitors
            raise KeyError(f"no monitor {monitor!r} has told anything{parts._proposal(monitor, dict.fromkeys(known))}") from None

    def to_dataframe(self, monitor=None):
        """The numbers of one monitor, or of all, as a pandas DataFrame."""
        from .reports import frame_of

        names = [monitor] if monitor else self._begin().monitors
        return frame_of([self.series(name) for name in names])

    @property
    def frames(self):
        """Frames that `record_frames` has kept: `time`, `positions` (frames, n, 3), `velocities`."""
        from .reports import MemoryFrames

        return MemoryFrames(self._begin(), self)

    @property
    def particles(self):
        """The particles where they stand now: `sim.particles["Jupiter"].e`, by place or name."""
        return _particles.MovingBodies(self)

    def elements(self, body=None, about=None):
        """Osculating elements of a body, or of several, about another one, now: see `nt.particles.Bodies.elements`."""
        return self.particles.elements(body, about)

    @property
    def scene(self):
        """The scene of this simulation: for compare, advise, stability, explain and evaluate."""
        from .scenes import Scene

        return Scene(self.tree(), functions=self._functions)

    def tree(self):
        """The same as a dict, which `nt.run` and `nt.compare` take."""
        tree = {"units": self._units, "integrator": dict(self._integrator), "every": list(self._every)}
        if self.title:
            tree["title"] = self.title
        if self._system is not None:
            tree["system"] = self._system.tree(self._units)
        else:
            tree["particles"] = self._particles.tree()
            tree["hamiltonian"] = self._hamiltonian.tree(self._units)
            for key, tables in (("force", self._forces), ("field", self._fields), ("constraint", self._constraints)):
                if tables:
                    tree["hamiltonian"][key] = list(tables)
            if self._thermostat is not None:
                tree["hamiltonian"]["thermostat"] = self._thermostat.tree(self._units)
        if self._decorators:
            tree["integrator"]["decorator"] = list(self._decorators)
        if self._stops:
            tree["stop"] = list(self._stops)
        return tree

    def explain(self):
        return self.scene.explain()

    def compare(self, **options):
        return self.scene.compare(**options)

    def plot(self, **options):
        """Orbits, or positions, and errors of the energy: see `nt.plots`."""
        from . import plots

        return plots.plot(self, **options)

    def close(self):
        """Writes all that is still in memory to the files of the run, and marks them complete."""
        if self._held is not None and self._files:
            self._held.finish("completed")
            self._unfinished.detach()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def __repr__(self):
        what = self._system.name if self._system is not None else f"{len(self._particles)} particles"
        place = f", step {self._held.step}, time {self._held.time:g}" if self._held is not None else ", not begun"
        return f"<Simulation: {self._integrator['method']}, {what}{place}>"

    # ---- inside -----------------------------------------------------------------------------------------------------

    def _expect_not_begun(self, what):
        if self._held is not None:
            raise RuntimeError(f"{what}: the run has begun; make another Simulation, or add it before the first run")

    def _cadence(self, cadence, after):
        import numbers

        when = {}
        if isinstance(cadence, numbers.Integral) and not isinstance(cadence, bool):
            when["steps"] = int(cadence)
        elif isinstance(cadence, (list, tuple)) or getattr(cadence, "ndim", 0) == 1:
            when["times"] = quantities.with_units(cadence, "time", self._units)
        else:
            when["every"] = quantities.with_units(cadence, "time", self._units)
        if after is not None:
            when["after"] = quantities.with_units(after, "time", self._units)
        return when

    def _watcher(self, monitor):
        if isinstance(monitor, str) and monitor in parts.described().get("writer", {}):
            return parts.part_class("writer", monitor)()
        if isinstance(monitor, type) and issubclass(monitor, parts.Part):
            monitor = monitor()
        if isinstance(monitor, parts.Part) and monitor.kind == "writer":
            return monitor
        return parts.as_part(monitor, "monitor", "monitors")

    def _write(self, name, table, when):
        self._expect_not_begun("every")
        file = table.pop("file", "run.h5" if name == "trajectory" else "checkpoint.h5")
        if name in self._files:
            raise ValueError(f"a run has one {name}; it is written to {self._files[name]!r} already")
        self._files[name] = os.fspath(file)
        self._every.append({"type": name, **table, **when})
        return self

    def _begin(self):
        if self._held is None:
            scene = _core.Scene(self.tree(), [], self._functions)
            self._held = _core.Simulation(scene, self._files.get("trajectory", ""), self._files.get("checkpoint", ""))
            for message in scene.warnings:
                _warnings.warn(message, stacklevel=4)
            for when in self._frame_cadences:
                self._begin_frames(when)
            if self._files:
                self._unfinished = weakref.finalize(self, self._held.finish, "interrupted")
        return self._held

    def _attach(self, name, table, when, function):
        self._held.attach(name, quantities.plain(table), when, function)

    def _begin_frames(self, when):
        self._held.record_frames(when)


class _Edit:
    """Arrays to be written to; the run takes them at the end of the `with`."""

    def __init__(self, held):
        self._held = held

    def __enter__(self):
        import numpy

        held = self._held
        self.positions, self.velocities = numpy.array(held.positions), numpy.array(held.velocities)
        self.masses = numpy.array(held.masses)
        return self

    def __exit__(self, kind, value, trace):
        if kind is not None:
            return

        def change(x, v, m):
            x[:], v[:], m[:] = self.positions, self.velocities, self.masses

        self._held.edit(change)
