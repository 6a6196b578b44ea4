"""Reads the run.h5 of a first-order system with h5py as a stranger would, and prints the last frame's digest.

    read_system.py FILE FRAMES EVERY DT NAMES
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


def main(path, frames, every, dt, names):
    with h5py.File(path, "r") as file:
        assert list(file["h5md"].attrs["version"]) == [1, 1]
        assert "particles" not in file
        system = file["noether/system"]
        value = system["value"]
        assert value.shape == (frames, len(names)) and value.dtype == numpy.dtype("<f8"), value
        assert value.maxshape[0] is None and value.compression is None
        assert system.attrs["variables"] == len(names)
        assert [name.decode() for name in system["name"]] == names
        steps = numpy.arange(frames) * every
        assert (system["step"][:] == steps).all()
        assert (system["time"][:] == steps * dt).all()
        assert numpy.isfinite(value[:]).all()
        state = hashlib.sha256(b"noether-system-1\n")
        state.update(struct.pack("<qqd", system["step"][-1], len(names), system["time"][-1]))
        state.update(value[-1].astype("<f8").tobytes())
        print("sha256:" + state.hexdigest())


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4]), sys.argv[5].split(","))
