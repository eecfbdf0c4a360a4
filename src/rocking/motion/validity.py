"""Validity of the model for a motion: no sliding, no uplift, and a slender block (Housner 1963).

The smallest value of a quotient along a motion is found by division of the arcs where it can still be smaller.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from attrs import evolve, frozen
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from rocking.kernels.march import finite_runs, initial_state
from rocking.kernels.march import march as kernel
from rocking.model.block import Block
from rocking.model.forcing import Harmonic
from rocking.model.validation import instance, refuse_if
from rocking.model.verdict import Outcome
from rocking.motion.march_loop import is_lossless, outcome_of, parameters, run
from rocking.motion.model_warnings import block_warnings, degrees_too, slender_errors

if TYPE_CHECKING:
    from rocking.motion.trajectory import Trajectory


Array = NDArray[np.float64]
Quotient = Callable[[Array, Array], tuple[Array, Array]]
"""Function of times and sides (n,). It returns numerators (k, n) and their common denominator (n,), all of them smooth."""

CELLS_PER_SCALE = 8
CELLS_AT_ONCE = 60_000
HALVINGS = 14
"""Largest number of divisions of a cell. After them, a cell is so short that the quotient changes by rounding alone."""
TOLERANCE = 1e-12
"""Relative error of the smallest value."""
DEGREE = 6
NODES = chebyshev.chebpts2(DEGREE + 1)
TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(NODES, DEGREE)).T
_ORDER = np.arange(DEGREE + 1.0)
BELOW_CHORD = 2 * np.max(np.diff(NODES)) ** 2 / 8 * _ORDER**2 * (_ORDER**2 - 1) / 3
"""Depth below the chords between nodes, for each coefficient of a Chebyshev series, doubled for what the series omits.

It is at most an eighth of the squared distance of the nodes, times the largest second derivative.
"""


class Arcs(NamedTuple):
    """Pieces of a motion without an event, on which the base acceleration is smooth, with the side (−1, 0 at rest, 1) on each."""

    starts: Array
    ends: Array
    sides: Array

    def where(self, chosen: NDArray[np.bool_]) -> Arcs:
        """Return the selected arcs."""
        return Arcs(*(column[chosen] for column in self))

    def divided(self, parts: NDArray[np.intp]) -> Arcs:
        """Divide each arc into a number of equal parts."""
        which = np.repeat(np.arange(parts.size), parts)
        step = np.arange(which.size) - (np.cumsum(parts) - parts)[which]
        starts, lengths = self.starts[which], (self.ends - self.starts)[which]
        begins = starts + lengths * (step / parts[which])
        ends = np.where(
            step + 1 == parts[which], self.ends[which], starts + lengths * ((step + 1) / parts[which])
        )
        return Arcs(begins, ends, self.sides[which])


class Extreme(NamedTuple):
    """Value and time of an extreme; of equal values, the earlier one is the smaller."""

    value: float
    time: float


NOTHING = Extreme(math.inf, 0.0)


def global_minimum(quotient: Quotient, arcs: Arcs, scale: float) -> Extreme:
    """Return the smallest value of a quotient over all arcs; −∞ where its denominator is not positive.

    Numerators and denominator vary over times of `scale`. A value below μ, the smallest one found so far, means that a
    numerator minus μ times the denominator is negative. This difference is smooth, also where the denominator is nearly 0.
    A cell is divided in two as long as the Chebyshev series of the difference admits a negative value between its nodes.
    """
    best = NOTHING
    for batch in _cells(arcs, scale):
        cells = batch
        for _ in range(HALVINGS):
            best, open_ = _improved(quotient, cells, best)
            cells = cells.where(open_)
            if best.value == -math.inf or not cells.starts.size:
                break
            cells = cells.divided(np.full(cells.starts.size, 2))
    return best


def _improved(quotient: Quotient, cells: Arcs, best: Extreme) -> tuple[Extreme, NDArray[np.bool_]]:
    """Return the smallest value at the nodes of all cells and before, and the cells that can hold a smaller one."""
    middles, halves = (cells.starts + cells.ends) / 2, (cells.ends - cells.starts) / 2
    times = np.clip(middles[:, None] + halves[:, None] * NODES, cells.starts[:, None], cells.ends[:, None])
    tops, bottom = quotient(times.ravel(), np.repeat(cells.sides, NODES.size))
    values = np.divide(tops.min(axis=0), bottom, out=np.full(bottom.size, -math.inf), where=bottom > 0)
    lowest = int(np.argmin(values))
    best = min(best, Extreme(float(values[lowest]), float(times.flat[lowest])))
    if best.value == -math.inf:
        return best, np.zeros(cells.starts.size, bool)
    shape = (len(tops), *times.shape)
    over = (tops - best.value * bottom).reshape(shape)
    size = (np.abs(tops) + abs(best.value) * bottom).reshape(shape).max(axis=-1)
    least = over.min(axis=-1) - np.abs(over @ TO_COEFFICIENTS) @ BELOW_CHORD
    return best, (least < -TOLERANCE * size).any(axis=0)


def _cells(arcs: Arcs, scale: float) -> Iterator[Arcs]:
    """Yield the arcs, divided into cells that are short against `scale`, some at a time."""
    parts = np.clip(np.ceil(CELLS_PER_SCALE * (arcs.ends - arcs.starts) / scale), 1, CELLS_AT_ONCE).astype(
        int
    )
    batches = np.cumsum(parts) // CELLS_AT_ONCE
    for batch in np.unique(batches):
        yield arcs.where(batches == batch).divided(parts[batches == batch])


ORDINARY_FRICTION = 0.5
"""Coefficient of friction that dry stone, concrete and steel usually reach. A larger requirement gives a warning."""
MIN_ARC = 1e-12
"""Shortest arc evaluated, in τ. On shorter arcs of a chatter, the reaction equals that on the longer ones before."""
INWARDS = 8 * 2.0**-52
"""Relative change of the ends of an arc, so that no time on it is counted to the next one after rounding."""


@frozen
class Validity:
    """Validity of the model's assumptions for a motion of a real block; returned by `Motion.validity`.

    Attributes
    ----------
    until : float
        End of the assessed part of the motion, in τ: its end, or the instant from which overturning is certain.
    overturned : bool
        True if overturning is proved.
    friction : float or None
        Smallest coefficient of friction without sliding. Infinite if the base reaction vanishes. None if there is nothing to
        assess: a block in permanent contact with a brace, or one whose overturning is certain from the start.
    friction_source : str or None
        Phase that requires this friction: "motion" (largest |H|/N between events), "impact" (|J_x|/J_y) or "rest" (|a_g|/g).
    friction_time, reaction_time : float or None
        Times of these extremes, in τ (`block.seconds` converts).
    reaction : float or None
        Smallest upward base reaction N/(Mg) over the motion. The model requires a positive value. None if there is nothing
        to assess.
    angle, critical_angle : float
        Largest |θ| up to `until`, and θcr, in radians.
    moment_error, forcing_error : float
        Largest relative overestimate of the restoring moment, δ/sin δ − 1 with δ = θcr − |θ|, and of the moment of the
        base acceleration, 1/cos δ − 1. Infinite beyond δ = −90°. Both are 0 for the full equation of motion.
    time_unit : float
        1/α, in seconds.
    full_angle : float or None
        With ``full=True``: largest |θ| of the full block under the same base motion, in radians; infinite if it overturns.
    full_outcome : Outcome or None
        With ``full=True``: outcome of its motion.
    warnings : tuple of str
        One sentence for each assumption that does not hold, and for each quantity that the motion does not determine.

    Notes
    -----
    The reactions during contact with a brace, and at a brace impact, depend on the height of the brace. Both are excluded,
    with a warning.

    Examples
    --------
    >>> from rocking import Block, simulate
    >>> block = Block(height=2.0, width=0.5)
    >>> result = simulate(block.system(acceleration=3.0, frequency_hz=1.2)).validity(block)
    >>> until, friction, reaction, slender = str(result).splitlines()
    >>> print(until)
    assessed up to τ = 15.5003, where overturning is proved
    >>> print(friction)
    least coefficient of friction without sliding: 0.2587 (motion, t = 0 s, τ = 0)
    >>> print(reaction)
    least base reaction: 0.8576 Mg (t = 4.651 s, τ = 12.4227)
    >>> print(slender)
    slender-block model: overestimates the restoring moment by up to 1.01%, that of the base acceleration by up to 3.08%
    """

    until: float
    overturned: bool
    friction: float | None
    friction_source: str | None
    friction_time: float | None
    reaction: float | None
    reaction_time: float | None
    angle: float
    critical_angle: float
    moment_error: float
    forcing_error: float
    time_unit: float
    full_angle: float | None = None
    full_outcome: Outcome | None = None
    warnings: tuple[str, ...] = ()

    def __str__(self) -> str:
        friction = reaction = "not assessed"
        if self.friction is not None:
            least = f"{self.friction:.4g}"
            if self.friction == math.inf:
                least = "none suffices, because the base reaction vanishes"
            friction = f"{least} ({self.friction_source}, {self.instant(self.friction_time)})"
        if self.reaction is not None:
            reaction = f"{self.reaction:.4g} Mg ({self.instant(self.reaction_time)})"
        slender = "does not apply beyond 90° from the balance point"
        if self.forcing_error == 0.0:
            slender = "not used, but the full equation of motion"
        elif self.forcing_error < math.inf:
            slender = (
                f"overestimates the restoring moment by up to {self.moment_error:.2%}, "
                f"that of the base acceleration by up to {self.forcing_error:.2%}"
            )
        lines = (
            [f"assessed up to τ = {self.until:.6g}, where overturning is proved"] if self.overturned else []
        )
        lines += [
            f"least coefficient of friction without sliding: {friction}",
            f"least base reaction: {reaction}",
        ]
        if not self.overturned:
            share = self.angle / self.critical_angle
            lines.append(f"largest angle: {degrees_too(self.angle, 4)}, {share:.4g} of the critical angle")
        lines.append(f"slender-block model: {slender}")
        if self.full_angle is not None:
            lines.append(f"full equation of motion: {self._compared(self.full_angle)}")
        return "\n".join((*lines, *(f"warning: {warning}" for warning in self.warnings)))

    def _compared(self, angle: float) -> str:
        """Return the outcome of the full block, and how its largest angle differs, in words."""
        if angle == math.inf:
            return f"{self.full_outcome}"
        other = (
            ""
            if self.overturned or self.angle == 0.0
            else f", {angle / self.angle - 1:+.1%} from that of the slender block"
        )
        return f"{self.full_outcome}, largest angle {degrees_too(angle, 4)}{other}"

    def instant(self, time: float | None) -> str:
        """Format a time in seconds and in τ; empty for None."""
        return "" if time is None else f"t = {time * self.time_unit:.4g} s, τ = {time:.6g}"


def validity(motion: Trajectory, block: Block, *, full: bool = False) -> Validity:
    """Assess whether `block` can perform `motion` as the model assumes; with ``full``, compare with the full equation of motion.

    The extremes are those of the exact motion, to a relative error of 1e-12. Arcs are divided until none can hold a greater
    one.

    Raises
    ------
    TypeError
        If `block` is not a Block.
    ValueError
        If the motion was not recorded with record="all". With ``full``, also if it is that of a full block.

    Examples
    --------
    >>> from rocking import Block, simulate
    >>> block = Block(height=2.0, width=0.5)
    >>> motion = simulate(block.system(acceleration=3.0, frequency_hz=1.2), cycles=20)
    >>> motion.validity(block).friction > 0.25
    True
    """
    instance("block", block, Block)
    until = motion.duration if motion.overturning is None else motion.overturning.time
    moving, resting, leaning = split(motion, until)
    forcing = motion.system.forcing
    fast, slow = min(forcing.time_scale, 1), forcing.time_scale

    def upward(times: Array, sides: Array) -> tuple[Array, Array]:
        return base_reaction(motion, block, times, sides)[1][None], np.ones(times.size)

    def hold(times: Array, sides: Array) -> tuple[Array, Array]:
        sideways, up = base_reaction(motion, block, times, sides)
        return np.stack((sideways, -sideways)), up

    reaction = min(global_minimum(upward, moving, fast), global_minimum(upward, resting, slow))
    pulled = Extreme(-math.inf, reaction.time)
    slides = {
        "motion": global_minimum(hold, moving, fast) if reaction.value > 0 else pulled,
        "impact": impact_friction(motion, block),
        "rest": global_minimum(hold, resting, slow),
    }
    source = min(slides, key=lambda name: slides[name].value)
    friction = slides[source]
    angle = largest_angle(motion, block, until)
    slender = motion.system.critical_angle is None
    moment_error, forcing_error = slender_errors(block.critical_angle, angle) if slender else (0.0, 0.0)
    result = Validity(
        until=until,
        overturned=motion.overturning is not None,
        friction=None if friction == NOTHING else abs(friction.value),
        friction_source=None if friction == NOTHING else source,
        friction_time=None if friction == NOTHING else friction.time,
        reaction=None if reaction == NOTHING else reaction.value,
        reaction_time=None if reaction == NOTHING else reaction.time,
        angle=angle,
        critical_angle=block.critical_angle,
        moment_error=moment_error,
        forcing_error=forcing_error,
        time_unit=block.seconds(1.0),
    )
    if full:
        outcome, reached = full_block(motion, block)
        result = evolve(result, full_outcome=outcome, full_angle=block.critical_angle * reached)
    return evolve(result, warnings=tuple(warnings(result, motion, block, leaning)))


def full_block(motion: Trajectory, block: Block) -> tuple[Outcome, float]:
    """Return the outcome and the largest |Θ| of the full block under the base motion of a slender one, infinite if it overturns.

    A harmonic base motion lasts as long as that of the motion. Another one is followed to its end, as in `simulate`.
    """
    known = motion.system.critical_angle is not None
    refuse_if(known, "full", "be False for a motion by the full equation", True)
    system = evolve(motion.system, critical_angle=block.critical_angle)
    p, cycles, start = parameters(system), motion.cycles, (motion.start.angle, motion.start.velocity)
    if not isinstance(system.forcing, Harmonic):
        falls = finite_runs.run_to_end(p, *start, math.inf).status == kernel.OVERTURNED
        endless = is_lossless(system) and not falls
        cycles = math.ceil(motion.duration / p.clock.cycle_length) if endless else kernel.OPEN
    begun, _ = initial_state.begin_march(p, *start)
    status, reached, _, _ = run(p, begun, cycles, 0.0, "none", want_peak=True)
    outcome = outcome_of(status)
    return outcome, math.inf if outcome is Outcome.OVERTURNED else reached.peak


def base_reaction(motion: Trajectory, block: Block, times: Array, sides: Array) -> tuple[Array, Array]:
    """Return the base reactions H/Mg and N/Mg while the block turns about one corner or rests; positive H acts towards +x.

    Relative to the base, the centre of mass has the accelerations ``x'' = R (cos δ θ'' ± sin δ θ'²)`` and
    ``y'' = R (± sin δ θ'' − cos δ θ'²)``, with δ = θcr − |θ| and ± for the side. Then H/M = a_g + x'' and N/M = g + y''.
    In units of g, R α²/g = MR²/Io.
    """
    angle, velocity = motion.at(times)
    lean = block.critical_angle - block.critical_angle * np.abs(angle)
    turning = block.critical_angle / block.inertia_ratio * motion.acceleration(times)
    centripetal = block.critical_angle**2 / block.inertia_ratio * velocity**2
    push = block.critical_angle * motion.system.forcing.acceleration(times)
    sideways = push + np.cos(lean) * turning + sides * np.sin(lean) * centripetal
    return sideways, 1 + sides * np.sin(lean) * turning - np.cos(lean) * centripetal


def impact_friction(motion: Trajectory, block: Block) -> Extreme:
    """Return −|J_x|/J_y = −(1 − e)/((1 + e) tan θcr) of the impact with the smallest coefficient of restitution, and its time."""
    times, restitutions = impact_restitutions(motion)
    if times.size == 0:
        return NOTHING
    hardest = int(np.argmin(restitutions))
    e = float(restitutions[hardest])
    return Extreme(-(1 - e) / ((1 + e) * math.tan(block.critical_angle)), float(times[hardest]))


def impact_restitutions(motion: Trajectory) -> tuple[Array, Array]:
    """Return the times of the impacts at Θ = 0, and the coefficient of restitution at the speed of each."""
    impacts = motion.events[motion.events["kind"] == "impact"]
    speeds, kept = np.array(motion.system.restitution_law or [(0.0, motion.system.restitution)]).T
    return impacts["time"], np.interp(np.abs(impacts["before"]), speeds, kept)


def largest_angle(motion: Trajectory, block: Block, until: float) -> float:
    """Return the largest |θ| up to a time: at a turn, at an event or at either end."""
    angles = [motion.at([0.0, until])[0]]
    angles += [table["angle"][table["time"] <= until] for table in (motion.peaks, motion.events)]
    return float(np.max(np.abs(np.concatenate(angles)))) * block.critical_angle


def warnings(result: Validity, motion: Trajectory, block: Block, leaning: Arcs) -> Iterator[str]:
    """Yield one sentence for each assumption that does not hold, and for each excluded quantity."""
    if result.overturned and result.reaction is None:
        yield "sliding and uplift are not assessed, because overturning is certain from the start"
    if result.friction is not None and ORDINARY_FRICTION < result.friction < math.inf:
        at = f"({result.friction_source}, {result.instant(result.friction_time)})"
        yield f"sliding: a coefficient of friction of at least {result.friction:.3g} is required {at}"
    if result.reaction is not None and result.reaction <= 0:
        at = result.instant(result.reaction_time)
        yield f"base reaction: {result.reaction:.3g} Mg at {at}; the base would have to pull the block down"
    hit = float(np.min(impact_restitutions(motion)[1], initial=1.0))
    full = motion.system.critical_angle is not None
    yield from block_warnings(block, motion.system.forcing.largest, hit, result.angle, full=full)
    if motion.brace_hits:
        yield f"brace impacts: {motion.brace_hits}, not assessed, because the base reactions depend on the height of the brace"
    if leaning.starts.size:
        share = np.sum(leaning.ends - leaning.starts) / motion.duration
        yield f"contact with a brace: {share:.1%} of the time, not assessed, because the base reactions depend on the height of the brace"


def split(motion: Trajectory, until: float) -> tuple[Arcs, Arcs, Arcs]:
    """Split the arcs up to a time into moving, resting and in contact with a brace.

    An arc ends at an event, or where the base acceleration or its rate jumps. Its ends lie inwards by some units of the last
    place. Arcs at rest are limited to the time in which the base takes all its accelerations.
    """
    forcing, events = motion.system.forcing, motion.events["time"]
    marks = np.concatenate((events, forcing.corners))
    edges = np.unique(np.concatenate(([0.0], marks[(marks > 0) & (marks < until)], [until])))
    starts, ends = edges[:-1] * (1 + INWARDS), edges[1:] * (1 - INWARDS)
    long = ends - starts > MIN_ARC
    starts, ends = starts[long], ends[long]
    middles = (starts + ends) / 2
    angle, velocity = motion.at(middles)
    still = (velocity == 0) & (motion.acceleration(middles) == 0)
    leans = still & (angle != 0) & (motion.system.braces is not None)
    rests = still & (angle == 0)
    arcs = Arcs(starts, np.where(rests, np.minimum(ends, starts + forcing.span), ends), np.sign(angle))
    return arcs.where(~rests & ~leans), arcs.where(rests), arcs.where(leans)
