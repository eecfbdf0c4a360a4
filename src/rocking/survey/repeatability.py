"""Whether an experiment can be repeated: what comes of inputs that are off by a little, at a point and over a map."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import Executor
from typing import Any

import numpy as np

from rocking.kernels import judgement as kernel
from rocking.kernels import many
from rocking.model import (
    FREQUENCIES,
    LARGEST_AMPLITUDE,
    Repeatability,
    RepeatabilityMap,
    Share,
    State,
    System,
    check_start,
    whole,
    within,
)
from rocking.survey.ask import ask
from rocking.survey.axes import SYSTEM, Points, question
from rocking.survey.basins import points_of
from rocking.survey.maps import MOST_CYCLES, MOST_PERIOD
from rocking.survey.outcomes import KIND, KINDS
from rocking.survey.responses import response
from rocking.survey.samples import MOST_SAMPLES, MOST_SEED, sampled
from rocking.survey.tiles import Arrays, Measure, Variable

TITLE = "Repeatability of the response of a free-standing block on a shaking base"
LARGEST_RELATIVE = 0.5
MILLIONTH = 1e-6
INPUTS = 5
"""A, T, e, Θ and Θ' at the start."""
MOST_AT_A_POINT = 1_000


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

    A, T, e and both numbers of the start are each drawn evenly from within `relative` of themselves, e not above 1. What is
    zero stays so: a block at rest is at rest.

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

    Notes
    -----
    The intervals are Wilson's at 95 %. Two unsymmetric responses that are each other's mirror image count as one.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> print(rk.repeatability(system, samples=200))
    200 runs off by up to 1 %: period 1, symmetric, 2 impacts 100.0 % (98.1–100.0 %)
    """
    start = State() if start is None else start
    check_start(system, start)
    off = within("relative", relative, 0, LARGEST_RELATIVE)
    count = whole("samples", samples, 1, MOST_SAMPLES)
    measure = response(
        whole("max_cycles", max_cycles, 1, MOST_CYCLES),
        whole("max_period", max_period, 1, MOST_PERIOD),
        TITLE,
    )
    random = np.random.default_rng(whole("seed", seed, 0, MOST_SEED))
    meant = points_of(system, np.tile([start.angle, start.velocity], (count, 1)))
    answers = sampled(disturbed(meant, random.uniform(-1.0, 1.0, (count, INPUTS)), off), measure, executor)
    kinds = Counter(KINDS[k] for k in answers["kind"].tolist())
    columns = (
        answers[name].tolist() for name in ("kind", "response_period", "symmetric", "impacts_per_period")
    )
    responses = Counter(_told(*each) for each in zip(*columns, strict=True))
    return Repeatability(
        system,
        start,
        off,
        {kind: Share(number, count) for kind, number in kinds.most_common()},
        {name: Share(number, count) for name, number in responses.most_common()},
    )


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

    Notes
    -----
    Not guaranteed: that a point at which all experiments agree is certain; an outcome with a share p is missed by
    (1 − p)ⁿ of n experiments. The intervals of the shares are those of as many random points.

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
    off = round(within("relative", relative, 0, LARGEST_RELATIVE) / MILLIONTH)
    options = {
        "max_cycles": whole("max_cycles", max_cycles, 1, MOST_CYCLES),
        "max_period": whole("max_period", max_period, 1, MOST_PERIOD),
        "samples": whole("samples", samples, 2, MOST_AT_A_POINT),
        "relative_millionths": off,
    }
    measure = Measure(TITLE, judge, many.compile_many, VARIABLES, options, many.METHOD, shares="kind")
    found = ask(asked, measure, store, executor, progress=progress, repair=repair).load()
    found.attrs["relative"] = off * MILLIONTH
    uncertain = np.count_nonzero(found.agreeing.values < 1.0)
    fallen = found.overturned.values
    divided = np.count_nonzero((fallen > 0.0) & (fallen < 1.0))
    return RepeatabilityMap(found, Share(uncertain, asked.points), Share(divided, asked.points))


VARIABLES = (
    Variable(
        "kind", KIND.dtype, KIND.fill, KIND.attributes | {"long_name": "most frequent kind of response"}
    ),
    Variable("overturned", "float32", -1.0, {"long_name": "share of the runs that overturn", "units": "1"}),
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
        tried = disturbed(
            at, np.tile(units, (len(at.systems), 1)), options["relative_millionths"] * MILLIONTH
        )
        told = many.judge_many(*tried, options["max_cycles"], options["max_period"], stop)
        if told is None:
            return None
        counts[np.arange(len(counts)), told.kind] += 1
    shares = (counts / options["samples"]).astype(np.float32)
    return {
        "kind": counts.argmax(axis=1).astype(np.uint8),
        "overturned": shares[:, kernel.OVERTURNS],
        "agreeing": shares.max(axis=1),
    }


def spread(count: int) -> np.ndarray:
    """Points (count, INPUTS) spread evenly over [-1, 1]: multiples of powers of the root of g⁶ = g + 1, modulo one."""
    root = 1.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (INPUTS + 1))
    steps = root ** -np.arange(1.0, INPUTS + 1)
    return 2.0 * ((0.5 + np.arange(count)[:, None] * steps) % 1.0) - 1.0


def disturbed(meant: Points, units: np.ndarray, off: float) -> Points:
    """Points (n) with A, T, e, Θ and Θ' off by that share of themselves times `units` (n, INPUTS), which lie in [-1, 1]."""
    factors = 1.0 + off * units
    systems, starts = meant.systems.copy(), meant.starts.copy()
    place = {name: k for k, name in enumerate(SYSTEM)}
    amplitude, period, restitution = (
        systems[:, place[name]] for name in ("amplitude", "period", "restitution")
    )
    np.minimum(amplitude * factors[:, 0], LARGEST_AMPLITUDE, out=amplitude)
    shortest, longest = (np.float64(2.0 * np.pi) / each for each in FREQUENCIES[::-1])
    np.clip(period * factors[:, 1], shortest, longest, out=period)
    systems[:, place["frequency"]] = 2.0 * np.pi / period
    # drawn evenly from what is possible
    low, high = restitution * (1.0 - off), np.minimum(restitution * (1.0 + off), 1.0)
    restitution[:] = 0.5 * (low + high) + 0.5 * (high - low) * units[:, 2]
    reach = systems[:, place["brace_angle"]]
    starts[:, 0] = np.clip(starts[:, 0] * factors[:, 3], -reach, reach)
    starts[:, 1] *= factors[:, 4]
    return Points(systems, starts)


def _told(kind: int, period: int, symmetric: int, impacts: int) -> str:
    """A response in a few words."""
    if kind != kernel.PERIODIC:
        return str(KINDS[kind])
    many_impacts = "with rest" if impacts < 0 else f"{impacts} impact{'s' * (impacts != 1)}"
    return f"period {period}, {'symmetric' if symmetric == 1 else 'unsymmetric'}, {many_impacts}"
