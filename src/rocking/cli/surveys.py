"""What the commands of surveys share: how they are carried out, and what they write."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.files import check_files, with_block, write_dataset
from rocking.cli.options import ARGUMENTS as SYSTEM_ARGUMENTS
from rocking.cli.options import as_typed, your_input

if TYPE_CHECKING:
    from rocking.model import BasinMap, Block, OverturningCurve, Share

OWN = ("samples", "seed", "boundary_runs", "phases", "store", "repair", "brace_angle", "brace_restitution")
ARGUMENTS = SYSTEM_ARGUMENTS | {name: name for name in OWN}
FILES = ("plot", "netcdf")
MOST_ROWS = 20


def carried_out(survey: Callable[..., Any], arguments: Mapping[str, Any]) -> Any:
    """What a survey finds, with a bar where somebody watches; interrupted, it says how to go on."""
    with your_input(ARGUMENTS):
        try:
            return survey(**arguments, progress=sys.stderr.isatty())
        except KeyboardInterrupt as error:
            for note in getattr(error, "__notes__", ()):
                print(f"rocking: {as_typed(note, ARGUMENTS)}", file=sys.stderr)
            raise


def files_of(asked: Mapping[str, Any]) -> dict[str, Path]:
    """The files asked for; refused where they cannot be written."""
    return check_files({name: asked.get(name) for name in FILES})


def write(
    found: BasinMap | OverturningCurve, picture: str, files: Mapping[str, Path], block: Block | None
) -> None:
    """Write a picture and the dataset, with SI axes if there is a block."""
    if "plot" in files:
        from rocking import plot

        plot.save(getattr(plot, picture)(found, block=block), files["plot"])
    if "netcdf" in files:
        write_dataset(with_block(found.dataset, block), files["netcdf"])


def written(asked: Mapping[str, Any], files: Mapping[str, Path]) -> list[Path]:
    """Where all that was found is."""
    return [*([asked["store"]] if "store" in asked else []), *files.values()]


def share_record(share: Share) -> dict[str, Any]:
    """A share with its interval."""
    return {name: getattr(share, name) for name in ("value", "low", "high", "count", "of", "unknown")}
