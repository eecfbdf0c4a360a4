"""Many systems, one after another, without Python in between: what a survey asks of a tile."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from .desk import desk
from .elementary import ENTRY
from .parameters import make
from .verdict import judge

# The version of what is answered: raised whenever an answer to the same question may change, so that a store never mixes two.
METHOD = 1


class Answers(NamedTuple):
    """What the cascade says of each of n points, one flat array a question; as in ``Judgement``."""

    kind: np.ndarray  # (n,), Kind
    ground: np.ndarray  # (n,), Ground
    period: np.ndarray  # (n,), 0 where none
    symmetric: np.ndarray  # (n,), 0 or 1
    impacts: np.ndarray  # (n,), -1 where they accumulate or there is no orbit
    brace_hits: np.ndarray  # (n,), likewise
    exponent: np.ndarray  # (n,), NaN where not weighed
    error: np.ndarray  # (n,), likewise
    peak: np.ndarray  # (n,)
    transient: np.ndarray  # (n,), -1 where none is known
    cycles: np.ndarray  # (n,)
    orbit: (
        np.ndarray
    )  # (n, 3): a state of the orbit, (time within the cycle, angle, velocity); NaN where none


def no_answers(count):
    """Room for the answers of ``count`` points."""
    return Answers(
        *(np.zeros(count, np.uint8) for _ in range(2)),
        np.zeros(count, np.int32),
        np.zeros(count, np.uint8),
        *(np.zeros(count, np.int32) for _ in range(2)),
        *(np.zeros(count) for _ in range(3)),
        *(np.zeros(count, np.int32) for _ in range(2)),
        np.zeros((count, 3)),
    )


@njit(**ENTRY)
def judge_each(systems, starts, max_cycles, max_period, memory, answers, stop):
    """How many points were judged: all, unless ``stop[0]`` was set on the way.

    A row of ``systems`` is what ``make`` takes, a row of ``starts`` (angle, velocity).
    """
    for k in range(systems.shape[0]):
        if stop[0] != 0:
            return k
        p = make(
            systems[k, 0],
            systems[k, 1],
            systems[k, 2],
            systems[k, 3],
            systems[k, 4],
            systems[k, 5],
            systems[k, 6],
        )
        judged = judge(p, starts[k, 0], starts[k, 1], max_cycles, max_period, memory)
        answers.kind[k], answers.ground[k] = judged[0], judged[1]
        answers.period[k], answers.symmetric[k] = judged[2], judged[3]
        answers.impacts[k], answers.brace_hits[k] = judged[4], judged[5]
        answers.exponent[k], answers.error[k], answers.peak[k] = judged[10], judged[11], judged[12]
        answers.transient[k], answers.cycles[k] = judged[14], judged[15]
        answers.orbit[k, 0], answers.orbit[k, 1], answers.orbit[k, 2] = judged[17], judged[18], judged[19]
    return systems.shape[0]


def judge_many(systems, starts, max_cycles, max_period, stop):
    """``Answers`` for points (n, 7) and (n, 2); None where ``stop`` (1,) was set by another thread on the way."""
    answers = no_answers(len(systems))
    judged = judge_each(systems, starts, max_cycles, max_period, desk(max_cycles, max_period), answers, stop)
    return answers if judged == len(systems) else None


def compile_many():
    """Compile, or load, what ``judge_many`` runs: a process that ends while another thread compiles may crash."""
    still = np.array([[0.0, 1.0, math.tau, 0.0, 0.0, math.inf, 1.0]])
    judge_many(still, np.zeros((1, 2)), 1, 1, np.zeros(1, np.int64))
