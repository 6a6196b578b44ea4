"""Writes the tables of bodies, NAME.csv: make_bodies.py. In 40 digits, then rounded once; needs mpmath."""

import csv
import pathlib

import mpmath
from mpmath import mpf

import systems

ROOT = pathlib.Path(__file__).resolve().parents[2]
EARTH = mpf("3.0034896e-6")  # Msun

mpmath.mp.dps = 40


def ellipse(mu, a, e, inc, node, omega, mean):
    """Position and velocity; angles in degrees."""
    inc, node, omega, mean = (mpmath.radians(angle) for angle in (inc, node, omega, mean))
    E = mpmath.findroot(lambda E: E - e * mpmath.sin(E) - mean, mean + e * mpmath.sin(mean))
    n, root = mpmath.sqrt(mu / a**3), mpmath.sqrt(1 - e * e)
    x, y = a * (mpmath.cos(E) - e), a * root * mpmath.sin(E)
    rate = n * a / (1 - e * mpmath.cos(E))
    vx, vy = -rate * mpmath.sin(E), rate * root * mpmath.cos(E)
    c, s = mpmath.cos, mpmath.sin
    p = [c(node) * c(omega) - s(node) * s(omega) * c(inc), s(node) * c(omega) + c(node) * s(omega) * c(inc), s(omega) * s(inc)]
    q = [-c(node) * s(omega) - s(node) * c(omega) * c(inc), -s(node) * s(omega) + c(node) * c(omega) * c(inc), c(omega) * s(inc)]
    return [x * p[k] + y * q[k] for k in range(3)], [vx * p[k] + vy * q[k] for k in range(3)]


def center(bodies):
    """Position and velocity of the center of mass, and the mass."""
    mass = sum(body[1] for body in bodies)
    return [[sum(body[1] * body[which][k] for body in bodies) / mass for k in range(3)] for which in (2, 3)] + [mass]


def jacobi(G, star, planets):
    """Bodies from the inside out, each about the center of mass of those before it. A planet: name, mass, a, e, inc, node,
    argument of the pericenter, mean anomaly; without a, (P,)."""
    bodies = [[star[0], mpf(star[1]), [mpf(0)] * 3, [mpf(0)] * 3]]
    for name, mass, a, *angles in planets:
        x0, v0, inside = center(bodies)
        mu = mpf(G) * (inside + mpf(mass))
        if isinstance(a, tuple):
            a = mpmath.cbrt(mu * (mpf(a[0]) / (2 * mpmath.pi)) ** 2)
        x, v = ellipse(mu, mpf(a), *(mpf(angle) for angle in angles))
        bodies.append([name, mpf(mass), [x0[k] + x[k] for k in range(3)], [v0[k] + v[k] for k in range(3)]])
    return bodies


def read(path):
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))[1:]
    return [[row[0], mpf(row[1]), [mpf(t) for t in row[2:5]], [mpf(t) for t in row[5:8]]] for row in rows]


def write(name, source, bodies):
    x0, v0, _ = center(bodies)
    with open(systems.HERE / f"{name}.csv", "w", encoding="utf-8") as file:
        file.write(f"# {source}\n# Barycentric; written by make_bodies.py.\n")
        file.write("name,mass [Msun],x [au],y [au],z [au],vx [au/day],vy [au/day],vz [au/day]\n")
        for body, mass, x, v in bodies:
            numbers = [mass] + [x[k] - x0[k] for k in range(3)] + [v[k] - v0[k] for k in range(3)]
            file.write(",".join([body] + [repr(float(number)) for number in numbers]) + "\n")


def main():
    G = systems.GAUSS
    write("outer", "examples/outer_solar_system/outer_planets.csv", read(ROOT / "examples/outer_solar_system/outer_planets.csv"))
    write("solar", "examples/solar_system/planets.csv", read(ROOT / "examples/solar_system/planets.csv"))
    chain = [("b", "1.374", "1.510826", "0.004", 30, 10), ("c", "1.308", "2.421937", "0.002", 100, 200),
             ("d", "0.388", "4.049219", "0.006", 200, 140), ("e", "0.692", "6.101013", "0.005", 60, 80),
             ("f", "1.039", "9.207540", "0.009", 180, 320), ("g", "1.321", "12.352446", "0.003", 340, 50),
             ("h", "0.326", "18.772866", "0.004", 10, 260)]
    planets = [(name, EARTH * mpf(mass), (P,), e, mpf(k) / 10, 50 * k, omega, mean)
               for k, (name, mass, P, e, omega, mean) in enumerate(chain, 1)]
    write("chain", "Periods and masses as of TRAPPIST-1 (0.0898 Msun); angles are made up.", jacobi(G, ("star", "0.0898"), planets))
    planets = [("b", "1e-3", "0.5", "0.9", 0, 0, 40, 180), ("c", "2e-3", "3", "0.3", 8, 50, 110, 20),
               ("d", "5e-4", "12", "0.1", 4, 200, 250, 300)]
    write("eccentric", "Made up: a planet of 1e-3 Msun with a = 0.5 au and e = 0.9, two others at 3 and 12 au.",
          jacobi(G, ("star", "1"), planets))
    planets = [("B", "0.9", "0.2", "0.2", 0, 0, 0, 60), ("b", "1e-4", "0.9", "0.05", 3, 120, 70, 10),
               ("c", "3e-5", "1.8", "0.08", 5, 30, 200, 150), ("C", "0.5", "40", "0.3", 20, 80, 130, 200)]
    write("hierarchy", "Made up: stars of 1 and 0.9 Msun, 0.2 au apart, planets at 0.9 and 1.8 au, a star of 0.5 Msun at 40 au.",
          jacobi(G, ("A", "1"), planets))


if __name__ == "__main__":
    main()
