"""The same as ../first_steps.py, with REBOUND."""

import matplotlib.pyplot as plt
import numpy as np
import rebound

sim = rebound.Simulation()
sim.add(m=1, name="star")
sim.add(m=1e-3, a=1, e=0.1, name="inner")
sim.add(m=1e-3, a=1.9, e=0.05, pomega=2.1, name="outer")
sim.move_to_com()
rebound.OrbitPlot(sim).fig.savefig("orbits.png")

sim.integrator = "whfast"
sim.dt = 0.05
times = np.linspace(0, 20_000, 1001)
eccentricities = np.zeros(len(times))
for k, time in enumerate(times):
    sim.integrate(time, exact_finish_time=0)
    eccentricities[k] = sim.particles["inner"].e

print(sim.t, sim.particles["inner"].xyz)
for orbit in sim.orbits():
    print(orbit.a, orbit.e)

plt.figure()
plt.plot(times, eccentricities)
plt.xlabel("time")
plt.ylabel("eccentricity of the inner planet")
plt.savefig("eccentricity.png")
