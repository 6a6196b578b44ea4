"""Energies and virials of a configuration of NIST, 1 or 4, pair by pair in 40 digits: see README.md."""

import pathlib
import sys

from mpmath import mp, mpf, nstr, pi, sqrt

mp.dps = 40
LINES = (pathlib.Path(__file__).parent / f"lj_sample_config_periodic{int(sys.argv[1])}.xyz").read_text().split("\n")
ATOMS = int(LINES[0])
EDGE = mpf(LINES[1].split()[1])
PLACES = [[mpf(word) for word in line.split()[1:]] for line in LINES[2:2 + ATOMS]]


def distances(longest):
    """Those to nearest images below the longest; pairs far beyond it, in doubles, are passed over."""
    rough = [[float(x) for x in place] for place in PLACES]
    found = []
    for i, a in enumerate(PLACES):
        for j, b in enumerate(PLACES[:i]):
            images = [round((p - q) / float(EDGE)) for p, q in zip(rough[i], rough[j])]
            if sum((p - q - float(EDGE) * n)**2 for p, q, n in zip(rough[i], rough[j], images)) > (longest + 0.01)**2:
                continue
            r = sqrt(sum((p - q - EDGE * n)**2 for p, q, n in zip(a, b, images)))
            if r < longest:
                found.append(r)
    return found


def energy(r):
    return 4 * (r**-12 - r**-6)


def force(r):
    return 24 * (2 * r**-12 - r**-6) / r


def sums(cutoff, shifted_force):
    """U and W = sum of r F."""
    u = w = mpf(0)
    for r in DISTANCES:
        if r >= cutoff:
            continue
        u += energy(r)
        w += r * force(r)
        if shifted_force:
            u += (r - cutoff) * force(cutoff) - energy(cutoff)
            w -= r * force(cutoff)
    return u, w


DISTANCES = distances(4)
print("# name, in units of epsilon")
for cutoff in (3, 4):
    for style in ("plain", "shifted_force"):
        u, w = sums(mpf(cutoff), style == "shifted_force")
        print(f"{style}{cutoff}.U {nstr(u, 17)}\n{style}{cutoff}.W {nstr(w, 17)}")
    c3 = mpf(cutoff)**-3
    print(f"plain{cutoff}.LRC {nstr(8 * pi * ATOMS**2 / EDGE**3 * (c3**3 / 3 - c3) / 3, 17)}")
