"""Bodies from tables and ephemerides: the Solar System, CSV, JPL Horizons, SPK kernels. Each function gives `nt.Particles`.

Masses of bodies that a source does not give are GM / G with GM of JPL's DE440 and of the solutions for satellites beside it
(Park et al. 2021), the same as for vector tables of Horizons.
"""

import os

from . import _core, parts
from .particles import Particles

AU_KM = 149597870.7  # IAU 2012, Resolution B2
_OBLIQUITY = 84381.448  # arcseconds, of the ecliptic of J2000: IAU 1976, as JPL Horizons has it
_HORIZONS = "https://ssd.jpl.nasa.gov/api/horizons.api"

# Numbers of NAIF. A planet other than the Earth is taken with its moons, as their barycenter: what moves the others.
_NUMBERS = {
    "Sun": 10, "Mercury": 1, "Venus": 2, "Earth": 399, "Moon": 301, "Earth-Moon": 3, "Mars": 4, "Jupiter": 5, "Saturn": 6,
    "Uranus": 7, "Neptune": 8, "Pluto": 9,
    "Phobos": 401, "Deimos": 402, "Io": 501, "Europa": 502, "Ganymede": 503, "Callisto": 504,
    "Mimas": 601, "Enceladus": 602, "Tethys": 603, "Dione": 604, "Rhea": 605, "Titan": 606, "Hyperion": 607, "Iapetus": 608,
    "Ariel": 701, "Umbriel": 702, "Titania": 703, "Oberon": 704, "Miranda": 705, "Triton": 801, "Charon": 901,
}
_MAJOR = ("Sun", "Mercury", "Venus", "Earth", "Moon", "Earth-Moon", "Mars", "Jupiter", "Saturn", "Uranus", "Neptune", "Pluto")


def solar_system(*, units="solar", frame="barycenter", **table):
    """The Sun and the eight planets (the Earth with the Moon), in the ecliptic of J2000: 9 bodies, as the example has them.

    units : "solar" (au, day, Msun) or "si"
    frame : "barycenter" or "as_given"
    table : further keys of [particles]
    """
    return from_csv(_example_file("solar_system", "planets.csv"), units=units, frame=frame, **table)


def outer_solar_system(*, units="solar", frame="barycenter", **table):
    """The Sun with the inner planets' mass, Jupiter to Pluto, equatorial: 6 bodies.

    From Hairer, Lubich and Wanner (2006), table 2.2 of section I.2. The epoch is 1994 September 5 (JD 2449600.5); as given, the
    Sun rests at the origin. Keywords as of `solar_system`.
    """
    return from_csv(_example_file("outer_solar_system", "outer_planets.csv"), units=units, frame=frame, **table)


def from_csv(file, *, units="solar", **table):
    """Bodies of a CSV file: mass, and positions and velocities, or elements; docs/bodies.md has the columns.

    nt.FileError if the file cannot be read, nt.Error for what is wrong in it, with its line. Read at once; a run reads it
    again, and refuses one that has changed.
    """
    return _read(file, units, table)


def from_horizons_table(files, *, units="solar", **table):
    """Bodies of vector tables that JPL Horizons has printed, as text or as the JSON of its API; docs/bodies.md has the rules.

    files : one file, with a table for each body one after the other, or a list of files

    The body at the origin of the tables joins them as the first. nt.FileError and nt.Error as in `from_csv`.
    """
    if isinstance(files, (str, os.PathLike)):
        return _read(files, units, table)
    texts = []
    for file in files:
        try:
            with open(file, encoding="utf-8") as opened:
                texts.append(opened.read())
        except OSError as wrong:
            raise _core.FileError(f"{os.fspath(file)}: cannot be read: {wrong.strerror}") from None
    if not texts:
        raise ValueError("from_horizons_table was given no file")
    return _from_text("\n".join(texts), units, table)


def from_spk(file, epoch, bodies=None, *, masses=None, axes="equatorial", units="solar", **table):
    """Bodies of an SPK kernel of JPL, such as de421.bsp or de440s.bsp, at one moment. Needs jplephem.

    epoch : a Julian day (TDB) as a number or "JD 2451545", a date "2000-01-01 12:00" (TDB), or a Time of astropy
    bodies : names ("Sun", "Earth", "Io", ...) or numbers of NAIF; default: the Sun, the planets and the Moon. Jupiter is its
        barycenter with all its moons, as other planets but the Earth; with moons of its own in the list write its number, 599
    masses : {2000433: "6.69e15 kg"}: of bodies whose GM is not built in, or in place of it; 0 is a tracer
    axes : "equatorial", those of the kernel (ICRF), or "ecliptic", of J2000
    units : "solar" or "si"

    Positions and velocities are barycentric, and those that jplephem computes to the bit; km and km/day are divided by 1 au
    (149597870.7 km) in solar units. KeyError for a body that is not in the kernel, nt.Error for an epoch outside of it.
    """
    try:
        from jplephem.spk import SPK
    except ImportError:
        raise ImportError("reading SPK kernels needs jplephem: pip install jplephem") from None
    if axes not in ("equatorial", "ecliptic"):
        raise ValueError(f"axes = {axes!r}; 'equatorial' or 'ecliptic' is expected")
    day, rest = _julian_day(epoch)
    file = os.fspath(file)
    try:
        kernel = SPK.open(file)
    except OSError as wrong:
        raise _core.FileError(f"{file}: cannot be read: {wrong.strerror or wrong}") from None
    except (ValueError, IndexError, UnicodeDecodeError) as wrong:
        raise _core.FileError(f"{file}: it is not an SPK kernel: {wrong}") from None
    try:
        rows = _spk_rows(kernel, file, day, rest, bodies)
    finally:
        kernel.close()
    if axes == "ecliptic":
        rows = [(name, number, _to_ecliptic(x), _to_ecliptic(v)) for name, number, x, v in rows]
    all_masses = [_mass(name, number, masses, units) for name, number, _, _ in rows]
    return Particles.from_arrays(all_masses, [_from_km(x, units) for _, _, x, _ in rows],
                                 [_from_km_per_day(v, units) for _, _, _, v in rows], [name for name, *_ in rows],
                                 units=units, epoch=f"JD {day + rest!r} TDB", **table)


def horizons(bodies, epoch, *, center="Sun", masses=None, save=None, units="solar", timeout=30.0, **table):
    """Bodies from the service of JPL Horizons, over the net; ConnectionError where it cannot be reached.

    bodies : a name, a number of NAIF, what Horizons calls a target ("Ceres;", "DES=1P;"), or a list of these
    epoch : as in `from_spk`
    center : the body at the origin, which becomes the first body, or "barycenter" of the Solar System (then the Sun has to
        be one of the bodies)
    masses : {"Eros;": "6.69e15 kg"}: of bodies whose GM is not built in; 0 is a tracer
    save : a file for the answers: later runs read it, nt.bodies.from_horizons_table(save), and need no net

    One request for each body, in the ecliptic of J2000; bodies are called as here. nt.Error for a name that Horizons does not
    know, with its answer.
    """
    day, rest = _julian_day(epoch)
    names = [bodies] if isinstance(bodies, (str, int)) else list(bodies)
    origin = 0 if center == "barycenter" else _number(center)
    texts = [_with_mass(_ask_horizons(_target(name), origin, day + rest, timeout), name, masses, units)
             for name in names if _target(name) != str(origin)]
    if not texts:
        raise ValueError(f"{names!r} are all at the center; name other bodies, or another center")
    text = "\n".join(texts)
    if save is not None:
        with open(save, "w", encoding="utf-8") as opened:
            opened.write(text)
    return _from_text(text, units, table, {str(_number(name)): name for name in names if name in _NUMBERS})


# ---- inside ---------------------------------------------------------------------------------------------------------


def _read(file, units, table):
    made = Particles(bodies=os.fspath(file), units=units, **table)
    made._state()
    return made


def _from_text(text, units, table, called=None):
    """Bodies of tables that are in no file: what the engine reads from one that is there for a moment.

    called : names in place of those of Horizons, by number
    """
    import re
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "tables.txt")
        with open(file, "w", encoding="utf-8") as opened:
            opened.write(text)
        try:
            read = _read(file, units, table)
        except _core.Error as wrong:
            raise type(wrong)(str(wrong).replace(folder + os.sep, "")) from None
        rest = {key: value for key, value in table.items() if key not in ("frame", "epoch")}
        names = read.names
        for number, name in (called or {}).items():
            # "Mars Barycenter" of the head "Mars Barycenter (4)"
            found = re.search(rf"body name: *(.+?) *\({number}\)", text)
            names = [name if found and one == found.group(1) else one for one in names]
        return Particles.from_arrays(read.masses, read.positions, read.velocities, names, units=units, epoch=read.epoch, **rest)


def _example_file(example, name):
    from .scenes import _example_folders

    for folder in _example_folders():
        file = os.path.join(folder, example, name)
        if os.path.exists(file):
            return os.path.realpath(file)
    raise FileNotFoundError(f"the table {name} of the example {example} is missing from this package")


def _julian_day(epoch):
    """A moment as two numbers whose sum is the Julian day, TDB."""
    tdb = getattr(epoch, "tdb", None)
    if tdb is not None:  # astropy
        return float(tdb.jd1), float(tdb.jd2)
    import datetime
    import numbers

    given = epoch
    if isinstance(epoch, numbers.Real) and not isinstance(epoch, bool):
        return float(epoch), 0.0
    if isinstance(epoch, str):
        words = epoch.split()
        try:
            if words and words[0].upper() == "JD" and (len(words) == 2 or words[2:] == ["TDB"]):
                return float(words[1]), 0.0
            epoch = datetime.datetime.fromisoformat(epoch.strip())
        except ValueError:
            epoch = None
    if not isinstance(epoch, datetime.date):
        raise ValueError(f"epoch = {given!r}; a Julian day such as 2451545.0 or 'JD 2451545', a date such as "
                         "'2000-01-01 12:00', or a Time of astropy is expected")
    seconds = 0.0
    if isinstance(epoch, datetime.datetime):
        seconds = epoch.hour * 3600 + epoch.minute * 60 + epoch.second + epoch.microsecond / 1e6
    return epoch.toordinal() + 1721424.5, seconds / 86400


def _number(body):
    """The number of NAIF of a body. @raise KeyError"""
    if isinstance(body, int) and not isinstance(body, bool):
        return body
    for name, number in _NUMBERS.items():
        if isinstance(body, str) and body.strip().lower() == name.lower():
            return number
    raise KeyError(f"no body is called {body!r} here{parts._proposal(str(body), _NUMBERS)}; a number of NAIF serves too")


def _name(body, number):
    if isinstance(body, str):
        return body
    return next((name for name, one in _NUMBERS.items() if one == number), f"body {number}")


def _mass(name, number, masses, units):
    """A mass that was given, or GM / G. @raise nt.Error"""
    from .quantities import number_of

    for key in (name, number):
        if masses and key in masses:
            return number_of(masses[key], "mass", units)
    GM = _core.known_gm(number)
    if GM is None:
        raise _core.Error(f"the mass of {name!r} is not built in; give it: masses={{{name!r}: '1e20 kg'}}, or 0 for a tracer")
    return _core.quantity(f"{GM!r} km^3/s^2", "length^3/time^2", units) / _core.gravitational_constant(units)


def _spk_rows(kernel, file, day, rest, bodies):
    """Name, number, position [km] and velocity [km/day] of each body."""
    segments = {}
    for segment in kernel.segments:
        segments.setdefault(segment.target, []).append(segment)
    if bodies is None:
        wanted = [name for name in _MAJOR if _NUMBERS[name] in segments]
        bodies = [name for name in wanted if name != "Earth-Moon" or "Earth" not in wanted]
    elif isinstance(bodies, (str, int)):
        bodies = [bodies]
    numbers = [_number(body) for body in bodies]
    for number in numbers:
        if 10 < number < 1000 and number // 100 in numbers:
            whole = number // 100
            alone = "" if whole == 3 or number % 100 == 99 else f", or write {whole}99 for the planet without its moons"
            raise _core.Error(f"{_name(None, number)} ({number}) is part of {_name(None, whole)} ({whole}), whose mass contains "
                              f"it; leave one of them out{alone}")
    return [(_name(body, number), number, *_spk_state(segments, file, number, day, rest))
            for body, number in zip(bodies, numbers)]


def _spk_state(segments, file, number, day, rest):
    """Position and velocity about the barycenter of the Solar System, by the segments that lead there."""
    chain = []
    at = number
    while at != 0:
        if at not in segments:
            raise KeyError(f"{_name(None, number)} ({number}) is not in {file}; it has: "
                           + ", ".join(f"{_name(None, one)} ({one})" for one in sorted(segments)))
        fitting = [one for one in segments[at] if one.start_jd <= day + rest <= one.end_jd]
        if not fitting:
            first, last = min(one.start_jd for one in segments[at]), max(one.end_jd for one in segments[at])
            raise _core.Error(f"{file}: JD {day + rest} is outside of what it has of {_name(None, at)}: JD {first} to {last}")
        chain.append(fitting[-1])
        at = chain[-1].center
    x = v = 0.0
    for segment in reversed(chain):
        try:
            dx, dv = segment.compute_and_differentiate(day, rest)
        except (ValueError, AttributeError) as wrong:
            raise _core.Error(f"{file}: {_name(None, segment.target)} cannot be computed by jplephem: {wrong}") from None
        x, v = x + dx, v + dv
    return x, v


def _to_ecliptic(vector):
    import math

    import numpy

    angle = math.radians(_OBLIQUITY / 3600)
    c, s = math.cos(angle), math.sin(angle)
    return numpy.array([vector[0], c * vector[1] + s * vector[2], c * vector[2] - s * vector[1]])


def _from_km(x, units):
    return x / AU_KM if units == "solar" else x * _core.quantity("1 km", "length", units)


def _from_km_per_day(v, units):
    return v / AU_KM if units == "solar" else v * _core.quantity("1 km/day", "velocity", units)


def _target(body):
    """What Horizons calls a body."""
    try:
        return str(_number(body))
    except KeyError:
        return str(body)


def _ask_horizons(target, origin, jd, timeout):
    """The vector table of one body. @raise ConnectionError, nt.Error"""
    import urllib.error
    import urllib.parse
    import urllib.request

    query = {"format": "text", "COMMAND": target, "CENTER": f"500@{origin}", "EPHEM_TYPE": "VECTORS", "MAKE_EPHEM": "YES",
             "OBJ_DATA": "NO", "TLIST": repr(jd), "TLIST_TYPE": "JD", "TIME_TYPE": "TDB", "REF_PLANE": "ECLIPTIC",
             "REF_SYSTEM": "ICRF", "OUT_UNITS": "AU-D", "VEC_TABLE": "2", "VEC_CORR": "NONE", "CSV_FORMAT": "YES"}
    url = _HORIZONS + "?" + urllib.parse.urlencode(
        {key: value if key == "format" else f"'{value}'" for key, value in query.items()})
    try:
        with urllib.request.urlopen(url, timeout=timeout) as answer:
            text = answer.read().decode("utf-8", "replace")
    except urllib.error.HTTPError as wrong:
        told = _first_lines(wrong.read().decode("utf-8", "replace"))
        raise _core.Error(f"Horizons refused {target!r}: HTTP {wrong.code}: {told}") from None
    except OSError as wrong:
        raise ConnectionError(f"JPL Horizons cannot be reached ({getattr(wrong, 'reason', wrong)}); without a net use "
                              "nt.bodies.solar_system(), or read a saved table with nt.bodies.from_horizons_table") from None
    if "$$SOE" not in text:
        raise _core.Error(f"Horizons has no vectors of {target!r}: {_first_lines(text)}")
    return text


def _first_lines(text):
    lines = [line.strip() for line in text.splitlines() if line.strip(" *\t")]
    return " / ".join(lines[:6])[:400]


def _with_mass(text, name, masses, units):
    """A table with the line of a mass that was given."""
    from .quantities import with_units

    if not masses or name not in masses:
        return text
    value = with_units(masses[name], "mass", units)
    kilograms = _core.quantity(value, "mass", "si") if isinstance(value, str) else float(value)
    return text.replace("$$SOE", f"mass [kg] = {kilograms!r}\n$$SOE", 1)
