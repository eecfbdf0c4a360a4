"""Rotation numbers of motion without loss, by weighted Birkhoff averages on the section of its impacts."""

from __future__ import annotations

import math

import numpy as np
from attrs import evolve, frozen
from numpy.typing import NDArray

from rocking.model import Outcome, State, System, TooShort, counted, ordinal, refusal, whole
from rocking.motion import Motion, simulate
from rocking.response.island_rotation import (
    MIN_TURNS,
    REGULAR_DIGITS,
    average,
    deviations,
    fraction_of,
    turning_of,
)

Array = NDArray[np.float64]

MAX_CYCLES = 1_000_000
# Chaotic motions do not agree in as many.
CHAOTIC_DIGITS = 6
ISLANDS_WITHIN = 4


@frozen
class RotationNumber:
    """How a motion without loss turns, in what is locked to the forcing and in what is free; made by `rotation_number`.

    Attributes
    ----------
    system, start : System, State
        What was followed.
    cycles : int
        Forcing cycles followed.
    section : str
        "impacts", or "brace hits" where no impact occurs.
    per_cycle : float
        Impacts (or brace hits) per forcing cycle.
    locked : tuple of int, or None
        (p, q): exactly p impacts in q cycles, to all the digits found; None where the two are incommensurate.
    period : int
        Cycles after which the island comes back to itself, a multiple of q; 1 where nothing is locked.
    free : float or None
        Turns in `period` cycles, in [0, 1): about the centre of the island, counter-clockwise in the plane of Θ and Θ′.
        Where nothing is locked `per_cycle` itself; None within 1e-6 of the centre, a periodic motion.
    digits : int
        In how many both halves of the run agree, on the worse of the numbers found.
    """

    system: System
    start: State
    cycles: int
    section: str
    per_cycle: float
    locked: tuple[int, int] | None
    period: int
    free: float | None
    digits: int

    def __str__(self) -> str:
        known = f"to {self.digits} digits over {self.cycles} cycles"
        if self.locked is None:
            return f"free: {self.per_cycle:.{self.digits}g} {self.section} per cycle, {known}"
        strikes = counted(self.locked[0], self.section.removesuffix("s"))
        locked = f"locked: {strikes} in {counted(self.locked[1], 'cycle')}"
        if self.free is None:
            return f"{locked}; nothing turns about them, {known}"
        return (
            f"{locked}; free: {self.free:.{self.digits}g} turns in {counted(self.period, 'cycle')}, {known}"
        )


def rotation_number(system: System, start: State | None = None, cycles: int = 20_000) -> RotationNumber:
    """Measure how often a motion without loss strikes per cycle, and how it turns about what is locked to the forcing.

    Flight times between impacts, and speeds and phases at impacts, are analytic functions on the torus that a regular
    motion fills; the stroboscopic states are not. So weighted Birkhoff averages over impacts find a frequency to many
    digits. Where the impacts are locked to the forcing, p in q cycles, every p-th lies on a closed curve, and the
    free frequency is its rotation about the curve's mean; a rotation that is a fraction itself belongs to islands within
    islands, about whose own centres it is measured anew.

    Parameters
    ----------
    system : System
        The block, its forcing and its braces.
    start : State, optional
        Θ and Θ' at τ = 0; at rest by default.
    cycles : int
        Forcing cycles to follow, 1 to 10⁶.

    Returns
    -------
    RotationNumber

    Raises
    ------
    TooShort
        Where the halves of the run agree to fewer than 9 digits: chaotic motion, or too few cycles. Its `estimate` is
        what was found.
    ValueError
        For motion that loses something (an impact with e < 1, a brace hit with r < 1, rest, leaning), that overturns
        or that never strikes; for motion locked to the forcing that turns about nothing, as in an island so bent that
        its mean lies outside; or for an argument outside its range.
    TypeError
        For an argument of the wrong type.

    See Also
    --------
    spectral_density : Spectral lines of a motion.
    classify : Response type with its evidence.

    Notes
    -----
    Not guaranteed: that a fraction with a denominator up to 500 met to all digits is one; an irrational number can
    come as close, with a chance of about 10⁻⁴ at 9 digits.

    References
    ----------
    Das, Saiki, Sander & Yorke, Nonlinearity 30, 4111–4140 (2017).

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
    >>> turning = rk.rotation_number(system)
    >>> turning.locked, turning.period, round(turning.free, 10)
    ((2, 3), 3, 0.4744150886)
    """
    motion = simulate(system, start, cycles=whole("cycles", cycles, 1, MAX_CYCLES), record="all")
    section, phases, speeds = _strikes(motion)
    flights = _flights(motion, section)
    mean, digits = average(flights)
    found = RotationNumber(
        system=system,
        start=motion.start,
        cycles=motion.cycles,
        section=section,
        per_cycle=1.0 / mean,
        locked=None,
        period=1,
        free=1.0 / mean,
        digits=digits,
    )
    _check(found)
    fraction = fraction_of(found.per_cycle, digits)
    if fraction is None:
        return found
    locked = evolve(
        found, locked=(fraction.numerator, fraction.denominator), period=fraction.denominator, free=None
    )
    return _about_the_centre(locked, phases, speeds)


def _strikes(motion: Motion) -> tuple[str, Array, Array]:
    """What the section is made of, and forcing phase and speed just before, strike by strike; refused where anything is lost."""
    system, kinds = motion.system, motion.events["kind"]
    if motion.outcome is Outcome.OVERTURNED:
        raise ValueError("the block must stay up for a rotation number; it overturns (take a weaker forcing)")
    if np.isin(kinds, ("rest", "lean")).any() or motion.outcome is Outcome.AT_REST:
        raise ValueError("a rotation number needs motion that goes on without loss; the block comes to rest")
    if motion.impacts and system.restitution < 1.0:
        raise ValueError(
            refusal("restitution", "be 1 for a rotation number: motion without loss", system.restitution)
        )
    if motion.brace_hits and system.braces is not None and system.braces.restitution < 1.0:
        raise ValueError(
            refusal(
                "braces.restitution",
                "be 1 for a rotation number: motion without loss",
                system.braces.restitution,
            )
        )
    section, kind = (
        ("brace hits", "brace") if motion.brace_hits and not motion.impacts else ("impacts", "impact")
    )
    strikes = motion.events[kinds == kind]
    if len(strikes) < 4:
        raise ValueError(
            f"too few {section} for a rotation number: {len(strikes)} in {counted(motion.cycles, 'cycle')} (take more cycles)"
        )
    return section, strikes["phase"], np.abs(strikes["before"])


def _flights(motion: Motion, section: str) -> Array:
    """Forcing cycles between strikes, each to full precision however late in the run."""
    strikes = motion.events[motion.events["kind"] == ("impact" if section == "impacts" else "brace")]
    parts = np.diff(strikes["phase"]) / (2.0 * math.pi)
    return parts + np.round(np.diff(strikes["time"]) / motion.system.forcing.period - parts)


def _check(found: RotationNumber) -> None:
    if found.digits >= REGULAR_DIGITS:
        return
    why = (
        "as on chaotic motion, or over too few cycles"
        if found.digits < CHAOTIC_DIGITS
        else "take more cycles"
    )
    raise TooShort(
        f"the halves of {found.cycles} cycles agree to {found.digits} digits where a rotation number needs "
        f"{REGULAR_DIGITS} ({why})",
        found,
    )


def _about_the_centre(locked: RotationNumber, phases: Array, speeds: Array) -> RotationNumber:
    """The rotation of every p-th strike about its mean, and, where that is a fraction, about the centres of smaller islands."""
    assert locked.locked is not None
    found, stride = locked, locked.locked[0]
    for _ in range(ISLANDS_WITHIN):
        points = deviations(phases[::stride], speeds[::stride])
        if points is None:
            return found
        if len(points) < MIN_TURNS:
            raise TooShort(
                f"{found.cycles} cycles are {len(points)} periods of the island: too few for a rotation number (take more cycles)",
                found,
            )
        mean, digits, pieces = turning_of(points)
        if mean is None:
            each = "each" if stride == 1 else f"every {ordinal(stride)}"
            raise ValueError(
                f"start must lie on a curve that surrounds its own mean; {each} of the {found.section}, {stride} in "
                f"{counted(found.period, 'cycle')}, lies on none (the motion is chaotic, or its curve is bent: take another start)"
            )
        turning = evolve(found, free=mean, digits=min(found.digits, digits))
        _check(turning)
        if pieces == 1:
            return turning
        stride *= pieces
        found = evolve(turning, free=None, period=found.period * pieces)
    return found
