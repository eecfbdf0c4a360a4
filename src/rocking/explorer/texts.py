"""What the page says in words: the verdict, the legend, and how to get the same without the page."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from rocking.explorer.bokeh_figures import SHADED
from rocking.explorer.form_fields import written
from rocking.explorer.progressive_map import Picture
from rocking.explorer.view_state import DEFAULT, ViewState
from rocking.model import GRAVITY, Block, Harmonic, Verdict, counted, percent
from rocking.plot.parts import legend as looks

Facts = list[tuple[str, str]]


def verdict(found: Verdict, block: Block | None) -> dict[str, Any]:
    """A verdict for the page: its kind, numbers with what they are, and the evidence in one sentence."""
    forcing = found.system.forcing
    facts: Facts = [] if block is None else _physical(forcing, block)
    if found.period is not None:
        symmetry = "symmetric" if found.symmetric else "unsymmetric"
        seconds = "" if block is None else f" ({block.seconds(found.period * forcing.period):.4g} s)"
        facts.append(("period", f"{counted(found.period, 'cycle')}, {symmetry}{seconds}"))
        hits = [(found.impacts_per_period, "impact"), (found.brace_hits_per_period, "brace hit")]
        facts.append(("in a period", ", ".join(hits_in_period(*hit) for hit in hits if hit[0] != 0)))
    facts.append(("peak |Θ|", f"{found.peak:.6g}" + _reach(found.peak, block)))
    if found.multipliers is not None:
        facts.append(("multipliers", _pair(*found.multipliers)))
    if found.exponent is not None:
        facts.append(("exponent λ₁", exponent(found.exponent, found.exponent_error)))
    facts.append(("followed", counted(found.cycles, "cycle")))
    return {
        "kind": str(found.kind),
        "colour": looks.COLOURS[found.kind],
        "facts": facts,
        "evidence": str(found.evidence),
    }


def hits_in_period(number: int | None, what: str) -> str:
    """How many hits a period has; infinitely many come before rest or leaning."""
    return f"infinitely many {what}s" if number is None else counted(number, what)


def exponent(value: float, error: float | None) -> str:
    """An exponent with its error."""
    if value == -math.inf:
        return "−∞ (forgets every small difference)"
    return f"{_signed(value)} ± {error:.2g} per τ" if error else f"{_signed(value)} per τ"


def _physical(forcing: Harmonic, block: Block) -> Facts:
    """The base's motion in SI, and what the normalised units are there."""
    acceleration, seconds = block.acceleration(forcing.amplitude), block.seconds(forcing.period)
    base = f"{acceleration:.4g} m/s² ({acceleration / GRAVITY:.4g} g), {seconds:.4g} s ({1 / seconds:.4g} Hz)"
    units = f"A {block.acceleration(1.0):.4g} m/s², τ {block.seconds(1.0):.4g} s, Θ {block.degrees(1.0):.4g}°"
    return [("base", base), ("units", units)]


def _reach(angle: float, block: Block | None) -> str:
    return (
        "" if block is None else f" ({block.degrees(angle):.3g}°, top {block.top_displacement(angle):.3g} m)"
    )


def _signed(value: float) -> str:
    return f"{value:.4g}".replace("-", "−")


def _pair(larger: complex, smaller: complex) -> str:
    if abs(larger.imag) < 1e-12:
        return f"{_signed(larger.real)} and {_signed(smaller.real)}"
    return f"{_signed(larger.real)} ± {abs(larger.imag):.4g}i"


def legend(counts: np.ndarray) -> list[dict[str, str]]:
    """All looks, each always in its place, with the shares of those that a picture has: `counts` (looks,)."""
    total = max(int(counts.sum()), 1)
    return [
        _entry(look.name, look.colour, look, count / total)
        for look, count in zip(looks.LOOKS, counts.tolist(), strict=True)
    ]


def attractors(counts: np.ndarray) -> list[dict[str, str]]:
    """What starts lead to, with shares: the looks that a picture has, and their shades, the largest first; `counts` (shades, looks)."""
    total, entries = max(int(counts.sum()), 1), []
    for place in np.argsort(-counts.sum(axis=0), kind="stable").tolist():
        name, look = looks.LOOKS[place].name, looks.LOOKS[place]
        for shade in np.argsort(-counts[:, place], kind="stable").tolist():
            if counts[shade, place]:
                colour = SHADED[shade * len(looks.LOOKS) + place]
                entries.append(_entry(name, colour, look, counts[shade, place] / total))
                name = "another"
    return entries


def _entry(name: str, colour: str, look: looks.Look, share: float) -> dict[str, str]:
    return {
        "name": name,
        "colour": colour,
        "hatch": look.hatch or "",
        "share": percent(share) if share else "",
    }


def progress(picture: Picture) -> dict[str, Any]:
    """How far the map is: in words, and as a share of all points."""
    side = len(picture.look)
    share = (
        1.0
        if picture.done
        else 0.25 * (side / picture.points) ** 2 * (1.0 + 3.0 * picture.settled / max(picture.of, 1))
    )
    return {"text": f"map of {side} × {side} points", "share": share, "side": side, "done": picture.done}


def python(shown: ViewState) -> str:
    """The lines of Python that give what is shown."""
    lines = ["import numpy as np", "import rocking as rk", ""]
    phase = "" if shown.phase == 0.0 else f", phase={shown.phase!r}"
    braces = ""
    if shown.brace_angle is not None:
        braces = f", braces=rk.Braces({shown.brace_angle!r}, {shown.brace_restitution!r})"
    lines += [
        f"forcing = rk.Harmonic({shown.amplitude!r}, period={shown.period!r}{phase})",
        f"system = rk.System(forcing, restitution={shown.restitution!r}{braces})",
        f"start = rk.State({shown.angle!r}, {shown.velocity!r})",
        "print(rk.classify(system, start))",
        f"motion = rk.simulate(system, start, cycles={shown.first + shown.cycles})",
        f"basin = rk.basin_map(system, angle={_axis(shown.angles)}, velocity={_axis(shown.velocities)}, boundary_runs=0)",
        f"diagram = rk.orbit_diagram(system, {shown.vary!r}, {_axis(shown.varied)}, start)",
        "found = rk.parametric_map(",
        f"    amplitude={_axis(shown.amplitudes)},",
        f"    period={_axis(shown.periods)},",
        "    " + ", ".join(f"{name}={value!r}" for name, value in shown.fixed.items()) + ",",
        ")",
    ]
    if shown.block is not None:
        lines.insert(
            3, f"block = rk.Block({shown.height!r}, {shown.width!r}, restitution={shown.restitution!r})"
        )
    return "\n".join(lines)


def _axis(span: Any) -> str:
    return f"np.linspace({span.low!r}, {span.high!r}, 101)"


def commands(shown: ViewState) -> str:
    """The same at a prompt, in SI where there is a block: what the response is, its motion, and the map."""
    usual = ("phase", "angle", "velocity", "brace_angle", "brace_restitution")
    named = [name for name in usual if name in shown.fixed and getattr(shown, name) != getattr(DEFAULT, name)]
    block = shown.block
    if block is None or block.restitution != block.housner_restitution:
        named = ["restitution", *named]
    rest = "".join(f" --{name.replace('_', '-')}={written(getattr(shown, name))}" for name in named)
    point, plane = _normalised(shown) if block is None else _in_metres(shown, block)
    return (
        f"rocking classify {point}{rest}\n"
        f"rocking simulate {point}{rest} --cycles {shown.first + shown.cycles} --plot motion.png\n"
        f"rocking map {plane}{rest} --plot map.png"
    )


def _normalised(shown: ViewState) -> tuple[str, str]:
    """Options of the forcing selected, and of those of the map."""
    return (
        f"--amplitude {written(shown.amplitude)} --period {written(shown.period)}",
        f"--amplitude {written(shown.amplitudes)}:101 --period {written(shown.periods)}:101",
    )


def _in_metres(shown: ViewState, block: Block) -> tuple[str, str]:
    """The same of a block in SI; the map over seconds, for even steps of the frequency are not even ones of the period."""

    def acceleration(amplitude: float) -> str:
        return _digits(amplitude, block.acceleration, block.amplitude)

    def hertz(period: float) -> str:
        return _digits(
            period, lambda each: 1 / block.seconds(each), lambda each: math.tau / block.frequency(each)
        )

    def seconds(period: float) -> str:
        return _digits(period, block.seconds, block.time)

    size = f"--height {written(block.height)} --width {written(block.width)}"
    across = f"{seconds(shown.periods.low)}:{seconds(shown.periods.high)}:101"
    up = f"{acceleration(shown.amplitudes.low)}:{acceleration(shown.amplitudes.high)}:101"
    return (
        f"{size} --acceleration {acceleration(shown.amplitude)} --frequency-hz {hertz(shown.period)}",
        f"{size} --acceleration {up} --period-s {across}",
    )


def _digits(value: float, physical: Callable[[float], float], normalised: Callable[[float], float]) -> str:
    """What is in SI, in the fewest digits that give the normalised value back: 3 where 3 was typed."""
    for digits in (15, 16, 17):
        text = f"{physical(value):.{digits}g}"
        if normalised(float(text)) == value:
            break
    return text
