"""Outcome of a simulated motion, with the proof of overturning."""

from __future__ import annotations

from enum import StrEnum

from attrs import frozen


class Outcome(StrEnum):
    """State of knowledge about a motion after the simulated cycles: a string, one of three.

    `BOUNDED` means only that neither of the other outcomes was proved in these cycles. `AT_REST` includes permanent
    contact with a brace.

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
    """Instant from which overturning is certain.

    Attributes
    ----------
    time : float
        Normalised time τ of the proof.
    cycle : int
        Forcing cycle of the proof, counted from 0.
    impacts : int
        Number of impacts before it.

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
