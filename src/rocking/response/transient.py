"""Transient of a classified response, the same for one verdict and for a batch of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from rocking.kernels.classify import results
from rocking.kernels.classify import verdict_record as kernel


def transient_of(judged: kernel.Judgement | results.ResultArrays) -> Any:
    """Return the cycles after which a response was reached at the latest, as an integer or an array; -1 if unknown.

    A block that never moves has no transient. The decision sequence itself gives the cycle of the checkpoint at which rest was
    proved. If a block overturns, the cycles before that of the proof count.
    """
    # Rest after a motion needs an event, which `work` counts.
    unmoved = np.equal(judged.kind, kernel.REST) & np.equal(judged.work, 0)
    before_proof = np.maximum(np.subtract(judged.cycles, 1), 0)
    moved = np.where(np.equal(judged.kind, kernel.OVERTURNS), before_proof, judged.transient)
    return np.where(unmoved, 0, moved)
