"""Symmetric (1, n) modes in closed form, eqs (8)-(10) of Yim & Lin (1991), and their states on a section.

Let h = nπ/Ω, half a response, t = tanh(h/2), k∓ = (1 ∓ e)/2e and a = Ω²t²k₋² + k₊². The speed V after an
impact and the phase φ there obey

    β cos φ = −t V k₋,   βΩ sin φ = t − V k₊,   so that   aV² − 2t k₊ V + t² − Ω²β² = 0.

Both roots meet at V_E = t k₊/a. With the distance of V from V_E nothing cancels and nothing overflows:

    (V − V_E)² = (Ω/a)² (√a β − t²k₋)(√a β + t²k₋).

The trace of the half-cycle map is 1 + e² + e(1+e) sinh h (1/V − 1/V_E).
"""

import math
from typing import NamedTuple

import numpy as np

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE, KERNEL
from rocking.kernels.deferred import njit, provide
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing import periodic
from rocking.kernels.forcing.arc import Arc
from rocking.kernels.forcing.contract import arc_at
from rocking.kernels.forcing.drives import HarmonicConstants, HarmonicDrive
from rocking.kernels.forcing.full.parameters import FullHarmonicParameters
from rocking.kernels.forcing.harmonic.acceleration import TURN
from rocking.kernels.forcing.harmonic.parameters import HarmonicParameters
from rocking.kernels.forcing.harmonic.solution import arc_from, evaluate
from rocking.kernels.numerics.elementary import size

# Beyond this sinh overflows.
MAX_ARGUMENT = 700.0
# Arc that stands for no mode.
NOWHERE = Arc(1, 0.0, 0.0, 0.0, HarmonicDrive(1.0, 0.0), HarmonicConstants(0.0, 0.0))


class Nearest(NamedTuple):
    """State of a mode on a section that is nearest to a given state."""

    distance: float  # infinite if there is no stable mode
    order: int
    angle: float
    velocity: float
    arc: Arc  # on which the state lies
    since: float
    half: float  # duration of every arc of the mode


@njit(**INTERNAL_INLINE)
def closed_form(frequency, response, restitution, order, faster):
    """Evaluate the faster or slower mode; NaN if it does not exist.

    Returns
    -------
    tuple of (float, float, float)
        Speed after an impact and forcing phase there.
        Trace of the half-cycle map.
    """
    e, h = restitution, order * math.pi / frequency
    t, lost, kept, twice = math.tanh(0.5 * h), 1.0 - e, 1.0 + e, 2.0 * e
    swept = frequency * t * lost
    # a, the root and k-+ times (2e)**2 or 2e
    a = swept * swept + kept * kept
    fold, width = twice * t * kept / a, math.sqrt(a) * response
    root = math.sqrt((width - t * t * lost) * (width + t * t * lost))
    root = root if faster else -root
    fast = fold + twice * frequency * abs(root) / a
    slow = (t - frequency * response) * (t + frequency * response) * twice * (twice / fast) / a
    # at the fold both roots are equal
    speed = fast if faster else (slow if root < 0.0 else math.nan)
    # (t - V k+)/Omega without the cancellation that occurs if e is near 1
    sine = (frequency * t * t * t * lost * lost - root * kept) / a
    apart = -frequency * root * (twice / speed) / (a * fold)
    steep = math.sinh(h) if h < MAX_ARGUMENT else math.inf
    trace = 1.0 + e * e + (e * kept * steep * apart if apart != 0.0 else 0.0)
    return speed, math.atan2(sine, -t * lost * (speed / twice)), trace


@entry_point(**KERNEL)
def closed_form_plain(
    frequency: float, response: float, restitution: float, order: int, faster: bool
) -> tuple[float, float, float]:
    """Return ``closed_form``; entry point for Python."""
    return closed_form(frequency, response, restitution, order, faster)


@njit(**INTERNAL)
def nearest(p, order, angle, velocity):
    """Provide ``periodic.nearest_mode``, at the start of a cycle."""
    half = order * math.pi * p.forcing.per_frequency
    best = Nearest(math.inf, order, math.nan, math.nan, NOWHERE, 0.0, half)
    if order % 2 == 0 or p.block.restitution == 0.0:
        return best
    speed, phase, trace = closed_form(
        p.forcing.frequency, p.forcing.response, p.block.restitution, order, True
    )
    if not (speed > 0.0 and abs(trace) < 1.0 + p.block.restitution * p.block.restitution):
        return best
    first = p.forcing.phase - phase
    first -= TURN * np.floor(first / TURN)
    for k in range(order):
        since, side = (first + k * TURN) * p.forcing.per_frequency, 1
        if since >= half:
            since, side = since - half, -1
        arc = arc_from(p, side, -since, 0.0, speed)
        now = evaluate(p, arc, since)
        place, rate = side * now.angle, side * now.velocity
        distance = size(place - angle, rate - velocity)
        if distance < best.distance:
            best = Nearest(distance, order, place, rate, arc, since, half)
    return best


@njit(**INTERNAL)
def none_known(p, order, angle, velocity):
    """Provide ``periodic.nearest_mode`` for the full block, whose modes have no closed form."""
    arc = arc_at(p, 1, 0, 0.0, 0.0, 0.0)
    return Nearest(math.inf, order, math.nan, math.nan, arc, 0.0, 0.0)


provide(HarmonicParameters, {periodic.nearest_mode: nearest})
provide(FullHarmonicParameters, {periodic.nearest_mode: none_known})
