"""Sweeps over the values of a parameter: section points of motions that follow one another, or of independent ones.

A store holds one survey for each part of the sweeps. A part begins at the states at which the part before it ended.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from itertools import pairwise, product
from typing import Any, ClassVar

import numpy as np
from attrs import evolve, field, frozen
from numpy.typing import NDArray

from rocking.kernels import batch as kernels
from rocking.kernels import system as numbers
from rocking.kernels.motion import march
from rocking.kernels.motion import sweep as kernel
from rocking.model.progress import Bar
from rocking.model.system import System
from rocking.orbits.parameter import identity_of
from rocking.orbits.verdicts import NORMALISED, variable
from rocking.survey.engine import Engine
from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import SurveySpec, Values
from rocking.survey.store_access import store_in

# Compiled code cannot be interrupted. It returns after this number of cycles, or after one value.
BREATH = 1_000_000
# Largest number of parts in a store, and number of tasks of a part whose motions are independent.
MAX_PARTS, TASKS = 400, 8
TITLE = "Sweeps of a free-standing block on a shaking base"
FLOATS = ("angle", "velocity", "peak", "end_angle", "end_velocity")
VARIABLES = (*(variable(name, np.dtype(float)) for name in FLOATS), variable("status", np.dtype(np.uint8)))


@frozen(eq=False)
class SweepSpec(SurveySpec):
    """Sweeps, of which each `part` is a survey of one tile, because its motions follow one another."""

    comment = NORMALISED
    contiguous = True
    in_a_tile = None
    numbers: ClassVar[dict[str, str]] = {
        "sweep": "number of the sweep",
        "value": "number of the value in the order of the sweep",
        "cycle": "forcing cycles since the transient",
    }

    system: System = field(kw_only=True)
    parameter: str = field(kw_only=True)
    sweep: str = field(kw_only=True)
    transient: int = field(kw_only=True)
    cycles: int = field(kw_only=True)
    section_phase: float = field(kw_only=True)
    # The values in the order of each sweep (s, n), their systems (s, n, 8), and the states at which the sweeps begin (s, 2).
    values: NDArray[np.float64] = field(kw_only=True)
    rows: NDArray[np.float64] = field(kw_only=True)
    states: NDArray[np.float64] = field(kw_only=True)

    @property
    def breath(self) -> int:
        """Number of values between two moments at which Ctrl-C is heard."""
        return max(BREATH // (self.transient + self.cycles), 1)

    def part(self, first: int, last: int) -> SweepSpec:
        """Return the survey of the values with the numbers from `first` to below `last`."""
        ends = {"sweep": (0, len(self.rows)), "value": (first, last), "cycle": (0, self.cycles)}
        axes = {name: np.arange(*each, dtype=float) for name, each in ends.items()}
        return evolve(self, axes=axes, values=self.values[:, first:last], rows=self.rows[:, first:last])

    def inputs(self, values: Values) -> tuple[SweepSpec, tuple[np.ndarray, ...]]:
        """Return the survey, and the indices of n points along its axes."""
        return self, tuple((values[name] - each[0]).astype(int) for name, each in self.axes.items())

    def described(self) -> dict[str, Any]:
        """Return what determines the motions."""
        names = ("sweep", "transient", "cycles", "section_phase")
        return identity_of(self.system, self.parameter) | {
            **{name: getattr(self, name) for name in names},
            "values_sha256": sha256(self.values.tobytes()).hexdigest(),
            "states": self.states.tolist(),
        }

    def blank(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return arrays for the section points (s, n, m, 2), peaks and statuses (s, n), not filled."""
        shape = self.values.shape
        return np.empty((*shape, self.cycles, 2)), np.empty(shape), np.empty(shape, np.int64)

    def advance(
        self, results: tuple[np.ndarray, ...], row: int, first: int, last: int, state: np.ndarray
    ) -> np.ndarray:
        """Compute motions of a sweep from a state; return the state at which the next one begins."""
        law = np.array(self.system.restitution_law).reshape(-1, 2)
        kind = numbers.kind_of_rows(self.rows.reshape(-1, self.rows.shape[-1]), law)
        here = row, slice(first, last)
        how = self.sweep != "rest", self.transient, self.section_phase, *(each[here] for each in results)
        return np.array(kernel.sweep(kind, self.rows[here], *state.tolist(), *how, march.no_recording()))


def sections_at(
    inputs: tuple[SweepSpec, tuple[np.ndarray, ...]], options: Mapping[str, int], stop: np.ndarray
) -> Arrays | None:
    """Return the results at successive values of one sweep; None if another thread sets `stop`."""
    part, at = inputs
    results, row, last = part.blank(), int(at[0][0]), int(at[1][-1]) + 1
    state = part.states[row]
    for first in range(int(at[1][0]), last, part.breath):
        if stop[0]:
            return None
        state = part.advance(results, row, first, min(first + part.breath, last), state)
    points, peak, status = results[0][at], results[1][at[:2]], results[2][at[:2]]
    columns = (*points.T, peak, *np.broadcast_to(state, points.shape).T)
    return dict(zip(FLOATS, columns, strict=True)) | {"status": status.astype(np.uint8)}


def run_sweeps(
    sweeps: SweepSpec,
    store: str | os.PathLike[str] | None,
    executor: Engine | None,
    bar: Bar,
    *,
    repair: bool,
) -> tuple[np.ndarray, ...]:
    """Return section points, peaks and statuses; one thread computes a sweep, and independent motions are divided."""
    results, (rows, count) = sweeps.blank(), sweeps.values.shape
    plain = store is None and executor is None and repair is False
    tasks = rows if sweeps.sweep != "rest" else min(os.cpu_count() or 1, count) if plain else TASKS
    size = sweeps.breath * (tasks // rows)
    if not plain:
        size = max(size, -(-count // MAX_PARTS))
    with ThreadPoolExecutor(tasks) as pool:
        for number, first in enumerate(range(0, count, size)):
            last, before = min(first + size, count), False
            if plain:
                edges = pairwise(np.linspace(first, last, tasks // rows + 1).astype(int).tolist())
                lanes = (
                    (results, row, *each, sweeps.states[row]) for row, each in product(range(rows), edges)
                )
                states = np.array(list(pool.map(sweeps.advance, *zip(*lanes, strict=True))))[:rows]
            else:
                part, place = sweeps.part(first, last), store_in(store, "part", number)
                before = place is not None and place.exists()
                batch = -(-part.points // tasks)
                measure = Measurement(TITLE, sections_at, VARIABLES, {}, kernels.METHOD, "status", batch)
                data = run_survey(part, measure, place, executor, repair=repair).load()
                angle, velocity, peak, *ends = (data[name].values for name in FLOATS)
                new = np.stack([angle, velocity], axis=-1), peak[..., 0], data["status"].values[..., 0]
                for whole, each in zip(results, new, strict=True):
                    whole[:, first:last] = each
                states = np.stack(ends, axis=-1)[:, 0, 0]
            sweeps = evolve(sweeps, states=states)
            bar.advance((last - first) * rows, before=before)
    return results
