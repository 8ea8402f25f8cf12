"""Zhou et al. 2008: definitions by quadrature, differences by 40 digits, slabs by adding layers, half spaces by an integral for H."""
import itertools
from math import asin, exp, gcd, log, pi, sqrt

import numpy as np
from mpmath import diff, mp, mpf, quad
import mpmath
from scipy.special import erf

from common import File
from harmonics import about_axis, basis, sphere
from slab import Slab

file = File('compensated_ray_marching', paper='compensated_ray_marching_2008')
random = np.random.default_rng(11)


def leaves(value, path):
    if isinstance(value, dict):
        for k, v in value.items():
            yield from leaves(v, f'{path}/{k}')
    elif isinstance(value, list):
        for i, v in enumerate(value):
            yield from leaves(v, f'{path}/{i}')
    else:
        yield path, value


def add(kind, inputs, expected, rtol, atol, **more):
    """Adds a vector. The first and the last number of each list of expected numbers are made wrong in turn."""
    expected = plain(expected)
    wrong, seen = {}, {}
    for path, value in leaves(expected, '/expected'):
        seen.setdefault(path.rstrip('0123456789'), []).append((path, value))
    for group in seen.values():
        for path, value in (group[0], group[-1]):
            wrong[path] = 10 * (rtol * abs(value) + atol)
    file.add(kind, {'input': plain(inputs), 'expected': expected, 'rtol': rtol, 'atol': atol, **more}, wrong)


def plain(x):
    if isinstance(x, dict):
        return {k: plain(v) for k, v in x.items()}
    if isinstance(x, (list, tuple, np.ndarray)):
        return [plain(v) for v in x]
    return x if isinstance(x, (int, str, bool, type(None))) else int(x) if isinstance(x, np.integer) else float(x)


def rounded(*shape):
    return np.round(random.normal(size=shape), 3)


def triple(order):
    w, weight = sphere(2 * order + 2)
    y = basis(order, w)
    return np.einsum('an,bn,cn,n->abc', y, y, y, weight)


def zonal_depth(order, d, cut):
    """Zonal coefficients of the depth of a Gaussian of width and amplitude 1 at a distance d, by quadrature in the cosine."""
    def depth(mu):
        a, square = d * mu, d * d * (1 - mu * mu)
        if cut is None:
            return mpmath.sqrt(mp.pi) / 2 * mpmath.exp(-square) * (1 + mpmath.erf(a))
        if square >= cut * cut:
            return mpf(0)
        h = mpmath.sqrt(cut * cut - square)
        return mpmath.sqrt(mp.pi) / 2 * mpmath.exp(-square) * (mpmath.erf(h) - mpmath.erf(min(max(-a, -h), h)))

    d = mpf(d)
    least = mpf(-1) if cut is None or d <= cut else mpmath.sqrt(1 - (mpf(cut) / d)**2)

    # mu = least + (1 - least) u^2: the depth begins with a root where the cone touches the cut.
    def term(band):
        return lambda u: depth(least + (1 - least) * u * u) * mpmath.legendre(band, least + (1 - least) * u * u) * 2 * (1 - least) * u

    return [2 * mp.pi * mpmath.sqrt(mpf(2 * band + 1) / (4 * mp.pi)) * quad(term(band), [0, 0.3, 0.6, 1]) for band in range(order)]


def harmonic_kinds():
    way = [0.75, -1.5, 0.5]
    add('sh_basis', {'order': 6, 'direction': way}, basis(6, way / np.linalg.norm(way))[:, 0], 1e-13, 1e-14)
    gaunt = triple(5)
    for i, j, k in ((20, 6, 8), (3, 13, 21), (24, 24, 0)):
        add('sh_triple_entry', {'order': 5, 'i': i, 'j': j, 'k': k}, gaunt[i, j, k], 1e-12, 1e-14)
    orders = [2, 5, 3]
    every = [triple(n) for n in orders]
    counts = {
        'nonzero': [int((abs(t) > 1e-12).sum()) for t in every], 'unique_sorted': [
            sum(abs(t[i, j, k]) > 1e-12 for i, j, k in itertools.combinations_with_replacement(range(len(t)), 3)) for t in every
        ]
    }
    file.add('sh_triple_counts', {'input': {'orders': orders}, 'expected': counts, 'rtol': 0, 'atol': 0},
             {'/expected/nonzero/1': 1, '/expected/unique_sorted/2': -1})
    for order in (3, 5):
        f, g = rounded(order * order), rounded(order * order)
        add('sh_triple_product', {'order': order, 'f': f, 'g': g}, np.einsum('abc,a,b->c', triple(order), f, g), 1e-12, 1e-13)
    for order, g in ((6, -0.35), (3, 0.8)):
        inside = lambda mu, b: (1 - mpf(g)**2) / (1 + mpf(g)**2 - 2 * g * mu)**1.5 * mpmath.legendre(b, mu)
        zonal = [
            2 * mp.pi * mpmath.sqrt(mpf(2 * b + 1) / (4 * mp.pi)) * quad(lambda mu: inside(mu, b), [-1, 0, 0.5, 1]) for b in range(order)
        ]
        add('hg_zh', {'order': order, 'g': g}, zonal, 1e-13, 0)
    f, zonal = rounded(25), rounded(5)
    # By the integral over the sphere of a zonal function about each of so many directions.
    w, weight = sphere(12)
    y = basis(5, w)
    z = np.polynomial.legendre.legval(w.T @ w, [zonal[b] * sqrt((2 * b + 1) / (4 * pi)) for b in range(5)])
    add('sh_convolution', {'order': 5, 'f': f, 'zonal': zonal}, y @ (weight * (z @ (weight * (y.T @ f)))), 1e-12, 1e-13)
    axis = np.array([-2, 0.5, 1.25])
    z = np.polynomial.legendre.legval(axis / np.linalg.norm(axis) @ w, [zonal[b] * sqrt((2 * b + 1) / (4 * pi)) for b in range(5)])
    add('zh_rotation', {'order': 5, 'zonal': zonal, 'axis': axis}, y @ (weight * z), 1e-12, 1e-13)
    for d in (0.35, 1.6, 12.5):
        add('theta_of_d', {'d': d}, asin(1 / d) if d > 1 else pi - asin(d), 1e-12, 0)
    for d, mu, radius, cut in ((1.75, 0.8, 0.4, 2.5), (0.6, -0.35, 2.0, None), (4.0, 0.9, 1.5, 3.5)):
        side = d * sqrt(1 - mu * mu)
        inside = lambda t: mpmath.exp(-(mpf(side)**2 + (t - d * mpf(mu))**2))
        half = sqrt(cut * cut - side * side) if cut else 12
        ends = [max(0, d * mu - half), max(0.0, d * mu), d * mu + half]
        add('gaussian_optical_depth', {'d': d, 'mu': mu, 'cut': cut, 'radius': radius}, quad(inside, ends), 1e-12, 1e-15)
    for order, d, cut in ((5, 1.75, 2.5), (3, 4.5, 2.5), (4, 0.4, None)):
        add('rbf_zh_optical_depth', {'order': order, 'd': d, 'cut': cut, 'radius': 0.3}, zonal_depth(order, d, cut), 1e-9, 1e-12)


SMOKE = [[0.45, 0.6, 0.5, 0.125, 0.75], [0.625, 0.4, 0.375, 0.09, 1.25]]


def minus_depth(smoke, x, sigma_t, cut):
    total = np.zeros(16)
    for g in smoke:
        way = np.array(g[:3]) - x
        d = np.linalg.norm(way)
        total -= sigma_t * g[3] * g[4] * about_axis([float(c) for c in zonal_depth(4, d / g[3], cut)], way)
    return total


def projected_exp(f):
    w, weight = sphere(80)
    y = basis(4, w)
    return y @ (weight * np.exp(f @ y))


def columns(smoke, x, w):
    """Depths of uncut Gaussians along rays without end; x is 3 x 1 or 3 x n."""
    total = 0
    for a, b, c, r, amplitude in smoke:
        way = np.array([[a], [b], [c]]) - x
        along = (way * w).sum(0)
        square = (way * way).sum(0) - along**2
        total = total + amplitude * r * sqrt(pi) / 2 * np.exp(-square / r**2) * (1 + erf(along / r))
    return total


def hg(g, c):
    return (1 - g * g) / (1 + g * g - 2 * g * c)**1.5


def sky():
    """0.25 + 2 ((1 + w.a) / 2)^2, by its coefficients."""
    a = np.array([2, -1, 2]) / 3
    w, weight = sphere(12)
    return basis(4, w) @ (weight * (0.25 + 2 * ((1 + a @ w) / 2)**2))


def mixture(sizes):
    """Sums of one or three blockers from 0.3 to 10 widths, about random axes, cut at 3: means of a sample, with their standard errors."""
    node, weight = np.polynomial.legendre.leggauss(48)
    members, (w, area) = 1500, sphere(28)
    y = basis(4, w)
    family = []
    for count in (1, 3):
        d = np.exp(random.uniform(log(0.3), log(10), (members, count, 1)))
        # By the angle to the axis, over the cone in which the blocker lies.
        least = np.where(d > 3, np.sqrt(np.maximum(0, 1 - (3 / d)**2)), -1)
        u = (node + 1) / 2
        mu = least + (1 - least) * u * u
        square = d * d * (1 - mu * mu)
        half = np.sqrt(np.maximum(0, 9 - square))
        depth = sqrt(pi) / 2 * np.exp(-square) * (erf(half) - erf(np.clip(-d * mu, -half, half)))
        axis = random.normal(size=(members, count, 3))
        axis /= np.linalg.norm(axis, axis=2)[:, :, None]
        at_axis = basis(4, axis.reshape(-1, 3).T).reshape(16, members, count)
        h = np.zeros((16, members))
        for b in range(1, 4):
            zonal = 2 * pi * (depth * np.polynomial.legendre.legval(mu, [0] * b + [1]) * 2 * (1 - least) * u * weight / 2).sum(2)
            h[b * b:(b + 1)**2] = (at_axis[b * b:(b + 1)**2] * zonal).sum(2)
        family.append(h / np.linalg.norm(h, axis=0))
    table, error = {'a': [], 'b': []}, {'a': [], 'b': []}
    for s in sizes:
        parts = []
        for h in family:
            e = y @ (area[:, None] * np.exp(-s * (y.T @ h)))
            parts.append((e[0] / sqrt(4 * pi), -(e * h).sum(0) / s))
        for i, n in enumerate('ab'):
            table[n].append(np.mean([p[i].mean() for p in parts]))
            error[n].append(sqrt(sum(p[i].var() / members for p in parts)) / len(parts))
    wrong = {f'/expected/{n}/{i}': 150 * error[n][i] for n in 'ab' for i in (0, 2)}
    file.add(
        'ol_table', {
            'input': {'order': 4, 'family': 'counts', 'counts': [1, 3], 's': sizes}, 'expected': plain(table), 'rtol': 0, 'atol': 0,
            'stderr': plain(error)
        }, wrong)


def ball():
    """Isotropic scattering in a Gaussian: the mean radiance at radii by collocation, a polynomial in the radius."""
    sigma_t, width, amplitude, cut, albedo, light = 4.0, 0.25, 1.5, 3.5, 0.8, 1.75
    sigma, count = sigma_t * width * amplitude, 26
    node, weight = np.polynomial.legendre.leggauss(72)
    grid = cut * (1 - np.cos(pi * (np.arange(count) + 0.5) / count)) / 2

    def path(r, mu):
        """Nodes along the way backwards from a point, which went at mu to the radius: radii, extinction times steps, what is left."""
        a, square = r * mu, r * r * (1 - mu * mu)
        length = a + np.sqrt(np.maximum(0, cut * cut - square))
        s = length * (node + 1) / 2
        depth = sigma * sqrt(pi) / 2 * np.exp(-square) * (erf(a) - erf(a - s))
        whole = sigma * sqrt(pi) / 2 * np.exp(-square) * (erf(a) - erf(a - length))
        radius = np.sqrt(square + (a - s)**2)
        return radius, sigma * np.exp(-radius**2 - depth) * weight / 2 * length, exp(-whole)

    def chebyshev(r):
        return np.polynomial.chebyshev.chebvander(2 * np.asarray(r) / cut - 1, count - 1)

    to_values = np.linalg.inv(chebyshev(grid))

    def gathered(r):
        """The row that gives the mean of what is gathered at r, and the mean of the light that nothing has scattered."""
        row, reduced = np.zeros(count), 0
        for mu, w in zip(node, weight):
            radius, share, left = path(r, mu)
            row += w / 2 * share @ chebyshev(radius) @ to_values
            reduced += w / 2 * left
        return row, light * reduced

    rows, reduced = zip(*map(gathered, grid))
    J = np.linalg.solve(np.eye(count) - albedo * np.array(rows), reduced)
    radii, impacts = [0.2, 0.8, 2.4], [0.3, 1.1, 2.2]
    means = [gathered(r) for r in radii]
    chords = [path(cut, sqrt(1 - (b / cut)**2)) for b in impacts]
    add(
        'multiple_scattering_sphere', {
            'rbf_x_y_z_r_w': [[0.1, 0.2, 0.3, width, amplitude]], 'cut': cut, 'sigma_t': sigma_t, 'albedo': albedo, 'g': 0.0,
            'phase': 'order 4: P_l with l < 4', 'environment_radiance': light, 'radius_over_r': radii, 'impact_over_r': impacts
        }, {
            'mean_radiance': [albedo * row @ J + first for row, first in means], 'mean_reduced_radiance': [first for _, first in means],
            'exit_radiance': [albedo * share @ chebyshev(radius) @ to_values @ J + light * left
                              for radius, share, left in chords], 'exit_transmittance': [left for _, _, left in chords]
        }, 1e-6, 1e-8)


def source_kinds():
    blockers = [[0.8, -0.4, 1.2, 0.6, 0.9], [-0.5, 1.5, 0.3, 0.45, 0.6]]
    for cut in (3, 2.5):
        depth = minus_depth(blockers, np.zeros(3), 1.75, cut)
        add('sh_exponential', {'order': 4, 'blockers_xyz_r_w': blockers, 'sigma_t': 1.75, 'cut': cut},
            {'minus_depth_vector': depth, 'exp_of_bandlimited': projected_exp(depth)}, 1e-9, 1e-11)
    unit = rounded(3, 16)
    unit[:, 0] = 0
    unit /= np.linalg.norm(unit, axis=1)[:, None]
    sizes = [0.5, 1.5, 3]

    def linear(h, s):
        e = projected_exp(-s * h)
        return e[0] / sqrt(4 * pi), -s * (e @ h) / s**2

    table = {n: [np.mean([linear(h, s)[i] for h in unit]) for s in sizes] for i, n in enumerate('ab')}
    add('ol_table', {'order': 4, 'family': 'explicit', 'unit_vectors': unit, 's': sizes}, table, 1e-6, 0)
    # One blocker from 0.5 to 6 widths, cut at 2.
    node, weight = np.polynomial.legendre.leggauss(16)
    table = {'a': np.zeros(3), 'b': np.zeros(3)}
    for lo, hi in ((log(0.5), log(2)), (log(2), log(6))):
        for x, w in zip(node, weight):
            zonal = np.array([float(c) for c in zonal_depth(4, exp(lo + (hi - lo) * (x + 1) / 2), 2)])
            zonal[0] = 0
            h = about_axis(zonal / np.linalg.norm(zonal), [0, 0, 1])
            for i, s in enumerate(sizes):
                a, b = linear(h, s)
                share = w / 2 * (hi - lo) / log(12)
                table['a'][i] += share * a
                table['b'][i] += share * b
    add('ol_table', {'order': 4, 'family': 'one blocker, d/r log-uniform in [0.5, 6], cut 2', 's': sizes}, table, 1e-6, 0)
    mixture(sizes)
    w, weight = sphere(140)
    y, light = basis(4, w), sky()
    x, sigma_t, albedo, g = np.array([[0.5], [0.45], [0.55]]), 7.0, 0.8, 0.4
    common = {'order': 4, 'point': x.ravel(), 'rbf_x_y_z_r_w': SMOKE, 'sigma_t': sigma_t, 'cut': None, 'environment_sh_lookup': light}
    passed = np.exp(-sigma_t * columns(SMOKE, x, w))
    left = passed * (light @ y)
    ways = np.array([[0.6, 0, 0.8], [-2 / 3, 1 / 3, 2 / 3], [0, -1, 0]])
    turned = np.concatenate([[(-g)**b] * (2 * b + 1) for b in range(4)])
    depth = minus_depth(SMOKE, x.ravel(), sigma_t, None)
    limited = albedo * turned * np.einsum('abc,a,b->c', triple(4), light, projected_exp(depth))
    sent = [albedo / (4 * pi) * weight @ (left * hg(g, -(way @ w))) for way in ways]
    add('single_scattering_source', {**common, 'albedo': albedo, 'g': g, 'propagation_directions': ways}, {
        'exact_projection': albedo * turned * (y @ (weight * left)), 'exact_radiance': sent, 'minus_depth_vector': depth,
        'band_limited': limited, 'band_limited_radiance': limited @ basis(4, ways.T)
    }, 1e-6, 1e-8)
    add('transmittance_environment', {**common, 'lookup_directions': ways}, {
        'mean_transmittance': weight @ passed / (4 * pi), 'mean_attenuated_radiance': weight @ left /
        (4 * pi), 'vector_irradiance': w @ (weight * left), 'transmittance_projection': y @ (weight * passed),
        'attenuated_light_projection': y @ (weight * left), 'optical_depth': sigma_t * columns(SMOKE, x, ways.T)
    }, 1e-6, 1e-8)


def density(smoke, x, cut=None):
    """At points 3 x n, of each Gaussian."""
    square = [((x - np.array([g[:3]]).T)**2).sum(0) / g[3]**2 for g in smoke]
    return np.array([g[4] * np.exp(-q) * (1 if cut is None else q <= cut * cut) for g, q in zip(smoke, square)])


def panels(ends, count, nodes=12):
    """Gauss nodes and weights over `count` equal parts between each two ends."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    edges = np.unique(np.concatenate([np.linspace(a, b, count + 1) for a, b in zip(ends, ends[1:])]))
    half = np.diff(edges) / 2
    return (edges[:-1, None] + half[:, None] * (x + 1)).ravel(), (half[:, None] * w).ravel()


def march_kinds():
    sigma_t, albedo, g, end = 5.0, 0.7, 0.3, 2.0
    light, (w, weight) = sky(), sphere(48)
    y = basis(4, w)
    rays = [([0.5, 0.5, -0.5], [0.0, 0.0, 1.0]), ([-0.4, 0.3, 0.2], [0.96, 0.0, 0.28])]
    turned = np.concatenate([[(-g)**b] * (2 * b + 1) for b in range(4)])
    centres = [albedo * turned * (y @ (weight * np.exp(-sigma_t * columns(SMOKE, np.array([s[:3]]).T, w)) * (light @ y))) for s in SMOKE]
    expected = {'transmittance': [], 'radiance': [], 'radiance_interpolated': []}
    for o, r in rays:
        o, r = np.array([o]).T, np.array([r]).T
        t, step = panels([0, end], 24)
        x = o + t * r
        parts = density(SMOKE, x)
        depth = np.array([columns(SMOKE, o, r)[0] - columns(SMOKE, x[:, [i]], r)[0] for i in range(len(t))])
        reach = sigma_t * parts.sum(0) * np.exp(-sigma_t * depth) * step
        sent = [
            albedo / (4 * pi) * weight @ (np.exp(-sigma_t * columns(SMOKE, x[:, [i]], w)) * (light @ y) * hg(g,
                                                                                                             r.ravel() @ w))
            for i in range(len(t))
        ]
        towards = np.array(centres) @ basis(4, -r)[:, 0]
        # Nothing is sent where the Gaussians are below 1e-10.
        between = np.where(parts.sum(0) < 1e-10, 0, np.maximum(0, towards @ parts / np.maximum(parts.sum(0), 1e-300)))
        left = exp(-sigma_t * (columns(SMOKE, o, r)[0] - columns(SMOKE, o + end * r, r)[0]))
        behind = left * (light @ basis(4, r))[0]
        expected['transmittance'].append(left)
        expected['radiance'].append(reach @ sent + behind)
        expected['radiance_interpolated'].append(reach @ between + behind)
    add(
        'march_single_scattering', {
            'rbf_x_y_z_r_w': SMOKE, 'sigma_t': sigma_t, 'cut': None, 'albedo': albedo, 'g': g, 'environment_sh_lookup': light,
            'rays': [{'origin': o, 'direction': r}
                     for o, r in rays], 't_max': end, 'background': 'environment radiance in the ray direction'
        }, expected, 1e-5, 1e-6)
    cut, sources, background = 2.5, np.round(random.normal(size=(2, 16)) / 5, 3), 0.3
    sources[:, 0] = [1.5, 2.0]
    axis, thickness, count = np.array([0, 0, 1.0]), 0.05, 40
    names = ['transmittance', 'radiance', 'slice_transmittance', 'slice_printed', 'slice_paper', 'slice_exact_weight']
    expected = {n: [] for n in names}
    rays = [([0.5, 0.55, -0.5], [0.0, 0.0, 1.0]), ([0.2, 0.5, -0.5], [0.28, 0.0, 0.96])]
    for o, r in rays:
        o, r = np.array([o]).T, np.array([r]).T
        cosine = abs(axis @ r)[0]
        towards = sources @ basis(4, -r)[:, 0]

        def field(t):
            parts = density(SMOKE, o + t * r, cut)
            total = parts.sum(0)
            return np.where(total < 1e-10, 0, total), np.where(total < 1e-10, 0, np.maximum(0, towards @ parts / np.maximum(total, 1e-300)))

        ends = [0, count * thickness / cosine]
        for s in SMOKE:
            way = np.array(s[:3]) - o.ravel()
            along = way @ r.ravel()
            square = (cut * s[3])**2 - way @ way + along**2
            ends += [along - sqrt(square), along + sqrt(square)] if square > 0 else []
        t, step = panels(sorted(ends), 6, 16)
        D, J = field(t)
        # The depth up to each node: by quadrature from the start of its panel's part.
        before = np.array(
            [sum((w_ * field(n)[0]).sum() for n, w_ in [panels(sorted([e for e in ends if e < at] + [at]), 4, 16)]) for at in t])
        expected['radiance'].append((sigma_t * D * J * np.exp(-sigma_t * before) * step).sum() + background * exp(-sigma_t * (D @ step)))
        expected['transmittance'].append(exp(-sigma_t * (D @ step)))
        du = thickness / cosine
        D, J = field((np.arange(count) + 0.5) * du)
        depth = sigma_t * D * du
        clear = np.exp(-np.concatenate([[0], np.cumsum(depth)]))
        expected['slice_transmittance'].append(clear[-1])
        expected['slice_printed'].append(clear[:-1] @ (J * depth * cosine) + background * clear[-1])
        expected['slice_paper'].append(clear[:-1] @ (J * depth) + background * clear[-1])
        expected['slice_exact_weight'].append(clear[:-1] @ (J * -np.expm1(-depth)) + background * clear[-1])
    add(
        'march_compensated', {
            'order': 4, 'rbf_x_y_z_r_w': SMOKE, 'sigma_t': sigma_t, 'cut': cut, 'source_sh_propagation': sources,
            'rays': [{'origin': o, 'direction': r}
                     for o, r in rays], 'slice_axis': axis, 'slice_thickness': thickness, 'slices': count, 'background': background
        }, expected, 1e-9, 1e-11)
    s, D, J, step, count = 3.5, 0.6, 1.75, 0.03, 24
    depth = s * D * step
    add('ray_march_homogeneous', {'sigma_t': s, 'D': D, 'J': J, 'step': step, 'slices': count, 'background': 1.0}, {
        'transmittance': exp(-count * depth), 'paper_sum_without_background': J * depth * sum(exp(-i * depth) for i in range(count)),
        'exact_without_background': J * (1 - exp(-count * depth))
    }, 1e-11, 0)


def collocation():
    smoke = [[0.4, 0.5, 0.55, 0.1, 0.9], [0.5, 0.45, 0.5, 0.12, 0.4], [0.55, 0.6, 0.45, 0.09, 1.1]]
    sigma_t, albedo, g = mpf('9.5'), mpf('0.75'), mpf('0.2')
    sources = rounded(3, 4)
    centres = [[mpf(c) for c in s[:3]] for s in smoke]

    def shape(i, *x):
        return mpf(smoke[i][4]) * mpmath.exp(-sum((a - b)**2 for a, b in zip(x, centres[i])) / mpf(smoke[i][3])**2)

    def D(*x):
        return sum(shape(i, *x) for i in range(3))

    def slope(f, x, axis, n=1):
        return diff(f, tuple(x), tuple(n if a == axis else 0 for a in range(3)))

    sigma_tr = (1 - albedo * g) * sigma_t
    kappa = lambda *x: 1 / (3 * sigma_tr * D(*x))
    mean = [mpf(f[0]) / mpmath.sqrt(4 * mp.pi) for f in sources]
    c = mpmath.sqrt(3 / (4 * mp.pi))
    direction = [[-c * mpf(f[3]), -c * mpf(f[1]), c * mpf(f[2])] for f in sources]
    rows, right, printed = [], [], []
    for x in centres:
        row = []
        for i in range(3):
            share = lambda *p: shape(i, *p) / D(*p)
            spread = sum(slope(kappa, x, a) * slope(share, x, a) + kappa(*x) * slope(share, x, a, 2) for a in range(3))
            row.append(spread - (1 - albedo) * sigma_t * D(*x) * share(*x))
        rows.append(row)
        J0 = sum(shape(i, *x) * mean[i] for i in range(3)) / D(*x)
        divergence = sum(slope(lambda *p: sum(shape(i, *p) * direction[i][a] for i in range(3)) / D(*p), x, a) for a in range(3))
        right.append(-sigma_t * D(*x) * J0 + sigma_t / (3 * sigma_tr) * divergence)
        printed.append(-sigma_t / albedo * D(*x) * J0 + sigma_t / sigma_tr * divergence)
    add('collocation_matrix', {'rbf_x_y_z_r_w': smoke, 'sigma_t': sigma_t, 'albedo': albedo, 'g': g, 'cut': None, 'Jss_sh_order2': sources},
        {'corrected': {'A': rows, 'b': right}, 'as_printed': {'A': rows, 'b': printed}}, 1e-10, 1e-12)


def H(albedo, mu):
    """Chandrasekhar's, by its integral; the quotient tends to -albedo / 2 pi ... no singularity for albedo < 1."""
    inside = lambda t: mpmath.log(1 - albedo * t / mpmath.tan(t)) / (mpmath.cos(t)**2 + mu**2 * mpmath.sin(t)**2)
    return mpmath.exp(-mu / mp.pi * quad(inside, [mpf('1e-30'), 0.5, 1, 1.4, mp.pi / 2]))


def moments(g, count):
    return [g**l for l in range(count)]


def transport_kinds():
    albedo, g, sigma_t, r, power = 0.85, 0.3, 2.5, 0.7, 3.0
    tr = (1 - albedo * g) * sigma_t
    effective = sqrt(3 * tr * (1 - albedo) * sigma_t)
    fluence = power * exp(-effective * r) * 3 * tr / (4 * pi * r)
    add('diffusion_point_source', {'albedo': albedo, 'g': g, 'sigma_t': sigma_t, 'r': r, 'power': power},
        {'sigma_tr': tr, 'kappa': 1 / (3 * tr), 'sigma_eff': effective, 'mean_radiance': fluence / (4 * pi)}, 1e-12, 0)
    add('diffusion_uniform_source', {'albedo': 0.65, 'single_scatter_mean_source': 0.8}, 0.8 / (1 - 0.65), 1e-12, 0)
    # kappa L'' = alpha L - sigma J0, with -kappa dL/dn = L / 2 at both faces.
    sigma, thickness, J0 = sigma_t * 0.6, 1.5, 1.25
    tr = (1 - albedo * g) * sigma
    kappa, alpha = 1 / (3 * tr), (1 - albedo) * sigma
    s = sqrt(alpha / kappa)
    even = J0 / (1 - albedo)
    e = exp(-s * thickness)
    # L = even + p exp(-s x) + q exp(-s (T - x)).
    p, q = np.linalg.solve([[kappa * s + 0.5, (-kappa * s + 0.5) * e], [(-kappa * s + 0.5) * e, kappa * s + 0.5]], [-even / 2, -even / 2])
    value = lambda x: even + p * exp(-s * x) + q * exp(-s * (thickness - x))
    add('diffusion_slab_marshak', {'albedo': albedo, 'g': g, 'sigma_t': sigma_t, 'D': 0.6, 'thickness': thickness, 'J0': J0, 'J1': 0},
        {'centre': value(thickness / 2), 'boundary': value(0), 'quarter': value(thickness / 4)}, 1e-10, 0)
    albedo = mpf('0.75')
    one, half, root = H(albedo, 1), H(albedo, mpf('0.5')), mpmath.sqrt(1 - albedo)
    first = quad(lambda mu: mu * H(albedo, mu), [mpf('1e-30'), 0.2, 1], maxdegree=5)
    add('halfspace_albedo_isotropic', {'albedo': albedo, 'g': 0}, {
        'H_mu1': one, 'H_mu0p5': half, 'plane_albedo_mu1': 1 - one * root, 'plane_albedo_mu0p5': 1 - half * root,
        'spherical_albedo_diffuse': 1 - 2 * root * first, 'radiance_mu1_from_mu1_per_unit_flux': albedo / (4 * mp.pi) * one * one / 2
    }, 1e-9, 0)
    mu = 0.65
    slab = Slab(moments(0.4, 40), 0.8, [mu])
    down, up = slab.inside(2.5, 0, 1, 0)[0], slab.inside(0, 2.5, 1, 0)[1]
    add('slab_albedo_mc', {'albedo': 0.8, 'g': 0.4, 'optical_thickness': 2.5, 'incidence_mu': mu},
        {'reflectance': up[-1], 'transmittance': down[-1]}, 0, 1e-6)
    # Slabs: radiance and its mean at depths; the reduced light has half of E2-like integrals as its mean.
    for kind, g, emission, top, bottom in (('sn_slab', 0.3, 0.0, 1.5, 0.25), ('sn_slab', 0.0, 0.4, 0.0, 0.0), ('hetero', 0.25, 0.0, 1.0,
                                                                                                               0.5)):
        albedo = 0.7
        if kind == 'sn_slab':
            depth, thickness = (lambda z: z), 1.5
        else:
            # Density 0.4 at the top and 1.2 at the bottom of 2 m.
            depth, thickness = (lambda z: 1.25 * (0.4 * z + 0.2 * z * z)), 1.25 * 1.6
        places = [0.0, 0.5, 1.5 if kind == 'sn_slab' else 2.0]
        asked = [[0.0, -0.7], [0.5, 0.35], [0.5, -0.35], [places[-1], 0.8]]

        def numbers(moments):
            slab = Slab(moments, albedo, [abs(m) for _, m in asked], emission=emission)
            got = {'mean_radiance': [], 'radiance': [0] * len(asked)}
            for z in sorted(set(places)):
                down, up = slab.inside(depth(z), thickness - depth(z), top, bottom)
                got['mean_radiance'].append(slab.mean(down + up))
                for i, (at, m) in enumerate(asked):
                    if at == z:
                        got['radiance'][i] = (down if m > 0 else up)[len(slab.mu) - len(asked) + i]
            got['flux_leaving_top'] = slab.flux(slab.inside(0, thickness, top, bottom)[1])
            got['flux_leaving_bottom'] = slab.flux(slab.inside(thickness, 0, top, bottom)[0])
            return got

        full, short = numbers(moments(g, 24)), numbers(moments(g, 4))
        expected = {'full_phase': full, 'order4_phase': short} if g else full
        common = {'albedo': albedo, 'g': g, 'inflow_top': top, 'inflow_bottom': bottom}
        if kind == 'sn_slab':
            add(kind, {'optical_thickness': thickness, **common, 'emission_J0': emission, 'tau': places, 'radiance_tau_mu': asked},
                expected, 1e-7, 1e-9)
        else:
            expected['optical_depth'] = [depth(z) for z in places]
            add('multiple_scattering_slab_hetero',
                {'sigma_t': 1.25, 'density_top': 0.4, 'density_bottom': 1.2, 'height': 2.0, **common, 'z': places, 'radiance_z_mu': asked},
                expected, 1e-7, 1e-9)


def other_kinds():
    n, center, square, cut = 6, np.array([0.4, 0.55, 0.6]), 0.09, 3.0
    rows = [[0.42, 0.5, 0.61, 0.11, 0.65], [0.55, 0.6, 0.45, 0.1, 0.3], [0.3, 0.7, 0.7, 0.08, 0.5]]
    places = (np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing='ij')) + 0.5) / n
    target = np.exp(-((places - center[:, None, None, None])**2).sum(0) / square)

    def model(rows):
        total = 0
        for a, b, c, r, w in rows:
            q = ((places - np.array([a, b, c])[:, None, None, None])**2).sum(0) / r**2
            total = total + w * np.exp(-q) * (q <= cut * cut)
        return total

    error = model(rows) - target
    gradient = []
    for a, b, c, r, w in rows:
        away = places - np.array([a, b, c])[:, None, None, None]
        q = (away**2).sum(0) / r**2
        one = np.exp(-q) * (q <= cut * cut)
        gradient += [4 * w / r**2 * (error * one * away[i]).sum() for i in range(3)]
        gradient += [4 * w / r * (error * one * q).sum(), 2 * (error * one).sum()]
    add('fit_objective',
        {'grid': n, 'density': 'exp(-|x-(0.4,0.55,0.6)|^2/0.09) at voxel centres (i+.5)/N, box [0,1]^3', 'rbf_x_y_z_r_w': rows, 'cut': cut},
        {'objective': (error**2).sum(), 'gradient': gradient, 'sum_D2': (target**2).sum()}, 1e-10, 1e-12)

    size, lo, hi = [3, 2, 4], np.array([0, -1, 1.0]), np.array([1.5, 1, 3.0])
    values = np.round(random.uniform(0, 2, size), 3)
    points = np.round(random.uniform(lo - 0.3, hi + 0.3, (8, 3)), 3)

    def interpolated(x, clamp):
        p = (x - lo) / (hi - lo) * size - 0.5
        if clamp:
            if ((x < lo) | (x > hi)).any():
                return 0.0
            p = np.clip(p, 0, np.array(size) - 1)
        base, total = np.floor(p).astype(int), 0.0
        for corner in itertools.product((0, 1), repeat=3):
            at = base + corner
            weight = np.prod(np.where(corner, p - base, 1 - (p - base)))
            total += weight * values[tuple(at)] if ((at >= 0) & (at < size)).all() else 0
        return total

    add('trilinear_border', {'resolution': size, 'values_x_y_z': values, 'box_min': lo, 'box_max': hi, 'points': points},
        {'clamp': [interpolated(x, True) for x in points], 'zero': [interpolated(x, False) for x in points]}, 1e-12, 1e-13)

    m, r, p, offset = 12, 17, [200, 31, 5], [11, 0, 7]
    file.add(
        'psh_address', {
            'input': {'m': m, 'r': r, 'p': p, 'offset': offset},
            'expected': {'offset_slot': [x % r for x in p], 'hash_slot': [(x + o) % m for x, o in zip(p, offset)]}, 'rtol': 0, 'atol': 0
        }, {'/expected/offset_slot/1': 1, '/expected/hash_slot/2': 1})
    positions = [[1, 2, 3], [40, 17, 9], [5, 5, 5], [59, 29, 49], [30, 0, 0], [2, 28, 40]]
    residual = [0.4, -0.0119, 0.0031, -0.25, 0.1, -0.0063]
    q, threshold = max(map(abs, residual)) / 127, 2
    levels = [round(x / q) for x in residual]
    levels = [0 if abs(k) <= threshold else k for k in levels]
    absent = [[0, 0, 0], [41, 17, 9], [5, 5, 6], [60, 0, 0], [-1, 4, 4]]
    expected = {
        'q': q, 'count': sum(k != 0 for k in levels), 'quantised': levels, 'decoded': [q * k for k in levels],
        'decoded_absent': [0.0] * len(absent), 'max_abs_error': max(abs(q * k - x) for k, x in zip(levels, residual))
    }
    wrong = {
        '/expected/q': 10 * 1e-12 * q, '/expected/count': 1, '/expected/quantised/1': 1, '/expected/decoded/0': 1e-11,
        '/expected/decoded_absent/2': 1e-11, '/expected/max_abs_error': 1e-10
    }
    file.add(
        'hash_round_trip', {
            'input': {
                'domain': [60, 30, 50], 'threshold': threshold, 'positions': positions, 'residual': residual, 'absent_positions': absent
            }, 'expected': expected, 'rtol': 1e-12, 'atol': 1e-15
        }, wrong)


def make():
    for kinds in (harmonic_kinds, source_kinds, march_kinds, collocation, transport_kinds, ball, other_kinds):
        kinds()
    file.write()


if __name__ == '__main__':
    make()
