"""Report of a verdict, as text or JSON."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import attrs

from rocking.cli.option_names import as_typed, options
from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.reports import validity
from rocking.cli.reports.motion import asked, beyond, physical, question, reach
from rocking.model.block import Block
from rocking.model.proof import Proof
from rocking.model.text import counted, plus_minus
from rocking.model.verdict import Verdict

BUDGET = options("max_cycles", "max_period")


def show(verdict: Verdict, block: Block | None, file: Path | None, *, as_json: bool) -> None:
    """Print the verdict on stdout, and the path of its plot."""
    if as_json:
        print_json(record(verdict, block, file))
        return
    rows = [*asked(verdict, block), *found(verdict, block)]
    more = list(beyond(verdict.start.angle, block))
    if block is not None:
        over, motion = validity.validity_motion(verdict)
        more += [f"{over}:", *validity.lines(motion, block)]
    print_table(as_typed(str(verdict), BUDGET), rows, [] if file is None else [file], more)


def found(verdict: Verdict, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the result; quantities that do not apply are left out."""
    orbit, exponent = verdict.orbit, verdict.exponent
    if orbit is not None:
        time = orbit.period * verdict.system.periodic.period
        seconds = "" if block is None else f"{block.seconds(time):.4g} s"
        yield "period", f"{counted(orbit.period, 'cycle')}, τ = {time:.6g}", seconds
        yield "impacts per period", count_shown(orbit.impacts), ""
        if verdict.system.braces is not None:
            yield "brace impacts per period", count_shown(orbit.brace_hits), ""
        yield "Floquet multipliers", multipliers_shown(*orbit.multipliers), ""
        if orbit.proof is not None and orbit.proof.proved:
            yield "proof", f"{orbit.proof.bits} bits, multipliers to {_accuracy(orbit.proof)}", ""
    if exponent is not None:
        yield "largest Lyapunov exponent", *_exponent(exponent, verdict.exponent_error, block)
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


def record(verdict: Verdict, block: Block | None, file: Path | None) -> dict[str, Any]:
    """Return the verdict as a JSON object; multipliers are pairs [real, imaginary]."""
    orbit = verdict.orbit
    result = {
        "kind": str(verdict.kind),
        "evidence": attrs.asdict(verdict.evidence),
        **question(verdict),
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
        "files": [] if file is None else [str(file)],
    }
    if block is None:
        return result
    over, motion = validity.validity_motion(verdict)
    record = validity.record(motion, block)
    return result | {"block": physical(verdict, block), "judged": over, "validity": record}


def proof_record(proof: Proof) -> dict[str, Any]:
    """Return the proof as a JSON object; multipliers are [real, imaginary, radius]."""
    result = attrs.asdict(proof, filter=attrs.filters.exclude("system", "multipliers"))
    discs = [[value.real, value.imag, radius] for value, radius in proof.multipliers or ()]
    return result | {"multipliers": discs or None}


def _accuracy(proof: Proof) -> str:
    """Return the largest radius of the multipliers."""
    return f"±{max((radius for _, radius in proof.multipliers or ()), default=0.0):.1e}"


def count_shown(hits: int | None) -> str:
    """Return a number of impacts per period as text; None stands for infinitely many."""
    return "infinitely many, before rest or sustained contact with a brace" if hits is None else f"{hits}"


def multipliers_shown(larger: complex, smaller: complex) -> str:
    """Return two Floquet multipliers as text, conjugate ones with one ±."""
    if larger.imag:
        return f"{larger.real:.6g} ± {abs(larger.imag):.6g}i"
    return f"{larger.real:.6g}, {smaller.real:.6g}"


def _exponent(value: float, error: float | None, block: Block | None) -> tuple[str, str]:
    """Return the exponent per τ and, with a block, per second."""
    if value == -math.inf:
        return "−∞ (superstable)", ""
    shown = plus_minus(value, error) if error else f"{value:.6g}"
    physical = "" if block is None else f"{value * block.frequency_parameter:.4g} per s"
    return f"{shown} per τ", physical
