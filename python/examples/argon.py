"""Three atoms of argon in a vacuum: 10 ps in steps of 4 fs, a frame every 10 steps.

    python argon.py                writes argon.h5, and argon.xyz for viewers

The same with OpenMM is peers/openmm_argon.py.
"""

import noether as nt

atoms = nt.Particles(units="molecular")
for k in range(3):
    atoms.add(m=39.95, x=0.5 * k)

with nt.Simulation(atoms, method="verlet", step=0.004) as sim:
    sim.add_force(nt.LennardJones(sigma=0.3350, epsilon=0.996, cutoff=100))
    sim.every(10, nt.Trajectory(file="argon.h5"))
    sim.run(2500)
    print(sim.positions[:, 0])

nt.convert("argon.h5", "argon.xyz")
