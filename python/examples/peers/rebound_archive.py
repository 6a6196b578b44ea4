"""The same as ../archive.py, with REBOUND."""

import matplotlib.pyplot as plt
import numpy as np
import rebound

sim = rebound.Simulation()
sim.add(m=1, name="star")
sim.add(m=1e-3, a=1, name="inner")
sim.add(m=1e-3, a=1.9, e=0.08, name="outer")
sim.move_to_com()
sim.integrator = "whfast"
sim.dt = 0.25
sim.save_to_file("archive.bin", step=200, delete_file=True)
sim.integrate(50_000)

archive = rebound.Simulationarchive("archive.bin")
print(len(archive), archive.tmin, archive.tmax)
times, eccentricities, energies, distances = np.zeros((4, len(archive)))
for k, one in enumerate(archive):
    times[k] = one.t
    eccentricities[k] = one.particles[1].orbit(primary=one.particles[0]).e
    energies[k] = one.energy()
    between = one.particles[1] - one.particles[2]
    distances[k] = np.sqrt(between.x**2 + between.y**2 + between.z**2)
print("between", distances.min(), "and", distances.max())

again = archive[500]
again.integrator = "ias15"
again.integrate(again.t + 1000)
print(again.particles[1].orbit(primary=again.particles[0]).e)

fig, (top, bottom) = plt.subplots(2, sharex=True, layout="constrained")
top.plot(times, eccentricities)
top.set_ylabel("eccentricity")
bottom.semilogy(times, abs(energies / energies[0] - 1), ".", markersize=2)
bottom.set_ylabel("error of the energy")
bottom.set_xlabel("time")
fig.savefig("archive.png")
