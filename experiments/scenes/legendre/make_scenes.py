#!/usr/bin/env python3
"""Writes the scenes of Gupta and Narasimhan's Figures 1, 15 and 16 that are too long for hands: a winter evening and a
lake among mountains, without a medium (the pictures behind mist are rendered from them, README.md), lamps as particles, and
mist as Legendre coefficients."""
import math
import os
import random

here = os.path.dirname(os.path.abspath(__file__))


def write(name, text):
    with open(os.path.join(here, name), "w", encoding="ascii") as file:
        file.write(text)


def numbers(values):
    return "[" + ", ".join(f"{v:.5g}" for v in values) + "]"


def surface(kind, color, **keys):
    lines = ["", "[[surface]]", f'type = "{kind}"']
    for key, value in keys.items():
        lines.append(f"{key} = {numbers(value) if isinstance(value, (list, tuple)) else value}")
    lines.append(f'material = {{ type = "lambert", albedo = {numbers(color)} }}')
    return "\n".join(lines) + "\n"


def legendre(k, x):
    """Orthonormal Legendre functions, by their recurrence."""
    p, before = 1.0, 0.0
    for i in range(k):
        p, before = ((2 * i + 1) * x * p - i * before) / (i + 1), p
    return math.sqrt(k + 0.5) * p


def gauss(n):
    """Nodes and weights on [-1, 1], by Newton's method."""
    rule = []
    for i in range(n):
        x = math.cos(math.pi * (i + 0.75) / (n + 0.5))
        for _ in range(50):
            p, before = 1.0, 0.0
            for k in range(n):
                p, before = ((2 * k + 1) * x * p - k * before) / (k + 1), p
            slope = n * (x * p - before) / (x * x - 1)
            x -= p / slope
        rule.append((x, 2 / ((1 - x * x) * slope * slope)))
    return rule


def project(density, size):
    """The L2 projection of a density on [-1, 1]^3, as the CSV of a Legendre box, damped by Lanczos' factors."""
    rule = gauss(24)
    basis = [[[legendre(k, x) * w for x, w in rule] for k in range(n)] for n in size]
    values = [[[density(x, y, z) for z, _ in rule] for y, _ in rule] for x, _ in rule]
    damp = [[1 if k == 0 else math.sin(math.pi * k / n) / (math.pi * k / n) for k in range(n)] for n in size]
    rows = ["i,j,k,coefficient"]
    along_z = [[[sum(v * b for v, b in zip(row, basis[2][k])) for k in range(size[2])] for row in plane]
               for plane in values]
    for i in range(size[0]):
        for j in range(size[1]):
            for k in range(size[2]):
                c = sum(basis[0][i][p] * basis[1][j][q] * along_z[p][q][k] for p in range(24) for q in range(24))
                rows.append(f"{i},{j},{k},{round(c * damp[0][i] * damp[1][j] * damp[2][k], 9):.8g}")
    return "\n".join(rows) + "\n"


def tree(x, y, z, height, random_green):
    g = random_green
    text = surface("prism", [0.10, 0.06, 0.03], base=(x, y - 0.5, z), sides=6, radius=0.05 * height,
                   height=0.3 * height + 0.5)
    for i in range(4):
        low = y + height * (0.12 + 0.2 * i)
        r = height * (0.27 - 0.055 * i)
        text += surface("prism", [0.06 * g, 0.13 * g, 0.07 * g], base=(x, low, z), sides=14, radius=r,
                        top_radius=0.18 * r, height=0.30 * height)
        # Snow on the upper parts of the branches.
        text += surface("prism", [0.80, 0.82, 0.86], base=(x, low + 0.17 * height, z), sides=14, radius=0.57 * r,
                        top_radius=0.10 * r, height=0.16 * height)
    return text


def house(x, z, w, d, h, roof):
    text = surface("box", [0.42, 0.20, 0.13], lo=(x - w / 2, -0.4, z - d / 2), hi=(x + w / 2, h, z + d / 2))
    # A roof of four sides, its ridge a point; snow on it.
    size = max(w, d) * 0.5 * math.sqrt(2) + 0.5
    text += ("\n[[surface]]\ntype = \"prism\"\nsides = 4\nradius = %.5g\ntop_radius = 0.3\nheight = %.5g\n"
             "transform = { rotation = { axis = [0, 1, 0], angle = 0.785398 }, translation = %s }\n"
             "material = { type = \"lambert\", albedo = [0.82, 0.84, 0.88] }\n" % (size, roof, numbers((x, h, z))))
    text += surface("box", [0.30, 0.16, 0.11], lo=(x + w / 4, h, z - 0.3), hi=(x + w / 4 + 0.6, h + roof, z + 0.3))
    return text


def winter():
    rng = random.Random(7)
    waves = [(0.25, 0.12, 0.05, 1.0), (0.16, -0.08, 0.21, 0.3), (0.05, 0.6, 0.5, 2.0), (0.02, -1.7, 2.3, 0.7)]

    def ground(x, z):
        return sum(a * math.sin(kx * (x + 60) + kz * (z + 160) + p) for a, kx, kz, p in waves)

    text = """# A village on a winter evening, without mist: written by make_scenes.py. Its picture is the backdrop of figure 1.
name = "legendre/winter, clear"

[film]
width = 640
height = 480

[camera]
position = [0, 2.4, 15]
look_at = [0, 3.1, 0]
vertical_fov = 0.62

[[light]]
type = "environment"
sh = [[0.95, 1.10, 1.75], [-0.46, -0.42, -0.38], [0, 0, 0], [0, 0, 0]]

[[light]]
type = "directional"
to_light = [0.55, 0.35, 0.35]
irradiance = [0.5, 0.42, 0.42]

[[particles]]
type = "disc"
file = "winter_lamps.csv"
set = 0
radius = 0.13
radiance = [[3.0, 1.7, 0.6]]

[[particles]]
type = "disc"
file = "winter_lamps.csv"
set = 1
radius = 0.05
radiance = [[3.0, 0.5, 0.4], [2.6, 1.9, 0.5], [0.5, 2.2, 0.6], [0.6, 0.9, 3.0]]

[[particles]]
type = "disc"
file = "winter_lamps.csv"
set = 2
radius = 0.17
radiance = [[3.0, 2.4, 1.2]]
"""
    for x, y, z, power in [(-4.6, 1.3, -0.4, 4.5), (3.1, 1.6, 3.6, 3.5), (7.6, 1.4, -9.2, 5), (-11, 1.4, -19, 6),
                           (0.2, 2.6, -13, 5)]:
        color = numbers((power, 0.62 * power, 0.28 * power))
        text += f"\n[[light]]\ntype = \"point\"\nposition = {numbers((x, y, z))}\nintensity = {color}\n"
    text += ("\n[[surface]]\nname = \"snow\"\ntype = \"height_field\"\nsize = [241, 361]\nspacing = [0.5, 0.5]\n"
             "origin = [-60, 0, -160]\nwaves = [\n")
    for a, kx, kz, p in waves:
        text += f"  {{ amplitude = {a}, wave_vector = [{kx}, {kz}], phase = {p} }},\n"
    text += "]\nmaterial = { type = \"lambert\", albedo = [0.84, 0.86, 0.90] }\n"
    # Hills behind.
    text += """
[[surface]]
name = "hills"
type = "height_field"
size = [161, 81]
spacing = [2.5, 2.5]
origin = [-200, 6, -360]
waves = [
  { amplitude = 14, wave_vector = [0.021, 0.013], phase = 1.1 },
  { amplitude = 8, wave_vector = [-0.047, 0.02], phase = 0.2 },
  { amplitude = 2, wave_vector = [0.13, 0.08], phase = 2.2 },
]
material = { type = "lambert", albedo = [0.52, 0.56, 0.62] }
"""
    houses = [(-5.2, -3.6, 5.2, 4.2, 2.6, 2.3), (8.4, -12, 5.5, 4.5, 2.7, 2.4), (-12, -22, 6, 5, 2.8, 2.6), (16, -36, 7, 6, 3, 3),
              (-1, -48, 7, 6, 3, 3)]
    lamps = ["set,x,y,z"]
    for x, z, w, d, h, roof in houses:
        text += house(x, z, w, d, h, roof)
        for side in (-1, 1):  # two windows of four panes in the wall that faces the camera
            for i in range(2):
                for j in range(2):
                    pane = (x + side * 0.27 * w + (i - 0.5) * 0.34, 1.35 + (j - 0.5) * 0.36, z + d / 2 + 0.06)
                    lamps.append("0," + ",".join(f"{v:.4g}" for v in pane))
    text += tree(3.1, ground(3.1, 2), 2, 4.4, 1.6)
    for i in range(90):  # a garland around the tree
        share = (i + 0.5) / 90
        y = 0.75 + 3.3 * share
        r = 1.13 * (1 - share) + 0.12
        angle = 31 * share
        lamps.append(f"1,{3.1 + r * math.sin(angle):.4g},{ground(3.1, 2) + y:.4g},{2 + r * math.cos(angle):.4g}")
    lamps.append(f"2,3.1,{ground(3.1, 2) + 4.55:.4g},2.1")
    for i in range(46):
        z = -8 - 100 * rng.random() ** 1.3
        x = (rng.random() - 0.5) * (22 + 0.9 * -z)
        if any(abs(x - hx) < hw * 0.9 + 1 and abs(z - hz) < hd * 1.2 + 2 for hx, hz, hw, hd, _, _ in houses):
            continue
        if abs(x) < 2.2 and z > -30:
            continue
        text += tree(x, ground(x, z), z, 4 + 5 * rng.random(), 0.8 + 0.5 * rng.random())
    write("winter_clear.toml", text)
    write("winter_lamps.csv", "\n".join(lamps) + "\n")


terrain_origin = (-9000, -8500)


def terrain_waves():
    rng = random.Random(23)
    waves = [(760, 2 * math.pi / 9500, 0, -math.pi / 2 - 2 * math.pi / 9500 * -terrain_origin[0] + 2 * math.pi)]
    for i in range(46):
        length = 4600 * (0.035 ** (i / 45))
        angle = 2 * math.pi * rng.random()
        amplitude = 0.026 * length ** 1.03 * (0.6 + 0.8 * rng.random())
        k = 2 * math.pi / length
        waves.append((amplitude, k * math.cos(angle), k * math.sin(angle), 2 * math.pi * rng.random()))
    return waves


def lake_surfaces():
    waves = terrain_waves()

    def layer(name, color, share, level, noise, seed):
        rng = random.Random(seed)
        mine = [(share * a, kx, kz, p) for a, kx, kz, p in waves]
        for _ in range(6 if noise else 0):
            k = 2 * math.pi / (140 + 500 * rng.random())
            angle = 2 * math.pi * rng.random()
            mine.append((noise, k * math.cos(angle), k * math.sin(angle), 2 * math.pi * rng.random()))
        text = (f"\n[[surface]]\nname = \"{name}\"\ntype = \"height_field\"\nsize = [361, 361]\nspacing = [49.777778, 49.777778]\n"
                f"origin = [{terrain_origin[0]}, {(1 - share) * level:.5g}, {terrain_origin[1]}]\nwaves = [\n")
        for a, kx, kz, p in mine:
            text += f"  {{ amplitude = {a:.6g}, wave_vector = [{kx:.6g}, {kz:.6g}], phase = {p:.6g} }},\n"
        return text + f"]\nmaterial = {{ type = \"lambert\", albedo = {numbers(color)} }}\n"

    # Copies of one terrain, drawn a little towards a height: each is on top on one side of that height.
    text = layer("rock", (0.34, 0.31, 0.28), 1, 0, 0, 1)
    text += layer("snow", (0.86, 0.88, 0.92), 1.03, 330, 1.6, 2)
    text += layer("forest", (0.06, 0.11, 0.045), 0.97, 60, 1.2, 3)
    text += layer("meadows", (0.17, 0.26, 0.07), 0.94, -320, 1.5, 4)
    text += ("\n[[surface]]\nname = \"lake\"\ntype = \"box\"\nlo = [-9000, -1500, -9000]\nhi = [9000, -560, 9500]\n"
             "material = { type = \"lambert\", albedo = [0.03, 0.08, 0.11] }\n")
    return text


lights = """
[[light]]
type = "environment"
sh = [[1.25, 1.75, 2.65], [-0.35, -0.42, -0.30], [0, 0, 0], [0, 0, 0]]

[[light]]
type = "directional"
to_light = [-0.75, 0.55, 0.25]
irradiance = [3.6, 3.3, 2.8]
"""


def lake():
    write("lake_clear.toml", """# A lake among mountains, without mist: written by make_scenes.py. Its picture is the backdrop of figure 15.
name = "legendre/lake, clear"

[film]
width = 640
height = 480

[camera]
position = [-300, 420, -7600]
look_at = [100, -420, -1200]
vertical_fov = 0.72
""" + lights + lake_surfaces())
    def mist(x, y, z):
        return (0.06 + 1.2 * math.exp(-((x - 0.02) / 0.36) ** 2 - ((z + 0.10) / 0.42) ** 2)) * (0.5 * (1 - y)) ** 2

    write("lake_mist.csv", project(mist, (8, 5, 8)))


def alps():
    write("alps.toml", """# A flight over the lake of lake_clear.toml in fog that drifts (Gupta and Narasimhan 2007, Figure 16); its
# mountains are surfaces. Experiments give the places of the camera, and frames of flows/alps.toml as the fog; the file only stands for it.
# Written by make_scenes.py.
name = "legendre/alps"

[film]
width = 320
height = 240

[camera]
position = [-300, 420, -7600]
look_at = [100, -420, -1200]
vertical_fov = 0.8

[[medium]]
name = "fog"
type = "legendre"
file = "lake_mist.csv"
size = [8, 5, 8]
lo = [-3400, -565, -7800]
hi = [3400, 100, 5200]
sigma_t = 0.0014
""" + lights + lake_surfaces())


winter()
lake()
alps()
