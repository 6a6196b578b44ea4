"""The systems whose error fronts are measured, and the times at which runs of them are looked at.

A system is a table of barycentric bodies, NAME.csv beside this file, and its motion at 20 equally spaced times, NAME_truth.csv
(truth.py made it). Both are read as they are, to the last bit, by all programs. Steps divide the time between two samples,
and are written with few binary digits, so that every program is at the same moments and no error of time enters."""

import csv
import functools
import math
import pathlib
import re
from dataclasses import dataclass

HERE = pathlib.Path(__file__).resolve().parent
SAMPLES = 20  # times at which positions are compared
LOOKS = 20  # at most so many looks at the energy from one sample to the next


@functools.cache
def odd_divisors(number):
    return [k for k in range(1, number + 1, 2) if number % k == 0]


@dataclass(frozen=True)
class System:
    name: str
    title: str
    G: float  # [au^3/Msun/day^2]
    sample: int  # time from one sample to the next [day]
    step: float  # a twentieth of a turn of the fastest body, at its fastest [day]
    star: bool  # one body dominates
    truth_step: float  # of the run that is taken as the truth [day]
    share: float  # of the time for all systems

    @property
    def bodies(self):
        """Rows of mass, x, y, z, vx, vy, vz."""
        with open(HERE / f"{self.name}.csv", encoding="utf-8") as file:
            rows = list(csv.reader(line for line in file if not line.startswith("#")))[1:]
        return [[float(value) for value in row[1:]] for row in rows]

    @property
    def table(self):
        return HERE / f"{self.name}.csv"

    def end(self, samples):
        return self.sample * samples

    def divisions(self, wanted):
        """Steps from one sample to the next, for steps of about the wanted length: their length has few binary digits."""
        most = math.log(self.sample / wanted)
        choices = [k << j for k in odd_divisors(self.sample) for j in range(40) if abs(math.log(k << j) - most) < 0.8]
        if not choices:
            raise ValueError(f"{self.name}: no step near {wanted} day divides {self.sample} days")
        return min(choices, key=lambda k: abs(math.log(k) - most))


def looks_of(divisions):
    """How many looks there are from one sample to the next, a divisor of the steps."""
    return max(k for k in range(1, LOOKS + 1) if divisions % k == 0)


GAUSS = 0.01720209895**2

SYSTEMS = {
    one.name: one
    for one in (
        System("outer", "Outer Solar System, 1e5 years", 2.95912208286e-4, 1826250, 216, True, 110, 0.13),
        System("solar", "Solar System, eight planets, 1e4 years", GAUSS, 182625, 3, True, 2.7, 0.45),
        System("chain", "Seven planets in a resonant chain, as of TRAPPIST-1, 7200 days", GAUSS, 360, 0.075, True, 0.08, 0.14),
        System("eccentric", "Three planets, the inner one with e = 0.9, 986 years", GAUSS, 18000, 0.15, True, 0.11, 0.17),
        System("hierarchy", "Two stars with two planets and a third star, 493 years", GAUSS, 9000, 0.75, False, 0.75, 0.11),
    )
}


def truth_table(system):
    return HERE / f"{system.name}_truth.csv"


def resolution(system):
    """What errors can be told, by the line of truth.py's `finer`: the energy error of the truth's states in doubles, and how far
    positions of the truth are from those with finer steps."""
    text = truth_table(system).read_text(encoding="utf-8")
    found = re.search(r"^# wide_gauss_8, .* differs by (\S+) of .* states in doubles (\S+)\.$", text, re.MULTILINE)
    if not found:
        raise ValueError(f"{truth_table(system).name} has no line of `truth.py PROGRAM {system.name} finer`")
    return float(found[2]), float(found[1])


def read_truth(system):
    """Positions about the first body, an array of times, bodies and coordinates."""
    import numpy

    rows = numpy.loadtxt(truth_table(system), delimiter=",", comments="#", ndmin=2)
    return rows[:, 1:].reshape(len(rows), -1, 3)
