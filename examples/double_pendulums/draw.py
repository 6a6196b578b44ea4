"""Which double pendulums are chaotic: draw.py writes double_pendulums.h5, where it is not there, and double_pendulums.png."""

import pathlib

import noether as nt

scene = pathlib.Path(__file__).with_name("scene.toml")
table = nt.ensemble(scene, ["system.length2=0.4:1.6:24", "system.mass2=0.2:3:24"], out="double_pendulums.h5")

print(f"{int((table['megno_mean'] > 4).sum())} of {table['megno_mean'].size} are chaotic")
ax = nt.plots.ensemble(table, "megno_mean", limits=(1, 8))
ax.set_xlabel("lower rod, beside the upper one")
ax.set_ylabel("lower bob, beside the upper one")
ax.figure.savefig("double_pendulums.png", dpi=110)
