"""Where Jupiter empties the belt of asteroids: draw.py writes kirkwood_gaps.h5, where it is not there, and kirkwood_gaps.png."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

import noether as nt

scene = pathlib.Path(__file__).with_name("scene.toml")
asteroid = "particles.body.asteroid."
vary = [asteroid + one for one in ("a=uniform(2.3,2.9)", "e=uniform(0.05,0.12)", "pomega=uniform(0,360)", "M=uniform(0,360)")]
table = nt.ensemble(scene, vary, members=320, out="kirkwood_gaps.h5")

stays = (table["outcome"] == "completed").values
start = table[asteroid + "a"].values
end = table["elements_value"].sel(body="asteroid")
near = abs(start - 2.5) < 0.015
print(f"{(~stays).sum()} of {stays.size} have come to the orbit of Mars; of the {near.sum()} from 2.485 to 2.515 au "
      f"{(near & ~stays).sum()}")

plt.style.use(nt.plots.STYLE)
figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5.6), sharex=True, layout="constrained")
above.plot(start[~stays], table[asteroid + "e"].values[~stays], "x", ms=6, mew=1.5, color="#ee6677", zorder=3,
           label="start of one that was lost")
above.plot(end.sel(elements_value_column="a").values[stays], end.sel(elements_value_column="e").values[stays], ".", ms=4, mew=0,
           color="#4477aa", label="end of one that stayed")
above.set_ylabel("eccentricity")
above.set_ylim(0, 0.27)
above.legend(loc="upper left", ncols=2)
bins = np.linspace(2.3, 2.9, 31)
below.hist(start, bins=bins, color="#dddddd", label="at the start")
below.hist(end.sel(elements_value_column="a").values[stays], bins=bins, color="#4477aa", label="after 200,000 years")
below.set_ylim(0, 21)
below.legend(loc="upper left", bbox_to_anchor=(0, 0.9), ncols=2)
below.set_ylabel("asteroids")
below.set_xlabel("semi-major axis (au)")
for p, q in ((3, 1), (8, 3), (5, 2)):
    a = 5.2026 * (q / p) ** (2 / 3)
    for ax in (above, below):
        ax.axvline(a, color="#777777", lw=0.8, ls=(0, (4, 3)), zorder=0)
    below.annotate(f"{p}:{q}", (a, 0.97), xycoords=("data", "axes fraction"), ha="left", va="top", fontsize=9, xytext=(3, 0),
                   textcoords="offset points")
figure.savefig("kirkwood_gaps.png", dpi=110)
