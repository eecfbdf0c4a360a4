"""Where the slender model misjudges a block, whatever that does: its proportions, its lifting, its impacts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rocking.model import GRAVITY, Block

SLENDER_ERROR = 0.05
"""Relative error up to which the block counts as slender: θcr = 18°, about three times as high as wide."""


def block_warnings(
    block: Block, amplitudes: Any, restitution: float = 1.0, angle: float | None = None
) -> Iterator[str]:
    """One sentence for each assumption that fails of a block at these `amplitudes`.

    `restitution` is the least that is met, 1 where nothing is hit; `angle` the largest |θ| in radians, θcr unless given.
    """
    yield from _proportions(block, block.critical_angle if angle is None else angle)
    yield from _lifting(block, np.atleast_1d(amplitudes))
    if restitution < block.housner_restitution * (1 - 1e-12):
        yield (
            f"restitution {restitution:.4g} is less than Housner's {block.housner_restitution:.4g}: the base's "
            "impulse at an impact would have to act outside the base"
        )


def slender_errors(block: Block, angle: float) -> tuple[float, float]:
    """Largest δ/sin δ − 1 and 1/cos δ − 1 for |θ| up to `angle`; infinite from δ = −90° on."""
    worst = max(block.critical_angle, angle - block.critical_angle)
    if worst >= math.pi / 2:
        return math.inf, math.inf
    return worst / math.sin(worst) - 1, 1 / math.cos(worst) - 1


def degrees_too(angle: float, digits: int = 3) -> str:
    """An angle in radians, and in degrees."""
    return f"{angle:.{digits}g} rad = {math.degrees(angle):.{digits}g}°"


def _proportions(block: Block, angle: float) -> Iterator[str]:
    moment, push = slender_errors(block, angle)
    if max(moment, push) <= SLENDER_ERROR:
        return
    how = f"the restoring moment is overrated by up to {moment:.1%}, the base's push by up to {push:.1%}"
    if push == math.inf:
        how = "over a right angle from balance its moments do not apply"
    yield f"outside the slender range, θcr = {degrees_too(block.critical_angle)} and |θ| up to {degrees_too(angle)}: {how}"


def _lifting(block: Block, amplitudes: np.ndarray) -> Iterator[str]:
    """Whether some lift the block from rest in the model, a_x > g θcr, but not in truth: a_x ≤ g tan θcr = g B/H."""
    model, truth = block.critical_angle, math.tan(block.critical_angle)
    between = amplitudes[(amplitudes > 1.0) & (amplitudes * model <= truth)]
    if not between.size:
        return
    which = f"{between.size} of the {amplitudes.size} accelerations lie"
    if amplitudes.size == 1:
        which = f"{_acceleration(amplitudes[0] * model)} lies"
    yield (
        f"lifting: the model lifts a standing block beyond {_acceleration(model)}, a real one of this shape lifts only beyond "
        f"{_acceleration(truth)} (g width/height): {which} between, where the real one stands still"
    )


def _acceleration(share: float) -> str:
    return f"{share * GRAVITY:.4g} m/s² = {share:.4g} g"
