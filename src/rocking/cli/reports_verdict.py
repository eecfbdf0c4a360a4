"""Reports of a verdict, of Lyapunov exponents, and of the symmetric modes in closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import frozen

from rocking.cli.options import reworded
from rocking.cli.output import Report, Row, Text, aligned
from rocking.cli.reports import (
    angle_warning,
    block_warnings,
    in_si,
    input_rows,
    reach,
    system_rows,
    warning_lines,
)
from rocking.cli.reports_motion import validity_lines, validity_motion, validity_record
from rocking.model.arrays import nan_if_none
from rocking.model.block import Block
from rocking.model.orbit import Mode, multiplier_columns
from rocking.model.proof import Proof
from rocking.model.result import Result, along, described
from rocking.model.system import System, quantities
from rocking.model.text import counted, plus_minus
from rocking.model.verdict import Verdict
from rocking.response.lyapunov import dimension_of

if TYPE_CHECKING:
    import xarray as xr

    from rocking.cli.requests import Request
    from rocking.response.lyapunov import LyapunovSpectrum

# Verdict.


def verdict_text(verdict: Verdict, request: Request) -> Text:
    """Return the verdict, its numbers, and the validity of the model."""
    block = request.block
    rows = [*input_rows(verdict, block), *verdict_rows(verdict, block)]
    lines = list(angle_warning(verdict.start.angle, block))
    if block is not None:
        over, motion = validity_motion(verdict)
        lines += [f"{over}:", *validity_lines(motion, block)]
    return Text(reworded(str(verdict)), rows, lines)


def verdict_rows(verdict: Verdict, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the result; quantities that do not apply are left out."""
    orbit, exponent = verdict.orbit, verdict.exponent
    if orbit is not None:
        time = orbit.period * verdict.system.periodic.period
        seconds = "" if block is None else f"{block.seconds(time):.4g} s"
        yield "period", f"{counted(orbit.period, 'cycle')}, τ = {time:.6g}", seconds
        yield "impacts per period", count_text(orbit.impacts), ""
        if verdict.system.braces is not None:
            yield "brace impacts per period", count_text(orbit.brace_hits), ""
        yield "Floquet multipliers", multipliers_text(*orbit.multipliers), ""
        if orbit.proof is not None and orbit.proof.proved:
            yield "proof", f"{orbit.proof.bits} bits, multipliers to {accuracy(orbit.proof)}", ""
    if exponent is not None:
        yield "largest Lyapunov exponent", *exponent_text(exponent, verdict.exponent_error, block)
    if verdict.kind != "overturned":
        yield "largest |Θ|", f"{verdict.peak:.6g}", reach(verdict.peak, block)
    if verdict.steady_peak is not None:
        yield (
            "largest |Θ| after the transient",
            f"{verdict.steady_peak:.6g}",
            reach(verdict.steady_peak, block),
        )
    if verdict.transient and verdict.kind != "overturned":
        yield "transient", f"at most {counted(verdict.transient, 'cycle')}", ""
    yield (
        "simulated",
        f"{counted(verdict.cycles, 'cycle')}, {counted(verdict.impacts, 'event')} computed",
        "",
    )


def accuracy(proof: Proof) -> str:
    """Return the largest radius of the multipliers."""
    return f"±{max((radius for _, radius in proof.multipliers or ()), default=0.0):.1e}"


def count_text(hits: int | None) -> str:
    """Return a number of impacts per period as text; None stands for infinitely many."""
    return "infinitely many, before rest or sustained contact with a brace" if hits is None else f"{hits}"


def multipliers_text(larger: complex, smaller: complex) -> str:
    """Return two Floquet multipliers as text, conjugate ones with one ±."""
    if larger.imag:
        return f"{larger.real:.6g} ± {abs(larger.imag):.6g}i"
    return f"{larger.real:.6g}, {smaller.real:.6g}"


def exponent_text(value: float, error: float | None, block: Block | None) -> tuple[str, str]:
    """Return the exponent per τ and, with a block, per second."""
    if value == -math.inf:
        return "−∞ (superstable)", ""
    text = plus_minus(value, error) if error else f"{value:.6g}"
    in_seconds = "" if block is None else f"{value * block.rate_unit:.4g} per s"
    return f"{text} per τ", in_seconds


def verdict_validity(verdict: Verdict, request: Request) -> dict[str, Any]:
    """Return the validity report as a JSON object, and the motion that it is about; empty without a block."""
    block = request.block
    if block is None:
        return {}
    over, motion = validity_motion(verdict)
    return {
        "peak_top_displacement_m": float(block.top_displacement(verdict.peak)),
        "judged": over,
        "validity": validity_record(motion, block),
    }


CLASSIFY = Report(verdict_text, more=verdict_validity)


# Lyapunov exponents.


def exponents_text(spectrum: LyapunovSpectrum, request: Request) -> Text:
    """Return the exponents."""
    block = request.block
    rows = [*input_rows(spectrum, block), *exponent_rows(spectrum, block)]
    return Text(str(spectrum), rows, angle_warning(spectrum.start.angle, block))


def exponent_rows(spectrum: LyapunovSpectrum, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the result."""
    if not spectrum.superstable:
        values, errors = spectrum.per_cycle
        for number, (value, error) in enumerate(zip(values, errors, strict=True)):
            yield f"λ{'₁₂'[number]} per cycle", plus_minus(value, error), rate(spectrum, number, block)
    dimension = dimension_of(spectrum)
    if dimension is not None:
        yield "Kaplan–Yorke dimension of the section", plus_minus(*dimension), ""
    yield "averaged over", f"{counted(spectrum.cycles, 'cycle')} after {spectrum.transient:,}", ""
    yield "impacts in this time", f"{spectrum.impacts:,}", ""
    if spectrum.system.braces is not None:
        yield "brace impacts in this time", f"{spectrum.brace_hits:,}", ""


def rate(spectrum: LyapunovSpectrum, number: int, block: Block | None) -> str:
    """Return an exponent with its error per second; an empty text without a block."""
    if block is None:
        return ""
    return f"{plus_minus(*(float(part[number]) for part in per_second(spectrum, block)))} per s"


def per_second(spectrum: LyapunovSpectrum, block: Block) -> tuple[np.ndarray, np.ndarray]:
    """Return the exponents and their errors per second, each of shape (2,)."""
    return spectrum.values * block.rate_unit, spectrum.errors * block.rate_unit


LYAPUNOV = Report(exponents_text, table="cycles_direction")


# Symmetric modes.


@frozen
class Modes(Result):
    """Symmetric (1, n) modes of a system, and the amplitudes that bound them."""

    system: System
    n: int
    modes: list[Mode]
    amplitudes: dict[str, float]

    def _data(self) -> xr.Dataset:
        import xarray as xr

        modes = self.modes

        columns = {
            "velocity": ([each.velocity for each in modes], "speed after the impact"),
            "phase": ([each.phase for each in modes], "forcing phase at the impact", "rad"),
            "trace": ([each.trace for each in modes], "trace of the half-cycle map"),
            **multiplier_columns(np.array([each.multipliers for each in modes], complex).reshape(-1, 2)),
            "peak": (nan_if_none(each.peak for each in modes), "largest angle"),
            "stability": (np.array([str(each.stability) for each in modes], str), "stability"),
            "admissible": (
                np.array([each.admissible for each in modes], bool),
                "whether the mode is a motion",
            ),
        }
        names = {"mode": (np.array(NAMES[: len(modes)], str), "the faster or the slower mode")}
        attributes = described("Symmetric modes") | quantities(self.system) | {"n": self.n}
        attributes |= {f"{name}_amplitude": each for name, each in self.amplitudes.items()}
        return xr.Dataset(along("mode", columns), along("mode", names), attributes)

    def __str__(self) -> str:
        name, amplitude, begins = (
            f"symmetric (1, {self.n}) mode",
            self.amplitude,
            self.amplitudes["existence"],
        )
        count = len(self.modes)
        if count == 0 and amplitude == 0.0:
            return f"no {name} at A = 0: without forcing the phase is not determined"
        if count == 0:
            below = f"A = {amplitude:.6g} lies {begins - amplitude:.3g} below A_E = {begins:.6g}"
            return f"no {name}: {below}, the lowest amplitude with such modes"
        real = [mode for mode in self.modes if mode.admissible]
        word = "neutral" if self.system.restitution == 1.0 else "stable"
        steady = [mode for mode in real if mode.stability == word]
        return f"{counted(count, name)}: {len(real)} admissible, {len(steady)} of these {word}"

    @property
    def amplitude(self) -> float:
        """Amplitude A of the base acceleration."""
        return self.system.harmonic.amplitude


LABELS = {
    "existence": "modes exist from A_E",
    "symmetry_breaking": "stable up to A_SB",
    "melnikov": "Melnikov amplitude A_M",
    "heteroclinic": "exact tangency A*",
}


def find(system: System, n: int) -> Modes:
    """Return the modes and amplitudes of a system in closed form; raises as in `theory`."""
    from rocking import theory

    forcing, e = system.harmonic, system.restitution
    modes = theory.symmetric_modes(forcing.amplitude, forcing.period, e, n)
    values = {
        "existence": theory.existence_amplitude(forcing.period, e, n),
        "symmetry_breaking": theory.symmetry_breaking_amplitude(forcing.period, e, n),
        "melnikov": theory.melnikov_amplitude(forcing.period, e),
        "heteroclinic": theory.heteroclinic_amplitude(forcing.period, e),
    }
    return Modes(system, int(n), modes, values)


NAMES = ("faster", "slower")


def modes_text(modes: Modes, request: Request) -> Text:
    """Return the modes, one column for each."""
    block = request.block
    rows = [*system_rows(modes.system, block), *bounds(modes, block)]
    lines = ["", *aligned(list(zip(*modes_columns(modes.modes, block), strict=True)))] if modes.modes else []
    return Text(str(modes), rows, [*lines, *warning_lines(modes_warnings(modes, block))])


def modes_warnings(modes: Modes, block: Block | None) -> list[str]:
    """Return the warnings about the block."""
    return block_warnings(block, modes.amplitude, modes.system.restitution)


def modes_figure(plot: Any, modes: Modes, request: Request) -> Any:
    """Return the plot of the modes over the amplitude: velocity and phase."""
    forcing = modes.system.periodic
    figure, axes = plot.panels(rows=2, height=2.9)
    for ax, quantity in zip(axes, ("velocity", "phase"), strict=True):
        plot.modes(
            forcing.period,
            modes.system.restitution,
            modes.n,
            ax,
            request.block,
            quantity=quantity,
            amplitude=forcing.amplitude,
        )
    axes[0].get_legend().remove()  # it is that of the other panel, too
    return figure


def bounds(modes: Modes, block: Block | None) -> Iterator[tuple[str, str, str]]:
    """Yield the rows of the amplitudes that bound the modes, and of the two thresholds for intersecting manifolds."""
    for name, label in LABELS.items():
        value = modes.amplitudes[name]
        yield label, f"A = {value:.6g}", in_si("amplitude", value, block)


def modes_columns(modes: list[Mode], block: Block | None) -> Iterator[tuple[str, ...]]:
    """Yield a column of names, then one column per mode."""
    yield (
        "mode",
        "speed V after impact",
        "phase φ at impact",
        "trace of the half-cycle map",
        f"Floquet multipliers over {counted(modes[0].n, 'cycle')}",
        "",
        "largest |Θ|",
        "stability",
        "admissible",
    )
    for name, mode in zip(NAMES, modes, strict=False):
        yield (
            name,
            f"{mode.velocity:.6g}{velocity_in_si(mode.velocity, block)}",
            f"{mode.phase:.6g} rad",
            f"{mode.trace:.6g}",
            *(complex_text(value) for value in mode.multipliers),
            "–" if mode.peak is None else f"{mode.peak:.6g}{peak_text(mode.peak, block)}",
            mode.stability,
            "yes" if mode.admissible else "no, passes through Θ = 0",
        )


def complex_text(value: complex) -> str:
    """Return a complex number as text."""
    return f"{value.real:.6g}" if value.imag == 0.0 else f"{value.real:.6g} {value.imag:+.6g}i"


def velocity_in_si(velocity: float, block: Block | None) -> str:
    """Return a velocity in SI, to follow the normalised one."""
    return "" if block is None else f" = {math.degrees(block.radians_per_second(velocity)):.4g}°/s"


def peak_text(angle: float, block: Block | None) -> str:
    """Return a largest angle in SI, to follow the normalised one."""
    return "" if block is None else f" = {reach(angle, block)}"


MODES = Report(
    modes_text,
    figure=modes_figure,
    warnings=lambda modes, request: modes_warnings(modes, request.block),
)
