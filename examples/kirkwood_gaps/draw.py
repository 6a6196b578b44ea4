"""Where Jupiter empties the belt of asteroids: draw.py writes kirkwood_gaps.h5, where it is not there, and kirkwood_gaps.png."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

import noether as nt

scene = pathlib.Path(__file__).with_name("scene.toml")
asteroid = "particles.body.asteroid."
vary = [asteroid + one for one in ("a=uniform(2,3.5)", "e=uniform(0.05,0.25)", "pomega=uniform(0,360)", "M=uniform(0,360)")]
table = nt.ensemble(scene, vary, members=600, out="kirkwood_gaps.h5")

stays = (table["outcome"] == "completed").values
start = table[asteroid + "a"].values
end = table["elements_value"].sel(body="asteroid")
print(f"{stays.sum()} of {stays.size} never came within the orbit of Mars")

plt.style.use(nt.plots.STYLE)
figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5.6), sharex=True, layout="constrained")
above.plot(start[~stays], table[asteroid + "e"].values[~stays], "x", ms=4, color="#ee6677", label="start of one that was lost")
above.plot(end.sel(elements_value_column="a").values[stays], end.sel(elements_value_column="e").values[stays], ".", ms=4, mew=0,
           color="#4477aa", label="end of one that stayed")
above.set_ylabel("eccentricity")
above.set_ylim(0, 0.5)
above.legend(loc="upper left", ncols=2)
bins = np.linspace(2, 3.5, 51)
below.hist(end.sel(elements_value_column="a").values[stays], bins=bins, color="#4477aa")
below.set_ylabel("asteroids")
below.set_xlabel("semi-major axis (au)")
for p, q in ((4, 1), (3, 1), (5, 2), (7, 3), (2, 1)):
    a = 5.2026 * (q / p) ** (2 / 3)
    for ax in (above, below):
        ax.axvline(a, color="#777777", lw=0.8, ls=(0, (4, 3)), zorder=0)
    below.annotate(f"{p}:{q}", (a, 0.97), xycoords=("data", "axes fraction"), ha="left", va="top", fontsize=9, xytext=(3, 0),
                   textcoords="offset points")
figure.savefig("kirkwood_gaps.png", dpi=110)
