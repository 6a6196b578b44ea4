"""TRAPPIST-1 with masses drawn from what is known: draw.py writes trappist_1.h5, where it is not there, and trappist_1.png."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

import noether as nt

MASSES = {"b": (1.017, 0.15), "c": (1.156, 0.14), "d": (0.297, 0.037), "e": (0.772, 0.077), "f": (0.934, 0.079),
          "g": (1.148, 0.097), "h": (0.331, 0.053)}  # Earth masses
scene = pathlib.Path(__file__).with_name("scene.toml")
vary = [f"particles.body.{name}.mass=normal({mean},{error})" for name, (mean, error) in MASSES.items()]
table = nt.ensemble(scene, vary, members=400, out="trappist_1.h5")

pairs = {"resonance_angle": "d, e (3:2)", "resonance_angle_2": "e, f (3:2)", "resonance_angle_3": "f, g (4:3)",
         "resonance_angle_4": "g, h (3:2)"}
plt.style.use(nt.plots.STYLE)
figure, (left, right) = plt.subplots(1, 2, figsize=(9.4, 3.8), layout="constrained")
for name, label in pairs.items():
    amplitude = np.degrees(np.minimum(table[f"{name}_amplitude"].values, np.pi))
    librate = (amplitude < 180).mean()
    print(f"{label}: {100 * librate:.0f} % librate, amplitudes {np.median(amplitude):.0f} deg in the median")
    left.hist(amplitude, bins=np.linspace(0, 100, 51), histtype="step", lw=1.5, label=label)
left.set_xlabel("amplitude of the angle in 30 yr (deg)")
left.set_ylabel("members")
left.legend()
shown = table.assign(amplitude=np.degrees(np.minimum(table["resonance_angle_2_amplitude"], np.pi)).assign_attrs(units="deg"))
nt.plots.ensemble(shown, "amplitude", x="particles.body.e.mass", y="particles.body.f.mass", ax=right)
right.set_title("e and f")
figure.savefig("trappist_1.png", dpi=110)
