"""Classification of points, also of none."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rocking.kernels import batch
from rocking.kernels.classify import attractor_anchor, results
from rocking.survey.harmonic_spec import Points


def verdicts(points: Points, options: Mapping[str, int], stop: np.ndarray) -> results.ResultArrays | None:
    """Return the verdicts at points, with the conventions of `classify`; None if another thread sets `stop`."""
    found: results.ResultArrays | None = batch.classify_batch(
        *points, options["max_cycles"], options["max_period"], stop
    )
    return found


def anchors(points: Points, judged: results.ResultArrays) -> np.ndarray:
    """Return a representative state (n, 2) of the orbit at each point; NaN if there is none."""
    return np.asarray(attractor_anchor.anchors_of(*points, judged))
