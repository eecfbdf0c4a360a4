"""What the page says in words: the verdict, the legend, and how to get the same without the page."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.explorer.fields import written
from rocking.explorer.figures import SHADED
from rocking.explorer.refine import Picture
from rocking.explorer.state import DEFAULT, Shown
from rocking.model import Block, Verdict, counted, percent
from rocking.plot import kinds

Facts = list[tuple[str, str]]


def verdict(found: Verdict, block: Block | None) -> dict[str, Any]:
    """A verdict for the page: its kind, numbers with what they are, and the evidence in one sentence."""
    facts: Facts = []
    if found.period is not None:
        symmetry = "symmetric" if found.symmetric else "unsymmetric"
        facts.append(("period", f"{counted(found.period, 'cycle')}, {symmetry}"))
        hits = [(found.impacts_per_period, "impact"), (found.brace_hits_per_period, "brace hit")]
        told = ", ".join(counted(number, what) for number, what in hits if number)
        facts.append(("in a period", told or "rest or leaning"))
    facts.append(("peak |Θ|", f"{found.peak:.6g}" + _reach(found.peak, block)))
    if found.multipliers is not None:
        facts.append(("multipliers", " and ".join(_complex(each) for each in found.multipliers)))
    if found.exponent is not None:
        facts.append(("exponent λ₁", exponent(found.exponent, found.exponent_error)))
    facts.append(("followed", counted(found.cycles, "cycle")))
    return {
        "kind": str(found.kind),
        "colour": kinds.COLOURS[found.kind],
        "facts": facts,
        "evidence": str(found.evidence),
    }


def exponent(value: float, error: float | None) -> str:
    """An exponent with its error."""
    if value == -math.inf:
        return "−∞ (forgets every small difference)"
    return f"{_signed(value)} ± {error:.2g} per τ" if error else f"{_signed(value)} per τ"


def _reach(angle: float, block: Block | None) -> str:
    return (
        "" if block is None else f" ({block.degrees(angle):.3g}°, top {block.top_displacement(angle):.3g} m)"
    )


def _signed(value: float) -> str:
    return f"{value:.4g}".replace("-", "−")


def _complex(value: complex) -> str:
    if abs(value.imag) < 1e-12:
        return _signed(value.real)
    return f"{_signed(value.real)} {'+' if value.imag > 0 else '−'} {abs(value.imag):.4g}i"


def legend(counts: np.ndarray) -> list[dict[str, str]]:
    """All looks, each always in its place, with the shares of those that a picture has: `counts` (looks,)."""
    total = max(int(counts.sum()), 1)
    return [
        _entry(look.name, look.colour, look, count / total)
        for look, count in zip(kinds.LOOKS, counts.tolist(), strict=True)
    ]


def attractors(counts: np.ndarray) -> list[dict[str, str]]:
    """What starts lead to, with shares: the looks that a picture has, and their shades, the largest first; `counts` (shades, looks)."""
    total, entries = max(int(counts.sum()), 1), []
    for place in np.argsort(-counts.sum(axis=0), kind="stable").tolist():
        name, look = kinds.LOOKS[place].name, kinds.LOOKS[place]
        for shade in np.argsort(-counts[:, place], kind="stable").tolist():
            if counts[shade, place]:
                colour = SHADED[shade * len(kinds.LOOKS) + place]
                entries.append(_entry(name, colour, look, counts[shade, place] / total))
                name = "another"
    return entries


def _entry(name: str, colour: str, look: kinds.Look, share: float) -> dict[str, str]:
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


def python(shown: Shown) -> str:
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
        lines.insert(3, f"block = {_block(shown)}")
    return "\n".join(lines)


def _axis(span: Any) -> str:
    return f"np.linspace({span.low!r}, {span.high!r}, 101)"


def _block(shown: Shown) -> str:
    return f"rk.Block({shown.height!r}, {shown.width!r}, restitution={shown.restitution!r})"


def commands(shown: Shown) -> str:
    """The same at a prompt: what the response is, and the map."""
    usual = ("phase", "angle", "velocity", "brace_angle", "brace_restitution")
    named = [name for name in usual if name in shown.fixed and getattr(shown, name) != getattr(DEFAULT, name)]
    options = [
        f" --{name.replace('_', '-')}={written(getattr(shown, name))}" for name in ("restitution", *named)
    ]
    rest = "".join(options)
    point = f"rocking classify --amplitude {written(shown.amplitude)} --period {written(shown.period)}{rest}"
    plane = (
        f"rocking map --amplitude {written(shown.amplitudes)}:101 --period {written(shown.periods)}:101{rest}"
        " --plot map.png"
    )
    return f"{point}\n{plane}"
