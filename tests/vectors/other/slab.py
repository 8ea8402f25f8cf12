"""Slabs by adding and doubling, with extra directions of weight 0 where radiance is asked for."""
import numpy as np


class Layer:
    """Reflection, transmission (both with the cosines and weights of the rule) and what leaves by its own emission."""
    def __init__(self, r, t, up=None):
        self.r, self.t, self.up = r, t, up if up is not None else np.zeros(len(r))

    def over(self, other):
        """A layer as thick as both. They are alike: only then one reflection and one emission tell all."""
        one = np.eye(len(self.r))
        inner = np.linalg.inv(one - other.r @ self.r)
        top = self.r + self.t @ inner @ other.r @ self.t
        through = other.t @ np.linalg.inv(one - self.r @ other.r) @ self.t
        up = self.up + self.t @ inner @ (other.up + other.r @ self.up)
        return Layer(top, through, up)


class Slab:
    """moments: of P_l over the phase function. Directions: Gauss nodes in u, mu = u^2, then `asked` of weight 0, the first of them of
    weight `light`. A beam is the light of that direction divided by a weight of next to nothing."""
    def __init__(self, moments, albedo, asked=(), nodes=48, emission=0.0, light=0.0):
        u, w = np.polynomial.legendre.leggauss(nodes)
        u = 0.5 * (u + 1)
        self.mu = np.concatenate([u * u, asked])
        self.weight = np.concatenate([w * u, [light] * bool(asked), np.zeros(max(0, len(asked) - 1))])
        p = [np.polynomial.legendre.legval(self.mu, [0] * l + [1]) for l in range(len(moments))]
        forward = sum((2 * l + 1) * c * np.outer(p[l], p[l]) for l, c in enumerate(moments))
        back = sum((-1)**l * (2 * l + 1) * c * np.outer(p[l], p[l]) for l, c in enumerate(moments))
        self.forward, self.back = 0.5 * albedo * forward * self.weight, 0.5 * albedo * back * self.weight
        self.emission = emission

    def layer(self, tau):
        if tau == 0:
            return Layer(np.zeros_like(self.back), np.eye(len(self.mu)))
        halvings = 24
        d = tau / 2**halvings
        # The thinnest layer to second order in its depth.
        m = np.diag(1 / self.mu)
        a, b = m @ (np.eye(len(self.mu)) - self.forward), m @ self.back
        r = d * b - 0.5 * d * d * (a @ b + b @ a)
        t = np.eye(len(self.mu)) - d * a + 0.5 * d * d * (a @ a + b @ b)
        source = m @ np.full(len(self.mu), float(self.emission))
        layer = Layer(r, t, d * source - 0.5 * d * d * (a - b) @ source)
        for _ in range(halvings):
            layer = layer.over(layer)
        return layer

    def inside(self, above, below, top, bottom):
        """Radiance down and up between two layers, under even light `top` and `bottom`."""
        x, y = self.layer(above), self.layer(below)
        one, ones = np.eye(len(self.mu)), np.ones(len(self.mu))
        fall, rise = x.t @ (top * ones) + x.up, y.t @ (bottom * ones) + y.up
        down = np.linalg.solve(one - x.r @ y.r, fall + x.r @ rise)
        return down, y.r @ down + rise

    def beam(self, tau):
        """Radiance up and down under a beam of irradiance 1 in the first asked direction, of all directions but that."""
        layer, i = self.layer(tau), len(self.mu) - np.count_nonzero(self.weight == 0) - 1
        into = 1 / (2 * np.pi * self.weight[i] * self.mu[i])
        up, down = layer.r[:, i] * into, layer.t[:, i] * into
        down[i] = np.nan
        return up, down

    def mean(self, radiance):
        return self.weight @ radiance / 2

    def flux(self, radiance):
        return 2 * np.pi * self.weight @ (self.mu * radiance)
