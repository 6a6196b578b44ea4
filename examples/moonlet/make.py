"""Writes disc.csv: tracers of a disc that would fill a strip about the moonlet evenly after a time of 80, were it not there.

    python3 make.py > disc.csv

Places are those of the sequence R2, which leaves neither heaps nor holes: nothing is random.
"""

TIME, X, Y, COUNT = 80, 7, 60, 6000
RADIUS = 0.5  # of the moonlet

golden = 1.32471795724474602596  # x^3 = x + 1
print("mass,x,y,z,vx,vy,vz")
for k in range(1, COUNT + 1):
    x = round(X * (2 * (k / golden % 1) - 1), 3)
    y = round(Y * (2 * (k / golden**2 % 1) - 1) + 1.5 * x * TIME, 2)
    if x * x + y * y > 1.1 * RADIUS**2:
        print(f"0,{x},{y},0,0,{-1.5 * x:.4f},0")
