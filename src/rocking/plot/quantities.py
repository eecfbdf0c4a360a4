"""Normalised or SI axes: what is drawn, in which unit, under which label."""

from collections.abc import Callable
from typing import Any

import numpy as np
from attrs import frozen

from rocking.model import Block, instance


@frozen
class Quantities:
    """Turns normalised time, angle and velocity into what a picture shows, with the labels of axes.

    `reading` is a template for a line of text: a time, its digits after the point, an angle and how it is written.
    """

    time: Callable[[Any], Any]
    angle: Callable[[Any], Any]
    velocity: Callable[[Any], Any]
    time_label: str
    angle_label: str
    velocity_label: str
    time_unit: str
    reading: str


def _same(values: Any) -> Any:
    return values


NORMALISED = Quantities(
    time=_same,
    angle=_same,
    velocity=_same,
    time_label=r"time $\tau = \alpha t$ (–)",
    angle_label=r"angle $\Theta = \theta/\theta_\mathrm{cr}$ (–)",
    velocity_label=r"velocity $\Theta' = \mathrm{d}\Theta/\mathrm{d}\tau$ (–)",
    time_unit="τ",
    reading="τ = {:.{}f}    Θ = {:{}}",
)


def quantities(block: Block | None) -> Quantities:
    """Normalised quantities, or, for a `block`, seconds, degrees and degrees per second."""
    if block is None:
        return NORMALISED
    instance("block", block, Block)
    return Quantities(
        time=block.seconds,
        angle=block.degrees,
        velocity=lambda velocity: np.degrees(block.radians_per_second(velocity)),
        time_label=r"time $t$ (s)",
        angle_label=r"angle $\theta$ (°)",
        velocity_label=r"velocity $\dot\theta$ (°/s)",
        time_unit="s",
        reading="t = {:.{}f} s    θ = {:{}}°",
    )
