#!/usr/bin/env python3
"""Writes the scenes of this folder: the draws of Gaussians (.csv) and the scene files that use them (.toml).

Run it here; the output is committed, and running it again changes nothing. Lengths in metres. A medium's extinction is
sigma_t times the amplitudes of its table, so that one draw serves several optical depths.
"""

import math
import random
from pathlib import Path

FOLDER = Path(__file__).parent
FOV_50 = 50 * math.pi / 180
FOV_45 = 45 * math.pi / 180


def write_table(name, gaussians):
    """gaussians: (center, width, amplitude)."""
    lines = ["center_x,center_y,center_z,width,amplitude"]
    for (x, y, z), width, amplitude in gaussians:
        lines.append(",".join(f"{v:.9g}" for v in (x, y, z, width, amplitude)))
    (FOLDER / f"{name}.csv").write_text("\n".join(lines) + "\n")


def vector(v):
    return "[" + ", ".join(f"{x:.9g}" for x in v) + "]"


def write_scene(name, about, table, sigma_t, light, intensity, constant=0.0, position=(0, 1, -1), target=(0, 1, 8),
                fov=FOV_50, wall=18.0, wall_albedo=0.0, film=(24, 18), more="", albedo=None):
    """One light, or a list of places that share the intensity. A wall perpendicular to the view ends every ray; it is
    black, so that the picture is airlight alone. `more` is the text of further tables.
    """
    forward = [b - a for a, b in zip(position, target)]
    length = math.sqrt(sum(x * x for x in forward))
    forward = [x / length for x in forward]
    on_wall = [a + wall * b for a, b in zip(position, forward)]
    lights = light if isinstance(light, list) else [light]
    lights = "\n".join(f'''[[light]]
type = "point"
position = {vector(place)}
intensity = {intensity / len(lights):.9g}
''' for place in lights)
    # `constant` is an extinction [1/m]; the file's is multiplied by sigma_t.
    text = f'''# {about}
name = "fogshop/{name}"

[film]
width = {film[0]}
height = {film[1]}

[camera]
type = "perspective"
position = {vector(position)}
look_at = {vector(target)}
vertical_fov = {fov:.16g}

[[medium]]
name = "fog"
type = "gaussians"
file = "{table}.csv"
constant = {constant / sigma_t:.12g}
sigma_t = {sigma_t:.9g}
{f"albedo = {vector(albedo)}" + chr(10) if albedo else ""}
{lights}
[[surface]]
name = "wall"
type = "plane"
point = {vector(on_wall)}
normal = {vector([-x for x in forward])}
material = {{ type = "lambert", albedo = {wall_albedo:.1f} }}
{more}'''
    (FOLDER / f"{name}.toml").write_text(text)


def cloud(n, seed):
    """n Gaussians in a box; the narrower the more there are, so that they always overlap."""
    draw = random.Random(seed)
    narrower = 1 if n == 30 else 0.8 * (n / 30) ** (1 / 3)
    gaussians = []
    for _ in range(n):
        a = draw.uniform(0.45, 0.8) * narrower
        c = draw.uniform(0.3, 1)
        center = (draw.uniform(-6, 6), draw.uniform(-1, 3), draw.uniform(2, 14))
        gaussians.append((center, 1 / a, c))
    return gaussians


def smooth_fog():
    """Patchy fog, lit from outside and from within."""
    outside, inside = (4, 11, 3), (1, 3.2, 7)
    for n, seed in ((30, 1), (100, 2), (300, 3)):
        write_table(f"cloud_{n}", cloud(n, seed))
    write_scene("f100_thin", "100 Gaussians, optically thin, the light outside.", "cloud_100", 0.025, outside, 1000)
    write_scene("f100", "100 Gaussians, the light outside.", "cloud_100", 0.25, outside, 1000)
    write_scene("f100_constant", "100 Gaussians over a constant, the light outside.", "cloud_100", 0.25, outside, 1000,
                constant=0.02)
    for n in (30, 100, 300):
        write_scene(f"a{n}", f"{n} Gaussians over a constant, the light among them.", f"cloud_{n}", 0.25, inside, 50,
                    constant=0.01)
    write_scene("d100_thin", "100 Gaussians, optically thin, the light among them.", "cloud_100", 0.025, inside, 50)
    write_scene("d100", "100 Gaussians, the light among them; the depth sweep scales sigma_t.", "cloud_100", 0.25,
                inside, 50)
    write_scene("d100_thick", "100 Gaussians, optically thick, the light among them.", "cloud_100", 1.2, inside, 50)


def halo():
    """Zhou et al. 2007, Fig. 7, top: a light close to the centre of a Gaussian."""
    draw = random.Random(4)
    gaussians = []
    for i in range(12):
        c = draw.uniform(0.3, 0.8)
        center = (draw.uniform(-2, 2), draw.uniform(-1, 1), draw.uniform(5, 8))
        gaussians.append(((0, 0, 6) if i == 0 else center, 1, c))
    write_table("halo", gaussians)
    for name, distance in (("halo_far", 1.5), ("halo_near", 0.2)):
        write_scene(name, f"12 Gaussians, the light {distance} widths from the centre of one (Fig. 7, top).", "halo", 1,
                    (0, distance, 6), 10, position=(0, 0, 0), target=(0, 0, 6), wall=12)


def shaft():
    """Zhou et al. 2007, Fig. 7, bottom: a dense tube with a hole, a light inside, thin fog around."""
    gaussians = []
    for k in range(24):
        angle = 2 * math.pi * k / 24
        for j in range(20):
            y = -1.9 + 0.2 * j
            if abs(y) < 0.35 and abs(angle - 0.3) < 0.35:
                continue
            gaussians.append(((1.2 * math.cos(angle), y, 6 + 1.2 * math.sin(angle)), 0.2, 6))
    write_table("tube", gaussians)
    write_scene("tube", "A tube of 468 dense Gaussians with a hole, the light inside (Fig. 7, bottom).", "tube", 1,
                (0, 0, 6), 10, constant=0.03, position=(0, 0.7, 0), target=(0.6, 0, 6), fov=FOV_45, wall=10)


def same_density():
    """One wide Gaussian, and the same density as n narrower ones on a cubic lattice.

    Gaussians of squared width v on a lattice, weighted by one of squared width V - v, make one of squared width V, up
    to the lattice (below 1e-4 for a width of 1.05 steps) and the end of the lattice (e^-7 of the peak). The lattice is
    off centre, so that no two of its points are equally far out and any n will do.
    """
    middle, width, peak = (0, 1, 8), 3.0, 0.33
    off = (0.13, 0.29, 0.41)
    for n in (1, 57, 251, 967):
        gaussians = [(middle, width, peak)]
        if n > 1:
            reach = range(-9, 10)
            lattice = [(i + off[0], j + off[1], k + off[2]) for i in reach for j in reach for k in reach]
            lattice = sorted(lattice, key=lambda p: sum(x * x for x in p))[:n]
            ball = sum(x * x for x in lattice[-1])
            step = width / math.sqrt(ball / 7 + 1.05**2)
            narrow = 1.05 * step
            wide2 = width**2 - narrow**2
            scale = peak * step**3 * (width**2 / (math.pi * wide2 * narrow**2)) ** 1.5
            gaussians = []
            for p in lattice:
                offset = [x * step for x in p]
                weight = scale * math.exp(-sum(x * x for x in offset) / wide2)
                gaussians.append((tuple(m + x for m, x in zip(middle, offset)), narrow, weight))
        write_table(f"count_{n}", gaussians)
        write_scene(f"count_{n}", f"One density from {n} Gaussian{'s' if n > 1 else ''}, the light outside.",
                    f"count_{n}", 1, (4, 11, 3), 1000)


def many_lights():
    """One cloud, lit by more and more lights of the same power together."""
    for n in (1, 2, 4, 8, 16):
        ring = [(7 * math.cos(2 * math.pi * k / n), 9, 8 + 7 * math.sin(2 * math.pi * k / n)) for k in range(n)]
        write_scene(f"lights_{n}", f"100 Gaussians under {n} light{'s' if n > 1 else ''} outside.", "cloud_100", 0.25,
                    ring, 1000)


def edges():
    """Balls and thin posts in fog: edges of the distance, for the upsampling of section 5.4."""
    material = 'material = { type = "lambert", albedo = 0.5 }'
    more = ""
    balls = (((-2.2, 0.2, 5.5), 0.9), ((0.9, 1.6, 7), 1.0), ((2.6, -0.3, 4.5), 0.6), ((-0.4, -0.4, 3.6), 0.4),
             ((-3.5, 2.2, 9), 1.1))
    for i, (center, radius) in enumerate(balls):
        more += f'\n[[surface]]\nname = "ball {i}"\ntype = "sphere"\ncenter = {vector(center)}\n'
        more += f"radius = {radius:.9g}\n{material}\n"
    posts = ((-1.2, 4.2, 0.03), (-0.2, 6, 0.04), (0.4, 4.8, 0.025), (1.7, 6.5, 0.05), (3, 9, 0.06), (-3, 7, 0.05),
             (-2, 10, 0.06), (1, 3.4, 0.02))
    for i, (x, z, half) in enumerate(posts):
        lo, hi = (x - half, -1.5, z - half), (x + half, 3.2, z + half)
        more += f'\n[[surface]]\nname = "post {i}"\ntype = "box"\nlo = {vector(lo)}\nhi = {vector(hi)}\n{material}\n'
    write_scene("posts", "100 Gaussians around balls and thin posts: many edges of the distance (section 5.4).",
                "cloud_100", 0.15, (4, 11, 3), 1000, film=(160, 120), wall_albedo=0.5, more=more)


def scales():
    """The fog of f100 in other units of length: culling must not depend on the unit (section 5.3)."""
    for unit, name in ((100, "f100_large"), (0.01, "f100_small")):
        table = [(tuple(unit * x for x in center), unit * width, c) for center, width, c in cloud(100, 2)]
        write_table(f"cloud_{name[5:]}", table)
        write_scene(name, f"f100 with all lengths times {unit}.", f"cloud_{name[5:]}", 0.25 / unit,
                    tuple(unit * x for x in (4, 11, 3)), 1000 * unit**2, position=(0, unit, -unit),
                    target=(0, unit, 8 * unit), wall=18 * unit)


def colours():
    """White steam and brown smoke that extinguish alike: a colour per Gaussian, over a constant of a third one."""
    gaussians = cloud(100, 2)
    write_table("steam", gaussians[::2])
    write_table("smoke", gaussians[1::2])
    steam = '''
[[medium]]
name = "steam"
type = "gaussians"
file = "steam.csv"
sigma_t = 0.25
albedo = [0.98, 0.98, 0.98]

[[medium]]
name = "haze"
type = "homogeneous"
sigma_t = 0.01
albedo = [0.4, 0.6, 0.9]
'''
    write_scene("colours", "Steam, smoke and haze of different albedo and one hue of extinction, the light outside.",
                "smoke", 0.25, (4, 11, 3), 1000, more=steam, albedo=(0.7, 0.35, 0.1))


def lit_surfaces():
    """Surfaces lit through fog from above: an open floor, and a floor with walls around a corner that shadow it."""
    draw = random.Random(5)
    gaussians = []
    for _ in range(16):
        center = (draw.uniform(-3, 3), draw.uniform(0, 2.5), draw.uniform(-3, 3))
        gaussians.append((center, draw.uniform(0.5, 1.0), draw.uniform(0.5, 1.5)))
    write_table("patches", gaussians)
    constant = '[[medium]]\ntype = "homogeneous"\nsigma_t = 0.3\n'
    patches = '[[medium]]\ntype = "gaussians"\nfile = "patches.csv"\nsigma_t = 0.5\n'
    floor = '''[[surface]]
name = "floor"
type = "plane"
point = [0, 0, 0]
material = { type = "lambert", albedo = [0.8, 0.7, 0.6] }
'''
    walls = '''[[surface]]
name = "floor"
type = "height_field"
origin = [-6, 0, -6]
size = [97, 97]
spacing = [0.125, 0.125]
waves = []
material = { type = "lambert", albedo = [0.8, 0.7, 0.6] }

[[surface]]
name = "post"
type = "box"
lo = [-1.03, -0.1, -1.03]
hi = [-0.28, 1.6, 1.03]
material = { type = "lambert", albedo = 0 }

[[surface]]
name = "roof"
type = "box"
lo = [0.65, 0.9, -1.2]
hi = [2.4, 1.0, 0.6]
material = { type = "lambert", albedo = 0 }
'''
    matte = 'type = "lambert", albedo = [0.8, 0.7, 0.6]'
    phong_5 = floor.replace(matte, 'type = "phong", diffuse = 0.3, specular = 0.5, exponent = 5')
    phong_50 = floor.replace(matte, 'type = "phong", diffuse = 0.1, specular = 0.8, exponent = 50')
    for name, about, medium, surfaces in (
            ("floor_phong_5", "An open, dull floor in constant fog, a lamp above it.", constant, phong_5),
            ("floor_phong_50", "An open, shiny floor in constant fog, a lamp above it.", constant, phong_50),
            ("patches_phong_5", "An open, dull floor in 16 patches of fog, a lamp above it.", patches, phong_5),
            ("floor_constant", "An open floor in constant fog, a lamp above it.", constant, floor),
            ("floor_patches", "An open floor in 16 patches of fog, a lamp above it.", patches, floor),
            ("walls_constant", "A floor under a post and a roof in constant fog; they are black.", constant, walls),
            ("walls_patches", "A floor under a post and a roof in 16 patches of fog; they are black.", patches, walls)):
        (FOLDER / f"{name}.toml").write_text(f'''# {about}
name = "fogshop/{name}"

[film]
width = 32
height = 24

[camera]
type = "perspective"
position = [0, 4.5, 4]
look_at = [0, 0, 0]
vertical_fov = 0.7

{medium}
[[light]]
type = "point"
position = [0.4, 2.2, 0.3]
intensity = 10

{surfaces}''')


if __name__ == "__main__":
    lit_surfaces()
    smooth_fog()
    halo()
    shaft()
    same_density()
    many_lights()
    edges()
    scales()
    colours()
