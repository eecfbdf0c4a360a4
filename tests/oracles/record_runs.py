"""Seeded runs of blocks under sampled base accelerations, for comparison with ``segments``.

A family is a function of a random generator that returns one ``Case``. ``cases(family, count, seed)`` lists them.
"""

import math
from typing import NamedTuple

import numpy as np

import rocking as rk
from oracles import segments


class Case(NamedTuple):
    """Samples with their step and scale, restitution, initial state, and (angle, restitution) of braces or None."""

    values: np.ndarray
    step: float
    scale: float
    restitution: float
    angle: float = 0.0
    velocity: float = 0.0
    brace: tuple[float, float] | None = None


def simulated(case, scale=None):
    """Return the motion that the package computes."""
    forcing = rk.PiecewiseLinear(case.values, step=case.step, scale=case.scale if scale is None else scale)
    braces = None if case.brace is None else rk.Braces(angle=case.brace[0], restitution=case.brace[1])
    system = rk.System(forcing, restitution=case.restitution, braces=braces)
    return rk.simulate(system, rk.State(case.angle, case.velocity))


def exact(case):
    """Return the ``segments.Run`` of a case."""
    return segments.motion(
        case.values,
        case.step,
        case.restitution,
        scale=case.scale,
        angle=case.angle,
        velocity=case.velocity,
        brace=case.brace,
    )


def _log_uniform(rng, low, high):
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def _noise(rng, samples):
    """White noise through a random resonance, times an envelope."""
    pole = rng.uniform(0.5, 0.99) * np.exp(1j * rng.uniform(0.02, 1.5))
    values, before, last = rng.normal(size=samples), 0.0, 0.0
    for k in range(samples):
        before, last = last, values[k] + 2 * pole.real * last - abs(pole) ** 2 * before
        values[k] = last
    return values * np.sin(np.linspace(0.0, math.pi, samples)) ** rng.uniform(0.2, 2.0)


def _synthetic(rng, samples):
    """A synthetic ground motion of the package."""
    step = float(rng.choice([0.01, 0.02]))
    duration = (samples - 1) * step
    (motion,) = rk.synthetic_ground_motions(
        1,
        seed=int(rng.integers(2**31)),
        duration=duration,
        step=step,
        rise=0.2 * duration,
        strong=0.6 * duration,
        soil_frequency=float(rng.uniform(8, 30)),
    )
    return motion.acceleration


def _restitution(rng):
    """Housner's value of a slender block, or any."""
    if rng.random() < 0.5:
        return 1.0 - 1.5 * math.sin(rng.uniform(0.1, 0.4)) ** 2
    return float(rng.uniform(0.3, 0.95))


def ordinary(rng):
    """A filtered record at 1.02 to 6 times the scale of lift-off; one run in three starts with a tilt."""
    samples = int(rng.integers(40, 120))
    values = (_noise if rng.random() < 0.6 else _synthetic)(rng, samples)
    tilt = (rng.uniform(-0.8, 0.8), rng.uniform(-0.5, 0.5)) if rng.random() < 0.3 else (0.0, 0.0)
    scale = _log_uniform(rng, 1.02, 6.0) * rng.choice([-1.0, 1.0])
    return Case(
        values / np.abs(values).max(),
        _log_uniform(rng, 0.005, 0.5),
        float(scale),
        _restitution(rng),
        *map(float, tilt),
    )


def braced(rng):
    """A shorter record with braces."""
    case = ordinary(rng)
    brace = _log_uniform(rng, 0.02, 1.5), float(rng.uniform(0.3, 0.9))
    values = case.values[: int(rng.integers(10, 60))]
    values = values / np.abs(values).max()
    return case._replace(values=values, angle=case.angle * brace[0], brace=brace)


def odd(rng):
    """One to five samples, spikes, zeros, long steps, samples at the level of lift-off."""
    kind = rng.integers(5)
    case = ordinary(rng)._replace(scale=float(rng.choice([-1.0, 1.0])))
    if kind == 0:
        values = rng.uniform(-4, 4, rng.integers(1, 6))
    elif kind == 1:
        values = np.zeros(40)
        values[rng.integers(1, 39, 3)] = rng.uniform(-30, 30, 3)
    elif kind == 2:
        values = np.where(rng.random(60) < 0.5, 0.0, rng.uniform(-3, 3, 60))
    elif kind == 3:
        values = np.round(rng.uniform(-2, 2, 60))
    else:
        values = rng.choice([-1.0, 1.0], 40) * (1.0 + rng.choice([0.0, 1e-12, -1e-12, 0.5], 40))
    return case._replace(values=values, step=_log_uniform(rng, 0.005, 3.0 if kind == 0 else 0.5))


def near_threshold(rng):
    """A run whose scale lies within 1e-9 to 1e-14 of one at which the package finds the other outcome."""
    while True:
        case = ordinary(rng)
        scales = case.scale * np.linspace(1.0, 1.5, 8)
        falls = [simulated(case, float(scale)).outcome == "overturned" for scale in scales]
        change = next((k for k in range(7) if falls[k] != falls[k + 1]), None)
        if change is None:
            continue
        low, high, width = float(scales[change]), float(scales[change + 1]), _log_uniform(rng, 1e-14, 1e-9)
        while abs(high - low) > width * abs(low):
            middle = 0.5 * (low + high)
            if (simulated(case, middle).outcome == "overturned") == falls[change]:
                low = middle
            else:
                high = middle
        return case._replace(scale=low if rng.random() < 0.5 else high)


FAMILIES = {family.__name__: family for family in (ordinary, braced, odd, near_threshold)}


def cases(family, count, seed):
    """Cases of a family by name; the same seed gives the same cases."""
    rng = np.random.default_rng([seed, *family.encode()])
    return [FAMILIES[family](rng) for _ in range(count)]
