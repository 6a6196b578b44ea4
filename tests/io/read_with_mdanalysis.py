"""Reads every frame of a run.h5 with MDAnalysis and compares with h5py: read_with_mdanalysis.py FILE."""

import sys
import warnings

try:
    import h5py
    import MDAnalysis
    import numpy
except ImportError as missing:
    print(f"{missing.name} is not installed")
    sys.exit(77)

warnings.filterwarnings("ignore")


def main(path):
    with h5py.File(path, "r") as file:
        positions = file["particles/system/position/value"][:]
        velocities = file["particles/system/velocity/value"][:]
        times = file["particles/system/position/time"][:]
    universe = MDAnalysis.Universe.empty(positions.shape[1], trajectory=False)
    universe.load_new(path, format="H5MD", convert_units=False)
    assert universe.trajectory.n_frames == len(positions)
    for k, frame in enumerate(universe.trajectory):
        assert frame.frame == k
        assert numpy.array_equal(frame.positions, positions[k].astype("f4")), k
        assert numpy.array_equal(frame.velocities, velocities[k].astype("f4")), k
        assert frame.time == times[k], (frame.time, times[k])
    print(f"{len(positions)} frames")


if __name__ == "__main__":
    main(sys.argv[1])
