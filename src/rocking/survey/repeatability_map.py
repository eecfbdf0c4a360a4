"""Map of repeatability: outcomes of runs with slightly perturbed inputs at each point of a grid."""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import Executor
from typing import Any

import numpy as np

from rocking.kernels import batch
from rocking.kernels.classify import verdict_record as kernel
from rocking.model.share import Share
from rocking.model.survey_results import RepeatabilityMap
from rocking.model.validation import whole, within
from rocking.response.classify import KINDS, budget
from rocking.survey.engine.run_survey import run_survey
from rocking.survey.harmonic_spec import Points, question
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.measures.kind import KIND
from rocking.survey.measures.verdicts import verdicts
from rocking.survey.sampling.perturbation import MAX_RELATIVE, TITLE, perturbed, spread

MILLIONTH = 1e-6
MAX_AT_A_POINT = 1_000


def repeatability_map(
    *,
    amplitude: Any,
    period: Any = None,
    frequency: Any = None,
    restitution: Any,
    phase: Any = 0.0,
    angle: Any = 0.0,
    velocity: Any = 0.0,
    brace_angle: Any = None,
    brace_restitution: Any = 1.0,
    critical_angle: Any = None,
    relative: float = 0.01,
    samples: int = 16,
    max_cycles: int = 10_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: bool = False,
    repair: bool = False,
) -> RepeatabilityMap:
    """Compute at each point of a grid whether all runs with slightly perturbed inputs have the same outcome.

    Parameters
    ----------
    amplitude, period, frequency, restitution, phase, angle, velocity : float or array (n,)
    brace_angle, brace_restitution, critical_angle : float or array (n,)
        As in `parametric_map`. Two of them are arrays, the axes of the map.
    relative : float
        Largest relative deviation of A, T, e, Θ and Θ', in [0, 0.5], rounded to 10⁻⁶. Default: 0.01.
    samples : int
        Number of runs at each point, in [2, 1000]. Their deviations are evenly spread and the same at each point.
        Default: 16.
    max_cycles, max_period, store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    RepeatabilityMap
        `.dataset`, and the fractions `.uncertain` and `.overturning_uncertain` of the points; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    repeatability : The outcomes of one experiment.
    parametric_map : Exact inputs at every point.
    rocking.plot.repeatability_map : Plot the map.

    Notes
    -----
    Not guaranteed: that the outcome is certain at a point at which all runs agree. An outcome of probability p does not
    occur among n runs with probability (1 − p)ⁿ. Undetermined is not an outcome: a point counts as uncertain only if
    two other outcomes occur. Points that undetermined runs leave open widen the intervals of the fractions. These are
    the intervals of an equal number of random points.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> found = rk.repeatability_map(
    ...     amplitude=np.linspace(1, 13, 4), period=np.linspace(0.5, 2, 4), restitution=0.925, samples=4
    ... )
    >>> found.uncertain.of, found.dataset.agreeing.dims
    (16, ('amplitude', 'period'))
    """
    given = {
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
    }
    asked = question(given, 2, "a map of repeatability")
    off = round(within("relative", relative, 0, MAX_RELATIVE) / MILLIONTH)
    options = budget(max_cycles, max_period) | {
        "samples": whole("samples", samples, 2, MAX_AT_A_POINT),
        "relative_millionths": off,
    }
    measure = Measurement(TITLE, judge, VARIABLES, options, batch.METHOD)
    found = run_survey(asked, measure, store, executor, progress=progress, repair=repair).load()
    found.attrs["relative"] = off * MILLIONTH
    runs = {
        name: np.rint(found[name].values * options["samples"]).astype(int)
        for name in ("agreeing", "overturned", "undetermined")
    }
    braced = "brace_angle" in asked.axes or "brace_angle" in asked.fixed
    may_fall = 0 * runs["undetermined"] if braced else runs["undetermined"]
    return RepeatabilityMap(
        found,
        _divided(runs["agreeing"], runs["undetermined"], options["samples"]),
        _divided(runs["overturned"], may_fall, options["samples"]),
    )


def _divided(one: np.ndarray, unknown: np.ndarray, of: int) -> Share:
    """Return the fraction of points at which some of the runs have the outcome counted in `one` and others do not."""
    divided = (one > 0) & (one + unknown < of)
    return Share(np.count_nonzero(divided), one.size, np.count_nonzero((unknown > 0) & ~divided))


VARIABLES = (
    Variable(
        "kind", KIND.dtype, KIND.fill, KIND.attributes | {"long_name": "most frequent kind of response"}
    ),
    Variable(
        "overturned", "float32", -1.0, {"long_name": "fraction of the runs that overturn", "units": "1"}
    ),
    Variable(
        "undetermined",
        "float32",
        -1.0,
        {"long_name": "fraction of the runs whose response is undetermined", "units": "1"},
    ),
    Variable(
        "agreeing",
        "float32",
        -1.0,
        {"long_name": "fraction of the runs of the most frequent kind", "units": "1"},
    ),
)


def judge(at: Points, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Return the most frequent kind of response and the fractions of the runs at each point."""
    counts = np.zeros((len(at.systems), len(KINDS)), np.int64)
    for units in spread(options["samples"]):
        tried = perturbed(
            at, np.tile(units, (len(at.systems), 1)), options["relative_millionths"] * MILLIONTH
        )
        arrays = verdicts(tried, options, stop)
        if arrays is None:
            return None
        counts[np.arange(len(counts)), arrays.kind] += 1
    shares = (counts / options["samples"]).astype(np.float32)
    known = np.delete(shares, kernel.UNDETERMINED, axis=1)
    return {
        "kind": np.where(known.any(axis=1), known.argmax(axis=1), kernel.UNDETERMINED).astype(np.uint8),
        "overturned": shares[:, kernel.OVERTURNS],
        "undetermined": shares[:, kernel.UNDETERMINED],
        "agreeing": known.max(axis=1),
    }
