"""Limits of the slender-block model for a given block: proportions, lift-off and impacts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY

MAX_HEIGHT = 30.0
"""Height in m above which the size of a block was possibly not given in metres."""
SLENDER_ERROR = 0.05
"""Relative error up to which a block counts as slender: θcr = 18°, a height of about three times the width."""


def block_warnings(
    block: Block,
    amplitudes: Any,
    restitution: float = 1.0,
    angle: float | None = None,
    *,
    full: bool = False,
) -> Iterator[str]:
    """Yield one sentence for each assumption that does not hold for a block at the given amplitudes.

    Parameters
    ----------
    block : Block
        Block.
    amplitudes : float or array
        Normalised amplitudes A.
    restitution : float
        Smallest coefficient of restitution in use; 1 without impacts. Default: 1.
    angle : float, optional
        Largest |θ| in radians. Default: θcr.
    full : bool
        Flag: the equation of motion is the full one, which needs no slender block. Default: False.

    Yields
    ------
    str
        Warning.
    """
    yield from height_warnings(block.height)
    if not full:
        yield from proportion_warnings(block.critical_angle, block.critical_angle if angle is None else angle)
        yield from _lifting(block, np.atleast_1d(amplitudes))
    yield from impact_warnings(block, restitution)


def height_warnings(height: float) -> Iterator[str]:
    """Yield a warning for a height in m that was possibly given in another unit."""
    if height > MAX_HEIGHT:
        yield f"height {height:.4g} m is unusual: sizes are in metres"


def impact_warnings(block: Block, restitution: float) -> Iterator[str]:
    """Yield a warning if the smallest coefficient of restitution in use is impossible for a block that turns about its edges."""
    if restitution < block.housner_restitution * (1 - 1e-12):
        yield (
            f"restitution {restitution:.4g} is less than Housner's {block.housner_restitution:.4g}: the impulse at an "
            "impact would have to act outside the bottom face of the block"
        )


def slender_errors(critical_angle: float, angle: float) -> tuple[float, float]:
    """Return the largest δ/sin δ − 1 and 1/cos δ − 1, δ = θcr − |θ|, for |θ| up to `angle`; infinite beyond δ = −90°."""
    worst = max(critical_angle, angle - critical_angle)
    if worst >= math.pi / 2:
        return math.inf, math.inf
    return worst / math.sin(worst) - 1, 1 / math.cos(worst) - 1


def degrees_too(angle: float, digits: int = 3) -> str:
    """Format an angle in radians and in degrees."""
    return f"{angle:.{digits}g} rad = {math.degrees(angle):.{digits}g}°"


def proportion_warnings(critical_angle: float, angle: float) -> Iterator[str]:
    """Yield a warning for a block that is not slender, with the errors of the slender-block model for |θ| up to `angle`."""
    moment, push = slender_errors(critical_angle, angle)
    if max(moment, push) <= SLENDER_ERROR:
        return
    how = f"the restoring moment is overestimated by up to {moment:.1%}, that of the base acceleration by up to {push:.1%}"
    if push == math.inf:
        how = "the slender-block model does not apply beyond 90° from the balance point"
    yield f"outside the slender range, θcr = {degrees_too(critical_angle)} and |θ| up to {degrees_too(angle)}: {how}"


def _lifting(block: Block, amplitudes: np.ndarray) -> Iterator[str]:
    """Yield a warning for amplitudes that lift off the slender model, a_x > g θcr, but not the real block, a_x ≤ g B/H."""
    model, truth = block.critical_angle, math.tan(block.critical_angle)
    between = amplitudes[(amplitudes > 1.0) & (amplitudes * model <= truth)]
    if not between.size:
        return
    which = f"{between.size} of the {amplitudes.size} accelerations lie"
    if amplitudes.size == 1:
        which = f"{_acceleration(amplitudes[0] * model)} lies"
    yield (
        f"lift-off: the model lifts a resting block off above {_acceleration(model)}, a real block of this shape only above "
        f"{_acceleration(truth)} (g width/height); {which} between, where the real block remains at rest"
    )


def _acceleration(share: float) -> str:
    return f"{share * GRAVITY:.4g} m/s² = {share:.4g} g"
