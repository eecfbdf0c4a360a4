"""Reports of a verdict, of Lyapunov exponents, and of the symmetric modes in closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np
from attrs import frozen

from rocking.cli.options import reworded
from rocking.cli.output import Report, Row, Text, aligned, columns, with_block
from rocking.cli.reports import (
    angle_warning,
    block_warnings,
    in_si,
    input_record,
    input_rows,
    multiplier_columns,
    peak_in_si,
    reach,
    system_in_si,
    system_rows,
    warning_lines,
    with_warnings,
)
from rocking.cli.reports_motion import validity_lines, validity_motion, validity_record
from rocking.model.block import Block
from rocking.model.orbit import Mode
from rocking.model.proof import Proof
from rocking.model.system import System
from rocking.model.text import counted, plus_minus
from rocking.model.verdict import Verdict

if TYPE_CHECKING:
    import xarray as xr

    from rocking.cli.inputs import Request
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


def verdict_record(verdict: Verdict, _: Request) -> dict[str, Any]:
    """Return the verdict as a JSON object; multipliers are pairs [real, imaginary]."""
    orbit = verdict.orbit
    return {
        "kind": str(verdict.kind),
        "evidence": attrs.asdict(verdict.evidence),
        **input_record(verdict),
        "response_period": verdict.period,
        "impacts_per_period": verdict.impacts_per_period,
        "brace_hits_per_period": verdict.brace_hits_per_period,
        "symmetric": verdict.symmetric,
        "multipliers": None if orbit is None else [[value.real, value.imag] for value in orbit.multipliers],
        "exponent": verdict.exponent,
        "exponent_error": verdict.exponent_error,
        "superstable": verdict.superstable,
        "peak": verdict.peak,
        "steady_peak": verdict.steady_peak,
        "transient": verdict.transient,
        "cycles": verdict.cycles,
        "events_computed": verdict.impacts,
        "orbit": None
        if orbit is None
        else {"phase": orbit.phase, "residual": orbit.residual} | attrs.asdict(orbit.state),
        "proof": None if orbit is None or orbit.proof is None else proof_record(orbit.proof),
    }


def verdict_in_si(verdict: Verdict, request: Request) -> dict[str, Any]:
    """Return the block, its base motion, its largest angle and the validity report as a JSON object; empty without a block."""
    block = request.block
    if block is None:
        return {}
    over, motion = validity_motion(verdict)
    entries = system_in_si(verdict.system, block) | peak_in_si(verdict, block)
    return {"block": entries, "judged": over, "validity": validity_record(motion, block)}


def proof_record(proof: Proof) -> dict[str, Any]:
    """Return the proof as a JSON object; multipliers are [real, imaginary, radius]."""
    entries = attrs.asdict(proof, filter=attrs.filters.exclude("system", "multipliers"))
    discs = [[value.real, value.imag, radius] for value, radius in proof.multipliers or ()]
    return entries | {"multipliers": discs or None}


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
    in_seconds = "" if block is None else f"{value * block.frequency_parameter:.4g} per s"
    return f"{text} per τ", in_seconds


CLASSIFY = Report(
    verdict_text,
    verdict_record,
    figure=lambda plot, verdict, request: plot.verdict(verdict, request.block),
    more=verdict_in_si,
)


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
    return spectrum.values * block.frequency_parameter, spectrum.errors * block.frequency_parameter


def dimension_of(spectrum: LyapunovSpectrum) -> tuple[float, float] | None:
    """Return the Kaplan–Yorke dimension and its error; None where there is none, or it is undecided."""
    try:
        return spectrum.kaplan_yorke
    except ValueError:
        return None


def exponent_tables(spectrum: LyapunovSpectrum, request: Request) -> Iterator[dict[str, Any]]:
    """Yield the running estimates as columns by heading; with a block also per second.

    Exponents of −∞ have one row, that of all cycles.
    """
    block = request.block
    history = final_estimate(spectrum) if spectrum.superstable else spectrum.history
    rates = {
        f"{name}_{number + 1}": history[f"{name}s"][:, number]
        for number in (0, 1)
        for name in ("value", "error")
    }
    table = {"cycles": history["cycles"]} | {f"{name} [alpha]": rate for name, rate in rates.items()}
    in_si = (
        {}
        if block is None
        else {f"{name} [1/s]": rate * block.frequency_parameter for name, rate in rates.items()}
    )
    yield table | in_si


def final_estimate(spectrum: LyapunovSpectrum) -> dict[str, np.ndarray]:
    """Return the result after all cycles as one row of running estimates."""
    return {
        "cycles": np.array([spectrum.cycles]),
        "values": spectrum.values[np.newaxis],
        "errors": spectrum.errors[np.newaxis],
    }


def exponent_data(spectrum: LyapunovSpectrum, request: Request) -> xr.Dataset:
    """Return the dataset; with a block, each variable also per second."""
    block, data = request.block, spectrum.to_xarray()
    if block is not None:
        rates = {
            f"{name}_per_s": (
                each.dims,
                each.values * block.frequency_parameter,
                {"long_name": each.attrs["long_name"].replace("per tau", "per second"), "units": "s-1"},
            )
            for name, each in data.data_vars.items()
        }
        data = data.assign(rates)
    return with_block(data, block)


def exponent_record(spectrum: LyapunovSpectrum, _: Request) -> dict[str, Any]:
    """Return the exponents as a JSON object; an exponent of −∞ is null."""
    return {
        **input_record(spectrum),
        "exponents": spectrum.values.tolist(),
        "errors": [float(error) for error in spectrum.errors],
        "bounded": spectrum.bounded,
        "superstable": spectrum.superstable,
        "kaplan_yorke": dimension_of(spectrum),
        "cycles": spectrum.cycles,
        "transient": spectrum.transient,
        "impacts": spectrum.impacts,
        "brace_hits": spectrum.brace_hits,
    }


def exponents_in_si(spectrum: LyapunovSpectrum, request: Request) -> dict[str, Any]:
    """Return the block and the exponents per second as a JSON object; empty without a block."""
    block = request.block
    if block is None:
        return {}
    values, errors = per_second(spectrum, block)
    rates = {"exponents_per_s": values.tolist(), "errors_per_s": errors.tolist()}
    return {"block": system_in_si(spectrum.system, block) | rates}


LYAPUNOV = Report(
    exponents_text,
    exponent_record,
    figure=lambda plot, spectrum, request: plot.convergence(spectrum, block=request.block),
    tables=exponent_tables,
    data=exponent_data,
    more=exponents_in_si,
)


# Symmetric modes.


@frozen
class Modes:
    """Symmetric (1, n) modes of a system, and the amplitudes that bound them."""

    system: System
    n: int
    modes: list[Mode]
    amplitudes: dict[str, float]

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
            forcing.period, modes.system.restitution, modes.n, ax, quantity, forcing.amplitude, request.block
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


def modes_tables(result: Modes, request: Request) -> Iterator[dict[str, Any]]:
    """Yield the modes as columns by heading, with a block also in SI; the peak of an inadmissible mode is NaN."""
    modes = result.modes
    multipliers = np.array([mode.multipliers for mode in modes], complex).reshape(-1, 2)
    values = {
        "mode": np.array(NAMES[: len(modes)]),
        "velocity": np.array([mode.velocity for mode in modes]),
        "phase": np.array([mode.phase for mode in modes]),
        "trace": np.array([mode.trace for mode in modes]),
        **multiplier_columns(multipliers),
        "peak": np.array([math.nan if mode.peak is None else mode.peak for mode in modes]),
        "stability": np.array([str(mode.stability) for mode in modes]),
        "admissible": np.array([mode.admissible for mode in modes]),
    }
    yield columns(values, request.block)


def modes_record(modes: Modes, _: Request) -> dict[str, Any]:
    """Return the modes as a JSON object; multipliers are pairs [real, imaginary], infinite numbers null."""
    forcing = modes.system.harmonic
    return {
        "amplitude": forcing.amplitude,
        "period": forcing.period,
        "frequency": forcing.frequency,
        "restitution": modes.system.restitution,
        "n": modes.n,
        **{f"{name}_amplitude": value for name, value in modes.amplitudes.items()},
        "modes": [
            {
                "velocity": mode.velocity,
                "phase": mode.phase,
                "trace": mode.trace,
                "multipliers": [[value.real, value.imag] for value in mode.multipliers],
                "stability": mode.stability,
                "stable": mode.stable,
                "admissible": mode.admissible,
                "peak": mode.peak,
            }
            for mode in modes.modes
        ],
    }


def modes_in_si(modes: Modes, request: Request) -> dict[str, Any]:
    """Return the block and the warnings as a JSON object; empty without a block."""
    block = request.block
    return (
        {}
        if block is None
        else with_warnings(system_in_si(modes.system, block), modes_warnings(modes, block))
    )


MODES = Report(modes_text, modes_record, figure=modes_figure, tables=modes_tables, more=modes_in_si)
