"""Result arrays of a batch, and the conversion of a verdict into them."""

from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.classify.verdict_record import Judgement
from rocking.kernels.compile_options import INTERNAL


class ResultArrays(NamedTuple):
    """Classification of n points, one flat array per field of ``Judgement``."""

    kind: np.ndarray  # (n,), Kind
    ground: np.ndarray  # (n,), Ground
    period: np.ndarray  # (n,), 0 if there is none
    symmetric: np.ndarray  # (n,), 0 or 1
    impacts: np.ndarray  # (n,), -1 if there are infinitely many or there is no orbit
    brace_hits: np.ndarray  # (n,), as for impacts
    exponent: np.ndarray  # (n,), NaN if not measured
    error: np.ndarray  # (n,), standard error of the exponent
    peak: np.ndarray  # (n,)
    transient: np.ndarray  # (n,), -1 if unknown
    cycles: np.ndarray  # (n,)
    orbit: (
        np.ndarray
    )  # (n, 3): a state of the orbit, (time within the cycle, angle, velocity); NaN if there is none


def empty_results(count):
    """Return result arrays for ``count`` points."""
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
def store_result(results, k, verdict):
    """Write the verdict on point k."""
    found = Judgement(*verdict)
    results.kind[k], results.ground[k] = found.kind, found.ground
    results.period[k], results.symmetric[k] = found.period, found.symmetric
    results.impacts[k], results.brace_hits[k] = found.impacts, found.brace_hits
    results.exponent[k], results.error[k], results.peak[k] = found.exponent, found.error, found.peak
    results.transient[k], results.cycles[k] = found.transient, found.cycles
    results.orbit[k, 0], results.orbit[k, 1], results.orbit[k, 2] = (
        found.section_time,
        found.angle,
        found.velocity,
    )
