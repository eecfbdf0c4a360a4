"""An event of a periodic orbit, from which its states are marched."""

from __future__ import annotations

from attrs import frozen


@frozen
class OrbitEvent:
    """A state of an orbit where its velocity may jump, known to rounding however unstable the orbit is."""

    turned: float
    """Forcing phase, rad, from the orbit's `state` to the event."""
    angle: float
    before: float
    """Θ' just before the event."""
    after: float
