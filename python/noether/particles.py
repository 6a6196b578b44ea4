"""Particles, one by one, as a table of bodies; their orbits as properties."""

import numbers

from . import _core, parts, quantities

# Short names, as users of other programs write them.
_SHORT = {"m": "mass", "primary": "about", "position": "x", "xyz": "x", "velocity": "v", "vxyz": "v", "r": "radius",
          "hash": "name"}
_COMPUTED = ("a", "e", "inc", "Omega", "omega", "M", "f")
_ELEMENTS = _COMPUTED + ("pomega", "l", "theta", "P", "n")
_ORBIT = ("a", "P", "q", "e", "inc", "Omega", "omega", "pomega", "M", "f", "l", "T")
_PAL = ("h", "k", "ix", "iy", "pal_h", "pal_k", "pal_ix", "pal_iy")
_FIRST = 0


class Body:
    """One body of `Particles`, or of a simulation where it stands now: what is known of it, and what follows from it.

    name, mass (or m)
    x, v : position and velocity, three numbers each [length, velocity]
    a, e, inc, Omega, omega, M, f, pomega, l, theta, P, n : osculating elements [length, 1, angle, time, 1/time]; of
        `Particles` about what the body was given about, of a run about the first body; `elements(about)` has them about others

    Those that were given to `Particles.add` can be set too: `bodies["Jupiter"].e = 0.1`.
    """

    def __init__(self, particles, index, values=None):
        self.__dict__.update(_particles=particles, _place=index, values=values)

    @property
    def index(self):
        """Its place among all particles."""
        # Bodies that were added come after those of a file.
        return self._place if self.values is None else self._particles._first_added() + self._place

    @property
    def name(self):
        return self._particles.names[self._place] if self.values is None else self.values["name"]

    @property
    def mass(self):
        return float(self._particles.masses[self.index])

    m = mass

    @property
    def x(self):
        return self._particles.positions[self.index]

    @property
    def v(self):
        return self._particles.velocities[self.index]

    xyz, vxyz = x, v

    def elements(self, about=None):
        """Osculating elements as a dict: see `Particles.elements`."""
        return self._particles.elements(self.index, about)

    def __getattr__(self, key):
        if key in _ELEMENTS:
            return self.elements()[key]
        for vector, components in (("x", ("y", "z")), ("v", ("vx", "vy", "vz"))):
            if key in components:
                raise AttributeError(f"a body has no {key!r}; {vector} has all three numbers: {vector}[{'xyz'.index(key[-1])}]")
        known = dict.fromkeys(("name", "mass", "x", "v") + _ELEMENTS)
        raise AttributeError(f"a body has no {key!r}{parts._proposal(key, known)}")

    def __setattr__(self, key, value):
        if self.values is None:
            raise AttributeError(f"{key} of {self.name!r} cannot be set here: bodies of a file, and those of a run, are "
                                 "changed by Simulation.edit")
        word = _SHORT.get(key, key)
        if word == "name":
            raise AttributeError("a body keeps its name; others may be given about it")
        told = self._particles._told(self.name, {word: value})
        given = [other for other in self.values if other in _GROUP_OF.get(word, ())]
        for other in given:
            del self.values[other]
        self.values.update(told)
        self._particles._held = None

    def __repr__(self):
        if self.values is not None:
            return f"Body({', '.join(f'{k}={v!r}' for k, v in self.values.items())})"
        return f"Body(name={self.name!r}, mass={self.mass!r})"


# Keys of which a body has one: one that is set takes the place of another.
_GROUP_OF = {key: group for group in (("a", "P", "q"), ("omega", "pomega"), ("M", "f", "l", "T")) for key in group}


class Bodies:
    """What particles at their start and those of a run have in common: bodies by place or name, and their elements."""

    def elements(self, body=None, about=None):
        """Osculating elements of a body about another one, or of several: a dict, whose entries are attributes too.

        body : its place, its name or itself; a list or a slice of these gives arrays; default: all but the first
        about : a body, a list of bodies (their barycenter), or "jacobi" (the barycenter of all bodies above); default: for
            `Particles` what the body was given about, for a run the first body

        a [length], e [1], inc, Omega, omega, M, f [angle], and what follows from them: pomega = Omega + omega,
        l = pomega + M, theta = pomega + f, P = 2 pi / n [time], n = sqrt(mu / |a|^3) [1/time], mu = G (M + m). Angles are in
        radians; those of ellipses lie in [0, 2 pi).
        """
        if body is None:
            body = slice(1, None)
        if about is None:
            about = self._about(body)
        return elements_of(self.positions, self.velocities, self.masses, body, about, self.units, names=self.names)

    def _about(self, body):
        return _FIRST

    def index(self, body):
        """The place of a body, which is given by its place, its name, or itself. @raise KeyError, IndexError"""
        return _place_of(body, self.names)

    def __len__(self):
        return len(self.names)

    def __getitem__(self, which):
        if isinstance(which, slice):
            return [self[k] for k in range(*which.indices(len(self)))]
        return self._body(self.index(which))

    def _body(self, index):
        return Body(self, index)

    def __iter__(self):
        return (self._body(k) for k in range(len(self)))


class MovingBodies(Bodies):
    """The particles of a simulation, where they stand now: `sim.particles["Jupiter"].e`."""

    def __init__(self, simulation):
        self._simulation = simulation

    names = property(lambda self: self._simulation.names)
    positions = property(lambda self: self._simulation.positions)
    velocities = property(lambda self: self._simulation.velocities)
    masses = property(lambda self: self._simulation.masses)
    units = property(lambda self: self._simulation.units)

    def __repr__(self):
        return f"<{len(self)} particles at time {self._simulation.time:g}>"


class Particles(Bodies):
    """Bodies of a simulation.

    >>> bodies = nt.Particles(units="solar")
    >>> bodies.add(m=1)
    >>> bodies.add("Jupiter", m=1e-3, a=5.2, e=0.05)
    >>> bodies["Jupiter"].P

    Parameters
    ----------
    units : "solar" (au, day, Msun), "molecular" (nm, ps, Da), "si" or "reduced" (G = 1)
        Bare numbers are in these units; texts such as "5.2 au" and quantities of pint and astropy carry their own.
    source : file of bodies (CSV, vector tables of JPL Horizons, or run.h5), a structure (LAMMPS data, XYZ, .gro, a mesh),
        or a builder such as `nt.builders.Lattice(...)`
    frame : "as_given", "barycenter", or the number of a frame of run.h5
    elements : "first_body", or "jacobi": elements are about the barycenter of all bodies above, as in REBOUND
    table : further keys of [particles]: box, mixing, special, ...
    """

    _STRUCTURES = (".data", ".xyz", ".extxyz", ".gro", ".msh", ".lmp")

    def __init__(self, source=None, *, units="reduced", frame=None, **table):
        _core.unit_names(units)
        self.units = units
        self.table = {key: value for key, value in {"frame": frame, **table}.items() if value is not None}
        self._bodies, self._held, self._in_source, self._numbered = [], None, None, 0
        known = parts.table_fields("[particles]")
        for key in self.table:
            if key not in known:
                raise TypeError(f"Particles has no keyword {key!r}{parts._proposal(key, known)}")
        if isinstance(source, parts.Part):
            self.table.update(parts.as_part(source, "builder", "builders").tree(units))
        elif source is not None:
            name = str(source)
            self.table["structure" if name.lower().endswith(self._STRUCTURES) else "bodies"] = name

    @classmethod
    def from_arrays(cls, masses, positions, velocities, names=None, *, units="reduced", **table):
        """Particles from arrays: masses (n), positions and velocities (n, 3), to the bit."""
        import numpy

        masses, positions, velocities = (numpy.asarray(one, dtype=float) for one in (masses, positions, velocities))
        n = masses.size
        if masses.ndim != 1 or positions.shape != (n, 3) or velocities.shape != (n, 3):
            raise ValueError(f"masses of shape {masses.shape}, positions {positions.shape} and velocities {velocities.shape}; "
                             "(n), (n, 3) and (n, 3) are expected")
        if names is not None and len(names) != n:
            raise ValueError(f"{len(names)} names for {n} particles")
        made = cls(units=units, **table)
        for k in range(n):
            made.add(names[k] if names else None, m=float(masses[k]), x=positions[k].tolist(), v=velocities[k].tolist())
        return made

    def add(self, name=None, **values):
        """Adds a body, by position and velocity or by elements, and returns it.

        m (or mass) : default 0, a tracer, which feels forces and exerts none
        x, y, z, vx, vy, vz, or x and v of three numbers each : those that are missing are 0
        a, P or q; e; inc; Omega; omega or pomega; M, f, l, theta, E or T : elements; angles without a unit are in radians
        primary (or about) : a body that was added before, its name or place, or a list of these: their barycenter; x and v
            are relative to it too. Default: the first body, or as `elements` of the particles says
        r (or radius), charge, ... : a column that a part of the simulation needs

        TypeError for a keyword that no body has, nt.Error (at the first look) for values that are not an orbit.
        """
        values = {_SHORT.get(key, key): value for key, value in values.items() if value is not None}
        name = values.pop("name", name)
        if not values:
            what = f"add({name!r})" if name else "add()"
            search = f", or take it from nt.bodies.horizons({name!r}, epoch)" if name else ""
            raise TypeError(f"{what} says nothing about the body; give its mass, and where it is: m=1, a=5.2{search}")
        self._numbered += 1  # of all that were ever added: no default name comes twice
        told = {"name": str(name) if name else f"body_{self._first_added() + self._numbered}",
                **self._told(name, self._place(values))}
        if "mass" not in told and "type" not in told:
            told["mass"] = quantities.with_units(0.0, "mass", self.units)
        body = Body(self, len(self._bodies), told)
        self._bodies.append(body)
        self._held = None
        return body

    def _place(self, values):
        """The same with whole vectors, and with elements that the engine has."""
        told = dict(values)
        for vector, keys in (("x", ("x", "y", "z")), ("v", ("vx", "vy", "vz"))):
            given = [key for key in keys if key in told and not (key == vector and _is_vector(told[key]))]
            if given and vector in told and _is_vector(told[vector]):
                raise TypeError(f"{vector} has three numbers, and {given[0]} is given too; give one of the two")
            if given:
                told[vector] = [told.pop(key, 0.0) for key in keys]
        if "x" in told or "v" in told:
            for vector in ("x", "v"):
                told.setdefault(vector, [0.0, 0.0, 0.0])
        for key in _PAL:
            if key in told:
                raise TypeError(f"a body has no {key!r}; the variables of Pal are not supported: give a, e, inc, Omega, pomega "
                                "and l")
        places = [key for key in ("M", "f", "l", "T", "theta", "E") if key in told]
        if len(places) > 1:
            raise TypeError(f"a body has one of M, f, l, theta, E and T; {' and '.join(places)} are given")
        if "theta" in told:
            told["f"] = self._number(told.pop("theta"), "angle") - self._longitude(told)
        if "E" in told:
            told["M"] = self._mean_anomaly(self._number(told.pop("E"), "angle"), self._number(told.get("e", 0.0), "1"))
        return told

    def _number(self, value, dimension):
        return quantities.number_of(value, dimension, self.units)

    def _longitude(self, told):
        """The longitude of the pericenter."""
        if "pomega" in told:
            return self._number(told["pomega"], "angle")
        return self._number(told.get("Omega", 0.0), "angle") + self._number(told.get("omega", 0.0), "angle")

    @staticmethod
    def _mean_anomaly(E, e):
        import math

        if e == 1:
            raise ValueError("a parabola has no eccentric anomaly; give f or T")
        return E - e * math.sin(E) if e < 1 else e * math.sinh(E) - E

    def _told(self, name, values):
        """Values as a scene has them. @raise TypeError for a key that no body has"""
        fields = self._fields()
        told = dict(values)
        for key in told:
            if key not in fields:
                hint = _core.other_name(key) or parts._proposal(key, fields)
                raise TypeError(f"a body has no {key!r}{hint}")
        if "about" in told:
            about = told["about"]
            told["about"] = ([self._name_of(one) for one in about] if isinstance(about, (list, tuple)) else
                             self._name_of(about))
        return {key: quantities.with_units(value, fields[key].get("dimension", "1"), self.units) for key, value in told.items()}

    def _name_of(self, body):
        if isinstance(body, Body):
            return body.name
        return self.names[_place_of(body, self.names)] if isinstance(body, numbers.Integral) else body

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

    def _from_source(self):
        return bool(set(self.table) & {"bodies", "structure", "type"})

    def _first_added(self):
        """How many particles come before those that were added."""
        if not self._from_source():
            return 0
        if self._in_source is None:
            self._in_source = len(self._state().names) - len(self._bodies)
        return self._in_source

    def _state(self):
        """The particles as the engine has them. A force that takes any of them is enough for that."""
        if self._held is None:
            tree = self.tree()
            known = parts.table_fields("[[particles.body]]")
            if "body" in tree:
                tree["body"] = [{key: value for key, value in body.items() if key in known} for body in tree["body"]]
            zero = [quantities.with_units(0.0, "acceleration", self.units)] * 3
            field = {"type": "uniform_field", "acceleration": zero}
            step = quantities.with_units(1.0, "time", self.units)
            self._held = _core.Scene({"units": self.units, "particles": tree,
                                      "hamiltonian": {"type": "kinetic_potential", "force": [field]},
                                      "integrator": {"method": "verlet", "step": step}}, [], [])
        return self._held

    @property
    def names(self):
        if self._from_source():
            return self._state().names
        return [body.values["name"] for body in self._bodies]

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

    @property
    def epoch(self):
        """The Julian day of the start, such as "JD 2451545 TDB", where it is known; else None."""
        if not self._from_source():
            return self.table.get("epoch")
        return self._state().tree["particles"].get("epoch")

    def _about(self, body):
        """What a body was given about."""
        if isinstance(body, slice) or _is_list(body):
            return "jacobi" if self.table.get("elements") == "jacobi" else _FIRST
        added = self.index(body) - self._first_added()
        values = self._bodies[added].values if added >= 0 else {}
        if "about" in values:
            return values["about"]
        return "jacobi" if self.table.get("elements") == "jacobi" else _FIRST

    def _body(self, index):
        added = index - self._first_added()
        return self._bodies[added] if added >= 0 else Body(self, index)

    def __delitem__(self, which):
        added = self.index(which) - self._first_added()
        if added < 0:
            raise TypeError(f"{self.names[self.index(which)]!r} is from a file; only bodies that were added can be taken out")
        del self._bodies[added]
        for place, body in enumerate(self._bodies):
            body.__dict__["_place"] = place
        self._held = None

    def __getstate__(self):
        # What the engine holds is made anew where it is wanted: copy.deepcopy and pickle work.
        return {**self.__dict__, "_held": None}

    def copy(self):
        """Particles of their own, which may be changed."""
        import copy

        return copy.deepcopy(self)

    def __repr__(self):
        return f"<Particles: {len(self)} in {self.units} units>"


def _is_vector(value):
    return _is_list(value) or hasattr(getattr(value, "magnitude", 0), "__len__")


def _is_list(value):
    return isinstance(value, (list, tuple)) or getattr(value, "ndim", 0) == 1


def _place_of(body, names):
    """The place of one body among names. @raise KeyError, IndexError, TypeError"""
    if isinstance(body, Body):
        return body.index
    if isinstance(body, numbers.Integral) and not isinstance(body, bool):
        if not -len(names) <= body < len(names):
            raise IndexError(f"there is no body {body}; there are {len(names)}, from 0 on")
        return range(len(names))[body]
    if not isinstance(body, str):
        raise TypeError(f"{body!r} is not a body; give its place, its name or itself")
    names = list(names)
    if body not in names:
        raise KeyError(f"no body is called {body!r}{parts._proposal(body, dict.fromkeys(names))}")
    return names.index(body)


def _places_of(bodies, names):
    """Places of several bodies, as an array."""
    import numpy

    if isinstance(bodies, slice):
        return numpy.arange(len(names))[bodies]
    return numpy.array([_place_of(one, names) for one in bodies], dtype=int)


def elements_of(positions, velocities, masses, body, about, units, names=None):
    """Osculating elements of bodies about another one: see `Bodies.elements`.

    positions, velocities : shape (..., n, 3): one state, or frames; masses : shape (n)

    Every entry has the shape of the frames, and one dimension more where several bodies are wanted; one body of one state
    gives numbers. About 1 microsecond for each orbit.
    """
    import numpy

    from .reports import Figures

    names = list(names) if names is not None else [""] * masses.shape[-1]
    single = not isinstance(body, slice) and not _is_list(body)
    places = _places_of([body] if single else body, names)
    x, v = numpy.asarray(positions)[..., places, :], numpy.asarray(velocities)[..., places, :]
    center_x, center_v, center_mass = _center(numpy.asarray(positions), numpy.asarray(velocities), numpy.asarray(masses),
                                              places, about, names)
    mu = _core.gravitational_constant(units) * (center_mass + numpy.asarray(masses)[places])
    x, v, mu = x - center_x, v - center_v, numpy.broadcast_to(mu, x.shape[:-1])
    flat = [numpy.ascontiguousarray(x.reshape(-1, 3)), numpy.ascontiguousarray(v.reshape(-1, 3)),
            numpy.ascontiguousarray(mu.reshape(-1))]
    rows = _core.elements_of_states(*flat).reshape(x.shape[:-1] + (len(_COMPUTED),))
    if single:
        rows, mu = rows[..., 0, :], mu[..., 0]
    found = {name: rows[..., k] for k, name in enumerate(_COMPUTED)}
    turn = 2 * numpy.pi
    found["pomega"] = (found["Omega"] + found["omega"]) % turn
    found["l"] = (found["pomega"] + found["M"]) % turn
    found["theta"] = (found["pomega"] + found["f"]) % turn
    with numpy.errstate(invalid="ignore", divide="ignore"):
        found["n"] = numpy.sqrt(mu / numpy.abs(found["a"]) ** 3)
        found["P"] = numpy.where(found["a"] > 0, turn / found["n"], numpy.inf)
    if single and x.ndim == 2:
        found = {name: float(one) for name, one in found.items()}
    return Figures(found)


def _center(positions, velocities, masses, places, about, names):
    """Position, velocity and mass of what orbits are about; those of a barycenter where there are several bodies."""
    import numpy

    if isinstance(about, str) and about == "jacobi" and about not in names:
        if (places < 1).any():
            raise _core.Error("the first body has no elements in Jacobi coordinates: there are no bodies above it")
        above = numpy.cumsum(masses)[places - 1]
        weighted = [numpy.cumsum(masses[:, None] * one, axis=-2)[..., places - 1, :] for one in (positions, velocities)]
        with numpy.errstate(invalid="ignore", divide="ignore"):
            return weighted[0] / above[:, None], weighted[1] / above[:, None], above
    centers = _places_of(about if _is_list(about) else [about], names)
    for place in places:
        if place in centers:
            raise _core.Error(f"the body {names[place] or place!r} has no elements about itself; give another one as about")
    mass = masses[centers].sum()
    if len(centers) == 1:
        return positions[..., centers, :], velocities[..., centers, :], mass
    weights = masses[centers, None] / mass
    return ((weights * positions[..., centers, :]).sum(axis=-2, keepdims=True),
            (weights * velocities[..., centers, :]).sum(axis=-2, keepdims=True), mass)
