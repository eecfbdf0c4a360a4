"""What a motion can be written to: checked before it is run, written whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from rocking.cli.options import YourInput, option
from rocking.model.files import check_writable, replacing

if TYPE_CHECKING:
    from rocking.model import Block
    from rocking.motion import Motion

PICTURES = (".png", ".svg", ".pdf")
FILMS = (".gif", ".mp4")
SUFFIXES = {"plot": PICTURES + FILMS, "csv": (".csv",), "netcdf": (".nc", ".nc4", ".netcdf")}
CYCLES_SHOWN = 30


def check(**paths: Path | None) -> dict[str, Path]:
    """The outputs asked for; `YourInput` for one that cannot be written."""
    asked = {name: path for name, path in paths.items() if path is not None}
    for name, path in asked.items():
        try:
            check_writable(option(name), path, SUFFIXES[name])
        except (ValueError, OSError) as error:
            raise YourInput(str(error)) from error
    return asked


def write_plot(motion: Motion, block: Block | None, path: Path) -> None:
    """Time history and phase portrait side by side, or the block as a film, as the suffix says.

    A long motion that stays bounded is shown by its last cycles; whole, it would be a band of ink.
    """
    from rocking import plot

    if path.suffix.lower() in FILMS:
        plot.animation(motion, path, block)
        return
    long = motion.outcome == "bounded" and motion.cycles > CYCLES_SHOWN
    cycles = (motion.cycles - CYCLES_SHOWN, motion.cycles) if long else None
    figure, (left, right) = plot.panels(columns=2, height=2.8, ratios=(3, 2))
    plot.time_history(motion, left, block, cycles)
    plot.phase_portrait(motion, right, block, cycles)
    plot.save(figure, path)


def write_csv(motion: Motion, block: Block | None, path: Path) -> None:
    """Even steps, one column a quantity, its unit in the header."""
    import csv

    table = motion.to_xarray(block=block).reset_coords()
    columns = ["time", *(name for name in table.data_vars if table[name].dims == ("time",))]
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(f"{name} [{table[name].attrs['units']}]" for name in columns)
        writer.writerows(zip(*(table[name].values.tolist() for name in columns), strict=True))


def write_netcdf(motion: Motion, block: Block | None, path: Path) -> None:
    """The motion's dataset, with its units and parameters."""
    with replacing(path) as temporary:
        motion.to_xarray(block=block).to_netcdf(temporary, engine="h5netcdf")


WRITERS: dict[str, Callable[[Motion, Block | None, Path], None]] = {
    "plot": write_plot,
    "csv": write_csv,
    "netcdf": write_netcdf,
}
