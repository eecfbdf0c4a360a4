"""Checks of the initial state of a motion."""

from __future__ import annotations

import math

from rocking.model.system import MAX_START, State, System, check_between
from rocking.model.validation import instance, refuse_if, within


def check_start(system: System, start: State | None) -> State:
    """Return the initial state of a motion, by default at rest.

    Raises
    ------
    TypeError
        If `system` is not a System or `start` is not a State.
    ValueError
        If the initial state lies outside [-1000, 1000], beyond a brace, or where a full block lies flat.
    """
    instance("system", system, System)
    start = State() if start is None else instance("start", start, State)
    within("angle", start.angle, -MAX_START, MAX_START)
    within("velocity", start.velocity, -MAX_START, MAX_START)
    if system.braces is not None:
        check_between(start.angle, system.braces.angle)
    if system.critical_angle is not None:
        flat = 0.5 * math.pi / system.critical_angle
        allowed = f"lie within ±{flat:.6g}, where the block lies flat"
        refuse_if(abs(start.angle) >= flat, "angle", allowed, start.angle)
    return start


def check_periodic(system: System, start: State | None) -> State:
    """Return the initial state as `check_start` does, for an analysis that needs a periodic base motion.

    Raises
    ------
    TypeError
        If the base motion is not periodic, or as in `check_start`.
    ValueError
        As in `check_start`.
    """
    instance("system", system, System).periodic  # noqa: B018 (it refuses)
    return check_start(system, start)
