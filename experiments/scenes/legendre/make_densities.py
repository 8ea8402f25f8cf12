#!/usr/bin/env python3
"""Writes smooth.toml, rough.toml, smoke_cube.toml: densities of Legendre coefficients, the same at every call.

smooth, rough: random coefficients, scaled to densities from 0.4 to 1.6 with mean 1; smoke_cube: 1 within a cube of half the box's sides,
projected, with Lanczos' factors and drawn towards its mean until it is positive (Gupta and Narasimhan 2007, Figure 13).
"""
import math
import random
import textwrap
from pathlib import Path

FOLDER = Path(__file__).parent
CAMERA = """\
[film]
width = 160
height = 120

[camera]
type = "orthographic"
position = {position}
look_at = [0, 0, 0]
height = {height}
"""


def legendre(n, x):
    p, values = [1, x], []
    for k in range(n):
        p.append(((2 * k + 3) * x * p[-1] - (k + 1) * p[-2]) / (k + 2))
        values.append(math.sqrt(k + 0.5) * p[k])
    return values


def samples(c, n, count):
    """Values at count^3 points, faces included."""
    basis = [legendre(n, -1 + 2 * i / (count - 1)) for i in range(count)]
    for x in basis:
        plane = [sum(x[i] * c[i * n * n + jk] for i in range(n)) for jk in range(n * n)]
        for y in basis:
            row = [sum(y[j] * plane[j * n + k] for j in range(n)) for k in range(n)]
            for z in basis:
                yield sum(z[k] * row[k] for k in range(n))


def random_density(n, seed, decay):
    draw = random.Random(seed)
    c = [draw.gauss(0, 1) * (1 + i + j + k) ** -decay for i in range(n) for j in range(n) for k in range(n)]
    c[0] = 0
    most = max(abs(v) for v in samples(c, n, 4 * n + 1))
    return [math.sqrt(8)] + [0.6 * v / most for v in c[1:]]


def smoke_cube(n):
    def along(k):  # the integral of L_k over [-1/2, 1/2], times sinc(k/n)
        p = [1, 0.5]
        for i in range(1, k + 1):
            p.append(((2 * i + 1) * 0.5 * p[-1] - i * p[-2]) / (i + 1))
        integral = 1 if k == 0 else 0 if k % 2 else 2 * (p[k + 1] - p[k - 1]) / (2 * k + 1)
        return math.sqrt(k + 0.5) * integral * (1 if k == 0 else math.sin(math.pi * k / n) / (math.pi * k / n))

    one = [along(k) for k in range(n)]
    c = [one[i] * one[j] * one[k] for i in range(n) for j in range(n) for k in range(n)]
    mean, least = c[0] / math.sqrt(8), min(samples(c, n, 4 * n + 1))
    theta = min(1, 0.99 * mean / (mean - least))
    return [c[0]] + [theta * v + 0 for v in c[1:]]  # no -0


def medium(n, c, lines):
    numbers = textwrap.fill(", ".join(f"{v:.10g}" for v in c), 136, initial_indent="  ", subsequent_indent="  ")
    return f"""
[[medium]]
type = "legendre"
{lines}lo = [-1, -1, -1]
hi = [1, 1, 1]
size = [{n}, {n}, {n}]
coefficients = [
{numbers},
]
"""


def oblique(name, title, n, seed, decay):
    """Light along (.48, .6, -.64), seen along (-.36, .48, .8); as the paper's systems need it: orthographic, one medium, nothing else."""
    text = f"# {title[0].upper() + title[1:]}, light and view oblique, for the errors of systems and rays. By make_densities.py.\n"
    text += f'name = "{title}"\n\n' + CAMERA.format(position="[-1.8, 2.4, 4]", height=2.8)
    text += '\n[[light]]\ntype = "directional"\nto_light = [-0.48, -0.6, 0.64]\nirradiance = 1\n'
    text += medium(n, random_density(n, seed, decay), "sigma_t = 0.5  # times 2 it is the mean optical depth along an edge\nalbedo = 0.8\n")
    (FOLDER / f"{name}.toml").write_text(text)


def main():
    oblique("smooth", "smooth density of 64 coefficients", 4, 1, 2)
    oblique("rough", "rough density of 216 coefficients", 6, 2, 0)
    text = "# A cube of smoke in 64 coefficients before a wall: Gupta and Narasimhan 2007, Figure 13. By make_densities.py.\n"
    text += 'name = "smoke cube before a wall"\n\n' + CAMERA.format(position="[2.4, 1.2, 8]", height=5.6)
    text += '\n[[light]]\ntype = "directional"\nto_light = [-0.9, 0.5, 1]\nirradiance = 3.5\n'
    text += '\n[[surface]]\ntype = "plane"\nname = "wall"\npoint = [0, 0, -1.6]\nnormal = [0, 0, 1]\n'
    text += 'material = { type = "lambert", albedo = 0.8 }\n'
    text += medium(4, smoke_cube(4), "sigma_t = 8\nalbedo = 0.95\n")
    (FOLDER / "smoke_cube.toml").write_text(text)


main()
