"""noether: long, honest integrations of mechanical systems.

    import noether as nt

    report = nt.run("scene.toml", until="100 kyr", set={"integrator.method": "gauss_8"})
    report.plot()

or, object by object:

    sim = nt.Simulation(nt.bodies.solar_system(), method="aba_10_6_4", hamiltonian=nt.WisdomHolman(), step="5 day")
    sim.every("10 yr", nt.Energy())
    sim.run(until="1 kyr")

Every force, monitor, Hamiltonian and constraint is a class here, made from what the engine says of its parts:
``help(nt.LennardJones)``. ``nt.forces``, ``nt.monitors``, ``nt.methods``, ... list them by kind.
"""

import importlib as _importlib
import os as _os

# Threads of OpenMP that wait for work do not spin, unless the user wants them to: another runtime in the process, such as
# that of scikit-learn, would lose its processors to them. It has to be said before the runtime starts.
_os.environ.setdefault("OMP_WAIT_POLICY", "passive")

from . import _core  # noqa: E402

Error = _core.Error
FileError = _core.FileError

# Where each name lives; a module is loaded when somebody asks for it first.
_HOMES = {
    "Simulation": "simulation", "Outcome": "simulation", "RunWarning": "simulation",
    "Particles": "particles", "Body": "particles",
    "Scene": "scenes", "run": "scenes", "compare": "scenes", "advise": "scenes", "stability": "scenes", "explain": "scenes",
    "evaluate": "scenes", "example": "scenes", "examples": "scenes", "Report": "reports",
    "ensemble": "ensembles", "open_ensemble": "ensembles", "merge": "ensembles",
    "verify": "files", "convert": "files", "info": "files", "view": "files", "open_run": "reports",
    "from_rebound": "rebound", "force_signature": "functions",
}
_MODULES = ("bodies", "plots", "files", "reports", "rebound", "quantities", "parts", "particles", "scenes", "ensembles",
            "simulation", "viewer", "functions")


def __getattr__(name):
    if name in _HOMES:
        value = getattr(_importlib.import_module("." + _HOMES[name], __name__), name)
    elif name in _MODULES:
        value = _importlib.import_module("." + name, __name__)
    else:
        parts = _importlib.import_module(".parts", __name__)
        value = parts.find(name)
    globals()[name] = value
    return value


def __dir__():
    from . import parts

    return sorted({"Error", "FileError", "threads", "__version__", *_HOMES, *_MODULES, *parts.KINDS, *parts.class_names()})


def threads(count=None):
    """How many threads loops over particles may use; with a number, sets it. Results do not depend on it."""
    if count is not None:
        _core.set_thread_count(count)
    return _core.thread_count()


__version__ = _core.version()
