"""Lowest amplitude that overturns a block from rest, over periods and restitutions, by a scan and bisection."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import frozen

from rocking.kernels.classify import verdict as kernel
from rocking.model.survey_results import OverturningCurve
from rocking.model.system import System
from rocking.model.validation import instance, refuse_if, whole
from rocking.survey.engine import Engine
from rocking.survey.measurement import Measurement
from rocking.survey.memory import attributes
from rocking.survey.random_points import sampled
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import (
    HarmonicSpec,
    coordinate,
    harmonic_spec,
    quantity_axis,
    system_quantities,
)
from rocking.survey.verdict_measures import outcome
from rocking.theory import heteroclinic_amplitude

if TYPE_CHECKING:
    import xarray as xr


HALVINGS = 40
SETTLED = 1e-12
"""Relative width at which bisection ends."""


@frozen(eq=False)
class Scan:
    """Kinds of response over phase and amplitude (the last two dimensions) in each cell of the dimensions `over`."""

    spec: HarmonicSpec
    measure: Measurement
    over: tuple[str, ...]
    kinds: xr.DataArray

    @property
    def amplitudes(self) -> np.ndarray:
        """Amplitudes A, ascending."""
        return self.kinds.amplitude.values

    @property
    def phases(self) -> np.ndarray:
        """Initial phases φ of the forcing."""
        return self.kinds.phase.values

    @property
    def cells(self) -> np.ndarray:
        """Mask of the runs that overturned, of shape (cells, phases, amplitudes)."""
        fell: np.ndarray = np.asarray(self.kinds.values == kernel.OVERTURNS)
        return fell.reshape(-1, *fell.shape[-2:])

    @property
    def first(self) -> np.ndarray:
        """Index of the lowest amplitude that overturns at any phase of each cell; the number of amplitudes if none."""
        hit: np.ndarray = np.any(self.cells, axis=1)
        return np.where(hit.any(axis=1), hit.argmax(axis=1), self.amplitudes.size)


def refined(scan: Scan, executor: Engine | None) -> tuple[np.ndarray, np.ndarray]:
    """Refine the lowest overturning amplitude of each cell by bisection, at each phase that overturns there.

    Returns
    -------
    tuple of (array (cells,), array (cells,))
        Lowest overturning amplitude and its phase; NaN if no run overturned.
    """
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
        tried = {name: v[wide] for name, v in values.items()} | {"amplitude": middle}
        fell = sampled(tried, scan.spec.fixed, scan.measure, executor)["kind"] == kernel.OVERTURNS
        high[wide[fell]], low[wide[~fell]] = middle[fell], middle[~fell]
    lowest, phase = np.full(first.size, np.nan), np.full(first.size, np.nan)
    # in descending order, so that the lowest amplitude is written last
    order = np.argsort(-high, kind="stable")
    lowest[rows[order]], phase[rows[order]] = high[order], turned[columns[order]]
    return lowest, phase


MAX_PHASES = 100_000
TITLE = "Overturning of a free-standing block from rest on a shaking base"
SCANNED = np.linspace(1.0, 16.0, 301)
"""Default amplitudes of the scan. Up to A = 1 a block at rest does not move."""


def overturning_amplitude(
    system: System,
    *,
    amplitude: Any = None,
    period: Any = None,
    frequency: Any = None,
    restitution: Any = None,
    critical_angle: Any = None,
    phases: int = 16,
    max_cycles: int = 1_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> OverturningCurve:
    """Find the lowest amplitude that overturns a block from rest, over the initial phases of the forcing.

    Overturning is not monotone in the amplitude: a block may survive far above the lowest overturning amplitude. So
    amplitudes are scanned at each phase. All runs survive up to some scanned amplitude, and the next one overturns the
    block at some phase. Bisection refines the change between these two.

    Parameters
    ----------
    system : System
        Block on a harmonic base without braces, of any amplitude and phase.
    amplitude : array (n,), optional
        Amplitudes A to scan, ascending. Default: 301 values from 1 to 16.
    period, frequency, restitution, critical_angle : array (n,), optional
        Axes of the result, ascending: forcing period T or forcing frequency Ω, coefficient of restitution e and critical angle of
        the full equation, rad. Default: those of the system.
    phases : int
        Number of initial phases φ, evenly spaced over [0, π), for an unsymmetric block over [0, 2π). From rest, the
        other half of the phases only mirrors the motion of a symmetric block. Default: 16.
    max_cycles, max_period : int
        As in `classify`. A run that has not overturned after `max_cycles` counts as survived. Default: 1,000 and 64.
    store, executor, progress, repair
        As in `parametric_map`, for the scan.

    Returns
    -------
    OverturningCurve
        `.dataset` with `lowest`, `resolution`, `lowest_phase`, `survived_up_to`, `surviving_above`, `overturning_share` and
        `changes`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    safe_basin : Fraction of safe initial states.
    repeatability : Outcomes under uncertain inputs.
    rocking.plot.overturning : Plot the curve.

    Notes
    -----
    Not guaranteed: that the block survives all amplitudes below `lowest`, because the scan skips amplitudes and phases
    between its values. `resolution` is the distance between scanned amplitudes there. If `lowest` lies in a fractal
    set, it depends on the last digits of the system: for one cabinet at 1 Hz it varies by 1e-5.
    If the block overturns at the lowest scanned amplitude, `lowest` is that amplitude and `survived_up_to` is NaN.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.overturning_amplitude(system, period=[1.5, 2.0], amplitude=np.linspace(1, 4, 31), phases=2)
    >>> result.dataset.lowest.dims, result.dataset.overturning_share.shape
    (('period',), (2, 31))
    """
    count = whole("phases", phases, 1, MAX_PHASES)
    measure = outcome(max_cycles, max_period, TITLE)
    span = np.pi if instance("system", system, System).left is None else 2.0 * np.pi
    turned = np.arange(count) * (span / count)
    fixed = system_quantities(system) | {"phase": 0.0}
    refuse_if(
        system.braces is not None, "system", "have no braces: between them a block does not overturn", system
    )
    axes = {
        "amplitude": quantity_axis("amplitude", SCANNED if amplitude is None else amplitude),
        "restitution": restitution,
        "phase": turned if count > 1 else None,
        "frequency": frequency,
        "period": period,
        "critical_angle": critical_angle,
    }
    varied = sum(each is not None for each in axes.values())
    spec = harmonic_spec(fixed, axes, varied, "an overturning amplitude")
    data = run_survey(spec, measure, store, executor, progress=progress, repair=repair)
    kinds = data.kind if count > 1 else data.kind.expand_dims(phase=turned)
    over = [name for name in ("restitution", "critical_angle", "frequency", "period") if name in spec.axes]
    kinds = kinds.transpose(*over, "phase", "amplitude").load()
    scan = Scan(spec, measure, tuple(over), kinds)
    return OverturningCurve(_summed_up(scan, *refined(scan, executor)), system=system)


def _summed_up(scan: Scan, lowest: np.ndarray, phase: np.ndarray) -> xr.Dataset:
    """Return the curve as a dataset."""
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
        "resolution": (over, steps[first], "distance between the amplitudes scanned there", "1", none),
        "lowest_phase": (over, phase, "phase at which it overturns", "rad", none),
        "survived_up_to": (
            over,
            before[first],
            "highest scanned amplitude up to which all runs survived",
            "1",
            none,
        ),
        "surviving_above": (
            over,
            surviving,
            "fraction of the runs scanned from there on that survive",
            "1",
            none,
        ),
        "overturning_share": (
            (*over, "amplitude"),
            cells.mean(axis=1),
            "fraction of the phases at which the block overturns",
            "1",
            "",
        ),
        "changes": (
            (*over, "phase"),
            changes,
            "number of changes between survival and overturning along the scanned amplitudes",
            "1",
            "",
        ),
        "heteroclinic_amplitude": (over, _thresholds(scan), "exact tangency A*", "1", ""),
        "undetermined": (
            over,
            undetermined,
            "fraction of the scanned runs whose response is undetermined",
            "1",
            "",
        ),
    }
    sizes = {str(name): size for name, size in scan.kinds.sizes.items()}
    variables = {
        name: (
            dims,
            np.reshape(values, tuple(sizes[each] for each in dims)),
            {"long_name": long_name, "units": unit} | ({"comment": note} if note else {}),
        )
        for name, (dims, values, long_name, unit, note) in columns.items()
    }
    coordinates = {name: (name, scan.kinds[name].values, coordinate(name)) for name in sizes}
    return xr.Dataset(variables, coordinates, attributes(scan.spec, scan.measure))


def _thresholds(scan: Scan) -> np.ndarray:
    """Return A* of each cell; NaN without a closed form."""
    grids = np.meshgrid(*(scan.kinds[name].values for name in scan.over), indexing="ij")
    if not scan.spec.has_tangency:
        return np.full(grids[0].shape if grids else (), np.nan)
    at: dict[str, Any] = scan.spec.fixed | dict(zip(scan.over, grids, strict=True))
    period = at["period"] if "period" in at else 2.0 * np.pi / at["frequency"]
    return np.asarray(heteroclinic_amplitude(period, at["restitution"]))
