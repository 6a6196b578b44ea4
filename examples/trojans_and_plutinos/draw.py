"""Which starts librate about Jupiter's L4, and which in 3:2 with Neptune: draw.py writes trojans.h5 and plutinos.h5, where they
are not there, and trojans_and_plutinos.png."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

import noether as nt

scene = pathlib.Path(__file__).with_name("scene.toml")
trojans = nt.ensemble(scene, ["particles.body.Trojan.l=44.3:204.3:32", "particles.body.Trojan.a=5:5.4:32"], out="trojans.h5")
plutinos = nt.ensemble(scene, ["particles.body.plutino.a=38.8:40.2:32", "particles.body.plutino.e=0.02:0.35:32"],
                       out="plutinos.h5")
run = nt.run(scene, out="trojans_and_plutinos.out", existing="fresh")

plt.style.use(nt.plots.STYLE)
figure, axes = plt.subplots(2, 2, figsize=(9.8, 7), layout="constrained", height_ratios=[1.35, 1])
for ax, table, monitor, name in ((axes[0, 0], trojans, "resonance_angle", "Trojans"),
                                 (axes[0, 1], plutinos, "resonance_angle_2", "plutinos")):
    amplitude = np.degrees(np.minimum(table[f"{monitor}_amplitude"], np.pi))
    print(f"{name}: {int((amplitude < 180).sum())} of {amplitude.size} librate")
    nt.plots.ensemble(table.assign(amplitude=amplitude.assign_attrs(units="deg")), "amplitude", limits=(0, 180), ax=ax)
    ax.set_title(name)
for ax, monitor, until, low in ((axes[1, 0], "resonance_angle", 2, -180), (axes[1, 1], "resonance_angle_2", 60, 0)):
    series = run.series(monitor)
    time, angle = series.time / 365250, (np.degrees(series.value) - low) % 360 + low
    ax.plot(time[time < until], angle[time < until], lw=1)
    ax.set_ylim(low, low + 360)
    ax.set_yticks(range(low, low + 361, 90))
    ax.set_xlabel("time (kyr)")
    ax.set_ylabel("resonance angle (deg)")
figure.savefig("trojans_and_plutinos.png", dpi=110)
