"""Whether the model applies to a motion: no sliding, a base that only pushes, a slender block (Housner 1963)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from attrs import evolve, frozen

from rocking.model import Block, instance
from rocking.motion.arc_minimum import NOTHING, Arcs, Array, Extreme, global_minimum
from rocking.motion.model_warnings import block_warnings, degrees_too, slender_errors

if TYPE_CHECKING:
    from rocking.motion.trajectory import Trajectory

ORDINARY_FRICTION = 0.5
"""Dry stone, concrete or steel seldom offers less: a motion that needs more is warned of."""
MIN_ARC = 1e-10
"""In τ. The reaction on the shorter arcs of a chatter is that of their longer neighbours, to as many digits."""


@frozen
class Validity:
    """How far a motion of a real block keeps to the model's assumptions.

    Attributes
    ----------
    until : float
        Up to when the motion is judged, in τ: its end, or the proof that it never returns.
    overturned : bool
        Whether there is such a proof.
    friction : float or None
        Least coefficient of friction with which the block never slides; infinite where the base would have to pull, None
        where there is nothing to judge: a block that leans throughout, or is past return from the start.
    friction_source : str or None
        What asks for it: "motion" (largest |H|/N between events), "impact" (|J_x|/J_y) or "rest" (|a_g|/g).
    friction_time, reaction_time : float or None
        Where these occur, in τ (`block.seconds` converts).
    reaction : float or None
        Least N/(Mg) of the base's upward reaction over the motion; from 0 on the base would have to pull. None where there
        is nothing to judge.
    angle, critical_angle : float
        Largest |θ| and θcr, in radians.
    moment_error, forcing_error : float
        By how much, relatively, the slender model overrates the restoring moment (δ for sin δ) and the moment of the
        base's acceleration (1 for cos δ) where they are worst, δ = θcr − |θ|; infinite from δ = −90° on.
    time_unit : float
        1/α, in seconds.
    warnings : tuple of str
        One sentence for each assumption that fails, and for each thing that the motion alone does not determine.

    Notes
    -----
    Not covered: while the block leans on a brace, and at the instant it hits one, the reactions depend on the height at
    which the brace acts; both are left out, and a warning says so.

    Examples
    --------
    >>> from rocking import Block, simulate
    >>> block = Block(height=2.0, width=0.5)
    >>> print(simulate(block.system(acceleration=3.0, frequency_hz=1.2)).validity(block))
    judged up to τ = 15.5003, where it is proved never to return
    least friction without sliding: 0.2587 (motion, t = 0 s, τ = 0)
    least base reaction: 0.8576 Mg (t = 4.651 s, τ = 12.4227)
    largest angle: 0.1708 rad = 9.788°, 0.6973 of the critical angle
    slender model: restoring moment up to 1.01%, base's push up to 3.08% too large
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
    warnings: tuple[str, ...] = ()

    def __str__(self) -> str:
        friction = reaction = "not judged"
        if self.friction is not None:
            least = f"{self.friction:.4g}"
            if self.friction == math.inf:
                least = "none would do, for the base reaction vanishes"
            friction = f"{least} ({self.friction_source}, {self.instant(self.friction_time)})"
        if self.reaction is not None:
            reaction = f"{self.reaction:.4g} Mg ({self.instant(self.reaction_time)})"
        slender = "does not apply over a right angle from balance"
        if self.forcing_error < math.inf:
            slender = f"restoring moment up to {self.moment_error:.2%}, base's push up to {self.forcing_error:.2%} too large"
        lines = (
            [f"judged up to τ = {self.until:.6g}, where it is proved never to return"]
            if self.overturned
            else []
        )
        lines += [
            f"least friction without sliding: {friction}",
            f"least base reaction: {reaction}",
            f"largest angle: {degrees_too(self.angle, 4)}, {self.angle / self.critical_angle:.4g} of the critical angle",
            f"slender model: {slender}",
        ]
        return "\n".join((*lines, *(f"warning: {warning}" for warning in self.warnings)))

    def instant(self, time: float | None) -> str:
        """A time in seconds and in τ; empty for what did not occur."""
        return "" if time is None else f"t = {time * self.time_unit:.4g} s, τ = {time:.6g}"


def validity(motion: Trajectory, block: Block) -> Validity:
    """Say whether `block` can perform `motion` as the model has it; `Validity` tells what is measured.

    The extremes are those of the exact motion: a grid on every arc, refined around each point that can be the extreme.
    Raises TypeError for another `block`, ValueError unless the motion was recorded with record="all".

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
    period = motion.system.forcing.period

    def upward(times: Array, sides: Array) -> Array:
        return base_reaction(motion, block, times, sides)[1]

    def hold(times: Array, sides: Array) -> Array:
        sideways, up = base_reaction(motion, block, times, sides)
        return np.divide(-np.abs(sideways), up, out=np.full_like(up, -math.inf), where=up > 0)

    reaction = min(global_minimum(upward, moving, min(period, 1)), global_minimum(upward, resting, period))
    pulled = Extreme(-math.inf, reaction.time)
    slides = {
        "motion": global_minimum(hold, moving, min(period, 1)) if reaction.value > 0 else pulled,
        "impact": impact_friction(motion, block),
        "rest": global_minimum(hold, resting, period),
    }
    source = min(slides, key=lambda name: slides[name].value)
    friction = slides[source]
    angle = largest_angle(motion, block, until)
    moment_error, forcing_error = slender_errors(block, angle)
    found = Validity(
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
    return evolve(found, warnings=tuple(warnings(found, motion, block, leaning)))


def base_reaction(motion: Trajectory, block: Block, times: Array, sides: Array) -> tuple[Array, Array]:
    """(H/Mg, N/Mg) from the base while the block turns about one corner or rests; positive H pushes to +x.

    With δ = θcr − |θ| the centre of mass has x'' = R (cos δ θ'' ± sin δ θ'²), y'' = R (± sin δ θ'' − cos δ θ'²) relative
    to the base (± the side), and H/M = a_g + x'', N/M = g + y''. In units of g: R α²/g = MR²/Io.
    """
    angle, velocity = motion.at(times)
    lean = block.critical_angle - block.critical_angle * np.abs(angle)
    turning = block.critical_angle / block.inertia_ratio * motion.acceleration(times)
    centripetal = block.critical_angle**2 / block.inertia_ratio * velocity**2
    push = block.critical_angle * motion.system.forcing.acceleration(times)
    sideways = push + np.cos(lean) * turning + sides * np.sin(lean) * centripetal
    return sideways, 1 + sides * np.sin(lean) * turning - np.cos(lean) * centripetal


def impact_friction(motion: Trajectory, block: Block) -> Extreme:
    """−|J_x|/J_y = −(1 − e)/((1 + e) tan θcr) of an impact, whatever its speed, and the time of the first one."""
    impacts = motion.events["time"][motion.events["kind"] == "impact"]
    if impacts.size == 0:
        return NOTHING
    e = motion.system.restitution
    return Extreme(-(1 - e) / ((1 + e) * math.tan(block.critical_angle)), float(impacts[0]))


def largest_angle(motion: Trajectory, block: Block, until: float) -> float:
    """Largest |θ| up to a time: at a turn, at an event, at either end."""
    angles = [motion.at([0.0, until])[0]]
    angles += [table["angle"][table["time"] <= until] for table in (motion.peaks, motion.events)]
    return float(np.max(np.abs(np.concatenate(angles)))) * block.critical_angle


def warnings(found: Validity, motion: Trajectory, block: Block, leaning: Arcs) -> Iterator[str]:
    """One sentence for each assumption that fails, and for each thing that is left out."""
    if found.overturned and found.reaction is None:
        yield "not judged: whether the block slides or jumps, for it is past return from the start"
    if found.friction is not None and ORDINARY_FRICTION < found.friction < math.inf:
        at = f"({found.friction_source}, {found.instant(found.friction_time)})"
        yield f"sliding: only a coefficient of friction of {found.friction:.3g} or more prevents it {at}"
    if found.reaction is not None and found.reaction <= 0:
        yield f"base reaction: {found.reaction:.3g} Mg at {found.instant(found.reaction_time)}, the base would have to pull the block down"
    hit = motion.system.restitution if motion.impacts else 1.0
    yield from block_warnings(block, motion.system.forcing.amplitude, hit, found.angle)
    if motion.brace_hits:
        yield f"brace hits: {motion.brace_hits}, whose reactions at the base depend on where the brace acts, are left out"
    if leaning.starts.size:
        share = np.sum(leaning.ends - leaning.starts) / motion.duration
        yield f"leaning: the base reactions during {share:.1%} of the time depend on where the brace acts and are left out"


def split(motion: Trajectory, until: float) -> tuple[Arcs, Arcs, Arcs]:
    """The arcs up to a time on which the block moves, rests (a period of each: the base repeats itself), leans on a brace."""
    events = motion.events["time"]
    edges = np.unique(np.concatenate(([0.0], events[events < until], [until])))
    long = np.diff(edges) > MIN_ARC
    starts, ends = edges[:-1][long], edges[1:][long]
    middles = (starts + ends) / 2
    angle, velocity = motion.at(middles)
    still = (velocity == 0) & (motion.acceleration(middles) == 0)
    leans = still & (angle != 0) & (motion.system.braces is not None)
    rests = still & (angle == 0)
    arcs = Arcs(
        starts, np.where(rests, np.minimum(ends, starts + motion.system.forcing.period), ends), np.sign(angle)
    )
    return arcs.where(~rests & ~leans), arcs.where(rests), arcs.where(leans)
