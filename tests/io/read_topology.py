"""Reads types, charges and bonds of a run.h5 with h5py as a stranger would, by H5MD 1.1 and its module `units` alone, and
prints them: read_topology.py FILE
"""

import sys

try:
    import h5py
except ImportError as missing:
    print(f"{missing.name} is not installed")
    sys.exit(77)


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def main(path):
    with h5py.File(path, "r") as file:
        system = file["particles/system"]
        print("id", *system["id"][:])
        print("species", *(system["species"][:] if "species" in system else ["none"]))
        if "charge" in system:
            charge = system["charge"]
            print("charge", *charge[:], text(charge.attrs["type"]), text(charge.attrs.get("unit", "none")))
        for name, tuples in sorted(file.get("connectivity", {}).items()):
            assert file[tuples.attrs["particles_group"]] == system, name
            print(name, *(tuple(int(i) for i in row) for row in tuples[:]))
        for name in ("mass", "position/value", "position/time", "velocity/value", "box/edges/value"):
            if name in system:
                print(name, text(system[name].attrs.get("unit", "none")))
        if "modules" in file["h5md"]:
            module = file["h5md/modules/units"]
            print("units", *module.attrs["version"], text(module.attrs["system"]))


if __name__ == "__main__":
    main(sys.argv[1])
