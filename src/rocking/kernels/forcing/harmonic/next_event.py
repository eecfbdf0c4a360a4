"""Next event of a motion: impact, brace impact, lift-off, departure from a brace, or proof that none follows."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE, KERNEL, KERNEL_INLINE, SELDOM
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, LEAN, LEAVE, LIFT_OFF, NONE, REST
from rocking.kernels.forcing.arc import CROSSING, MAX_ARC_TIME, NEVER, Next
from rocking.kernels.forcing.drives import HarmonicDrive
from rocking.kernels.forcing.harmonic.acceleration import first_sign_change, next_sign_change
from rocking.kernels.forcing.harmonic.bracket import NEVER as NEVER_MORE
from rocking.kernels.forcing.harmonic.bracket import ZERO
from rocking.kernels.forcing.harmonic.enclosure import grazes
from rocking.kernels.forcing.harmonic.fast_path import fast_first_event, fast_first_impact
from rocking.kernels.forcing.harmonic.first_zero import base_event_function, brace_event_function, first_zero
from rocking.kernels.forcing.harmonic.solution import NONE_YET, evaluate, propagator_or_none

# Forcing at events that are computed from the clock again.
UNKNOWN = HarmonicDrive(0.0, 0.0)


@njit(**KERNEL_INLINE)
def until_window(p, side, psi, half, inside):
    """Return the time until eta next enters |eta| < half (``inside``) or leaves it.

    The time is 0 in the first half of that window. A block that is still held in the second half of a window
    came back at its very end, before the clock advanced. It waits for the next window.
    """
    sign_change, now_inside = first_sign_change(p, side, psi, 0.0, half)
    if now_inside != inside:
        return sign_change
    return (
        0.0
        if sign_change > 0.5 * next_sign_change(p, half, inside)
        else sign_change + next_sign_change(p, half, not inside)
    )


@njit(**INTERNAL)
def wait_at_rest(p, psi):
    """Return the time until a block at rest lifts off, when |A cos psi| rises through 1; infinite for A <= 1.

    Returns
    -------
    tuple of (float, int)
        The time, and the side of the lift-off.
    """
    if p.forcing.base_half == math.inf:
        return math.inf, 1
    right = until_window(p, 1, psi, p.forcing.base_half, False)
    left = until_window(p, -1, psi, p.forcing.base_half, False)
    return (right, 1) if right < left else (left, -1)


@njit(**INTERNAL)
def wait_leaning(p, side, psi):
    """Return the time until a block leaves its brace, when brace_angle + f falls through 0; infinite if never."""
    if p.forcing.brace_half == math.inf:
        return math.inf
    return until_window(p, side, psi, p.forcing.brace_half, True)


@njit(**INTERNAL)
def side_to_lift(p, start, drive):
    """Return the side to which a block at rest at the base lifts now, where f > 0; 0 if it stays."""
    if p.forcing.base_half < math.inf:
        psi = p.forcing.frequency * start + p.forcing.phase
        for side in (1, -1):
            if not first_sign_change(p, side, psi, 0.0, p.forcing.base_half)[1]:
                return side
    return 0


@njit(**KERNEL)
def stays_leaning(p, arc):
    """Return whether a block at rest at the brace is pressed against it: brace_angle + f > 0."""
    if p.forcing.brace_half == math.inf:
        return p.block.brace_angle > 1.0
    return not first_sign_change(p, arc.side, arc.constants.psi, 0.0, p.forcing.brace_half)[1]


@njit(**INTERNAL_INLINE)
def nothing_more(side):
    """Return that no event follows."""
    return Next(math.inf, NONE, side, 0.0, 0.0, UNKNOWN, 0.0, 0.0)


@njit(**KERNEL_INLINE)
def next_event(p, mode, arc, guess):
    """Find the next event, starting from the propagator ``guess`` of the time until it.

    There is no guess between braces. NONE after a finite time only restarts an arc that has grown long.

    Returns
    -------
    tuple of (Next, Propagator)
        The next event.
        The propagator from which to guess the event after the next.
    """
    if mode == FLIGHT and p.forcing.base_half < math.inf:
        at_brace, propagator = False, NONE_YET
        if p.block.brace_angle == math.inf:
            answer, t, now, propagator = fast_first_impact(p, arc, guess)
        else:
            answer, at_brace, t, now = fast_first_event(p, arc)
        if answer == NEVER_MORE:
            return nothing_more(arc.side), guess
        grazing = grazes(p.forcing.amplitude, arc.angle, arc.velocity, t, now.velocity)
        if answer == ZERO and not grazing:
            event, angle = (BRACE, p.block.brace_angle) if at_brace else (IMPACT, 0.0)
            return Next(t, event, arc.side, angle, now.velocity, now.drive, now.sinh, now.versinh), propagator
    coming = any_event(p, mode, arc)
    if mode != FLIGHT or p.block.brace_angle < math.inf:
        return coming, guess
    return coming, propagator_or_none(p, min(coming.wait, MAX_ARC_TIME))


@njit(**SELDOM)
def any_event(p, mode, arc):
    """Find the next event without a guess."""
    if mode == REST:
        wait, side = wait_at_rest(p, arc.constants.psi)
        return Next(wait, LIFT_OFF if wait < math.inf else NONE, side, 0.0, 0.0, UNKNOWN, 0.0, 0.0)
    if mode == LEAN:
        wait = wait_leaning(p, arc.side, arc.constants.psi)
        event = LEAVE if wait < math.inf else NONE
        return Next(wait, event, arc.side, p.block.brace_angle, 0.0, UNKNOWN, 0.0, 0.0)
    event = IMPACT
    found, t, now = first_zero(p, arc, base_event_function(p), 0.0, MAX_ARC_TIME)
    if found != CROSSING:
        event, t = NONE, MAX_ARC_TIME
    if p.block.brace_angle < math.inf:
        hit, t_hit, now_hit = first_zero(p, arc, brace_event_function(p), 0.0, t)
        if hit == CROSSING:
            event, t, now = BRACE, t_hit, now_hit
    elif found == NEVER:
        return nothing_more(arc.side)
    if event == NONE:
        now = evaluate(p, arc, t)
    return Next(t, event, arc.side, now.angle, now.velocity, now.drive, now.sinh, now.versinh)
