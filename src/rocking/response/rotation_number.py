"""Rotation numbers of undamped motions, from weighted Birkhoff averages on the section of their impacts."""

from __future__ import annotations

import math

import numpy as np
from attrs import evolve, frozen
from numpy.typing import NDArray

from rocking.model import Outcome, State, System, TooShort, check_periodic, counted, ordinal, refusal, whole
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
# Averages over both halves of a chaotic motion agree to fewer digits.
CHAOTIC_DIGITS = 6
ISLANDS_WITHIN = 4


@frozen
class RotationNumber:
    """Rotation numbers of an undamped motion: the part locked to the forcing and the free part; returned by `rotation_number`.

    Attributes
    ----------
    system, start : System, State
        System and initial state.
    cycles : int
        Number of forcing cycles simulated.
    section : str
        "impacts", or "brace hits" if no impact at Θ = 0 occurs.
    per_cycle : float
        Number of impacts (or brace impacts) per forcing cycle.
    locked : tuple of int, or None
        (p, q): p impacts in q cycles, to all digits found. None if the impacts are incommensurate with the forcing.
    period : int
        Number of cycles after which the island returns to itself, a multiple of q; 1 if `locked` is None.
    free : float or None
        Turns about the island centre per `period` cycles, in [0, 1), counter-clockwise in the (Θ, Θ') plane. Equal to
        `per_cycle` if `locked` is None. None within 1e-6 of the centre, that is, for a periodic motion.
    digits : int
        Number of digits to which both halves of the run agree, for the least accurate of these numbers.

    Examples
    --------
    >>> import rocking as rk
    >>> print(rk.rotation_number(rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)))
    locked: 2 impacts in 3 cycles; free: 0.47441508... turns in 3 cycles, to ... digits over 20000 cycles
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
            return f"{locked}; no rotation about the island centre (periodic motion), {known}"
        return (
            f"{locked}; free: {self.free:.{self.digits}g} turns in {counted(self.period, 'cycle')}, {known}"
        )


def rotation_number(system: System, start: State | None = None, cycles: int = 20_000) -> RotationNumber:
    """Compute the rotation numbers of an undamped motion: impacts per cycle, and the rotation about the island centre.

    On a regular motion, which fills a torus, the times between impacts and the speeds and phases at impacts are analytic
    functions on the torus. The stroboscopic states are not. Weighted Birkhoff averages over impacts therefore give the
    frequencies to many digits.

    If the impacts are locked to the forcing, p in q cycles, every p-th impact lies on a closed curve. The free rotation
    number is that of these impacts about their mean. If it is a fraction, the motion lies on smaller islands. The rotation
    is then measured about the centre of one of them.

    Parameters
    ----------
    system : System
        Block, base motion and braces, without dissipation in the motion.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0. Default: at rest.
    cycles : int
        Number of forcing cycles, in [1, 10⁶]. Default: 20,000.

    Returns
    -------
    RotationNumber
        Locked and free rotation numbers, with their digits.

    Raises
    ------
    TooShort
        If the halves of the run agree to fewer than 9 digits: chaotic motion, or too few cycles. Its `estimate` is the
        result so far.
    ValueError
        If the motion dissipates energy: impacts with e < 1, brace impacts with r < 1, rest, sustained contact with a brace.
        If the block overturns, or has no impacts. If the points of a locked motion surround no mean, as on a strongly bent
        island. If an argument lies outside its range.
    TypeError
        If an argument is of the wrong type.

    See Also
    --------
    spectral_density : Spectral lines of a motion.
    classify : Response type with its evidence.

    Notes
    -----
    Limit: a fraction with a denominator up to 500 that agrees to all digits is taken as exact. An irrational number can be
    as close, with a probability of about 10⁻⁴ at 9 digits.

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
    start = check_periodic(system, start)
    motion = simulate(system, start, cycles=whole("cycles", cycles, 1, MAX_CYCLES), record="all")
    return rotation_of(motion, *strikes_of(motion))


def rotation_of(motion: Motion, section: str, phases: Array, speeds: Array) -> RotationNumber:
    """Return the rotation numbers of a motion from its impacts, as `strikes_of` gives them; errors as of `rotation_number`."""
    mean, digits = average(flights_of(motion, section))
    found = RotationNumber(
        system=motion.system,
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


def strikes_of(motion: Motion) -> tuple[str, Array, Array]:
    """Return the impacts of an undamped motion.

    Returns
    -------
    tuple of (str, ndarray, ndarray)
        Type of section; forcing phases and speeds just before each impact.

    Raises
    ------
    ValueError
        If the motion dissipates energy, overturns or has too few impacts.
    """
    system, kinds = motion.system, motion.events["kind"]
    if motion.outcome is Outcome.OVERTURNED:
        raise ValueError(
            "the block must stay upright for a rotation number; it overturns (reduce the forcing)"
        )
    if np.isin(kinds, ("rest", "lean")).any() or motion.outcome is Outcome.AT_REST:
        raise ValueError("a rotation number requires a motion without dissipation; the block comes to rest")
    if motion.impacts and system.restitution < 1.0:
        raise ValueError(
            refusal("restitution", "be 1 for a rotation number (no dissipation)", system.restitution)
        )
    if motion.brace_hits and system.braces is not None and system.braces.restitution < 1.0:
        raise ValueError(
            refusal(
                "braces.restitution",
                "be 1 for a rotation number (no dissipation)",
                system.braces.restitution,
            )
        )
    section, kind = (
        ("brace hits", "brace") if motion.brace_hits and not motion.impacts else ("impacts", "impact")
    )
    strikes = motion.events[kinds == kind]
    if len(strikes) < 4:
        raise ValueError(
            f"too few {section} for a rotation number: {len(strikes)} in {counted(motion.cycles, 'cycle')} (increase cycles)"
        )
    return section, strikes["phase"], np.abs(strikes["before"])


def flights_of(motion: Motion, section: str) -> Array:
    """Return the times between impacts in forcing cycles, to full precision at any time in the run."""
    strikes = motion.events[motion.events["kind"] == ("impact" if section == "impacts" else "brace")]
    parts = np.diff(strikes["phase"]) / (2.0 * math.pi)
    return parts + np.round(np.diff(strikes["time"]) / motion.system.periodic.period - parts)


def _check(found: RotationNumber) -> None:
    if found.digits >= REGULAR_DIGITS:
        return
    why = "the motion is chaotic, or cycles too few" if found.digits < CHAOTIC_DIGITS else "increase cycles"
    raise TooShort(
        f"both halves of {found.cycles} cycles agree to {found.digits} digits, but a rotation number requires "
        f"{REGULAR_DIGITS} ({why})",
        found,
    )


def _about_the_centre(locked: RotationNumber, phases: Array, speeds: Array) -> RotationNumber:
    """Measure the rotation of every p-th impact about its mean; if it is a fraction, about the centres of smaller islands."""
    assert locked.locked is not None
    found, stride = locked, locked.locked[0]
    for _ in range(ISLANDS_WITHIN):
        points = deviations(phases[::stride], speeds[::stride])
        if points is None:
            return found
        if len(points) < MIN_TURNS:
            raise TooShort(
                f"{found.cycles} cycles are {len(points)} periods of the island, too few for a rotation number (increase cycles)",
                found,
            )
        mean, digits, pieces = turning_of(points)
        if mean is None:
            each = "each" if stride == 1 else f"every {ordinal(stride)}"
            raise ValueError(
                f"start must lie on a curve that surrounds its own mean; {each} of the {found.section}, {stride} in "
                f"{counted(found.period, 'cycle')}, does not (the motion is chaotic, or its curve is strongly bent: change start)"
            )
        turning = evolve(found, free=mean, digits=min(found.digits, digits))
        _check(turning)
        if pieces == 1:
            return turning
        stride *= pieces
        found = evolve(turning, free=None, period=found.period * pieces)
    return found
