"""What a motion can be written to: checked before it is run, written whole or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.option_names import YourInput, option
from rocking.cli.output import files
from rocking.cli.output.files import PICTURES, SUFFIXES, check_files, write_dataset

if TYPE_CHECKING:
    from rocking.model import Block, State, System, Verdict
    from rocking.motion import Motion

FILMS = (".gif", ".mp4")
ROWS_AT_ONCE = 100_000
MAX_CYCLES_KEPT = 100_000
"""Of a longer run only the counters, the peak and the end are kept."""


def run(system: System, start: State, cycles: int, wanted: tuple[str, ...]) -> Motion:
    """The motion with all its events, so that what is told of it is the same whatever files are `wanted`.

    Without them where there are too many: too many cycles, or too many events if no file needs them.
    """
    from rocking.model import TooManyEvents
    from rocking.motion import simulate as march

    if not cycles <= MAX_CYCLES_KEPT:
        counted = march(system, start, cycles=cycles, record="none")
        if counted.cycles > MAX_CYCLES_KEPT:
            return counted
        cycles = counted.cycles  # it overturned long before
    try:
        return march(system, start, cycles=cycles)
    except TooManyEvents as error:
        if wanted:
            names = ", ".join(map(option, wanted))
            raise YourInput(f"too many events for {names}: run fewer cycles, or leave {names} out") from error
        return march(system, start, cycles=cycles, record="none")


def check(cycles: float, **paths: Path | None) -> dict[str, Path]:
    """The outputs asked for; `YourInput` for one that cannot be written, or for more cycles than are kept for it."""
    asked = check_files(paths, SUFFIXES | {"plot": PICTURES + FILMS})
    if asked and cycles > MAX_CYCLES_KEPT:
        wanted = ", ".join(map(option, asked))
        raise YourInput(f"--cycles must be at most {MAX_CYCLES_KEPT} with {wanted}; got {cycles}")
    return asked


def check_picture(path: Path | None) -> None:
    """`YourInput` for a picture that cannot be written."""
    check_files({"plot": path})


def write_verdict(verdict: Verdict, block: Block | None, path: Path) -> None:
    """The response and what it is."""
    from rocking import plot

    plot.save(plot.verdict(verdict, block), path)


def write_modes(system: System, n: int, block: Block | None, path: Path) -> None:
    """The modes over the amplitude."""
    from rocking import plot

    forcing = system.forcing
    figure, axes = plot.panels(rows=2, height=2.9)
    for ax, quantity in zip(axes, ("velocity", "phase"), strict=True):
        plot.modes(forcing.period, system.restitution, n, ax, quantity, forcing.amplitude, block)
    plot.save(figure, path)


def write_plot(motion: Motion, block: Block | None, path: Path) -> None:
    """The motion at a glance, or the block as a film, as the suffix says."""
    from rocking import plot

    if path.suffix.lower() in FILMS:
        plot.animation(motion, path, block)
    else:
        plot.save(plot.overview(motion, block), path)


def write_csv(motion: Motion, block: Block | None, path: Path) -> None:
    """A hundred rows a cycle, or a motion that ends sooner, normalised, then in SI if there is a block; the header names the units."""
    files.write_csv(tables(motion, block), path)


def tables(motion: Motion, block: Block | None) -> Iterator[dict[str, Any]]:
    """Columns by their heading, so many rows at once that a long motion needs no more memory than a short one."""
    import numpy as np

    from rocking.motion import end_shown, sample_step

    step, end = sample_step(motion), end_shown(motion)
    count = 1 + int(end / step * (1 + 1e-12))
    for first in range(0, count, ROWS_AT_ONCE):
        time = np.minimum(np.arange(first, min(first + ROWS_AT_ONCE, count)) * step, end)
        angle, velocity = motion.at(time)
        table = files.columns({"time": time, "angle": angle, "velocity": velocity}, block)
        if block is not None:
            table["top_displacement [m]"] = block.top_displacement(angle)
        yield table


def write_netcdf(motion: Motion, block: Block | None, path: Path) -> None:
    """The motion's dataset, with its units and parameters."""
    write_dataset(motion.to_xarray(block=block), path)


WRITERS: dict[str, Callable[[Motion, Block | None, Path], None]] = {
    "plot": write_plot,
    "csv": write_csv,
    "netcdf": write_netcdf,
}
