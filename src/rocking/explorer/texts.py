"""Texts of the page: verdict, legends, progress, and the equivalent Python code and commands."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from attrs import evolve

from rocking.explorer.fields import Span, written
from rocking.explorer.harmonic_maps import SHADED
from rocking.explorer.harmonic_view import DEFAULT, HarmonicView
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.forcing import Harmonic
from rocking.model.text import counted, percent
from rocking.model.verdict import Kind, Verdict
from rocking.plot import palette

Facts = list[tuple[str, str]]

MIN_SHARE = 1e-4
"""Smallest area fraction in a legend."""


def verdict(result: Verdict, block: Block | None) -> dict[str, Any]:
    """Return a verdict for the page: response type, colour, named values and evidence."""
    forcing = result.system.periodic
    facts: Facts = [] if block is None else _physical(forcing, block)
    if result.period is not None:
        symmetry = "symmetric" if result.symmetric else "asymmetric"
        seconds = "" if block is None else f" ({block.seconds(result.period * forcing.period):.4g} s)"
        facts.append(("period", f"{counted(result.period, 'cycle')}, {symmetry}{seconds}"))
        hits = [("impacts", result.impacts_per_period), ("brace impacts", result.brace_hits_per_period)]
        facts += [(f"{what} per period", impacts(number)) for what, number in hits if number != 0]
    if result.kind != Kind.OVERTURNED:
        facts.append(_reach(result.peak, block))
    if result.multipliers is not None:
        facts.append(("Floquet multipliers", _pair(*result.multipliers)))
    if result.exponent is not None:
        rate, unit = (1.0, "τ") if block is None else (block.rate_unit, "s")
        error = result.exponent_error and rate * result.exponent_error
        facts.append(("largest Lyapunov exponent λ₁", exponent(rate * result.exponent, error, unit)))
    facts.append(("simulated", counted(result.cycles, "cycle")))
    return {
        "kind": str(result.kind),
        "sentence": sentence(result),
        "colour": palette.look_of(result).colour,
        "facts": facts,
        "level": f": {result.evidence.level}",
        "evidence": str(result.evidence),
    }


SENTENCES = {
    Kind.REST: "The block stands at rest.",
    Kind.QUASI_PERIODIC: "The block keeps rocking, regularly, and has not repeated its motion.",
    Kind.CHAOTIC: "The block keeps rocking, irregularly. Two almost equal starts soon lead to different motions.",
    Kind.OVERTURNED: "The block falls over.",
    Kind.UNDETERMINED: "The simulated motion does not show how the block ends.",
}
"""What a verdict means for the block; that of a periodic response also states its period."""


def sentence(result: Verdict) -> str:
    """Return in plain words what the block does."""
    if result.period is None:
        return SENTENCES[result.kind]
    times = "cycle" if result.period == 1 else f"{result.period} cycles"
    return f"The block keeps moving and repeats its motion every {times} of the base."


def impacts(number: int | None) -> str:
    """Write a number of impacts per period; None stands for infinitely many, before rest or contact with a brace."""
    return "infinitely many" if number is None else f"{number:,}"


def exponent(value: float, error: float | None, unit: str) -> str:
    """Write an exponent with its error."""
    if value == -math.inf:
        return "−∞ (superstable)"
    return f"{_signed(value)} ± {error:.2g} per {unit}" if error else f"{_signed(value)} per {unit}"


def _physical(forcing: Harmonic, block: Block) -> Facts:
    """Return the forcing and the block in SI units."""
    acceleration, seconds = block.acceleration(forcing.amplitude), block.seconds(forcing.period)
    base = f"{acceleration:.4g} m/s² ({acceleration / GRAVITY:.4g} g), {seconds:.4g} s ({1 / seconds:.4g} Hz)"
    sides = 1 if block.left is None else 2
    angles = ", ".join(f"{math.degrees(angle):.4g}°" for angle in block.critical_angles[:sides])
    kept = ", ".join(f"{e:.4g}" for e in block.housner_restitutions[:sides])
    size = f"{block.size}, θcr {angles}, Housner’s e {kept}"
    return [("forcing", base), ("block", size)]


def _reach(angle: float, block: Block | None) -> tuple[str, str]:
    if block is None:
        return "largest |Θ|", f"{angle:.6g}"
    top = f"top displacement {block.top_displacement(angle):.3g} m"
    return "largest |θ|", f"{block.degrees(angle):.4g}° ({angle:.4g} θcr), {top}"


def _signed(value: float) -> str:
    return f"{value:.4g}".replace("-", "−")


def _pair(larger: complex, smaller: complex) -> str:
    if abs(larger.imag) < 1e-12:
        return f"{_signed(larger.real)} and {_signed(smaller.real)}"
    return f"{_signed(larger.real)} ± {abs(larger.imag):.4g}i"


def legend(counts: np.ndarray, *, done: bool = True) -> list[dict[str, str]]:
    """Return all categories of the map, in fixed order, with their area fractions.

    A fraction below `MIN_SHARE` has no number. `counts`, shape (categories,), are numbers of points. Until the map is done,
    undetermined points are blank.
    """
    total = max(int(counts.sum()), 1)
    return [
        _entry(look.name, look.colour, look, count / total, done)
        for look, count in zip(palette.LOOKS, counts.tolist(), strict=True)
    ]


def attractors(counts: np.ndarray, *, done: bool = True) -> list[dict[str, str]]:
    """Return the attractors of a basin map with their area fractions, the largest category first.

    Attractors of a fraction below `MIN_SHARE` are left out. `counts`, shape (shades, categories), are numbers of points.
    Until the map is done, undetermined points are blank.
    """
    total, entries = max(int(counts.sum()), 1), []
    for place in np.argsort(-counts.sum(axis=0), kind="stable").tolist():
        name, look = palette.LOOKS[place].name, palette.LOOKS[place]
        for shade in np.argsort(-counts[:, place], kind="stable").tolist():
            if counts[shade, place] >= MIN_SHARE * total:
                colour = SHADED[shade * len(palette.LOOKS) + place]
                entries.append(_entry(name, colour, look, counts[shade, place] / total, done))
                name = "another orbit"
    return entries


def _entry(name: str, colour: str, look: palette.Look, share: float, done: bool) -> dict[str, str]:
    awaits = look.hatch is not None and not done
    return {
        "name": "not yet decided" if awaits else name,
        "colour": "transparent" if awaits else colour,
        "hatch": "" if awaits else look.hatch or "",
        "share": percent(share) if share >= MIN_SHARE else "",
    }


def python(view: HarmonicView) -> str:
    """Return Python code that reproduces the view, in its units; it leaves out initial angles beyond the braces."""
    angles = _between_braces(view)
    view = evolve(view, angles=angles or view.angles)
    phase = "" if view.phase == 0.0 else f", phase={view.phase!r}"
    if view.block is None:
        lines, limits = _normalised_code(view, phase), view.fields
    else:
        lines, limits = _code_in_si(view, view.block, phase), view.shown

    def axis(ranges: str) -> str:
        low, _, high = limits[ranges].partition(":")
        grid = f"np.linspace({low}, {high}, 101)"
        return grid if view.block is None else AXES_IN_SI[ranges].format(grid)

    varied = "amplitudes" if view.vary == "amplitude" else "periods"
    grid = f"angle={axis('angles')}, velocity={axis('velocities')}"
    basin = [f"basin = rk.basin_map(system, {grid}, boundary_runs=0)"] if angles else []
    return "\n".join(
        [
            "import numpy as np",
            "import rocking as rk",
            "",
            *lines,
            "print(rk.classify(system, start))",
            f"motion = rk.simulate(system, start, cycles={view.first + view.cycles})",
            *basin,
            f"diagram = rk.orbit_diagram(system, start, {view.vary}={axis(varied)})",
            "responses = rk.parametric_map(",
            "    system,",
            "    start,",
            f"    amplitude={axis('amplitudes')},",
            f"    period={axis('periods')},",
            ")",
        ]
    )


def _between_braces(view: HarmonicView) -> Span | None:
    """Return the part of the initial angles of the basin map that lies between the braces."""
    reach = math.inf if view.brace_angle is None else view.brace_angle
    low, high = max(view.angles.low, -reach), min(view.angles.high, reach)
    return Span(low, high) if low < high else None


AXES_IN_SI = {
    "amplitudes": "block.amplitude({})",
    "periods": "block.time({})",
    "angles": "block.angle(degrees={})",
    "velocities": "block.velocity(np.radians({}))",
}
"""Code that makes an axis in the units of the screen normalised."""


def _normalised_code(view: HarmonicView, phase: str) -> list[str]:
    """Return the lines that make system and initial state."""
    braces = ""
    if view.brace_angle is not None:
        braces = f", braces=rk.Braces({view.brace_angle!r}, {view.brace_restitution!r})"
    angle = "" if view.critical_angle is None else f", critical_angle={view.critical_angle!r}"
    return [
        f"forcing = rk.Harmonic({view.amplitude!r}, period={view.period!r}{phase})",
        f"system = rk.System(forcing, restitution={view.restitution!r}{braces}{angle})",
        f"start = rk.State({view.angle!r}, {view.velocity!r})",
    ]


def _code_in_si(view: HarmonicView, block: Block, phase: str) -> list[str]:
    """Return the lines that make block, system and initial state."""
    shown, braces = view.shown, ""
    if view.brace_angle is not None:
        angle = f"block.angle(degrees={shown['brace_angle']})"
        braces = f", braces=rk.Braces({angle}, {view.brace_restitution!r})"
    given = block.restitution != block.housner_restitution
    restitution = f", restitution={view.restitution!r}" if given else ""
    restitution += f", offset={block.offset!r}" if block.offset else ""
    model = "" if view.critical_angle is None else ', model="full"'
    forcing = f"acceleration={shown['amplitude']}, frequency_hz={shown['frequency_hz']}"
    return [
        f"block = rk.Block({block.height!r}, {block.width!r}{restitution})",
        f"system = block.system({forcing}{phase}{braces}{model})",
        f"start = rk.State(block.angle(degrees={shown['angle']}), block.velocity(np.radians({shown['velocity']})))",
    ]


def commands(view: HarmonicView) -> str:
    """Return commands for verdict, motion and map of the view; with a block in SI units."""
    usual = ("phase", "angle", "velocity", "brace_angle", "brace_restitution")
    named = [name for name in usual if name in view.fixed and getattr(view, name) != getattr(DEFAULT, name)]
    block = view.block
    if block is None or block.restitution != block.housner_restitution:
        named = ["restitution", *named]
    if block is None and view.critical_angle is not None:
        named.append("critical_angle")
    rest = "".join(f" --{name.replace('_', '-')}={written(getattr(view, name))}" for name in named)
    if block is not None and view.critical_angle is not None:
        rest += " --model full"
    point, plane = _normalised(view) if block is None else _in_metres(view, block)
    return (
        f"rocking classify {point}{rest}\n"
        f"rocking simulate {point}{rest} --cycles {view.first + view.cycles} --plot motion.png\n"
        f"rocking map {plane}{rest} --plot map.png"
    )


def _normalised(view: HarmonicView) -> tuple[str, str]:
    """Return the options of the selected forcing and of the map, normalised."""
    return (
        f"--amplitude {written(view.amplitude)} --period {written(view.period)}",
        f"--amplitude {written(view.amplitudes)}:101 --period {written(view.periods)}:101",
    )


def _in_metres(view: HarmonicView, block: Block) -> tuple[str, str]:
    """Return the options of the selected forcing and of the map, in SI units.

    The map is over the period in s, because even steps of the frequency are not even steps of the period.
    """
    size, shown = f"--height {written(block.height)} --width {written(block.width)}", view.shown
    size += f" --offset {written(block.offset)}" if block.offset else ""
    return (
        f"{size} --acceleration {shown['amplitude']} --frequency-hz {shown['frequency_hz']}",
        f"{size} --acceleration {shown['amplitudes']}:101 --period-s {shown['periods']}:101",
    )
