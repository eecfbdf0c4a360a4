"""How a run ended, and the proof where there is one."""

from __future__ import annotations

from enum import StrEnum

from attrs import frozen


class Outcome(StrEnum):
    """What is known of a motion after its cycles: a plain string, and one of three.

    `BOUNDED` says only that neither of the others was proved in these cycles. `AT_REST` includes leaning on a brace
    for ever.

    Examples
    --------
    >>> import rocking as rk
    >>> motion = rk.simulate(rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9))
    >>> motion.outcome is rk.Outcome.AT_REST, motion.outcome == "at-rest", str(motion.outcome)
    (True, True, 'at-rest')
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
        The forcing cycle of the proof, counted from 0, as everywhere.
    impacts : int
        Impacts before it.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
    >>> rk.simulate(system).overturning
    Overturning(time=10.309, cycle=5, impacts=4)
    """

    time: float
    cycle: int
    impacts: int
