"""Impact law, eq. (2) of Yim & Lin (1991): Theta'(after) = e Theta'(before); impacts at braces; the states after all other events."""

import math

from rocking.kernels.block.chattering import base_settling_time, brace_settling_within
from rocking.kernels.block.rest import side_to_lift
from rocking.kernels.contract import (
    arc_after,
    arc_renewed,
    has_wall,
    restitution_at,
    stays_leaning,
)
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, LEAN, LEAVE, LIFT_OFF, REST
from rocking.kernels.library.kernel import kernel

# In a recorded motion chattering impacts are resolved one by one down to this speed.
SLOWEST = 1e-13
# A speed below this counts as zero. If the acceleration into the contact nearly vanishes, chattering cannot
# be proved to end.
NEGLIGIBLE = 1e-30
# Above this speed chattering is not tested.
SLOW = 0.1


@kernel(inline=True)
def side_after_impact(p, side):
    """Return the side of the arc after an impact that ends one on a side: the other one, or the same one at a wall."""
    return side if has_wall(p) else -side


@kernel(inline=True)
def after_impact(p, arc, time, coming, horizon, peak):
    """Return mode and arc after an impact at the base, eq. (2), or at a wall, which reverses the velocity.

    ``horizon`` is the time in which nothing is recorded, so that chattering may be cut short. It is not cut if an
    angle may exceed ``peak``, the largest one so far: while the base moves on, a slower arc may be higher. If the
    block returns before the clock has advanced, it has not left; the same holds at a brace.

    Returns
    -------
    tuple of (int, Arc)
        Mode and arc.
    """
    before = max(-coming.velocity, 0.0)
    restitution, _ = restitution_at(p, arc.side, before)
    speed = restitution * before
    side, mode = side_after_impact(p, arc.side), FLIGHT
    if speed < NEGLIGIBLE and (restitution < 1.0 or speed == 0.0):
        speed, side = 0.0, side_to_lift(p, time, coming.drive)
        if side == 0 or time == arc.start:
            side, mode = arc.side, REST
    after = arc_after(p, side, time, 0.0, speed, coming)
    may_cut = horizon > 0.0 or speed < SLOWEST
    if may_cut and mode == FLIGHT and 0.0 < speed < SLOW and restitution < 1.0:
        settled = base_settling_time(
            p, after.side, after.drive, speed, peak if speed >= SLOWEST else math.inf
        )
        if settled < math.inf and (settled <= horizon or speed < SLOWEST):
            mode = REST
    if mode == REST:
        after = arc_renewed(p, side, time, 0.0, 0.0, coming)
    return mode, after


@kernel
def after_brace(p, arc, time, coming, horizon):
    """Return mode and arc after a brace impact; arguments as for ``after_impact``.

    Returns
    -------
    tuple of (int, Arc)
        Mode and arc.
    """
    speed = p.block.brace_restitution * max(coming.velocity, 0.0)
    if speed < NEGLIGIBLE and p.block.brace_restitution < 1.0:
        speed = 0.0
    if speed >= SLOW:
        # Only a slow arc depends on the last digits of its acceleration.
        return FLIGHT, arc_after(p, arc.side, time, p.block.brace_angle, -speed, coming)
    after = arc_renewed(p, arc.side, time, p.block.brace_angle, -speed, coming)
    mode = FLIGHT
    if speed == 0.0:
        if stays_leaning(p, after) or time == arc.start:
            mode = LEAN
    elif p.block.brace_restitution < 1.0 and (horizon > 0.0 or speed < SLOWEST):
        settled = brace_settling_within(p, after.side, after.drive, speed)
        if settled < math.inf and (settled <= horizon or speed < SLOWEST):
            mode = LEAN
    if mode == LEAN:
        after = arc_renewed(p, arc.side, time, p.block.brace_angle, 0.0, coming)
    return mode, after


@kernel(inline=True)
def after_chattering(p, arc, time, coming):
    """Return mode and arc after an impact at the base whose chattering ends in rest."""
    return REST, arc_renewed(p, side_after_impact(p, arc.side), time, 0.0, 0.0, coming)


@kernel(inline=True)
def after_event(p, arc, time, coming, horizon, peak):
    """Return mode and arc after the coming event; arguments as for ``after_impact``.

    Returns
    -------
    tuple of (int, Arc)
        Mode and arc.
    """
    if coming.event == IMPACT:
        return after_impact(p, arc, time, coming, horizon, peak)
    if coming.event == BRACE:
        return after_brace(p, arc, time, coming, horizon)
    if coming.event == LIFT_OFF:
        return FLIGHT, arc_renewed(p, coming.side, time, 0.0, 0.0, coming)
    if coming.event == LEAVE:
        return FLIGHT, arc_renewed(p, arc.side, time, p.block.brace_angle, 0.0, coming)
    return FLIGHT, arc_renewed(p, arc.side, time, coming.angle, coming.velocity, coming)
