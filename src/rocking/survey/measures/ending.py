"""Measurement of surveys of ground motions: how a run ends, its largest angle and its margin."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise, starmap

import numpy as np

from rocking.kernels.forcing import parameters as numbers
from rocking.kernels.march import ending as ends
from rocking.kernels.march import finite_runs as kernel
from rocking.kernels.march import march
from rocking.model.forcing import PiecewiseLinear
from rocking.model.verdict import Outcome
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.motion_spec import Runs

METHOD = 7
"""Version of the method; a change of the results increases it."""
OUTCOMES = tuple(Outcome)
UNDECIDED, CERTIFIED, NOT_ASSESSED = range(3)
"""Codes of the effect of rounding errors on an outcome."""
OVERTURNED = OUTCOMES.index(Outcome.OVERTURNED)
CODES = {
    march.OVERTURNED: OVERTURNED,
    march.STILL: OUTCOMES.index(Outcome.AT_REST),
}

VARIABLES = (
    Variable(
        "outcome",
        "uint8",
        255,
        {
            "long_name": "end of the motion",
            "flag_values": np.arange(len(OUTCOMES), dtype=np.uint8),
            "flag_meanings": " ".join(OUTCOMES),
        },
    ),
    Variable(
        "certified",
        "uint8",
        255,
        {
            "long_name": "whether no rounding error can have changed the outcome",
            "flag_values": np.arange(3, dtype=np.uint8),
            "flag_meanings": "undecided certified not-assessed",
        },
    ),
    Variable(
        "peak",
        "float64",
        -1.0,
        {
            "long_name": "largest absolute angle in units of theta_cr",
            "units": "1",
            "comment": "infinite if the block overturns",
        },
    ),
    Variable(
        "margin",
        "float64",
        math.inf,
        {
            "long_name": "K+ of least size over all lift-offs and impacts",
            "units": "1",
            "comment": "negative: lacked to overturn there; NaN: the block never moves",
        },
    ),
    Variable(
        "impacts_since_rest",
        "int32",
        -2,
        {"long_name": "impacts since the block last rested", "comment": "0: overturned without impact"},
    ),
    Variable("impacts", "int32", -2, {"long_name": "impacts", "comment": "chattering is cut short"}),
)


def ending(title: str, *, with_peak: bool = True) -> Measurement:
    """Return the measurement of the end of a motion; without the peak, which is then NaN, it takes half the time."""
    return Measurement(title, judge, VARIABLES, {"with_peak": int(with_peak)}, METHOD, shares="outcome")


def judge(runs: Runs, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Follow runs to their ends; None if another thread sets `stop`. Neighbours with the same record and α share tables."""
    with_peak = bool(options["with_peak"])
    rows, asked = np.empty(runs.record.size, ends.ENDING_ROW), np.empty(runs.record.size, kernel.RUN_ROW)
    asked["restitution"], asked["angle"] = runs.restitution, runs.angle
    asked["critical_angle"] = runs.slenderness
    for part in alike(runs):
        motion, alpha = (
            runs.motions[int(runs.record[part.start])],
            float(runs.frequency_parameter[part.start]),
        )
        base = motion.normalised(1.0, alpha)
        asked["scale"][part] = base.scale * runs.factor[part]
        p = sampled(base, full=runs.full)
        if not kernel.run_batch(p, asked[part], with_peak, rows[part], stop):
            return None
    return answers(rows, with_peak=with_peak, assessed=not runs.full)


def sampled(base: PiecewiseLinear, *, full: bool) -> numbers.AnySampledParameters:
    """Return parameters with the tables of a base motion, for runs of any blocks of one kind."""
    tables, length = numbers.tables_of(base.values, base.step), numbers.CYCLE * base.step
    if full:
        return numbers.full_sampled_parameters(numbers.full_block(1.0, 1.0), tables, 1.0, length)
    return numbers.sampled_parameters(tables, 1.0, length, 1.0)


def alike(runs: Runs) -> Iterator[slice]:
    """Yield the stretches of neighbouring points that share the tables of a record."""
    if not runs.record.size:
        return
    differs = (np.diff(runs.record) != 0) | (np.diff(runs.frequency_parameter) != 0)
    edges = [0, *(np.flatnonzero(differs) + 1).tolist(), runs.record.size]
    yield from starmap(slice, pairwise(edges))


def answers(rows: np.ndarray, *, with_peak: bool, assessed: bool) -> Arrays:
    """Return the variables of the rows of the kernel; `assessed` says whether it considers rounding errors."""
    outcome = np.zeros(rows.size, np.uint8)
    for status, code in CODES.items():
        outcome[rows["status"] == status] = code
    certified = ((rows["decided"] != 0) & (rows["status"] != march.CROWDED)).astype(np.uint8)
    peak = np.where(outcome == OVERTURNED, math.inf, rows["peak"] if with_peak else math.nan)
    return {
        "outcome": outcome,
        "certified": certified if assessed else np.full_like(certified, NOT_ASSESSED),
        "peak": peak,
        "margin": rows["margin"],
        "impacts_since_rest": rows["since_rest"].astype(np.int32),
        "impacts": rows["impacts"].astype(np.int32),
    }
