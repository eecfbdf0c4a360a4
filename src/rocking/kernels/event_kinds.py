"""What a block does between events, and what can end an arc, a rest or a lean."""

from enum import IntEnum


class MotionMode(IntEnum):
    """What the block does between events."""

    FLIGHT = 0
    REST = 1
    LEAN = 2


# Kernels compute with plain integers: an enum member would give every function a second type to be compiled
# for.
FLIGHT, REST, LEAN = (int(mode) for mode in MotionMode)


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
