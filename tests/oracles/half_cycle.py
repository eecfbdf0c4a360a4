"""Half a response of a symmetric mode: in many digits from eq. (5), by brute force, and by the package's engine."""

import math

import mpmath as mp
import numpy as np

from oracles.engine import harmonic_parameters
from rocking.kernels import event_kinds
from rocking.kernels.arc import first_zero_cosine
from rocking.kernels.arc.arc import Transfer
from rocking.kernels.arc.slender_cosine import arc_from
from rocking.kernels.motion import tangent


def _flight(amplitude, omega, phase, velocity, t):
    """Return (Θ, Θ') a time t after leaving the base, eq. (5) solved for a start at Θ = 0."""
    beta = amplitude / (1 + omega**2)
    cosine, sine = mp.cos(phase), mp.sin(phase)
    later = omega * t + phase
    angle = velocity * mp.sinh(t) + 1 - mp.cosh(t)
    angle += beta * (mp.cos(later) - cosine * mp.cosh(t) + omega * sine * mp.sinh(t))
    rate = velocity * mp.cosh(t) - mp.sinh(t)
    rate += beta * (-omega * mp.sin(later) - cosine * mp.sinh(t) + omega * sine * mp.cosh(t))
    return angle, rate


def solved(amplitude, period, restitution, n, velocity, phase):
    """Return (V, φ) of the mode near a guess: Θ = 0 and Θ' = −V/e half a response later."""
    a, omega, e = mp.mpf(amplitude), 2 * mp.pi / mp.mpf(period), mp.mpf(restitution)
    length = n * mp.pi / omega

    def miss(v, phi):
        angle, rate = _flight(a, omega, phi, v, length)
        return angle, rate + v / e

    v, phi = mp.findroot(miss, (mp.mpf(velocity), mp.mpf(phase)))
    return v, phi


def trace_and_determinant(amplitude, period, restitution, n, v, phi):
    """Differentiate the mirrored map (φ, V) → (φ', V') from an impact to the next numerically, in many digits."""
    a, omega, e = mp.mpf(amplitude), 2 * mp.pi / mp.mpf(period), mp.mpf(restitution)
    length = n * mp.pi / omega

    def image(phase, speed):
        t = mp.findroot(lambda s: _flight(a, omega, phase, speed, s)[0], length)
        return phase + omega * t, -e * _flight(a, omega, phase, speed, t)[1]

    step = mp.mpf(10) ** (-mp.mp.dps // 3)
    columns = []
    for dphi, dv in ((step, 0), (0, step)):
        up, down = image(phi + dphi, v + dv), image(phi - dphi, v - dv)
        columns.append([(x - y) / (2 * step) for x, y in zip(up, down, strict=True)])
    (aa, ba), (ab, bb) = columns
    return aa + bb, aa * bb - ab * ba


def sampled(mode, points=20_001):
    """Return the least Θ over its distance from the nearer end of the half cycle, and the largest Θ, by brute force."""
    omega = 2 * math.pi / mode.period
    h = mode.n * math.pi / omega
    beta = mode.amplitude / (1 + omega**2)
    t = np.linspace(0, h, points)[1:-1]
    swing = beta * math.cos(mode.phase)
    near, far = -1 / (1 + math.exp(-h)), swing / math.expm1(-h)
    angle = (
        (near + far) * np.exp(-t) + (near - far) * np.exp(t - h) + 1 + beta * np.cos(mode.phase + omega * t)
    )
    return float((angle / np.minimum(t, h - t)).min()), float(angle.max())


def engine(mode, faster=0.0):
    """Return time of the first impact, speed after it, and mirrored 2 × 2 tangent between two impacts.

    The arc starts on the mode, or ``faster`` by the given speed.
    """
    p = harmonic_parameters(
        mode.amplitude, 2 * math.pi / mode.period, mode.period, mode.phase, mode.restitution
    )
    arc = arc_from(p, 1, 0.0, 0.0, mode.velocity + faster)
    coming = first_zero_cosine.any_event(p, event_kinds.FLIGHT, arc)
    assert coming.event == event_kinds.IMPACT
    start = tangent.Tangent(1.0, 0.0, 0.0, 1.0)
    cosh = 1.0 + coming.versinh
    a, b, c, d = tangent.through(
        tangent.along(start, Transfer(cosh, coming.sinh, coming.sinh, cosh)),
        tangent.event_map(p, arc, coming, event_kinds.FLIGHT, -1),
    )
    return coming.wait, -mode.restitution * coming.velocity, -np.array([[a, c], [b, d]])
