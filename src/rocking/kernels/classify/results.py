"""What a survey is told of each of its points: flat arrays, and the way from a judgement into them."""

from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.compile_options import INTERNAL


class ResultArrays(NamedTuple):
    """What the cascade says of each of n points, one flat array a question; as in ``Judgement``."""

    kind: np.ndarray  # (n,), Kind
    ground: np.ndarray  # (n,), Ground
    period: np.ndarray  # (n,), 0 where none
    symmetric: np.ndarray  # (n,), 0 or 1
    impacts: np.ndarray  # (n,), -1 where there are infinitely many or there is no orbit
    brace_hits: np.ndarray  # (n,), likewise
    exponent: np.ndarray  # (n,), NaN where not weighed
    error: np.ndarray  # (n,), likewise
    peak: np.ndarray  # (n,)
    transient: np.ndarray  # (n,), -1 where none is known
    cycles: np.ndarray  # (n,)
    orbit: (
        np.ndarray
    )  # (n, 3): a state of the orbit, (time within the cycle, angle, velocity); NaN where none


def empty_results(count):
    """Room for the answers of ``count`` points."""
    return ResultArrays(
        *(np.zeros(count, np.uint8) for _ in range(2)),
        np.zeros(count, np.int32),
        np.zeros(count, np.uint8),
        *(np.zeros(count, np.int32) for _ in range(2)),
        *(np.zeros(count) for _ in range(3)),
        *(np.zeros(count, np.int32) for _ in range(2)),
        np.zeros((count, 3)),
    )


@njit(**INTERNAL)
def store_result(answers, k, told):
    """Write what was judged of point k."""
    answers.kind[k], answers.ground[k] = told[0], told[1]
    answers.period[k], answers.symmetric[k] = told[2], told[3]
    answers.impacts[k], answers.brace_hits[k] = told[4], told[5]
    answers.exponent[k], answers.error[k], answers.peak[k] = told[10], told[11], told[12]
    answers.transient[k], answers.cycles[k] = told[14], told[15]
    answers.orbit[k, 0], answers.orbit[k, 1], answers.orbit[k, 2] = told[17], told[18], told[19]
