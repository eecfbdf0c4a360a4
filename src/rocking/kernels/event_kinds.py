"""Modes of motion between events, and the events that end them."""

from enum import IntEnum


class MotionMode(IntEnum):
    """Mode of motion between two events."""

    FLIGHT = 0
    REST = 1
    LEAN = 2


# Kernels use plain integers: an enum member would be a second type, for which every function is compiled
# again.
FLIGHT, REST, LEAN = (int(mode) for mode in MotionMode)


class Event(IntEnum):
    """Event that ends an arc, a rest or a sustained contact with a brace; NONE if there is none."""

    IMPACT = 0
    BRACE = 1
    RESTS = 2
    LIFT_OFF = 3
    LEANS = 4
    LEAVE = 5
    NONE = 6


IMPACT, BRACE, RESTS, LIFT_OFF, LEANS, LEAVE, NONE = (int(event) for event in Event)
