"""Repeatability of an experiment: outcomes of runs with slightly perturbed inputs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from concurrent.futures import Executor
from typing import TypeVar

import numpy as np

from rocking.kernels.classify import verdict_record as kernel
from rocking.model.share import Share
from rocking.model.survey_results import Repeatability
from rocking.model.system import State, System, check_periodic
from rocking.model.text import counted
from rocking.model.validation import whole, within
from rocking.model.verdict import Kind
from rocking.response.classify import KINDS
from rocking.survey.measures.response import response
from rocking.survey.sampling.perturbation import INPUTS, MAX_RELATIVE, TITLE, perturbed
from rocking.survey.sampling.random_points import MAX_SAMPLES, generator, sampled
from rocking.survey.system_points import points_of

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
    executor: Executor | None = None,
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
    executor : concurrent.futures.Executor, optional
        Executor that runs the computation. Default: threads on all cores.

    Returns
    -------
    Repeatability
        `.kinds` and `.responses`, fractions with their intervals; `print` shows one line.

    Raises
    ------
    TypeError, ValueError
        If an argument has the wrong type or lies outside its range.

    See Also
    --------
    repeatability_map : The outcomes at every point of a grid.
    rocking.plot.repeatability : Plot the fractions.

    Notes
    -----
    The intervals are Wilson's at 95 %. A run that is undetermined after `max_cycles` may have any outcome, so that it
    raises the upper ends of all intervals. An asymmetric response and its mirror image count as one.

    There is no store: a thousand runs take seconds, and the same seed reproduces them.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> print(rk.repeatability(system, samples=200))
    200 runs with inputs off by up to 1 %: period 1, symmetric, 2 impacts 100 % (98.1–100 %)
    """
    start = check_periodic(system, start)
    off = within("relative", relative, 0, MAX_RELATIVE)
    count = whole("samples", samples, 1, MAX_SAMPLES)
    measure = response(max_cycles, max_period, TITLE)
    random = generator(seed)
    meant = points_of(system, np.tile([start.angle, start.velocity], (count, 1)))
    answers = sampled(perturbed(meant, random.uniform(-1.0, 1.0, (count, INPUTS)), off), measure, executor)
    kinds = Counter(KINDS[k] for k in answers["kind"].tolist())
    unknown = kinds[Kind.UNDETERMINED]
    columns = (
        answers[name].tolist() for name in ("kind", "response_period", "symmetric", "impacts_per_period")
    )
    return Repeatability(
        system,
        start,
        off,
        _shares(kinds, unknown, count),
        _shares(Counter(_told(*each) for each in zip(*columns, strict=True)), unknown, count),
    )


def _shares(counts: Mapping[Name, int], unknown: int, of: int) -> dict[Name, Share]:
    """Return fractions by name in descending order; undetermined runs, which may belong to any other, come last."""
    known = sorted((each for each in counts if each != Kind.UNDETERMINED), key=lambda each: -counts[each])
    shares = {name: Share(counts[name], of, unknown) for name in known}
    return shares | {name: Share(unknown, of) for name in counts if name == Kind.UNDETERMINED and unknown}


def _told(kind: int, period: int, symmetric: int, impacts: int) -> str:
    """Return a short description of a response."""
    if kind != kernel.PERIODIC:
        return str(KINDS[kind])
    many_impacts = "infinitely many impacts" if impacts < 0 else counted(impacts, "impact")
    return f"period {period}, {'symmetric' if symmetric == 1 else 'asymmetric'}, {many_impacts}"
