"""Machine code of the figures: each figure waits for its own, while the page is shown at once."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from contextlib import suppress

from rocking.explorer.view_state import ViewState
from rocking.kernels import build_processes, machine_code

POLLING = 0.1
"""Interval, s, at which a waiting figure looks for its machine code."""
SIMULATION = (
    "parameters.make_plain",
    "initial_state.begin_march.HarmonicParameters",
    "initial_state.note_start.HarmonicDrive",
    "march.march_plain.HarmonicParameters",
    "resample.sample.HarmonicParameters",
    "resample.turns.HarmonicParameters",
)
CLASSIFICATION = (*SIMULATION, "batch.classify_batch_scalar.HarmonicParameters")
BASIN = (*CLASSIFICATION, "attractor_anchor.anchor_each.HarmonicParameters")
FINITE = tuple(
    f"{name}.{kind}{what}"
    for kind in ("Sampled", "Pulse")
    for name, what in (
        ("finite_runs.run_to_end", "Parameters"),
        ("initial_state.begin_march", "Parameters"),
        ("initial_state.note_start", "Drive"),
        ("march.march_plain", "Parameters"),
        ("resample.sample", "Parameters"),
        ("resample.turns", "Parameters"),
    )
)
GROUND = {
    "map": (
        "tables.fill",
        "parameters.make_pulse_plain",
        "finite_runs.run_batch.SampledParameters",
        "finite_runs.run_pulses.PulseParameters",
    ),
    "motion": ("tables.fill", "parameters.make_pulse_plain", *FINITE),
}
"""Entry points of each figure of the page of ground motions, for the slender block."""
GROUND_ALL = sorted({name for names in GROUND.values() for name in names})
FULL_PARAMETERS = ("parameters.full_shape", "parameters.full_cosine")
LANES = ("scheduler.classify_batch_lanes",)
NEEDED = {
    "motion": SIMULATION,
    "spectrum": SIMULATION,
    "section": SIMULATION,
    "verdict": CLASSIFICATION,
    "map": CLASSIFICATION,
    "basin": BASIN,
    "diagram": (*SIMULATION, "sweep.sweep.HarmonicParameters"),
}
"""Entry points of each figure; maps of slender blocks also need those of the lanes."""
ALL = sorted({name for names in NEEDED.values() for name in names} | set(LANES))


def needed(figure: str, shown: ViewState) -> tuple[str, ...]:
    """Return the entry points of a figure of a view."""
    if shown.critical_angle is not None:
        return full(NEEDED[figure])
    return NEEDED[figure] + (LANES if figure in ("map", "basin") else ())


def full(names: Sequence[str]) -> tuple[str, ...]:
    """Return the entry points that the full block has in place of those of the slender block."""
    return FULL_PARAMETERS + tuple(
        ".".join([*name.split(".")[:2], f"Full{name.split('.')[2]}"]) if name.count(".") == 2 else name
        for name in names
    )


def needed_by_ground(figure: str, model: str) -> tuple[str, ...]:
    """Return the entry points of a figure of the page of ground motions."""
    return full(GROUND[figure]) if model == "full" else GROUND[figure]


class Compilation:
    """Compilation of what is missing, by processes that outlive this one."""

    def __init__(self) -> None:
        self._folder = machine_code.find_folder()
        if self._folder is not None and self.fraction([*ALL, *GROUND_ALL]) < 1.0:
            with suppress(OSError):  # without builders, each figure compiles what it needs
                build_processes.start_builders(self._folder, machine_code.processor_class())

    def fraction(self, names: Sequence[str]) -> float:
        """Return the fraction of the work for some entry points that is done, by measured seconds."""
        return build_processes.fraction_done(names)

    def may_start(self, names: Sequence[str]) -> bool:
        """Return whether the machine code of entry points is there, or no builder is at work on it."""
        if self._folder is None or all(map(machine_code.is_stored, names)):
            return True
        try:
            return not build_processes.are_running(self._folder)
        except OSError:
            return True

    async def ready(self, figure: str, shown: ViewState) -> None:
        """Wait for the machine code of a figure."""
        await self.stored(needed(figure, shown))

    async def stored(self, names: Sequence[str]) -> None:
        """Wait for the machine code of entry points."""
        while not self.may_start(names):
            await asyncio.sleep(POLLING)
