"""Spoils a run.h5 in several ways, as verify must notice: damage.py FILE"""

import sys

try:
    import h5py
except ImportError as missing:
    print(f"{missing.name} is not installed")
    sys.exit(77)

with h5py.File(sys.argv[1], "r+") as file:
    system = file["particles/system"]
    system["position/value"].resize(11, axis=0)
    system["velocity/value"].resize(12, axis=0)
    system["position/step"][8] = 5
    system["velocity/value"][4, 2, 1] = float("nan")
    file["noether/monitors/energy/total"].resize(20, axis=0)
