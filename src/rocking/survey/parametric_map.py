"""Parametric maps: responses over two quantities."""

from __future__ import annotations

import os
from typing import Any

from rocking.model.survey_results import ParametricMap
from rocking.model.system import State, System
from rocking.survey.engine import Engine
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import fixed_start, harmonic_spec, system_quantities
from rocking.survey.verdict_measures import response


def parametric_map(
    system: System,
    start: State | None = None,
    *,
    amplitude: Any = None,
    period: Any = None,
    frequency: Any = None,
    restitution: Any = None,
    phase: Any = None,
    angle: Any = None,
    velocity: Any = None,
    brace_angle: Any = None,
    brace_restitution: Any = None,
    critical_angle: Any = None,
    max_cycles: int = 10_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> ParametricMap:
    """Classify the response at each point of a grid over any two quantities, with the evidence at each point.

    Parameters
    ----------
    system : System
        Block on a harmonic base. The map replaces those of its quantities that are axes.
    start : State, optional
        Initial state at τ = 0. Default: at rest.
    amplitude, period, frequency, restitution, phase, angle, velocity : array (n,)
    brace_angle, brace_restitution, critical_angle : array (n,)
        Axes of the map: two normalised quantities as in `Harmonic`, `System`, `Braces` and `State`, ascending, for example
        ``np.linspace(0, 16, 60)``. All others are those of the system and of the initial state. For a block in SI use
        ``block.amplitude(accelerations)`` and ``block.frequency(hertz)``.
    max_cycles, max_period : int
        As in `classify`. A response is classified as chaotic after 10⁴ cycles at the earliest (with braces 10⁵).
        Default: 10,000 and 64.
    store : path, optional
        Folder of a Zarr store (format 3), written during the computation. It has one group for each level, from coarse
        to fine, and each group opens in plain xarray. Repeating the call after an interruption resumes it. Longer axes
        extend the map and axes of half the spacing refine it; no point is computed twice. Default: results are kept in
        memory.
    executor : concurrent.futures.Executor or distributed.Client, optional
        Executor, or client of a Dask cluster, that runs the computation. Results are bit-identical for all executors on the
        same class of processors. Default: threads on all cores.
    progress : bool
        Whether to show the estimated cost and the progress on stderr. The progress is the part done, the time left, points per
        second and the fraction of each response type. A terminal and a notebook show a bar. A log gets a line every few seconds,
        and none about a survey that ends before. Default: False.
    repair : bool
        Whether to recompute damaged tiles of the store. Default: False, so that damage raises OSError.

    Returns
    -------
    ParametricMap
        `.dataset` over both axes; `print` shows one line. With a store, its finest level, which is read on access.

    Raises
    ------
    TypeError
        If an argument has the wrong type, or if the number of axes is not two.
    ValueError
        If an argument lies outside its range, if a map without store exceeds the memory, or if the store holds a
        different survey.
    ImportError
        If a store is given, and the extra ``store`` is not installed.
    OSError
        If the store is not a folder, is in use by another run, is damaged or cannot be written. The same if it is moved or deleted
        during the run.

    See Also
    --------
    classify : Classify one response.
    repeatability_map : Vary the inputs at every point.
    basin_map : Vary the initial state.
    rocking.plot.parametric_map : Plot the map.
    rocking.plot.tiles : Write the map as a page that zooms.

    Notes
    -----
    Not guaranteed: what `classify` does not guarantee, and the responses between the points of the grid. Long runs are
    advanced many at a time, which rounds differently from `classify`. The two may disagree where the outcome depends on
    the last digit, in chaos and after chaotic transients.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.parametric_map(system, amplitude=np.linspace(0, 16, 9), period=np.linspace(0.2, 3, 8))
    >>> result.dataset.kind.dims, result.dataset.attrs["restitution"]
    (('amplitude', 'period'), 0.925)
    """
    spec = harmonic_spec(
        system_quantities(system) | fixed_start(start),
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
            "critical_angle": critical_angle,
        },
        2,
        "a parametric map",
    )
    measure = response(max_cycles, max_period, "Parametric map of a free-standing block on a shaking base")
    data = run_survey(spec, measure, store, executor, progress=progress, repair=repair)
    return ParametricMap(data, system=system)
