"""Repeatability of an experiment: outcomes of runs with slightly perturbed inputs, for one system or on a grid."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from rocking.kernels import batch
from rocking.kernels.classify import verdict as kernel
from rocking.model.restitution import check_uniform
from rocking.model.share import Share
from rocking.model.survey_results import Repeatability, RepeatabilityMap
from rocking.model.system import State, System, check_periodic
from rocking.model.text import counted
from rocking.model.validation import instance, whole, within
from rocking.model.verdict import Kind
from rocking.response.classify import KINDS, budget
from rocking.survey.engine import Engine
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.random_points import (
    INPUTS,
    MAX_RELATIVE,
    MAX_SAMPLES,
    TITLE,
    RandomSpec,
    generator,
    perturbed,
    spread,
)
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import (
    START,
    SYSTEM,
    Points,
    by_period,
    fixed_start,
    harmonic_spec,
    points,
    system_quantities,
)
from rocking.survey.verdict_measures import KIND, response, verdicts

Name = TypeVar("Name", bound=str)


def repeatability(
    system: System,
    start: State | None = None,
    *,
    relative: float = 0.01,
    samples: int = 1000,
    seed: int = 0,
    max_cycles: int = 10_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> Repeatability:
    """Estimate the fraction of each outcome of an experiment whose inputs vary slightly.

    A, T, e, Θ and Θ' are uniformly distributed within ± `relative` of their values; e does not exceed 1. Values of A, T
    and Θ beyond their limits, for example beyond a brace, are set to the limit. Zero values stay zero, so that a block
    at rest stays at rest.

    Parameters
    ----------
    system : System
        Nominal system.
    start : State, optional
        Nominal initial state at τ = 0. Default: at rest.
    relative : float
        Largest relative deviation of an input, in [0, 0.5]. Default: 0.01.
    samples : int
        Number of runs, in [1, 10⁷]. Default: 1000.
    seed : int
        Random seed in [0, 2³² − 1]. Default: 0.
    max_cycles, max_period : int
        As in `classify`. Default: 10,000 and 64.
    store, executor, progress, repair
        As in `parametric_map`. More samples of the same seed extend a store.

    Returns
    -------
    Repeatability
        `.kinds` and `.responses`, fractions with their intervals; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    repeatability_map : The outcomes at every point of a grid.
    rocking.plot.repeatability : Plot the fractions.

    Notes
    -----
    The intervals are Wilson's at 95 %. A run that is undetermined after `max_cycles` may have any outcome, so that it
    raises the upper ends of all intervals. An asymmetric response and its mirror image count as one.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> print(rk.repeatability(system, samples=200))
    200 runs with inputs off by up to 1 %: period 1, symmetric, 2 impacts 100 % (98.1–100 %)
    """
    start = check_periodic(system, start)
    check_uniform(system.restitution_table, "repeatability, which changes it")
    off = within("relative", relative, 0, MAX_RELATIVE)
    count = whole("samples", samples, 1, MAX_SAMPLES)
    measure = response(max_cycles, max_period, TITLE)
    fixed = by_period(system) | fixed_start(start)
    meant = points({"angle": np.full(count, start.angle)}, fixed)
    tried = perturbed(meant, generator(seed).uniform(-1.0, 1.0, (count, INPUTS)), off)
    drawn = dict(zip((*SYSTEM, *START), np.hstack([tried.systems, tried.starts]).T, strict=True))
    spec = RandomSpec(
        {"sample": np.arange(float(count))},
        fixed,
        drawn={name: drawn[name] for name in ("amplitude", "period", "restitution", *START)},
        stated={"relative": off, "seed": seed},
    )
    data = run_survey(spec, measure, store, executor, progress=progress, repair=repair).load()
    kinds = Counter(KINDS[k] for k in data.kind.values.tolist())
    unknown = kinds[Kind.UNDETERMINED]
    columns = (
        data[name].values.tolist() for name in ("kind", "response_period", "symmetric", "impacts_per_period")
    )
    return Repeatability(
        system,
        start,
        off,
        _shares(kinds, unknown, count),
        _shares(Counter(_response(*each) for each in zip(*columns, strict=True)), unknown, count),
    )


def _shares(counts: Mapping[Name, int], unknown: int, of: int) -> dict[Name, Share]:
    """Return fractions by name in descending order; undetermined runs, which may belong to any other, come last."""
    known = sorted((each for each in counts if each != Kind.UNDETERMINED), key=lambda each: -counts[each])
    shares = {name: Share(counts[name], of, unknown) for name in known}
    return shares | {name: Share(unknown, of) for name in counts if name == Kind.UNDETERMINED and unknown}


def _response(kind: int, period: int, symmetric: int, impacts: int) -> str:
    """Return a short description of a response."""
    if kind != kernel.PERIODIC:
        return str(KINDS[kind])
    many_impacts = "infinitely many impacts" if impacts < 0 else counted(impacts, "impact")
    return f"period {period}, {'symmetric' if symmetric == 1 else 'asymmetric'}, {many_impacts}"


MILLIONTH = 1e-6
MAX_AT_A_POINT = 1_000


def repeatability_map(
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
    relative: float = 0.01,
    samples: int = 16,
    max_cycles: int = 10_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> RepeatabilityMap:
    """Compute at each point of a grid whether all runs with slightly perturbed inputs have the same outcome.

    Parameters
    ----------
    system : System
        Nominal system. The map replaces those of its quantities that are axes.
    start : State, optional
        Nominal initial state at τ = 0. Default: at rest.
    amplitude, period, frequency, restitution, phase, angle, velocity : array (n,)
    brace_angle, brace_restitution, critical_angle : array (n,)
        Axes of the map, two of them, as in `parametric_map`.
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
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.repeatability_map(
    ...     system, amplitude=np.linspace(1, 13, 4), period=np.linspace(0.5, 2, 4), samples=4
    ... )
    >>> result.uncertain.of, result.dataset.agreeing.dims
    (16, ('amplitude', 'period'))
    """
    check_uniform(instance("system", system, System).restitution_table, "repeatability, which changes it")
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
        "a map of repeatability",
    )
    off = round(within("relative", relative, 0, MAX_RELATIVE) / MILLIONTH)
    options = budget(max_cycles, max_period) | {
        "samples": whole("samples", samples, 2, MAX_AT_A_POINT),
        "relative_millionths": off,
    }
    measure = Measurement(TITLE, agreement, VARIABLES, options, batch.METHOD)
    data = run_survey(spec, measure, store, executor, progress=progress, repair=repair).load()
    data.attrs["relative"] = off * MILLIONTH
    runs = {
        name: np.rint(data[name].values * options["samples"]).astype(int)
        for name in ("agreeing", "overturned", "undetermined")
    }
    braced = "brace_angle" in spec.axes or "brace_angle" in spec.fixed
    may_fall = 0 * runs["undetermined"] if braced else runs["undetermined"]
    return RepeatabilityMap(
        data,
        _divided(runs["agreeing"], runs["undetermined"], options["samples"]),
        _divided(runs["overturned"], may_fall, options["samples"]),
        system=system,
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


def agreement(at: Points, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
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
