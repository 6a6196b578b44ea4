"""Test particles outside of a planet, and which of them librate in the 2:1 resonance, from elements in NumPy.

    python test_particles.py       writes resonance.png

The resonance angle phi = 2 l - l_planet - pomega takes every value where it circulates, so that the mean of exp(i phi) is near
0, and stays near one value where it librates. The same with REBOUND is peers/rebound_test_particles.py.
"""

import matplotlib.pyplot as plt
import numpy as np

import noether as nt

bodies = nt.Particles(frame="barycenter")
bodies.add("star", m=1)
bodies.add("planet", m=1e-3, a=1, e=0.05)
a, rng = np.linspace(1.45, 1.75, 200), np.random.default_rng(1)
for one in a:
    bodies.add(a=one, e=0.1, pomega=rng.uniform(0, 2 * np.pi), l=rng.uniform(0, 2 * np.pi))

sim = nt.Simulation(bodies, method="verlet_aba", hamiltonian="wisdom_holman", step=0.2)
sim.record_frames(5)
sim.run(until=2500)

planet, tracers = sim.frames.elements("planet"), sim.frames.elements(slice(2, None))
phi = 2 * tracers.l - planet.l[:, None] - tracers.pomega
locked = abs(np.exp(1j * phi).mean(axis=0))
print(f"{(locked > 0.6).sum()} of {len(a)} librate; eccentricities up to {tracers.e[-1].max():.3f}")

plt.scatter(a**1.5, tracers.e[-1], c=locked, s=6)
plt.colorbar(label="|mean of exp(i phi)|")
plt.xlabel("period ratio")
plt.ylabel("final eccentricity")
plt.savefig("resonance.png")
