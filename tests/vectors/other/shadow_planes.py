"""Light of a point light along a ray by quadrature in the distance, x, with 30 digits. Shadows are those of a rectangle, whose lit parts
are known without counting planes."""
from mpmath import atan, cos, exp, log10, mpf, pi, polyval, quad, sin, sqrt, tan, taylor

from common import File, absolute, relative
from fogshop import along, away, dot, norm


def phase(name, g, c):
    """Phase functions as printed: the mean over the sphere of the first two is not 1."""
    return {
        'hazy': lambda: 1 + 9 * ((1 + c) / 2)**8, 'murky': lambda: 1 + 50 * ((1 + c) / 2)**32, 'iso': lambda: mpf(1),
        'rayleigh': lambda: 3 * (1 + c * c) / 4, 'hg': lambda: (1 - g * g) / (1 + g * g - 2 * g * c)**1.5
    }[name]()


def scattered(k, foot, h, parts, p, dimmed=None, power=lambda d: mpf(1)):
    """Over the parts, lists of abscissae. A point's direction from the light is (h, x - foot) / r; the light turns by it to the eye."""
    def term(x):
        r = sqrt((x - foot)**2 + h * h)
        way = dimmed(x, r) if dimmed else x + r
        return power((h / r, (x - foot) / r)) * p(-(x - foot) / r) * exp(-k * way) / (r * r)

    return k / (4 * pi) * sum(quad(term, part) for part in parts)


def geometry(o, way, light):
    r = [mpf(x) / norm([mpf(y) for y in way]) for x in way]
    foot = dot(away(o, light), r)
    return r, foot, norm(away(along(o, r, foot), light))


def text(x):
    return format(float(x), '.17g')


def sphere_cut(o, r, center, radius):
    """Abscissae at which the ray is on the sphere."""
    m = dot(away(o, center), r)
    half = sqrt(radius**2 - dot(away(o, center), away(o, center)) + m * m)
    return m - half, m + half


def make():
    file = File('shadow_planes', format='airlight/shadow_planes/1')
    for k, albedo, intensity, foot, h, x0, x1, name, g in ((0.45, 0.75, 3.5, 2.5, 0.8, 0.5, 6, 'hazy', 0),
                                                           (1.25, 0.5, 2, -1.5, 2.25, 0, 4, 'hg', 0.35), (0.2, 1, 1, 3, 1.5, 0.25, 9,
                                                                                                          'rayleigh', 0)):
        value = albedo * intensity * scattered(mpf(k), mpf(foot), mpf(h), [[x0, foot, x1] if foot > x0 else [x0, x1]],
                                               lambda c: phase(name, mpf(g), c))
        numbers = {'k_t': k, 'albedo': albedo, 'intensity': intensity, 'T': foot, 'h': h, 'x0': x0, 'x1': x1}
        vector = {
            'input': {**{n: str(x) for n, x in numbers.items()}, 'phase': name, 'g': str(g)},
            'expect': {'L': text(value), 'log10_L': text(log10(value))}
        }
        file.add('airlight', vector, absolute(1e-13, '/expect/log10_L'))
    for name, g, a, degree in (('hazy', 0, 0.75, 7), ('hg', 0.25, 2.5, 5), ('murky', 0, 1.5, 4)):
        a = mpf(a)
        f = lambda t: exp(a - a * (1 + sin(t)) / cos(t)) * phase(name, mpf(g), -sin(t))
        c = taylor(f, 0, degree)
        vector = {'input': {'phase': name, 'g': str(g), 'a': str(a), 'degree': degree}, 'expect': {'c': [text(x) for x in c]}}
        most = max(abs(x) for x in c)
        file.add('taylor_coefficients', vector, absolute(1e-13 * float(most), '/expect/c/0', f'/expect/c/{degree}'))
        theta = mpf('-0.7'), mpf('0.55')
        polynomial = exp(-a) * quad(lambda t: polyval(c[::-1], t), theta)
        exact = exp(-a) * quad(f, [theta[0], 0, theta[1]])
        vector = {
            'input': {**vector['input'], 'theta0': text(theta[0]), 'theta1': text(theta[1])},
            'expect': {'J_poly': text(polynomial), 'J_exact': text(exact)}
        }
        file.add('taylor_integral', vector, {**relative(vector, 1e-11, '/expect/J_poly'), **relative(vector, 1e-13, '/expect/J_exact')})
    # A spot: the cosine to its axis from the direction of a point by the axis's parts across and along the ray.
    o, way, light, axis = [0.5, -0.25, 0], [0.25, 0.5, 2], [1, 3, 5], [0.25, -1, -0.125]
    r, foot, h = geometry(o, way, light)
    across = [x / h for x in away(light, along(o, r, foot))]
    unit = [mpf(x) / norm([mpf(y) for y in axis]) for x in axis]
    parts = dot(across, unit), dot(r, unit)
    k, n, x0, x1 = mpf('0.375'), 3, 1, 9
    # The lit side is where the cosine is above 0.
    turn = foot - h * parts[0] / parts[1]
    value = scattered(k,
                      foot,
                      h, [sorted({mpf(x0), mpf(x1), foot} | ({turn} if x0 < turn < x1 else set()))],
                      lambda c: phase('hg', mpf('0.4'), c),
                      power=lambda d: max(mpf(0), d[0] * parts[0] + d[1] * parts[1])**n)
    vector = {
        'input': {
            'O': o, 'dir': way, 'S': light, 'axis': axis, 'n': n, 'k_t': text(k), 'x0': str(x0), 'x1': str(x1), 'phase': 'hg', 'g': '0.4'
        }, 'expect': {'L': text(value), 'T': text(foot), 'h': text(h)}
    }
    file.add('spot', vector, {**relative(vector, 1e-10, '/expect/L'), **relative(vector, 1e-14, '/expect/T', '/expect/h')})
    # A box across the sky over the ray y = 0 from a light above: shaded is what the light's cone through the underside [-1, 1.5] at y = 2
    # or the top at y = 2.5 covers, from z = 3.75 and 6.25; the ray runs along z at x = 0.25.
    low, high, light, k, far = [-1, 2, 4], [1.5, 2.5, 6], [0.25, 5, 3], mpf('0.3'), 12
    corners = [[(low, high)[i][0], (low, high)[j][1], (low, high)[m][2]] for i in (0, 1) for j in (0, 1) for m in (0, 1)]
    sides = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7],
             [1, 7, 3]]
    # On the ground y = 0 the height y of an edge z0 throws its shadow to 3 + (z0 - 3) 5 / (5 - y).
    throws = [3 + (z - 3) * mpf(5) / (5 - y) for z in (4, 6) for y in (mpf(2), mpf('2.5'))]
    begin, end = min(throws), max(throws)
    o, way = [0.25, 0, 0], [0, 0, 1]
    r, foot, h = geometry(o, way, light)
    value = scattered(k, foot, h, [[0, begin], [end, far]], lambda c: mpf(1))
    vector = {
        'input': {'vertices': corners, 'triangles': sides, 'O': o, 'dir': way, 'S': light, 'k_t': text(k), 'far': str(far)}, 'expect': {
            'x_end': str(far), 'count_profile': [['0', text(begin), 0], [text(begin), text(end), 1], [text(end), str(far), 0]],
            'lit': [['0', text(begin)], [text(end), str(far)]], 'L': text(value)
        }
    }
    file.add('shadow', vector,
             {**relative(vector, 1e-12, '/expect/L'), **relative(vector, 1e-13, '/expect/lit/0/1', '/expect/lit/1/0', '/expect/x_end')})
    # A ball; the paper has the same length R of medium from the light to every point, and the way to the eye from where the ray enters.
    o, way, light, center, radius, k = [0.25, 0.5, -4], [0.125, -0.25, 3], [1, 2.5, 0.5], [0, 0.25, 1], mpf('1.75'), mpf('0.8')
    r, foot, h = geometry(o, way, light)
    x_in, x_out = sphere_cut(o, r, center, radius)

    def in_ball(x, _):
        point = along(o, r, x)
        way_back = [y / norm(away(point, light)) for y in away(point, light)]
        return x - x_in + min(norm(away(point, light)), sphere_cut(point, way_back, center, radius)[1])

    exact = scattered(k, foot, h, [[x_in, foot, x_out] if x_in < foot < x_out else [x_in, x_out]], lambda c: mpf(1), in_ball)
    length = 6 * radius / 5
    paper = scattered(k, foot, h, [[x_in, x_out]], lambda c: mpf(1), lambda x, _: length + x - x_in)
    vector = {
        'input': {'shape': 'sphere', 'params': [center, float(radius)], 'O': o, 'dir': way, 'S': light, 'k_t': text(k), 'R': text(length)},
        'expect': {'x_in': text(x_in), 'x_out': text(x_out), 'L_exact': text(exact), 'L_paper': text(paper)}
    }
    file.add(
        'bounded', vector, {
            **relative(vector, 1e-11, '/expect/L_exact'), **relative(vector, 1e-12, '/expect/L_paper'), **relative(
                vector, 1e-13, '/expect/x_out'), '/expect/x_in': 1e-12 * float(1 + x_in)
        })
    file.write()


if __name__ == '__main__':
    make()
