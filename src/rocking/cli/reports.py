"""Rows, JSON entries and warnings that several reports share."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.output import WARNING, Row
from rocking.model.block import Block, unit_for
from rocking.model.block_formulas import GRAVITY, with_unit
from rocking.model.forcing import Pulse
from rocking.model.quantity import IN_SI
from rocking.model.system import Side, System, Wall, angle_doubt
from rocking.model.text import counted
from rocking.model.verdict import Verdict

if TYPE_CHECKING:
    from rocking.motion.motion import Motion
    from rocking.response.lyapunov import LyapunovSpectrum

MAX_ROWS = 20
"""Largest number of printed rows of a long result."""


def input_rows(result: Motion | Verdict | LyapunovSpectrum, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the input, normalised and in SI."""
    yield from system_rows(result.system, block)
    yield (
        "initial state",
        f"Θ = {result.start.angle:.6g}, Θ' = {result.start.velocity:.6g}",
        "" if block is None else state_in_si(result.start, block),
    )


def system_rows(system: System, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the system."""
    restitution, braces = system.restitution, system.braces
    if block is not None:
        yield "", "normalised", "in SI"
        name = "unstable balance" if block.by_balance else "critical angle"
        yield name, "1", f"{block.degrees(1.0):.4g}°"
        if block.restrainer is not None:
            yield "restrainer", f"κ = {block.stiffness_ratio:.6g}, ρ = {block.prestress_ratio:.6g}", ""
        yield time_unit(block), "1", f"{block.seconds(1.0):.4g} s"
        unit = ", a/(g tan θcr)" if block.normalised_by == "tangent" else ""
        unit = unit.replace("(g", "((1 + ρ) g") if block.by_balance else unit
        slender = system.critical_angle is None
        yield "equation of motion", f"small angles{unit}" if slender else "full", ""
        if block.left is not None:
            angle = "" if block.wall else f"{math.degrees(block.critical_angles[1]):.4g}°"
            yield "left side", left_text(system.left), angle
    elif system.critical_angle is not None:
        yield "critical angle", f"θcr = {system.critical_angle:.6g} rad, full equation of motion", ""
    if block is None and system.left is not None:
        yield "left side", left_text(system.left), ""
    yield from base_rows(system, block)
    if block is None:
        yield "restitution", f"e = {restitution:.6g}", ""
    else:
        yield "restitution", f"e = {restitution:.6g}", origin(block)
    if braces is not None:
        at = "" if block is None else f"{block.degrees(braces.angle):.4g}°"
        yield "braces", f"Θb = {braces.angle:.6g}, r = {braces.restitution:.6g}", at


def angle_symbol(block: Block) -> str:
    """Return the unit of the normalised angles of a block in words."""
    return "of the angle of unstable balance" if block.by_balance else "θcr"


def left_text(left: Side | None) -> str:
    """Return the left side of an unsymmetric block in units of the right one, or the wall there."""
    if left is None:
        return "as the right one"
    if isinstance(left, Wall):
        return f"wall, e_w = {left.restitution:.6g}"
    return f"θcr2 = {left.angle_ratio:.6g}, α2 = {left.frequency_ratio:.6g}, e21 = {left.restitution:.6g}"


def base_rows(system: System, block: Block | None) -> Iterator[Row]:
    """Yield the rows of a base motion that a few numbers describe."""
    if isinstance(system.forcing, Pulse):
        pulse = system.forcing
        size = f"A = {pulse.amplitude:.6g}"
        yield "pulse", pulse.kind, ""
        yield "amplitude", size, in_si("amplitude", pulse.amplitude, block)
        yield "duration", f"τ = {pulse.span:.6g}", in_si("period", pulse.span, block)
        return
    forcing = system.periodic
    if block is None:
        yield "forcing", f"A = {forcing.amplitude:.6g}, T = {forcing.period:.6g}, φ = {forcing.phase:.6g}", ""
    else:
        yield "amplitude", f"A = {forcing.amplitude:.6g}", in_si("amplitude", forcing.amplitude, block)
        yield "period", f"T = {forcing.period:.6g}", in_si("period", forcing.period, block)
        yield "phase", f"φ = {forcing.phase:.6g}", f"{math.degrees(forcing.phase):.4g}°"


def law_text(block: Block | None) -> str:
    """Return the law of restitution of a block, if it is not one number."""
    return "" if block is None or block.law.is_plain else str(block.law)


def origin(block: Block) -> str:
    """Return the origin of the coefficient of restitution of a block, in words."""
    law = block.law
    if law.is_plain:
        return (
            "Housner's value for this block"
            if law.is_housner
            else law.origin
            if law.value is None
            else "as given"
        )
    return str(law)


def in_si(name: str, values: Any, block: Block | None) -> str:
    """Return a quantity, or the ends of its range, in SI units; an acceleration in m/s² and in g."""
    if block is None or name not in IN_SI:
        return ""
    si = IN_SI[name]
    assert si.drawn is not None
    text = (
        f"{ends_text(si.drawn(block, values))}{'' if si.drawn_unit.startswith('°') else ' '}{si.drawn_unit}"
    )
    return f"{text} = {ends_text(block.acceleration(values) / GRAVITY)} g" if name == "amplitude" else text


def ends_text(values: Any) -> str:
    """Return a number, or the ends of a range."""
    return " to ".join(f"{value:.4g}" for value in np.atleast_1d(values))


def angle_warning(angle: float, block: Block | None) -> Iterator[str]:
    """Yield a warning for an initial angle that was probably meant in degrees."""
    remedy = "the unit is not degrees"
    if block is not None:
        remedy = f"{angle:.6g}° is --angle {block.angle(degrees=angle):.4g}"
    if sentence := angle_doubt(angle, remedy):
        yield f"{WARNING}--{sentence}"


def reach(angle: float, block: Block | None) -> str:
    """Return an angle of a block in degrees, and the displacement of its top."""
    return "" if block is None else f"{block.degrees(angle):.4g}°, top {block.top_displacement(angle):.4g} m"


def state_in_si(state: Any, block: Block) -> str:
    """Return the angle and the velocity of a state in ° and °/s."""
    return f"{in_si('angle', state.angle, block)}, {in_si('velocity', state.velocity, block)}"


def time_unit(block: Block) -> str:
    """Return the name of the unit of time of a block."""
    return "time unit" if block.by_balance else "time unit 1/α"


SMALL_ANGLES, FULL = "small angles, with the restrainer", "full, with the restrainer"


def equation(
    critical_angle: float,
    left_angle: float | None = None,
    *,
    full: bool,
    braced: bool = False,
    normalised_by: str = "angle",
) -> str:
    """Return the equation of motion in words, that of small angles with its errors for |θ| ≤ θcr, in rad, on both sides."""
    from rocking.motion.model_warnings import slender_errors

    if full:
        return "full"
    reached = max(critical_angle, left_angle or 0.0)
    worst = max(slender_errors(critical_angle, reached, normalised_by, left_angle))
    remedy = "" if braced else " (--model full avoids this)"
    what = {"angle": "moments overestimated", "tangent": "a/(g tan θcr), moments wrong"}[normalised_by]
    return f"small angles; {what} by up to {100.0 * worst:.1f} %{remedy}"


def equation_line(block: Block, attributes: Mapping[str, Any]) -> str:
    """Return the equation of motion of a survey of one block, as a line below a table with a row per record."""
    if block.restrainer is not None:
        restrained = SMALL_ANGLES if attributes["model"] == "slender" else FULL
        return f"equation of motion: {restrained}"
    full, by = attributes["model"] == "full", attributes.get("normalised_by", "angle")
    return f"equation of motion: {equation(*block.critical_angles, full=full, normalised_by=by)}"


def survey_warnings(block: Block, attributes: Mapping[str, Any]) -> list[str]:
    """Return the warnings about the block of a survey of ground motions with these attributes."""
    by = unit_for(block, attributes.get("normalised_by", "angle"), attributes["model"])
    block = with_unit(block, by)
    return block_warnings(block, (), block.restitution, full=attributes["model"] == "full")


def shape_warnings(
    height: float,
    critical_angle: float,
    left_angle: float | None = None,
    *,
    full: bool,
    normalised_by: str = "angle",
) -> Iterator[str]:
    """Yield the warnings about blocks of many shapes, up to a height in m and a critical angle of each side in rad."""
    from rocking.motion.model_warnings import height_warnings, proportion_warnings

    yield from height_warnings(height)
    if not full:
        reached = max(critical_angle, left_angle or 0.0)
        yield from proportion_warnings(critical_angle, reached, normalised_by, left_angle)


def block_warnings(
    block: Block | None,
    amplitudes: Any,
    restitutions: Any,
    *,
    full: bool = False,
    angle: float | None = None,
) -> list[str]:
    """Return the warnings about the block itself, up to an angle in rad, by default θcr; none without a block."""
    if block is None:
        return []
    from rocking.motion.model_warnings import block_warnings as sentences

    left = None if block.left is None else block.left_restitution
    least = float(np.min(restitutions))
    return list(sentences(block, amplitudes, least, angle, left_restitution=left, full=full))


def warning_lines(sentences: Iterable[str]) -> list[str]:
    """Return sentences as warning lines below a table."""
    return [f"{WARNING}{sentence}" for sentence in sentences]


def undecided(count: int) -> Iterator[str]:
    """Yield a warning if outcomes are undecided."""
    if count:
        yield f"{counted(count, 'outcome')} undecided in double precision: the rounding error may exceed what decides"
