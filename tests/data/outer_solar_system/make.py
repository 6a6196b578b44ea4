"""Outer solar system after 10000 days, to 25 digits: Taylor series of degree 30 in 40-digit arithmetic.

Shares no code and no method with the integrators it is to judge. Run it with `python3 make.py > after_10000_days.txt`;
with `--check` it compares the file with DOP853 (scipy) and, if it is installed, IAS15 (rebound).
"""

import sys

from mpmath import mp, mpf

mp.dps = 40
DEGREE = 30
G = 2.95912208286e-4
BODIES = [  # name, mass, position [au], velocity [au/day]
    ("Sun", 1.00000597682, (0, 0, 0), (0, 0, 0)),
    ("Jupiter", 0.000954786104043, (-3.5023653, -3.8169847, -1.5507963), (0.00565429, -0.00412490, -0.00190589)),
    ("Saturn", 0.000285583733151, (9.0755314, -3.0458353, -1.6483708), (0.00168318, 0.00483525, 0.00192462)),
    ("Uranus", 0.0000437273164546, (8.3101420, -16.2901086, -7.2521278), (0.00354178, 0.00137102, 0.00055029)),
    ("Neptune", 0.0000517759138449, (11.4707666, -25.7294829, -10.8169456), (0.00288930, 0.00114527, 0.00039677)),
    ("Pluto", 1 / 1.3e8, (-15.5387357, -25.2225594, -3.1902382), (0.00276725, -0.00170702, -0.00136504)),
]


def series(x, v, gm):
    """Taylor coefficients of all positions; u = r^2 and w = u^(-3/2) of every pair follow by their recurrences."""
    n = len(x)
    c = [[[x[i][k], v[i][k]] for k in range(3)] for i in range(n)]
    pairs = [(i, j) for i in range(n) for j in range(i)]
    u = {pair: [] for pair in pairs}
    w = {pair: [] for pair in pairs}
    d = {pair: [[], [], []] for pair in pairs}
    for order in range(DEGREE):
        acceleration = [[mpf(0)] * 3 for _ in range(n)]
        for pair in pairs:
            i, j = pair
            dp, up, wp = d[pair], u[pair], w[pair]
            for k in range(3):
                dp[k].append(c[i][k][order] - c[j][k][order])
            up.append(sum(dp[k][m] * dp[k][order - m] for k in range(3) for m in range(order + 1)))
            if order == 0:
                wp.append(up[0] ** mpf("-1.5"))
            else:
                s = sum((mpf("-1.5") * (order - m) - m) * wp[m] * up[order - m] for m in range(order))
                wp.append(s / (order * up[0]))
            for k in range(3):
                f = sum(wp[m] * dp[k][order - m] for m in range(order + 1))
                acceleration[i][k] -= gm[j] * f
                acceleration[j][k] += gm[i] * f
        for i in range(n):
            for k in range(3):
                c[i][k].append(acceleration[i][k] / ((order + 1) * (order + 2)))
    return c


def taylor(days, step):
    gm = [mpf(G) * mpf(m) for _, m, _, _ in BODIES]
    x = [[mpf(q) for q in body[2]] for body in BODIES]
    v = [[mpf(q) for q in body[3]] for body in BODIES]
    h = mpf(step)
    for _ in range(days // step):
        c = series(x, v, gm)
        x = [[sum(a * h**m for m, a in enumerate(c[i][k])) for k in range(3)] for i in range(len(x))]
        v = [[sum(m * a * h ** (m - 1) for m, a in enumerate(c[i][k]) if m) for k in range(3)] for i in range(len(x))]
    return x, v


def check(path):
    import numpy
    from scipy.integrate import solve_ivp

    rows = [line.split() for line in open(path) if not line.startswith("#")]
    exact = numpy.array([[float(q) for q in row[1:4]] for row in rows])
    m = numpy.array([body[1] for body in BODIES])
    x0 = numpy.array([body[2] for body in BODIES], float)
    v0 = numpy.array([body[3] for body in BODIES], float)

    def f(_, y):
        x = y[:18].reshape(6, 3)
        d = x[:, None] - x[None]
        r3 = (d**2).sum(2) ** 1.5
        numpy.fill_diagonal(r3, 1)
        return numpy.concatenate([y[18:], (-G * (m[None, :, None] * d / r3[:, :, None]).sum(1)).ravel()])

    y = solve_ivp(f, (0, 10000), numpy.concatenate([x0.ravel(), v0.ravel()]), "DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    print("DOP853:", abs(y[:18].reshape(6, 3) - exact).max(), "au")
    try:
        import rebound
    except ImportError:
        return
    sim = rebound.Simulation()
    sim.G = G
    for i in range(6):
        sim.add(m=m[i], x=x0[i, 0], y=x0[i, 1], z=x0[i, 2], vx=v0[i, 0], vy=v0[i, 1], vz=v0[i, 2])
    sim.integrate(10000)
    print("IAS15: ", abs(numpy.array([[p.x, p.y, p.z] for p in sim.particles]) - exact).max(), "au")


if __name__ == "__main__":
    if "--check" in sys.argv:
        check("after_10000_days.txt")
    else:
        print("# body x y z [au] vx vy vz [au/day] at day 10000, made by make.py")
        x, v = taylor(10000, 20)
        for body, a, b in zip(BODIES, x, v):
            print(body[0], *(mp.nstr(q, 28) for q in a + b))
