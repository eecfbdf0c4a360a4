"""How hard the base must shake to overturn a block from rest: a scan over amplitudes and phases, its first hits refined."""

from __future__ import annotations

import os
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import frozen

from rocking.kernels import judgement as kernel
from rocking.model import OverturningCurve, refusal, whole
from rocking.survey.ask import ask
from rocking.survey.axes import Question, points, question
from rocking.survey.dataset import attributes, coordinate
from rocking.survey.maps import MOST_CYCLES, MOST_PERIOD
from rocking.survey.outcomes import outcome
from rocking.survey.samples import sampled
from rocking.survey.tiles import Measure
from rocking.theory import heteroclinic_amplitude

if TYPE_CHECKING:
    import xarray as xr

MOST_PHASES = 100_000
TITLE = "Overturning of a free-standing block from rest on a shaking base"
SCANNED = tuple(np.linspace(1.0, 16.0, 301).tolist())
"""Amplitudes scanned unless others are given; up to 1 nothing moves from rest."""
HALVINGS = 40
SETTLED = 1e-12
"""Relative width at which bisection ends."""


def overturning_amplitude(
    *,
    period: Any = None,
    frequency: Any = None,
    restitution: Any,
    amplitude: Any = SCANNED,
    phases: int = 16,
    max_cycles: int = 1_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: bool = False,
    repair: bool = False,
) -> OverturningCurve:
    """Find the lowest amplitude that overturns a block from rest, over all phases at which the shaking may begin.

    Overturning is not monotone in the amplitude: a block may survive far above the lowest one. So amplitudes are scanned, at
    every phase; between the last one up to which everything survived and the first that overturns the block at some
    phase, the change is refined by bisection.

    Parameters
    ----------
    period, frequency : float or array (n,)
        T or Ω (exactly one of them), ascending if several.
    restitution : float or array (n,)
        e, likewise.
    amplitude : array (n,)
        The amplitudes to scan, ascending; 301 from 1 to 16 unless given.
    phases : int
        How many phases φ, evenly over half a turn: from rest those of the other half only swap left and right.
    max_cycles, max_period : int
        As in `classify`; what has not overturned in so many cycles survived.
    store, executor, progress, repair
        As in `parametric_map`, for the scan.

    Returns
    -------
    OverturningCurve
        `.dataset` with `lowest`, `resolution`, `lowest_phase`, `survived_up_to`, `surviving_above`, `overturning_share` and
        `changes`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, OSError
        In one line, as in `parametric_map`.

    Notes
    -----
    Not guaranteed: that nothing overturns below `lowest`, between two amplitudes or two phases of the scan; `resolution` is
    how far apart the amplitudes are there. Where the lowest amplitude scanned overturns already, it is `lowest`, and
    `survived_up_to` is NaN.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> found = rk.overturning_amplitude(
    ...     period=[1.5, 2.0], restitution=0.925, amplitude=np.linspace(1, 4, 31), phases=2
    ... )
    >>> found.dataset.lowest.dims, found.dataset.overturning_share.shape
    (('period',), (2, 31))
    """
    count = whole("phases", phases, 1, MOST_PHASES)
    if np.ndim(amplitude) != 1:
        raise TypeError(refusal("amplitude", "be an array of amplitudes to scan, ascending", amplitude))
    measure = outcome(
        whole("max_cycles", max_cycles, 1, MOST_CYCLES),
        whole("max_period", max_period, 1, MOST_PERIOD),
        TITLE,
    )
    turned = np.arange(count) * (np.pi / count)
    given = {
        "amplitude": amplitude,
        "restitution": restitution,
        "phase": turned if count > 1 else 0.0,
        "frequency": frequency,
        "period": period,
    }
    varying = sum(np.ndim(value) > 0 for value in given.values())
    asked = question(given, varying, "an overturning amplitude")
    found = ask(asked, measure, store, executor, progress=progress, repair=repair)
    kinds = found.kind if count > 1 else found.kind.expand_dims(phase=turned)
    over = [name for name in ("restitution", "frequency", "period") if name in asked.axes]
    kinds = kinds.transpose(*over, "phase", "amplitude").load()
    scan = Scan(asked, measure, tuple(over), kinds)
    return _summed_up(scan, *_refined(scan, executor))


@frozen(eq=False)
class Scan:
    """What was found at each amplitude and phase (the last two dimensions) of each cell (those before, `over`)."""

    asked: Question
    measure: Measure
    over: tuple[str, ...]
    kinds: xr.DataArray

    @property
    def amplitudes(self) -> np.ndarray:
        """A, ascending."""
        return self.kinds.amplitude.values

    @property
    def phases(self) -> np.ndarray:
        """φ."""
        return self.kinds.phase.values

    @property
    def cells(self) -> np.ndarray:
        """Whether the block overturned: (cells, phases, amplitudes)."""
        fell: np.ndarray = np.asarray(self.kinds.values == kernel.OVERTURNS)
        return fell.reshape(-1, *fell.shape[-2:])

    @property
    def first(self) -> np.ndarray:
        """The place of the first amplitude of each cell that overturns it at any phase; one past the last if none does."""
        hit: np.ndarray = np.any(self.cells, axis=1)
        return np.where(hit.any(axis=1), hit.argmax(axis=1), self.amplitudes.size)


def _summed_up(scan: Scan, lowest: np.ndarray, phase: np.ndarray) -> OverturningCurve:
    """The curve as a dataset."""
    import xarray as xr

    cells, first, amplitudes, over = scan.cells, scan.first, scan.amplitudes, scan.over
    steps = np.concatenate([[np.nan], np.diff(amplitudes), [np.nan]])
    before = np.concatenate([[np.nan], amplitudes])
    scanned_above = (amplitudes.size - first) * scan.phases.size
    fell_above = cells.sum(axis=(1, 2))
    surviving = np.where(scanned_above > 0, 1.0 - fell_above / np.maximum(scanned_above, 1), np.nan)
    changes = (cells[..., 1:] != cells[..., :-1]).sum(axis=-1)
    undetermined = (scan.kinds.values == kernel.UNDETERMINED).mean(axis=(-2, -1))
    none = "NaN: none"
    columns: dict[str, tuple[tuple[str, ...], np.ndarray, str, str, str]] = {
        "lowest": (over, lowest, "lowest overturning amplitude found", "1", none),
        "resolution": (over, steps[first], "distance of the amplitudes scanned there", "1", none),
        "lowest_phase": (over, phase, "phase at which it overturns", "rad", none),
        "survived_up_to": (
            over,
            before[first],
            "highest amplitude scanned up to which all survived",
            "1",
            none,
        ),
        "surviving_above": (
            over,
            surviving,
            "share of what was scanned from there on that survives",
            "1",
            none,
        ),
        "overturning_share": (
            (*over, "amplitude"),
            cells.mean(axis=1),
            "share of the phases at which the block overturns",
            "1",
            "",
        ),
        "changes": (
            (*over, "phase"),
            changes,
            "changes along the scanned amplitudes between overturning and not",
            "1",
            "",
        ),
        "heteroclinic_amplitude": (over, _thresholds(scan), "exact tangency A*", "1", ""),
        "undetermined": (
            over,
            undetermined,
            "share of what was scanned whose response is undetermined",
            "1",
            "",
        ),
    }
    sizes = {str(name): size for name, size in scan.kinds.sizes.items()}
    variables = {
        name: (
            dims,
            np.reshape(values, tuple(sizes[each] for each in dims)),
            {"long_name": told, "units": unit} | ({"comment": note} if note else {}),
        )
        for name, (dims, values, told, unit, note) in columns.items()
    }
    coordinates = {name: (name, scan.kinds[name].values, coordinate(name)) for name in sizes}
    return OverturningCurve(xr.Dataset(variables, coordinates, attributes(scan.asked, scan.measure)))


def _thresholds(scan: Scan) -> np.ndarray:
    """A* of each cell."""
    grids = np.meshgrid(*(scan.kinds[name].values for name in scan.over), indexing="ij")
    at: dict[str, Any] = scan.asked.fixed | dict(zip(scan.over, grids, strict=True))
    period = at["period"] if "period" in at else 2.0 * np.pi / at["frequency"]
    return np.asarray(heteroclinic_amplitude(period, at["restitution"]))


def _refined(scan: Scan, executor: Executor | None) -> tuple[np.ndarray, np.ndarray]:
    """(lowest amplitude, its phase) of each cell: the first hit, at each phase that has one, bisected back to a survivor."""
    amplitudes, turned, cells, first = scan.amplitudes, scan.phases, scan.cells, scan.first
    there = np.take_along_axis(cells, first[:, None, None].clip(max=amplitudes.size - 1), axis=2)[..., 0]
    rows, columns = np.nonzero(there & (first < amplitudes.size)[:, None])
    high = amplitudes[first[rows]]
    low = np.where(first[rows] > 0, amplitudes[first[rows] - 1], high)
    places = np.unravel_index(rows, scan.kinds.shape[:-2]) if scan.over else ()
    values = {name: scan.kinds[name].values[k] for name, k in zip(scan.over, places, strict=True)}
    values["phase"] = turned[columns]
    for _ in range(HALVINGS):
        wide = np.flatnonzero(high - low > SETTLED * high)
        if wide.size == 0:
            break
        middle = 0.5 * (low[wide] + high[wide])
        tried = points(
            {name: v[wide] for name, v in values.items()} | {"amplitude": middle}, scan.asked.fixed
        )
        fell = sampled(tried, scan.measure, executor)["kind"] == kernel.OVERTURNS
        high[wide[fell]], low[wide[~fell]] = middle[fell], middle[~fell]
    lowest, phase = np.full(first.size, np.nan), np.full(first.size, np.nan)
    # the last written is the lowest
    order = np.argsort(-high, kind="stable")
    lowest[rows[order]], phase[rows[order]] = high[order], turned[columns[order]]
    return lowest, phase
