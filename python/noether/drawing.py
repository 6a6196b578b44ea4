"""What all pictures share: their style, where they are drawn, and what a run has to show."""

import contextlib
import math

from . import _core

# Paul Tol's bright scheme, which people who see few colours tell apart: that of the reports of `noether compare`; and five
# more for what is many.
COLOURS = ("#4477aa", "#ee6677", "#228833", "#b59f1d", "#2ea8c9", "#aa3377", "#777777", "#d2722c", "#7b5ea7", "#4a9a8c",
           "#8c564b", "#333333")
MARKS = ("o", "s", "^", "D", "v")
INK, SOFT, FAINT, PRIMARY = "#1a1a1a", "#5c5c5c", "#e4e4e4", "#e0a500"
# Bodies that are called by a colour have it.
NAMED = {"red": "#d43d3d", "green": "#228833", "blue": "#3b6fb6", "orange": "#e08a2e", "purple": "#8e4fb0", "sun": PRIMARY}
# For figures of one's own to match: plt.style.use(nt.plots.STYLE).
STYLE = {
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#505050", "axes.linewidth": 0.8,
    "axes.labelcolor": INK, "axes.titlesize": 11, "axes.titlecolor": "#303030", "axes.labelsize": 10, "axes.grid": True,
    "axes.axisbelow": True, "grid.color": FAINT, "grid.linewidth": 0.6, "xtick.color": "#505050", "ytick.color": "#505050",
    "xtick.labelcolor": "#303030", "ytick.labelcolor": "#303030", "xtick.labelsize": 9, "ytick.labelsize": 9,
    "xtick.major.size": 3, "ytick.major.size": 3, "xtick.minor.size": 0, "ytick.minor.size": 0, "legend.frameon": False,
    "legend.fontsize": 9, "legend.handlelength": 1.4, "lines.linewidth": 1.3, "figure.facecolor": "white",
    "axes.formatter.limits": (-4, 5), "axes.formatter.use_mathtext": True,
    "axes.prop_cycle": f"cycler('color', {list(COLOURS)})",
}
MOST_NAMES = 12  # more bodies have no legend


def pyplot():
    try:
        import matplotlib.pyplot
    except ImportError:
        raise ImportError("pictures need matplotlib: pip install matplotlib") from None
    return matplotlib.pyplot


@contextlib.contextmanager
def styled():
    """Figures that are made here are in the style of this package."""
    import matplotlib

    plt = pyplot()
    with plt.rc_context(STYLE):
        yield plt
        interactive = matplotlib.is_interactive()
    matplotlib.interactive(interactive)  # of a notebook, which begins with its first figure and shows no later ones without


def axes_of(ax, size=(5.6, 3.4), **options):
    """The axes to draw into: those that are given, or new ones in the style of this package."""
    if ax is not None:
        return ax
    with styled() as plt:
        return plt.subplots(figsize=size, layout="constrained", subplot_kw=options)[1]


def run_of(what):
    """A Simulation, RunFile or Frames, from these, a Report, or the path of a run.h5."""
    from . import reports
    from .particles import Bodies, Particles
    from .simulation import Simulation

    if isinstance(what, reports.Report):
        return what.run
    if isinstance(what, (Simulation, Particles, Bodies, reports.RunFile, reports.Frames)):
        return what
    if isinstance(what, (str, bytes)) or hasattr(what, "__fspath__"):
        return reports.open_run(what)
    raise TypeError(f"{type(what).__name__} is not a run; give a Simulation, a Report, a run.h5, Particles or frames")


def monitors_of(run):
    """Names of the monitors that have told something."""
    if hasattr(run, "record_frames"):
        return list(run._begin().monitors)
    return list(getattr(run, "monitors", ()))


def series_of(run, monitor):
    """What a monitor has told. @raise Error that says how to add it"""
    from .parts import class_name

    if monitor not in monitors_of(run):
        if hasattr(run, "record_frames") and any(one["type"] == monitor for one in run._every):
            raise _core.Error(f"the monitor {monitor} has told nothing yet; run the simulation first")
        raise _core.Error(f"the run has no monitor {monitor}; add sim.every(..., nt.{class_name(monitor)}(...)), or [[every]] "
                          f'with type = "{monitor}" to the scene')
    return run.series(monitor)


def frames_of(what):
    """Frames of a run, or None."""
    if hasattr(what, "add"):  # Particles
        return None
    if hasattr(what, "record_frames"):
        frames = what.frames
        return frames if len(frames) else None
    if hasattr(what, "series"):
        return what.frames if "particles/system" in what._file else None
    return what


def frames_needed(what):
    frames = frames_of(what)
    if frames is None:
        raise _core.Error('the run has no frames; add sim.record_frames(...), or [[every]] with type = "trajectory" to the scene')
    return frames


def units_of(run):
    if hasattr(run, "units"):
        return run.units
    units = run._file["noether"].attrs.get("units", b"reduced")
    return units.decode() if isinstance(units, bytes) else str(units)


def scene_text(run):
    """The scene as text, where it is known: to see which parts it has."""
    if hasattr(run, "tree"):
        return str(run.tree())
    return run.scene if hasattr(run, "scene") else None


def with_unit(name, unit):
    return name if unit in ("1", "", None) else f"{name} ({unit})"


def time_scale(units, times):
    """A unit of time that suits times: what to divide by, and its name."""
    unit = _core.unit_names(units)[2]
    longest = max((abs(float(t)) for t in (times[0], times[-1])), default=0) if len(times) else 0
    if unit == "day":
        for scale, name in ((365.25e9, "Gyr"), (365.25e6, "Myr"), (365.25e3, "kyr"), (365.25, "yr")):
            if longest >= 0.999 * scale:
                return scale, name
    if unit == "ps" and longest >= 2000:
        return 1000.0, "ns"
    return 1.0, unit


def length_scale(units, extent):
    unit = _core.unit_names(units)[0]
    return (1 / 149597870.7, "km") if unit == "au" and extent < 0.01 else (1.0, unit)


def is_logarithmic(times):
    """Whether moments are spread over decades: half of them in the first tenth, two decades at least."""
    later = [t for t in times if t > 0]
    return (len(later) > 4 and later[-1] >= 100 * later[0] and
            sum(t <= later[-1] / 10 for t in later) >= len(later) / 2)


def against_time(ax, units, times):
    """Names the axis of time. @return times in its unit"""
    import numpy

    scale, name = time_scale(units, times)
    ax.set_xlabel(with_unit("time", name))
    return numpy.asarray(times, dtype=float) / scale


def legend(ax, outside=False, **options):
    handles, names = ax.get_legend_handles_labels()
    if not handles:
        return
    if outside:
        options = {"loc": "center left", "bbox_to_anchor": (1.0, 0.5), **options}
    ax.legend(handles, names, frameon=False, fontsize=9, **options)


def decades(ax):
    """A logarithmic axis with powers of ten only, as far as there are any."""
    from matplotlib.ticker import LogLocator, NullLocator

    ax.set_yscale("log")
    ax.yaxis.set_major_locator(LogLocator(10, numticks=7))
    ax.yaxis.set_minor_locator(NullLocator())


def places_of(bodies, names):
    """Places of bodies that are given by names or places; all of them without."""
    from .parts import _proposal

    if bodies is None:
        return list(range(len(names)))
    found = []
    for one in [bodies] if isinstance(bodies, (str, int)) else bodies:
        if isinstance(one, str) and one not in list(names):
            raise KeyError(f"no body is called {one!r}{_proposal(one, dict.fromkeys(names))}")
        found.append(list(names).index(one) if isinstance(one, str) else range(len(names))[one])
    return found
