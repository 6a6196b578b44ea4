"""Ensembles: a scene many times with other values, on all threads or by any `map`, as an xarray Dataset."""

import math
import os
import re

from . import _core, files, quantities

# A shard takes a start of the program, some 0.1 s, and its members go eight at a time.
_SHARDS, _LANES = 16, 8


def ensemble(scene, vary, *, members=None, seed=0, set=None, until=None, map=None, shards=None, threads=None, simd=None,
             out=None, fresh=False):
    """Runs a scene many times with other values of some keys, as `noether ensemble` does, and returns a table of the members.

    scene : a file, the name of an example, a dict, a Scene or a Simulation
    vary : a dict of keys and their values: (a, b, n) for n points from a to b, "uniform(a,b)" or "normal(m,s)" for draws, each
        as a text of the program too: {"particles.body.b.a": "0.9:1.1:64 au"}; or a list of texts "KEY=VALUES"
    members : how often to draw, at each point of the grids; seed : of the draws
    set, until : changes of the scene and its end, as in `nt.run`
    map : what makes the members: a function like `map` that is called as map(make, shards), such as the `map` of an executor of
        concurrent.futures or mpi4py.futures, or that of a Dask client, whose futures are waited for. Members are then made in
        shards, each by a process of its own; workers have to see this machine's files. Default: all threads of this machine
    shards : how many of them there are; default: 16, of few members fewer
    threads : of the program; default: all, in a shard one
    simd : "base", "avx2" or "avx512"; default: the highest here. Machines that differ need one that all of them have
    out : the file of the table; default: SCENE.ensemble.h5 in the working directory
    fresh : whether what is there of this or another ensemble is discarded

    What was interrupted goes on when the same is called again; what is there already is read. Rows, and the file, have the same
    bits by any `map`. Members that fail, or whose values make no scene, are rows like others; their `outcome` says so.

    @return what `open_ensemble` makes of the file
    """
    words, scene_file, made = _words(scene, vary, members, seed, set, until, simd, out)
    try:
        if map is None or (os.path.exists(made) and not fresh):
            # In a process of mpirun or srun too it is the whole that is wanted.
            told = _make([*words, "--shard", "0/1", *_threads(threads), *(["--fresh"] if fresh else [])])
        else:
            told = _in_shards(map, words, made, _shard_count(shards, vary, members), threads, fresh)
    finally:
        if scene_file is not None:
            os.remove(scene_file)
    return open_ensemble(told["file"])


def merge(shards, out):
    """Puts the shards of an ensemble, files in any order, into one file, as `noether merge` does: its table."""
    shards = [shards] if isinstance(shards, (str, os.PathLike)) else list(shards)
    return open_ensemble(files._ask("merge", *shards, "--out", out)[0]["file"])


def _words(scene, vary, members, seed, changes, until, simd, out):
    """The command without a shard, the file of its scene where that is made for it, and the file that it makes."""
    from .scenes import Scene, _sets

    if isinstance(scene, (str, os.PathLike)) and os.path.exists(scene):
        path, lines, scene_file = os.fspath(scene), [], None
    else:
        read = Scene(scene)
        if read._functions:
            raise _core.Error("functions of Python cannot go along to the members of an ensemble; take a part of noether, or run "
                              "the members by nt.run")
        path, lines, scene_file = (read._source, read._set_lines, None) if isinstance(read._source, str) else (None, [], None)
    name = os.fspath(out) if out is not None else _default_file(path or "scene.toml")
    if path is None:  # a dict: its file stands here, as files that it names do
        path = scene_file = os.path.abspath(os.path.basename(name) + ".scene.toml")
        with open(scene_file, "w", encoding="utf-8") as file:
            file.write(read.toml)
    words = ["ensemble", os.path.abspath(path), "--out", os.path.abspath(name)]
    for text in _variations(vary):
        words += ["--vary", text]
    for line in [*lines, *_sets(changes, until)]:
        words.append(f"--set={line}")
    words += ["--seed", str(int(seed))]
    words += ["--members", str(int(members))] if members is not None else []
    words += ["--simd", simd] if simd is not None else []
    return words, scene_file, os.path.abspath(name)


def _default_file(path):
    """As the program calls it: NAME.ensemble.h5 here, by the folder where the scene is called scene.toml."""
    stem = os.path.splitext(os.path.basename(path))[0]
    folder = os.path.basename(os.path.dirname(path))
    return (folder if stem == "scene" and folder not in ("", ".", "..") else stem) + ".ensemble.h5"


def _variations(vary):
    """Texts "KEY=VALUES". @raise TypeError, ValueError"""
    if not isinstance(vary, dict):
        return [vary] if isinstance(vary, str) else [str(one) for one in vary]
    return [f"{key}={values if isinstance(values, str) else _grid(key, values)}" for key, values in vary.items()]


def _grid(key, values):
    """"a:b:n unit" of (a, b, n), whose ends may be quantities. @raise TypeError, ValueError"""
    if not isinstance(values, (tuple, list)) or len(values) != 3 or int(values[2]) != values[2]:
        raise TypeError(f"{key} varies by {values!r}; (first, last, points), \"uniform(a,b)\" or \"normal(m,s)\" is expected")
    first, last = (_number_and_unit(one) for one in values[:2])
    if first[1] != last[1] and first[1] and last[1]:
        raise ValueError(f"{key} varies from {values[0]} to {values[1]}; one unit for both is expected")
    return f"{first[0]}:{last[0]}:{int(values[2])} {first[1] or last[1]}".rstrip()


def _number_and_unit(value):
    value = quantities.plain(value)
    if isinstance(value, str):
        number, _, unit = value.strip().partition(" ")
        return number, unit.strip()
    return repr(float(value)), ""


def _shard_count(shards, vary, members):
    if shards is not None:
        if int(shards) != shards or shards < 1:
            raise ValueError(f"shards = {shards!r}; a whole number of 1 or more is expected")
        return int(shards)
    points = 1 if members is None else int(members)
    for text in _variations(vary):
        grid = re.search(r":\s*(\d+)(\s[^:]*)?$", text)
        points *= int(grid.group(1)) if grid else 1
    return max(1, min(_SHARDS, math.ceil(points / _LANES)))


def _threads(threads):
    return [] if threads is None else ["--threads", str(int(threads))]


def _make(words):
    """Makes the members of a shard, wherever this is called: what the program tells. @raise Error, FileError"""
    told, code = files._ask(*words)
    if code == 130:
        raise KeyboardInterrupt
    return told


def _in_shards(map, words, made, count, threads, fresh):
    """Makes shards by a `map`, and one file of them."""
    options = [*_threads(1 if threads is None else threads), *(["--fresh"] if fresh else [])]
    told = list(map(_make, [(*words, "--shard", f"{k}/{count}", *options) for k in range(count)]))
    told = [one.result() if hasattr(one, "result") else one for one in told]
    shards = [one["file"] for one in told]
    lost = [one for one in shards if not os.path.exists(one)]
    if lost:
        raise _core.FileError(f"{lost[0]}: the shard was made, but is not to be seen from here; `out` has to be on a disk that "
                              "workers share with this machine")
    if count == 1:
        return told[0]
    if fresh and os.path.exists(made) and files._ask("info", made)[0].get("kind") == "ensemble":
        os.remove(made)
    told = files._ask("merge", *shards, "--out", made)[0]
    for one in shards:
        os.remove(one)
    return told


# ---- tables -----------------------------------------------------------------------------------------------------------

def open_ensemble(path):
    """The table of an ensemble or of a shard, whoever made it, as an xarray Dataset. Needs h5py and xarray.

    Its dimensions are the keys of the grids, by their values, and `member` for draws; of a shard `member` alone. Variables are
    `outcome` (a text), `step`, `time` (where it ended), `particle`, `digest`, the figures of monitors (`energy_worst`), and the
    state at the end (`position`, `velocity`: dimensions body and axis). Drawn values are coordinates of the members. `attrs` has
    the seed, the units, the scene as text and how often members ended in which way; each variable has its unit in `attrs`.

    Costs the size of the table in memory.
    """
    try:
        import h5py
    except ImportError:
        raise ImportError("reading the table of an ensemble needs h5py: pip install h5py") from None
    path = os.fspath(path)
    try:
        file = h5py.File(path, "r")
    except OSError as wrong:
        raise _core.FileError(f"{path}: {wrong}") from None
    with file:
        if "ensemble" not in file:
            raise _core.FileError(f"{path}: this is not the table of an ensemble")
        return _Table(file, path).dataset()


def _text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def _tables(text):
    """An effective scene, as the program writes it, as a dict: a value a line, tables and lists of tables."""
    import json

    root = {}
    table = root
    for line in text.splitlines():
        if line.startswith("["):
            *way, last = line.strip("[]").split(".")
            at = root
            for key in way:
                at = at.setdefault(key, {})
                at = at[-1] if isinstance(at, list) else at
            if line.startswith("[["):
                table = {}
                at.setdefault(last, []).append(table)
            else:
                table = at.setdefault(last, {})
        elif " = " in line:
            key, _, value = line.partition(" = ")
            try:
                table[key] = json.loads(value)
            except ValueError:  # such as a table in a line
                table[key] = value
    return root


def _value_at(tables, key):
    """What a scene has at the path of a key, or None."""
    for word in key.split("."):
        if isinstance(tables, list):
            named = [one for k, one in enumerate(tables)
                     if word in (str(k), one.get("name")) or (one.get("type") == word and "name" not in one)]
            tables = named[0] if named else None
        else:
            tables = tables.get(word) if isinstance(tables, dict) else None
    return tables


class _Table:
    """The file of an ensemble while it is read."""

    def __init__(self, file, path):
        self._path, self._group = path, file["ensemble"]
        self._attributes = {key: _text(value) if isinstance(value, bytes) else value for key, value in self._group.attrs.items()}
        self._scene_text = _text(file["noether/scene"][()])
        self._scene = _tables(self._scene_text)
        self._units = self._scene.get("units", "reduced")
        self._version, self._simd = (_text(file["noether"].attrs[key]) for key in ("version", "simd"))
        self._vary = [_text(one) for one in self._group["vary"][:]]
        self._keys = [_text(one) for one in self._group["keys"][:]]
        self._names = [one.get("name") or str(k) for k, one in enumerate(self._scene.get("particles", {}).get("body", ()))]

    def _is_drawn(self, k):
        return self._vary[k].partition("=")[2].lstrip().startswith(("uniform", "normal"))

    def _unit_of_key(self, k):
        """Of the numbers of a key: what stands behind them, else what the scene has there."""
        for written in (self._vary[k].partition("=")[2].strip(), _value_at(self._scene, self._keys[k])):
            _, _, unit = written.partition(") " if ")" in written else " ") if isinstance(written, str) else ("", "", "")
            if unit:
                return unit.strip()
        return "1"

    def _unit(self, dimension):
        if self._units == "reduced" or dimension in ("", "1"):
            return "1"
        return ", ".join("rad" if one == "angle" else "1" if one == "1" else _core.unit_of(one, self._units)
                         for one in dimension.split(", "))

    def _grid(self):
        """Dimensions and their lengths, and which keys are those of grids."""
        whole = "shards" not in self._attributes
        shape = [int(n) for n in self._attributes["grid"]] if whole else [len(self._group["member"])]
        grids = [k for k in range(len(self._keys)) if not self._is_drawn(k)] if whole else []
        names = [self._keys[k] for k in grids]
        return names + ["member"] * (len(shape) - len(names)), shape, grids

    def _coordinates(self, dimensions, shape, grids):
        import numpy

        values = self._group["parameters"][:]
        made = {}
        for k, key in enumerate(self._keys):
            attributes = {"units": self._unit_of_key(k)}
            of_all = values[:, k].reshape(shape)
            if k in grids:
                at = grids.index(k)
                made[key] = (key, of_all[tuple(slice(None) if d == at else 0 for d in range(len(shape)))], attributes)
            else:
                made[key] = (dimensions, of_all, attributes)
        if dimensions[-1:] == ["member"]:
            made["member"] = self._group["member"][:] if len(shape) == 1 else numpy.arange(shape[-1])
        return made

    def _outcomes(self):
        import numpy

        names = numpy.array([_text(one) for one in self._group["outcomes"][:]] + ["unknown"])
        numbers = self._group["outcome"][:]
        return names[numpy.where((0 <= numbers) & (numbers < len(names) - 1), numbers, len(names) - 1)]

    def _digests(self):
        import numpy

        words = numpy.ascontiguousarray(self._group["digest"][:].astype("<i8"))
        return numpy.array([row.tobytes().hex() for row in words])

    def _column(self, name, data, dimensions, shape, coordinates):
        """A column with the dimensions that it has beyond those of members."""
        values = data[:]
        labels = _text(data.attrs["columns"]).split() if "columns" in data.attrs else []
        own = []
        for at, length in enumerate(values.shape[1:]):
            last = at == values.ndim - 2
            if name in ("position", "velocity"):
                own.append("axis" if last else "body")
            elif last and len(labels) == length:
                own.append(f"{name}_column")
                coordinates[own[-1]] = labels
            else:
                own.append("body" if not last and length == len(self._names) else f"{name}_{at}")
            if own[-1] == "body" and length == len(self._names):
                coordinates["body"] = self._names
            if own[-1] == "axis":
                coordinates["axis"] = ["x", "y", "z"]
        return dimensions + own, values.reshape(shape + list(values.shape[1:])), {
            "units": self._unit(_text(data.attrs["dimension"]))}

    def dataset(self):
        import collections

        try:
            import xarray
        except ImportError:
            raise ImportError("the table of an ensemble needs xarray: pip install xarray") from None
        dimensions, shape, grids = self._grid()
        coordinates = self._coordinates(dimensions, shape, grids)
        outcomes = self._outcomes()
        data = {"outcome": (dimensions, outcomes.reshape(shape)), "digest": (dimensions, self._digests().reshape(shape))}
        for name in ("step", "time", "particle"):
            data[name] = (dimensions, self._group[name][:].reshape(shape))
        data["time"] += ({"units": self._unit("time")},)
        columns = [(int(one.attrs["column"]), name) for name, one in self._group.items() if "column" in one.attrs]
        for _, name in sorted(columns):
            data[name] = self._column(name, self._group[name], dimensions, shape, coordinates)
        attributes = {"seed": int(self._attributes["seed"]), "units": self._units, "vary": self._vary,
                      "file": os.path.abspath(self._path), "version": self._version, "simd": self._simd,
                      "scene": self._scene_text}
        attributes.update({f"outcome_{name}": count for name, count in sorted(collections.Counter(outcomes.tolist()).items())})
        if "shards" in self._attributes:
            attributes.update(shard=int(self._attributes["shard"]), shards=int(self._attributes["shards"]))
        return xarray.Dataset(data, coordinates, attributes)
