"""Axes of figures in normalised or SI units; labels of intensities and of limits of the angle."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from attrs import evolve, frozen

from rocking.model.block import Block
from rocking.model.quantity import SYSTEM_QUANTITIES
from rocking.model.validation import instance


@frozen
class Units:
    """Conversions from normalised values to the units of a figure, with the labels of axes.

    A label reads "quantity (unit)"; a dimensionless quantity has no unit. `reading` is a template for a line of text. Its
    fields are a time, the number of its decimals, an angle and the format of the angle.
    """

    time: Callable[[Any], Any]
    amplitude: Callable[[Any], Any]
    angle: Callable[[Any], Any]
    velocity: Callable[[Any], Any]
    frequency: Callable[[Any], Any]
    density: Callable[[Any], Any]
    time_label: str
    angle_label: str
    velocity_label: str
    speed_label: str
    base_label: str
    frequency_label: str
    density_label: str
    time_unit: str
    reading: str


def _same(values: Any) -> Any:
    return values


NORMALISED = Units(
    time=_same,
    amplitude=_same,
    angle=_same,
    velocity=_same,
    frequency=_same,
    density=_same,
    time_label=r"time $\tau = \alpha t$",
    angle_label=r"angle $\Theta = \theta/\theta_\mathrm{cr}$",
    velocity_label=r"velocity $\Theta' = \mathrm{d}\Theta/\mathrm{d}\tau$",
    speed_label=r"speed after impact $|\Theta'|$",
    base_label="acceleration\nof base ($g\\theta_\\mathrm{cr}$)",
    frequency_label=r"frequency (cycles per unit of $\tau$)",
    density_label=r"power spectral density $S_\Theta$",
    time_unit="τ",
    reading="τ = {:.{}f}    Θ = {:{}}",
)


def units_of(block: Block | None, own: Block | None = None) -> Units:
    """Return seconds, degrees and degrees per second for a `block`, or else normalised quantities, in the units of an `own` block."""
    if block is None:
        return NORMALISED if own is None else _normalised(own)
    instance("block", block, Block)
    return Units(
        time=block.seconds,
        amplitude=block.acceleration,
        angle=block.degrees,
        velocity=lambda velocity: np.degrees(block.radians_per_second(velocity)),
        frequency=lambda frequency: frequency / block.seconds(1.0),
        density=lambda density: density * block.degrees(1.0) ** 2 * block.seconds(1.0),
        time_label=r"time $t$ (s)",
        angle_label=r"angle $\theta$ (°)",
        velocity_label=r"velocity $\dot\theta$ (°/s)",
        speed_label=r"speed after impact $|\dot\theta|$ (°/s)",
        base_label="acceleration\nof base (m/s²)",
        frequency_label="frequency (Hz)",
        density_label=r"power spectral density $S_\theta$ (°²/Hz)",
        time_unit="s",
        reading="t = {:.{}f} s    θ = {:{}}°",
    )


def _normalised(own: Block) -> Units:
    """Return normalised quantities with the units of a block in the labels."""
    rate, force = (r"\alpha\sqrt{1 - \kappa}\,", r"(1 + \rho)\,") if own.by_balance else (r"\alpha ", "")
    level = r"g\,\tan\theta_\mathrm{cr}" if own.normalised_by == "tangent" else r"g\theta_\mathrm{cr}"
    return evolve(
        NORMALISED,
        time_label=rf"time $\tau = {rate}t$",
        angle_label=rf"angle $\Theta = \theta/{balance_symbol(own)}$",
        base_label=f"acceleration\nof base (${force}{level}$)",
    )


def parameter(name: str, block: Block | None) -> tuple[Callable[[Any], Any], str]:
    """Return the conversion of a parameter of a system or an initial state, and the label of its axis."""
    if block is not None:
        instance("block", block, Block)
    conversion, label = SYSTEM_QUANTITIES[name].axis(block)
    return partial(conversion, block), label


SYMBOLS = {
    "I_A": "$I_A$",
    "PGA/(g tan θcr)": r"PGA$/(g\,\tan\theta_\mathrm{cr})$",
    "α PGV/(g tan θcr)": r"$\alpha\,$PGV$/(g\,\tan\theta_\mathrm{cr})$",
}


def level_label(level: Any) -> str:
    """Return the label of the axis of the levels of a dataset: description, symbol and unit."""
    symbol, unit = level.attrs["symbol"], level.attrs.get("units", "1")
    name = level.attrs["long_name"]
    if "/" in symbol:
        name = ""
    elif symbol in name:
        symbol = ""
    return " ".join(
        filter(None, (name, SYMBOLS.get(symbol, symbol), "" if unit in ("1", "") else f"({unit})"))
    )


def balance_symbol(block: Block | None) -> str:
    """Return the symbol of the unit of angles: θcr, or the unstable balance θu of a slender restrained block."""
    return r"\theta_\mathrm{u}" if block is not None and block.by_balance else r"\theta_\mathrm{cr}"


def limit_label(limit: float, block: Block) -> str:
    """Return the event of exceeding a limit of |Θ|, in degrees."""
    if math.isinf(limit):
        return "overturning"
    return rf"$|\theta| > {block.degrees(limit):.3g}°$ (${limit:.3g}\,{balance_symbol(block)}$)"
