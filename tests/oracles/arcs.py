"""Seeded arcs for which the first crossing is hardest to find.

A family is a function of a random generator that returns one Arc. `arcs(family, count, seed)` lists them.
"""

import math

import numpy as np
from flint import arb

from oracles.distance import ROUNDING, Arc, Distance, pinned

TURN = 2 * math.pi


def _log_uniform(rng, low, high):
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def _system(rng, brace=None):
    """Amplitude 0–100, frequency .05–200, brace none or .01–2, side."""
    choice = rng.random()
    amplitude = (
        0.0 if choice < 0.02 else _log_uniform(rng, 0.01, 100) if choice < 0.5 else float(rng.uniform(0, 100))
    )
    braced = rng.random() < 0.4 if brace is None else brace
    angle = _log_uniform(rng, 0.01, 2) if braced else math.inf
    return amplitude, _log_uniform(rng, 0.05, 200), angle, int(rng.choice([-1, 1]))


def _start(rng, brace):
    """From the base, from the brace or from between; speeds from 1e-12 to 10."""
    speed = _log_uniform(rng, 1e-12, 10)
    where = rng.integers(3)
    if where == 1 and math.isfinite(brace):
        return brace, -speed
    if where == 2:
        return float(rng.uniform(0, brace if math.isfinite(brace) else 2.0)), float(
            rng.choice([-1, 1])
        ) * speed
    return 0.0, speed


def generic(rng):
    amplitude, frequency, brace, side = _system(rng)
    return Arc(amplitude, frequency, brace, side, *_start(rng, brace), float(rng.uniform(0, TURN)))


def slow_from_base(rng):
    """Starts at the base with speeds 1e-12 … 0.3: the arcs whose time and speed are measured."""
    amplitude, frequency, _, side = _system(rng, brace=False)
    return Arc(
        amplitude, frequency, math.inf, side, 0.0, _log_uniform(rng, 1e-12, 0.3), float(rng.uniform(0, TURN))
    )


def release(rng):
    """Lift-off from rest at the base, or release from the brace, where the acceleration already points inward."""
    while True:
        amplitude, frequency, brace, side = _system(rng)
        phase = float(rng.uniform(0, TURN))
        braced = math.isfinite(brace) and rng.random() < 0.5
        forcing = -1 - side * amplitude * math.cos(phase)
        if (brace + forcing < -1e-3) if braced else (forcing > 1e-3):
            return Arc(amplitude, frequency, brace, side, brace if braced else 0.0, 0.0, phase)


def near_saddle(rng):
    """The growing part all but vanishes: flights over up to hundreds of forcing cycles, most of them down in the end."""
    while True:
        amplitude, frequency, brace, side = _system(rng)
        phase = float(rng.uniform(0, TURN))
        ripple = side * amplitude / (1 + frequency**2)
        angle = float(rng.choice([0.0, rng.uniform(0, min(brace, 2))]))
        short = _log_uniform(rng, 1e-13, 0.1) * float(rng.choice([-1, 1]))
        velocity = 1 + ripple * (math.cos(phase) - frequency * math.sin(phase)) - angle + short
        if 0 < abs(velocity) < 1e3 and (angle > 0 or velocity > 0):
            return Arc(amplitude, frequency, brace, side, angle, velocity, phase)


def _nudged(rng, value):
    """A few units in the last place to either side."""
    return float(value + rng.integers(-4, 5) * math.ulp(value)) % TURN


def stretch_boundary(rng):
    """Starts where the acceleration at the base, or at the brace, changes sign, to a few ulps on both sides."""
    while True:
        amplitude, frequency, brace, side = _system(rng)
        braced = math.isfinite(brace) and rng.random() < 0.5
        target = side * ((brace - 1) if braced else -1.0)
        if amplitude <= abs(target):
            continue
        phase = math.acos(target / amplitude)
        phase = _nudged(rng, phase if rng.random() < 0.5 else TURN - phase)
        speed = _log_uniform(rng, 1e-12, 1)
        return Arc(amplitude, frequency, brace, side, *((brace, -speed) if braced else (0.0, speed)), phase)


def _tuned(rng, arc, kind, left, right):
    """The arc whose speed makes w touch zero between two times, off by up to 32 roundings of its terms."""
    distance = Distance(arc._replace(velocity=0.0), kind)

    def touching(time):
        w, first, second, _ = distance.at(time)
        sinh, cosh = time.sinh_cosh()
        return w * cosh - first * sinh, (w - second) * sinh

    time = pinned(touching, arb(left), arb(right)).mid()
    sinh = time.sinh()
    exact = -distance.at(time)[0] / sinh * distance.outward
    size = Distance(arc._replace(velocity=float(exact)), kind).size(time)
    return arc._replace(
        velocity=float(exact + distance.outward * arb(float(rng.uniform(-32, 32))) * ROUNDING * size / sinh)
    )


def _record_dips(arc, kind, times):
    """Brackets of the times where, as the speed falls, w touches zero for the first time: record maxima of −w/sinh."""
    ripple = arc.side * arc.amplitude / (1 + arc.frequency**2)
    angle = (
        (arc.angle - 1 - ripple * math.cos(arc.phase)) * np.cosh(times)
        + ripple * arc.frequency * math.sin(arc.phase) * np.sinh(times)
        + 1
        + ripple * np.cos(arc.phase + arc.frequency * times)
    )
    level = -(angle if kind == "base" else arc.brace - angle) / np.sinh(times)
    inner = level[1:-1]
    peak = (inner > level[:-2]) & (inner > level[2:]) & (inner >= np.maximum.accumulate(level)[1:-1])
    return [(times[index], times[index + 2]) for index in np.flatnonzero(peak)]


def _grazing(rng, kind):
    while True:
        amplitude, frequency, brace, side = _system(rng, brace=kind == "brace" or None)
        where = rng.integers(3)
        angle = (
            0.0
            if where == 0
            else brace
            if where == 1 and kind == "brace"
            else float(rng.uniform(0, min(brace, 2)))
        )
        arc = Arc(amplitude, frequency, brace, side, angle, 0.0, float(rng.uniform(0, TURN)))
        step = min(0.02, 0.15 / frequency)
        brackets = _record_dips(arc, kind, step * np.arange(1, min(4000, int(rng.uniform(1, 6) / step))))
        if not brackets:
            continue
        arc = _tuned(rng, arc, kind, *brackets[rng.integers(len(brackets))])
        inward = arc.velocity > 0 if angle == 0 else arc.velocity < 0 if angle == brace else True
        if inward and abs(arc.velocity) < 1e3:
            return arc


def grazing_base(rng):
    """Dips that touch the base to ±32 roundings of their terms."""
    return _grazing(rng, "base")


def grazing_brace(rng):
    """Dips that touch a brace to ±32 roundings of their terms."""
    return _grazing(rng, "brace")


def grazing_slow(rng):
    """Dips near the start: just before the acceleration turns outward, at speeds down to 1e-12."""
    while True:
        amplitude, frequency, brace, side = _system(rng)
        if amplitude < 1.001:
            continue
        turn = math.acos(-side / amplitude)
        turn = turn if side > 0 else -turn  # where 1 + side·A·cos ψ falls through zero
        lead = _log_uniform(rng, 1e-6, 0.05)
        arc = Arc(amplitude, frequency, brace, side, 0.0, 0.0, (turn - lead) % TURN)
        guess = 1.5 * lead / frequency
        arc = _tuned(rng, arc, "base", 0.3 * guess, 2.5 * guess)
        if arc.velocity > 1e-12:
            return arc


FAMILIES = {
    family.__name__: family
    for family in (
        generic,
        slow_from_base,
        release,
        near_saddle,
        stretch_boundary,
        grazing_base,
        grazing_brace,
        grazing_slow,
    )
}


def arcs(family, count, seed):
    """Arcs of a family by name; the same seed gives the same arcs."""
    rng = np.random.default_rng([seed, *family.encode()])
    return [FAMILIES[family](rng) for _ in range(count)]
