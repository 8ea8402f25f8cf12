"""Gaussian fog under point lights by quadrature with 30 digits, in the form of the definitions: no closed form but that of one Gaussian's
depth along a line, by erf."""
from mpmath import cos, e1, erf, exp, expj, legendre, mpf, pi, quad, sqrt, tan

from common import File, relative


def norm(v):
    return sqrt(sum(x * x for x in v))


def away(a, b):
    return [y - x for x, y in zip(a, b)]


def along(o, r, t):
    return [x + t * y for x, y in zip(o, r)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def line_integral(g, o, r, d):
    """Integral of c exp(-a^2 |x - b|^2) over 0 < t < d."""
    a, c, b = mpf(g['a']), mpf(g['c']), [mpf(x) for x in g['b']]
    m = dot(away(o, b), r)
    square = dot(away(o, b), away(o, b)) - m * m
    return c * sqrt(pi) / (2 * a) * exp(-a * a * square) * (erf(a * (d - m)) + erf(a * m))


def depth(medium, p, q):
    d = norm(away(p, q))
    r = [x / d for x in away(p, q)]
    return mpf(medium['beta0']) * d + sum(line_integral(g, p, r, d) for g in medium['gaussians'])


def density(medium, x):
    return mpf(medium['beta0']) + sum(g['c'] * exp(-mpf(g['a'])**2 * dot(away(g['b'], x), away(g['b'], x))) for g in medium['gaussians'])


def airlight(medium, light, view, r, end):
    def term(t):
        x = along(view, r, t)
        return density(medium, x) * exp(-depth(medium, view, x) - depth(medium, x, light)) / (4 * pi * dot(away(x, light), away(x, light)))

    return quad(term, [mpf('1e-20')] + [end * mpf(i) / 8 for i in range(1, 9)])


def paper(medium, light, view, r, end):
    """Eqs. 8 to 17 of the paper, of a medium without a constant."""
    total = mpf(0)
    for g in medium['gaussians']:
        alone = {'beta0': 0, 'gaussians': [g]}
        x = along(view, r, min(max(dot(away(view, g['b']), r), 0), end))
        e = -depth(medium, light, g['b']) - depth(medium, view, g['b']) + depth(alone, light, g['b']) + depth(alone, view, g['b'])
        e -= depth(alone, light, x) + depth(alone, view, x)
        total += line_integral(g, view, r, end) * exp(e) / (4 * pi * dot(away(x, light), away(x, light)))
    return total


def digits(x):
    return format(float(x), '.17g')


def npsf(gamma, t):
    """t e^t times the airlight of an infinite ray at an angle gamma from a light at the optical distance t."""
    gamma, t = mpf(gamma), mpf(t)
    foot = max(t * cos(gamma), t / 2)
    return t * quad(lambda s: exp(t - s - sqrt(t * t + s * s - 2 * t * s * cos(gamma))) /
                    (t * t + s * s - 2 * t * s * cos(gamma)), [0, foot, 2 * foot, 5 * foot, 5 * foot + 4, 20, 60]) / (4 * pi)


def npsf_coefficient(band, t):
    """Coefficient of the zonal harmonic. The integral along the ray is e^z E1(z) here."""
    def term(x):
        z = t * (1 - expj(x))
        return (exp(z) * e1(z)).imag * legendre(band, cos(x))

    return sqrt(mpf(2 * band + 1) / (4 * pi)) * quad(term, [mpf('1e-30'), 0.01, 0.1, 0.5, 1.5, pi])


def make():
    file = File('fogshop', format='airlight-fogshop-vectors-1')
    fog = {'gaussians': [{'a': 1.1, 'c': 0.7, 'b': [0.5, -0.25, 3]}, {'a': 0.6, 'c': 0.4, 'b': [-1, 0.75, 5]}], 'beta0': 0.0}
    even = dict(fog, beta0=0.0625)
    view, way, light = [0.25, -0.5, 0], [0.5, 0.25, 2], [2, 3, 4.5]
    r = [mpf(x) / norm([mpf(y) for y in way]) for x in way]
    start = [mpf(x) for x in view]
    one = fog['gaussians'][0]

    def add(kind, inputs, value, tolerance=1e-12):
        vector = {'in': inputs, 'value': digits(value)}
        file.add(kind, vector, relative(vector, tolerance, '/value'))

    for d in (1.5, 40.0):
        add('line_integral', {**one, 'o': view, 'dir': way, 'd': d},
            quad(lambda t: density({'beta0': 0, 'gaussians': [one]}, along(start, r, t)), [0, min(d, 3), min(d, 10), d]))
    add('depth', {**even, 'p': view, 'q': [2, 1, 9]},
        quad(lambda t: density(even, along(start, away(start, [2, 1, 9]), t)), [0, 0.3, 0.6, 1]) * norm(away(start, [2, 1, 9])))
    for u, v in ((0.35, 1.2), (3.0, 1.45)):
        add('F', {'u': u, 'v': v}, quad(lambda x: exp(-mpf(u) * tan(x)), [0, v / 2, v]))
    for gamma, d_sv, d_vp, beta in ((0.8, 3.0, 4.0, 0.25), (2.5, 0.75, 1.5, 1.25)):

        def term(t):
            d = sqrt(mpf(d_sv)**2 + t * t - 2 * d_sv * t * cos(mpf(gamma)))
            return beta * exp(-beta * (t + d)) / (4 * pi * d * d)

        add('airlight_homogeneous', {'gamma': gamma, 'd_sv': d_sv, 'd_vp': d_vp, 'beta': beta}, quad(term, [0, d_vp / 2, d_vp]))
    for medium in (fog, even):
        shot = {**medium, 'light': light, 'I0': 2.5, 'view': view, 'dir': way, 'd_r': 7.0}
        add('airlight_scene', shot, mpf(2.5) * airlight(medium, light, start, r, 7), 1e-9)
    add('airlight_paper', {**fog, 'light': light, 'I0': 2.5, 'view': view, 'dir': way, 'd_r': 7.0},
        mpf(2.5) * paper(fog, light, start, r, 7))
    for u in (0.6, 2.75):
        # Eq. 20 of the paper: the depth through a Gaussian, averaged over the directions with its own weights.
        add('avg_depth', {'u': u}, sqrt(pi) / 2 * exp(-mpf(u)**2) * quad(lambda x: exp(x * x), [0, u]) / u)
    for gamma, t in ((0.7, 1.0), (2.0, 0.4)):
        add('npsf', {'gamma': gamma, 'T': t}, npsf(gamma, t))
    for band, t in ((2, 1.0), (3, 0.5)):
        add('npsf_coef', {'l': band, 'T': t}, npsf_coefficient(band, mpf(t)))
    file.write()


if __name__ == '__main__':
    make()
