"""Rotation numbers of undamped motions, from weighted Birkhoff averages on the section of their impacts."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from attrs import evolve, frozen
from numpy.typing import NDArray

from rocking.kernels.numerics import averages
from rocking.model.result import Result, described
from rocking.model.system import State, System, check_periodic, quantities
from rocking.model.text import counted, ordinal
from rocking.model.validation import Refusal, TooShort, whole
from rocking.model.verdict import Outcome
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

MIN_TURNS = 64
# Number of digits to which averages over both halves of a regular motion agree.
REGULAR_DIGITS = 9
MAX_DIGITS = 15
MAX_LOCK = 500
# An average over about ten thousand rounded arcs is accurate to no more digits, even if its halves agree better.
CERTAIN_DIGITS = 14
# A smaller island, compared with speeds and phases of order one, is dominated by rounding and counts as a point.
POINT = 1e-6
# Largest angular gap of a closed curve with many points, as seen from inside.
WIDEST_GAP = 1.5
WIDEST_JUMP = 0.25


def average(values: Array) -> tuple[float, int]:
    """Return the weighted Birkhoff average of a sequence and the number of digits of agreement of its halves.

    Returns
    -------
    tuple of (float, int)
        Average; number of digits, 15 at most.
    """
    values = np.ascontiguousarray(values)
    weights = np.empty((len(values) + 1) // 2)
    mean, digits = averages.mean_and_digits(values, weights)
    return mean, min(max(math.floor(digits), 0), MAX_DIGITS)


def fraction_of(value: float, digits: int) -> Fraction | None:
    """Return the fraction that equals a number to all its digits, or None."""
    near = Fraction(value).limit_denominator(MAX_LOCK)
    off = 10.0 ** (1 - min(digits, CERTAIN_DIGITS)) * max(abs(value), 1.0 / MAX_LOCK)
    return near if abs(value - near) <= off else None


def deviations(phases: Array, speeds: Array) -> Array | None:
    """Return speeds and phases relative to their means, shape (n, 2), scaled to 1 at most; None if all points coincide.

    In this order, counter-clockwise here is counter-clockwise in (Θ, Θ') for both directions of crossing Θ = 0. The reason
    is that Θ, Θ', ψ form a right-handed system. The motion crosses one section towards growing ψ, and the other towards
    growing Θ (or −Θ).
    """
    offsets = np.mod(phases - phases[0] + math.pi, 2.0 * math.pi) - math.pi
    speeds = np.ascontiguousarray(speeds)
    weights = np.empty((len(speeds) + 1) // 2)
    points = np.column_stack(
        [
            speeds - averages.mean_and_digits(speeds, weights)[0],
            offsets - averages.mean_and_digits(offsets, weights)[0],
        ]
    )
    sizes = np.abs(points).max(axis=0)
    return None if sizes.max() < POINT else points / np.maximum(sizes, POINT)


def turning_of(points: Array) -> tuple[float | None, int, int]:
    """Return the mean rotation from point to point about the origin, its digits and the number of islands.

    Points on a curve that does not surround its mean are straightened first, by subtracting a parabola.

    Returns
    -------
    tuple of (float or None, int, int)
        Mean rotation in turns (None without a closed curve); digits of agreement; number of islands.
    """
    fast, late = points.T
    for x, y in ((fast, late), (_unbent(fast, late), late), (fast, _unbent(late, fast))):
        angles = np.arctan2(y, x)
        mean, digits = average(np.mod(np.diff(angles), 2.0 * math.pi) / (2.0 * math.pi))
        fraction = fraction_of(mean, digits) if digits >= REGULAR_DIGITS else None
        if fraction is not None and fraction.denominator > 1:
            return mean, digits, fraction.denominator
        if fraction is None and _surrounds(angles, np.hypot(x, y)):
            return mean, digits, 1
    return None, 0, 1


def _unbent(bent: Array, along: Array) -> Array:
    """Return one coordinate minus its least-squares parabola over the other, scaled to 1 at most."""
    straight = bent - np.polynomial.Polynomial.fit(along, bent, 2)(along)
    return straight / max(float(np.abs(straight).max()), POINT)


def _surrounds(angles: Array, radii: Array) -> bool:
    """Return whether points lie on one curve around the origin, with one point in every direction."""
    order = np.argsort(angles)
    gaps = np.diff(angles[order], append=angles[order[0]] + 2.0 * math.pi)
    jumps = np.abs(np.diff(radii[order], append=radii[order[0]]))
    return bool(gaps.max() <= WIDEST_GAP and jumps[gaps < 0.1].max(initial=0.0) <= WIDEST_JUMP * radii.max())


MAX_CYCLES = 1_000_000
# Averages over both halves of a chaotic motion agree to fewer digits.
CHAOTIC_DIGITS = 6
ISLANDS_WITHIN = 4


@frozen
class RotationNumber(Result):
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

    def _data(self) -> xr.Dataset:
        import xarray as xr

        impacts, cycles = self.locked or (None, None)
        attributes = described("Rotation number") | {
            **quantities(self.system),
            "start_angle": self.start.angle,
            "start_velocity": self.start.velocity,
            "cycles": self.cycles,
            "section": self.section,
            "per_cycle": self.per_cycle,
            "locked_impacts": impacts,
            "locked_cycles": cycles,
            "island_period": self.period,
            "free": self.free,
            "digits": self.digits,
        }
        return xr.Dataset(attrs=attributes)

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
    result = RotationNumber(
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
    _check(result)
    fraction = fraction_of(result.per_cycle, digits)
    if fraction is None:
        return result
    locked = evolve(
        result, locked=(fraction.numerator, fraction.denominator), period=fraction.denominator, free=None
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
    if motion.impacts and not system.lossless:
        raise Refusal("restitution", "be 1 for a rotation number (no dissipation)", system.restitution)
    if motion.brace_hits and system.braces is not None and system.braces.restitution < 1.0:
        raise Refusal(
            "braces.restitution",
            "be 1 for a rotation number (no dissipation)",
            system.braces.restitution,
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


def _check(result: RotationNumber) -> None:
    if result.digits >= REGULAR_DIGITS:
        return
    why = "the motion is chaotic, or cycles too few" if result.digits < CHAOTIC_DIGITS else "increase cycles"
    raise TooShort(
        f"both halves of {result.cycles} cycles agree to {result.digits} digits, but a rotation number requires "
        f"{REGULAR_DIGITS} ({why})",
        result,
    )


def _about_the_centre(locked: RotationNumber, phases: Array, speeds: Array) -> RotationNumber:
    """Measure the rotation of every p-th impact about its mean; if it is a fraction, about the centres of smaller islands."""
    assert locked.locked is not None
    result, stride = locked, locked.locked[0]
    for _ in range(ISLANDS_WITHIN):
        points = deviations(phases[::stride], speeds[::stride])
        if points is None:
            return result
        if len(points) < MIN_TURNS:
            raise TooShort(
                f"{result.cycles} cycles are {len(points)} periods of the island, too few for a rotation number (increase cycles)",
                result,
            )
        mean, digits, pieces = turning_of(points)
        if mean is None:
            each = "each" if stride == 1 else f"every {ordinal(stride)}"
            raise ValueError(
                f"start must lie on a curve that surrounds its own mean; {each} of the {result.section}, {stride} in "
                f"{counted(result.period, 'cycle')}, does not (the motion is chaotic, or its curve is strongly bent: change start)"
            )
        turning = evolve(result, free=mean, digits=min(result.digits, digits))
        _check(turning)
        if pieces == 1:
            return turning
        stride *= pieces
        result = evolve(turning, free=None, period=result.period * pieces)
    return result
