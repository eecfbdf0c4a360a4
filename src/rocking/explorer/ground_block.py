"""Motion of the selected block: time history, verdict in words, and validity of the model."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.explorer.ground_maps import ANGLES, FALLEN, STILL
from rocking.explorer.ground_view import Ground, GroundView, thinned
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY, with_unit
from rocking.model.verdict import Outcome
from rocking.motion.model_warnings import restrained_warnings
from rocking.motion.motion import Motion, end_shown, margin_speed
from rocking.motion.simulate import simulate
from rocking.motion.validity import Validity, compared, degrees_and_share

FEWEST, STEPS = 4_000, 20_000
"""Smallest and largest number of times at which the angle is computed before it is thinned."""
OVER = 0.02
"""Free border above and below a curve, as a fraction of its range."""

Facts = list[tuple[str, str]]


Contents = dict[str, dict[str, Any]]
"""New contents of both figures, the time history of the angle in degrees and the acceleration of the base in g, over the time in s."""


def block_motion(view: GroundView, ground: Ground) -> tuple[Contents, dict[str, Any]]:
    """Simulate the selected block under the scaled base motion; return the figures, and the verdict in words."""
    block, base = view.block, ground.scaled(view.scale)
    model, normalised_by = view.equation
    up = None if ground.vertical is None else ground.vertical.scaled(view.scale)
    motion = simulate(block.system(base, model=model, normalised_by=normalised_by, vertical=up))
    times, degrees = _history(motion, block, ground.sampled.times.size)
    fullest = max(float(np.abs(degrees).max()), 0.2 * block.degrees(1.0))
    words = _words(motion, block, view.friction)
    return _figures(view, ground, times, degrees, fullest), words | {
        "sentence": f"{words['sentence']}{factor_in_words(view)}{map_in_words(block)}"
    }


def no_motion(view: GroundView, ground: Ground, reason: str) -> tuple[Contents, dict[str, Any]]:
    """Return figures without a motion, and the reason in place of the verdict."""
    words = {"kind": "not computed", "colour": "", "facts": [], "decided": True, "validity": []}
    words |= {"sentence": _sentence(reason), "margin": "", "certified": ""}
    return _figures(view, ground, np.empty(0), np.empty(0), view.block.degrees(1.0)), words


def _figures(
    view: GroundView, ground: Ground, times: np.ndarray, degrees: np.ndarray, fullest: float
) -> Contents:
    """Return both figures for the same times, with free borders, and with lines at both critical angles, or unstable balances.

    A block against a wall has no angles below 0.
    """
    line, critical = ground.line(view.scale), view.block.degrees(1.0)
    end = float(max([*times[-1:], line["time"][-1]]))
    angle = fullest * (1 + 2 * OVER)
    least = -angle if view.block.wall is None else -2 * OVER * fullest
    largest = max(float(np.abs(line["acceleration"]).max()), 1e-6) * (1 + 5 * OVER)
    history: dict[str, Any] = {"ranges": [0.0, end, least, angle], "line": {"time": times, "angle": degrees}}
    left = -math.degrees(view.block.critical_angles[1]) if view.block.is_unsymmetric else -critical
    history |= {"above": critical, "below": 0.0 if view.block.wall else left}
    return {"history": history, "base": {"ranges": [0.0, end, -largest, largest], "line": line}}


def _history(motion: Motion, block: Block, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Return times in s and angles in degrees, thinned."""
    times = np.linspace(0.0, end_shown(motion), min(max(samples, FEWEST), STEPS))
    angle, _ = motion.at(times)
    return thinned(block.seconds(times), block.degrees(angle))


def _words(motion: Motion, block: Block, friction: float | None) -> dict[str, Any]:
    validity = None if block.restrainer else motion.validity(block, friction=friction)
    overturned, moves = motion.outcome == Outcome.OVERTURNED, motion.peak > 0.0
    kind, colour = "stands still", STILL
    if overturned:
        kind, colour = "overturns", FALLEN
    elif moves:
        kind, colour = "rocks and stands", ANGLES[min(int(motion.peak * len(ANGLES)), len(ANGLES) - 1)]
    sentence = SENTENCES[kind]
    if validity is not None and validity.refusal:
        kind, colour, sentence = "slides", "", _sentence(validity.refusal)
    unit = with_unit(block, motion.system.normalised_by)
    right, left = (unit.acceleration(level) / GRAVITY for level in motion.system.lift_offs)
    onset, other = f"{right:.4g} g", f", {left:.4g} g" if left < math.inf else ""
    weight = "" if motion.system.vertical is None else ", times the weight 1 + a_v"
    facts: Facts = [
        ("block", f"{block.height:.4g} m × {block.width:.4g} m"),
        *_sides(block),
        ("lifts off at", (onset if block.left is None else f"−{onset}{other}") + weight),
    ]
    if moves and not overturned:
        facts.append(("largest |θ|", degrees_and_share(block, motion.peak)))
    if moves:
        facts.append(("impacts", f"{motion.impacts:,}"))
    if motion.overturning is not None:
        facts.append(("overturning certain from", f"{block.seconds(motion.overturning.time):.4g} s"))
    facts += [row for row in (compared(motion),) if row[0]]
    return {
        "kind": kind,
        "sentence": sentence,
        "colour": colour,
        "facts": facts,
        **_evidence(motion, block, validity),
    }


def _sides(block: Block) -> Facts:
    """Return R, θcr and e, of both sides of an unsymmetric block."""
    if not block.is_unsymmetric:
        return [
            ("R", f"{block.radius:.4g} m"),
            ("θcr", f"{math.degrees(block.critical_angle):.4g}°"),
            ("e", f"{block.restitution:.4g} ({'Housner' if block.wall is None else 'wall'})"),
            *_restrainer(block),
        ]
    angles, radii, kept = block.critical_angles, block.radii, (block.restitution, block.left_restitution)
    return [
        ("offset", f"{block.offset:.4g} m"),
        ("R for θ > 0 and θ < 0", f"{radii[0]:.4g} m, {radii[1]:.4g} m"),
        ("θcr", f"{math.degrees(angles[0]):.4g}°, {math.degrees(angles[1]):.4g}°"),
        ("e", f"{kept[0]:.4g}, {kept[1]:.4g} (Housner)"),
    ]


def _restrainer(block: Block) -> Facts:
    """Return the ratios of a restrained block and its unstable balance; nothing of a free one."""
    if block.restrainer is None:
        return []
    ratios = f"κ = {block.stiffness_ratio:.4g}, ρ = {block.prestress_ratio:.4g}"
    balance = [("unstable balance θu", f"{block.degrees(1.0):.4g}°")] if block.by_balance else []
    return [("restrainer", ratios), *balance]


SENTENCES = {
    "stands still": "The base motion does not lift the block.",
    "rocks and stands": "The block rocks, and does not fall over.",
    "overturns": "The block falls over.",
}
"""What an outcome means for the block."""


def map_in_words(block: Block) -> str:
    """Return a sentence on what the blocks of the map lack that this one has; empty if it is like them."""
    lacks = {"wall": block.wall, "restrainer": block.restrainer, "offset": block.left}
    return next((f" The blocks of the map have no {name}." for name, own in lacks.items() if own), "")


def factor_in_words(view: GroundView) -> str:
    """Return a sentence that states the factor of the base motion; empty for the base motion itself."""
    if view.scale == 1.0:
        return ""
    motion = {"pulse": "the pulse", "file": "the record", "example": "the record"}
    return f" The base accelerates {view.scale:.4g} times as much as in {motion.get(view.source, 'the synthetic motion')}."


def _evidence(motion: Motion, block: Block, validity: Validity | None) -> dict[str, Any]:
    """Return margin, certificate and validity in words; of a block that slides, the validity alone."""
    sentences = _validity(motion, block, validity)
    if validity is not None and validity.refusal:
        return {"margin": "", "certified": "", "decided": True, "validity": sentences}
    certified = "Certified: no rounding error can have changed the outcome."
    if not motion.certified:
        certified = (
            "Not certified: rounding may have changed the outcome. Another computer may find the opposite."
        )
    return {
        "margin": margin_in_words(motion, block),
        "certified": certified,
        "decided": bool(motion.certified),
        "level": ": certified" if motion.certified else ": not certified",
        "validity": sentences,
    }


def margin_in_words(motion: Motion, block: Block) -> str:
    """Return how close the motion came to another outcome, as one sentence."""
    if math.isnan(motion.margin):
        return "No margin was found." if motion.peak > 0.0 else "The block never lifts off."
    size, time = abs(motion.margin), block.seconds(motion.margin_time)
    side = " of its side" if block.is_unsymmetric else ""
    unit = "" if block.by_balance else f"{size:.3g} α θcr{side} = "
    speed = f"{unit}{math.degrees(abs(margin_speed(motion, block))):.3g} °/s"
    if motion.margin >= 0.0:
        return f"Closest decision at t = {time:.4g} s: the block was faster than it had to be to overturn, by {speed}."
    if motion.outcome == Outcome.OVERTURNED:
        return f"Closest decision at t = {time:.4g} s: the block lacked a speed of {speed}, but overturned later."
    return f"Closest to overturning at t = {time:.4g} s: the block lacked a speed of {speed}."


def _validity(motion: Motion, block: Block, validity: Validity | None) -> list[str]:
    """Return the required friction, the error of the slender-block model and the warnings, as sentences."""
    if validity is None:
        return [
            _sentence(each) for each in restrained_warnings(block, motion.peak, motion.system.restitution)
        ]
    friction = []
    if validity.friction is not None and math.isfinite(validity.friction):
        available = validity.available_friction
        enough = available is not None and validity.slides_from is None
        friction = [
            f"Required coefficient of friction: {validity.friction:.3g}"
            + (f"; {available:g} suffices." if enough else ".")
        ]
    elif validity.friction is not None:
        friction = ["No friction suffices, because the base reaction vanishes."]
    errors = []
    if math.isfinite(validity.moment_error) and motion.system.critical_angle is None:
        errors = [
            f"The slender-block model overestimates the restoring moment by up to {validity.moment_error:.1%}."
        ]
    return [*friction, *errors, *map(_sentence, validity.warnings)]


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."
