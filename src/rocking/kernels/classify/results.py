"""Result arrays of a batch, and the conversion of a verdict into them."""

from typing import NamedTuple

import numpy as np

from rocking.kernels.classify.verdict_record import Judgement
from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.signature import Bytes1, Counts1, Floats1, Integers1, resolve, types_of


class ResultArrays(NamedTuple):
    """Classification of n points, one flat array per field of ``Judgement``."""

    kind: Bytes1  # (n,), Kind
    ground: Bytes1  # (n,), Ground
    period: Counts1  # (n,), 0 if there is none
    symmetric: Bytes1  # (n,), 0 or 1
    impacts: Counts1  # (n,), -1 if there are infinitely many or there is no orbit
    brace_hits: Counts1  # (n,), as for impacts
    real: Floats1  # (n,), the multipliers of the orbit: real and imaginary part of both
    imaginary: Floats1
    other_real: Floats1
    other_imaginary: Floats1
    exponent: Floats1  # (n,), NaN if not measured
    error: Floats1  # (n,), standard error of the exponent
    peak: Floats1  # (n,)
    steady_peak: Floats1  # (n,)
    transient: Counts1  # (n,), -1 if unknown
    cycles: Counts1  # (n,)
    work: Integers1  # (n,), events computed
    section_time: (
        Floats1  # (n,), time of a state of the orbit, NaN if there is none; then its angle and velocity
    )
    angle: Floats1
    velocity: Floats1
    residual: Floats1
    distance: Floats1
    excess: Floats1
    digits: Floats1


# Found once: the annotations of a class take longer to read than the arrays to allocate.
DTYPES = tuple(resolve(kind, None).dtype for kind in types_of(ResultArrays))


def empty_results(count):
    """Return result arrays for ``count`` points."""
    return ResultArrays(*(np.zeros(count, dtype) for dtype in DTYPES))


def judgement_of(results, k):
    """Return the verdict on point k."""
    kinds = Judgement.__annotations__.values()
    return Judgement(*(kind(values[k]) for kind, values in zip(kinds, results, strict=True)))


@njit(**INTERNAL)
def store_result(results, k, verdict):
    """Write the verdict on point k."""
    found = Judgement(*verdict)
    results.kind[k], results.ground[k] = found.kind, found.ground
    results.period[k], results.symmetric[k] = found.period, found.symmetric
    results.impacts[k], results.brace_hits[k] = found.impacts, found.brace_hits
    results.real[k], results.imaginary[k] = found.real, found.imaginary
    results.other_real[k], results.other_imaginary[k] = found.other_real, found.other_imaginary
    results.exponent[k], results.error[k] = found.exponent, found.error
    results.peak[k], results.steady_peak[k] = found.peak, found.steady_peak
    results.transient[k], results.cycles[k], results.work[k] = found.transient, found.cycles, found.work
    results.section_time[k], results.angle[k], results.velocity[k] = (
        found.section_time,
        found.angle,
        found.velocity,
    )
    results.residual[k], results.distance[k] = found.residual, found.distance
    results.excess[k], results.digits[k] = found.excess, found.digits
