"""Orthonormal Legendre polynomials in a box by Gauss quadrature on the grid of their products; fluids by the null space of the divergence;
light by quadrature along rays."""
import itertools
from math import exp, pi, sqrt

import numpy as np
from numpy.polynomial import chebyshev, legendre
from scipy.linalg import block_diag, expm, null_space

from common import File

file = File('legendre_fluids', topic='legendre_fluids')
random = np.random.default_rng(7)


def values(n, x, slope=0):
    """L_0 to L_{n-1} at x, or their derivatives: n x len(x)."""
    return np.array([sqrt((2 * k + 1) / 2) * legendre.legval(x, legendre.legder([0] * k + [1], slope)) for k in range(n)])


def integrals(n, x):
    """Integrals of L_1 to L_{n-1} from -1."""
    return np.array([sqrt((2 * k + 1) / 2) * legendre.legval(x, legendre.legint([0] * k + [1], lbnd=-1)) for k in range(1, n)])


def outer(parts):
    """Products of one function for each axis, at the products of the points of each axis."""
    out = parts[0]
    for p in parts[1:]:
        out = np.einsum('ax,by->abxy', out, p).reshape(out.shape[0] * p.shape[0], -1)
    return out


class Space:
    def __init__(self, d, n):
        self.d, self.n = d, n
        x, w = legendre.leggauss(2 * n + 3)
        self.weight = outer([w[None]] * d)[0]
        self.scalar = outer([values(n, x)] * d)
        self.scalar_slope = [outer([values(n, x, int(a == b)) for a in range(d)]) for b in range(d)]
        self.parts = [outer([integrals(n, x) if a == c else values(n, x) for a in range(d)]) for c in range(d)]
        self.slopes = [[
            outer([(values(n, x)[1:] if a == b else integrals(n, x)) if a == c else values(n, x, int(a == b)) for a in range(d)])
            for b in range(d)
        ] for c in range(d)]
        self.mass = block_diag(*[p * self.weight @ p.T for p in self.parts])
        self.stiffness = block_diag(*[sum(s * self.weight @ s.T for s in self.slopes[c]) for c in range(d)])
        self.div = np.hstack([self.scalar * self.weight @ self.slopes[c][c].T for c in range(d)])
        free = null_space(self.div)
        self.projection = free @ np.linalg.solve(free.T @ self.mass @ free, free.T @ self.mass)
        self.sizes = [len(p) for p in self.parts]

    def split(self, u):
        return np.split(u, np.cumsum(self.sizes)[:-1])

    def at(self, u):
        return [c @ p for c, p in zip(self.split(u), self.parts)]

    def advected(self, w, u):
        """-(w.grad) u, tested with every function of the space."""
        moved = [-sum(wb * (c @ self.slopes[a][b]) for b, wb in enumerate(self.at(w))) for a, c in enumerate(self.split(u))]
        return np.linalg.solve(self.mass, np.concatenate([p @ (self.weight * m) for p, m in zip(self.parts, moved)]))

    def carried(self, w, r):
        return self.scalar @ (self.weight * -sum(wb * (r @ s) for wb, s in zip(self.at(w), self.scalar_slope)))

    def energy(self, u):
        return u @ self.mass @ u / 2

    def named(self, u, before='', after=''):
        shape = lambda a: [self.n - (b == a) for b in range(self.d)]
        return {before + 'abc'[a] + after: c.reshape(shape(a)) for a, c in enumerate(self.split(u))}

    def shaped(self, r):
        return r.reshape([self.n] * self.d)

    def random_flow(self):
        return self.projection @ self.random_field()

    def random_field(self):
        return np.round(random.normal(size=sum(self.sizes)) / 4, 3)


def rk4(u, dt, rate):
    k1 = rate(u)
    k2 = rate(u + dt / 2 * k1)
    k3 = rate(u + dt / 2 * k2)
    return u + dt / 6 * (k1 + 2 * k2 + 2 * k3 + rate(u + dt * k3))


def add(kind, vector, arrays=(), numbers=(), **wrong):
    """Arrays are compared to 1e-12 of their largest entry, numbers to 1e-12 of themselves and of 1."""
    vector = {k: x.tolist() if isinstance(x, np.ndarray) else x for k, x in vector.items()}
    moved = {}
    for name in arrays:
        entries = np.array(vector[name])
        first = ''.join('/0' for _ in entries.shape)
        moved[f'/{name}{first}'] = 10 * 1e-12 * abs(entries).max()
    for name in numbers:
        moved['/' + name] = 10 * 1e-12 * (abs(float(vector[name])) + 1)
    file.add(kind, vector, moved | wrong)


def basis_kinds():
    for n in (5, 9):
        x, w = legendre.leggauss(n + 2)
        add('derivative', {'n': n, 'D[k][i]': values(n, x) * w @ values(n, x, 1).T}, ['D[k][i]'])
        every = np.array([sqrt((2 * k + 1) / 2) * legendre.legval(x, legendre.legint([0] * k + [1], lbnd=-1)) for k in range(n)])
        add('integral', {'n': n, 'B[k][i]': values(n + 1, x) * w @ every.T}, ['B[k][i]'])
    x, w = legendre.leggauss(40)
    L, slope = values(30, x), values(30, x, 1)
    every = np.array([sqrt((2 * k + 1) / 2) * legendre.legval(x, legendre.legint([0] * k + [1], lbnd=-1)) for k in range(30)])
    pairs = [(20, 19), (21, 6), (7, 2), (8, 8)]
    entries = [{'i': i, 'k': k, 'c': L[k] * w @ slope[i]} for i, k in pairs]
    add('derivative-samples', {'entries': entries}, **{f'/entries/{e}/c': 1e-11 * (1 + abs(entries[e]['c'])) for e in (0, 3)})
    entries = [{'i': i, 'k': k, 'b': L[k] * w @ every[i]} for i, k in ((20, 21), (13, 12), (0, 0), (5, 9))]
    add('integral-samples', {'entries': entries}, **{f'/entries/{e}/b': 2e-11 for e in (0, 3)})
    entries = [{'i': i, 'j': j, 'k': k, 'TI': L[i] * L[j] * w @ L[k]}
               for i, j, k in ((1, 2, 3), (5, 7, 10), (9, 9, 4), (2, 3, 6), (20, 11, 17))]
    add('triple', {'entries': entries}, **{f'/entries/{e}/TI': 2e-11 for e in (1, 3)})
    counts = [{'n': n, 'nonzero': int((abs(np.einsum('ax,bx,cx,x->abc', L[:n], L[:n], L[:n], w)) > 1e-11).sum())} for n in (3, 5, 10)]
    add('triple-count', {'entries': counts}, **{'/entries/1/nonzero': 1})

    def economized(n):
        """Coefficients of 2n - 1 polynomials L as n: their series in Chebyshev polynomials without all beyond."""
        columns = []
        for k in range(2 * n - 1):
            c = chebyshev.poly2cheb(legendre.leg2poly([0] * k + [sqrt((2 * k + 1) / 2)]))[:n]
            low = legendre.poly2leg(chebyshev.cheb2poly(c))
            columns.append(np.pad(low, (0, n - len(low))) / [sqrt((2 * i + 1) / 2) for i in range(n)])
        return np.array(columns).T

    for n in (3, 6):
        add('truncation', {'n': n, 'm': 2 * n - 1, 'T': economized(n)}, ['T'])
    x, w = legendre.leggauss(20)
    for n in (3, 7):
        M = integrals(n, x) * w @ integrals(n, x).T
        eigenvalues = np.linalg.eigvalsh(M)
        add('phi-mass', {'n': n, 'M': M, 'eigenvalues': eigenvalues}, ['M'], **{'/eigenvalues/0': 1e-11 * eigenvalues[0]})
    for d, n in ((1, 4), (2, 3), (3, 3)):
        F, G = np.round(random.normal(size=(2, n**d)), 3)
        x, w = legendre.leggauss(2 * n + 2)
        weight, low, high = outer([w[None]] * d)[0], outer([values(n, x)] * d), outer([values(2 * n - 1, x)] * d)
        product = weight * (F @ low) * (G @ low)
        H = (high @ product).reshape([2 * n - 1] * d)
        cut = H
        for a in range(d):
            cut = np.moveaxis(np.tensordot(economized(n), cut, (1, a)), 0, a)
        shape = [n] * d
        add('product', {
            'd': d, 'F': F.reshape(shape), 'G': G.reshape(shape), 'H': H, 'H_trunc_cheb': cut, 'H_trunc_l2': (low @ product).reshape(shape)
        }, ['H', 'H_trunc_cheb', 'H_trunc_l2'])


def fluid_kinds():
    for d, n in ((2, 5), (3, 3)):
        s = Space(d, n)
        head = {'d': d, 'n': n}

        def projection(u):
            p = s.projection @ u
            return {
                **s.named(p, after='_proj'), 'energy_before': s.energy(u), 'energy_after': s.energy(p), 'div_before': s.shaped(s.div @ u),
                'div_norm_before': np.linalg.norm(s.div @ u)
            }

        u = s.random_field()
        add('project', {**head, **s.named(u), **projection(u)}, ['b_proj', 'div_before'],
            ['energy_before', 'energy_after', 'div_norm_before'])
        # x (1 - x^2) y^2 and so on, of which every component is 0 on its own walls.
        field, terms = [], []
        for a in range(d):
            one = []
            for c, powers in ((0.75 - a, [0, 1, 2]), (1.25, [1, 2, 0])):
                own = powers[:d] + [0] * (3 - d)
                squared = list(own)
                squared[a] += 2
                one += [{'c': c, 'powers': own}, {'c': -c, 'powers': squared}]
            field.append(one)
        x, w = legendre.leggauss(2 * n + 3)
        grid = np.array([outer([x[None] if a == b else np.ones((1, len(x))) for b in range(d)])[0] for a in range(d)])
        at = [sum(t['c'] * np.prod([grid[b]**t['powers'][b] for b in range(d)], axis=0) for t in one) for one in field]
        u = np.linalg.solve(s.mass, np.concatenate([p @ (s.weight * f) for p, f in zip(s.parts, at)]))
        if n >= 4:
            add('coefficients', {**head, 'field': field, **s.named(u), **projection(u)}, ['b', 'a_proj'],
                ['energy_before', 'energy_after'])
        u, r = s.random_field(), np.round(random.normal(size=n**d), 3)
        points = []
        for place in np.round(random.uniform(-1, 1, (2, d)), 3):
            one = lambda c, a, b: outer([(integrals(n, place[[k]]) if b != k else values(n, place[[k]])[1:])
                                         if k == c else values(n, place[[k]], int(b == k)) for k in range(d)])[:, 0]
            coefficients = s.split(u)
            # Lists of three: without a third axis, zeros.
            pad = lambda v: [*map(float, v), *[0.0] * (3 - d)]
            points.append({
                'x': pad(place), 'u': pad([coefficients[a] @ one(a, a, None) for a in range(d)]),
                'grad_u': [pad([coefficients[a] @ one(a, a, b) for b in range(d)]) for a in range(d)],
                'r': float(r @ one(None, None, None)), 'grad_r': pad([r @ one(None, None, b) for b in range(d)])
            })
        most = lambda name: 1e-11 * max(map(abs, points[1][name]))
        add(
            'evaluate', {**head, **s.named(u), 'r': s.shaped(r), 'points': points}, **{
                             '/points/1/u/0': most('u'), '/points/0/r': 1e-11 * (1 + abs(points[0]['r'])),
                             '/points/1/grad_r/1': most('grad_r'), '/points/1/grad_u/0/1': 1e-11 * np.abs(points[1]['grad_u']).max()
                         })
        w, u = s.random_flow(), s.random_flow()
        rate = s.advected(w, u)
        add('advect',
            {**head, **s.named(w, 'w_'), **s.named(u), **s.named(rate, 'rhs_unprojected_'), **s.named(s.projection @ rate, 'rhs_')},
            ['rhs_unprojected_a', 'rhs_b'])
        amount = 0.035
        slow = expm(-amount * np.linalg.solve(s.mass, s.stiffness)) @ u
        implicit = np.linalg.solve(s.mass + amount * s.stiffness, s.mass @ u)
        add(
            'diffuse', {
                **head, 'nu_dt': amount, **s.named(u), **s.named(slow, 'exp_'),
                **s.named(implicit, 'implicit_'), 'energy_before': s.energy(u), 'energy_exp': s.energy(slow),
                'energy_implicit': s.energy(implicit)
            }, ['exp_a', 'implicit_b'], ['energy_before', 'energy_exp', 'energy_implicit'])
        dt, nu = 0.2, 0.05
        acceleration = lambda v: s.projection @ s.advected(v, v)
        after = rk4(u, dt, acceleration)
        add('rk4',
            {**head, 'dt': dt, **s.named(u), **s.named(after, after='_1'), 'energy_before': s.energy(u), 'energy_after': s.energy(after)},
            ['b_1'], ['energy_after'])
        half = s.projection @ expm(-nu * dt / 2 * np.linalg.solve(s.mass, s.stiffness))
        after = half @ rk4(half @ u, dt, acceleration)
        add(
            'step', {
                **head, 'nu': nu, 'dt': dt, **s.named(u), **s.named(after, after='_1'), 'energy_before': s.energy(u),
                'energy_after': s.energy(after)
            }, ['b_1'], ['energy_after'])
        next_ = rk4(r, dt, lambda now: s.carried(w, now))
        add(
            'density-advect', {
                **head, 'dt': dt, **s.named(w), 'r': s.shaped(r), 'rhs': s.shaped(s.carried(
                    w, r)), 'r_1': s.shaped(next_), 'mass_before': sqrt(2)**d * r[0], 'mass_after': sqrt(2)**d * next_[0],
                'l2_norm_before': np.linalg.norm(r), 'l2_norm_after': np.linalg.norm(next_)
            }, ['rhs', 'r_1'], ['mass_after', 'l2_norm_after'])
        w = s.random_field()
        squares = sum(v * v for v in s.at(u))
        divergence = (s.div @ w) @ s.scalar
        add(
            'energy-identity', {
                **head, **s.named(w, 'w_'), **s.named(u), 'r': s.shaped(r), 'energy_u': s.energy(u), 'energy_w': s.energy(w),
                'w_grad_u_dot_u': -u @ s.mass @ s.advected(w, u), 'minus_half_div_w_u2': -s.weight @ (divergence * squares) / 2,
                'w_grad_r_times_r': -s.carried(w, r) @ r, 'w_grad_r_integral': -sqrt(2)**d * s.carried(w, r)[0],
                'w_projected_energy': s.energy(s.projection @ w), 'gradient_energy_u': u @ s.stiffness @ u
            }, [], [
                'energy_w', 'w_grad_u_dot_u', 'minus_half_div_w_u2', 'w_grad_r_times_r', 'w_grad_r_integral', 'w_projected_energy',
                'gradient_energy_u'
            ])
    nu, t = 0.07, 0.4
    fall = exp(-2 * pi**2 * nu * t)
    points = [{'x': [x, y], 'u': [fall * np.sin(pi * x) * np.cos(pi * y), -fall * np.cos(pi * x) * np.sin(pi * y)]}
              for x, y in ((0.35, -0.6), (-0.15, 0.85))]
    file.add('taylor-green', {'nu': nu, 't': t, 'energy': fall**2, 'points': points},
             {'/energy': 2e-8 * fall**2, '/points/0/u/0': 2e-8, '/points/1/u/1': 2e-8})


def hg(g, c):
    return (1 - g * g) / (1 + g * g - 2 * g * c)**1.5 / (4 * pi)


def density_at(R, x):
    """x: 3 x n."""
    return np.einsum('ijk,in,jn,kn->n', R, *[values(R.shape[a], x[a]) for a in range(3)])


def column(R, x, way, end):
    """Integral of the density from x along a direction, up to a distance, by a rule that is exact."""
    node, weight = legendre.leggauss(sum(R.shape))
    s = end * (node + 1) / 2
    return end / 2 * weight @ density_at(R, x[:, None] + way[:, None] * s)


def light_kinds():
    # The light comes from above, along -y, and the eye looks along -x: both leave by one face each.
    down, view = np.array([0.0, -1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    R = np.round(random.normal(size=(3, 4, 2)) / 40, 4)
    R[0, 0, 0] = 2.5
    sigma, beta, g, arriving = 1.2, 0.9, 0.35, 2.0
    common = {'d': 3, 'R': R, 'omega_d': down.tolist(), 'omega_s': view.tolist(), 'sigma': sigma, 'beta': beta, 'g': g, 'E_in': arriving}
    node, weight = legendre.leggauss(40)

    def scattered(x, end):
        """Along -view from x, where the light leaves the box or ends."""
        total = 0
        for s, w in zip(end * (node + 1) / 2, weight * end / 2):
            p = x - s * view
            lit = arriving * exp(-sigma * column(R, p, -down, 1 - p[1]))
            total += w * beta * density_at(R, p[:, None])[0] * hg(g, down @ view) * lit * exp(-sigma * column(R, x, -view, s))
        return total

    points = []
    for x in ([1.0, 0.3, -0.4], [0.25, -0.75, 0.6]):
        x = np.array(x)
        depth = sigma * column(R, x, -down, 1 - x[1])
        points.append({'x': x.tolist(), 'tau_d': depth, 'E_d': arriving * exp(-depth), 'E_s': scattered(x, x[0] + 1)})
    wrong = {f'/points/{i}/{k}': 10 * 1e-12 * abs(points[i][k]) + 2e-12 * (k == 'tau_d') for i in (0, 1) for k in ('tau_d', 'E_d', 'E_s')}
    add('scatter', {**common, 'points': points}, **wrong)
    pixels = []
    for x, end, behind in (([1.0, -0.2, 0.5], 1.25, 0.75), ([1.0, 0.6, -0.9], 2.0, 0.3)):
        x = np.array(x)
        depth = sigma * column(R, x, -view, end)
        air = scattered(x, end)
        pixels.append({
            'x': x.tolist(), 'depth': end, 'background': behind, 'tau_view': depth, 'attenuated': behind * exp(-depth), 'airlight': air,
            'total': behind * exp(-depth) + air
        })
    add('airlight', {**common, 'pixels': pixels},
        **{f'/pixels/1/{k}': 1e-11 * pixels[1][k] for k in ('tau_view', 'attenuated', 'airlight', 'total')})
    u, v = [-0.7, 0.1, 0.65], [-0.35, 0.8]
    image = np.array([[scattered(np.array([1.0, a, b]), 2.0) for b in v] for a in u])
    add('image', {**common, 'face': {'axis': 0, 'side': 1}, 'u': u, 'v': v, 'E_s': image},
        **{'/E_s/2/1': 1e-11 * image[2, 1], '/E_s/0/0': 1e-11 * image[0, 0]})


def upwind():
    """(v, omega.grad E + sigma r E) + int over inflow of |omega.n| E v = (v, q) + int over inflow of |omega.n| E_in v."""
    for d, n, size in ((2, 5, 3), (3, 3, 2)):
        R = np.round(random.normal(size=[size] * d) / 30, 4)
        R.flat[0] = 2.25
        ways = [np.array(w[:d]) / np.linalg.norm(w[:d]) for w in ([0.6, -0.5, 0.3], [-0.2, 0.9, 0.4])]
        sigma, beta, g, arriving = 0.8, 0.5, -0.2, 1.5
        x, w = legendre.leggauss(n + size + 3)
        weight, B = outer([w[None]] * d)[0], outer([values(n, x)] * d)
        slopes = [outer([values(n, x, int(a == b)) for a in range(d)]) for b in range(d)]
        r = R.ravel() @ outer([values(size, x)] * d)

        def face(a, side):
            at = np.array([side])
            return outer([values(n, at) if b == a else values(n, x)
                          for b in range(d)]), outer([np.ones((1, 1)) if b == a else w[None] for b in range(d)])[0]

        def solved(way, source, light):
            matrix = B * weight @ (sum(c * s for c, s in zip(way, slopes)) + sigma * r * B).T
            right = B @ (weight * source)
            for a in range(d):
                f, fw = face(a, -np.sign(way[a]))
                matrix += abs(way[a]) * f * fw @ f.T
                right += abs(way[a]) * light * (f @ fw)
            return np.linalg.solve(matrix, right)

        direct = solved(ways[0], np.zeros(len(weight)), arriving)
        E = solved(ways[1], beta * hg(g, ways[0] @ ways[1]) * r * (direct @ B), 0)
        shape = [n] * d
        vector = {
            'd': d, 'n': n, 'R': R, 'omega_d': ways[0].tolist(), 'omega_s': ways[1].tolist(), 'sigma': sigma, 'beta': beta, 'g': g,
            'E_in': arriving, 'E_d_coeffs': direct.reshape(shape), 'E_s_coeffs': E.reshape(shape)
        }
        arrays = ['E_d_coeffs', 'E_s_coeffs']
        if d == 3:
            u, v = np.array([-0.5, 0.25, 0.9]), np.array([-0.8, 0.4])
            seen = E @ outer([values(n, u), values(n, np.array([1.0])), values(n, v)])
            vector |= {'face': {'axis': 1, 'side': 1}, 'u': u, 'v': v, 'E_s_image': seen.reshape(3, 2)}
            arrays.append('E_s_image')
        add('upwind-galerkin', vector, arrays)


def make():
    basis_kinds()
    fluid_kinds()
    light_kinds()
    upwind()
    file.write()


if __name__ == '__main__':
    make()
