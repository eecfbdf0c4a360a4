"""Output files of a motion: checked before the simulation, written completely or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.option_names import YourInput, option
from rocking.cli.output import files
from rocking.cli.output.files import PICTURES, SUFFIXES, check_files, write_dataset

if TYPE_CHECKING:
    from rocking.model.block import Block
    from rocking.model.system import State, System
    from rocking.model.verdict import Verdict
    from rocking.motion.motion import Motion

FILMS = (".gif", ".mp4")
ROWS_AT_ONCE = 100_000
MAX_CYCLES_KEPT = 100_000
"""Longest run whose events are kept; a longer one keeps only the counters, the peak and the final state."""


def run(system: System, start: State, cycles: int | None, wanted: tuple[str, ...]) -> Motion:
    """Simulate a motion with all its events, so that the summary does not depend on the files `wanted`.

    Events are dropped for too many cycles, and for too many events if no file needs them. A base motion of finite length
    has no cycles: None.
    """
    from rocking.model.validation import TooManyEvents
    from rocking.motion.simulate import simulate as march

    if cycles is not None and not cycles <= MAX_CYCLES_KEPT:
        counted = march(system, start, cycles=cycles, record="none")
        if counted.cycles > MAX_CYCLES_KEPT:
            return counted
        cycles = counted.cycles  # the block overturned early
    try:
        return march(system, start, cycles=cycles)
    except TooManyEvents as error:
        if wanted:
            names = ", ".join(map(option, wanted))
            shorter = "" if cycles is None else "reduce --cycles, or "
            raise YourInput(f"too many events for {names}: {shorter}omit {names}") from error
        return march(system, start, cycles=cycles, record="none")


def check(cycles: float, **paths: Path | None) -> dict[str, Path]:
    """Return the requested files; YourInput if a file cannot be written or needs the events of too many cycles."""
    asked = check_files(paths, SUFFIXES | {"plot": PICTURES + FILMS})
    if asked and cycles > MAX_CYCLES_KEPT:
        wanted = ", ".join(map(option, asked))
        raise YourInput(f"--cycles must be at most {MAX_CYCLES_KEPT} with {wanted}; got {cycles}")
    return asked


def check_of_record(**paths: Path | None) -> dict[str, Path]:
    """Return the requested files; YourInput if a file cannot be written."""
    return check_files(paths, SUFFIXES | {"animate": FILMS})


def check_picture(path: Path | None) -> None:
    """Raise YourInput for a plot that cannot be written."""
    check_files({"plot": path})


def write_verdict(verdict: Verdict, block: Block | None, path: Path) -> None:
    """Write the plot of a response with its verdict."""
    from rocking import plot

    plot.save(plot.verdict(verdict, block), path)


def write_modes(system: System, n: int, block: Block | None, path: Path) -> None:
    """Write the plot of the modes over the amplitude."""
    from rocking import plot

    forcing = system.periodic
    figure, axes = plot.panels(rows=2, height=2.9)
    for ax, quantity in zip(axes, ("velocity", "phase"), strict=True):
        plot.modes(forcing.period, system.restitution, n, ax, quantity, forcing.amplitude, block)
    axes[0].get_legend().remove()  # it is that of the other panel, too
    plot.save(figure, path)


def write_plot(motion: Motion, block: Block | None, path: Path, heading: str = "") -> None:
    """Write the overview plot of a motion under a heading, or an animation of the block, depending on the suffix."""
    from rocking import plot

    if path.suffix.lower() in FILMS:
        plot.animation(motion, path, block)
        return
    figure = plot.overview(motion, block)
    if heading:
        figure.suptitle(heading, fontsize="small")
    plot.save(figure, path)


def write_csv(motion: Motion, block: Block | None, path: Path) -> None:
    """Write a motion as CSV with units in the header, also in SI if there is a block.

    There are 100 rows per cycle, or 100 rows of a motion that ends earlier. Under a sampled base acceleration there is a row
    per sample at least.
    """
    files.write_csv(tables(motion, block), path)


def tables(motion: Motion, block: Block | None) -> Iterator[dict[str, Any]]:
    """Yield tables (columns by heading) of limited length, so that memory does not grow with the motion."""
    import numpy as np

    from rocking.motion.motion import end_shown, sample_step

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
    """Write the dataset of a motion, with units and parameters."""
    write_dataset(motion.to_xarray(block=block), path)


WRITERS: dict[str, Callable[[Motion, Block | None, Path], None]] = {
    "plot": write_plot,
    "animate": write_plot,
    "csv": write_csv,
    "netcdf": write_netcdf,
}
