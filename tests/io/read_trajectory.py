"""Reads a run.h5 with h5py as a stranger would, checks its layout against H5MD 1.1, and prints the last frame's digest.

    read_trajectory.py FILE FRAMES EVERY DT UNITS
"""

import hashlib
import struct
import sys

try:
    import h5py
    import numpy
except ImportError as missing:
    print(f"{missing.name} is not installed")
    sys.exit(77)


def text(value):
    return value.decode() if isinstance(value, bytes) else value


def check_units(system, units):
    name = "unit" if units == "molecular" else "noether_unit"
    other = "noether_unit" if units == "molecular" else "unit"
    expected = {"molecular": ("nm", "nm ps-1", "ps"), "solar": ("au", "au/day", "day"), "reduced": ("1", "1", "1")}[units]
    for path, unit in zip(("position/value", "velocity/value", "position/time"), expected):
        assert text(system[path].attrs[name]) == unit, (path, dict(system[path].attrs))
        # MDAnalysis knows no unit that is a string of fixed length.
        fixed = h5py.check_string_dtype(system[path].attrs.get_id(name).dtype).length is not None
        assert fixed == (units != "molecular"), path
        assert other not in system[path].attrs


def main(path, frames, every, dt, units):
    with h5py.File(path, "r") as file:
        assert list(file["h5md"].attrs["version"]) == [1, 1]
        assert text(file["h5md/creator"].attrs["name"]) == "noether"
        assert text(file["h5md/creator"].attrs["version"])
        assert text(file["h5md/author"].attrs["name"])
        assert "observables" not in file

        system = file["particles/system"]
        n = len(system["id"])
        assert system["box"].attrs["dimension"] == 3
        assert [text(b) for b in system["box"].attrs["boundary"]] == ["none"] * 3
        assert "edges" not in system["box"]
        assert list(system["id"]) == sorted(system["id"])
        assert system["mass"].shape == system["name"].shape == (n,)
        assert "species" not in system  # planets have no types
        steps = numpy.arange(frames) * every
        for name in ("position", "velocity"):
            group = system[name]
            assert group["value"].shape == (frames, n, 3) and group["value"].dtype == numpy.dtype("<f8")
            assert group["value"].maxshape[0] is None and group["value"].compression is None
            assert (group["step"][:] == steps).all(), group["step"][:]
            assert (group["time"][:] == steps * dt).all()
            assert numpy.isfinite(group["value"][:]).all()
        check_units(system, units)

        noether = file["noether"]
        assert {"version", "commit", "simd", "complete"} <= set(noether.attrs)
        assert text(noether["scene"][()]).startswith("title")
        for monitor in noether["monitors"].values():
            rows = len(monitor["step"])
            for name, series in monitor.items():
                assert len(series) == rows, name
                assert name == "step" or text(series.attrs["noether_unit"])
            assert (numpy.diff(monitor["step"][:]) > 0).all()

        state = hashlib.sha256(b"noether-state-1\n")
        state.update(struct.pack("<qqd", system["position/step"][-1], n, system["position/time"][-1]))
        state.update(system["id"][:].astype("<i8").tobytes())
        for name in ("position", "velocity"):
            state.update(system[name]["value"][-1].astype("<f8").tobytes())
        state.update(system["mass"][:].astype("<f8").tobytes())
        print("sha256:" + state.hexdigest())


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4]), sys.argv[5])
