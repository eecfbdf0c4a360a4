"""Where an experiment can be repeated: at every point of a grid, what comes of inputs that are off by a little."""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import Executor
from typing import Any

import numpy as np

from rocking.kernels import batch
from rocking.kernels.classify import verdict_record as kernel
from rocking.model import RepeatabilityMap, Share, whole, within
from rocking.response import KINDS, budget
from rocking.survey.engine.run_survey import run_survey
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.measures.kind import KIND
from rocking.survey.sampling.perturbation import MAX_RELATIVE, TITLE, perturbed, spread
from rocking.survey.spec import Points, question

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
    relative: float = 0.01,
    samples: int = 16,
    max_cycles: int = 10_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: bool = False,
    repair: bool = False,
) -> RepeatabilityMap:
    """Tell at every point of a grid whether the outcome is certain when the inputs are off by a little, and at which share not.

    Parameters
    ----------
    amplitude, period, frequency, restitution, phase, angle, velocity, brace_angle, brace_restitution : float or array (n,)
        As in `parametric_map`: two of them are arrays, the axes.
    relative : float
        By which share of itself A, T, e and the start may be off, in [0, 0.5], to a millionth.
    samples : int
        Experiments at each point, 2 to 1000: evenly spread over what the inputs may be, the same at every point.
    max_cycles, max_period, store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    RepeatabilityMap
        `.dataset`, and the shares `.uncertain` and `.overturning_uncertain` of the points; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, OSError
        In one line, as in `parametric_map`.

    See Also
    --------
    repeatability : The outcomes of one experiment.
    parametric_map : Exact inputs at every point.
    rocking.plot.repeatability_map : Plot the map.

    Notes
    -----
    Not guaranteed: that a point at which all experiments agree is certain; an outcome with a share p is missed by
    (1 − p)ⁿ of n experiments. Undetermined is no outcome: a point is not certain only where two others are seen, and where
    it is not known the shares have a wider interval, which is that of as many random points.

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
    }
    asked = question(given, 2, "a map of repeatability")
    off = round(within("relative", relative, 0, MAX_RELATIVE) / MILLIONTH)
    options = budget(max_cycles, max_period) | {
        "samples": whole("samples", samples, 2, MAX_AT_A_POINT),
        "relative_millionths": off,
    }
    measure = Measurement(TITLE, judge, batch.compile_many, VARIABLES, options, batch.METHOD, shares="kind")
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
    """The points at which some of so many runs are of one sort and some of another."""
    divided = (one > 0) & (one + unknown < of)
    return Share(np.count_nonzero(divided), one.size, np.count_nonzero((unknown > 0) & ~divided))


VARIABLES = (
    Variable(
        "kind", KIND.dtype, KIND.fill, KIND.attributes | {"long_name": "most frequent kind of response"}
    ),
    Variable("overturned", "float32", -1.0, {"long_name": "share of the runs that overturn", "units": "1"}),
    Variable(
        "undetermined",
        "float32",
        -1.0,
        {"long_name": "share of the runs whose response is undetermined", "units": "1"},
    ),
    Variable(
        "agreeing",
        "float32",
        -1.0,
        {"long_name": "share of the runs of the most frequent kind", "units": "1"},
    ),
)


def judge(at: Points, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """How many of the experiments at each point end in each kind of response."""
    counts = np.zeros((len(at.systems), len(KINDS)), np.int64)
    for units in spread(options["samples"]):
        tried = perturbed(
            at, np.tile(units, (len(at.systems), 1)), options["relative_millionths"] * MILLIONTH
        )
        told = batch.classify_batch(*tried, options["max_cycles"], options["max_period"], stop)
        if told is None:
            return None
        counts[np.arange(len(counts)), told.kind] += 1
    shares = (counts / options["samples"]).astype(np.float32)
    known = np.delete(shares, kernel.UNDETERMINED, axis=1)
    return {
        "kind": np.where(known.any(axis=1), known.argmax(axis=1), kernel.UNDETERMINED).astype(np.uint8),
        "overturned": shares[:, kernel.OVERTURNS],
        "undetermined": shares[:, kernel.UNDETERMINED],
        "agreeing": known.max(axis=1),
    }
