"""The spheres of spheres.csv in REBOUND's shearing sheet: make.py ORBITS [gravity]. Prints a line for each tenth of an orbit: time
in orbits, dispersions of velocities along x, y and z, filling factor of the middle plane, local and collisional viscosity."""

import math
import pathlib
import sys

import numpy as np
import rebound

OMEGA, LENGTH, DENSITY = 1.3143527e-4, 100.0, 400.0


def restitution(sim, speed):
    return min(1.0, 0.32 * (abs(speed) * 100) ** -0.234) if speed != 0 else 1.0


def start(gravity):
    sim = rebound.Simulation()
    sim.integrator, sim.OMEGA, sim.gravity = "sei", OMEGA, "basic" if gravity else "none"
    sim.G, sim.softening = 6.67428e-11, 0.1
    sim.dt = 1e-3 * 2 * math.pi / OMEGA
    sim.root_size, sim.boundary = LENGTH, "shear"
    sim.N_ghost_x = sim.N_ghost_y = 1
    sim.collision, sim.collision_resolve = "direct", "hardsphere"
    sim.minimum_collision_velocity = OMEGA * 0.001
    sim.coefficient_of_restitution = restitution
    rows = np.loadtxt(pathlib.Path(__file__).parent / "spheres.csv", delimiter=",")
    for r, x, y, z, vx, vy, vz in rows:  # its box has the origin in the middle
        sim.add(m=4 / 3 * math.pi * r**3 * DENSITY, r=r, x=x - LENGTH / 2, y=y - LENGTH / 2, z=z, vx=vx,
                vy=vy + 1.5 * OMEGA * LENGTH / 2, vz=vz)
    return sim


def main():
    sim = start("gravity" in sys.argv)
    carried, last, orbit = 0.0, 0.0, 2 * math.pi / OMEGA
    for _ in range(int(float(sys.argv[1]) * 10)):
        sim.steps(100)
        m, r, x, z, vx, vy, vz = np.array([[p.m, p.r, p.x, p.z, p.vx, p.vy, p.vz] for p in sim.particles]).T
        w = vy + 1.5 * OMEGA * x
        filling = np.pi * np.maximum(0, r**2 - z**2).sum() / LENGTH**2
        factor = 2 / (3 * OMEGA * m.sum())
        collisional = factor * (sim.collisions_plog - carried) / (sim.t - last)
        carried, last = sim.collisions_plog, sim.t
        print(sim.t / orbit, vx.std(), w.std(), vz.std(), filling, factor * (m * vx * w).sum(), collisional)


main()
