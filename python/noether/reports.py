"""What runs and studies have to say, and the files that they leave, as NumPy arrays and tables."""

import os

from . import _core


class Figures(dict):
    """A dict whose entries are attributes too: `report.monitors["energy"].worst`."""

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no {name!r}; there is: {', '.join(self) or 'nothing'}") from None


def _figures(value):
    if isinstance(value, dict):
        return Figures((key, _figures(one)) for key, one in value.items())
    return [_figures(one) for one in value] if isinstance(value, list) else value


class Series:
    """What one monitor has told: `time`, `step`, and an array of each quantity, by name or as an attribute."""

    def __init__(self, monitor, told):
        import numpy

        self.monitor, self.time, self.step = monitor, told["time"], numpy.asarray(told["step"])
        self.quantities = {name: one["values"] for name, one in told["quantities"].items()}
        self.dimensions = {name: one.get("dimension", "") for name, one in told["quantities"].items()}
        self.columns = {name: list(one.get("columns", ())) for name, one in told["quantities"].items()}

    def __getitem__(self, name):
        return self.quantities[name]

    def __getattr__(self, name):
        if name != "quantities" and name in self.quantities:
            return self.quantities[name]
        raise AttributeError(f"{self.monitor} has told no {name!r}; it has: {', '.join(self.__dict__.get('quantities', {}))}")

    def flat(self):
        """Columns of a table: name and numbers of each."""
        import numpy

        for name, values in self.quantities.items():
            values = numpy.asarray(values)
            if values.ndim == 1 and len(values) == len(self.time):
                yield name, values
            elif len(values) == len(self.time):
                rows = values.reshape(len(self.time), -1)
                labels = self.columns[name] if len(self.columns[name]) == rows.shape[1] else range(rows.shape[1])
                for k, label in enumerate(labels):
                    yield f"{name}.{label}", rows[:, k]

    def to_dataframe(self):
        return frame_of([self])

    def __repr__(self):
        return f"<Series of {self.monitor}: {len(self.time)} looks, {', '.join(self.quantities)}>"


def frame_of(all_series):
    """Series side by side, by time: a pandas DataFrame."""
    import pandas

    frames = []
    for series in all_series:
        columns = {name if len(all_series) == 1 else f"{series.monitor}.{name}": values for name, values in series.flat()}
        frames.append(pandas.DataFrame(columns, index=pandas.Index(series.time, name="time")))
    if not frames:
        return pandas.DataFrame()
    if all(len(one) == len(frames[0]) and (one.index == frames[0].index).all() for one in frames):
        return pandas.concat(frames, axis=1)
    return frames[0].join(frames[1:], how="outer") if len(frames) > 1 else frames[0]


class Frames:
    """Frames: `time`, and `positions` and `velocities` of shape (frames, n, 3)."""

    units = "reduced"

    def elements(self, body=None, about=0):
        """Osculating elements of a body in every frame: a dict of arrays a, e, inc, Omega, omega, M, f, pomega, l, theta, P, n.

        body : its place or name; a list or a slice of these gives arrays of shape (frames, bodies); default: all but the first
        about : a body, a list of bodies (their barycenter), or "jacobi" (the barycenter of all bodies above)
        """
        import numpy

        from .particles import elements_of

        return elements_of(numpy.asarray(self.positions[:]), numpy.asarray(self.velocities[:]), self.masses,
                           slice(1, None) if body is None else body, about, self.units, names=self.names)

    def to_xarray(self):
        """The frames as an xarray Dataset with dimensions time, particle and axis."""
        import numpy
        import xarray

        names = [name or str(k) for k, name in enumerate(self.names)]
        dimensions = ("time", "particle", "axis")
        data = {"position": (dimensions, numpy.asarray(self.positions[:]))}
        if self.velocities is not None:
            data["velocity"] = (dimensions, numpy.asarray(self.velocities[:]))
        length, _, time, _ = _core.unit_names(self.units)
        made = xarray.Dataset(data, coords={"time": self.time, "particle": names, "axis": ["x", "y", "z"]})
        made["position"].attrs["units"], made["time"].attrs["units"] = length, time
        return made

    def __len__(self):
        return len(self.time)

    def __repr__(self):
        return f"<Frames: {len(self)} of {len(self.names)} particles>"


class MemoryFrames(Frames):
    """Frames that a simulation keeps in memory."""

    def __init__(self, held, simulation):
        told = held.frames()
        self.time, self.positions, self.velocities = told["time"], told["positions"], told["velocities"]
        self.names, self.masses, self.units = held.names, held.masses.copy(), simulation.units
        self.box = told["box"]


class FileFrames(Frames):
    """Frames in a run.h5, read when somebody looks at them: `frames.positions[-1]` reads one."""

    def __init__(self, file):
        group = file["particles/system"]
        self._file = file
        self.positions = group["position/value"]
        self.velocities = group["velocity/value"] if "velocity" in group else None
        self.time = group["position/time"][:]
        self.step = group["position/step"][:]
        self.masses = group["mass"][...] if "mass" in group else None
        self.names = ([one.decode() if isinstance(one, bytes) else str(one) for one in group["name"][:]]
                      if "name" in group else [""] * self.positions.shape[1])
        units = file["noether"].attrs.get("units", b"reduced")
        self.units = units.decode() if isinstance(units, bytes) else str(units)
        edges = group["box"].get("edges")  # of each frame: a box keeps its edges
        self.box = None if edges is None else tuple(edges[...] if hasattr(edges, "shape") else edges["value"][0])


class RunFile:
    """A run.h5: `frames`, `series(monitor)`, `monitors`, `scene` (as text). Needs h5py."""

    def __init__(self, path):
        try:
            import h5py
        except ImportError:
            raise ImportError("reading run.h5 needs h5py: pip install h5py") from None
        self.path = os.fspath(path)
        try:
            self._file = h5py.File(self.path, "r")
        except OSError as wrong:
            raise _core.FileError(f"{self.path}: {wrong}") from None
        if "noether" not in self._file:
            raise _core.FileError(f"{self.path}: it was not written by noether")

    @property
    def frames(self):
        if "particles" not in self._file:
            raise _core.FileError(f"{self.path}: it has no frames of particles")
        return FileFrames(self._file)

    @property
    def monitors(self):
        """Names of the monitors that it has numbers of."""
        return list(self._file.get("noether/monitors", {}))

    def series(self, monitor):
        """All that a monitor has told: a `Series`."""
        from .parts import _proposal

        if monitor not in self.monitors:
            raise KeyError(f"no monitor {monitor!r} in {self.path}{_proposal(monitor, dict.fromkeys(self.monitors))}")
        group = self._file["noether/monitors"][monitor]
        told = {"time": group["time"][:], "step": group["step"][:], "quantities": {}}
        for name, data in group.items():
            if name in ("time", "step") or not hasattr(data, "shape"):
                continue
            labels = data.attrs.get("columns", ())
            told["quantities"][name] = {"values": data[...], "columns": [
                one.decode() if isinstance(one, bytes) else str(one) for one in labels]}
        return Series(monitor, told)

    @property
    def scene(self):
        text = self._file["noether/scene"][()]
        return text.decode() if isinstance(text, bytes) else str(text)

    def to_dataframe(self, monitor=None):
        return frame_of([self.series(name) for name in ([monitor] if monitor else self.monitors)])

    def to_xarray(self):
        return self.frames.to_xarray()

    def plot(self, **options):
        from . import plots

        return plots.plot(self, **options)

    def close(self):
        self._file.close()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def __repr__(self):
        return f"<run {self.path}: monitors {', '.join(self.monitors) or 'none'}>"


def open_run(path):
    """Opens a run.h5, or the one in an output folder."""
    path = os.fspath(path)
    return RunFile(os.path.join(path, "run.h5") if os.path.isdir(path) else path)


class _Told:
    """What the engine told as JSON, each entry an attribute; it is printed as the program prints it."""

    def __init__(self, told, text):
        self._told, self._text = _figures(told), text

    def __getattr__(self, name):
        if name.startswith("_"):  # before there is anything told: pickle and copy ask
            raise AttributeError(name)
        try:
            return self._told[name]
        except KeyError:
            raise AttributeError(f"{type(self).__name__} has no {name!r}; it has: {', '.join(self._told)}") from None

    def to_dict(self):
        return dict(self._told)

    def __repr__(self):
        return self._text


class Report(_Told):
    """How a run went, as report.json has it, each entry an attribute: `outcome`, `digest`, `step`, `time`, `wall_s`, ...

    `monitors` has the figures of each monitor; `frames`, `series(monitor)`, `to_dataframe()` and `to_xarray()` read the
    run's file when somebody asks.
    """

    def __init__(self, told, text):
        super().__init__(told, text)
        self._opened = None

    @property
    def ok(self):
        """Whether the run ended as asked, or by a stop of its own."""
        return self._told["outcome"] in ("completed", "stopped")

    @property
    def run(self):
        """The run's file: a `RunFile`."""
        if self._opened is None:
            path = self._told["files"]["trajectory"]
            if not path:
                raise _core.FileError("the run has written no run.h5; it has no trajectory and no monitors")
            self._opened = open_run(path)
        return self._opened

    @property
    def frames(self):
        return self.run.frames

    def series(self, monitor):
        return self.run.series(monitor)

    def to_dataframe(self, monitor=None):
        return self.run.to_dataframe(monitor)

    def to_xarray(self):
        return self.run.to_xarray()

    def plot(self, **options):
        return self.run.plot(**options)


class _Study(_Told):
    """A study, as its JSON has it; `rows` as a DataFrame."""

    _rows = "rows"

    def to_dataframe(self):
        import pandas

        return pandas.DataFrame(self._told[self._rows])

    @property
    def rows(self):
        return self.to_dataframe()


class Comparison(_Study):
    """Error against run time: `rows`, `front` (the rows that no other beats), `orders`, `truth`, `plot()`."""

    @property
    def front(self):
        rows = self.rows
        return rows[rows["pareto_time"].astype(bool)].sort_values("wall_s")

    def plot(self, **options):
        from . import plots

        return plots.plot_comparison(self, **options)


class Advice(_Study):
    """The cheapest method and step that hold an error: `sets` as a dict for `nt.run(scene, set=advice.sets)`."""

    _rows = "proposals"

    @property
    def sets(self):
        """Changes of the scene, as `nt.run` takes them."""
        return list(self._told["set"])


class Stability(_Study):
    """The largest stable step of each method: `rows`."""
