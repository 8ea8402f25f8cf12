#!/usr/bin/env python3
"""Writes synthetic_satin.brdf: an isotropic reflectance that no one measured, for the material type "tabulated".

A coloured matte part, a broad gloss by the angle between half vector and normal, and some light sent back where it came
from: what neither Lambert nor Phong has. Symmetric in its two directions, and every albedo is below 1. Running it again
changes nothing.
"""

import math
from pathlib import Path

THETAS, PHIS = 16, 19  # every 6 and every 10 degrees


def direction(theta, phi):
    return (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))


def reflectance(theta_in, theta_out, delta_phi):
    a, b = direction(theta_in, 0), direction(theta_out, delta_phi)
    half = [x + y for x, y in zip(a, b)]
    length = math.sqrt(sum(x * x for x in half))
    tilt = math.acos(min(1, half[2] / length)) if length > 1e-12 else math.pi / 2
    apart = math.acos(max(-1, min(1, sum(x * y for x, y in zip(a, b)))))
    gloss = 0.22 * math.exp(-(tilt / 0.4) ** 2)
    back = 0.10 * math.exp(-(apart / 0.6) ** 2)
    return [matte / math.pi + gloss + back for matte in (0.45, 0.25, 0.12)]


lines = ["# Synthetic: made by make_synthetic_brdf.py, not measured.", f"{THETAS} {PHIS}"]
for i in range(THETAS):
    for j in range(THETAS):
        for k in range(PHIS):
            angles = (math.pi / 2 * i / (THETAS - 1), math.pi / 2 * j / (THETAS - 1), math.pi * k / (PHIS - 1))
            lines.append(" ".join(f"{v:.6g}" for v in reflectance(*angles)))
(Path(__file__).parent / "synthetic_satin.brdf").write_text("\n".join(lines) + "\n")
