"""Pictures of bodies: orbits, positions, elements."""

import math

from . import _core
from .drawing import (
    COLOURS, SOFT, FAINT, PRIMARY, NAMED, MOST_NAMES, styled, axes_of, run_of, frames_of, frames_needed, units_of,
    scene_text, with_unit, length_scale, time_scale, against_time, legend, places_of)


def primary_of(masses, names, about, run):
    """The place of the body that others go about, or None."""
    import numpy

    if about is None:
        return None
    if about != "auto":
        if isinstance(about, str) and about not in list(names):
            from .parts import _proposal

            raise KeyError(f"no body is called {about!r}{_proposal(about, dict.fromkeys(names))}")
        return list(names).index(about) if isinstance(about, str) else range(len(names))[about]
    if masses is None or len(masses) < 2:
        return None
    text = scene_text(run)
    if text is not None and hasattr(run, "series") and "gravity" not in text and "wisdom_holman" not in text:
        return None
    heaviest = int(numpy.argmax(masses))
    return heaviest if masses[heaviest] > 10 * (numpy.sum(masses) - masses[heaviest]) else None


def _ellipse(x, v, mu, points=361):
    """The osculating conic about the origin, shape (points, 3): of a hyperbola what lies within four times the distance."""
    import numpy

    r = math.sqrt(x @ x)
    h = numpy.cross(x, v)
    e_vector = numpy.cross(v, h) / mu - x / r
    e, h2 = math.sqrt(e_vector @ e_vector), h @ h
    if h2 == 0 or r == 0:
        return None
    p_way = e_vector / e if e > 1e-12 else x / r
    q_way = numpy.cross(h / math.sqrt(h2), p_way)
    if e < 1:
        a = h2 / mu / (1 - e * e)
        angle = numpy.linspace(0, 2 * math.pi, points)[:, None]
        return a * ((numpy.cos(angle) - e) * p_way + math.sqrt(1 - e * e) * numpy.sin(angle) * q_way)
    furthest = math.acos(max(-1.0, min(1.0, (h2 / mu / (4 * r) - 1) / e)))
    angle = numpy.linspace(-furthest, furthest, points)[:, None]
    return h2 / mu / (1 + e * numpy.cos(angle)) * (numpy.cos(angle) * p_way + numpy.sin(angle) * q_way)


def _path(times, x, v):
    """A smooth path through frames, shape (points, 3), by cubics through positions and velocities; None where frames lie too
    far apart for that."""
    import numpy

    if v is None or len(x) < 2:
        return None
    speeds = numpy.sqrt((v ** 2).sum(1))
    cosines = (v[1:] * v[:-1]).sum(1) / numpy.maximum(speeds[1:] * speeds[:-1], 1e-300)
    if numpy.quantile(cosines, 0.1) < 0.5:  # most turn by less than 60 degrees from frame to frame
        return None
    step = numpy.diff(times)[:, None, None]
    length = numpy.sqrt((numpy.diff(x, axis=0) ** 2).sum(1))
    expected = numpy.maximum(abs(step[:, 0, 0]) * 0.5 * (speeds[1:] + speeds[:-1]), 1e-300)
    if numpy.quantile(length / expected, 0.1) < 0.6 or numpy.quantile(length / expected, 0.9) > 2:  # it went around in between
        return None
    parts = int(max(1, min(12, 20000 // len(x))))
    s = numpy.linspace(0, 1, parts, endpoint=False)[None, :, None]
    a, b, u, w = x[:-1, None], x[1:, None], v[:-1, None] * step, v[1:, None] * step
    between = (1 + 2 * s) * (1 - s) ** 2 * a + s * (1 - s) ** 2 * u + s * s * (3 - 2 * s) * b + s * s * (s - 1) * w
    return numpy.concatenate([between.reshape(-1, 3), x[-1:]])


def _moments(what, frame, most=4000):
    """Times, positions and velocities (frames, n, 3) up to one that is shown, masses, names, units."""
    import numpy

    frames = frames_of(what)
    if frames is None:
        if not hasattr(what, "positions"):
            frames_needed(what)
        return (numpy.zeros(1), numpy.asarray(what.positions)[None], numpy.asarray(what.velocities)[None],
                numpy.asarray(what.masses), what.names, units_of(what))
    last = range(len(frames))[frame]
    first = max(0, last + 1 - max(1, min(most, 4_000_000 // len(frames.names))))
    times, x = numpy.asarray(frames.time[first:last + 1]), numpy.asarray(frames.positions[first:last + 1])
    v = None if frames.velocities is None else numpy.asarray(frames.velocities[first:last + 1])
    if hasattr(what, "record_frames") and last == len(frames) - 1 and what.time != times[-1]:  # where the run stands now
        times = numpy.append(times, what.time)
        x, v = numpy.concatenate([x, what.positions[None]]), numpy.concatenate([v, what.velocities[None]])
    return times, x, v, frames.masses, frames.names, frames.units


def orbits(what, *, bodies=None, about="auto", projection="xy", ellipses=True, frame=-1, names=True, ax=None):
    """Paths of bodies and their osculating ellipses, on equal axes.

    what : a Simulation (its recorded frames, and where it stands), Particles, frames, a Report, a RunFile or a path
    bodies : names or places of those that are drawn; default: all. Inner planets alone are larger
    about : the body that positions are relative to, and ellipses go about; default: the heaviest where bodies attract each
        other and it has ten times the mass of all others; None: none
    projection : "xy", "xz", "yz" or "3d"
    ellipses : whether they are drawn; they need masses, velocities and a primary
    frame : the last frame that is drawn, at which ellipses touch; frames close in time are joined by cubics, others are dots
    names : whether there is a legend; more than 12 bodies have none

    Costs up to 4000 frames in memory, of many bodies fewer.
    """
    import numpy

    run = run_of(what)
    if projection not in ("xy", "xz", "yz", "3d"):
        raise ValueError(f"projection = {projection!r}; one of 'xy', 'xz', 'yz', '3d' is expected")
    times, x, v, masses, all_names, units = _moments(run, frame)
    primary = primary_of(masses, all_names, about, run)
    chosen = places_of(bodies, all_names)
    if primary is not None:
        x = x - x[:, primary:primary + 1]
        v = None if v is None else v - v[:, primary:primary + 1]
    scale, length = length_scale(units, float(numpy.abs(x[:, chosen]).max()))
    flat = projection != "3d"
    axes = [0, 1, 2] if not flat else ["xyz".index(letter) for letter in projection]
    ax = axes_of(ax, (6.2, 4.6), **({} if flat else {"projection": "3d"}))
    colours = iter(COLOURS * (1 + len(all_names) // len(COLOURS)))
    for body in range(len(all_names)):
        name = str(all_names[body]) or str(body)
        colour = NAMED.get(name.lower()) or (PRIMARY if body == primary else next(colours))
        if body not in chosen and body != primary:
            continue
        label = name if names and 1 < len(all_names) <= MOST_NAMES else None
        draw = {"color": colour, "solid_capstyle": "round"}
        if body != primary:
            path = _path(times, x[:, body], None if v is None else v[:, body])
            if path is not None:
                ax.plot(*(scale * path[:, axes]).T, lw=1.1 if primary is None else 0.8, alpha=0.85, **draw)
            elif len(x) > 1:
                ax.plot(*(scale * x[:-1, body][:, axes]).T, ".", ms=3, mew=0, alpha=0.7, color=colour)
            if ellipses and primary is not None and v is not None and masses is not None:
                mu = _core.gravitational_constant(units) * (masses[primary] + masses[body])
                conic = _ellipse(x[-1, body], v[-1, body], float(mu))
                if conic is not None:
                    ax.plot(*(scale * conic[:, axes]).T, lw=1.2, alpha=0.9, **draw)
        ax.plot(*[[scale * x[-1, body, k]] for k in axes], "o", ms=7 if body == primary else 4.5, color=colour, label=label,
                zorder=5)
    origin = "" if primary is None or not flat or not all_names[primary] else f" from {all_names[primary]}"
    for letter, k in zip("xyz", axes):
        getattr(ax, f"set_{letter}label")(with_unit("xyz"[k] + origin, length))
    _equal(ax, flat)
    legend(ax, outside=True, **({} if flat else {"loc": "upper left", "bbox_to_anchor": (0.0, 1.0)}))
    return ax


def _equal(ax, flat):
    if flat:
        ax.set_aspect("equal", adjustable="datalim")
        return
    ax.set_aspect("equal")
    ends = [getattr(ax, f"get_{letter}lim")() for letter in "xyz"]
    ax.set_box_aspect([high - low for low, high in ends], zoom=1.2)
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.pane.set_visible(False)
        axis.line.set_color(FAINT)
        axis._axinfo["grid"]["color"] = FAINT


def positions(what, *, projection="xy", frame=-1, color=COLOURS[0], ax=None):
    """Where all particles are at one frame: discs of about their distance, paler the further away; in a periodic box wrapped
    into it.

    projection : "xy", "xz" or "yz"
    """
    import numpy
    from matplotlib.collections import EllipseCollection
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.patches import Rectangle

    if projection not in ("xy", "xz", "yz"):
        raise ValueError(f"projection = {projection!r}; one of 'xy', 'xz', 'yz' is expected")
    run = run_of(what)
    frames = frames_of(run)
    box = getattr(run.frames if hasattr(run, "record_frames") else frames, "box", None)
    x = numpy.array(run.positions if frames is None and hasattr(run, "positions") else frames_needed(run).positions[frame])
    units = units_of(run)
    edges = None if box is None else numpy.asarray(box, dtype=float).reshape(-1)[-3:]
    if edges is not None:
        x = x - numpy.floor(x / edges) * edges
    a, b = ("xyz".index(letter) for letter in projection)
    depth = 3 - a - b
    extent = edges if edges is not None else numpy.maximum(x.max(0) - x.min(0), 1e-300)
    width = 0.75 * (float(numpy.prod(numpy.maximum(extent, 0.05 * extent.max()))) / len(x)) ** (1 / 3)
    if edges is None and len(x) <= 2000:  # such as a chain, which fills no volume
        apart = ((x[:, None] - x[None]) ** 2).sum(axis=2)
        numpy.fill_diagonal(apart, numpy.inf)
        width = min(width, 0.9 * math.sqrt(float(numpy.median(apart.min(axis=1)))))
    flat = extent[depth] <= 1e-9 * extent.max()
    x = x[numpy.argsort(x[:, depth] if depth != 1 else -x[:, 1])]
    scale, length = length_scale(units, float(extent.max()))
    ax = axes_of(ax, (4.4, 4.4))
    discs = EllipseCollection(scale * width, scale * width, 0, units="xy", offsets=scale * x[:, [a, b]],
                              transOffset=ax.transData, array=numpy.linspace(1 if flat else 0, 1, len(x)),
                              edgecolor="white", linewidth=0.4,
                              clim=(0, 1), cmap=LinearSegmentedColormap.from_list("depth", ["#eef2f7", color]))
    ax.add_collection(discs)
    if edges is not None:
        ax.add_patch(Rectangle((0, 0), scale * edges[a], scale * edges[b], fill=False, edgecolor=SOFT, linewidth=0.8))
    ax.autoscale_view()
    ax.grid(False)
    ax.set_aspect("equal")
    ax.set_xlabel(with_unit("xyz"[a], length))
    ax.set_ylabel(with_unit("xyz"[b], length))
    return ax


ELEMENT_NAMES = {"a": "semi-major axis a", "e": "eccentricity e", "inc": "inclination", "Omega": "node Omega",
                  "omega": "pericenter omega", "M": "mean anomaly M", "P": "period P"}


def elements(what, bodies=None, *, quantities=("a", "e", "inc"), about="auto", ax=None):
    """Osculating elements against time, from frames: one axis for each quantity; angles in degrees.

    bodies : names or places; default: all but the primary
    quantities : of a, e, inc, Omega, omega, M, P, one or several
    about : as in `orbits`; there has to be one
    ax : axes, as many as there are quantities; one of them for one

    Costs up to 20,000 frames in memory; of more, every so many-th is taken.

    @return the axes of one quantity, or an array of them
    """
    import numpy

    from .particles import elements_of

    run = run_of(what)
    frames = frames_needed(run)
    wanted = [quantities] if isinstance(quantities, str) else list(quantities)
    for one in wanted:
        if one not in ELEMENT_NAMES:
            raise ValueError(f"quantities has {one!r}; of {', '.join(ELEMENT_NAMES)} are expected")
    if frames.velocities is None or frames.masses is None:
        raise _core.Error("elements need velocities and masses in the frames")
    primary = primary_of(frames.masses, frames.names, about, run)
    if primary is None:
        raise _core.Error("elements need a primary, and no body is ten times as heavy as all others; give about=...")
    own = ax is None
    if own:
        with styled() as plt:
            ax = plt.subplots(len(wanted), 1, figsize=(6.2, 0.6 + 1.7 * len(wanted)), sharex=True, layout="constrained",
                              squeeze=False)[1][:, 0]
    all_axes = numpy.atleast_1d(numpy.asarray(ax, dtype=object)).ravel()
    if len(all_axes) != len(wanted):
        raise ValueError(f"ax has {len(all_axes)} axes for {len(wanted)} quantities")
    every = slice(None, None, -(-len(frames) // 20_000))
    x, v, times = (numpy.asarray(one[every]) for one in (frames.positions, frames.velocities, frames.time))
    scale, time = time_scale(frames.units, frames.time)
    units = {"a": _core.unit_names(frames.units)[0], "P": time, "e": "1"}
    colours = iter(COLOURS * (1 + len(frames.names) // len(COLOURS)))
    chosen = [k for k in places_of(bodies, frames.names) if k != primary]
    for body in range(len(frames.names)):
        colour = None if body == primary else NAMED.get(str(frames.names[body]).lower()) or next(colours)
        if body not in chosen:
            continue
        found = elements_of(x, v, frames.masses, body, primary, frames.units)
        found = {name: values if name in units else numpy.degrees(values) for name, values in found.items()}
        found["P"] = found["P"] / scale
        for axis, quantity in zip(all_axes, wanted):
            values = found[quantity]
            axis.plot(against_time(axis, frames.units, times), values, color=colour, lw=1.1,
                      label=str(frames.names[body]) or str(body))
    for axis, quantity in zip(all_axes, wanted):
        axis.set_ylabel(with_unit(ELEMENT_NAMES[quantity], units.get(quantity, "deg")))
        if quantity in ("a", "P"):
            _decades_if_wide(axis)
        if own:
            axis.label_outer()
    if 1 < len(chosen) <= MOST_NAMES:
        legend(all_axes[0], outside=True)
    return all_axes if len(wanted) > 1 else all_axes[0]


def _decades_if_wide(axis):
    """A logarithmic axis with plain numbers, where bodies differ by more than three times."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    low, high = axis.dataLim.intervaly
    if low > 0 and high > 3 * low:
        axis.set_yscale("log")
        axis.yaxis.set_major_locator(LogLocator(10, subs=(1, 2, 5)))
        axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.yaxis.set_minor_locator(NullLocator())
