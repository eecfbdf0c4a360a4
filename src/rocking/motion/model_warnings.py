"""Limits of the slender-block model for a given block: proportions, lift-off and impacts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY, acceleration_unit_g

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
    left_restitution: float | None = None,
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
        Largest |θ| in radians. Default: θcr, of a restrained block its unstable balance.
    left_restitution : float, optional
        Smallest coefficient of restitution of impacts from the side θ < 0; `restitution` is then that of the others. Default:
        `restitution`.
    full : bool
        Flag: the equation of motion is the full one, which needs no slender block. Default: False.

    Yields
    ------
    str
        Warning.
    """
    yield from height_warnings(block.height)
    if not full:
        right, left = block.critical_angles
        balance = block.angle_unit if block.by_balance else max(right, left)
        yield from proportion_warnings(right, balance if angle is None else angle, block.normalised_by, left)
        if block.normalised_by != "tangent":
            yield from _lifting(block, np.atleast_1d(amplitudes))
    yield from impact_warnings(block, restitution, left_restitution)


def restrained_warnings(block: Block, peak: float, restitution: float) -> Iterator[str]:
    """Yield a sentence on what is not checked for a restrained block, and one for each assumption that does not hold.

    They are for its largest |Θ| and for the smallest coefficient of restitution in use.
    """
    yield "sliding and jumping of a restrained block are not checked"
    reached = float(block.radians(min(peak, 1.0)))
    yield from block_warnings(block, (), restitution, angle=reached, full=not block.by_balance)


def height_warnings(height: float) -> Iterator[str]:
    """Yield a warning for a height in m that was possibly given in another unit."""
    if height > MAX_HEIGHT:
        yield f"height {height:.4g} m is unusual: sizes are in metres"


def impact_warnings(block: Block, restitution: float, left: float | None = None) -> Iterator[str]:
    """Yield a warning if the smallest coefficient of restitution in use is impossible for a block that turns about its edges.

    Of a block with unequal sides, that of the impacts from each side is compared with its own Housner value. Against a wall any is
    possible.
    """
    if block.wall is not None:
        return
    ends = restitution, restitution if left is None else left
    sides = [*zip(ends, block.housner_restitutions, (" after θ > 0", " after θ < 0"), strict=True)]
    if block.left is None:
        sides = [(min(ends), block.housner_restitution, "")]
    for used, least, where in sides:
        if used < least * (1 - 1e-12):
            yield (
                f"restitution {used:.4g}{where} is less than Housner's {least:.4g}: the impulse at an "
                "impact would have to act outside the bottom face of the block"
            )


def slender_errors(
    critical_angle: float, angle: float, normalised_by: str = "angle", left_angle: float | None = None
) -> tuple[float, float]:
    """Return the largest δ/sin δ − 1 and |u/cos δ − 1|, δ = θcr − |θ|, for |θ| up to `angle`; infinite beyond δ = −90°.

    u is 1 if the base acceleration is normalised by the angle, and θcr/tan θcr if it is normalised by the tangent. The critical angle
    of side 2, if it differs, is `left_angle`; its u is that of side 1.
    """
    sides = critical_angle, critical_angle if left_angle is None else left_angle
    worst, least = max(*sides, angle - min(sides)), max(min(sides) - angle, 0.0)
    if worst >= math.pi / 2:
        return math.inf, math.inf
    unit = critical_angle / acceleration_unit_g(critical_angle, normalised_by)
    moment, push = worst / math.sin(worst) - 1, unit / math.cos(worst) - 1
    return moment, max(push, 1 - unit / math.cos(least)) if normalised_by == "tangent" else push


def degrees_too(angle: float, digits: int = 3) -> str:
    """Format an angle in radians and in degrees."""
    return f"{angle:.{digits}g} rad = {math.degrees(angle):.{digits}g}°"


def proportion_warnings(
    critical_angle: float, angle: float, normalised_by: str = "angle", left_angle: float | None = None
) -> Iterator[str]:
    """Yield a warning for a block that is not slender, with the errors of `slender_errors`."""
    moment, push = slender_errors(critical_angle, angle, normalised_by, left_angle)
    if max(moment, push) <= SLENDER_ERROR:
        return
    how = f"the restoring moment is overestimated by up to {moment:.1%}, that of the base acceleration {off(normalised_by)} {push:.1%}"
    if push == math.inf:
        how = "the slender-block model does not apply beyond 90° from the balance point"
    widest = max(critical_angle, left_angle or 0.0)
    yield f"outside the slender range, θcr = {degrees_too(widest)} and |θ| up to {degrees_too(angle)}: {how}"


def off(normalised_by: str) -> str:
    """Return the words before the error of the moment of the base acceleration, which the tangent also underestimates."""
    return "is wrong by up to" if normalised_by == "tangent" else "by up to"


def _lifting(block: Block, amplitudes: np.ndarray) -> Iterator[str]:
    """Yield a warning for amplitudes that lift off the slender model, a_x > g θcr, but not the real block, a_x ≤ g B/H."""
    model = min(block.critical_angles)
    truth, amplitudes = math.tan(model), amplitudes * (block.critical_angle / model)
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
