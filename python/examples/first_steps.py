"""First steps: a star and two planets; their orbits, printed and drawn, and an eccentricity that comes and goes.

    python first_steps.py          writes eccentricity.png and orbits.png

The same with REBOUND is peers/rebound_first_steps.py; docs/from_rebound.md has both side by side.
"""

import matplotlib.pyplot as plt

import noether as nt

bodies = nt.Particles(elements="jacobi", frame="barycenter")
bodies.add("star", m=1)
bodies.add("inner", m=1e-3, a=1, e=0.1)
bodies.add("outer", m=1e-3, a=1.9, e=0.05, pomega=2.1)
nt.plots.orbits(bodies).figure.savefig("orbits.png")

sim = nt.Simulation(bodies, method="verlet_aba", hamiltonian="wisdom_holman", step=0.05)
sim.record_frames(20)
sim.run(until=20_000)

print(sim.time, sim.particles["inner"].x)
orbits = sim.elements(about="jacobi")
print(orbits.a, orbits.e)

plt.figure()
plt.plot(sim.frames.time, sim.frames.elements("inner", about="jacobi").e)
plt.xlabel("time")
plt.ylabel("eccentricity of the inner planet")
plt.savefig("eccentricity.png")
