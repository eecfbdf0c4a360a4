"""Record files on the command line: the argument SOURCE, the options of reading, and the set of records that they give."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from inspect import Parameter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input.axis import axis_option
from rocking.cli.input.record_request import as_options, record_path
from rocking.cli.input.study_file import Check, Study, model, numbers
from rocking.cli.option_names import YourInput, option, options, your_input

if TYPE_CHECKING:
    from rocking.model.record_set import RecordSet

READING = ("units", "step", "baseline")
ARGUMENTS = options(*READING) | {"source": "SOURCE"}

Sources = Annotated[
    list[Path],
    typer.Argument(
        metavar="SOURCE",
        parser=record_path,
        help="Record files, a folder of them, or a table (CSV) with a column `file`. `example` is the record that comes with "
        "the package.",
    ),
]
Channel = Annotated[int, ask.number_option("--channel", "Channel of the file, counted from 1.")]
InertiaRatio = Annotated[
    ask.Number,
    ask.number_option(
        "--inertia-ratio",
        "Io/(MR²), the normalised moment of inertia about a corner. Default: 4/3, a uniform rectangle.",
    ),
]
Polarity = Annotated[
    ask.Number,
    ask.number_option(
        "--polarity",
        "1, or -1 for the opposite direction of the records: no effect on a block at rest, which is symmetric. Default: 1.",
    ),
]
LEVELS = {
    "scale": "factor of each record",
    "pga": "peak ground acceleration, m/s²",
    "pga_g": "peak ground acceleration, in units of g",
    "pgv": "peak ground velocity, m/s",
    "pgd": "peak ground displacement, m",
    "arias": "Arias intensity, m/s",
    "pga_ratio": "peak ground acceleration over g tan θcr",
    "pgv_ratio": "α times the peak ground velocity, over g tan θcr",
}
"""Options whose value is the axis of the levels, and the intensity measure of each."""
Units = Annotated[
    str | None,
    typer.Option(
        "--units",
        metavar="UNIT",
        help="Unit of the samples, if the file does not state it: m/s2, cm/s2, g, ….",
    ),
]
Step = Annotated[
    ask.Number, ask.number_option("--step", "Time between two samples, s, if the file does not state it.")
]
Baseline = Annotated[
    str | None,
    typer.Option(
        "--baseline",
        metavar="KIND",
        help="Polynomial that is subtracted from the acceleration: none, mean, linear or quadratic. Default: none.",
    ),
]


def with_levels(declare: Callable[[str, str], Any] = axis_option) -> Callable[[ask.Command], ask.Command]:
    """Return a decorator that adds the options of `LEVELS` before those of a command; ``declare`` makes an option."""
    kinds = {name: declare(option(name), f"Levels: {what}.") for name, what in LEVELS.items()}
    return ask.with_parameters(
        first=[
            Parameter(name, Parameter.KEYWORD_ONLY, default=None, annotation=Annotated[Any, kind])
            for name, kind in kinds.items()
        ]
    )


def with_files(plot: str | None, csv: str, *, store: bool = False) -> Callable[[ask.Command], ask.Command]:
    """Return a decorator that adds the options of reading and of files after those of a command.

    `plot` and `csv` are the help of the options for these files; without ``plot`` there is no figure. With ``store``, the command
    also has the options of a store.
    """
    options_of_files: dict[str, Any] = {
        "model": ask.Model,
        "units": Units,
        "step": Step,
        "baseline": Baseline,
        "study": Study,
        **({"store": ask.Store, "repair": ask.Repair} if store else {}),
        **(
            {"plot": Annotated[Path | None, ask.file_option("--plot", f"{plot} (.png .svg .pdf).")]}
            if plot
            else {}
        ),
        "csv": Annotated[Path | None, ask.file_option("--csv", f"{csv} (.csv).")],
        "netcdf": ask.SurveyNetcdf,
        "json": ask.Json,
    }
    switches = ("repair", "json")
    return ask.with_parameters(
        last=[
            Parameter(
                name, Parameter.KEYWORD_ONLY, default=False if name in switches else None, annotation=kind
            )
            for name, kind in options_of_files.items()
        ]
    )


def checks() -> dict[str, Check]:
    """Return the checks of the entries of a study file that state the model, and how records are read."""
    from rocking.model.validation import instance

    words = {name: partial(instance, name, kind=str) for name in ("units", "baseline")}
    return words | numbers("step") | {"model": model}


def record_set(
    sources: Sequence[Path], *, units: str | None = None, step: float | None = None, baseline: str = "none"
) -> tuple[RecordSet, list[str]]:
    """Return the records of the command line, and the warnings of the reader; YourInput if one cannot be read."""
    from rocking.records.record_set import read_record_set
    from rocking.records.text_file import RecordError

    given = sources[0] if len(sources) == 1 else list(sources)
    with your_input(ARGUMENTS), warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        try:
            records = read_record_set(given, units=units, step=step, baseline=baseline)
        except RecordError as error:
            raise YourInput(as_options(str(error))) from error
    return records, [str(doubt.message) for doubt in doubts]


def drift_doubts(records: RecordSet) -> list[str]:
    """Return a warning of the records whose PGV and PGD are those of a drift; none without such a record."""
    from rocking.model.text import listed

    doubts = {name: motion.drift_doubt for name, motion in zip(records.names, records, strict=True)}
    found = {name: as_options(doubt) for name, doubt in doubts.items() if doubt}
    if not found:
        return []
    first, *others = found
    more = f" (and {len(others)} of the other records: {listed(others)})" if others else ""
    return [f"{first}{more}: {found[first]}"]


def files_of(places: Mapping[str, Path], records: RecordSet) -> dict[str, Path]:
    """Return the output files among the `places`; YourInput if one cannot be written or would overwrite a record.

    Records are also the files that a folder or a table names, and copies of them.
    """
    from rocking.cli.output.survey_run import files_of as survey_files
    from rocking.model.text import shown_path

    files = survey_files(places)
    contents = {motion.file.sha256 for motion in records if motion.file is not None}
    for name, path in files.items():
        if _digest(path) in contents:
            raise YourInput(f"{option(name)} must not overwrite a record; got {shown_path(path)}")
    return files


def _digest(path: Path) -> str | None:
    """Return the SHA-256 digest of a file; None if there is none that can be read."""
    with suppress(OSError), path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
    return None
