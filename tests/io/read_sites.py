"""Reads the sites of rigid bodies in a run.h5 with h5py as a stranger would, and holds them against the bodies: centres,
momenta and spins by their masses, distances that stay. Prints their names: read_sites.py FILE

Where MDAnalysis is there, it shows the sites: they are the first group below /particles.
"""

import sys
import warnings

try:
    import h5py
    import numpy
except ImportError as missing:
    print(f"{missing.name} is not installed")
    sys.exit(77)


def unwrapped(group):
    x = group["position/value"][:]
    if "image" not in group:
        return x
    return x + group["image/value"][:] * group["box/edges/value"][:][:, None, :]


def check_body(system, row, x, v, m):
    """The sites of one body, all frames at a time: x and v (frames, sites, 3)."""
    total = m.sum()
    assert abs(total - system["mass"][row]) <= 1e-12 * total
    center = (m[:, None] * x).sum(1) / total
    rate = (m[:, None] * v).sum(1) / total
    assert numpy.allclose(center, unwrapped(system)[:, row], rtol=0, atol=1e-12)
    assert numpy.allclose(rate, system["velocity/value"][:, row], rtol=0, atol=1e-12)
    arm, beside = x - center[:, None], v - rate[:, None]
    spin = (m[:, None] * numpy.cross(arm, beside)).sum(1)
    assert numpy.allclose(spin, system["spin/value"][:, row], rtol=0, atol=1e-12), (spin, system["spin/value"][:, row])
    apart = numpy.linalg.norm(x[:, :, None] - x[:, None, :], axis=-1)
    assert numpy.abs(apart - apart[0]).max() < 1e-12


def main(path):
    with h5py.File(path, "r") as file:
        assert list(file["particles"]) == ["sites", "system"]
        sites, system = file["particles/sites"], file["particles/system"]
        frames, count, width = sites["position/value"].shape
        assert width == 3 and sites["velocity/value"].shape == (frames, count, 3)
        for name in ("position", "velocity"):
            for clock in ("step", "time"):
                assert (sites[name][clock][:] == system["position"][clock][:]).all()
            for unit in ("unit", "noether_unit"):
                assert sites[name]["value"].attrs.get(unit) == system[name]["value"].attrs.get(unit)
        assert list(sites["id"]) == list(range(count))
        x, v, m = unwrapped(sites), sites["velocity/value"][:], sites["mass"][:]
        for row, particle in enumerate(system["id"]):
            own = numpy.flatnonzero(sites["particle"][:] == particle)
            check_body(system, row, x[:, own], v[:, own], m[own])
        print(*(name.decode() for name in sites["name"]))
        if "species" in sites:
            print("species", *sites["species"][:])
        if "charge" in sites:
            print("charge", *sites["charge"][:])
        positions = sites["position/value"][:]
    try:
        import MDAnalysis
    except ImportError:
        return
    warnings.filterwarnings("ignore")
    universe = MDAnalysis.Universe.empty(count, trajectory=False)
    universe.load_new(path, format="H5MD", convert_units=False)
    for k, frame in enumerate(universe.trajectory):
        assert numpy.array_equal(frame.positions, positions[k].astype("f4")), k


if __name__ == "__main__":
    main(sys.argv[1])
