"""A run that plays in a notebook, or in a browser: the page of `noether view`."""

import functools
import html as _html
import json
import os
import tempfile

from . import _core, files

# What stands in the page where it reads its address; a page inside another has none.
_ADDRESS = "location.hash"


def page(run, out=None, *, frames=None, every=None, **options):
    """The path of a page that plays a run: it opens in any browser, needs no net, and can be sent to others.

    run : a Report, a RunFile, the path of a run.h5, or a Simulation with a trajectory or with recorded frames (these need h5py)
    out : where the page is written; default: a temporary folder
    frames, every : shows so many frames, or each so many-th; default: as many as fit into 25 MB
    options : how it begins: frame=10, paused=True, zoom=2, light=True, trails="none" ("short", "long", "all"), names="off",
        box="off"

    @raise Error for a run without frames
    """
    text = _page_text(run, frames, every, options)
    if out is None:
        out = os.path.join(tempfile.mkdtemp(prefix="noether-"), "view.html")
    out = os.fspath(out)
    try:
        with open(out, "w", encoding="utf-8") as file:
            file.write(text)
    except OSError as wrong:
        raise _core.FileError(f"{out}: {wrong.strerror}") from None
    return out


def show(run, *, height=480, open=False, frames=None, every=None, **options):
    """Plays a run: in a notebook below its cell; elsewhere it returns the path of the page, and opens it in a browser if told.

    In notebooks with anywidget this is a widget, whose `moment` (0 is the start, 1 the end) can be read and set; without, a
    frame with the page.

    height : of the picture, in pixels
    open : outside of notebooks: whether a browser shows the page
    frames, every, options : as in `page`
    """
    if not _in_notebook():
        path = page(run, frames=frames, every=every, **options)
        if open:
            import webbrowser

            webbrowser.open("file://" + os.path.abspath(path))
        return path
    text = _page_text(run, frames, every, options)
    try:
        return viewer_class()(page=text, height=int(height))
    except ImportError:
        return _Inline(text, int(height))


_OPTIONS = ("frame", "paused", "zoom", "light", "trails", "names", "box")


def _hash(options):
    """Options as the address of the page has them."""
    from .parts import _proposal

    words = []
    for key, value in options.items():
        if key not in _OPTIONS:
            raise TypeError(f"a viewer has no option {key!r}{_proposal(key, dict.fromkeys(_OPTIONS))}")
        if value is True or (value is not None and value is not False):
            words.append(key if value is True else f"{key}={value}")
        elif value is False and key in ("names", "box"):
            words.append(f"{key}=off")
    return "#" + "&".join(words) if words else ""


def _page_text(run, frames, every, options):
    begin = _hash(options)
    with tempfile.TemporaryDirectory(prefix="noether-") as folder:
        out = os.path.join(folder, "view.html")
        wish = [word for key, value in (("--frames", frames), ("--every", every)) if value is not None
                for word in (key, str(int(value)))]
        files._ask("view", _file_of(run, folder), "--out", out, *wish)
        with open(out, encoding="utf-8") as file:
            text = file.read()
    return text.replace(_ADDRESS, json.dumps(begin), 1) if begin else text


def _file_of(run, folder):
    """The run.h5 of a run; frames in memory are written into a folder."""
    from .reports import Report, RunFile
    from .simulation import Simulation

    if isinstance(run, Report):
        return run.run.path
    if isinstance(run, RunFile):
        return run.path
    if isinstance(run, Simulation):
        if not run._frame_cadences and "trajectory" in run._files:
            return run._files["trajectory"]
        place = os.path.join(folder, "simulation")  # is the title of the page, where the simulation has none
        os.mkdir(place)
        return _written(run, os.path.join(place, "run.h5"))
    path = os.fspath(run)
    return os.path.join(path, "run.h5") if os.path.isdir(path) else path


def _written(sim, path):
    """Frames in memory as a file that `noether view` reads: without the digests of one that a run has written."""
    frames = sim.frames
    if not len(frames):
        raise _core.Error("the simulation has no frames to view; add sim.record_frames(...) and run it")
    try:
        import h5py
    except ImportError:
        raise ImportError("viewing frames in memory needs h5py: pip install h5py") from None
    import numpy

    def text(told):  # as noether writes it: UTF-8 of a fixed length
        told = told.encode()
        return numpy.array(told, dtype=h5py.string_dtype("utf-8", len(told)))

    names = [str(name).encode() or b"-" for name in frames.names]
    with h5py.File(path, "w") as file:
        file.create_group("h5md").attrs["version"] = [1, 1]
        file["h5md"].create_group("author").attrs["name"] = text("noether")
        creator, noether = file["h5md"].create_group("creator"), file.create_group("noether")
        creator.attrs["name"] = text("noether")
        creator.attrs["version"] = noether.attrs["version"] = text(_core.version())
        noether.attrs["units"], noether.attrs["complete"] = text(frames.units), numpy.int64(1)
        noether["scene"] = text(sim.scene.toml)
        system = file.create_group("particles/system")
        box = system.create_group("box")
        box.attrs["dimension"] = numpy.int64(3)
        box.attrs["boundary"] = numpy.array([b"none" if frames.box is None else b"periodic"] * 3,
                                            dtype=h5py.string_dtype("utf-8", 8))
        if frames.box is not None:
            box["edges"] = numpy.asarray(frames.box, dtype=float)
        system["id"], system["mass"] = numpy.arange(len(names)), frames.masses
        system["name"] = numpy.array(names, dtype=h5py.string_dtype("utf-8", max(map(len, names))))
        for name, values in (("position", frames.positions), ("velocity", frames.velocities)):
            group = system.create_group(name)
            group["value"] = values
            group["time"], group["step"] = frames.time, numpy.arange(len(frames))
    return path


# ---- in notebooks ---------------------------------------------------------------------------------------------------

def _in_notebook():
    """Whether this runs in the kernel of a notebook."""
    import sys

    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


class _Inline:
    """The page in a frame of a notebook, without a widget."""

    def __init__(self, text, height):
        self._text, self._height = text, height

    def _repr_html_(self):
        return (f'<iframe srcdoc="{_html.escape(self._text)}" style="width:100%;height:{self._height}px;border:0;'
                'border-radius:6px" allowfullscreen></iframe>')

    def __repr__(self):
        return "<a run that plays in a notebook>"


# The widget is the page in a frame of its own, so that neither style nor keys of the notebook and the page mix. What the
# slider of the page shows and `moment` say the same.
_SCRIPT = """
function render({ model, el }) {
  const frame = document.createElement("iframe");
  frame.style.cssText = "width:100%;border:0;border-radius:6px;display:block";
  frame.allowFullscreen = true;
  const size = () => { frame.style.height = model.get("height") + "px"; };
  const fill = () => { frame.srcdoc = model.get("page"); };
  const slider = () => frame.contentDocument && frame.contentDocument.getElementById("slider");
  const go = () => {
    const own = slider();
    if (!own || Math.abs(Number(own.value) - model.get("moment")) < 1e-9) return;
    own.value = model.get("moment");
    own.dispatchEvent(new Event("input"));
  };
  frame.addEventListener("load", () => {
    const own = slider();
    if (own) own.addEventListener("change", () => { model.set("moment", Number(own.value)); model.save_changes(); });
  });
  model.on("change:height", size);
  model.on("change:page", fill);
  model.on("change:moment", go);
  size();
  fill();
  el.appendChild(frame);
}
export default { render };
"""


@functools.lru_cache(maxsize=None)
def viewer_class():
    """The widget: `page` (its text), `height` in pixels, `moment` that is shown. @raise ImportError without anywidget"""
    import anywidget
    import traitlets

    class Viewer(anywidget.AnyWidget):
        """A run that plays in a notebook; `moment` is what is shown, from 0 (the start) to 1 (the end), and can be set."""

        _esm = _SCRIPT
        page = traitlets.Unicode().tag(sync=True)
        height = traitlets.Int(480).tag(sync=True)
        moment = traitlets.Float(0.0).tag(sync=True)

        def __repr__(self):
            return "<a run that plays in a notebook>"

    return Viewer
