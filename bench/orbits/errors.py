"""Errors of a run from its states. The same for every program, worked out in the 64 bits of numpy's long double."""

import numpy


def energy(G, masses, states):
    """Of states, an array of times, bodies and x, y, z, vx, vy, vz."""
    G, m, states = numpy.longdouble(G), masses.astype(numpy.longdouble), states.astype(numpy.longdouble)
    kinetic = (m * (states[:, :, 3:] ** 2).sum(axis=2)).sum(axis=1) / 2
    i, j = numpy.triu_indices(len(m), 1)
    r = numpy.sqrt(((states[:, i, :3] - states[:, j, :3]) ** 2).sum(axis=2))
    return kinetic - (G * m[i] * m[j] / r).sum(axis=1)


def energy_error(G, masses, states):
    """The largest change of the energy, relative to that at the start."""
    values = energy(G, masses, states)
    return float(abs((values - values[0]) / values[0]).max())


def position_error(states, truth):
    """The largest distance of a body from where it should be, both seen from the first body, divided by the body's mean
    distance from the first one, over all bodies and sample times.

    states: one for each sample time after the start; truth: positions about the first body at these times."""
    positions = states[:, 1:, :3].astype(numpy.longdouble) - states[:, :1, :3]
    truth = truth[: len(positions), 1:]
    scale = numpy.sqrt((truth**2).sum(axis=2).mean(axis=0))
    off = numpy.sqrt(((positions - truth) ** 2).sum(axis=2))
    return float((off / scale).max())
