"""Run and output files shared by the commands of surveys."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.option_names import ARGUMENTS as SYSTEM_ARGUMENTS
from rocking.cli.option_names import AXIS_FORM, NORMALISED, as_typed, option, options, your_input
from rocking.cli.output.files import SUFFIXES, check_files, columns, with_block, write_result

if TYPE_CHECKING:
    from rocking.model.block import Block
    from rocking.model.share import Share
    from rocking.model.survey_results import BasinMap, OverturningCurve

OWN = (
    "samples",
    "seed",
    "boundary_runs",
    "boundary_width",
    "phases",
    "store",
    "repair",
    "brace_angle",
    "brace_restitution",
)
# On the command line an array is typed as an axis.
ARGUMENTS = SYSTEM_ARGUMENTS | options(*OWN) | {"as arrays": f"as axes, {AXIS_FORM}"}
MAX_ROWS = 20


def carried_out(
    survey: Callable[..., Any],
    arguments: Mapping[str, Any],
    block: Block | None = None,
    typed: Mapping[str, str] | None = None,
) -> Any:
    """Run a survey, with progress on stderr; an interruption prints how to resume it.

    Messages name quantities derived from a block in SI in words, because the user gave no such option. `typed` holds further
    names of arguments.
    """
    with your_input({**ARGUMENTS, **_made_of(block), **(typed or {})}):
        try:
            return survey(**arguments, progress=True)
        except KeyboardInterrupt as error:
            for note in getattr(error, "__notes__", ()):
                print(f"rocking: {as_typed(note, ARGUMENTS)}", file=sys.stderr)
            raise


def _made_of(block: Block | None) -> dict[str, str]:
    if block is None:
        return {}
    shaken = {name: f"the normalised {name}" for name in NORMALISED}
    follows = {"restitution": "restitution, which follows from the block,"}
    return shaken | follows if block.has_housner_restitution else shaken


@contextmanager
def complete(store: Path | None) -> Iterator[None]:
    """Report that the store is complete if the output after the survey is interrupted."""
    try:
        yield
    except KeyboardInterrupt:
        if store is not None:
            from rocking.model.text import shown_path

            note = f"{option('store')} {shown_path(store)} is complete; repeat the command to write the remaining files"
            print(f"rocking: {note}", file=sys.stderr)
        raise


def files_of(asked: Mapping[str, Any]) -> dict[str, Path]:
    """Return the requested files; YourInput if a file cannot be written."""
    return check_files({name: asked.get(name) for name in SUFFIXES}, folders={"store": asked.get("store")})


def write(
    found: BasinMap | OverturningCurve,
    picture: str,
    files: Mapping[str, Path],
    block: Block | None,
    tables: Callable[[], Iterable[Mapping[str, Any]]],
) -> None:
    """Write a plot, tables and the dataset; with a block, SI axes and further columns and coordinates in SI.

    `tables` returns columns by heading, normalised.
    """
    write_result(
        files,
        figure=lambda plot: getattr(plot, picture)(found, block=block),
        tables=lambda: (columns(table, block) for table in tables()),
        data=lambda: with_block(found.dataset, block),
    )


def written(asked: Mapping[str, Any], files: Mapping[str, Path]) -> list[Path]:
    """Return the paths of the store and the files."""
    return [*([asked["store"]] if "store" in asked else []), *files.values()]


def share_record(share: Share) -> dict[str, Any]:
    """Return a fraction with its interval as a JSON object."""
    return {name: getattr(share, name) for name in ("value", "low", "high", "count", "of", "unknown")}
