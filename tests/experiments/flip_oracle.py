"""Values of HDR-FLIP by its authors' own program, for tests/experiments/flip_test.cpp.

Needs the package flip-evaluator (1.7 was used). The pictures are made by whole numbers, so that both languages make the same ones.
"""
import flip_evaluator
import numpy as np

WIDTH, HEIGHT = 48, 36


def pictures(kind):
    y, x, c = np.mgrid[0:HEIGHT, 0:WIDTH, 0:3]
    smooth = (2 * x + 3 * y + 20 * c + 10) / np.float32(200)
    rough = ((37 * x + 101 * y + 59 * c + 7 * x * y) % 97) / np.float32(97)
    bump = ((13 * x + 29 * y + 17 * c) % 11 - 5) / np.float32(5)
    inside = (x >= 16) & (x < 30) & (y >= 8) & (y < 22)
    if kind == "brighter":
        return smooth * np.float32(1.2), smooth
    if kind == "noise":
        return smooth * (1 + np.float32(0.25) * bump), smooth
    if kind == "edge":
        return np.where(inside, smooth * np.float32(0.5), smooth), smooth
    if kind == "rough":
        return rough * rough * rough * (1 + np.float32(0.1) * bump), rough * rough * rough
    if kind == "range":
        wide = np.where(inside, np.float32(60), np.float32(1)) * smooth
        return wide * (1 + np.float32(0.05) * bump), wide
    if kind == "colour":
        tint = np.where(c == 2, np.float32(0.7), np.float32(1))
        return smooth * tint, smooth
    if kind == "partly black":
        dark = np.where(y < 12, np.float32(0), smooth)
        return np.where(inside, dark + np.float32(0.1), dark), dark
    raise ValueError(kind)


for kind in ("brighter", "noise", "edge", "rough", "range", "colour", "partly black"):
    image, reference = (p.astype(np.float32) for p in pictures(kind))
    found, mean, used = flip_evaluator.evaluate(reference, image, "HDR", applyMagma=False)
    print(f'      {{"{kind}", {mean:.7f}, {found.max():.7f}, {used["startExposure"]:.6f}, {used["stopExposure"]:.6f}, {used["numExposures"]}}},')
