"""What happens at an event: impact (2), brace impact, the limits of accumulating impacts, lift-off and leaving a brace."""

import math
from enum import IntEnum

from numba import njit

from .arc import forcing_term
from .elementary import COMPILED, INLINED
from .harmonic import drift, first_cut

# Accumulating impacts of a recorded motion go on, one by one, down to this speed.
SLOWEST = 1e-13


class Mode(IntEnum):
    """What the block does between events."""

    FLIGHT = 0
    REST = 1
    LEAN = 2


# Kernels compute with plain integers: an enum member would give every function a second type to be compiled for.
FLIGHT, REST, LEAN = (int(mode) for mode in Mode)


class Event(IntEnum):
    """What can end an arc, a rest or a lean; NONE where nothing does."""

    IMPACT = 0
    BRACE = 1
    RESTS = 2
    LIFT_OFF = 3
    LEANS = 4
    LEAVE = 5
    NONE = 6


IMPACT, BRACE, RESTS, LIFT_OFF, LEANS, LEAVE, NONE = (int(event) for event in Event)


@njit(**COMPILED)
def settling_time(speed, restitution, weakest, strongest, room):
    """A bound on how long impacts go on that start at ``speed`` and are pressed back with ``weakest`` to ``strongest``; infinite where they need not end.

    A hop's height stays below h = speed**2/weakest (<= weakest/2), so the press, less u, stays above ``weakest - h``; each impact returns at most ``ratio`` times the
    speed it left with, so speeds fall geometrically by restitution*ratio, and a hop lasts at most (1 + ratio)/(weakest - h) times its speed.
    """
    height = speed * speed / weakest
    if not (weakest > 0.0 and height <= 0.5 * min(weakest, room)):
        return math.inf
    press = weakest - height
    ratio = math.sqrt(strongest / press)
    fall = restitution * ratio
    if fall >= 1.0:
        return math.inf
    return speed * (1.0 + ratio) / (press * (1.0 - fall))


@njit(**COMPILED)
def base_settling_time(p, cosine, sine, speed):
    """A bound on the time from an impact to rest (Zeno limit at the base), infinite where rest is not certain.

    On the sides of the base the block is pressed back with 1 +- A cos psi; both stay positive within the window, so it ends before lift-off.
    """
    swing = p.amplitude * abs(cosine)
    if p.restitution >= 1.0 or swing >= 1.0:
        return math.inf
    window = 5.0 * speed / ((1.0 - swing) * (1.0 - p.restitution))
    moved = drift(p, cosine, sine, window)
    near = settling_time(speed, p.restitution, 1.0 - swing - moved, 1.0 - swing + moved, p.brace_angle)
    far = settling_time(speed, p.restitution, 1.0 + swing - moved, 1.0 + swing + moved, p.brace_angle)
    bound = max(near, far)
    return bound if bound <= window else math.inf


@njit(**COMPILED)
def brace_settling_time(p, cosine, sine, speed):
    """A bound on the time from a brace hit to leaning, infinite where leaning is not certain; the brace is pressed with brace_angle + f."""
    press = p.brace_angle + forcing_term(p, cosine)
    if p.brace_restitution >= 1.0 or press <= 0.0:
        return math.inf
    window = 5.0 * speed / (press * (1.0 - p.brace_restitution))
    moved = drift(p, cosine, sine, window)
    bound = settling_time(speed, p.brace_restitution, press - moved, press + moved, p.brace_angle)
    return bound if bound <= window else math.inf


@njit(**INLINED)
def side_to_lift(cosine_psi):
    """The side on which a block at rest lifts: -sign(cos psi)."""
    return -1 if cosine_psi > 0.0 else 1


@njit(**COMPILED)
def wait_at_rest(p, psi):
    """(time until |A cos psi| exceeds 1, side of the lift-off); infinite for A <= 1."""
    if p.base_half == math.inf:
        return math.inf, 1
    wait, side = math.inf, 1
    for candidate in (1, -1):
        cut, pressed = first_cut(p, candidate, psi, 0.0, p.base_half)
        if not pressed:
            return 0.0, candidate
        if cut < wait:
            wait, side = cut, candidate
    return wait, side


@njit(**COMPILED)
def wait_leaning(p, side, psi):
    """Time until the brace is no longer pressed, brace_angle + f <= 0; infinite where it always is."""
    if p.brace_half == math.inf:
        return math.inf if p.brace_angle > 1.0 else 0.0
    cut, leaving = first_cut(p, side, psi, 0.0, p.brace_half)
    return 0.0 if leaving else cut
