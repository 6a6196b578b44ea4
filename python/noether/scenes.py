"""Scenes: files, texts or dicts, run and asked as the program does."""

import os

from . import _core, parts, quantities, reports


def example(name):
    """The path of an example's scene, such as "figure_eight"."""
    found = _example_scene(name)
    if found is None:
        raise FileNotFoundError(f"noether has no example {name!r}{parts._proposal(name, dict.fromkeys(examples()))}")
    return found


def examples():
    """Names of all examples that come with noether."""
    return sorted({one for folder in _example_folders() for one in os.listdir(folder)
                   if os.path.exists(os.path.join(folder, one, "scene.toml"))})


def _example_scene(name):
    files = (os.path.join(folder, name, "scene.toml") for folder in _example_folders())
    return next(filter(os.path.exists, files), None)


def _example_folders():
    here = os.path.dirname(os.path.realpath(__file__))
    return [folder for folder in (os.path.join(here, "examples"), os.path.join(here, "..", "..", "examples"))
            if os.path.isdir(folder)]


def _toml(value):
    value = quantities.plain(value)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        import json

        return json.dumps(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(one) for one in value) + "]"
    return repr(value)


def _several(values):
    """A list; one text is a list of one."""
    return [values] if isinstance(values, str) else list(values)


def _sets(changes, until):
    """Changes of a scene as the program takes them."""
    all_sets = []
    if isinstance(changes, dict):
        all_sets += [f"{key}={'' if value is None else _toml(value)}" for key, value in changes.items()]
    elif isinstance(changes, str):
        all_sets.append(changes)
    else:
        all_sets += list(changes or [])
    if until is not None:
        all_sets.append(f"--until {quantities.plain(until)}")
    return all_sets


class Scene:
    """A scene that has been read and checked, but not run.

    source : the path of a file, the name of an example, a dict of tables, or another Scene
    set : changes, {"integrator.step": "2 day", "particles.body.Saturn.e": 0.1}; None takes a key out
    until : the end of the run, in place of its own
    """

    def __init__(self, source, *, set=None, until=None, functions=()):
        changed = []
        if isinstance(source, Scene):
            functions = tuple(source._functions) + tuple(functions)
            changed, source = source._set_lines, source._source
        elif not isinstance(source, dict) and hasattr(source, "tree"):
            functions = tuple(getattr(source, "_functions", ())) + tuple(functions)
            source = source.tree()
        if not isinstance(source, dict):
            source = os.fspath(source)
            if not os.path.exists(source):
                source = _example_scene(source) or source
        self._source, self._functions = source, list(functions)
        self._set_lines = [*changed, *_sets(set, until)]
        self._held = self._read()

    def _read(self):
        return _core.Scene(self._source if isinstance(self._source, str) else quantities.plain(self._source),
                           self._set_lines, self._functions)

    @property
    def toml(self):
        """The scene with every default, as text: the same as a file."""
        return self._held.toml

    @property
    def tree(self):
        """The same as a dict."""
        return self._held.tree

    title = property(lambda self: self._held.title)
    units = property(lambda self: self._held.units)
    names = property(lambda self: self._held.names)
    positions = property(lambda self: self._held.positions)
    velocities = property(lambda self: self._held.velocities)
    masses = property(lambda self: self._held.masses)
    warnings = property(lambda self: self._held.warnings)
    notes = property(lambda self: self._held.notes)

    def run(self, *, out=None, existing="keep", cost=False, checkpoint_wall=300.0, progress=None):
        """Runs it to its end, as `noether run` does: see `nt.run`."""
        if existing not in ("keep", "resume", "fresh"):
            raise ValueError(f"existing = {existing!r}; one of 'keep', 'resume', 'fresh' is expected")
        from .progress import Progress

        length = self.tree["integrator"]
        until = length.get("until")
        time = None if until is None else abs(quantities.number_of(until, "time", self.units))
        with Progress(progress, steps=length.get("steps"), time=time, unit=_core.unit_names(self.units)[2]) as tell:
            return reports.Report(*self._read().run("" if out is None else os.fspath(out), existing, bool(cost),
                                                    float(checkpoint_wall), tell))

    def compare(self, *, methods=(), steps=(), tolerances=(), until=None, repeats=3, budget=10.0, truth_budget=120.0,
                out=None, progress=None):
        """Error against run time, method by method: see `nt.compare`."""
        told = self._held.compare(_several(methods),
                                  [str(quantities.with_units(one, "time", self.units)) for one in _several(steps)],
                                  [float(one) for one in tolerances],
                                  None if until is None else str(quantities.with_units(until, "time", self.units)),
                                  int(repeats), float(budget), float(truth_budget), "" if out is None else os.fspath(out),
                                  progress)
        return reports.Comparison(*told)

    def advise(self, error, *, metric=None, methods=(), budget=2.0, progress=None):
        """The cheapest method and step that hold an error: see `nt.advise`."""
        if metric not in (None, "position", "energy"):
            raise ValueError(f"metric = {metric!r}; 'position' or 'energy' is expected")
        return reports.Advice(*self._held.advise(float(error), metric, _several(methods), float(budget), progress))

    def stability(self, *, methods=(), steps=100_000, budget=20.0, progress=None):
        """The largest stable step of each method: see `nt.stability`."""
        return reports.Stability(*self._held.stability(_several(methods), int(steps), float(budget), progress))

    def evaluate(self, *, check=False):
        """Energy by term, virial and forces of the start: a dict; with `check`, forces against differences too."""
        return self._held.evaluate(bool(check))

    def explain(self):
        """Which parts the scene uses and leaves out, and what a step costs: a dict."""
        return self._held.explain()

    def __repr__(self):
        return f"<Scene: {self.title or 'untitled'}, {len(self.names)} particles in {self.units} units>"


def run(scene, *, until=None, set=None, out=None, existing="keep", cost=False, checkpoint_wall=300.0, progress=None):
    """Runs a scene to its end, as `noether run` does, and returns a `Report`.

    scene : a file, the name of an example ("figure_eight"), a dict, a Scene or a Simulation
    until : the end of the run, in place of its own: "100 kyr"
    set : changes: {"integrator.method": "gauss_8"}
    out : the output folder; default: as the program chooses it
    existing : what becomes of an earlier run there: "keep" (a finished one is moved, an unfinished one refused), "resume"
        or "fresh"
    cost : the report tells what each part has cost
    progress : True shows a line (tqdm, where it is installed); a function is called as `f(step, time, seconds)`

    Ctrl-C ends the run after a whole step, writes its checkpoint and raises KeyboardInterrupt; existing="resume" goes on.
    A run that fails is no exception: `report.ok` is False, and `report.outcome` tells why.
    """
    return Scene(scene, set=set, until=until).run(out=out, existing=existing, cost=cost, checkpoint_wall=checkpoint_wall,
                                              progress=progress)


def compare(scene, *, set=None, **options):
    """Error against run time, method by method: a `Comparison` with `rows` (a DataFrame), `front` and `plot()`.

    methods, steps, tolerances : lists; default: those suited to the scene
    until : the end of each run; budget, truth_budget : seconds for one run, and for the reference
    out : a folder for compare.csv, compare.json and report.html
    """
    return Scene(scene, set=set).compare(**options)


def advise(scene, error, *, set=None, until=None, **options):
    """The cheapest method and step that hold an error over the whole run: an `Advice` with `sets` for `nt.run`."""
    return Scene(scene, set=set, until=until).advise(error, **options)


def stability(scene, *, set=None, **options):
    """The largest step at which each method stays bounded, beside linear theory: a `Stability` with `rows`."""
    return Scene(scene, set=set).stability(**options)


def evaluate(scene, *, set=None, check=False):
    """Energy by term, virial and forces of the start."""
    return Scene(scene, set=set).evaluate(check=check)


def explain(scene, *, set=None):
    """Which parts a scene uses and leaves out, and what a step costs."""
    return Scene(scene, set=set).explain()
