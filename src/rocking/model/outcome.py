"""How a run ended, and the proof where there is one."""

from __future__ import annotations

from enum import StrEnum

from attrs import frozen


class Outcome(StrEnum):
    """What is known of a motion after its cycles: a plain string, and one of three.

    `BOUNDED` says only that neither of the others was proved in these cycles. `AT_REST` includes leaning on a brace
    for ever.
    """

    BOUNDED = "bounded"
    AT_REST = "at-rest"
    OVERTURNED = "overturned"


@frozen
class Overturning:
    """When it was proved that the block does not return.

    Attributes
    ----------
    time : float
        Normalised time τ of the proof.
    cycle : int
        The forcing cycle in which it fell, the first being 1.
    impacts : int
        Impacts before it.
    """

    time: float
    cycle: int
    impacts: int
