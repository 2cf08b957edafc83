#!/usr/bin/env python3
"""Writes stiffness.mtx, mass.mtx, beam.dof and beam.inp: a free-free steel beam of 40 Euler-Bernoulli
elements along x (cubic bending, linear axial and torsional shapes, consistent mass; Przemieniecki,
Theory of Matrix Structural Analysis, sections 5.6 and 11.3, without shear and rotatory inertia).
Needs Python 3 only. Run in this folder."""

LENGTH, ELEMENTS = 1.0, 40
WIDTH, HEIGHT = 0.03, 0.02  # along y, z
YOUNG, POISSON, DENSITY = 2.1e11, 0.3, 7850.0

area = WIDTH * HEIGHT
i_y, i_z = WIDTH * HEIGHT**3 / 12, HEIGHT * WIDTH**3 / 12  # bending in x-z, in x-y
polar = i_y + i_z  # also taken as torsion constant: one number, a closed form to compare with
shear = YOUNG / (2 * (1 + POISSON))
h = LENGTH / ELEMENTS
k, m = {}, {}


def add(matrix, rows, block):
    for a, i in enumerate(rows):
        for b, j in enumerate(rows):
            if i >= j and block[a][b] != 0.0:
                matrix[i, j] = matrix.get((i, j), 0.0) + block[a][b]


def bending(inertia, sign):
    """Dofs w1, turn1, w2, turn2; sign -1 where a positive turn lowers the far end (about y)."""
    s = sign
    c = YOUNG * inertia / h**3
    stiff = [[12, 6 * h * s, -12, 6 * h * s], [6 * h * s, 4 * h * h, -6 * h * s, 2 * h * h],
             [-12, -6 * h * s, 12, -6 * h * s], [6 * h * s, 2 * h * h, -6 * h * s, 4 * h * h]]
    d = DENSITY * area * h / 420
    mass = [[156, 22 * h * s, 54, -13 * h * s], [22 * h * s, 4 * h * h, 13 * h * s, -3 * h * h],
            [54, 13 * h * s, 156, -22 * h * s], [-13 * h * s, -3 * h * h, -22 * h * s, 4 * h * h]]
    return [[c * v for v in r] for r in stiff], [[d * v for v in r] for r in mass]


for e in range(ELEMENTS):
    a, b = 6 * e, 6 * e + 6
    for offset, rigidity, inertia in [(0, YOUNG * area, DENSITY * area), (3, shear * polar, DENSITY * polar)]:
        c, d = rigidity / h, inertia * h / 6
        add(k, [a + offset, b + offset], [[c, -c], [-c, c]])
        add(m, [a + offset, b + offset], [[2 * d, d], [d, 2 * d]])
    for rows, inertia, sign in [([a + 2, a + 4, b + 2, b + 4], i_y, -1), ([a + 1, a + 5, b + 1, b + 5], i_z, 1)]:
        stiff, mass = bending(inertia, sign)
        add(k, rows, stiff)
        add(m, rows, mass)

nodes = ELEMENTS + 1
for name, matrix, unit in [("stiffness", k, "N/m"), ("mass", m, "kg")]:
    with open(f"{name}.mtx", "w") as f:
        f.write(f"%%MatrixMarket matrix coordinate real symmetric\n% free-free beam, {unit}, made by make.py\n")
        f.write(f"{6 * nodes} {6 * nodes} {len(matrix)}\n")
        for (i, j), v in sorted(matrix.items(), key=lambda e: (e[0][1], e[0][0])):
            f.write(f"{i + 1} {j + 1} {v:.17g}\n")
with open("beam.dof", "w") as f:
    for n in range(1, nodes + 1):
        f.writelines(f"{n}.{d}\n" for d in range(1, 7))
with open("beam.inp", "w") as f:
    f.write("** free-free beam along x, made by make.py\n*NODE, NSET=NALL\n")
    f.writelines(f"{n + 1}, {n * h:.17g}, 0, 0\n" for n in range(nodes))
    f.write("*NSET, NSET=LEFT\n1\n*NSET, NSET=RIGHT\n%d\n" % nodes)
