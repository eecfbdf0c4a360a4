"""A motion: what one simulated block did, exact at any time."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import define, field

from rocking.kernels import events as kernel_events
from rocking.kernels import sample
from rocking.model import Block, Outcome, Overturning, State, System, pictures, reals, refusal, within
from rocking.motion.run import parameters, section_of

if TYPE_CHECKING:
    import xarray as xr

    from rocking.motion.validity import Validity

EVENT = np.dtype(
    [
        ("time", "f8"),
        ("cycle", "i8"),
        ("phase", "f8"),
        ("angle", "f8"),
        ("before", "f8"),
        ("after", "f8"),
        ("kind", "U8"),
    ]
)
TURN = np.dtype([("time", "f8"), ("angle", "f8")])
KINDS = np.array(["impact", "brace", "rest", "lift-off", "lean", "leave"])
LARGEST_PHASE = 1000.0


@define(eq=False, slots=False)
class Motion:
    """What one simulated block did; made by `simulate`.

    Attributes
    ----------
    system, start : System, State
        What was simulated.
    record : str
        "all", "section" or "none": what was kept.
    cycles : int
        Whole forcing cycles run: those asked for, fewer only if the block overturned.
    outcome : Outcome
        OVERTURNED or AT_REST where that is proved, else BOUNDED, which says no more than that neither was.
    overturning : Overturning or None
        When no return was proved.
    impacts, brace_hits : int
        Impacts at Θ = 0 and hits on the braces.
    peak : float
        Largest |Θ| of the run; of a block that overturns, until the proof.
    final : State
        Θ, Θ' at the end, just after any event there; of an overturned block at the moment of the proof.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> motion = rk.simulate(system, cycles=50)
    >>> print(motion)
    bounded over 50 cycles: 99 impacts, peak |Θ| 0.1875
    >>> motion.events["kind"][:2].tolist(), motion.section().shape
    (['impact', 'impact'], (51, 2))
    """

    system: System
    start: State
    record: str
    cycles: int
    final: State
    outcome: Outcome
    overturning: Overturning | None
    impacts: int
    brace_hits: int
    peak: float
    _section_rows: np.ndarray = field(repr=False)
    _event_rows: np.ndarray = field(repr=False)

    @property
    def duration(self) -> float:
        """Length of the run, in τ."""
        return self.cycles * self.system.forcing.period

    @cached_property
    def events(self) -> np.ndarray:
        """Every event in order, a structured array.

        Its fields are time (τ), cycle, phase (ψ in [0, 2π)), angle, the velocities before and after, and
        kind. The kinds are "impact", "brace", "rest", "lift-off", "lean" and "leave". Needs
        ``record="all"``, as `at` does.
        """
        rows = self._rows()
        rows = rows[rows[:, 2] != kernel_events.NONE]
        forcing = self.system.forcing
        events = np.empty(len(rows), EVENT)
        events["cycle"] = rows[:, 0]
        events["time"] = self._absolute(rows)
        events["phase"] = np.mod(forcing.frequency * rows[:, 1] + forcing.phase, 2.0 * math.pi)
        events["angle"] = rows[:, 4] * rows[:, 5] + 0.0
        events["before"] = rows[:, 7] + 0.0
        events["after"] = rows[:, 4] * rows[:, 6] + 0.0
        events["kind"] = KINDS[rows[:, 2].astype(int)]
        return events

    @cached_property
    def peaks(self) -> np.ndarray:
        """Every local extreme of Θ between events, a structured array: time (τ), angle."""
        rows = self._rows()
        begins = self._absolute(rows)
        lasts = np.append(
            np.diff(rows[:, 0]) * self.system.forcing.period + np.diff(rows[:, 1]), self.duration - begins[-1]
        )
        found = np.empty((4 * len(rows) + 16, 3))
        count = sample.turns(self._numbers, rows, lasts, found)
        if count > len(found):
            found = np.empty((count, 3))
            sample.turns(self._numbers, rows, lasts, found)
        peaks = np.empty(count, TURN)
        peaks["time"] = begins[found[:count, 0].astype(int)] + found[:count, 1]
        peaks["angle"] = found[:count, 2]
        return peaks

    def at(self, times: Any) -> tuple[Any, Any]:
        """Give Θ and Θ' at any times, exactly: the closed form (5) of Yim & Lin (1991) from the event before.

        Parameters
        ----------
        times : float or array_like
            τ, from 0 to `duration` (after it for as long as nothing more can happen: an overturned block,
            one at rest).

        Returns
        -------
        angle, velocity : float or ndarray
            Shape of `times`; just after an event at the event's instant.

        Raises
        ------
        ValueError
            Outside the run, or where the motion was not recorded with ``record="all"``.
        """
        values = self._sampled(times)
        return values[..., 0], values[..., 1]

    def acceleration(self, times: Any) -> Any:
        """Give Θ'' at any times, as `at` gives Θ and Θ'; 0 at rest and leaning."""
        return self._sampled(times)[..., 2]

    def section(self, phase: float | None = None) -> np.ndarray:
        """Give the stroboscopic section: Θ, Θ' at every instant with ψ ≡ ``phase`` (mod 2π).

        Parameters
        ----------
        phase : float, optional
            The forcing's own by default: then the first of ``cycles + 1`` rows is the start (a block that
            overturns has no rows past the proof). For another phase, or where no section was kept, the
            motion is run again.

        Returns
        -------
        ndarray, shape (n, 2)
            Just after any event at that instant.
        """
        if phase is None:
            if self.record == "section":
                return self._section_rows
            phase = self.system.forcing.phase
        return section_of(self, within("phase", phase, -LARGEST_PHASE, LARGEST_PHASE))

    def to_xarray(self, step: float | None = None, block: Block | None = None) -> xr.Dataset:
        """Sample the motion as a dataset with units; in SI with a block. See `rocking.motion.dataset.to_dataset`."""
        from rocking.motion.dataset import to_dataset

        return to_dataset(self, step, block)

    def validity(self, block: Block) -> Validity:
        """Say where the model applies to a block: friction, base reaction, slender range. See `rocking.motion.validity`."""
        from rocking.motion.validity import validity

        return validity(self, block)

    def __str__(self) -> str:
        hits = f", {self.brace_hits} brace hits" if self.system.braces is not None else ""
        when = "" if self.overturning is None else f" (no return proved in cycle {self.overturning.cycle})"
        return f"{self.outcome}{when} over {self.cycles} cycles: {self.impacts} impacts{hits}, peak |Θ| {self.peak:.4g}"

    def _repr_html_(self) -> str | None:
        return pictures.html(self)

    @cached_property
    def _numbers(self) -> Any:
        return parameters(self.system)

    def _rows(self) -> np.ndarray:
        if self.record != "all":
            raise ValueError(
                refusal("record", "be 'all' for events, peaks and states at any time", self.record)
            )
        return self._event_rows

    def _absolute(self, rows: np.ndarray) -> np.ndarray:
        # rounding must not put the last event after the end
        return np.minimum(rows[:, 0] * self.system.forcing.period + rows[:, 1], self.duration)

    def _sampled(self, times: Any) -> np.ndarray:
        rows = self._rows()
        times = np.asarray(reals("times", times), dtype=float)
        last = self.duration if self.outcome is Outcome.BOUNDED else math.inf
        if times.size and not (times.min() >= 0.0 and times.max() <= last):
            outside = times[~((times >= 0.0) & (times <= last))].flat[0]
            raise ValueError(refusal("times", f"lie in the run, [0, {last:.6g}]", float(outside)))
        flat = times.ravel()
        period = self.system.forcing.period
        begins = self._absolute(rows)
        index = np.searchsorted(begins, flat, side="right") - 1
        cycle = np.floor(flat / period)
        elapsed = (cycle - rows[index, 0]) * period + ((flat - cycle * period) - rows[index, 1])
        out = np.empty((flat.size, 3))
        elapsed = np.where(flat > begins[index], np.maximum(elapsed, 0.0), 0.0)
        sample.sample(self._numbers, rows, index, elapsed, out)
        return out.reshape(*times.shape, 3) + 0.0
