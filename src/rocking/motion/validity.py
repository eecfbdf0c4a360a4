"""Validity of the model for a motion: no sliding, no uplift, and a slender block (Housner 1963)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from attrs import evolve, frozen
from numpy.typing import NDArray

from rocking.kernels import system as numbers
from rocking.kernels.motion import finite_motion as finite_runs
from rocking.kernels.motion import march
from rocking.model.block import Block, unrestrained
from rocking.model.forcing import Harmonic, PiecewiseLinear, Pulse
from rocking.model.result import in_units_of
from rocking.model.validation import ContactLost, Refusal, Text, instance, refuse_if
from rocking.model.verdict import Outcome
from rocking.motion.branch_and_bound import NOTHING, Arcs, Array, Extreme, first_time, global_minimum
from rocking.motion.march_loop import is_lossless, outcome_of, parameters, run
from rocking.motion.model_warnings import block_warnings, degrees_too, off, slender_errors

if TYPE_CHECKING:
    from rocking.model.system import System
    from rocking.motion.trajectory import Trajectory

ORDINARY_FRICTION = 0.5
"""Coefficient of friction that dry stone, concrete and steel usually reach. A larger requirement gives a warning."""
LEAST_LACK = 1e-10
"""Relative lack of friction from which a block slides, so that the least coefficient, with its rounding error, is enough."""
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
        base acceleration, 1/cos δ − 1. With a base acceleration in units of g tan θcr the latter is the largest relative error,
        |θcr/(tan θcr cos δ) − 1|. Infinite beyond δ = −90°. Both are 0 for the full equation of motion.
    time_unit : float
        1/α, in seconds.
    normalised_by : str
        Unit of the base acceleration of the motion: "angle", g θcr, or "tangent", g tan θcr.
    full_angle : float or None
        With ``full=True``: largest |θ| of the full block under the same base motion, in radians; infinite if it overturns.
    full_outcome : Outcome or None
        With ``full=True``: outcome of its motion.
    available_friction : float or None
        Coefficient of friction that the base has, if it was given.
    slides_from : float or None
        First time, in τ, at which the motion needs more than this friction. From then on the block slides, and the motion is no
        verdict on it. None if it never needs more, or if `available_friction` was not given.
    slides_in : str or None
        Phase of this time, as in `friction_source`.
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
    normalised_by: str = "angle"
    available_friction: float | None = None
    slides_from: float | None = None
    slides_in: str | None = None
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
                f"that of the base acceleration {off(self.normalised_by)} {self.forcing_error:.2%}"
            )
        lines = [self.refusal] if self.refusal else []
        lines += (
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

    @property
    def refusal(self) -> str:
        """Sentence that refuses the motion as a verdict because the block slides; empty if the friction suffices, or is not given."""
        if self.slides_from is None:
            return ""
        time = f"{self.slides_from * self.time_unit:.6g}"
        return f"slides from t = {time} s ({self.slides_in}): no rocking verdict with a friction of {self.available_friction:g}"

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


def validity(
    motion: Trajectory, block: Block, *, full: bool = False, friction: float | None = None
) -> Validity:
    """Assess whether `block` can perform `motion` as the model assumes; with ``full``, compare with the full equation of motion.

    The extremes are those of the exact motion, to a relative error of 1e-12. Arcs are divided until none can hold a greater
    one.

    Raises
    ------
    TypeError
        If `block` is not a Block.
    ValueError
        If the motion was not recorded with record="all", or if `block` has other sides than the block of the motion. With ``full``,
        also if it is that of a full block.

    Examples
    --------
    >>> from rocking import Block, simulate
    >>> block = Block(height=2.0, width=0.5)
    >>> motion = simulate(block.system(acceleration=3.0, frequency_hz=1.2), cycles=20)
    >>> motion.validity(block).friction > 0.25
    True
    """
    block = in_units_of(motion.system.block, instance("block", block, Block))
    for each in (block, motion.system.block or block):
        unrestrained(each, "block", "the force of a restrainer is not in the base reactions")
    if motion.system.wall is not None:
        block = evolve(block, wall=motion.system.wall)
    check_sides(motion.system, block)
    until = motion.duration if motion.overturning is None else motion.overturning.time
    moving, resting, leaning = split(motion, until)
    forcing = motion.system.forcing
    fast, slow = min(forcing.time_scale, 1), forcing.time_scale

    def upward(times: Array, sides: Array) -> tuple[Array, Array]:
        return base_reaction(motion, block, times, sides)[1][None], np.ones(times.size)

    def hold(times: Array, sides: Array) -> tuple[Array, Array]:
        sideways, up = base_reaction(motion, block, times, sides)
        return np.stack((sideways, -sideways)), up

    def hold_away(times: Array, sides: Array) -> tuple[Array, Array]:
        """Return the same of a block at rest that is pulled away from the wall; the other way the wall holds it."""
        sideways, up = hold(times, sides)
        return sideways[:1], up

    still = hold if motion.system.wall is None else hold_away
    reaction = min(global_minimum(upward, moving, fast), global_minimum(upward, resting, slow))
    pulled = Extreme(-math.inf, reaction.time)
    needs = {
        "motion": global_minimum(hold, moving, fast) if reaction.value > 0 else pulled,
        "impact": impact_friction(motion, block),
        "rest": global_minimum(still, resting, slow),
    }
    source = min(needs, key=lambda name: needs[name].value)
    needed = needs[source]
    begins, phase = math.inf, ""
    if friction is not None and -needed.value > friction * (1 + LEAST_LACK):
        impacts, pushes = impact_pushes(motion, block)
        begins, phase = min(
            (
                float(np.min(impacts[pushes > friction], initial=math.inf)),
                "impact",
            ),
            (first_time(hold, -friction, moving, fast), "motion"),
            (first_time(still, -friction, resting, slow), "rest"),
        )
    angle = largest_angle(motion, block, until)
    slender = motion.system.critical_angle is None
    moment_error, forcing_error = (0.0, 0.0)
    if slender:
        right, left = block.critical_angles
        moment_error, forcing_error = slender_errors(right, angle, block.normalised_by, left)
    result = Validity(
        until=until,
        overturned=motion.overturning is not None,
        friction=None if needed == NOTHING else abs(needed.value),
        friction_source=None if needed == NOTHING else source,
        friction_time=None if needed == NOTHING else needed.time,
        reaction=None if reaction == NOTHING else reaction.value,
        reaction_time=None if reaction == NOTHING else reaction.time,
        angle=angle,
        critical_angle=block.critical_angle,
        moment_error=moment_error,
        forcing_error=forcing_error,
        time_unit=block.seconds(1.0),
        normalised_by=block.normalised_by,
        available_friction=friction,
        slides_from=begins if begins < math.inf else None,
        slides_in=phase if begins < math.inf else None,
    )
    if full:
        known = motion.system.critical_angle is not None
        refuse_if(known, "full", "be False for a motion by the full equation", True)
        outcome, reached = by_other_equation(motion, block)
        result = evolve(result, full_outcome=outcome, full_angle=block.critical_angle * reached)
    return evolve(result, warnings=tuple(warnings(result, motion, block, leaning)))


SAME_SIDES = 1e-9
"""Relative difference up to which the sides of a block are those of a motion."""


def check_sides(system: System, block: Block) -> None:
    """Raise ValueError for a block whose left side is not that of the system, in units of the right one."""
    own, other = (
        (1.0, 1.0) if each is None else (each.angle_ratio, each.frequency_ratio)
        for each in (system.left, block.left)
    )
    apart = any(abs(one - two) > SAME_SIDES * two for one, two in zip(own, other, strict=True))
    got = Text(f"one with {{offset}} {block.offset:g} m")
    refuse_if(apart, "block", "have the sides of the block of the motion", got)


def other_system(system: System, block: Block) -> System:
    """Return the system of the other equation under the same base motion: full, or slender with a/(g tan θcr)."""
    angle = unrestrained(block, "block", "its equations of motion are not compared").critical_angle
    own = block.acceleration_unit_g if system.critical_angle is None else angle
    other = angle if system.critical_angle is None else math.tan(angle)
    forcing = system.forcing
    if isinstance(forcing, Pulse):
        forcing = evolve(forcing, amplitude=forcing.amplitude * (own / other))
    elif isinstance(forcing, PiecewiseLinear):
        forcing = evolve(forcing, scale=forcing.scale * (own / other))
    critical = angle if system.critical_angle is None else None
    return evolve(system, forcing=forcing, critical_angle=critical, block=None)


def by_other_equation(motion: Trajectory, block: Block) -> tuple[Outcome, float]:
    """Return the outcome and the largest |Θ| by the other equation under the same base motion, infinite if the block overturns.

    A harmonic base motion lasts as long as that of the motion, and so does one that was cut short. Another one is followed to its
    end, as in `simulate`.
    """
    system = other_system(motion.system, in_units_of(motion.system.block, block))
    p, cycles, start = parameters(system), motion.cycles, (motion.start.angle, motion.start.velocity)
    finite = not isinstance(system.forcing, Harmonic)
    if finite and motion.outcome is Outcome.BOUNDED and not is_lossless(system):
        cycles = max(1, math.ceil(motion.duration / (numbers.CYCLE * system.forcing.time_scale)))
        p = parameters(system, motion.duration / cycles)
    elif finite:
        falls = finite_runs.run_to_end(p, *start, math.inf).status == march.OVERTURNED
        endless = is_lossless(system) and not falls
        cycles = math.ceil(motion.duration / p.clock.cycle_length) if endless else march.OPEN
    begun, _ = march.begin_march(p, *start)
    status, reached, _, _ = run(p, begun, cycles, 0.0, "none", want_peak=True)
    outcome = outcome_of(status)
    return outcome, math.inf if outcome is Outcome.OVERTURNED else reached.peak


LARGEST_DIFFERENCE = 0.05
"""Difference of two largest |Θ| up to which a report does not state the other one."""


class OtherMotion(NamedTuple):
    """Motion of a block by the other equation: its model, its outcome and its largest |Θ|, infinite if the block overturns."""

    model: str
    outcome: Outcome
    peak: float


def other_motion(motion: Trajectory) -> OtherMotion | None:
    """Return the motion by the other equation if it differs; None if it does not, or if there is none.

    The slender block takes a/(g tan θcr). The motions differ if only one block overturns, or if the largest |Θ| differ by more than
    0.05. There is another equation for a block in SI under a base motion of finite length.
    """
    system, block = motion.system, motion.system.block
    if block is None or isinstance(system.forcing, Harmonic) or system.restitution_table:
        return None
    try:
        outcome, peak = by_other_equation(motion, block)
    except Refusal:  # an angle, or braces, that the full equation does not take
        return None
    falls = math.inf if motion.outcome is Outcome.OVERTURNED else motion.peak
    if falls == peak or abs(falls - peak) <= LARGEST_DIFFERENCE:
        return None
    return OtherMotion("full" if system.critical_angle is None else "slender", outcome, peak)


def compared(motion: Trajectory) -> tuple[str, str]:
    """Return the name of the other equation, and its outcome in words, if the motion by it differs; else two empty texts."""
    other = other_motion(motion)
    if other is None:
        return "", ""
    name = {"full": "full equation", "slender": "slender block"}[other.model]
    if other.outcome is Outcome.OVERTURNED:
        return name, "overturns"
    stands = "stands" if motion.outcome is Outcome.OVERTURNED else "also stands"
    assert motion.system.block is not None
    return name, f"{stands}, largest |θ| {degrees_and_share(motion.system.block, other.peak)}"


def degrees_and_share(block: Block, angle: float) -> str:
    """Return an angle in degrees and in units of θcr, of an unsymmetric block that of θ > 0, and of a slender restrained one θu."""
    side = " of θ > 0" if block.is_unsymmetric else ""
    unit = "θu" if block.by_balance else "θcr"
    return f"{block.degrees(angle):.4g}°, {angle:.4g} {unit}{side}"


def base_reaction(motion: Trajectory, block: Block, times: Array, sides: Array) -> tuple[Array, Array]:
    """Return the base reactions H/Mg and N/Mg while the block turns about one corner or rests; positive H acts towards +x.

    Relative to the base, the centre of mass has the accelerations ``x'' = R (cos δ θ'' ± sin δ θ'²)`` and
    ``y'' = R (± sin δ θ'' − cos δ θ'²)``, with δ = θcr − |θ| and ± for the side. Then H/M = a_g + x'' and N/M = g + y''.
    In units of g, R α²/g = MR²/Io. R and θcr are those of the side. On a base with the upward acceleration a_v, N/M = g + a_v + y''.
    """
    angle, velocity = motion.at(times)
    left = np.asarray(sides) < 0
    arm = np.where(left, block.radii[1] / block.radii[0], 1.0)
    lean = np.where(left, *reversed(block.critical_angles)) - block.critical_angle * np.abs(angle)
    turning = arm * (block.critical_angle / block.inertia_ratio * motion.acceleration(times))
    centripetal = arm * (block.critical_angle**2 / block.inertia_ratio * velocity**2)
    push = block.acceleration_unit_g * motion.system.forcing.acceleration(times)
    sideways = push + np.cos(lean) * turning + sides * np.sin(lean) * centripetal
    up = 1 + sides * np.sin(lean) * turning - np.cos(lean) * centripetal
    if motion.system.vertical is not None:
        up = up + motion.system.vertical.acceleration(times)
    return sideways, up


def check_contact(motion: Trajectory) -> None:
    """Raise ContactLost for a motion under vertical acceleration in which weight or base reaction vanish before overturning is proved.

    The weight, 1 + a_v, is linear between samples. The first time at which the base reaction vanishes is found by branch and bound over
    the exact motion. A system without a block has no base reaction.
    """
    until = motion.duration if motion.overturning is None else motion.overturning.time
    moving, resting, _ = split(motion, until)
    block, vertical, forcing = motion.system.block, motion.system.vertical, motion.system.forcing
    assert vertical is not None
    begins = {"weight": weightless_from(vertical)}

    def upward(times: Array, sides: Array) -> tuple[Array, Array]:
        assert block is not None
        return base_reaction(motion, block, times, sides)[1][None], np.ones(times.size)

    if block is not None and not begins["weight"] <= until:
        slow = forcing.time_scale
        begins["base reaction"] = min(
            first_time(upward, 0.0, moving, min(slow, 1)), first_time(upward, 0.0, resting, slow)
        )
    which = min(begins, key=lambda name: begins[name])
    if begins[which] <= until:
        at = f"τ = {begins[which]:.6g}" if block is None else f"t = {block.seconds(begins[which]):.6g} s"
        raise ContactLost(f"the {which} vanishes at {at}: the block leaves the base")


def weightless_from(vertical: PiecewiseLinear) -> float:
    """Return the first time at which the base accelerates downwards with 1 g or more; infinite if it never does."""
    weights = 1 + vertical.scale * vertical.values
    gone = np.flatnonzero(weights <= 0)
    if not gone.size:
        return math.inf
    first = int(gone[0])
    if first == 0:
        return 0.0
    before, here = weights[first - 1], weights[first]
    return float(vertical.step * (first - 1 + before / (before - here)))


def impact_friction(motion: Trajectory, block: Block) -> Extreme:
    """Return −|J_x|/J_y of the impact that needs most friction, and its time."""
    times, pushes = impact_pushes(motion, block)
    if times.size == 0:
        return NOTHING
    place = int(np.argmax(pushes))
    return Extreme(-float(pushes[place]), float(times[place]))


def impact_pushes(motion: Trajectory, block: Block) -> tuple[Array, Array]:
    """Return the times of the impacts, and |J_x|/J_y = (1 − e)/(tan θcr + e tan θcr') of each, θcr before and θcr' after it.

    There are none against a wall, which takes a part of J_x.
    """
    if motion.system.wall is not None:
        return np.empty(0), np.empty(0)
    times, restitutions = impact_restitutions(motion)
    first, second = np.tan(block.critical_angles)
    before = np.where(after_left(motion), second, first)
    return times, (1 - restitutions) / (before + restitutions * (first + second - before))


def after_left(motion: Trajectory) -> NDArray[np.bool_]:
    """Return for each impact at Θ = 0 whether it ends the motion on the side Θ < 0."""
    return motion.events["before"][motion.events["kind"] == "impact"] > 0


def impact_restitutions(motion: Trajectory) -> tuple[Array, Array]:
    """Return the times of the impacts at Θ = 0, and the coefficient of restitution at the speed of each."""
    impacts = motion.events[motion.events["kind"] == "impact"]
    before, after = np.abs(impacts["before"]), np.abs(impacts["after"])
    if (left := motion.system.left) is not None:
        law = np.where(after_left(motion), left.restitution, motion.system.restitution)
    else:
        speeds, kept = np.array(motion.system.restitution_law or [(0.0, motion.system.restitution)]).T
        law = np.interp(before, speeds, kept)
    if (
        motion.system.restitution_scatter is not None
    ):  # an impact after which the block rests has no speed after it
        law = np.where(after > 0.0, after / np.where(before > 0.0, before, 1.0), law)
    return impacts["time"], law


def largest_angle(motion: Trajectory, block: Block, until: float) -> float:
    """Return the largest |θ| up to a time: at a turn, at an event or at either end."""
    angles = [motion.at([0.0, until])[0]]
    angles += [table["angle"][table["time"] <= until] for table in (motion.peaks, motion.events)]
    return float(np.max(np.abs(np.concatenate(angles)))) * block.critical_angle


def warnings(result: Validity, motion: Trajectory, block: Block, leaning: Arcs) -> Iterator[str]:
    """Yield one sentence for each assumption that does not hold, and for each excluded quantity."""
    if result.overturned and result.reaction is None:
        yield "sliding and uplift are not assessed, because overturning is certain from the start"
    if result.slides_from is not None:
        yield "sliding: the motion and its results are those of a block that does not slide"
    if (
        result.available_friction is None
        and result.friction is not None
        and ORDINARY_FRICTION < result.friction < math.inf
    ):
        at = f"({result.friction_source}, {result.instant(result.friction_time)})"
        yield f"sliding: a coefficient of friction of at least {result.friction:.3g} is required {at}"
    if result.reaction is not None and result.reaction <= 0:
        at = result.instant(result.reaction_time)
        yield f"base reaction: {result.reaction:.3g} Mg at {at}; the base would have to pull the block down"
    (_, used), from_left = impact_restitutions(motion), after_left(motion)
    right, left = (float(np.min(used[each], initial=1.0)) for each in (~from_left, from_left))
    full, largest = motion.system.critical_angle is not None, motion.system.forcing.largest
    yield from block_warnings(block, largest, right, result.angle, left_restitution=left, full=full)
    if motion.system.wall is not None:
        yield (
            "wall: its impacts are not assessed, because the base reactions depend on the height of the contact; a block at rest that is "
            "pressed against it is taken to be held by it"
        )
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
