"""Symmetric (1, n) modes: closed form, eqs (8)-(10) of Yim & Lin (1991); states on a section; fixed point; admissibility.

Let h = nπ/Ω, half a response, t = tanh(h/2), k∓ = (1 ∓ e)/2e and a = Ω²t²k₋² + k₊². The speed V after an
impact and the phase φ there obey

    β cos φ = −t V k₋,   βΩ sin φ = t − V k₊,   so that   aV² − 2t k₊ V + t² − Ω²β² = 0.

Both roots meet at V_E = t k₊/a. With the distance of V from V_E nothing cancels and nothing overflows:

    (V − V_E)² = (Ω/a)² (√a β − t²k₋)(√a β + t²k₋).

The trace of the half-cycle map, eq. (10), is 1 + e² + e(1+e) sinh h (1/V − 1/V_E). A mode is stable if it is less than 1 + e² in size.

As a fixed point of the return map a mode needs no march, only the search for one impact. The closed form gives the
state, and the linear flow the derivative. The search proves that the block meets nothing on the arc before the impact
of the mode. The second arc is the mirror image of the first.

A mode is admissible if its closed form, eq. (8), does not pass through Theta = 0. On the positive side, from one impact
to the next a time ``length`` = n pi/Omega later,

    u = a e^-t + b e^-(length - t) + 1 + beta cos(phi + Omega t).

Both exponentials decay from their end of the half-cycle, so that no term grows however long it is. The mode is followed
from both ends to the middle, in pieces that each start from this form. So rounding grows by at most e^PIECE, and no
tolerance is needed for the impact at the far end.
"""

import math
from typing import NamedTuple

import numpy as np

from rocking.kernels import contract
from rocking.kernels.arc.arc import CROSSING, Arc, arc_peak
from rocking.kernels.arc.first_zero_cosine import base_event_function, first_zero
from rocking.kernels.arc.slender_cosine import arc_from, evaluate
from rocking.kernels.base.cosine import TURN, HarmonicConstants, HarmonicDrive, particular
from rocking.kernels.contract import (
    arc_at,
    forcing_term,
    guess_from,
    next_event,
    restoring_acceleration,
    transfer,
)
from rocking.kernels.event_kinds import FLIGHT, IMPACT
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.motion.tangent import Tangent, along, carry_along, carry_through, event_map, through
from rocking.kernels.numerics.elementary import (
    angle_of,
    direction,
    exponential,
    hyperbolic,
    hyperbolic_tangent,
    size,
)
from rocking.kernels.orbits.return_map import FixedPoint, MapImage, newton_correction
from rocking.kernels.system import Cosine, Full, Slender, Unsymmetric, slender_at_phase

# Beyond this sinh overflows.
MAX_ARGUMENT = 700.0
# Arc that stands for no mode.
NOWHERE = Arc(1, 0.0, 0.0, 0.0, HarmonicDrive(1.0, 0.0), HarmonicConstants(0.0, 0.0))


UNIT = Tangent(1.0, 0.0, 0.0, 1.0)
PIECE = 4.0


class Nearest(NamedTuple):
    """State of a mode on a section that is nearest to a given state."""

    distance: float  # infinite if there is no stable mode
    order: int
    angle: float
    velocity: float
    arc: Arc  # on which the state lies
    since: float
    half: float  # duration of every arc of the mode


@entry_point
@kernel(inline=True)
def closed_form(
    frequency: float, response: float, restitution: float, order: int, faster: bool
) -> tuple[float, float, float]:
    """Evaluate the faster or slower mode by eqs (8)-(10); NaN if it does not exist.

    Returns
    -------
    tuple of (float, float, float)
        Speed after an impact and forcing phase there.
        Trace of the half-cycle map.
    """
    e, h = restitution, order * math.pi / frequency
    t, lost, kept, twice = hyperbolic_tangent(0.5 * h), 1.0 - e, 1.0 + e, 2.0 * e
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
    steep = hyperbolic(h)[0] if h < MAX_ARGUMENT else math.inf
    trace = 1.0 + e * e + (e * kept * steep * apart if apart != 0.0 else 0.0)
    return speed, angle_of(sine, -t * lost * (speed / twice)), trace


@body(contract.nearest_mode, Slender, Cosine)
def nearest(p, order, angle, velocity):
    """Provide ``contract.nearest_mode``, at the start of a cycle."""
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


@body(contract.nearest_mode, Unsymmetric, Cosine)
@body(contract.nearest_mode, Full, Cosine)
def none_known(p, order, angle, velocity):
    """Provide ``contract.nearest_mode`` for the other blocks, whose modes have no closed form."""
    arc = arc_at(p, 1, 0, 0.0, 0.0, 0.0)
    return Nearest(math.inf, order, math.nan, math.nan, arc, 0.0, 0.0)


@kernel
def orbit_of_mode(p, mode):
    """Return a mode (``Nearest``) as the ``FixedPoint`` over its period.

    It has converged if the impact that ends its arc agrees with the closed form, to the tolerance of Newton's
    method.
    """
    arc, half, since = mode.arc, mode.half, mode.since
    coming, _ = next_event(p, FLIGHT, arc, guess_from(p, half))
    saltation = event_map(p, arc, coming, FLIGHT, -arc.side)
    to_impact, whole = transfer(p, arc, since, half - since), transfer(p, arc, 0.0, half)
    to_section = transfer(p, arc, 0.0, since)
    tangent = through(along(through(along(UNIT, to_impact), saltation), whole), saltation)
    tangent = along(tangent, to_section)

    # the state after the impact less that of the mode, at the same time, on the side of the next arc
    late, faster = coming.wait - half, -p.block.restitution * coming.velocity - arc.velocity
    bend = -forcing_term(p, arc.side, coming.drive) - 2.0 * restoring_acceleration(p, arc.side)
    off = -arc.velocity * late, faster - bend * late
    again = carry_through(carry_along(off, whole), *saltation)
    # one half of the orbit mirrors the other
    angle, velocity = carry_along((off[0] - again[0], off[1] - again[1]), to_section)
    missed = arc.side * angle, arc.side * velocity
    residual = max(abs(missed[0]), abs(missed[1]))
    step, enough = newton_correction(tangent, 1.0, missed)
    image = MapImage(
        coming.event == IMPACT,
        mode.angle + missed[0],
        mode.velocity + missed[1],
        tangent,
        2,
        0,
        math.nan,
        (half - since, half),
    )
    converged = coming.event == IMPACT and residual <= enough
    return FixedPoint(converged, mode.angle, mode.velocity, image, residual, size(step[0], step[1]), 1)


@kernel
def first_half(p, speed, near, far, length):
    """Follow a mode from u = 0 with ``speed`` to the middle; ``near`` and ``far`` are a, b above.

    Returns
    -------
    tuple of (bool, float)
        Whether u > 0 up to the middle.
        Largest value of u.
    """
    middle, peak = 0.5 * length, 0.0
    pieces = math.ceil(middle / PIECE)
    step = middle / pieces
    angle, velocity = 0.0, speed
    for k in range(pieces):
        arc = arc_from(p, 1, k * step, angle, velocity)
        found, _, _ = first_zero(p, arc, base_event_function(p), 0.0, step)
        if found == CROSSING:
            return False, peak
        peak = arc_peak(p, arc, step, peak)
        t = (k + 1) * step
        sine, cosine, _, _ = direction(p.forcing.frequency * t + p.forcing.phase)
        displacement, forced_velocity = particular(p, cosine, sine)
        leaving, coming = near * exponential(-t), far * exponential(t - length)
        angle, velocity = leaving + coming + 1.0 + displacement, coming - leaving + forced_velocity
        if angle <= 0.0:
            return False, peak
    return True, peak


@entry_point
def half_cycle(
    p: Slender[Cosine], speed: float, near: float, far: float, length: float
) -> tuple[bool, float]:
    """Follow a mode that leaves the base with ``speed`` at phase ``p.forcing.phase`` through its half-cycle.

    In reversed time the half-cycle begins at phase pi - phi with the speed before the impact.

    Returns
    -------
    tuple of (bool, float)
        Whether u > 0 inside the half-cycle.
        Largest value of u.
    """
    up, peak = first_half(p, speed, near, far, length)
    if not up:
        return False, peak
    backwards = slender_at_phase(p, math.pi - p.forcing.phase)
    up, other = first_half(backwards, speed / p.block.restitution, far, near, length)
    return up, max(peak, other)
