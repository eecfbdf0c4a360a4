"""Safe basin: fraction of initial states that do not overturn, over the amplitude."""

from __future__ import annotations

from concurrent.futures import Executor
from typing import Any

import numpy as np

from rocking.kernels.classify import verdict_record as kernel
from rocking.model.progress import Bar
from rocking.model.share import Share
from rocking.model.survey_results import SafeBasin
from rocking.model.system import RANGES
from rocking.model.validation import WrongType, instance, whole
from rocking.survey.harmonic_spec import HarmonicSpec, Points, coordinate, points, question
from rocking.survey.measures.kind import interval_variables, outcome
from rocking.survey.sampling.random_points import MAX_SAMPLES, generator, sampled, span
from rocking.survey.store.dataset import attributes
from rocking.theory import heteroclinic_amplitude, melnikov_amplitude

TITLE = "Safe basin of a free-standing block on a shaking base"


def safe_basin(
    *,
    amplitude: Any,
    period: float | None = None,
    frequency: float | None = None,
    restitution: float,
    phase: float = 0.0,
    brace_angle: float | None = None,
    brace_restitution: float = 1.0,
    critical_angle: float | None = None,
    angle: Any = (-1.0, 1.0),
    velocity: Any = (-1.0, 1.0),
    samples: int = 10_000,
    seed: int = 0,
    max_cycles: int = 10_000,
    max_period: int = 64,
    executor: Executor | None = None,
    progress: bool = False,
) -> SafeBasin:
    """Estimate the fraction of initial states that do not overturn, over the amplitude.

    The result includes the thresholds A* and A_M of the amplitude.

    For e > 0 and A* < A < √(1 + Ω²) the boundary of the overturning initial states is fractal (`horseshoe`).
    The safe fraction does not necessarily decrease
    from there on. Both thresholds hold for a slender block without braces, and are NaN
    for any other.

    Parameters
    ----------
    amplitude : array (n,)
        Amplitudes A, ascending.
    period, frequency, restitution, phase, brace_angle, brace_restitution, critical_angle : float
        As in `Harmonic` (either `period` or `frequency`), `System` and `Braces`.
    angle, velocity : pair
        Ranges (low, high) from which the initial states (Θ, Θ') are drawn. Default: (−1, 1).
    samples : int
        Number of initial states, in [1, 10⁷], the same ones at each amplitude. Default: 10,000.
    seed : int
        Random seed in [0, 2³² − 1]. Default: 0.
    max_cycles, max_period : int
        As in `classify`. Default: 10,000 and 64.
    executor : concurrent.futures.Executor, optional
        Executor that runs the computation. Default: threads on all cores.
    progress : bool
        Whether to show the progress on stderr. Default: False.

    Returns
    -------
    SafeBasin
        `.dataset`, `.shares`, `.heteroclinic_amplitude` and `.melnikov_amplitude`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError
        If an argument has the wrong type or lies outside its range.

    See Also
    --------
    basin_map : Basins at one amplitude.
    overturning_amplitude : Lowest overturning amplitude from rest.
    rocking.plot.safe_basin : Plot the fraction.

    Notes
    -----
    The intervals are Wilson's at 95 %. Because the initial states are the same, the difference of the fractions at two
    amplitudes is more certain than their intervals suggest. There is no store: the same seed reproduces the initial
    states, and `basin_map` stores a grid of them.
    Not guaranteed: that undetermined and chaotic responses never overturn. Both count as safe.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.safe_basin(amplitude=[3.3, 3.7, 5.5], period=1.0, restitution=0.8, samples=500)
    >>> found.dataset.safe.dims, round(found.heteroclinic_amplitude, 4)
    (('amplitude',), 3.6878)
    """
    measure = outcome(max_cycles, max_period, TITLE)
    given = {
        "amplitude": amplitude,
        "period": period,
        "frequency": frequency,
        "restitution": restitution,
        "phase": phase,
        "brace_angle": brace_angle,
        "brace_restitution": brace_restitution,
        "critical_angle": critical_angle,
    }
    asked = question(given, 1, "a safe basin")
    if "amplitude" not in asked.axes:
        raise WrongType("amplitude", "be an axis of amplitudes, ascending", amplitude)
    reach = (
        RANGES["angle"] if brace_angle is None else (-asked.fixed["brace_angle"], asked.fixed["brace_angle"])
    )
    low, high = zip(span("angle", angle, reach), span("velocity", velocity), strict=True)
    starts = generator(seed).uniform(low, high, (whole("samples", samples, 1, MAX_SAMPLES), 2))
    amplitudes, kinds = asked.axes["amplitude"].tolist(), []
    total = len(amplitudes) * len(starts)
    with Bar(total, "initial states", shown=instance("progress", progress, bool)) as bar:
        for value in amplitudes:
            kinds.append(sampled(_placed(asked, value, starts), measure, executor)["kind"])
            bar.advance(len(starts))
    drawn = {"seed": seed, "angle_range": [low[0], high[0]], "velocity_range": [low[1], high[1]]}
    return _summed_up(asked, measure, kinds, drawn)


def _placed(asked: HarmonicSpec, amplitude: float, starts: np.ndarray) -> Points:
    return points({"angle": starts[:, 0], "velocity": starts[:, 1]}, asked.fixed | {"amplitude": amplitude})


def _summed_up(
    asked: HarmonicSpec, measure: Any, kinds: list[np.ndarray], drawn: dict[str, Any]
) -> SafeBasin:
    import xarray as xr

    shares = tuple(Share(np.count_nonzero(each != kernel.OVERTURNS), each.size) for each in kinds)
    open_ones = np.array([np.mean(each == kernel.UNDETERMINED) for each in kinds])
    period = asked.fixed.get("period") or 2.0 * np.pi / asked.fixed["frequency"]
    exact = first_order = np.nan
    if "brace_angle" not in asked.fixed and not asked.full:
        exact = heteroclinic_amplitude(period, asked.fixed["restitution"])
        first_order = melnikov_amplitude(period, asked.fixed["restitution"])
    variables = interval_variables(
        "safe", shares, "amplitude", "fraction of the initial states that do not overturn"
    )
    variables["undetermined"] = (
        "amplitude",
        open_ones,
        {"long_name": "fraction of the initial states whose response is undetermined", "units": "1"},
    )
    metadata = attributes(asked, measure) | {
        "samples": shares[0].of,
        **drawn,
        "heteroclinic_amplitude": exact,
        "melnikov_amplitude": first_order,
    }
    coordinates = {"amplitude": ("amplitude", asked.axes["amplitude"], coordinate("amplitude"))}
    return SafeBasin(xr.Dataset(variables, coordinates, metadata), shares, exact, first_order)
