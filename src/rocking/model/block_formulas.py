"""Formulas of a block for which its shape is not needed: frequencies, and restitution by Housner (1963)."""

from __future__ import annotations

import math
from typing import Any

from attrs import evolve

from rocking.model.validation import exactly_one, within

GRAVITY = 9.80665
NORMALISATIONS = ("angle", "tangent")
"""Units of the base acceleration: g θcr of Yim & Lin (1991), or g tan θcr, at which a real block lifts off."""
BLOCK_NORMALISATIONS = (*NORMALISATIONS, "balance")
"""The same, and g θcr for the slender restrained block, whose angles are in units of its unstable balance with the last two."""


def acceleration_unit_g(critical_angle: float, normalised_by: str) -> float:
    """Return the base acceleration in g that is 1 if it is normalised: θcr, or tan θcr."""
    return math.tan(critical_angle) if normalised_by == "tangent" else critical_angle


def frequency_parameter(radius: float, inertia_ratio: float) -> float:
    """Return α = √(MgR/Io) in 1/s, from the distance R of the corners from the centre of mass, in metres."""
    return math.sqrt(GRAVITY / (inertia_ratio * radius))


def housner_restitution(critical_angle: float, inertia_ratio: float) -> float:
    """Return Housner's (1963) coefficient of restitution, 1 − 2 sin²θcr/(Io/MR²); 1 − (3/2) sin²θcr for a uniform rectangle."""
    return 1 - 2 * math.sin(critical_angle) ** 2 / inertia_ratio


def frequency_in_hertz(frequency_hz: float | None, period_s: float | None, low: float, high: float) -> float:
    """Return the frequency in Hz from the given one of the two; ValueError if it lies outside [low, high]."""
    if exactly_one(frequency_hz=frequency_hz, period_s=period_s) == "frequency_hz":
        return within("frequency_hz", frequency_hz, low, high, "Hz")  # type: ignore[arg-type]
    return 1 / within("period_s", period_s, 1 / high, 1 / low, "s")  # type: ignore[arg-type]


class Dimensions:
    """Base class of `Block`, by which a system knows that it has one."""

    __slots__ = ()


def with_unit(block: Any, normalised_by: str) -> Any:
    """Return a block with its units; the same object if it has them, so that no warning is repeated."""
    return block if block.normalised_by == normalised_by else evolve(block, normalised_by=normalised_by)
