#!/usr/bin/env python3
"""Writes the meshes (.off) and scenes (.toml) after Figures 1, 7 and 8 of Biri et al. 2006, whose own are not published.

Run it here; the output is committed, and running it again changes nothing. Numbers of triangles are the paper's, or those
closest to them that our shapes have. Meshes are closed; their vertices are whole numbers, which the scenes scale.
"""

import math
from pathlib import Path

FOLDER = Path(__file__).parent


def write_mesh(name, vertices, triangles):
    lines = ["OFF", f"{len(vertices)} {len(triangles)} 0"]
    lines += [" ".join(map(str, v)) for v in vertices]
    lines += ["3 " + " ".join(map(str, t)) for t in triangles]
    (FOLDER / f"{name}.off").write_text("\n".join(lines) + "\n")


def lathe(name, sides, profile):
    """A profile (radius, y) turned about the y axis, from the bottom, where the radius is 0, to the top, where it is."""
    rings = profile[1:-1]
    vertices = [(0, round(profile[0][1]), 0)]
    for radius, y in rings:
        for i in range(sides):
            phi = 2 * math.pi * i / sides
            vertices.append((round(radius * math.cos(phi)), round(y), round(-radius * math.sin(phi))))
    vertices.append((0, round(profile[-1][1]), 0))
    top = len(vertices) - 1
    triangles = []
    for i in range(sides):
        j = (i + 1) % sides
        triangles.append((0, 1 + j, 1 + i))
        for k in range(len(rings) - 1):
            a, b = 1 + sides * k + i, 1 + sides * k + j
            triangles += [(a, b, b + sides), (a, b + sides, a + sides)]
        last = 1 + sides * (len(rings) - 1)
        triangles.append((last + i, last + j, top))
    write_mesh(name, vertices, triangles)


def pen(sides=48, rings=180):
    """A ball pen of length 8000: a cone with its ball, a ribbed grip, a barrel, a ring, a button."""
    def radius(y):
        if y < 120:
            return 55 * math.sqrt(max(0.0, 1 - (1 - y / 120) ** 2))
        if y < 1000:
            return 55 + 225 * ((y - 120) / 880) ** 0.8
        if y < 2600:
            return 300 + 20 * math.sin(2 * math.pi * (y - 1000) / 200)
        if y < 6400:
            return 320 + 20 * math.sin(math.pi * (y - 2600) / 3800)
        if y < 6600:
            return 380
        if y < 7300:
            return 320 - 40 * (y - 6600) / 700
        return 130 * math.sqrt(max(0.0, 1 - max(0.0, (y - 7870) / 130) ** 2))
    profile = [(0, 0)]
    # Closer rings at the tip, where the shape changes most.
    for k in range(1, rings + 1):
        y = 8000 * (k / (rings + 1)) ** 1.15
        profile.append((radius(y), y))
    lathe("pen", sides, profile + [(0, 8000)])


def column(sides=48):
    """A column of height 3000 with a base and a capital, 25 rings."""
    profile = [(0, 0), (300, 0), (300, 140), (270, 150), (285, 180), (290, 210), (280, 240), (250, 260), (235, 275)]
    profile += [(230 - 30 * (k / 8) ** 1.5, 300 + 290 * k) for k in range(9)]
    profile += [(225, 2635), (232, 2655), (225, 2675), (205, 2690), (235, 2760), (275, 2820), (300, 2840), (300, 3000)]
    lathe("column", sides, profile + [(0, 3000)])


def shade(sides=32):
    """A lamp shade over the origin, closed: a light in it shines down a cone of half-angle 25 degrees. Unit 1 mm."""
    slope = math.tan(math.radians(25))
    # Outside from the top down to the rim, inside back up: the lathe wants it from the bottom, so it starts inside. The
    # wall is in steps of 2 cm beside the light: what is computed at vertices is linear between them.
    inside = [(60 + (600 * slope - 60) * k / 36, 120 - 20 * k) for k in range(37)]
    profile = [(0, 120)] + inside + [(600 * slope + 30, -600), (100, 160), (0, 160)]
    lathe("shade", sides, profile)


def floor(cells=32):
    """A floor of cells x cells squares, 75 wide and 20 thick, closed, about the middle of its upper side. Unit 1 cm."""
    vertices, triangles = [], []
    for y in (0, -20):
        vertices += [(75 * i - 75 * cells // 2, y, 75 * k - 75 * cells // 2) for k in range(cells + 1) for i in range(cells + 1)]
    side, below = cells + 1, (cells + 1) ** 2
    for k in range(cells):
        for i in range(cells):
            a = side * k + i
            triangles += [(a, a + side, a + side + 1), (a, a + side + 1, a + 1)]
            b = a + below
            triangles += [(b, b + side + 1, b + side), (b, b + 1, b + side + 1)]
    last = side * cells
    for i in range(cells):
        for a, b in ((i + 1, i), (last + i, last + i + 1), (side * i, side * (i + 1)), (side * (i + 1) + cells, side * i + cells)):
            triangles += [(a, a + below, b + below), (a, b + below, b)]
    write_mesh("floor", vertices, triangles)


def cube(cuts=35):
    """A cube of side `cuts`, every face in cuts x cuts squares of two triangles."""
    index, vertices, triangles = {}, [], []

    def vertex(p):
        if p not in index:
            index[p] = len(vertices)
            vertices.append(p)
        return index[p]

    for axis in range(3):
        for side in (0, cuts):
            def corner(u, v):
                p = [0, 0, 0]
                p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, u, v
                return vertex(tuple(p))
            for u in range(cuts):
                for v in range(cuts):
                    a, b, c, d = corner(u, v), corner(u + 1, v), corner(u + 1, v + 1), corner(u, v + 1)
                    triangles += [(a, b, c), (a, c, d)] if side else [(a, c, b), (a, d, c)]
    write_mesh("cube", vertices, triangles)


def number(x):
    return f"{x:.6g}"


def vector(v):
    return "[" + ", ".join(number(x) for x in v) + "]"


LAMBERT = '{{ type = "lambert", albedo = {} }}'


def surface(name, kind, keys, albedo):
    lines = [f'name = "{name}"', f'type = "{kind}"'] + [f"{key} = {value}" for key, value in keys.items()]
    return "\n[[surface]]\n" + "\n".join(lines) + f"\nmaterial = {LAMBERT.format(albedo)}\n"


def box(name, lo, hi, albedo):
    return surface(name, "box", {"lo": vector(lo), "hi": vector(hi)}, albedo)


def write_scene(name, about, camera, target, fov, light, media, surfaces, film=(800, 600)):
    (FOLDER / f"{name}.toml").write_text(f"""# {about}
# Written by make_scenes.py.
name = "shadow_planes/{name}"

[film]
width = {film[0]}
height = {film[1]}

[camera]
position = {vector(camera)}
look_at = {vector(target)}
vertical_fov = {number(fov)}

[[light]]
{light}
radius = 0.005
{media}{''.join(surfaces)}""")


def point(position, intensity):
    return f'type = "point"\nposition = {vector(position)}\nintensity = {vector(intensity)}'


def fog(sigma_t, more=""):
    return f'\n[[medium]]\ntype = "homogeneous"\nsigma_t = {number(sigma_t)}\n{more}'


def figure_7():
    camera, target = (0, 0.5, 9), (0, 0.2, 0)
    ball = surface("ball", "displaced_sphere", {"radius": 1, "size": "[32, 17]"}, 0.6)
    floor = box("floor", (-12, -3.2, -12), (12, -3, 12), 0.4)
    spot = ('type = "spot"\nposition = [0, 3, 0]\naxis = [0, -1, 0]\ninner_angle = 0.43\nouter_angle = 0.436332\n'
            "intensity = 60")
    write_scene("fig7", "After Figure 7 of Biri et al. 2006: a ball of 32 meridians under a spot, so 32 edges in its silhouette.",
                camera, target, 0.8, spot, fog(0.12), [ball, floor])
    fine_floor = surface("floor", "mesh", {"file": '"floor.off"', "transform": "{ scale = 0.01, translation = [0, -3, 0] }"}, 0.4)
    lamp = surface("shade", "mesh", {"file": '"shade.off"', "transform": "{ scale = 0.001, translation = [0, 3, 0] }"}, 0.5)
    write_scene("fig7_shade", "Figure 7 with a point light in a shade as its spot, as in the paper.", camera, target, 0.8,
                point((0, 3, 0), (60, 60, 60)), fog(0.12), [ball, fine_floor, lamp])


def figure_8a():
    pens = []
    for name, angle, at, albedo in (("left pen", -0.62, (-1.35, -1.05, 0.25), "[0.7, 0.2, 0.15]"),
                                    ("right pen", 0.55, (1.3, -1.1, -0.05), "[0.15, 0.3, 0.7]")):
        turn = f"{{ rotation = {{ axis = [0, 0, 1], angle = {number(angle)} }}, scale = 0.0005, translation = {vector(at)} }}"
        pens.append(surface(name, "mesh", {"file": '"pen.off"', "transform": turn}, albedo))
    floor = surface("floor", "plane", {"point": "[0, -1.5, 0]"}, 0.4)
    write_scene("fig8a", "After Figure 8a of Biri et al. 2006: two pens in front of a light, 34,560 triangles.",
                (3.2, 2.6, 5.2), (0.4, 0, 0.6), 0.8, point((0, 0.55, -0.45), (14, 13, 11)), fog(0.25), pens + [floor])


def figure_8b():
    media = ""
    for name, sigma_t, centre, radius in (("red", (2, 0.1, 0.1), (-0.75, -0.05, 0.2), 0.8),
                                          ("green", (0.1, 2, 0.1), (0.35, 0.3, -1.4), 0.9),
                                          ("blue", (0.1, 0.1, 2), (0.95, -0.25, 0.5), 0.75)):
        media += (f'\n[[medium]]\nname = "{name}"\ntype = "homogeneous"\nsigma_t = {vector(sigma_t)}\n'
                  f'region = {{ type = "sphere", center = {vector(centre)}, radius = {radius} }}\n')
    turn = "{ rotation = { axis = [1, 2, 0.5], angle = 0.7 }, scale = 0.016, translation = [-0.3, -0.1, 1.75] }"
    shapes = [surface("box", "mesh", {"file": '"cube.off"', "transform": turn}, 0.3),
              surface("floor", "plane", {"point": "[0, -1.3, 0]"}, 0.1)]
    write_scene("fig8b", "After Figure 8b of Biri et al. 2006: a box of 14,700 triangles before red, green and blue media.",
                (0, 0.5, 6.5), (0.1, 0, 0), 0.55, point((0.9, 1, 3.4), (30, 30, 30)), media, shapes)


def figure_8c():
    shapes = [surface("floor", "plane", {"point": "[0, 0, 0]"}, 0.5)]
    for i in range(12):
        for k in range(11):
            x, z = 0.8 * (i - 5.5), 0.8 * (k - 5)
            shapes.append(surface(f"column {i} {k}", "tube",
                                  {"path": f"[{vector((x, 0, z))}, {vector((x, 1.1, z))}]", "radius": 0.11,
                                   "end_radius": 0.09, "size": "[5, 16]"}, 0.6))
    write_scene("fig8c", "After Figure 8c of Biri et al. 2006: 132 columns, 20,592 triangles; the light moves and changes its colour.",
                (2.5, 4.2, 7.5), (0.2, 0.2, 0.4), 0.75, point((1.2, 0.85, 0.4), (12, 8, 5)), fog(0.25), shapes)


def figure_1():
    shapes = []
    for i in range(20):
        for side in (-1, 1):
            at = (2.4 * side, 0, -2 * i)
            shapes.append(surface(f"column {i} {'left' if side < 0 else 'right'}", "mesh",
                                  {"file": '"column.off"', "transform": f"{{ scale = 0.001, translation = {vector(at)} }}"}, 0.6))
    for i in range(19):
        for side in (-1, 1):
            path = [(2.4 * side, 2.95 + 1.0 * math.sin(math.pi * k / 8), -2 * i - 1 + 1.0 * math.cos(math.pi * k / 8))
                    for k in range(9)]
            lines = ",\n  ".join(", ".join(vector(p) for p in path[k:k + 3]) for k in (0, 3, 6))
            shapes.append(surface(f"arch {i} {'left' if side < 0 else 'right'}", "tube",
                                  {"path": f"[\n  {lines}\n]", "radius": 0.17, "size": "[12, 12]"}, 0.6))
    boxes = [("floor", (-6, -0.3, -44), (6, 0, 8), 0.45), ("left wall", (-5.3, -0.1, -43), (-5, 6.1, 7), 0.5),
             ("right wall", (5, -0.1, -43), (5.3, 6.1, 7), 0.5), ("far wall", (-5.2, -0.1, -42), (5.2, 6.1, -41.7), 0.5),
             ("near wall", (-5.2, -0.1, 6), (5.2, 6.1, 6.3), 0.5), ("roof", (-5.4, 6, -43), (5.4, 6.3, 7), 0.5),
             ("left spandrel", (-2.55, 4.05, -39.2), (-2.25, 5.5, 1.2), 0.6),
             ("right spandrel", (2.25, 4.05, -39.2), (2.55, 5.5, 1.2), 0.6)]
    boxes += [(f"beam {i}", (-4.95, 5.3, -2 * i - 0.1), (4.95, 5.55, -2 * i + 0.1), "[0.4, 0.3, 0.2]") for i in range(20)]
    for i in range(8):
        for side in (-1, 1):
            low, high = sorted((0.7 * side, 1.8 * side))
            z = -4 - 1.5 * i
            boxes.append((f"pew {i} {'left' if side < 0 else 'right'}", (low, 0.001, z - 0.25), (high, 0.45, z + 0.25),
                          "[0.4, 0.25, 0.15]"))
    shapes += [box(*b) for b in boxes]
    shapes.append(surface("font", "tube", {"path": "[[0, 0.001, -1.8], [0, 0.9, -1.8]]", "radius": 0.16, "end_radius": 0.3,
                                           "size": "[9, 11]"}, 0.6))
    write_scene("fig1", "After Figure 1 of Biri et al. 2006: a nave with columns and arches, 107,514 triangles; the light flies along it.",
                (-4.2, 2.1, 0.6), (-1.2, 2, -8), 0.95, point((0.3, 2.4, -13), (60, 54, 45)), fog(0.1), shapes)


def layers():
    """A real mesh with the light close to it: shadows in shadows."""
    for name, light, camera, scale in (("elephant", (-0.3, 0.3, -0.35), (1.3, 0.5, 2), 1), ("knot1", (0, 0.1, -0.75), (0.9, 0.7, 2), 1)):
        mesh = surface(name, "mesh", {"file": f'"../../data/{name}.off"', "transform": f"{{ scale = {scale} }}"}, 0.5)
        floor = surface("floor", "plane", {"point": "[0, -1, 0]"}, 0.4)
        write_scene(f"layers_{name}", f"Shadows in shadows: {name}.off, which folds before a light close to it.", camera, (0, 0, 0),
                    0.6, point(light, (3, 2.7, 2.2)), fog(0.5), [mesh, floor], (320, 240))


def edges():
    """A field of boxes of 10 m; experiments set their number, and with it that of silhouette edges."""
    field = surface("boxes", "city", {"boxes": 16, "columns": 4, "lot": 2.5, "street": 0, "heights": "[0.2, 2]",
                                      "seed": 3, "origin": "[-5, 0, -5]"}, 0.5)
    write_scene("edges", "A field of boxes: cost against the number of silhouette edges.", (0, 6, 12), (0, 0, 0), 0.8,
                point((1, 3.5, -1), (60, 60, 60)), fog(0.08), [field], (320, 240))


pen()
column()
shade()
floor()
cube()
figure_7()
figure_8a()
figure_8b()
figure_8c()
figure_1()
layers()
edges()
