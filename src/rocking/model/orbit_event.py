"""Event of a periodic orbit, from which states of the orbit are computed."""

from __future__ import annotations

from attrs import frozen


@frozen
class OrbitEvent:
    """State of an orbit at an instant where its velocity may jump, accurate to rounding even on an unstable orbit."""

    turned: float
    """Forcing phase, rad, from the orbit's `state` to the event."""
    angle: float
    before: float
    """Θ' just before the event."""
    after: float
