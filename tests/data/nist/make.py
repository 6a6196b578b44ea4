"""Energies and virials of a configuration of NIST, pair by pair in 40 digits: see README.md."""

import pathlib

from mpmath import mp, mpf, nint, nstr, pi, sqrt

mp.dps = 40
LINES = (pathlib.Path(__file__).parent / "lj_sample_config_periodic4.xyz").read_text().split("\n")
ATOMS = int(LINES[0])
EDGE = mpf(LINES[1].split()[1])
PLACES = [[mpf(word) for word in line.split()[1:]] for line in LINES[2:2 + ATOMS]]


def distance(a, b):
    """To the nearest image."""
    return sqrt(sum((p - q - EDGE * nint((p - q) / EDGE))**2 for p, q in zip(a, b)))


def energy(r):
    return 4 * (r**-12 - r**-6)


def force(r):
    return 24 * (2 * r**-12 - r**-6) / r


def sums(cutoff, shifted_force):
    """U and W = sum of r F."""
    u = w = mpf(0)
    for i, a in enumerate(PLACES):
        for b in PLACES[:i]:
            r = distance(a, b)
            if r >= cutoff:
                continue
            u += energy(r)
            w += r * force(r)
            if shifted_force:
                u += (r - cutoff) * force(cutoff) - energy(cutoff)
                w -= r * force(cutoff)
    return u, w


print("# name, in units of epsilon")
for cutoff in (3, 4):
    for style in ("plain", "shifted_force"):
        u, w = sums(mpf(cutoff), style == "shifted_force")
        print(f"{style}{cutoff}.U {nstr(u, 17)}\n{style}{cutoff}.W {nstr(w, 17)}")
    c3 = mpf(cutoff)**-3
    print(f"plain{cutoff}.LRC {nstr(8 * pi * ATOMS**2 / EDGE**3 * (c3**3 / 3 - c3) / 3, 17)}")
