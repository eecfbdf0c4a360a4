"""Whether an experiment can be repeated: what comes of inputs that are off by a little."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from concurrent.futures import Executor
from typing import TypeVar

import numpy as np

from rocking.kernels.classify import verdict_record as kernel
from rocking.model import Kind, Repeatability, Share, State, System, check_start, counted, whole, within
from rocking.response import KINDS
from rocking.survey.basin_map import points_of
from rocking.survey.measures.response import response
from rocking.survey.sampling.perturbation import INPUTS, MAX_RELATIVE, TITLE, perturbed
from rocking.survey.sampling.random_points import MAX_SAMPLES, generator, sampled

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
    """Tell what comes of an experiment whose inputs are off by a little: the share of each outcome, with its interval.

    A, T, e and both numbers of the start are each drawn evenly from within `relative` of themselves, e not above 1. Where that
    goes beyond what A, T or the angle may be, a brace say, they are at that limit. What is zero stays so: a block at rest
    is at rest.

    Parameters
    ----------
    system : System
        What is meant.
    start : State, optional
        Θ and Θ' at τ = 0; at rest by default.
    relative : float
        By which share of itself an input may be off, in [0, 0.5].
    samples : int
        How many experiments, 1 to 10⁷.
    seed : int
        Of the draw, 0 to 2³² − 1.
    max_cycles, max_period : int
        As in `classify`.
    executor : concurrent.futures.Executor, optional
        Who computes: threads on all cores unless given.

    Returns
    -------
    Repeatability
        `.kinds` and `.responses`, shares with their intervals; `print` shows one line.

    Raises
    ------
    TypeError, ValueError
        In one line, for arguments of the wrong type or outside their range.

    See Also
    --------
    repeatability_map : The outcomes at every point of a grid.
    rocking.plot.repeatability : Plot the fractions.

    Notes
    -----
    The intervals are Wilson's at 95 %. What is undetermined after `max_cycles` is no outcome: it may be any, and so widens
    the intervals of all. Two unsymmetric responses that are each other's mirror image count as one.

    There is no store: a thousand runs take seconds, and a seed gives them again.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> print(rk.repeatability(system, samples=200))
    200 runs off by up to 1 %: period 1, symmetric, 2 impacts 100 % (98.1–100 %)
    """
    start = check_start(system, start)
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
    responses = Counter(_told(*each) for each in zip(*columns, strict=True))
    return Repeatability(
        system,
        start,
        off,
        _shares(kinds, unknown, count),
        _shares(responses, unknown, count),
    )


def _shares(counts: Mapping[Name, int], unknown: int, of: int) -> dict[Name, Share]:
    """Shares by name, the largest first; the undetermined, which may belong to any of the others, last."""
    known = sorted((each for each in counts if each != Kind.UNDETERMINED), key=lambda each: -counts[each])
    shares = {name: Share(counts[name], of, unknown) for name in known}
    return shares | {name: Share(unknown, of) for name in counts if name == Kind.UNDETERMINED and unknown}


def _told(kind: int, period: int, symmetric: int, impacts: int) -> str:
    """A response in a few words."""
    if kind != kernel.PERIODIC:
        return str(KINDS[kind])
    many_impacts = "infinitely many impacts" if impacts < 0 else counted(impacts, "impact")
    return f"period {period}, {'symmetric' if symmetric == 1 else 'unsymmetric'}, {many_impacts}"
