"""A run that leaves a file: looked at afterwards, drawn, and taken up again in its middle.

    python archive.py              writes archive.h5 and archive.png

The same with REBOUND is peers/rebound_archive.py.
"""

import matplotlib.pyplot as plt
import numpy as np

import noether as nt

bodies = nt.Particles(elements="jacobi", frame="barycenter")
bodies.add("star", m=1)
bodies.add("inner", m=1e-3, a=1)
bodies.add("outer", m=1e-3, a=1.9, e=0.08)
with nt.Simulation(bodies, method="verlet_aba", hamiltonian="wisdom_holman", step=0.25) as sim:
    sim.every(200, nt.Trajectory(file="archive.h5"))
    sim.every(200, nt.Energy())
    sim.run(until=50_000)

run = nt.open_run("archive.h5")
frames, energy = run.frames, run.series("energy")
print(len(frames), frames.time[0], frames.time[-1])
distances = np.linalg.norm(frames.positions[:, 1] - frames.positions[:, 2], axis=1)
print("between", distances.min(), "and", distances.max())

again = nt.Simulation(nt.Particles("archive.h5", frame=500), method="gauss_8")
again.add_force("gravity")
again.run(until=1000)
print(again.particles["inner"].e)

fig, (top, bottom) = plt.subplots(2, sharex=True, layout="constrained")
top.plot(frames.time, frames.elements("inner").e)
top.set_ylabel("eccentricity")
bottom.semilogy(energy.time, abs(energy.relative_error), ".", markersize=2)
bottom.set_ylabel("error of the energy")
bottom.set_xlabel("time")
fig.savefig("archive.png")
