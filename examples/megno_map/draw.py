"""Makes the map of MEGNO over two planets and draws it: draw.py writes megno_map.h5, where it is not there, and megno_map.png."""

import pathlib

import noether as nt

scene = pathlib.Path(__file__).with_name("scene.toml")
table = nt.ensemble(scene, ["particles.body.Saturn.a=7:10:64", "particles.body.Saturn.e=0:0.5:64"], out="megno_map.h5")

# Those that have left the system are chaotic, however short they were there.
table["megno_mean"] = table["megno_mean"].where(table["outcome"] == "completed", 10)
regular = int((table["megno_mean"] < 2.5).sum())
print(f"{regular} of {table['megno_mean'].size} are regular so far, {int((table['outcome'] == 'stopped').sum())} have escaped")

ax = nt.plots.ensemble(table, "megno_mean")
for p, q in ((2, 1), (5, 2), (7, 3)):
    ax.annotate(f"{p}:{q}", (5.204 * (p / q) ** (2 / 3), 0.505), ha="center", va="bottom", annotation_clip=False, fontsize=9)
ax.set_xlabel("semi-major axis of Saturn (au)")
ax.set_ylabel("eccentricity of Saturn")
ax.figure.savefig("megno_map.png", dpi=110)
