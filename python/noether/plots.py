"""Pictures by matplotlib: orbits, elements, energies, liquids, variables, and comparisons of methods.

Every function draws into `ax`, or into a figure of its own, and returns the axes; what a picture needs and a run does not have
is one clear error. `plot` chooses by what there is. `plt.style.use(nt.plots.STYLE)` makes figures of your own match.
"""

import math

from . import _core
from .chaos_plots import ensemble, lyapunov, megno, resonance_angles  # noqa: F401 ensemble is for users
from .drawing import (  # noqa: F401 STYLE is for users
    COLOURS, MARKS, INK, SOFT, STYLE, MOST_NAMES, styled, axes_of, run_of, monitors_of, series_of, frames_of, units_of,
    with_unit, length_scale, is_logarithmic, against_time, legend, decades, places_of)
from .orbit_plots import ELEMENT_NAMES, elements, orbits, positions, primary_of


# ---- against time ---------------------------------------------------------------------------------------------------

def energies(run, *, ax=None):
    """The relative error of the energy against time, on a logarithmic axis, and that of the shadow Hamiltonian beside it,
    which a symplectic method conserves far better: of the order that changes least.

    Needs the monitor energy or shadow_hamiltonian.
    """
    import numpy

    run = run_of(run)
    have = monitors_of(run)
    energy = series_of(run, "energy") if "energy" in have or "shadow_hamiltonian" not in have else None
    columns = 2 if ax is None else 1
    ax = axes_of(ax)
    scale = None
    if energy is not None:
        times = against_time(ax, units_of(run), energy.time)
        error = numpy.abs(numpy.asarray(energy["relative_error"]))
        ax.plot(times[error > 0], error[error > 0], color=COLOURS[0], lw=1.1,
                label=f"energy, at most {_short(error.max())}")
        scale = max(abs(float(energy["total"][0])),
                    1e-3 * (float(energy["kinetic"][0]) + abs(float(energy["potential"][0]))))
    if "shadow_hamiltonian" in have:
        shadow = series_of(run, "shadow_hamiltonian")
        values = numpy.asarray(shadow["value"])
        change = numpy.abs(values - values[0]) / (scale or abs(values[0]))
        best = int(numpy.argmin(change.max(0)))
        order = _orders(run, shadow)[best] if len(_orders(run, shadow)) == values.shape[1] else None
        one = change[:, best]
        ax.plot(against_time(ax, units_of(run), shadow.time)[one > 0], one[one > 0], color=COLOURS[1], lw=1.1,
                label=f"shadow{'' if order is None else f' of order {order}'}, at most {_short(one.max())}")
    decades(ax)
    shown = numpy.concatenate([line.get_ydata() for line in ax.get_lines()] or [[1e-16]])
    if len(shown):  # whole decades, and single looks that are nearly exact may lie below
        ax.set_ylim(10 ** math.floor(math.log10(numpy.quantile(shown, 0.02))), 10 ** math.ceil(math.log10(shown.max() * 1.01)))
    ax.set_ylabel("relative error")
    legend(ax, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, borderaxespad=0.2)
    return ax


def _short(value):
    return f"{value:.1e}".replace("e-0", "e-").replace("e+0", "e+")


def _orders(run, shadow):
    """The orders of a shadow monitor, as far as its columns or the scene tell them."""
    import re

    names = shadow.columns.get("value", ())
    if len(names):
        return [re.sub(r"\D", "", str(one)) or one for one in names]
    told = [one for one in getattr(run, "_every", ()) if one["type"] == "shadow_hamiltonian"]
    if told:
        return told[0].get("orders", [4, 8, 12, 16, 20, 24])
    found = re.search(r'"shadow_hamiltonian"[^[]*?orders = \[([^\]]*)\]', getattr(run, "scene", "") or "", re.S)
    return found.group(1).replace(" ", "").split(",") if found else [4, 8, 12, 16, 20, 24]


def monitor(run, name, *, quantities=None, ax=None):
    """The numbers of any monitor against time: those of its quantities that are named; else all that are one number per look."""
    run = run_of(run)
    series = series_of(run, name)
    ax = axes_of(ax)
    times = against_time(ax, units_of(run), series.time)
    wanted = [quantities] if isinstance(quantities, str) else quantities
    drawn = [(key, values) for key, values in series.flat() if wanted is None or key in wanted or key.split(".")[0] in wanted]
    if wanted is None:
        drawn = [one for one in drawn if one[0] in series.quantities] or drawn
    if not drawn:
        raise _core.Error(f"{name} has no {quantities!r}; it has: {', '.join(key for key, _ in series.flat())}")
    for k, (key, values) in enumerate(drawn[:MOST_NAMES]):
        ax.plot(times, values, color=COLOURS[k % len(COLOURS)], lw=1.1, label=key)
    unit = _unit_of(run, series, drawn[0][0].split(".")[0])
    ax.set_ylabel(with_unit(name.replace("_", " "), unit))
    if len(drawn) > 1:
        legend(ax)
    return ax


def _unit_of(run, series, quantity):
    """The unit of what a monitor has told, where it has one."""
    if hasattr(run, "_file"):
        unit = run._file["noether/monitors"][series.monitor][quantity].attrs.get("noether_unit", b"1")
        return unit.decode() if isinstance(unit, bytes) else str(unit)
    dimension = series.dimensions.get(quantity, "")
    return "1" if units_of(run) == "reduced" or dimension in ("", "1") else _core.unit_of(dimension, units_of(run))


def variables(run, *, names=None, log_time=None, ax=None):
    """The variables of a system of first order against time: small ones magnified, as their names tell; many as a picture.

    names : of those that are drawn; default: all
    log_time : whether the axis of time is logarithmic; default: where looks at the run are spread over decades

    Needs the monitor variables, or a trajectory.
    """
    import numpy

    run = run_of(run)
    times, values, all_names = _variables_of(run)
    chosen = places_of(names, all_names)
    ax = axes_of(ax)
    shown = against_time(ax, units_of(run), times)
    if log_time is None:
        log_time = is_logarithmic(list(shown))
    keep = shown > 0 if log_time else numpy.ones(len(shown), dtype=bool)
    if log_time:
        ax.set_xscale("log")
    if len(chosen) > MOST_NAMES:
        mesh = ax.pcolormesh(shown[keep], numpy.arange(len(chosen)), values[keep][:, chosen].T, cmap="cividis", shading="nearest",
                             rasterized=True)
        ax.grid(False)
        ax.set_ylabel("variable")
        ax.figure.colorbar(mesh, ax=ax, pad=0.02, label="value").outline.set_visible(False)
        return ax
    largest = max(float(numpy.abs(values[keep][:, k]).max()) for k in chosen)
    for k in chosen:
        size = float(numpy.abs(values[keep][:, k]).max())
        power = int(math.floor(math.log10(largest / size))) if 0 < size < largest / 50 else 0
        label = rf"$10^{{{power}}}$ {all_names[k]}" if power else str(all_names[k])
        ax.plot(shown[keep], 10.0 ** power * values[keep][:, k], color=COLOURS[chosen.index(k) % len(COLOURS)], label=label)
    if len(chosen) == 1:
        ax.set_ylabel(str(all_names[chosen[0]]))
    else:
        ax.set_ylabel("variables")
        legend(ax, outside=True)
    return ax


def _variables_of(run):
    """Times, values (looks, variables) and names. @raise Error"""
    import numpy

    if "variables" in monitors_of(run):
        series = series_of(run, "variables")
        values = numpy.asarray(series["value"])
        names = list(series.columns.get("value", ()))
        return series.time, values, names if len(names) == values.shape[1] else _variable_names(run, values.shape[1])
    if not hasattr(run, "record_frames") and "noether/system/value" in getattr(run, "_file", {}):
        group = run._file["noether/system"]
        names = [one.decode() if isinstance(one, bytes) else str(one) for one in group["name"][:]]
        return group["time"][:], group["value"][:], names
    series_of(run, "variables")


def _variable_names(run, count):
    held = getattr(run, "_held", None)
    names = list(getattr(held, "variable_names", ()))
    return names if len(names) == count else [f"y{k + 1}" for k in range(count)]


# ---- liquids --------------------------------------------------------------------------------------------------------

def radial_distribution(run, *, ax=None, **line):
    """g(r), as the monitor radial_distribution has averaged it over the run. `line`: options of the line, such as label."""
    run = run_of(run)
    series = series_of(run, "radial_distribution")
    ax = axes_of(ax, (4.8, 3.2))
    scale, unit = length_scale(units_of(run), math.inf)
    ax.axhline(1, color=SOFT, lw=0.8, ls=(0, (4, 3)))
    ax.plot(scale * series["distance"][-1], series["value"][-1], **{"color": COLOURS[0], "lw": 1.5, **line})
    ax.set_xlim(left=0)
    ax.set_ylim(bottom=0)
    ax.set_xlabel(with_unit("r", unit))
    ax.set_ylabel("g(r)")
    return ax


def mean_square_displacement(run, *, ax=None, **line):
    """The mean square displacement by lag, and the line of the diffusion coefficient that the monitor tells."""
    import numpy

    run = run_of(run)
    series = series_of(run, "mean_square_displacement")
    ax = axes_of(ax, (4.8, 3.2))
    units = units_of(run)
    lag, value = _lags(series)
    length, _, time, _ = _core.unit_names(units)
    ax.plot(lag, value, **{"color": COLOURS[0], "lw": 1.5, **line})
    coefficient = float(numpy.asarray(series["diffusion_coefficient"])[-1])
    if coefficient > 0 and len(lag) > 2:
        half = len(lag) // 2
        shift = float(numpy.mean(value[half:] - 6 * coefficient * lag[half:]))
        fit = 6 * coefficient * lag + shift
        unit = _core.unit_of("length^2/time", units) if units != "reduced" else "1"
        ax.plot(lag[fit >= 0], fit[fit >= 0], color=SOFT, lw=0.9, ls=(0, (4, 3)),
                label=f"D = {coefficient:.3g}{'' if unit == '1' else ' ' + unit}".replace("^2", "\u00b2"))
        legend(ax, loc="upper left")
    ax.set_xlim(left=0)
    ax.set_ylim(bottom=0)
    ax.set_xlabel(with_unit("lag", time))
    ax.set_ylabel(with_unit("mean square displacement", "1" if length == "1" else length + "\u00b2"))
    return ax


def _lags(series):
    """Lags and values of the last look, as far as there are samples."""
    import numpy

    lag, value = numpy.asarray(series["lag"])[-1], numpy.asarray(series["value"])[-1]
    told = numpy.isfinite(value) & numpy.isfinite(lag)
    told[1:] &= lag[1:] > 0
    return lag[told], value[told]


def velocity_autocorrelation(run, *, ax=None, **line):
    """The velocity autocorrelation by lag, divided by its value at lag 0."""
    run = run_of(run)
    series = series_of(run, "velocity_autocorrelation")
    ax = axes_of(ax, (4.8, 3.2))
    lag, value = _lags(series)
    ax.axhline(0, color=SOFT, lw=0.8)
    ax.plot(lag, value / value[0], **{"color": COLOURS[0], "lw": 1.5, **line})
    ax.set_xlim(left=0)
    ax.set_xlabel(with_unit("lag", _core.unit_names(units_of(run))[2]))
    ax.set_ylabel("velocity autocorrelation")
    return ax


# ---- studies --------------------------------------------------------------------------------------------------------

_ERRORS = {"position": ("position_error_max", "largest error of positions"),
           "energy": ("energy_error_max", "largest relative error of the energy"),
           "orientation": ("orientation_error_max", "largest error of orientations")}


def plot_comparison(comparison, *, error=None, against="time", ax=None):
    """Error against run time, a line for each method; the runs that no other beats have a ring and are joined by a broad line.

    error : "position", "energy" or "orientation"; default: what the comparison has chosen
    against : "time" (seconds) or "evaluations"
    """
    import numpy

    rows = comparison.rows
    error = error or comparison.to_dict().get("error") or "position"
    if error not in _ERRORS:
        raise ValueError(f"error = {error!r}; one of {', '.join(map(repr, _ERRORS))} is expected")
    if against not in ("time", "evaluations"):
        raise ValueError(f"against = {against!r}; 'time' or 'evaluations' is expected")
    column, name = _ERRORS[error]
    across, front = ("wall_s", "pareto_time") if against == "time" else ("force_evaluations", "pareto_evaluations")
    rows = rows[(rows["outcome"] == "completed") & (rows[column].astype(float) > 0)]
    if not len(rows):
        raise _core.Error(f"the comparison has no run with a positive error of the kind {error!r}")
    ax = axes_of(ax, (6.6, 4.2))
    for k, (method, own) in enumerate(rows.groupby("method", sort=False)):
        x, y = own[across].astype(float).to_numpy(), own[column].astype(float).to_numpy()
        adaptive = own["step"].isna().all()
        colour = COLOURS[k % len(COLOURS)]
        ax.plot(x, y, color=colour, lw=1.3, marker=MARKS[k % len(MARKS)], ms=5, mfc="white" if adaptive else colour, mec=colour,
                ls=(0, (5, 2)) if adaptive else "-", label=method, zorder=3)
    best = rows[rows[front].astype(bool)].sort_values(across)
    x, y = best[across].astype(float).to_numpy(), best[column].astype(float).to_numpy()
    ax.step(x, y, where="post", color=INK, alpha=0.10, lw=8, solid_joinstyle="round", solid_capstyle="round", zorder=1)
    ax.plot(x, y, "o", ms=11, mfc="none", mec=INK, mew=1.0, zorder=4)
    _costs(ax, "s" if against == "time" else "")
    decades(ax)
    end = comparison.to_dict().get("end")
    ax.set_xlabel("run time" if against == "time" else "evaluations of forces")
    ax.set_ylabel(name + (f" up to {end:g}{_time_name(comparison)}" if isinstance(end, (int, float)) else ""))
    legend(ax, outside=True)
    return ax


def _costs(ax, unit):
    """A logarithmic axis with numbers such as 20 \u00b5s: by decades, or where there are few of these by 1, 2 and 5."""
    from matplotlib.ticker import EngFormatter, LogLocator, NullLocator

    low, high = ax.dataLim.intervalx
    ax.set_xscale("log")
    ax.xaxis.set_major_locator(LogLocator(10, subs=(1,) if high > 300 * low else (1, 2, 5), numticks=12))
    ax.xaxis.set_major_formatter(EngFormatter(unit=unit))
    ax.xaxis.set_minor_locator(NullLocator())


def _time_name(comparison):
    unit = comparison.to_dict().get("time_unit", "1")
    return "" if unit in ("1", "", None) else f" {unit}"


# ---- all that fits --------------------------------------------------------------------------------------------------

def _choices(run):
    """Pictures that a run has what it takes for, the main one first: (name, function)."""
    have = monitors_of(run)
    frames = frames_of(run)
    bodies = frames if frames is not None else run if hasattr(run, "positions") else None
    few, about = False, None
    chosen = []
    if "variables" in have or "noether/system/value" in getattr(run, "_file", {}):
        chosen.append("variables")
    elif bodies is not None and getattr(run, "_system", None) is None:
        few = len(bodies.names) <= MOST_NAMES
        about = primary_of(bodies.masses, bodies.names, "auto", run)
        in_box = getattr(run.frames if hasattr(run, "record_frames") else frames, "box", None) is not None
        chosen.append("orbits" if not in_box and (few or about is not None) else "positions")
    if "energy" in have or "shadow_hamiltonian" in have:
        chosen.append("energies")
    if chosen[:1] == ["orbits"] and few and about is not None and frames is not None and len(frames) > 2 and (
            frames.velocities is not None):
        chosen += ["a", "e", "inc"]
    chosen += [one for one in ("radial_distribution", "mean_square_displacement", "velocity_autocorrelation") if one in have]
    chosen += [one for one in ("temperature", "pressure") if one in have]
    return chosen + [one for one, monitor in _CHAOS.items() if monitor in have]


_CHAOS = {"resonance_angles": "resonance_angle", "megno": "megno", "lyapunov": "lyapunov"}


def plot(run, *, what=None, ax=None):
    """What fits the run, side by side: orbits, variables or positions, errors of the energy, elements, g(r), displacements,
    temperature and pressure, angles of resonances, MEGNO and Lyapunov exponents.

    what : a list of these: "orbits", "positions", "variables", "energies", "a", "e", "inc", "radial_distribution",
        "mean_square_displacement", "velocity_autocorrelation", "resonance_angles", "megno", "lyapunov", or names of other
        monitors; default: by what there is
    ax : draws the first of them alone, into these axes

    @return an array of axes; with `ax`, that
    """
    import numpy

    run = run_of(run)
    chosen = [what] if isinstance(what, str) else list(what) if what is not None else _choices(run)[:7]
    if not chosen and getattr(run, "_system", None) is not None:
        series_of(run, "variables")
    if not chosen:
        raise _core.Error("the run has nothing to show; add sim.record_frames(...), or sim.every(..., nt.Energy())")
    if ax is not None or len(chosen) == 1:
        made = _draw(run, chosen[0], ax)
        return made if ax is not None else numpy.array([made], dtype=object)
    others = len(chosen) - 1
    columns = 1 if others <= 2 else 2
    rows = max(2, math.ceil(others / columns))
    with styled() as plt:
        figure = plt.figure(figsize=(5.2 + 3.5 * columns, max(4.6, 2.3 * rows)), layout="constrained")
        grid = figure.add_gridspec(rows, 1 + columns, width_ratios=[1.5] + [1] * columns)
        places = [grid[:, 0]] + [grid[k // columns, 1 + k % columns] for k in range(others)]
        if others == 1:
            places[1] = grid[:, 1]
        all_axes = [figure.add_subplot(place) for place in places]
    for name, one in zip(chosen, all_axes):
        _draw(run, name, one)
        if one is not all_axes[0] and one.get_legend() is not None and name in ("a", "e", "inc"):
            one.get_legend().remove()
    return numpy.array(all_axes, dtype=object)


def _draw(run, name, ax):
    if name in ELEMENT_NAMES:
        return elements(run, quantities=name, ax=ax)
    own = {"orbits": orbits, "positions": positions, "variables": variables, "energies": energies,
           "radial_distribution": radial_distribution, "mean_square_displacement": mean_square_displacement,
           "velocity_autocorrelation": velocity_autocorrelation, "resonance_angles": resonance_angles, "megno": megno,
           "lyapunov": lyapunov}
    if name in own:
        return own[name](run, ax=ax)
    return monitor(run, name, ax=ax)
