"""Pictures of resonances, of chaos, and of ensembles: angles against time, MEGNO, exponents, and maps of what varies."""

import math
import re

from . import _core
from .drawing import (COLOURS, SOFT, STYLE, axes_of, against_time, decades, legend, monitors_of, run_of, scene_text, series_of,
                      time_scale, units_of, with_unit)

# What a map shows unless told, the first that the table has.
_FIGURES = ("megno_mean", "lyapunov_exponent", "resonance_angle_amplitude", "closest_approach_distance", "energy_worst", "time")
# Of MEGNO what tells regular motion, which is at 2, from chaotic motion: it has no upper end.
_LIMITS = {"megno_mean": (1.9, 4), "megno_value": (1.9, 4)}
_NAMES = {"megno_mean": "MEGNO <Y>", "megno_value": "MEGNO Y"}


def _named_like(run, monitor):
    """Monitors of a kind: resonance_angle, resonance_angle_2, ... @raise Error where there is none"""
    found = [one for one in monitors_of(run) if re.fullmatch(rf"{monitor}(_\d+)?", one)]
    return found or [series_of(run, monitor)]


def _resonances(run):
    """What the scene calls its resonances, in the order of their monitors: "3 : 2 of Neptune and Pluto"."""
    names = []
    told = [one for one in getattr(run, "_every", ()) if one.get("type") == "resonance_angle"]
    if not told:
        from .ensembles import _tables

        tables = _tables(scene_text(run) or "") if hasattr(run, "scene") and isinstance(run.scene, str) else {}
        told = [one for one in tables.get("every", ()) if one.get("type") == "resonance_angle"]
    for one in told:
        p, q, bodies = one.get("p", 1), one.get("q", 1), one.get("bodies", ("", ""))
        names.append(f"{p + q} : {p} of {bodies[0]} and {bodies[1]}")
    return names


def resonance_angles(run, *, ax=None):
    """Angles of resonances of mean motions against time, in degrees: bands where they librate, the whole height where they
    circulate. About 180 degrees where most of an angle is there, else about 0.

    Needs a monitor resonance_angle.
    """
    import numpy

    run = run_of(run)
    names = _resonances(run)
    ax = axes_of(ax)
    angles = []
    for k, name in enumerate(_named_like(run, "resonance_angle")):
        series = series_of(run, name)
        angles.append((k, series.time, numpy.degrees(numpy.asarray(series["value"], dtype=float))))
    about_half = sum((abs(angle) > 90).sum() for _, _, angle in angles) > sum(len(angle) for _, _, angle in angles) / 2
    for k, times, angle in angles:
        angle = numpy.where(angle < 0, angle + 360, angle) if about_half else angle
        ax.plot(against_time(ax, units_of(run), times), angle, ".", ms=2.5, mew=0, color=COLOURS[k % len(COLOURS)],
                label=names[k] if k < len(names) else f"resonance {k + 1}")
    low = 0 if about_half else -180
    ax.set_ylim(low, low + 360)
    ax.set_yticks(range(low, low + 361, 90))
    ax.set_ylabel("resonance angle (deg)")
    legend(ax, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, borderaxespad=0.2, markerscale=3)
    return ax


def megno(run, *, ax=None):
    """<Y> of MEGNO against time: it tends to 2 where motion is regular, and grows where it is chaotic.

    Needs the monitor megno."""
    run = run_of(run)
    ax = axes_of(ax)
    ax.axhline(2, color=SOFT, lw=0.8, ls=(0, (4, 3)))
    for k, name in enumerate(_named_like(run, "megno")):
        series = series_of(run, name)
        ax.plot(against_time(ax, units_of(run), series.time), series["mean"], color=COLOURS[k % len(COLOURS)])
    ax.set_ylabel("MEGNO <Y>")
    return ax


def lyapunov(run, *, ax=None):
    """The largest Lyapunov exponents against time, those above zero, on logarithmic axes: they fall as 1/t where motion is
    regular, and level out where it is chaotic. Needs the monitor lyapunov."""
    import numpy

    run = run_of(run)
    ax = axes_of(ax)
    series = series_of(run, "lyapunov")
    times = against_time(ax, units_of(run), series.time)
    scale = time_scale(units_of(run), series.time)[0]
    values = numpy.asarray(series["exponent"], dtype=float).reshape(len(times), -1) * scale
    for k in range(values.shape[1]):
        keep = (times > 0) & (values[:, k] > 0)
        if keep.any():
            ax.plot(times[keep], values[keep, k], color=COLOURS[k % len(COLOURS)], label=f"exponent {k + 1}")
    ax.set_xscale("log")
    decades(ax)
    name = ax.get_xlabel().partition("(")[2].rstrip(")")
    ax.set_ylabel(with_unit("Lyapunov exponent", f"1/{name}" if name else ""))
    if values.shape[1] > 1:
        legend(ax, outside=True)
    return ax


# ---- ensembles --------------------------------------------------------------------------------------------------------

def ensemble(what, figure=None, *, x=None, y=None, log=None, limits=None, cmap="viridis", ax=None):
    """A figure of every member over two keys that vary, in colour; over one key against it.

    what : a Dataset of `nt.ensemble`, or the path of its file
    figure : a variable of the table, "megno_mean"; of one with several numbers which: "elements_value.b.e"; default: a chaos
        indicator, else the first figure that differs from member to member
    x, y : keys; default: the first key goes across and the second up, as they were given
    log : whether colours are logarithmic; default: where values are above zero and span more than two decades
    limits : values of the lowest and the highest colour; default: all but the outermost hundredth, of MEGNO 1.9 and 4

    Grids are drawn as maps, of further grids and of draws at each point the mean; draws as points. Members without a value
    are left out. @return the axes
    """
    table = _table_of(what)
    keys = _keys_of(table)
    x = _known_key(keys, x) if x is not None else next((key for key in keys if key != y), None)
    y = _known_key(keys, y) if y is not None else next((key for key in keys if key != x), None)
    name, values = _figure_of(table, figure, keys)
    values = _members_only(values, table)
    unit = values.attrs.get("units", "1")
    label = with_unit(_NAMES.get(name, name.replace("_", " ")), unit if "," not in unit else "")
    if y is None or x == y:
        ax = axes_of(ax)
        ax.plot(*_flat(table, values, x), ".", ms=5, mew=0, color=COLOURS[0])
        ax.set_ylabel(label)
    else:
        ax = axes_of(ax, (5.6, 4.4))
        colours = _colours(values, log, _LIMITS.get(name) if limits is None and not log else limits)
        with _style():
            if x in values.dims and y in values.dims:
                drawn = _map(ax, values, x, y, cmap, colours)
            else:
                across, up, numbers = _flat(table, values, x, y)
                drawn = ax.scatter(across, up, c=numbers, s=14, lw=0, cmap=cmap, norm=colours[0])
            ax.grid(False)
            bar = ax.figure.colorbar(drawn, ax=ax, pad=0.02, label=label, extend=colours[1])
            bar.outline.set_visible(False)
        ax.set_ylabel(_key_label(table, y))
    ax.set_xlabel(_key_label(table, x))
    return ax


def _key_label(table, key):
    """"a of Saturn (au)" of particles.body.Saturn.a."""
    of_body = re.fullmatch(r"particles\.body\.(.+)\.(\w+)", key)
    name = f"{of_body.group(2)} of {of_body.group(1)}" if of_body else key
    return with_unit(name, table[key].attrs.get("units", "1"))


def _style():
    import matplotlib

    return matplotlib.rc_context(STYLE)


def _table_of(what):
    if hasattr(what, "data_vars"):
        return what
    if isinstance(what, (str, bytes)) or hasattr(what, "__fspath__"):
        from .ensembles import open_ensemble

        return open_ensemble(what)
    raise TypeError(f"{type(what).__name__} is not an ensemble; give what nt.ensemble returns, or the path of its file")


def _keys_of(table):
    return [one.partition("=")[0].strip() for one in table.attrs["vary"]]


def _known_key(keys, key):
    from .parts import _proposal

    if key not in keys:
        raise KeyError(f"{key!r} does not vary{_proposal(key, dict.fromkeys(keys))}")
    return key


def _figure_of(table, figure, keys):
    """The name and the values of a figure. @raise KeyError"""
    import numpy

    from .parts import _proposal

    numbers = [name for name, values in table.data_vars.items() if values.dtype.kind in "fi"]
    if figure is None:
        single = [name for name in numbers if not _own_dimensions(table, table[name])]
        differ = [one for one in single if numpy.unique(table[one]).size > 1]
        figure = next((one for one in _FIGURES if one in differ or one in numbers and one not in single), "time")
    name, *places = figure.split(".")
    if name not in numbers:
        raise KeyError(f"the table has no figure {name!r}{_proposal(name, dict.fromkeys(numbers))}")
    values = table[name]
    for place in places:
        values = _one_of(table, values, figure, place)
    for dimension in _own_dimensions(table, values):
        values = values.isel({dimension: 0})
    return figure, values


def _own_dimensions(table, values):
    """Dimensions of a variable that are not those of members."""
    return [one for one in values.dims if one not in table["outcome"].dims]


def _one_of(table, values, figure, place):
    own = _own_dimensions(table, values)
    for dimension in own:
        if dimension in table.coords and place in [str(one) for one in table[dimension].values]:
            return values.isel({dimension: [str(one) for one in table[dimension].values].index(place)})
    if own and place.isdigit() and int(place) < values.sizes[own[0]]:
        return values.isel({own[0]: int(place)})
    there = [str(one) for dimension in own if dimension in table.coords for one in table[dimension].values]
    raise KeyError(f"{figure} has no {place!r}; it has: {', '.join(there) or 'one number'}")


def _members_only(values, table):
    """Whole numbers as numbers that may lack, and nothing of members that could not be made."""
    return values.astype(float).where(table["outcome"] != "refused")


def _flat(table, values, *keys):
    """Numbers of keys, and of the figure, member by member."""
    coordinates = [table[key].broadcast_like(values).transpose(*values.dims).values.ravel() for key in keys]
    return (*coordinates, values.values.ravel())


def _colours(values, log, limits):
    """What makes a number a colour, and on which sides there are more."""
    import numpy
    from matplotlib.colors import LogNorm, Normalize

    told = values.values[numpy.isfinite(values.values)]
    if not len(told):
        raise _core.Error("no member has this figure: there is nothing to draw")
    least, most = float(told.min()), float(told.max())
    low, high = limits if limits is not None else (float(one) for one in numpy.quantile(told, [0.01, 0.99]))
    if limits is None and most - least <= 1.5 * (high - low):
        low, high = least, most
    if log is None:
        log = limits is None and least > 0 and high > 100 * max(low, math.ulp(0.0))
    if log and not low > 0:
        raise ValueError(f"colours from {low:g} on cannot be logarithmic; give limits above 0, or log=False")
    more = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}
    return (LogNorm if log else Normalize)(low, high), more[least < low, most > high]


def _map(ax, values, x, y, cmap, colours):
    others = [one for one in values.dims if one not in (x, y)]
    values = values.mean(others, skipna=True).transpose(y, x) if others else values.transpose(y, x)
    return ax.pcolormesh(values[x].values, values[y].values, values.values, cmap=cmap, norm=colours[0], shading="nearest",
                         rasterized=True)
