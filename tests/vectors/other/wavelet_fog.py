"""B-splines, filters and maps by fractions: splines by recursion, projections by Gram matrices, depths by Gauss rules between breaks."""
from fractions import Fraction as Q
from math import ceil, comb, floor

from mpmath import exp, expm1, mp, mpf, sqrt

from common import File, absolute, relative

file = File('wavelet_fog', format='airlight-wavelet-fog-1')
# The filters of Cohen, Daubechies and Feauveau: (first, taps) of p, q, p~, q~. Assertions below check that they belong together.
FAMILIES = {
    'haar': (0, (0, [1, 1]), (0, [1, -1]), (0, [Q(1, 2)] * 2), (0, [Q(1, 2), Q(-1, 2)])),
    'cdf22': (1, (0, [Q(1, 2), 1, Q(1, 2)]), (-2, [Q(c, 8) for c in (-1, -2, 6, -2, -1)]), (-1, [Q(c, 8) for c in (-1, 2, 6, 2, -1)]),
              (-1, [Q(-1, 2), 1, Q(-1, 2)])),
    'cdf33': (2, (0, [Q(c, 4) for c in (1, 3, 3, 1)]), (-2, [Q(c, 64) for c in (3, 9, -7, -45, 45, 7, -9, -3)]),
              (-2, [Q(c, 64) for c in (3, -9, -7, 45, 45, -7, -9, 3)]), (0, [Q(c, 4) for c in (1, -3, 3, -1)]))
}


def spline(n, u):
    """The cardinal one of degree n with support [0, n + 1)."""
    if n == 0:
        return u * 0 + 1 if 0 <= u < 1 else u * 0
    return (u * spline(n - 1, u) + (n + 1 - u) * spline(n - 1, u - 1)) / n


def two_scale(n):
    return [Q(comb(n + 1, k), 2**n) for k in range(n + 2)]


def down(c, filter_):
    """Sequences are {index: value}; values at even steps of the correlation."""
    first, taps = filter_
    out = {}
    for i, v in c.items():
        for j, t in enumerate(taps):
            k, odd = divmod(i - first - j, 2)
            if not odd:
                out[k] = out.get(k, 0) + t * v
    return out


def up(a, filter_):
    first, taps = filter_
    out = {}
    for k, v in a.items():
        for j, t in enumerate(taps):
            out[2 * k + first + j] = out.get(2 * k + first + j, 0) + t * v
    return out


def down_2d(c, across, along):
    """{(i, j): value}, i along x."""
    rows = {}
    for (i, j), v in c.items():
        rows.setdefault(j, {})[i] = v
    columns = {}
    for j, row in rows.items():
        for i, v in down(row, across).items():
            columns.setdefault(i, {})[j] = v
    return {(i, k): v for i, column in columns.items() for k, v in down(column, along).items()}


def listed(c):
    lo, hi = min(c), max(c)
    return {'lo': lo, 'values': [float(c.get(i, 0)) for i in range(lo, hi + 1)]}


def grid(c):
    lo = [min(k[a] for k in c) for a in (0, 1)]
    size = [max(k[a] for k in c) - lo[a] + 1 for a in (0, 1)]
    return {
        'lo': lo, 'width': size[0], 'height': size[1],
        'values': [float(c.get((lo[0] + i, lo[1] + j), 0)) for j in range(size[1]) for i in range(size[0])]
    }


def solve(matrix, right):
    n = len(right)
    rows = [list(r) + [b] for r, b in zip(matrix, right)]
    for i in range(n):
        pivot = next(k for k in range(i, n) if rows[k][i] != 0)
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for k in range(n):
            if k != i and rows[k][i] != 0:
                rows[k] = [x - rows[k][i] * y for x, y in zip(rows[k], rows[i])]
    return [r[n] for r in rows]


def projected(c, n):
    """On the coarse splines whose support meets that of the fine ones."""
    lo, hi = min(c), max(c) + n + 1
    indices = range(floor(Q(lo, 2)) - n, ceil(Q(hi, 2)))
    inner = lambda shift: spline(2 * n + 1, Q(n + 1 + shift))
    gram = [[2 * inner(k - l) for l in indices] for k in indices]
    p = two_scale(n)
    right = [sum(p[m] * inner(2 * k + m - i) * v for m in range(n + 2) for i, v in c.items()) for k in indices]
    return dict(zip(indices, solve(gram, right)))


def profile_value(profile, z):
    if profile['type'] == 'exp':
        return exp(-max(mpf(0), z - mpf(profile['z0'])) / mpf(profile['H']))
    if profile['type'] == 'layers':
        zs, vs = profile['z'], profile['v']
        if z <= zs[0] or z >= zs[-1]:
            return mpf(vs[0] if z <= zs[0] else vs[-1])
        i = max(k for k in range(len(zs) - 1) if zs[k] <= z)
        return vs[i] + (vs[i + 1] - vs[i]) * (z - zs[i]) / mpf(zs[i + 1] - zs[i])
    return mpf(1)


def depth(v, c, level=0, part=(0, 1)):
    """Optical depth of coefficients {(i, j): value} with cells 2^level times as large, over a part of the segment."""
    a, b = [[mpf(x) for x in v[k]] for k in 'AB']
    cell = mpf(v['cell']) * 2**level
    start = [(a[k] - mpf(v['origin'][k])) / cell for k in (0, 1)]
    step = [(b[k] - a[k]) / cell for k in (0, 1)]
    breaks = {mpf(t) for t in part}
    for k in (0, 1):
        if step[k]:
            ends = sorted((start[k], start[k] + step[k]))
            breaks |= {(i - start[k]) / step[k] for i in range(ceil(ends[0]), floor(ends[1]) + 1)}
    for z in v['profile'].get('z', [v['profile'].get('z0', 0)]):
        if b[2] != a[2]:
            breaks.add((z - a[2]) / (b[2] - a[2]))
    breaks = sorted(t for t in breaks if part[0] <= t <= part[1])
    n, total = v['degree'], mpf(0)

    def value(t):
        u, w = start[0] + t * step[0], start[1] + t * step[1]
        near = [(i, j) for i in range(floor(u) - n, floor(u) + 1) for j in range(floor(w) - n, floor(w) + 1) if (i, j) in c]
        return sum(c[k] * spline(n, u - k[0]) * spline(n, w - k[1]) for k in near) * profile_value(v['profile'], a[2] + t * (b[2] - a[2]))

    for lo, hi in zip(breaks, breaks[1:]):
        total += mp.quad(value, [lo, hi], method='gauss-legendre', maxdegree=4)
    return mpf(v['sigma']) * sqrt(sum((x - y)**2 for x, y in zip(a, b))) * total


def map_of(v):
    return {(i, j): mpf(v['coef'][j * v['width'] + i]) for i in range(v['width']) for j in range(v['height'])}


def text(x):
    return format(float(x), '.17g')


def make():
    for n in range(4):
        # q_k = (-1)^k 2^-n sum_l C(n + 1, l) N_{2n+1}(k + 1 - l).
        q = [(-1)**k * sum(comb(n + 1, l) * spline(2 * n + 1, Q(k + 1 - l)) for l in range(n + 2)) / 2**n for k in range(3 * n + 2)]
        vector = {
            'degree': n, 'p': [float(x) for x in two_scale(n)], 'p_offset': 0, 'chui_wang_q': [float(x) for x in q],
            'chui_wang_q_offset': 0, 'restriction': [float(x / 2) for x in two_scale(n)], 'restriction_offset': 0
        }
        file.add('sequence', vector, {'/p/0': 1e-14, f'/chui_wang_q/{3 * n + 1}': 1e-13, '/restriction/1': 1e-13, '/p_offset': 1})
        u = [Q(5, 16), Q(23, 16), Q(21, 8), Q(57, 16), Q(5)]
        vector = {'degree': n, 'u': [float(x) for x in u], 'expected': [float(spline(n, x)) for x in u]}
        file.add('basis', vector, absolute(2e-15, '/expected/0', '/expected/3'))
    c = {i - 2: Q(v, 8) for i, v in enumerate((3, 10, 0, 7, -5, 12, 1, 9, 4, 2))}
    plane = {(i, j): Q((7 * i + 5 * j * j) % 16, 8) for i in range(5) for j in range(3)}
    for name, (n, p, q, p_down, q_down) in FAMILIES.items():
        back = up(down(c, p_down), p)
        for i, v in up(down(c, q_down), q).items():
            back[i] = back.get(i, 0) + v
        assert {i: v for i, v in back.items() if v} == {i: v for i, v in c.items() if v}, name
        vector = {
            'degree': n, 'family': name, **{
                k: [float(x) for x in f[1]] for k, f in zip(('p', 'q', 'p_tilde', 'q_tilde'), (p, q, p_down, q_down))
            }, 'offsets': [f[0] for f in (p, q, p_down, q_down)]
        }
        file.add('family', vector, {'/q/0': 1e-14, '/p_tilde/1': 1e-13, '/offsets/3': 1})
        coarse, details = c, []
        for _ in range(3):
            details.append(listed(down(coarse, q_down)))
            coarse = down(coarse, p_down)
        vector = {'family': name, 'levels': 3, 'c': listed(c), 'expected': {'a': listed(coarse), 'd': details}}
        file.add('analysis1d', vector, {'/expected/a/values/0': 2e-13, '/expected/d/1/values/1': 2e-13})
        bands = {
            k: grid(down_2d(plane, x, y))
            for k, x, y in (('aa', p_down, p_down), ('ad', p_down, q_down), ('da', q_down, p_down), ('dd', q_down, q_down))
        }
        file.add('analysis2d', {'family': name, 'levels': 1, 'c': grid(plane), 'expected': bands},
                 {f'/expected/{k}/values/1': 2e-13 for k in bands})
    for n in range(4):
        file.add('restrict1d', {'degree': n, 'c': listed(c), 'expected': {'a': listed(down(c, (0, [x / 2 for x in two_scale(n)])))}},
                 {'/expected/a/values/2': 2e-13})
        file.add('l2proj1d', {'degree': n, 'c': listed(c), 'expected': {'a': listed(projected(c, n))}}, {'/expected/a/values/2': 2e-13})
    for n, profile in ((0, {'type': 'none'}), (2, {'type': 'layers', 'z': [0.5, 2.0, 3.5],
                                                   'v': [1.0, 0.25, 0.5]}), (3, {'type': 'exp', 'z0': 1.25, 'H': 1.5})):
        v = {
            'degree': n, 'width': 4, 'height': 3, 'coef': [((5 * k * k + 3) % 11) / 8 for k in range(12)], 'origin': [2.0, -1.0],
            'cell': 0.75, 'sigma': 0.875, 'profile': profile, 'A': [1.25, -0.5, 4.25], 'B': [6.5, 2.875, 0.25], 'rtol_f64': 1e-13
        }
        tau = depth(v, map_of(v))
        v['expected'] = {'optical_depth': text(tau), 'transmittance': text(exp(-tau)), 'opacity': text(-expm1(-tau))}
        file.add('optical_depth', v,
                 relative(v, 1e-13, '/expected/optical_depth', '/expected/opacity') | relative(v, 2e-13, '/expected/transmittance'))
    for name, mu in (('cdf22', 0.75), ('cdf33', 0.5), ('restrict', 0.25), ('haar', 0.6)):
        n = {'restrict': 1}.get(name) if name == 'restrict' else FAMILIES[name][0]
        v = {
            'family': name, 'degree': n, 'levels': 2, 'mu': mu, 'width': 5, 'height': 7,
            'coef': [((3 * k * k + 5 * k) % 13) / 8 for k in range(35)], 'origin': [-1.0, 0.5], 'cell': 1.25, 'sigma': 0.625,
            'profile': {'type': 'none'}, 'A': [0.375, 1.75, 0.0], 'B': [4.75, 8.125, 1.0], 'rtol_f64': 1e-12
        }
        analysis = (0, [x / 2 for x in two_scale(1)]) if name == 'restrict' else FAMILIES[name][3]
        levels = [map_of(v)]
        for _ in range(2):
            levels.append({
                k: mpf(c) for k, c in down_2d(
                    levels[-1], *[(analysis[0], [mpf(t.numerator) / t.denominator if isinstance(t, Q) else t
                                                 for t in analysis[1]])] * 2).items()
            })
        # Both ends lie in the box of every level: one grid at a time, the finest nearest.
        near, far = mpf(mu)**2, mpf(mu)
        paper = depth(v, levels[0], 0, (0, near)) + depth(v, levels[1], 1, (near, far)) + depth(v, levels[2], 2, (far, 1))
        v['expected'] = {'optical_depth': text(paper), 'full_optical_depth': text(depth(v, levels[0]))}
        file.add('multires', v, relative(v, 1e-12, '/expected/optical_depth', '/expected/full_optical_depth'))
    tau, behind, fog = mpf('1.375'), mpf('0.625'), mpf('0.25')
    v = {
        'optical_depth': '1.375', 'L_P': 0.625, 'L_fog': 0.25,
        'expected': {'transmittance': text(exp(-tau)), 'L': text(exp(-tau) * behind - expm1(-tau) * fog)}
    }
    file.add('composite', v, relative(v, 1e-15, '/expected/transmittance', '/expected/L'))
    # The change makes a refused input valid: then it must not be refused.
    file.add('reject', {'degree': 2, 'width': 2, 'height': 3, 'coef': [1, 0.5, 0, 2, -0.125, 1], 'expected': 'error'}, {'/coef/4': 1})
    file.add(
        'reject', {
            'family': 'cdf22', 'degree': 1, 'levels': 2, 'mu': 1.5, 'width': 4, 'height': 5, 'coef': [1] * 20, 'profile': {'type': 'none'},
            'expected': 'error'
        }, {'/mu': -1})
    file.write()


if __name__ == '__main__':
    make()
