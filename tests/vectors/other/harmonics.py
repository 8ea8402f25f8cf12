"""Real spherical harmonics with the Condon-Shortley phase, index l (l + 1) + m, from the derivatives of Legendre polynomials; Gauss product
quadrature over the sphere."""
from math import factorial, pi

import numpy as np
from numpy.polynomial import legendre


def basis(order, w):
    """An array of order^2 rows, for directions w in the columns of a 3 x n array."""
    x, y, z = np.asarray(w, float).reshape(3, -1)
    rows = []
    for band in range(order):
        for m in range(-band, band + 1):
            k = abs(m)
            slope = legendre.legval(z, legendre.legder([0] * band + [1], k))
            # (1 - z^2)^(k/2) e^(i k phi) is (x + i y)^k.
            turned = (-1)**k * (x + 1j * y)**k
            size = np.sqrt((2 * band + 1) / (4 * pi) * factorial(band - k) / factorial(band + k) * (2 if m else 1))
            rows.append(size * slope * (turned.imag if m < 0 else turned.real))
    return np.array(rows)


def sphere(levels, azimuths=None):
    """Directions (3 x n) and weights, which sum to 4 pi."""
    azimuths = azimuths or 2 * levels
    z, weight = np.polynomial.legendre.leggauss(levels)
    phi = 2 * pi * (np.arange(azimuths) + 0.5) / azimuths
    s = np.sqrt(1 - z * z)
    w = np.array([np.outer(s, np.cos(phi)).ravel(), np.outer(s, np.sin(phi)).ravel(), np.repeat(z, azimuths)])
    return w, np.repeat(weight, azimuths) * 2 * pi / azimuths


def about_axis(zonal, axis):
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    y = basis(len(zonal), axis)[:, 0]
    return np.concatenate([np.sqrt(4 * pi / (2 * b + 1)) * c * y[b * b:(b + 1)**2] for b, c in enumerate(zonal)])
