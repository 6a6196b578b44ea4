"""Particles, one by one, as a table of bodies; their orbits as properties."""

import numbers

from . import _core, parts, quantities

# Short names, as users of other programs write them.
_SHORT = {"m": "mass", "primary": "about", "position": "x", "velocity": "v"}
_ELEMENTS = ("a", "e", "inc", "Omega", "omega", "M")


class Body:
    """One body of `Particles`: what was said of it, and what follows from it.

    Position, velocity and elements are those of the start: a body that is given by elements has `x` and `v` too, and one
    that is given by these has elements about its primary (the first body unless `about` says otherwise).
    """

    def __init__(self, particles, index, values):
        self._particles, self._index, self.values = particles, index, values

    @property
    def name(self):
        return self.values["name"]

    @property
    def mass(self):
        return float(self._particles._state().masses[self._index])

    m = mass

    @property
    def x(self):
        return self._particles._state().positions[self._index]

    @property
    def v(self):
        return self._particles._state().velocities[self._index]

    def elements(self, about=None):
        """Osculating elements a, e, inc, Omega, omega, M about a body [length, 1, angle]."""
        return self._particles.elements(self._index, about)

    def __getattr__(self, key):
        if key in _ELEMENTS + ("P",):
            return self.elements()[key]
        raise AttributeError(f"a body has no {key!r}")

    def __repr__(self):
        return f"Body({', '.join(f'{k}={v!r}' for k, v in self.values.items())})"


class Particles:
    """Bodies of a simulation.

    >>> bodies = nt.Particles(units="solar")
    >>> bodies.add(m=1)
    >>> bodies.add(name="Jupiter", m=1e-3, a=5.2, e=0.05)

    Parameters
    ----------
    units : "solar" (au, day, Msun), "molecular" (nm, ps, Da), "si" or "reduced" (G = 1)
        Bare numbers stand in these; texts such as "5.2 au" and quantities of pint and astropy carry their own.
    source : file of bodies (CSV, vector tables of JPL Horizons, or run.h5), a structure (LAMMPS data, XYZ, .gro, a mesh),
        or a builder such as `nt.builders.Lattice(...)`
    frame : "as_given", "barycenter", or the number of a frame of run.h5
    table : further keys of [particles]: box, mixing, special, ...
    """

    _STRUCTURES = (".data", ".xyz", ".extxyz", ".gro", ".msh", ".lmp")

    def __init__(self, source=None, *, units="reduced", frame=None, **table):
        _core.unit_names(units)
        self.units = units
        self.table = {key: value for key, value in {"frame": frame, **table}.items() if value is not None}
        self._bodies, self._held = [], None
        known = parts.table_fields("[particles]")
        for key in self.table:
            if key not in known:
                raise TypeError(f"Particles has no keyword {key!r}{parts._proposal(key, known)}")
        if isinstance(source, parts.Part):
            self.table.update(parts.as_part(source, "builder", "builders").tree(units))
        elif source is not None:
            name = str(source)
            self.table["structure" if name.lower().endswith(self._STRUCTURES) else "bodies"] = name

    def add(self, name=None, **values):
        """Adds a body: mass, and position and velocity (x, v: three numbers each; or x, y, z, vx, vy, vz), or elements.

        Elements: a, P or q; e; inc; Omega; omega or pomega; M, f, l or T; about (or primary): a body that stands above, its
        name, or a list of them. Angles without a unit are in radians. A column that a part brings, such as a charge or a
        radius, is a keyword too.
        """
        told = {_SHORT.get(key, key): value for key, value in values.items() if value is not None}
        for vector, keys in (("x", ("x", "y", "z")), ("v", ("vx", "vy", "vz"))):
            given = [key for key in keys if key in told and not (key == "x" and _is_vector(told["x"]))]
            if given:
                told[vector] = [told.pop(key, 0) for key in keys]
        about = told.get("about")
        if isinstance(about, Body):
            told["about"] = about.name
        elif isinstance(about, (list, tuple)):
            told["about"] = [one.name if isinstance(one, Body) else one for one in about]
        told = {"name": name or f"body_{len(self._bodies) + 1}", **told}
        fields = self._fields()
        body = Body(self, len(self._bodies), {
            key: quantities.with_units(value, fields.get(key, {}).get("dimension", "1"), self.units)
            for key, value in told.items()})
        self._bodies.append(body)
        self._held = None
        return body

    def _fields(self):
        fields = dict(parts.table_fields("[[particles.body]]"))
        for column in _core.columns():
            fields.setdefault(column["name"], column)
        return fields

    def tree(self):
        """The table [particles] of a scene."""
        fields = parts.table_fields("[particles]")
        table = {key: quantities.with_units(value, fields.get(key, {}).get("dimension", "1"), self.units)
                 for key, value in self.table.items()}
        if self._bodies:
            table["body"] = [body.values for body in self._bodies]
        return table

    def _state(self):
        if self._held is None:
            self._held = _core.Scene({"units": self.units, "particles": self.tree(),
                                      "hamiltonian": {"type": "kinetic_potential", "force": [{"type": "gravity"}]},
                                      "integrator": {"method": "verlet", "step": quantities.with_units(1.0, "time", self.units)}},
                                     [], [])
        return self._held

    @property
    def names(self):
        return self._state().names

    @property
    def positions(self):
        """Positions at the start, shape (n, 3)."""
        return self._state().positions

    @property
    def velocities(self):
        """Velocities at the start, shape (n, 3)."""
        return self._state().velocities

    @property
    def masses(self):
        """Masses, shape (n)."""
        return self._state().masses

    def elements(self, body, about=None):
        """Osculating elements of a body, by its place or name, about another one: the first unless told."""
        return elements_of(self.positions, self.velocities, self.masses, self.index(body),
                           0 if about is None else self.index(about), self.units)

    def index(self, body):
        """The place of a body, which is given by its place, its name, or itself."""
        if isinstance(body, Body):
            return body._index
        if isinstance(body, numbers.Integral):
            return range(len(self))[body]
        names = self.names
        if body not in names:
            raise KeyError(f"no body is called {body!r}{parts._proposal(body, dict.fromkeys(names))}")
        return names.index(body)

    def __len__(self):
        return len(self._bodies) if self._bodies and not set(self.table) & {"bodies", "structure", "type"} else len(self.names)

    def __getitem__(self, which):
        index = self.index(which)
        if index < len(self._bodies) and not set(self.table) & {"bodies", "structure", "type"}:
            return self._bodies[index]
        return Body(self, index, {"name": self.names[index]})

    def __iter__(self):
        return (self[k] for k in range(len(self)))

    def __repr__(self):
        return f"<Particles: {len(self)} in {self.units} units>"


def _is_vector(value):
    return isinstance(value, (list, tuple)) or getattr(value, "ndim", 0) == 1 or hasattr(getattr(value, "magnitude", 0), "__len__")


def elements_of(positions, velocities, masses, body, about, units):
    """Osculating elements of one body about another: a dict of a, e, inc, Omega, omega, M and the period P.

    Lengths and times in the units of the scene, angles in radians. Vectorised: arrays of frames give arrays.
    """
    import math

    mu = _core.gravitational_constant(units) * (masses[about] + masses[body])
    x, v = positions[..., body, :] - positions[..., about, :], velocities[..., body, :] - velocities[..., about, :]
    if x.ndim == 1:
        found = dict(zip(_ELEMENTS, _core.elements_from_state(list(x), list(v), float(mu))))
        found["P"] = 2 * math.pi * math.sqrt(found["a"] ** 3 / mu) if found["a"] > 0 else math.inf
        return found
    import numpy

    rows = numpy.array([_core.elements_from_state(list(a), list(b), float(mu)) for a, b in zip(x, v)])
    found = {name: rows[:, k] for k, name in enumerate(_ELEMENTS)}
    with numpy.errstate(invalid="ignore"):
        found["P"] = numpy.where(found["a"] > 0, 2 * math.pi * numpy.sqrt(numpy.abs(found["a"]) ** 3 / mu), math.inf)
    return found
