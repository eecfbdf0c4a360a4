"""Symmetric (1, n) modes in closed form, eqs (8)-(10) of Yim & Lin (1991), and where one is when a section is due.

With h = nπ/Ω, half a response, t = tanh(h/2), k∓ = (1 ∓ e)/2e and a = Ω²t²k₋² + k₊², the speed V after an impact and the phase φ
there obey

    β cos φ = −t V k₋,   βΩ sin φ = t − V k₊,   so that   aV² − 2t k₊ V + t² − Ω²β² = 0.

Written with the distance of V from V_E = t k₊/a, where both roots meet, nothing cancels and nothing overflows:
(V − V_E)² = (Ω/a)² (√a β − t²k₋)(√a β + t²k₋), and the trace of the half-cycle map is 1 + e² + e(1+e) sinh h (1/V − 1/V_E).
"""

import math
from typing import NamedTuple

from numba import njit

from .arc import Arc, arc_from, evaluate
from .elementary import ENTRY, INNER, WITHIN, size
from .harmonic import TURN

# Beyond it sinh is infinite.
LARGEST_ARGUMENT = 700.0


class Nearest(NamedTuple):
    """Of the states of a mode on a section the one nearest to a given state."""

    distance: float  # infinite where there is no mode
    order: int
    angle: float
    velocity: float
    arc: Arc  # on which it lies; it began so long ago
    since: float
    half: float  # how long every arc of the mode takes


@njit(**INNER)
def closed_form(frequency, response, restitution, order, faster):
    """(speed after an impact, phase there, trace of the half-cycle map) of the faster or slower mode; NaN where there is none."""
    e, h = restitution, order * math.pi / frequency
    t = math.tanh(0.5 * h)
    less, more = (1.0 - e) / (2.0 * e), (1.0 + e) / (2.0 * e)
    swept = frequency * t * less
    a = swept * swept + more * more
    fold, width = t * more / a, math.sqrt(a) * response
    root = math.sqrt((width - t * t * less) * (width + t * t * less))
    root = root if faster else -root
    fast = fold + frequency * abs(root) / a
    slow = (t - frequency * response) * (t + frequency * response) / (a * fast)
    # at the fold both are one
    speed = fast if faster else (slow if root < 0.0 else math.nan)
    # (t - V k+)/Omega without the cancellation where e is near 1
    sine = (frequency * t * t * t * less * less - root * more) / a
    apart = -frequency * root / (a * speed * fold)
    steep = math.sinh(h) if h < LARGEST_ARGUMENT else math.inf
    trace = 1.0 + e * e + (e * (1.0 + e) * steep * apart if apart != 0.0 else 0.0)
    return speed, math.atan2(sine, -t * speed * less), trace


@njit(**ENTRY)
def closed_form_plain(frequency, response, restitution, order, faster):
    """``closed_form`` for Python."""
    return closed_form(frequency, response, restitution, order, faster)


@njit(**WITHIN)
def nearest(p, order, angle, velocity):
    """The state of the faster (1, ``order``) mode at the start of a cycle of ``p`` that lies nearest to (angle, velocity)."""
    half = order * math.pi * p.per_frequency
    best = Nearest(math.inf, order, math.nan, math.nan, arc_from(p, 1, 0.0, 0.0, 0.0), 0.0, half)
    if order % 2 == 0 or p.restitution == 0.0:
        return best
    speed, phase, _ = closed_form(p.frequency, p.response, p.restitution, order, True)
    if not speed > 0.0:
        return best
    first = p.phase - phase
    first -= TURN * math.floor(first / TURN)
    for k in range(order):
        since, side = (first + k * TURN) * p.per_frequency, 1
        if since >= half:
            since, side = since - half, -1
        arc = arc_from(p, side, -since, 0.0, speed)
        now = evaluate(p, arc, since)
        place, rate = side * now.angle, side * now.velocity
        distance = size(place - angle, rate - velocity)
        if distance < best.distance:
            best = Nearest(distance, order, place, rate, arc, since, half)
    return best
