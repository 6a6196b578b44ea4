"""Lets ASE write extended XYZ with momenta, and record velocities in angstrom/fs: see README.md."""

import pathlib

import numpy as np
from ase import Atoms, units
from ase.io import write

here = pathlib.Path(__file__).parent
rng = np.random.default_rng(4711)
atoms = Atoms("OHHNaCl", positions=[[1, 2, 3], [1.9, 2.1, 3.2], [0.8, 2.9, 3.1], [-1, 5, 7], [4.5, 8.5, 9.9]],
              cell=[6, 8, 10], pbc=True)
atoms.set_initial_charges([-0.8, 0.4, 0.4, 1, -1])
atoms.set_velocities(rng.normal(size=(5, 3)) * 0.005 / units.fs)
write(here / "ions.extxyz", atoms)
np.savetxt(here / "ions.velocities.txt", atoms.get_velocities() * units.fs, header="velocities [angstrom/fs]")
