"""Simulations of REBOUND, taken over: `nt.from_rebound(sim)`. docs/from_rebound.md has both codes side by side.

REBOUND itself is not needed here: only its simulation is looked at, of version 4 or 5.
"""

import math
import re
import warnings

from . import _core, parts
from .particles import Particles
from .simulation import Simulation

# What units of REBOUND are in SI, as it has them (units.py of REBOUND 5); masses are not needed, since G m is in its G.
_YEAR = 31557600.0
_TIMES = {"s": 1.0, "hr": 3600.0, **dict.fromkeys(("d", "day", "days"), 86400.0),
          **dict.fromkeys(("yr", "year", "years", "yrs", "jyr"), _YEAR), "sidereal_yr": 31558149.7635,
          "yr2pi": math.sqrt(149597870700.0**3 / 1.3271244004193938e20),
          "kyr": _YEAR * 1e3, "myr": _YEAR * 1e6, "gyr": _YEAR * 1e9}
_LENGTHS = {"m": 1.0, "cm": 0.01, "km": 1000.0, "au": 149597870700.0, "aus": 149597870700.0, "pc": 3.085677581e16,
            "parsec": 3.085677581e16}

_KERNELS = {"DEFAULT": "plain", "MODIFIEDKICK": "modified", "COMPOSITION": "composed", "LAZY": "lazy"}
_COORDINATES = {"JACOBI": "jacobi", "DEMOCRATICHELIOCENTRIC": "democratic", "WHDS": "whds", "BARYCENTRIC": "barycentric"}
_SABA = {"10_4": "aba_10_4", "8_6_4": "aba_8_6_4", "10_6_4": "aba_10_6_4", "H_8_4_4": "abah_8_4_4", "H_8_6_4": "abah_8_6_4",
         "H_10_6_4": "abah_10_6_4", **{str(n): f"saba_{n}" for n in range(1, 5)}}
_LEAPFROG = {2: "verlet_aba", 4: "yoshida_4", 6: "yoshida_6", 8: "kahan_li_8_s17"}
# Enumerations that REBOUND 4 gives as numbers.
_NUMBERED = {"kernel": list(_KERNELS), "coordinates": list(_COORDINATES)}
_REFUSED = {
    "janus": 'method="kahan_li_8_s17" has bounded errors without whole numbers',
    "eos": 'method="aba_10_6_4" with hamiltonian="wisdom_holman" has no inner steps',
    "sei": "the shearing sheet is not supported",
    "tes": 'method="encke_gauss_8" computes perturbations of Kepler orbits too',
    "none": 'name one: method="gauss_8"',
}


def from_rebound(sim, *, method=None, step=None, hamiltonian=None, units=None, **options):
    """A simulation of REBOUND as an `nt.Simulation`: particles, clock, method and step, softening, and distances to stop at.

    method, hamiltonian, options : in place of REBOUND's integrator; any of `nt.Simulation`
    step : default sim.dt; methods that choose their steps take it as the first one
    units : "reduced" (G = 1), "solar" or "si"; default: reduced where sim.units is not set, else solar

    whfast is verlet_aba on wisdom_holman with its coordinates, corrector and kernel, saba its namesake, and leapfrog verlet_aba:
    these agree with REBOUND to rounding, but for barycentric coordinates. Leapfrogs of higher order become others of that
    order, ias15 gauss_radau_15, and bs gragg_bulirsch_stoer. mercurius and trace, which have no namesake,
    become gauss_8, which resolves encounters too; a RunWarning says so. nt.Error for what has no counterpart (janus, eos, sei,
    boundaries, collisions, variational particles, forces of one's own), with what to do instead.
    """
    bodies = particles(sim, units)
    units, length, time, _ = _factors(sim, units)
    _refuse_what_is_missing(sim)
    name, own, split = _method_of(sim) if method is None else (method, {}, None)
    hamiltonian = split if hamiltonian is None else parts.as_part(hamiltonian, "hamiltonian", "hamiltonians")
    softening = getattr(sim, "softening", 0.0) * length
    made = Simulation(bodies, method=name, hamiltonian=hamiltonian, step=sim.dt * time if step is None else step,
                      **{"start_time": sim.t * time or None, **own, **options})
    if hamiltonian is None or hamiltonian.name == "kinetic_potential":
        made.add_force(parts.part_class("force", "gravity")(softening=softening or None))
    elif softening:
        raise _core.Error(f"softening = {sim.softening!r} has no place in {hamiltonian.name}; set it to 0, or use "
                          'hamiltonian="kinetic_potential" with method="gauss_8"')
    for stop, distance in (("escape", "exit_max_distance"), ("collision", "exit_min_distance")):
        if getattr(sim, distance, 0.0):
            made.stop_when(parts.part_class("stop", stop)(distance=getattr(sim, distance) * length))
    return made


def particles(sim, units=None):
    """The particles of a simulation of REBOUND as `nt.Particles`, with their names; units as in `from_rebound`.

    In reduced units positions and velocities are the same to the bit, and masses are where G = 1. What is kept in all others
    is G m: masses are those of REBOUND times the ratio of its G to that of the units. Particles from N_active on have no mass.
    """
    units, length, time, mass = _factors(sim, units)
    count = int(sim.N) if hasattr(sim, "particles_var") else int(sim.N - getattr(sim, "N_var", 0))
    active = int(getattr(sim, "N_active", -1))
    if not 0 <= active <= count:  # -1, or the largest of its type: all
        active = count
    given = [sim.particles[k] for k in range(count)]
    if getattr(sim, "testparticle_type", 0) and any(one.m for one in given[active:]):
        raise _core.Error(f"testparticle_type = {sim.testparticle_type}: particles that pull only those before N_active are not "
                          "supported; set it to 0, or N_active to -1")
    speed = length / time
    return Particles.from_arrays(
        [one.m * mass if k < active else 0.0 for k, one in enumerate(given)],
        [[one.x * length, one.y * length, one.z * length] for one in given],
        [[one.vx * speed, one.vy * speed, one.vz * speed] for one in given], _names_of(given), units=units)


# ---- inside ---------------------------------------------------------------------------------------------------------


def _factors(sim, units):
    """The units of what is made, and by what lengths, times and masses of REBOUND are multiplied. @raise nt.Error"""
    told = getattr(sim, "units", None) or {}
    length, time = told.get("length"), told.get("time")
    if units == "reduced" or (units is None and not (length and time)):
        return "reduced", 1.0, 1.0, sim.G
    if not (length and time):
        raise _core.Error(f"units = {units!r}, but the simulation of REBOUND has none; set sim.units before its particles are "
                          "added, or leave units out")
    units = units or "solar"
    for name, known in ((length, _LENGTHS), (time, _TIMES)):
        if name not in known:
            raise _core.Error(f"the unit {name!r} of REBOUND is not supported; expected one of: {', '.join(known)}")
    L = _LENGTHS[length] / _core.quantity(f"1 {_core.unit_names(units)[0]}", "length", "si")
    T = _TIMES[time] / _core.quantity(f"1 {_core.unit_names(units)[2]}", "time", "si")
    return units, L, T, sim.G * L**3 / T**2 / _core.gravitational_constant(units)


def _names_of(given):
    names = []
    for k, one in enumerate(given):
        name = getattr(one, "name", None)
        if not name:
            value = getattr(getattr(one, "hash", None), "value", 0)  # version 4 keeps no more of a name
            name = f"hash_{value}" if value else f"body_{k + 1}"
        names.append(name if name not in names else f"{name}_{k + 1}")
    return names


def _refuse_what_is_missing(sim):
    """@raise nt.Error for what would make the run another one"""
    for module, fine, instead in (("boundary", ("none",), "nt.Escape stops a run where a particle leaves"),
                                  ("collision", ("none",), "nt.Collision stops a run where two particles meet"),
                                  ("gravity", ("basic", "compensated", "jacobi", "mercurius", "trace", "tree"),
                                   "add forces to an nt.Simulation of nt.rebound.particles(sim)")):
        told = getattr(sim, module, fine[0])
        if told not in fine:
            raise _core.Error(f"{module} = {told!r} of REBOUND is not supported; {instead}")
    if getattr(sim, "N_var", 0):
        raise _core.Error(f"{int(sim.N_var)} variational particles are not supported; nt.rebound.particles(sim) leaves them out")
    for name, instead in (("_additional_forces", "add it with add_force, as docs/from_rebound.md shows"),
                          ("_pre_timestep_modifications", "write it as a force, or change the state with sim.edit"),
                          ("_post_timestep_modifications", "write it as a force, or change the state with sim.edit")):
        if getattr(sim, name, None):
            raise _core.Error(f"{name[1:]} of REBOUND cannot be taken over; make an nt.Simulation of nt.rebound.particles(sim), "
                              f"and {instead}")


def _method_of(sim):
    """The method, its options and its Hamiltonian. @raise nt.Error"""
    name = str(sim.integrator).lower()
    settings = sim.integrator if not isinstance(sim.integrator, str) else getattr(sim, f"ri_{name}", None)

    def setting(key, default):
        try:
            value = getattr(settings, key)
        except (AttributeError, LookupError):
            return default
        if key in _NUMBERED and not isinstance(value, str):
            value = _NUMBERED[key][int(value)]
        return str(value).upper() if isinstance(default, str) else value

    def wisdom_holman(coordinates="jacobi"):
        return parts.part_class("hamiltonian", "wisdom_holman")(coordinates=coordinates)

    if name == "whfast":
        coordinates = _COORDINATES[setting("coordinates", "JACOBI")]
        kernel = _KERNELS[setting("kernel", "DEFAULT")]
        return "verlet_aba", {"corrector": int(setting("corrector", 0)) or None,
                              "kernel": kernel if kernel != "plain" else None,
                              "second_corrector": bool(setting("corrector2", 0)) or None}, wisdom_holman(coordinates)
    if name == "whfast512":
        if setting("gr_potential", 0):
            raise _core.Error("gr_potential of whfast512 is not taken over; add nt.GrPotential() to a simulation of "
                              "nt.rebound.particles(sim)")
        return "verlet_aba", {"corrector": int(setting("corrector", 0)) or None}, wisdom_holman("democratic")
    if name == "saba":
        # H_8_4_4 and CM_2 of version 5 are h(8,4,4) and cm2 of version 4
        kind = re.sub("^(C[ML]|H)_?", r"\1_", re.sub("[(),]+", "_", setting("type", "1")).strip("_"))
        kind = "1" if kind == "DEFAULT" else kind
        if kind.startswith("CM_"):
            return _SABA[kind[3:]], {"kernel": "modified"}, wisdom_holman()
        if kind not in _SABA:
            raise _core.Error(f"saba of type {kind} is not supported; expected one of: {', '.join(_SABA)}, CM_1 to CM_4")
        return _SABA[kind], {}, wisdom_holman()
    if name == "leapfrog":
        return _LEAPFROG[int(setting("order", 2))], {}, None
    if name == "ias15":
        return "gauss_radau_15", {"adaptive": False if setting("epsilon", 1e-9) == 0 else None}, None
    if name == "bs":
        return "gragg_bulirsch_stoer", {"rtol": setting("eps_rel", 1e-8), "atol": setting("eps_abs", 1e-8)}, None
    if name in ("mercurius", "trace"):
        from .simulation import RunWarning

        warnings.warn(f"{name} has no namesake here; gauss_8 takes its place, which chooses its steps and resolves encounters",
                      RunWarning, stacklevel=3)
        return "gauss_8", {}, None
    raise _core.Error(f"the integrator {name!r} of REBOUND is not supported; "
                      + _REFUSED.get(name, 'name a method: method="gauss_8"'))
