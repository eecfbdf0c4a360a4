"""Report of a motion, as text or JSON; rows shared by the other reports."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from rocking.cli.output.console import WARNING, Row, print_json, print_table
from rocking.cli.reports import validity
from rocking.model.block import PHYSICAL, Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.forcing import Pulse
from rocking.model.system import System, angle_doubt, quantities
from rocking.model.text import counted, ordinal
from rocking.model.verdict import Verdict
from rocking.motion.motion import has_cycles

if TYPE_CHECKING:
    import xarray as xr

    from rocking.motion.motion import Motion
    from rocking.response.lyapunov import LyapunovSpectrum


def show(motion: Motion, block: Block | None, files: Sequence[Path], *, as_json: bool) -> None:
    """Print the summary on stdout, and the paths of the files."""
    if as_json:
        print_json(record(motion, block, files))
    else:
        more = [*beyond(motion.start.angle, block), *validity.lines(motion, block)]
        print_table(verdict(motion), [*asked(motion, block), *found(motion, block)], files, more)


def verdict(motion: Motion) -> str:
    """Return the outcome in one line."""
    overturning, doubt = motion.overturning, f" ({motion.doubt})" if motion.doubt else ""
    if overturning is not None:
        if doubt:
            return f"overturned from τ = {overturning.time:.6g}{doubt}"
        cycle = f", in the {ordinal(overturning.cycle + 1)} cycle" if has_cycles(motion) else ""
        return f"overturned (proved at τ = {overturning.time:.6g}{cycle})"
    if motion.outcome == "at-rest":
        return f"at rest permanently{doubt}"
    if not has_cycles(motion):
        return f"bounded up to τ = {motion.duration:.6g}{doubt}"
    return f"bounded over {counted(motion.cycles, 'cycle')} (neither rest nor overturning was proved)"


def asked(result: Motion | Verdict | LyapunovSpectrum, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the input, normalised and in SI."""
    yield from asked_of(result.system, block)
    yield (
        "initial state",
        f"Θ = {result.start.angle:.6g}, Θ' = {result.start.velocity:.6g}",
        _state(result.start, block),
    )


def asked_of(system: System, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the system."""
    restitution, braces = system.restitution, system.braces
    if block is not None:
        yield "", "normalised", "in SI"
        yield "critical angle", "1", f"{block.degrees(1.0):.4g}°"
        yield "time unit 1/α", "1", f"{block.seconds(1.0):.4g} s"
        if system.critical_angle is not None:
            yield "equation of motion", "full", ""
    elif system.critical_angle is not None:
        yield "critical angle", f"θcr = {system.critical_angle:.6g} rad, full equation of motion", ""
    yield from _base_rows(system, block)
    if block is None:
        yield "restitution", f"e = {restitution:.6g}", ""
    else:
        yield "restitution", f"e = {restitution:.6g}", origin(block)
    if braces is not None:
        at = "" if block is None else f"{block.degrees(braces.angle):.4g}°"
        yield "braces", f"Θb = {braces.angle:.6g}, r = {braces.restitution:.6g}", at


def _base_rows(system: System, block: Block | None) -> Iterator[Row]:
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


def origin(block: Block) -> str:
    """Return the origin of the coefficient of restitution of a block, in words."""
    return "Housner's value for this block" if block.has_housner_restitution else "as given"


def in_si(name: str, values: Any, block: Block | None) -> str:
    """Return a quantity, or the ends of its range, in SI units; an acceleration in m/s² and in g."""
    if block is None or name not in SHOWN:
        return ""
    turn, unit = SHOWN[name]
    shown = f"{_range(turn(block, values))}{unit}"
    return f"{shown} = {_range(block.acceleration(values) / GRAVITY)} g" if name == "amplitude" else shown


def _range(values: Any) -> str:
    return " to ".join(f"{value:.4g}" for value in np.atleast_1d(values))


def _degrees_per_second(block: Block, velocities: Any) -> Any:
    return np.degrees(block.radians_per_second(velocities))


SHOWN: dict[str, tuple[Callable[[Block, Any], Any], str]] = {
    "amplitude": (Block.acceleration, " m/s²"),
    "period": (Block.seconds, " s"),
    "frequency": (Block.hertz, " Hz"),
    "angle": (Block.degrees, "°"),
    "velocity": (_degrees_per_second, "°/s"),
    "brace_angle": (Block.degrees, "°"),
}
"""Quantity → its conversion by a block and the unit printed."""


def beyond(angle: float, block: Block | None) -> Iterator[str]:
    """Yield a warning for an initial angle that was probably meant in degrees."""
    remedy = "the unit is not degrees"
    if block is not None:
        remedy = f"{angle:.6g}° is --angle {block.angle(degrees=angle):.4g}"
    if doubt := angle_doubt(angle, remedy):
        yield f"{WARNING}--{doubt}"


def found(motion: Motion, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the result."""
    time = "" if block is None else f"{block.seconds(motion.duration):.4g} s"
    cycles = f"{counted(motion.cycles, 'cycle')}, " if has_cycles(motion) else ""
    yield "simulated", f"{cycles}τ = {motion.duration:.6g}", time
    yield "impacts", f"{motion.impacts}{_cut(motion, 'rest')}", ""
    if motion.system.braces is not None:
        yield "brace impacts", f"{motion.brace_hits}{_cut(motion, 'sustained contact')}", ""
    if motion.overturning is None:
        yield "largest |Θ|", f"{motion.peak:.6g}", reach(motion.peak, block)
    if not math.isnan(motion.margin):
        at = "" if block is None else f" = {block.seconds(motion.margin_time):.4g} s"
        yield "margin K₊", f"{motion.margin:.6g}", f"at τ = {motion.margin_time:.6g}{at}"
    yield (
        "final state" if motion.overturning is None else f"state when overturning was {_known(motion)}",
        f"Θ = {motion.final.angle:.6g}, Θ' = {motion.final.velocity:.6g}",
        _state(motion.final, block),
    )


def _known(motion: Motion) -> str:
    """Return the word for overturning: certain, or proved for the computed motion alone."""
    return "certain" if motion.certified else "proved"


def reach(angle: float, block: Block | None) -> str:
    """Return an angle of a block in degrees, and the displacement of its top."""
    return "" if block is None else f"{block.degrees(angle):.4g}°, top {block.top_displacement(angle):.4g} m"


def _cut(motion: Motion, end: str) -> str:
    """Return the note on a count of impacts that is incomplete, else an empty text."""
    return "" if motion.record == "all" else f" (without the last ones of chattering before {end})"


def _state(state: Any, block: Block | None) -> str:
    return "" if block is None else state_in_si(state, block)


def state_in_si(state: Any, block: Block) -> str:
    """Return the angle and the velocity of a state in ° and °/s."""
    return f"{in_si('angle', state.angle, block)}, {in_si('velocity', state.velocity, block)}"


def record(motion: Motion, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """Return the summary as a JSON object."""
    summary: dict[str, Any] = {
        "outcome": str(motion.outcome),
        "overturning": None if motion.overturning is None else attrs.asdict(motion.overturning),
        **question(motion),
        "cycles": motion.cycles,
        "duration": motion.duration,
        "impacts": motion.impacts,
        "brace_hits": motion.brace_hits,
        "impacts_cut_short": motion.record != "all",
        "peak": motion.peak,
        **({} if has_cycles(motion) else closeness(motion)),
        "final": attrs.asdict(motion.final),
        "files": [str(path) for path in files],
    }
    if block is not None:
        summary["block"] = physical(motion, block)
        summary["validity"] = validity.record(motion, block)
    return summary


def closeness(motion: Motion) -> dict[str, Any]:
    """Return how close a motion came to another outcome as a JSON object; no number if the block never moves."""
    moved = not math.isnan(motion.margin)
    return {
        "margin": motion.margin if moved else None,
        "margin_time": motion.margin_time if moved else None,
        "certified": motion.certified,
    }


def question(result: Motion | Verdict | LyapunovSpectrum) -> dict[str, Any]:
    """Return the system and the initial state as a JSON object."""
    return question_of(result.system) | {"start": attrs.asdict(result.start)}


def question_of(system: System) -> dict[str, Any]:
    """Return the system as a JSON object."""
    found = quantities(system)
    kind = {"pulse": system.forcing.kind} if isinstance(system.forcing, Pulse) else {}
    alone = kind | {name: found[name] for name in found if not name.startswith("brace_")}
    return alone | {"braces": None if system.braces is None else attrs.asdict(system.braces)}


def physical(result: Motion | Verdict, block: Block) -> dict[str, Any]:
    """Return the block, its base motion and its largest angle in SI as a JSON object."""
    return physical_of(result.system, block) | peak_in_si(result, block)


def peak_in_si(result: Motion | Verdict, block: Block) -> dict[str, float]:
    """Return the largest angle and the displacement of the top in SI as a JSON object."""
    return {
        "peak_deg": float(block.degrees(result.peak)),
        "peak_top_displacement_m": float(block.top_displacement(result.peak)),
    }


def size_of(block: Block) -> dict[str, float]:
    """Return the size of a block and its units of angle and time as a JSON object."""
    return {
        "height_m": block.height,
        "width_m": block.width,
        "critical_angle_deg": float(block.degrees(1.0)),
        "time_unit_s": block.seconds(1.0),
    }


def asked_in_si(data: xr.Dataset, block: Block) -> dict[str, Any]:
    """Return the block and the quantities of its survey in SI as a JSON object."""
    asked: dict[str, Any] = {}
    for name, each in PHYSICAL.items():
        if name in data.coords:
            start, stop = each.turn(block, data[name].values[[0, -1]]).tolist()
            asked[each.key] = {"start": start, "stop": stop, "count": data.sizes[name]}
        elif name in data.attrs:
            asked[each.key] = float(each.turn(block, data.attrs[name]))
    return size_of(block) | asked


def physical_of(system: System, block: Block) -> dict[str, Any]:
    """Return the block and its base motion in SI as a JSON object."""
    if isinstance(system.forcing, Pulse):
        pulse = system.forcing
        size, length = pulse.amplitude, {"duration_s": PHYSICAL["period"].turn(block, pulse.span)}
    else:
        size = system.periodic.amplitude
        length = {"period_s": PHYSICAL["period"].turn(block, system.periodic.period)}
    return size_of(block) | {
        "acceleration_m_per_s2": PHYSICAL["amplitude"].turn(block, size),
        **length,
        "restitution_is_housners": block.has_housner_restitution,
    }
