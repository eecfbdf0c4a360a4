"""Report of Lyapunov exponents, as text, JSON, CSV and netCDF."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import with_block, write_result
from rocking.cli.reports.motion import asked, beyond, physical_of, question
from rocking.model.block import Block
from rocking.model.text import counted, plus_minus

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr

    from rocking.response.lyapunov import LyapunovSpectrum


def write(spectrum: LyapunovSpectrum, block: Block | None, files: Mapping[str, Path]) -> None:
    """Write the plot and the table of the running estimates, and the dataset."""
    write_result(
        files,
        figure=lambda plot: plot.convergence(spectrum, block=block),
        tables=lambda: [_table(spectrum, block)],
        data=lambda: _dataset(spectrum, block),
    )


def _table(spectrum: LyapunovSpectrum, block: Block | None) -> dict[str, Any]:
    """Return the running estimates as columns by heading; with a block also per second.

    Exponents of −∞ have one row, that of all cycles.
    """
    history = _final(spectrum) if spectrum.superstable else spectrum.history
    rates = {
        f"{name}_{number + 1}": history[f"{name}s"][:, number]
        for number in (0, 1)
        for name in ("value", "error")
    }
    table = {"cycles": history["cycles"]} | {f"{name} [alpha]": rate for name, rate in rates.items()}
    if block is None:
        return table
    return table | {f"{name} [1/s]": rate * block.frequency_parameter for name, rate in rates.items()}


def _final(spectrum: LyapunovSpectrum) -> dict[str, np.ndarray]:
    """Return the result after all cycles as one row of running estimates."""
    import numpy as np

    return {
        "cycles": np.array([spectrum.cycles]),
        "values": spectrum.values[np.newaxis],
        "errors": spectrum.errors[np.newaxis],
    }


def show(spectrum: LyapunovSpectrum, block: Block | None, files: Sequence[Path], *, as_json: bool) -> None:
    """Print the exponents on stdout, and the paths of the files."""
    if as_json:
        print_json(record(spectrum, block, files))
        return
    rows = [*asked(spectrum, block), *found(spectrum, block)]
    print_table(str(spectrum), rows, files, [*beyond(spectrum.start.angle, block)])


def found(spectrum: LyapunovSpectrum, block: Block | None) -> Iterator[Row]:
    """Yield the rows of the result."""
    if not spectrum.superstable:
        values, errors = spectrum.per_cycle
        for number, (value, error) in enumerate(zip(values, errors, strict=True)):
            yield f"λ{'₁₂'[number]} per cycle", plus_minus(value, error), _rate(spectrum, number, block)
    dimension = dimension_of(spectrum)
    if dimension is not None:
        yield "Kaplan–Yorke dimension of the section", plus_minus(*dimension), ""
    yield "averaged over", f"{counted(spectrum.cycles, 'cycle')} after {spectrum.transient:,}", ""
    yield "impacts in this time", f"{spectrum.impacts:,}", ""
    if spectrum.system.braces is not None:
        yield "brace impacts in this time", f"{spectrum.brace_hits:,}", ""


def _rate(spectrum: LyapunovSpectrum, number: int, block: Block | None) -> str:
    """Return an exponent with its error per second; an empty text without a block."""
    if block is None:
        return ""
    return f"{plus_minus(*(float(part[number]) for part in per_second(spectrum, block)))} per s"


def per_second(spectrum: LyapunovSpectrum, block: Block) -> tuple[np.ndarray, np.ndarray]:
    """Return the exponents and their errors per second, each of shape (2,)."""
    return spectrum.values * block.frequency_parameter, spectrum.errors * block.frequency_parameter


def _dataset(spectrum: LyapunovSpectrum, block: Block | None) -> xr.Dataset:
    """Return the dataset; with a block, each variable also per second."""
    data = spectrum.to_xarray()
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


def dimension_of(spectrum: LyapunovSpectrum) -> tuple[float, float] | None:
    """Return the Kaplan–Yorke dimension and its error; None where there is none, or it is undecided."""
    try:
        return spectrum.kaplan_yorke
    except ValueError:
        return None


def record(spectrum: LyapunovSpectrum, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """Return the exponents as a JSON object; an exponent of −∞ is null."""
    result = {
        **question(spectrum),
        "exponents": spectrum.values.tolist(),
        "errors": [float(error) for error in spectrum.errors],
        "bounded": spectrum.bounded,
        "superstable": spectrum.superstable,
        "kaplan_yorke": dimension_of(spectrum),
        "cycles": spectrum.cycles,
        "transient": spectrum.transient,
        "impacts": spectrum.impacts,
        "brace_hits": spectrum.brace_hits,
        "files": [str(file) for file in files],
    }
    if block is None:
        return result
    values, errors = per_second(spectrum, block)
    rates = {"exponents_per_s": values.tolist(), "errors_per_s": errors.tolist()}
    return result | {"block": physical_of(spectrum.system, block) | rates}
