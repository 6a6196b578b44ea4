"""Writes slab.xyz: Lennard-Jones atoms in the middle of a long periodic box, a crystal that will melt, vacuum beside it.

    python3 make.py > slab.xyz

Extended XYZ in units of sigma. The same numbers come out every time: nothing is random.
"""

CELLS = (6, 6, 8)  # face-centred, along x, y and z
DENSITY = 0.75
LENGTH = 40.0  # of the box along z

edge = (4 / DENSITY) ** (1 / 3)
width, height = CELLS[0] * edge, CELLS[1] * edge
start = (LENGTH - CELLS[2] * edge) / 2
sites = [(0.25, 0.25, 0.25), (0.75, 0.75, 0.25), (0.75, 0.25, 0.75), (0.25, 0.75, 0.75)]

print(4 * CELLS[0] * CELLS[1] * CELLS[2])
print(f'Lattice="{width:.6f} 0 0 0 {height:.6f} 0 0 0 {LENGTH}" pbc="T T T" Properties=species:S:1:pos:R:3')
for k in range(CELLS[2]):
    for j in range(CELLS[1]):
        for i in range(CELLS[0]):
            for x, y, z in sites:
                print(f"A {(i + x) * edge:.4f} {(j + y) * edge:.4f} {start + (k + z) * edge:.4f}")
