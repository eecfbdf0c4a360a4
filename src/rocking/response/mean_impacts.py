"""Mean number of impacts per forcing cycle of a classified response: its rotation number."""

from __future__ import annotations

import math

import numpy as np
from attrs import frozen

from rocking.model import Kind, Outcome, TooManyEvents, Verdict
from rocking.motion import simulate
from rocking.response.batch_means import batch_mean
from rocking.response.island_rotation import CERTAIN_DIGITS, average
from rocking.response.rotation_number import RotationNumber, flights_of, rotation_of, strikes_of

# Length of the run of a response whose impacts are counted, and number of cycles discarded before.
CYCLES, TRANSIENT = 20_000, 2_000


@frozen
class MeanImpacts:
    """Mean number of impacts at Θ = 0 per forcing cycle; returned by `mean_impacts`.

    Attributes
    ----------
    value, error : float
        Mean number and its error; NaN if there is none.
    rotation : RotationNumber or None
        Rotation numbers of an undamped motion, with the rotation within its island.
    """

    value: float
    error: float
    rotation: RotationNumber | None = None


UNKNOWN = MeanImpacts(math.nan, math.nan)


def mean_impacts(verdict: Verdict) -> MeanImpacts:
    """Return the mean number of impacts per forcing cycle of a classified response.

    A periodic response has the fraction (impacts per period)/period, and a block at rest has none. The impacts of other
    responses are counted in a run of `simulate`, which rounds differently from `classify`.

    Parameters
    ----------
    verdict : Verdict
        Result of `classify`.

    Returns
    -------
    MeanImpacts
        NaN if the block overturns, if the response is undetermined, or if infinitely many impacts precede rest.

    Examples
    --------
    >>> import rocking as rk
    >>> found = mean_impacts(rk.classify(rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)))
    >>> round(found.value, 6), found.error  # two impacts in three cycles
    (0.666667, 0.0)
    """
    if verdict.kind is Kind.REST:
        return MeanImpacts(0.0, 0.0)
    if verdict.kind is Kind.PERIODIC:
        return _of_orbit(verdict)
    if verdict.kind is Kind.QUASI_PERIODIC:
        return _on_torus(verdict)
    return _counted(verdict) if verdict.kind is Kind.CHAOTIC else UNKNOWN


def _of_orbit(verdict: Verdict) -> MeanImpacts:
    if verdict.period is None or verdict.impacts_per_period is None:
        return UNKNOWN
    return MeanImpacts(verdict.impacts_per_period / verdict.period, 0.0)


def _on_torus(verdict: Verdict) -> MeanImpacts:
    motion = simulate(verdict.system, verdict.start, CYCLES, record="all")
    try:
        strikes = strikes_of(motion)
    except ValueError:
        # This run rounds differently, and it overturns or rests.
        return UNKNOWN
    try:
        rotation = rotation_of(motion, *strikes)
    except ValueError:
        # The rotation within the island is not known. The mean number of impacts does not need it.
        rotation = None
    section = strikes[0]
    if section != "impacts":
        return MeanImpacts(0.0, 0.0, rotation)
    time, digits = average(flights_of(motion, section))
    return MeanImpacts(1.0 / time, 10.0 ** -min(digits, CERTAIN_DIGITS) / time, rotation)


def _counted(verdict: Verdict) -> MeanImpacts:
    """Count the impacts of a chaotic motion. The error is infinite if the run supports none, and there is no mean if the block rests."""
    try:
        motion = simulate(verdict.system, verdict.start, CYCLES + TRANSIENT, record="all")
    except TooManyEvents:
        return UNKNOWN
    events = motion.events[motion.events["cycle"] >= TRANSIENT]
    if motion.outcome is not Outcome.BOUNDED or np.isin(events["kind"], ("rest", "lean")).any():
        return UNKNOWN
    cycles = events["cycle"][events["kind"] == "impact"] - TRANSIENT
    mean = batch_mean(np.bincount(cycles, minlength=CYCLES)[:CYCLES])
    return MeanImpacts(mean.value, mean.error)
