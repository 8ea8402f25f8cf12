"""Transport by quadrature and by adding layers, orders of scattering by powers of the albedo. Fields, sampling, statistics and fluids
by their definitions. What is measured by Monte Carlo is made wrong by 45 of the standard errors that its kind aims at."""
import itertools
from math import cos, exp, log, log10, pi, sin, sqrt

import mpmath
import numpy as np
from mpmath import mp, mpf, quad
from numpy.polynomial import legendre
from scipy import stats
from scipy.special import comb, exp1, gammaincc

import fogshop
from common import File
from compensated_ray_marching import H
from slab import Slab

file = File('references', part='references')


def add(kind, inputs, expected, accuracy, wrong):
    file.add(kind, {'input': inputs, 'expected': expected, 'accuracy': accuracy}, wrong)


def number(value, path):
    for key in path.split('/')[1:]:
        value = value[int(key)] if isinstance(value, list) else value[key]
    return float(value)


def of(expected, tolerance, *paths):
    return {'/expected' + p: 10 * tolerance * abs(number(expected, p)) for p in paths}


def phase(name, g, c):
    """Normalised: the integral over the sphere is 1."""
    return {
        'isotropic': lambda: 1, 'hg': lambda: (1 - g * g) / (1 + g * g - 2 * g * c)**1.5, 'rayleigh': lambda: 0.75 *
        (1 + c * c), 'hazy': lambda: (1 + 9 * ((1 + c) / 2)**8) / 2, 'murky': lambda: (1 + 50 * ((1 + c) / 2)**32) * 33 / 83
    }[name]() / (4 * mp.pi)


def moments(name, g, count):
    x, w = legendre.leggauss(120)
    p = np.array([float(phase(name, g, c)) for c in x]) * 2 * pi
    return [float(w * p @ legendre.legval(x, [0] * l + [1])) for l in range(count)]


# Shapes: distances at which a ray goes in and out.
def ball(radius):
    def cut(o, r):
        m = -fogshop.dot(o, r)
        half = mpmath.sqrt(max(0, radius**2 - fogshop.dot(o, o) + m * m))
        return m - half, m + half

    return cut


def box(lo, hi):
    def cut(o, r):
        ends = [sorted(((a - x) / y, (b - x) / y)) for a, b, x, y in zip(lo, hi, o, r) if y != 0]
        return max(e[0] for e in ends), min(e[1] for e in ends)

    return cut


def along_ray(shape, sigma, albedo, name, g, o, d, arriving):
    """Order one; `arriving` gives at a point the direction to the light and its irradiance, without the medium."""
    size = fogshop.norm([mpf(x) for x in d])
    r = [mpf(x) / size for x in d]
    o = [mpf(x) for x in o]
    begin, end = shape(o, r)
    begin = max(begin, 0)

    def term(t):
        x = fogshop.along(o, r, t)
        way, light, far = arriving(x)
        inside = min(shape(x, way)[1], far)
        return phase(name, mpf(g), fogshop.dot(way, r)) * light * mpmath.exp(-sigma * (t - begin + inside))

    return sigma * albedo * quad(term, np.linspace(float(begin), float(end), 7).tolist())


def point(position, intensity):
    def arriving(x):
        way = fogshop.away(x, position)
        far = fogshop.norm(way)
        return [w / far for w in way], intensity / far**2, far

    return arriving


def single_scattering():
    o, d = [0.375, -0.25, -4.0], [0.125, 0.25, 3.0]
    for shape, cut, sigma, albedo, name, g, light in (({'type': 'sphere', 'R': 1.5}, ball(mpf('1.5')), 0.75, 0.85, 'hg', 0.45,
                                                       ([2.5, 1.0, 0.5], 3.0)), ({'type': 'sphere',
                                                                                  'R': 1.5}, ball(mpf('1.5')), 2.25, 0.6, 'hazy', 0, None),
                                                      ({'type': 'box', 'lo': [-1.0, -0.75, -0.5], 'hi': [1.25, 1.0, 1.5]},
                                                       box([-1, -0.75, -0.5], [1.25, 1, 1.5]), 1.5, 0.9, 'rayleigh', 0, ([0.25, 0.25,
                                                                                                                          0.5], 2.0))):
        if light:
            tell, arriving = {'type': 'point', 'pos': light[0], 'I': light[1]}, point(light[0], light[1])
        else:
            to = [mpf(2) / 3, mpf(1) / 3, mpf(-2) / 3]
            tell, arriving = {'type': 'directional', 'to_light': [2, 1, -2], 'E': 4.0}, lambda x: (to, 4, mp.inf)
        expected = {'L1': float(along_ray(cut, sigma, albedo, name, g, o, d, arriving))}
        add('single_scattering_' + shape['type'],
            {'shape': shape, 'sigma_t': sigma, 'albedo': albedo, 'phase': {'name': name, 'g': g}, 'light': tell, 'o': o, 'd': d}, expected,
            {'rel': 1e-10}, of(expected, 1e-10, '/L1'))
    fog = [[0.75, 1.25, [0.25, 0.5, 3.0]], [1.5, 0.8, [-0.5, 0.0, 5.0]]]
    medium = {'gaussians': [{'c': c, 'a': a, 'b': b} for c, a, b in fog], 'beta0': 0.03125}
    eye, lights = [mpf('0.25'), mpf('-0.125'), mpf(0)], [([1.5, 2.0, 4.0], 5.0), ([-2.0, -1.0, 2.0], 3.0)]
    rays = []
    for p in ([0.5, 0.75, 7.0], [-1.0, 0.25, 6.0]):
        length = fogshop.norm(fogshop.away(eye, p))
        r = [x / length for x in fogshop.away(eye, p)]

        def term(t):
            x = fogshop.along(eye, r, t)
            total = 0
            for position, intensity in lights:
                way = fogshop.away(x, position)
                far = fogshop.norm(way)
                total += intensity / far**2 * phase('hg', mpf('0.3'),
                                                    fogshop.dot(way, r) / far) * mpmath.exp(-fogshop.depth(medium, x, position))
            return total * fogshop.density(medium, x) * mpmath.exp(-fogshop.depth(medium, eye, x))

        rays.append({
            'p': p, 'L1': float(0.75 * quad(term, [mpf('1e-20')] + [length * i / 8 for i in range(1, 9)])),
            'T': float(fogshop.depth(medium, eye, p))
        })
    add(
        'single_scattering_gaussians', {
            'gaussians': fog, 'b0': 0.03125, 'albedo': 0.75, 'phase': {'name': 'hg', 'g': 0.3},
            'lights': [{'type': 'point', 'pos': p, 'I': i} for p, i in lights], 'eye': [0.25, -0.125, 0.0]
        }, {'rays': rays}, {'rel': 1e-9}, of({'rays': rays}, 1e-9, '/rays/0/L1', '/rays/1/L1', '/rays/0/T'))
    # Under an even sky: for every point of the ray the phase function over the sphere times what is left of each direction.
    sigma, albedo, g, radius = 1.25, 0.8, 0.4, 1.5
    node, weight = legendre.leggauss(40)
    origin, way = np.array([0.5, 0.25, -4.0]), np.array([0.0, 0.0, 1.0])
    half = sqrt(radius**2 - 0.25 - 0.0625)
    phi = 2 * pi * (np.arange(80) + 0.5) / 80
    total = 0
    for t, w in zip(half * node, half * weight):
        x = np.array([0.5, 0.25, t])
        s = np.sqrt(1 - node**2)[:, None]
        toward = np.stack([s * np.cos(phi), s * np.sin(phi), node[:, None] + 0 * phi], -1)
        m = toward @ x
        out = -m + np.sqrt(radius**2 - x @ x + m * m)
        p = (1 - g * g) / (1 + g * g - 2 * g * node[:, None])**1.5 / (4 * pi)
        total += w * sigma * albedo * exp(-sigma * (t + half)) * (weight[:, None] * 2 * pi / 80 * p * np.exp(-sigma * out)).sum()
    add(
        'single_scattering_environment', {
            'kind': 'sphere', 'R': radius, 'sigma_t': sigma, 'albedo': albedo, 'phase': {'name': 'hg', 'g': g}, 'o': origin.tolist(),
            'd': way.tolist()
        }, {'L1': total}, {'abs': 1e-10}, {'/expected/L1': 0.05})


def slabs():
    """Shares of beams at the cosines 1, 0.5 and 0.1, and of even light."""
    def row(name, g, albedo, tau):
        s = Slab(moments(name, g, 50), albedo, [1.0, 0.5, 0.1])
        up, down = s.inside(0, tau, 1, 0)[1], s.inside(tau, 0, 1, 0)[0]
        numbers = [v for i in (-3, -2, -1) for v in (up[i], down[i])]
        return numbers + [s.flux(up) / pi, s.flux(down) / pi]

    columns = ['phase', 'g', 'albedo', 'tau', 'R_mu1', 'T_mu1', 'R_mu0.5', 'T_mu0.5', 'R_mu0.1', 'T_mu0.1', 'R_diffuse', 'T_diffuse']
    rows = [['hg', 0.3, 0.8, 0.75], ['rayleigh', 0.0, 0.65, 1.5], ['hazy', 0.0, 0.9, 0.4]]
    rows = [r + row(*r) for r in rows]
    # The quick profile takes two rows of few: all rows move, so one of them is seen.
    add('slab_table', {'columns': columns}, {'rows': rows}, {'abs': 1e-8}, {'/expected/rows/0/4': 0.0125})
    name, g, albedo, tau = 'hg', -0.4, 0.7, 1.2
    n = row(name, g, albedo, tau)
    expected = {
        'R': n[0], 'T_total': n[1], 'R_diffuse': n[6], 'T_diffuse_total': n[7], 'published_R': round(n[0], 5),
        'published_T': round(n[1], 5)
    }
    add('slab_point', {'phase': name, 'g': g, 'albedo': albedo, 'tau': tau}, expected, {'abs': 1e-8},
        {f'/expected/{k}': 0.0125 for k in expected})
    cosines = [0.9, 0.4]
    layer = Slab(moments('hg', 0.25, 40), 0.85, [1.0] + cosines, light=1e-9).beam(1.1)
    expected = {
        'L_reflected': {str(m): float(layer[0][i - 2]) for i, m in enumerate(cosines)},
        'L_transmitted': {str(m): float(layer[1][i - 2]) for i, m in enumerate(cosines)}
    }
    add('slab_exit_radiance', {'phase': 'hg', 'g': 0.25, 'albedo': 0.85, 'tau': 1.1}, expected, {'abs': 1e-7},
        {f'/expected/{k}/{m}': 0.5 * v for k, e in expected.items() for m, v in e.items()})
    # Orders: values for albedos on a circle are a polynomial whose coefficients a Fourier transform gives.
    count, size, albedo, tau = 32, 0.9, 0.8, 0.85
    circle = [beam_flux(size * np.exp(2j * pi * k / count), tau) for k in range(count)]
    orders = np.fft.fft(np.array(circle), axis=0) / count
    r, t = [[float((orders[m, i] / size**m * albedo**m).real) for m in range(1, 5)] for i in (0, 1)]
    add('slab_orders', {'tau': tau, 'albedo': albedo}, {'R_order': r, 'T_order': t}, {'abs': 1e-8},
        {'/expected/R_order/0': 0.03, '/expected/T_order/1': 0.03})
    at = lambda w: {str(m): float(H(mpf(w), mpf(m))) for m in (0.5, 1.0)}
    h = {'0.6': at('0.6'), '0.85': at('0.85')}
    expected = {
        'H': h, 'albedo_mu1': {w: 1 - e['1.0'] * sqrt(1 - float(w)) for w, e in h.items()},
        'albedo_mu0.5': {w: 1 - e['0.5'] * sqrt(1 - float(w)) for w, e in h.items()}
    }
    add('halfspace', {'phase': 'isotropic'}, expected, {'abs': 1e-9}, {'/expected/H/0.6/0.5': 0.05, '/expected/albedo_mu1/0.85': 0.02})


def beam_flux(albedo, tau):
    s = Slab([1.0], albedo, [1.0], light=1e-9)
    return np.array([2 * pi * (s.weight * s.mu)[:-1] @ side[:-1] for side in s.beam(tau)])


def path(radius, r, mu, node, weight, sigma=1.0):
    """Rule along a path in a homogeneous ball, backwards from a point at r, mu the cosine to the radius: radii, shares, transmittance."""
    length = r * mu + np.sqrt(np.maximum(0, radius**2 - r * r * (1 - mu * mu)))
    s = length * (node + 1) / 2
    return np.sqrt(r * r * (1 - mu * mu) + (r * mu - s)**2), sigma * np.exp(-sigma * s) * weight * length / 2, exp(-sigma * length)


class Ball:
    """Isotropic scattering under an even sky of 1: order by order, the mean radiance at radii as a polynomial of r^2, by collocation."""
    def __init__(self, radius, sigma=1.0):
        self.radius, self.sigma = radius, sigma
        self.node, self.weight = legendre.leggauss(64)
        # The mean radiance is steep towards the surface: nodes crowd there, and the polynomial is one in the root of the distance to it.
        self.count = 18
        self.u = (np.cos(pi * (np.arange(self.count) + 0.5) / self.count) + 1) / 2
        self.grid = radius * (1 - self.u**2)
        self.inverse = np.linalg.inv(np.polynomial.chebyshev.chebvander(2 * self.u - 1, self.count - 1))
        # By directions in two halves: light from the near side comes a short way.
        rows = [self.mean(r) for r in self.grid]
        self.K, self.first = np.array([a for a, _ in rows]), np.array([b for _, b in rows])

    def basis(self, r):
        u = np.sqrt(np.maximum(0, 1 - np.asarray(r) / self.radius))
        return np.polynomial.chebyshev.chebvander(2 * u - 1, self.count - 1) @ self.inverse

    def mean(self, r):
        row, left = np.zeros(self.count), 0
        for lo, hi in ((-1, -0.3), (-0.3, 0), (0, 0.3), (0.3, 1)):
            for x, w in zip(self.node, self.weight):
                radii, share, clear = path(self.radius, r, lo + (hi - lo) * (x + 1) / 2, self.node, self.weight, self.sigma)
                row += w * (hi - lo) / 4 * share @ self.basis(radii)
                left += w * (hi - lo) / 4 * clear
        return row, left

    def chord(self, b):
        # The way from the surface; halves, for the middle is the deepest.
        radii, share, left = path(self.radius, self.radius, sqrt(1 - (b / self.radius)**2), self.node, self.weight, self.sigma)
        return share @ self.basis(radii), left


def spheres():
    radius, albedo = 1.25, 0.7
    ball_ = Ball(radius)
    J = np.linalg.solve(np.eye(ball_.count) - albedo * ball_.K, ball_.first)
    chords = {b: ball_.chord(float(b) * radius) for b in ('0.25', '0.75')}
    row, left = ball_.mean(0.0)
    half, _ = ball_.chord(0.5 * radius)
    orders, source = [], ball_.first
    for _ in range(3):
        orders.append(float(albedo * half @ source))
        source = albedo * ball_.K @ source
    expected = {
        'J_centre': float(albedo * row @ J + left), 'L': {b: float(albedo * c @ J + clear) for b, (c, clear) in chords.items()},
        'orders_b0.5': orders
    }
    add('sphere_environment_all_orders', {'optical_radius': radius, 'albedo': albedo}, expected, {'abs': 1e-6},
        {'/expected/J_centre': 0.05, '/expected/L/0.75': 0.05, '/expected/orders_b0.5/1': 0.05})
    # Orders along a ray, and the number of collisions of a path that ends with probability 1 - albedo at each collision: n = K (1 +
    # albedo n) from a point.
    R, sigma, albedo, b = 1.5, 0.8, 0.9, 0.6
    ball_ = Ball(R, sigma)
    share, clear = ball_.chord(b)
    numbers, source = {'o0': [clear, 1e-9]}, ball_.first
    for m in range(1, 5):
        numbers[f'o{m}'] = [float(albedo * share @ source), 1e-9]
        source = albedo * ball_.K @ source
    J = np.linalg.solve(np.eye(ball_.count) - albedo * ball_.K, ball_.first)
    numbers['all'] = [float(albedo * share @ J + clear), 1e-9]
    further = np.linalg.solve(np.eye(ball_.count) - albedo * ball_.K, ball_.K @ np.ones(ball_.count))
    numbers |= {'mean_collisions_analog': float(share @ (1 + albedo * further)), 'histories': 1e12}
    add(
        'multiple_scattering_monte_carlo', {
            'shape': 'sphere', 'R': R, 'sigma_t': sigma, 'albedo': albedo, 'g': 0.0, 'light': 'environment L=1', 'o': [b, 0.0, -4.0],
            'd': [0.0, 0.0, 1.0]
        }, numbers, {'stderr': 'second entry'},
        {'/expected/o1/0': 0.03, '/expected/o3/0': 0.03, '/expected/all/0': 0.03, '/expected/mean_collisions_analog': 0.1})


def identities():
    add('identity', {}, {'L': 1.0}, {'exact': True}, {'/expected/L': 0.1})
    add('identity', {'sphere_optical_radius': 1.5}, {'mean_collisions': 2.0, 'slab_per_unit_tau': 2.0, 'cube_per_unit_optical_edge': 2 / 3},
        {'exact': True},
        {'/expected/mean_collisions': 0.2, '/expected/slab_per_unit_tau': 0.2, '/expected/cube_per_unit_optical_edge': 0.1})
    add('identity', {}, {'difference': 0.0}, {'exact': True}, {'/expected/difference': 0.1})
    thin = along_ray(ball(mpf(1)), mpf('1e-4'), 1, 'isotropic', 0, [0.5, 0, -3], [0, 0, 1], point([2, 0, 0],
                                                                                                  1)) / (mpf('1e-4') * mpmath.sqrt(3))
    reflected = 1 - H(mpf('0.9'), 1) * mpmath.sqrt(mpf('0.1'))
    add('identity', {},
        {'sphere_thin_L1_over_chord_tau': float(thin), 'R_mu1_iso_0.9_tau20': float(reflected), 'R_mu1_iso_0.9_inf': float(reflected)},
        {'abs': 1e-8}, {'/expected/sphere_thin_L1_over_chord_tau': 1e-7, '/expected/R_mu1_iso_0.9_inf': 0.0125})


def fields():
    p, q = np.array([-1.5, 0.25, 4.5]), np.array([6.0, 3.5, -0.5])
    n, seed = 5, 4
    node, weight = legendre.leggauss(24)

    def line(f, p, q, axes=(0, 1, 2)):
        """Between the planes of whole numbers f is a polynomial, or one times an exponential."""
        breaks = {0.0, 1.0}
        for a in axes:
            breaks |= {(k - p[a]) / (q[a] - p[a]) for k in range(-12, 13) if 0 < (k - p[a]) / (q[a] - p[a]) < 1}
        breaks = sorted(breaks)
        return np.linalg.norm(q - p) * sum((hi - lo) / 2 * w * f(p + (q - p) * (lo + (hi - lo) * (x + 1) / 2))
                                           for lo, hi in zip(breaks, breaks[1:]) for x, w in zip(node, weight))

    def trilinear(x):
        total, base = 0, np.floor(x).astype(int)
        for c in itertools.product((0, 1), repeat=3):
            i, j, k = at = base + c
            if (at >= 0).all() and (at < n).all():
                total += np.prod(1 - abs(x - at)) * ((7 * i + 13 * j + 31 * k + seed) % 11) / 10
        return total

    tau = line(trilinear, p, q)
    add('optical_depth', {'n': n, 'seed': seed, 'p': p.tolist(), 'q': q.tolist()}, {'tau': tau}, {'abs': 1e-12}, {'/expected/tau': 1e-11})

    def spline(degree, u):
        if degree == 0:
            return 1.0 * (0 <= u < 1)
        return (u * spline(degree - 1, u) + (degree + 1 - u) * spline(degree - 1, u - 1)) / degree

    for degree, kappa in ((1, 0.0), (3, 0.35)):

        def fog(x):
            near = [range(max(0, int(np.floor(x[a])) - degree), min(n, int(np.floor(x[a])) + 1)) for a in (0, 2)]
            map_ = sum(
                spline(degree, x[0] - i) * spline(degree, x[2] - j) * ((5 * i + 17 * j + seed) % 13) / 12 for i in near[0] for j in near[1])
            return map_ * exp(-kappa * max(0, x[1]))

        tau = line(fog, p, q)
        add('optical_depth', {'n': n, 'seed': seed, 'degree': degree, 'kappa': kappa, 'p': p.tolist(), 'q': q.tolist()}, {'tau': tau},
            {'abs': 1e-11}, {'/expected/tau': 1e-10})

    def series(n, seed, first):
        F = np.array([[[((7 * i + 13 * j + 31 * k + seed) % 11 - 5) / (10 * (1 + i + j + k)) for k in range(n)] for j in range(n)]
                      for i in range(n)])
        F[0, 0, 0] = first
        size = [sqrt((2 * k + 1) / 2) for k in range(n)]
        return F * np.einsum('i,j,k->ijk', size, size, size)

    F = series(3, 6, 0.25)
    p, q = np.array([-0.9, 0.4, -0.75]), np.array([0.8, -0.6, 0.95])
    # Along the segment: the polynomial of degree 6 through 7 of its values.
    t = np.cos(pi * (np.arange(7) + 0.5) / 7)
    poly = np.polynomial.Polynomial.fit(t, [legendre.legval3d(*(p + (q - p) * (x + 1) / 2), F) for x in t], 6, domain=[-1, 1])
    roots = sorted(r.real for r in poly.roots() if abs(r.imag) < 1e-12 and -1 < r.real < 1)
    length, whole = np.linalg.norm(q - p) / 2, poly.integ()
    pieces = [whole(b) - whole(a) for a, b in zip([-1, *roots], [*roots, 1])]
    expected = {
        'tau_raw': float(length * sum(pieces)), 'tau_clamped': float(length * sum(x for x in pieces if x > 0)), 'sign_changes': len(roots)
    }
    add('optical_depth', {'n': 3, 'seed': 6, 'F000': 0.25, 'p': p.tolist(), 'q': q.tolist()}, expected, {'abs': 1e-11},
        {'/expected/tau_raw': 1e-10, '/expected/tau_clamped': 1e-10, '/expected/sign_changes': 1})
    # The Bernstein coefficients of the same kind of field on a part of the box, and its values at 11^3 points.
    F, lo, hi = series(3, 8, 1.75), np.array([-0.75, 0.0, -0.5]), np.array([0.25, 0.5, 1.0])

    def bernstein(n, a, b):
        """From Legendre coefficients to Bernstein's on [a, b]."""
        x = np.linspace(0, 1, n)
        B = np.array([[comb(n - 1, k) * s**k * (1 - s)**(n - 1 - k) for k in range(n)] for s in x])
        return np.linalg.solve(B, legendre.legvander(a + (b - a) * x, n - 1))

    hull = np.einsum('ai,bj,ck,ijk->abc', *[bernstein(3, a, b) for a, b in zip(lo, hi)], F)
    sampled = legendre.leggrid3d(*[np.linspace(a, b, 11) for a, b in zip(lo, hi)], F)
    expected = {
        'bernstein_min': float(hull.min()), 'bernstein_max': float(hull.max()), 'sampled_min_25^3': float(sampled.min()),
        'sampled_max_25^3': float(sampled.max())
    }
    add('field_bounds', {'n': 3, 'seed': 8, 'F000': 1.75, 'lo': lo.tolist(), 'hi': hi.tolist()}, expected, {'abs': 1e-11},
        {'/expected/bernstein_min': -1e-10, '/expected/bernstein_max': 1e-10, '/expected/sampled_max_25^3': 1e3})
    # A cell of a fogmap: the coefficients that reach it, and the values in it.
    degree, n, seed, cell = 3, 6, 5, [3, 4]
    c = {(i, j): ((5 * i + 17 * j + seed) % 13) / 12 if 0 <= i < n and 0 <= j < n else 0.0 for i in range(cell[0] - degree, cell[0] + 1)
         for j in range(cell[1] - degree, cell[1] + 1)}
    grid = np.linspace(1e-6, 1 - 1e-6, 21)
    inside = [
        sum(v * spline(degree, cell[0] + x - i) * spline(degree, cell[1] + y - j) for (i, j), v in c.items()) for x in grid for y in grid
    ]
    add('field_bounds', {'cell': cell, 'degree': degree, 'n': n, 'seed': seed},
        {'hull': [min(c.values()), max(c.values())], 'sampled': [min(inside), max(inside)]}, {'abs': 1e-11},
        {'/expected/sampled/1': 1.0, '/expected/hull/0': 1.0})
    fog, b0, lo, hi = [[1.5, 1.25, [0.25, 0.5, 2.0]], [0.75, 2.0, [1.0, -0.5, 2.5]]], 0.125, [0.5, 0.0, 1.5], [1.0, 0.25, 2.25]
    ends = [b0, b0]
    for c, a, b in fog:
        near = sum(max(l - x, 0, x - h)**2 for l, h, x in zip(lo, hi, b))
        far = sum(max(abs(l - x), abs(h - x))**2 for l, h, x in zip(lo, hi, b))
        ends[0] += c * exp(-a * a * far)
        ends[1] += c * exp(-a * a * near)
    at = [
        b0 + sum(c * exp(-a * a * sum((x - y)**2 for x, y in zip(p, b))) for c, a, b in fog)
        for p in itertools.product(*[np.linspace(l, h, 9) for l, h in zip(lo, hi)])
    ]
    add('field_bounds', {'gaussians': fog, 'b0': b0, 'lo': lo, 'hi': hi},
        {'lower': ends[0], 'upper': ends[1], 'sampled': [min(at), max(at)]}, {'abs': 1e-11},
        {'/expected/lower': 1e-10, '/expected/upper': 1e-10, '/expected/sampled/1': 10.0})
    table = {}
    for name in ('murky', 'hazy'):
        f = lambda c: phase(name, 0, c)
        K = 4 * mp.pi * f(mpf(-1))
        table[name] = {
            'K': float(K), 'g': float(2 * mp.pi * quad(lambda c: c * f(c), [-1, 0.5, 1])), 'p_fwd': float(f(mpf(1))),
            'p_side': float(f(mpf(0))), 'p_back': float(f(mpf(-1))), 'paper_norm': float(1 / K)
        }
    add('phase_function', {}, table, {'rel': 1e-11},
        of(table, 1e-11, '/hazy/K', '/murky/g', '/murky/p_fwd', '/hazy/p_side', '/hazy/p_back', '/murky/paper_norm'))


def sampling():
    def inverse(cumulative, u):
        return mpmath.findroot(lambda c: cumulative(c) - u, (mpf(-1), mpf(1)), solver='illinois', tol=mpf('1e-40'))

    hg = lambda g: lambda c: (1 - g * g) / (2 * g) * ((1 + g * g - 2 * g * c)**mpf('-0.5') - 1 / (1 + g))
    rows = [[g, u, float(inverse(hg(mpf(g)), mpf(u)))] for g in (-0.75, 0.3, 0.8125) for u in (0.0625, 0.4, 0.875)]
    add('sampling', {'rows': 'g,u,cos'}, {'rows': rows}, {'abs': 1e-14}, {'/expected/rows/0/2': 1e-13, '/expected/rows/7/2': 1e-13})
    rayleigh = lambda c: (c**3 + 3 * c + 4) / 8
    rows = [[u, float(inverse(rayleigh, mpf(u)))] for u in (0.0625, 0.375, 0.9375)]
    add('sampling', {'rows': 'u,cos'}, {'rows': rows}, {'abs': 1e-14}, {'/expected/rows/1/1': 1e-13})
    rows = []
    for a, b, length, t in ((0.5, 2.0, 1.5, 0.75), (2.0, 0.25, 0.5, 0.25), (1.25, 1.25, 3.0, 2.0)):
        depth = lambda s: mpf(a) * s + (mpf(b) - a) * s * s / (2 * length) - t
        rows.append([a, b, length, t, float(mpmath.findroot(depth, (mpf(0), mpf(length)), solver='illinois', tol=mpf('1e-40')))])
    add('sampling', {'rows': 'a,b,l,t,s'}, {'rows': rows}, {'rel': 1e-14},
        {'/expected/rows/0/4': 1e-13 * rows[0][4], '/expected/rows/2/4': 1e-13 * rows[2][4]})
    rows = []
    for D, h, a, b, u in ((1.5, 0.25, 0.5, 4.0, 0.375), (-2.0, 1.5, 0.25, 3.0, 0.75)):
        angle = [mpmath.atan((mpf(t) - D) / h) for t in (a, b)]
        t = D + h * mpmath.tan(angle[0] + u * (angle[1] - angle[0]))
        rows.append([D, h, a, b, u, float(t), float(h / ((angle[1] - angle[0]) * (h * h + (t - D)**2)))])
    add('sampling', {'rows': 'D,h,ta,tb,u,t,pdf'}, {'rows': rows}, {'rel': 1e-12},
        {'/expected/rows/0/5': 1e-11 * rows[0][5], '/expected/rows/1/6': 1e-11 * rows[1][6]})

    def philox(counter, key):
        c, k = list(counter), list(key)
        for _ in range(10):
            a, b = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
            c = [(b >> 32) ^ c[1] ^ k[0], b & 0xffffffff, (a >> 32) ^ c[3] ^ k[1], a & 0xffffffff]
            k = [(k[0] + 0x9E3779B9) & 0xffffffff, (k[1] + 0xBB67AE85) & 0xffffffff]
        return c

    words = lambda list_: [f'{x:08x}' for x in list_]
    rows = [[words(c), words(k), words(philox(c, k))]
            for c, k in (([1, 2, 3, 4], [5, 6]), ([0xdeadbeef, 0x01234567, 0x89abcdef, 0xfeedface], [0xcafebabe, 0x0badf00d]))]
    assert words(philox([0] * 4, [0] * 2)) == ['6627e8d5', 'e169c58d', 'bc57ac4c', '9b00dbd8']
    add('random_numbers', {'rows': 'counter,key,out'}, {'rows': rows}, {'exact': True}, {'/expected/rows/1/2/3': '00000000'})


def statistics():
    A, R, s2, n = [0.5, 1.25, 2.5, 0.75, 1.0], [0.55, 1.2, 2.3, 0.8, 1.05], [4e-4, 1e-4, 9e-4, 2.5e-4, 1e-4], [64, 128, 64, 256, 512]
    d2, v, m, r = (np.array([(a - b)**2 for a, b in zip(A, R)]), *map(np.array, (s2, n, R)))
    mse = np.mean(d2 - v)
    variance = np.sum(4 * d2 * v - 2 * v**2 + 2 * v**2 / (m - 1)) / len(A)**2
    half = stats.norm.isf(0.025) * sqrt(variance)
    expected = {
        'mse_raw': np.mean(d2), 'mse_unbiased': mse, 'var_mse': variance, 'ci95': [mse - half, mse + half], 'rmse': sqrt(mse),
        'rel_l2': sqrt(mse / np.mean(r**2 - v)), 'floor': sqrt(np.mean(v)), 'relmse_eps001': np.mean(
            (d2 - v) / (r**2 + 0.01 * np.mean(r)**2)), 'psnr_peak2': 10 * log10(4 / mse)
    }
    paths = [f'/{k}' for k in expected if k != 'ci95'] + ['/ci95/0', '/ci95/1']
    add('statistics', {'A': A, 'R': R, 's2': s2, 'n': n}, expected, {'rel': 1e-10}, of(expected, 1e-10, *paths))
    z = [0.4, -2.2, 1.7, 0.9, -0.3]
    threshold = lambda m, alpha: stats.norm.isf(-np.expm1(np.log1p(-alpha) / m) / 2)
    largest = 2 * stats.norm.sf(max(map(abs, z)))
    chi2 = sum(x * x for x in z)
    expected = {
        'chi2': chi2, 'p_chi2': gammaincc(2.5, chi2 / 2), 'sidak_1e3': threshold(5, 1e-3), 'bonf_1e3': stats.norm.isf(1e-3 / 10),
        'p_max_sidak': -np.expm1(5 * np.log1p(-largest))
    }
    add('statistics', {'z': z}, expected, {'rel': 1e-8}, of(expected, 1e-8, *[f'/{k}' for k in expected]))
    rows = [[m, alpha, threshold(m, alpha)] for m, alpha in ((7, 0.01), (1000, 1e-4))]
    add('statistics', {'rows': 'm,alpha,threshold'}, {'rows': rows}, {'rel': 1e-9}, of({'rows': rows}, 1e-9, '/rows/0/2', '/rows/1/2'))

    def ranks(n):
        lower = max(k for k in range(1, n) if stats.binom.cdf(k - 1, n, 0.5) <= 0.025)
        return [n, lower, n + 1 - lower]

    x = [3.5, 1.25, 2.0, 8.0, 2.75, 2.5, 4.0, 3.0]
    middle = float(np.median(x))
    mad = float(np.median(abs(np.array(x) - middle)))
    expected = {'rows': [ranks(n) for n in (9, 40, 150)], 'median': middle, 'mad': mad, 'sigma': mad / stats.norm.ppf(0.75)}
    add('statistics', {'rows': 'n,lower,upper', 'x': x}, expected, {'abs': 1e-9},
        {'/expected/rows/1/1': 1, '/expected/rows/2/2': -1, '/expected/median': 1e-8, '/expected/mad': 1e-8, '/expected/sigma': 1e-8})
    points, ref = [[0.5, 0.4], [1.5, 0.1], [0.75, 0.5], [2.0, 0.1], [4.0, 0.02], [3.0, 0.3]], [8.0, 0.6]
    best = sorted(p for p in points if not any(q != p and q[0] <= p[0] and q[1] <= p[1] for q in points))
    area = sum((log(ref[0]) - log(t)) * (log(before) - log(e)) for (t, e), before in zip(best, [ref[1]] + [e for _, e in best]))
    add('statistics', {'points': points, 'ref': ref}, {'front': best, 'hv': area}, {'abs': 1e-10},
        {'/expected/hv': 1e-9, '/expected/front/1/1': 0.5})


def bilinear(f, x, y, wrap):
    """Samples at whole numbers, f[i, j] at (i, j); beyond the edge the last of them, or the first again."""
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b = x - i, y - j
    index = (lambda k, n: k % n) if wrap else (lambda k, n: np.clip(k, 0, n - 1))
    at = lambda p, q: f[index(p, f.shape[0]), index(q, f.shape[1])]
    return (1 - a) * ((1 - b) * at(i, j) + b * at(i, j + 1)) + a * ((1 - b) * at(i + 1, j) + b * at(i + 1, j + 1))


def rotation(scheme, n, steps):
    """A Gaussian turned once: where a cell's air was, exactly."""
    c = (np.arange(n) + 0.5) / n
    x, y = np.meshgrid(c, c, indexing='ij')
    f = first = np.exp(-((x - 0.5)**2 + (y - 0.75)**2) / (2 * 0.05**2))
    turn = 2 * pi / steps

    def moved(f, angle):
        u, v = x - 0.5, y - 0.5
        return bilinear(f, (0.5 + cos(angle) * u + sin(angle) * v) * n - 0.5, (0.5 - sin(angle) * u + cos(angle) * v) * n - 0.5, False)

    for _ in range(steps):
        to = moved(f, turn)
        f = to if scheme == 'sl' else to + (f - moved(to, -turn)) / 2
    norm = (first**2).sum()
    return [scheme, n, steps, (f**2).sum() / norm, f.sum() / first.sum(), f.max(), f.min(), sqrt(((f - first)**2).sum() / norm)]


def taylor_green(scheme, order, n, steps):
    """Staggered and periodic: advection of both components, then viscosity and pressure by Fourier transforms."""
    h, dt, nu = 2 * pi / n, 1 / steps, 0.01
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing='ij')
    places = [(i, j + 0.5), (i + 0.5, j)]  # in cells
    exact = lambda p: (np.sin(p[0][0] * h) * np.cos(p[0][1] * h), -np.cos(p[1][0] * h) * np.sin(p[1][1] * h))
    first = u = exact(places)
    k = 2 * pi * np.fft.fftfreq(n) * 1.0
    symbol = (2 - 2 * np.cos(k))[:, None] + (2 - 2 * np.cos(k))[None, :]

    def at(u, x, y):
        return bilinear(u[0], x, y - 0.5, True), bilinear(u[1], x - 0.5, y, True)

    def moved(f, shift, wind, sign):
        x, y = places[shift]
        a, b = at(wind, x, y)
        if order == 2:
            a, b = at(wind, x - sign * a * dt / h / 2, y - sign * b * dt / h / 2)
        x, y = x - sign * a * dt / h, y - sign * b * dt / h
        return bilinear(f, x, y - 0.5, True) if shift == 0 else bilinear(f, x - 0.5, y, True)

    for _ in range(steps):
        new = []
        for c in (0, 1):
            to = moved(u[c], c, u, 1)
            new.append(to if scheme == 'sl' else to + (u[c] - moved(to, c, u, -1)) / 2)
        new = [np.fft.fft2(f) / (1 + nu * dt / h**2 * symbol) for f in new]
        d = [np.exp(1j * k)[:, None] - 1, np.exp(1j * k)[None, :] - 1]
        p = (d[0] * new[0] + d[1] * new[1]) / np.where(symbol == 0, 1, -symbol)
        u = [np.fft.ifft2(f + np.conj(g) * p).real for f, g in zip(new, d)]
    norm = sum((f**2).sum() for f in first)
    return [
        scheme, order, n, steps,
        sum((f**2).sum() for f in u) / norm,
        sqrt(sum(((f - exp(-0.02) * g)**2).sum() for f, g in zip(u, first)) / norm)
    ]


def fluids():
    rows = []
    for a, n, k in ((0.3, 24, 2), (2.7, 40, 3), (0.65, 96, 1)):
        theta, f = 2 * pi * k / n, a - int(a)
        G = np.exp(-1j * int(a) * theta) * (1 - f + f * np.exp(-1j * theta))
        rows.append([a, n, k, abs(G), abs(G + (1 - abs(G)**2) / 2), abs(G * (3 - abs(G)**2) / 2)])
    add('fluid', {'rows': 'a,N,k,SL,MC,BFECC'}, {'rows': rows}, {'abs': 1e-9}, {f'/expected/rows/{i}/{3 + i}': 1e-4 for i in range(3)})
    rows = [[nu, dt, n, k, 1 / (1 + nu * dt * 4 * n * n * sin(pi * k / n)**2)] for nu, dt, n, k in ((0.02, 0.3, 20, 3), (1.5, 4.0, 48, 7))]
    add('fluid', {'rows': 'nu,dt,N,k,factor'}, {'rows': rows}, {'rel': 1e-11}, of({'rows': rows}, 1e-11, '/rows/0/4', '/rows/1/4'))
    n, h = (3, 5, 4), 0.25
    cells = list(itertools.product(*map(range, n)))
    index = {c: i for i, c in enumerate(cells)}
    matrix, right = np.zeros((len(cells), len(cells))), np.array([(7 * i + 13 * j + 29 * k) % 11 - 5.0 for i, j, k in cells])
    for c in cells:
        for a, s in itertools.product(range(3), (-1, 1)):
            beside = tuple(x + s * (b == a) for b, x in enumerate(c))
            if beside in index:
                matrix[index[c], index[beside]] += 1 / h**2
                matrix[index[c], index[c]] -= 1 / h**2
    p = np.linalg.lstsq(matrix, right - right.mean(), rcond=None)[0]
    p -= p.mean()
    expected = {name: p[index[tuple(int(d) for d in name[1:])]] for name in ('p000', 'p241', 'p123')} | {'l2': sqrt((p**2).mean())}
    add('fluid', {'n': list(n), 'h': h}, expected, {'abs': 1e-12}, {f'/expected/{k}': 1e-11 for k in expected})
    rows = [rotation('sl', 40, 60), rotation('mc', 56, 90)]
    add('fluid', {'rows': 'scheme,n,steps,energy,mass,max,min,rel_error'}, {'rows': rows}, {'rel': 1e-3},
        of({'rows': rows}, 1e-3, '/rows/0/3', '/rows/1/4', '/rows/1/5', '/rows/0/7') | {'/expected/rows/1/6': 0.01})
    rows = [taylor_green('sl', 2, 24, 16), taylor_green('mc', 1, 40, 20)]
    add('fluid', {'rows': 'scheme,trace_order,n,steps,energy_ratio,rel_error'}, {'rows': rows}, {'rel': 'own run'},
        {'/expected/rows/0/4': 0.5 * (1 - rows[0][4]), '/expected/rows/1/5': 0.5 * rows[1][5]})
    force = [0.5 * 0.08 * exp(-r * r) for r in (0.75, 1.25)]
    add('fluid', {'eps': 0.5, 'h': 0.08, 'r': [0.75, 1.25]}, {'f_theta': force}, {'exact': True},
        {f'/expected/f_theta/{i}': 0.2 * f for i, f in enumerate(force)})
    add('fluid', {'steps': 7}, {'max_speed_over_g_dt': 0.0}, {'abs': 1e-12}, {'/expected/max_speed_over_g_dt': 1e-4})


def central_light():
    """A light in the middle of an even ball: r times the source of a further order is half the albedo times the integral of rho S(rho) with
    E1(|r - rho|) - E1(r + rho)."""
    radius, albedo = 0.9, 0.75
    x, w = legendre.leggauss(200)
    r, w = radius * (x + 1) / 2, w * radius / 2
    first = albedo * np.exp(-r) / (4 * pi * r)  # r S_1
    whole = lambda a: 1 - np.exp(-a) + a * exp1(a)  # integral of E1 from 0 to a
    kernel = exp1(abs(r[:, None] - r[None, :]) + np.eye(len(r))) * (1 - np.eye(len(r))) * w
    # The logarithm on the diagonal is taken off with the value there.
    kernel += np.diag(whole(r) + whole(radius - r) - kernel.sum(1))
    kernel -= exp1(r[:, None] + r[None, :]) * w
    kernel *= albedo / 2
    second = kernel @ first
    rest = np.linalg.solve(np.eye(len(r)) - kernel, second)
    t, v = legendre.leggauss(60)
    expected = {}
    for b in (0.3, 0.7):
        half = radius * sqrt(1 - b * b)
        s = half * t
        rho = np.sqrt(s * s + (b * radius)**2)
        seen = v * half * np.exp(-(half + s)) / rho
        expected[str(b)] = [
            float(seen @ (albedo * np.exp(-rho) / (4 * pi * rho))),
            float(seen @ np.interp(rho, r, second)),
            float(seen @ (albedo * np.exp(-rho) / (4 * pi * rho) + np.interp(rho, r, rest)))
        ]
    add('sphere_central_point', {'optical_radius': radius, 'albedo': albedo}, {'L1_L2_Lall': expected}, {'abs': 1e-6},
        {'/expected/L1_L2_Lall/0.3/0': 0.02, '/expected/L1_L2_Lall/0.7/1': 0.01, '/expected/L1_L2_Lall/0.3/2': 0.04})


def make():
    for kinds in (single_scattering, slabs, spheres, central_light, identities, fields, sampling, statistics, fluids):
        kinds()
    file.write()


if __name__ == '__main__':
    make()
