"""Uncertainty exponents of the basin boundaries of a system, from triples of initial states."""

from __future__ import annotations

import math
from concurrent.futures import Executor

import numpy as np
from attrs import frozen

from rocking.kernels.classify import verdict_record as kernel
from rocking.model.survey_results import UncertaintyExponent
from rocking.model.system import System
from rocking.survey.measurement import Measurement
from rocking.survey.measures.attractors import label_attractors
from rocking.survey.sampling.random_points import MAX_SAMPLES, sampled
from rocking.survey.sampling.uncertainty_exponent import distances, exponent, perturbed_triples
from rocking.survey.system_points import points_of

Exponents = tuple[UncertaintyExponent | None, UncertaintyExponent | None]
WIDTHS = (1e-4, 1.0)
# Further runs beyond the number that the width so far suggests, and the largest factor at once: a first width is uncertain.
SPARE, AT_ONCE = 1.2, 8.0
# Largest ratio of the widths after and before more runs, of which there are at least this many as before; about one half is usual.
NARROWER, LEAST = 0.85, 2.0


@frozen
class Boundaries:
    """Boundaries of the basins of a system, in a range of initial states from ``low`` to ``high``."""

    system: System
    low: tuple[float, float]
    high: tuple[float, float]
    random: np.random.Generator
    measure: Measurement
    executor: Executor | None
    progress: bool

    def exponents(self, runs: int, width: float) -> Exponents:
        """Return the uncertainty exponents of the boundary of overturning and of all boundaries.

        Runs are added until both intervals are narrower than ``width``. Where the fractions follow no power law, further runs do
        not narrow an interval, and none are added. An exponent without enough uncertain states is None.
        """
        if runs == 0:
            return None, None
        found, starts = self._followed(runs)
        before = math.inf
        while True:
            both = self._fitted(found, starts)
            widest = max((one.high - one.low for one in both if one is not None), default=0.0)
            if widest <= width or widest > NARROWER * before or starts.size // 2 >= MAX_SAMPLES:
                return both
            before = widest
            wanted = starts.size // 2 * min(max(SPARE * (widest / width) ** 2, LEAST), AT_ONCE)
            more, others = self._followed(int(min(wanted, MAX_SAMPLES)) - starts.size // 2)
            joined = {name: _appended(found[name], more[name], starts.shape, others.shape) for name in found}
            found, starts = joined, np.concatenate([starts, others], axis=1)

    def _followed(self, runs: int) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Return the results of new triples of initial states, and the states (distances, n, 3, 2)."""
        tried = perturbed_triples(self.low, self.high, runs, self.random)
        starts = tried.reshape(-1, 2)
        if self.system.braces is not None:
            starts[:, 0] = np.clip(starts[:, 0], -self.system.braces.angle, self.system.braces.angle)
        shown = "boundary runs" if self.progress else ""
        return sampled(points_of(self.system, starts), self.measure, self.executor, shown), tried

    def _fitted(self, found: dict[str, np.ndarray], starts: np.ndarray) -> Exponents:
        labels, _ = label_attractors(self.system, found)
        (a, c), (b, d) = self.low, self.high
        reach = distances((b - a, d - c))
        overturned = (found["kind"] == kernel.OVERTURNS).reshape(starts.shape[:3])
        return exponent(reach, overturned), exponent(reach, labels.reshape(starts.shape[:3]))


def _appended(
    before: np.ndarray, more: np.ndarray, shape: tuple[int, ...], added: tuple[int, ...]
) -> np.ndarray:
    """Return results of triples with more of them at each distance."""
    rest = before.shape[1:]
    return np.concatenate(
        [before.reshape(*shape[:3], *rest), more.reshape(*added[:3], *rest)], axis=1
    ).reshape(-1, *rest)
