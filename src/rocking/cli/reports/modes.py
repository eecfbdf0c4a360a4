"""Report of the symmetric modes of a system, as text, JSON and CSV."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from attrs import frozen

from rocking.cli.output import motion_files
from rocking.cli.output.console import aligned, print_json, print_table
from rocking.cli.output.files import columns, write_csv
from rocking.cli.reports.motion import asked_of, in_si, physical_of, reach
from rocking.cli.reports.orbits import multiplier_columns
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import Block
from rocking.model.orbit import Mode
from rocking.model.system import System
from rocking.model.text import counted


@frozen
class Answer:
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
        found = [mode for mode in real if mode.stability == word]
        return f"{counted(count, name)}: {len(real)} admissible, {len(found)} of these {word}"

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


def find(system: System, n: int) -> Answer:
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
    return Answer(system, int(n), modes, values)


NAMES = ("faster", "slower")


def write(answer: Answer, block: Block | None, files: Mapping[str, Path]) -> None:
    """Write the plot of the modes over the amplitude, and one row per mode as CSV."""
    if "plot" in files:
        motion_files.write_modes(answer.system, answer.n, block, files["plot"])
    if "csv" in files:
        write_csv([_columns(answer.modes, block)], files["csv"])


def _columns(modes: Sequence[Mode], block: Block | None) -> dict[str, Any]:
    """Return the modes as columns by heading, with a block also in SI; the peak of an inadmissible mode is NaN."""
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
    return columns(values, block)


def show(answer: Answer, block: Block | None, files: Sequence[Path], *, as_json: bool) -> None:
    """Print the modes on stdout, and the paths of the files."""
    if as_json:
        print_json(record(answer, block, files))
        return
    rows = [*asked_of(answer.system, block), *bounds(answer, block)]
    columns = ["", *aligned(list(zip(*table(answer.modes, block), strict=True)))] if answer.modes else []
    more = [*columns, *warned(warnings(block, answer.amplitude, answer.system.restitution))]
    print_table(str(answer), rows, files, more)


def bounds(answer: Answer, block: Block | None) -> Iterator[tuple[str, str, str]]:
    """Yield the rows of the amplitudes that bound the modes, and of the two thresholds for intersecting manifolds."""
    for name, label in LABELS.items():
        value = answer.amplitudes[name]
        yield label, f"A = {value:.6g}", in_si("amplitude", value, block)


def table(modes: list[Mode], block: Block | None) -> Iterator[tuple[str, ...]]:
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
            f"{mode.velocity:.6g}{_degrees_per_second(mode.velocity, block)}",
            f"{mode.phase:.6g} rad",
            f"{mode.trace:.6g}",
            *(_complex(value) for value in mode.multipliers),
            "–" if mode.peak is None else f"{mode.peak:.6g}{_reach(mode.peak, block)}",
            mode.stability,
            "yes" if mode.admissible else "no, passes through Θ = 0",
        )


def record(answer: Answer, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """Return the modes as a JSON object; multipliers are pairs [real, imaginary], infinite numbers null."""
    forcing = answer.system.harmonic
    result: dict[str, Any] = {
        "amplitude": forcing.amplitude,
        "period": forcing.period,
        "frequency": forcing.frequency,
        "restitution": answer.system.restitution,
        "n": answer.n,
        **{f"{name}_amplitude": value for name, value in answer.amplitudes.items()},
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
            for mode in answer.modes
        ],
        "files": [str(path) for path in files],
    }
    if block is None:
        return result
    found = warnings(block, answer.amplitude, answer.system.restitution)
    return result | {"block": physical_of(answer.system, block), "warnings": found}


def _complex(value: complex) -> str:
    return f"{value.real:.6g}" if value.imag == 0.0 else f"{value.real:.6g} {value.imag:+.6g}i"


def _degrees_per_second(velocity: float, block: Block | None) -> str:
    return "" if block is None else f" = {math.degrees(block.radians_per_second(velocity)):.4g}°/s"


def _reach(angle: float, block: Block | None) -> str:
    return "" if block is None else f" = {reach(angle, block)}"
