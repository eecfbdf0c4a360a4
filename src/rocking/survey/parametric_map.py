"""Maps of responses over two quantities."""

from __future__ import annotations

import os
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

from rocking.survey.engine.run_survey import run_survey
from rocking.survey.measures.response import response
from rocking.survey.spec import question

if TYPE_CHECKING:
    import xarray as xr


def parametric_map(
    *,
    amplitude: Any = None,
    period: Any = None,
    frequency: Any = None,
    restitution: Any = None,
    phase: Any = 0.0,
    angle: Any = 0.0,
    velocity: Any = 0.0,
    brace_angle: Any = None,
    brace_restitution: Any = 1.0,
    max_cycles: int = 10_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: bool = False,
    repair: bool = False,
) -> xr.Dataset:
    """Tell what the response is at every point of a grid over any two quantities, each point with its evidence.

    Parameters
    ----------
    amplitude, period, frequency, restitution, phase, angle, velocity, brace_angle, brace_restitution : float or array (n,)
        As in `Harmonic` (either `period` or `frequency`), `System`, `Braces` and `State`, normalised. Two of them are
        arrays, ascending: the axes of the map. A sequence holds the values themselves, so that a range of them is
        ``np.linspace(0, 16, 60)``. Those of a block in SI: ``block.amplitude(accelerations)``,
        ``block.frequency(hertz)``, ``block.restitution``.
    max_cycles, max_period : int
        As in `classify`. Chaotic responses need 10⁴ cycles (with braces 10⁵) to be called so.
    store : path, optional
        A folder that is written to while the map is computed, in Zarr's third format, one group a level from coarse to
        fine, each of which opens in plain xarray. The same call goes on with what is there after any interruption; longer
        axes extend it, axes of half the spacing refine it, without computing anything twice. A second run on a store in
        use is refused.
    executor : concurrent.futures.Executor, optional
        Who computes: threads on all cores unless given. Every executor gives the same bytes on the same kind of
        processor.
    progress : bool
        Whether to show, on stderr, what the map will cost, then a bar with the rate, the time left and the shares by kind.
    repair : bool
        Whether tiles of the store found damaged are computed again; refused otherwise.

    Returns
    -------
    xarray.Dataset
        Over both axes `kind`, `evidence`, `symmetric` (numbers whose meanings are in their attributes `flag_values` and
        `flag_meanings`), `response_period`, `impacts_per_period`, `brace_hits_per_period`, `exponent`,
        `exponent_error`, `peak`, `transient` and `cycles`, as in `Verdict`. With a store its finest level, read as it is
        used.

    Raises
    ------
    TypeError, ValueError
        In one line, for arguments of the wrong type or outside their range, unless two quantities vary, for more points
        than memory holds without a store, and for a store that holds another survey, which says what differs.
    OSError
        For a store that is no folder, is in use, is damaged or cannot be written; what it holds stays good.

    See Also
    --------
    classify : Classify one response.
    repeatability_map : Vary the inputs at every point.
    basin_map : Vary the initial state.
    rocking.plot.parametric_map : Plot the map.
    rocking.plot.tiles : Write the map as a page that zooms.

    Notes
    -----
    Not guaranteed: what `classify` does not guarantee; and that nothing happens between the points. Points that are marched
    long are marched many at once, which rounds otherwise than `classify` does: where an answer hangs on the last
    digit, in chaos and after chaotic transients, the two may differ.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> found = rk.parametric_map(
    ...     amplitude=np.linspace(0, 16, 9), period=np.linspace(0.2, 3, 8), restitution=0.925
    ... )
    >>> found.kind.dims, found.attrs["restitution"]
    (('amplitude', 'period'), 0.925)
    """
    asked = question(
        {
            "amplitude": amplitude,
            "period": period,
            "frequency": frequency,
            "restitution": restitution,
            "phase": phase,
            "angle": angle,
            "velocity": velocity,
            "brace_angle": brace_angle,
            "brace_restitution": brace_restitution,
        },
        2,
        "a parametric map",
    )
    title = "Parametric map of a free-standing block on a shaking base"
    measure = response(max_cycles, max_period, title)
    return run_survey(asked, measure, store, executor, progress=progress, repair=repair)
