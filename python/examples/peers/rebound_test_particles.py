"""The same as ../test_particles.py, with REBOUND."""

import matplotlib.pyplot as plt
import numpy as np
import rebound

sim = rebound.Simulation()
sim.integrator = "whfast"
sim.dt = 0.2
sim.add(m=1)
sim.add(m=1e-3, a=1, e=0.05)
sim.move_to_com()
sim.N_active = 2
a, rng = np.linspace(1.45, 1.75, 200), np.random.default_rng(1)
for one in a:
    sim.add(a=one, e=0.1, pomega=rng.uniform(0, 2 * np.pi), l=rng.uniform(0, 2 * np.pi), primary=sim.particles[0])

times = np.linspace(0, 2500, 501)
phi = np.zeros((len(times), len(a)))
e = np.zeros(len(a))
for k, time in enumerate(times):
    sim.integrate(time, exact_finish_time=0)
    star = sim.particles[0]
    planet = sim.particles[1].orbit(primary=star)
    for j, particle in enumerate(sim.particles[2:]):
        orbit = particle.orbit(primary=star)
        phi[k, j] = 2 * orbit.l - planet.l - orbit.pomega
        e[j] = orbit.e
locked = abs(np.exp(1j * phi).mean(axis=0))
print(f"{(locked > 0.6).sum()} of {len(a)} librate; eccentricities up to {e.max():.3f}")

plt.scatter(a**1.5, e, c=locked, s=6)
plt.colorbar(label="|mean of exp(i phi)|")
plt.xlabel("period ratio")
plt.ylabel("final eccentricity")
plt.savefig("resonance.png")
