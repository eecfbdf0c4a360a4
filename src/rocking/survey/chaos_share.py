"""Fraction of chaotic responses among random periods and amplitudes."""

from __future__ import annotations

from concurrent.futures import Executor
from typing import Any

import numpy as np

from rocking.kernels.classify import verdict_record as kernel
from rocking.model.share import Share
from rocking.model.survey_results import ChaosShare
from rocking.model.system import RANGES, check_below_flat
from rocking.model.validation import WrongType, real, whole, within
from rocking.response.classify import KINDS
from rocking.survey.harmonic_spec import HarmonicSpec, check_quantity, coordinate, points
from rocking.survey.measures.kind import interval_variables, outcome
from rocking.survey.sampling.random_points import MAX_SAMPLES, generator, sampled, span
from rocking.survey.store.dataset import attributes

TITLE = "Share of chaotic responses of a free-standing block on a shaking base"


def chaos_share(
    *,
    restitution: Any,
    period: Any = (0.2, 3.0),
    amplitude: Any = (0.0, 16.0),
    brace_angle: float | None = None,
    brace_restitution: float = 1.0,
    critical_angle: float | None = None,
    samples: int = 3_000,
    seed: int = 0,
    max_cycles: int = 20_000,
    max_period: int = 64,
    executor: Executor | None = None,
) -> ChaosShare:
    """Estimate the fraction of chaotic responses from rest over the restitution, for random periods and amplitudes.

    Parameters
    ----------
    restitution : float or array (n,)
        Coefficient of restitution e in [0, 1]; an array is ascending.
    period, amplitude : pair
        Ranges (low, high) of the forcing period T and the amplitude A, which are uniformly distributed.
        Default: (0.2, 3) and (0, 16).
    brace_angle, brace_restitution : float
        As in `Braces`. Default: no braces.
    critical_angle : float, optional
        As in `System`. Default: None, slender blocks.
    samples : int
        Number of responses at each restitution, in [1, 10⁷], with independent samples. Default: 3,000.
    seed : int
        Random seed in [0, 2³² − 1]. Default: 0.
    max_cycles, max_period : int
        As in `classify`. A response is classified as chaotic after 10⁴ cycles at the earliest (with braces 10⁵).
        Default: 20,000 and 64.
    executor : concurrent.futures.Executor, optional
        Executor that runs the computation. Default: threads on all cores.

    Returns
    -------
    ChaosShare
        `.dataset` and `.shares`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError
        If an argument has the wrong type or lies outside its range.

    See Also
    --------
    classify : Classify one response.
    parametric_map : Classify every point of a grid.
    rocking.plot.chaos_share : Plot the fractions.

    Notes
    -----
    The intervals are Wilson's at 95 %. Their upper ends assume that all undetermined responses are chaotic.
    Not guaranteed: that a chaotic response is an attractor. A longer run may show a chaotic transient.

    There is no store: a thousand responses take seconds, and the same seed reproduces them.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.chaos_share(restitution=[0.5, 0.9], samples=20)
    >>> found.dataset.share.dims
    ('restitution', 'response')
    """
    measure = outcome(max_cycles, max_period, TITLE)
    values = np.atleast_1d(check_quantity("restitution", restitution))
    spans = {"period": span("period", period), "amplitude": span("amplitude", amplitude)}
    fixed = {}
    if brace_angle is not None:
        given = {"brace_angle": brace_angle, "brace_restitution": brace_restitution}
        fixed = {name: within(name, value, *RANGES[name]) for name, value in given.items()}
    elif real("brace_restitution", brace_restitution) != 1.0:
        raise WrongType("brace_restitution", "be used with {brace_angle}", brace_restitution)
    if critical_angle is not None:
        fixed["critical_angle"] = float(check_quantity("critical_angle", critical_angle))
        if brace_angle is not None:
            check_below_flat(fixed["brace_angle"], fixed["critical_angle"])
    count = whole("samples", samples, 1, MAX_SAMPLES)
    random = generator(seed)
    counts = []
    for each in values.tolist():
        drawn = {name: random.uniform(*ends, count) for name, ends in spans.items()}
        kinds = sampled(points(drawn, {"restitution": each, **fixed}), measure, executor)["kind"]
        counts.append(np.bincount(kinds, minlength=len(KINDS)))
    return _summed_up(values, spans, fixed, measure, np.array(counts), seed)


def _summed_up(
    restitutions: np.ndarray,
    spans: dict[str, tuple[float, float]],
    fixed: Any,
    measure: Any,
    counts: np.ndarray,
    seed: int,
) -> ChaosShare:
    import xarray as xr

    of = int(counts[0].sum())
    shares = tuple(Share(each[kernel.CHAOTIC], of, each[kernel.UNDETERMINED]) for each in counts)
    variables: dict[str, Any] = dict(
        interval_variables("chaotic", shares, "restitution", "fraction of chaotic responses")
    )
    variables["share"] = (
        ("restitution", "response"),
        counts / of,
        {"long_name": "fraction of the responses of each kind", "units": "1"},
    )
    coordinates = {
        "restitution": ("restitution", restitutions, coordinate("restitution")),
        "response": ("response", [str(kind) for kind in KINDS], {"long_name": "kind of response"}),
    }
    metadata = attributes(HarmonicSpec({}, dict(fixed)), measure) | {
        "samples": of,
        "seed": seed,
        **{f"{name}_range": list(ends) for name, ends in spans.items()},
    }
    return ChaosShare(xr.Dataset(variables, coordinates, metadata), shares)
