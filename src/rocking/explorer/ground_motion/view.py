"""View of the page of ground motions as one frozen value, with its fields as text."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import urlencode

import attrs
from attrs import frozen

from rocking.explorer.field_readers import (
    VERSION,
    Refused,
    count,
    number,
    optional,
    parameters,
    read_fields,
    word,
    written,
)
from rocking.explorer.form_fields import at_width
from rocking.explorer.view_state import Span
from rocking.model.block import Block
from rocking.model.forcing import KINDS
from rocking.model.ground_motion import STEPS
from rocking.model.system import MODELS
from rocking.model.validation import Refusal

SOURCES = ("example", "synthetic-1", "synthetic-2", "synthetic-3", "pulse", "file")
UNITS = ("", "m/s²", "cm/s²", "mm/s²", "g", "gal")
SCALES = (0.01, 100.0)
SIZES = (0.1, 100.0)
"""Range of half the diagonal of the map, in m."""
SLENDERNESS = (0.5, 54.0)
"""Range of the critical angle of the map, in degrees; up to 54.7° Housner's restitution is positive."""
WHOLE_SIZES, WHOLE_ANGLES = Span(0.2, 10.0), Span(3.0, 30.0)
"""Ranges of the map at the start."""
NARROWEST = 1.001
"""Smallest ratio of the ends of a range, so that the points of a map differ clearly."""
INTERVALS = 304
"""Intervals along each side of the finest map."""


@frozen
class GroundView:
    """View of a session: base motion, its scale, one block, and the ranges of the map.

    Attributes
    ----------
    source : str
        One of `SOURCES`.
    kind, amplitude, duration : str and float
        Form of the pulse, its amplitude in g and its duration in s.
    units, step : str, float or None
        Unit and time step, in s, of a file that does not state them.
    channel : int
        Channel of the file, counted from 1.
    scale : float
        Factor of the base motion.
    height, width : float
        Block, in m.
    model : str
        Equation of motion: "slender" or "full".
    sizes, angles : Span
        Ranges of the map: half the diagonal R in m, and the critical angle in degrees.
    """

    source: str = "example"
    kind: str = "one-sine"
    amplitude: float = 0.5
    duration: float = 1.0
    units: str = ""
    step: float | None = None
    channel: int = 1
    scale: float = 5.0
    height: float = 2.0
    width: float = 0.5
    model: str = "slender"
    sizes: Span = WHOLE_SIZES
    angles: Span = WHOLE_ANGLES

    @property
    def block(self) -> Block:
        """Selected block: a uniform rectangle with Housner's restitution."""
        return Block(self.height, self.width)

    @property
    def shaking(self) -> tuple[Any, ...]:
        """Fields that decide the base motion, without its scale."""
        chosen = {
            "pulse": (self.kind, self.amplitude, self.duration),
            "file": (self.units, self.step, self.channel),
        }
        return (self.source, *chosen.get(self.source, ()))


DEFAULT = GroundView()


def _range(low: float, high: float) -> Callable[[str, str], Span]:
    end = number(low, high)

    def read(name: str, text: str) -> Span:
        first, _, last = text.partition(":")
        span = Span(end(name, first), end(name, last))
        if not span.high >= NARROWEST * span.low:
            raise Refusal(name, "be LOW:HIGH, with LOW clearly below HIGH", text)
        return span

    return read


READ: dict[str, Callable[[str, str], Any]] = {
    "source": word(*SOURCES),
    "kind": word(*KINDS),
    "amplitude": number(1e-3, 20.0),
    "duration": number(0.01, 60.0),
    "units": word(*UNITS),
    "step": optional(number(*STEPS)),
    "channel": count(1, 10_000),
    "scale": number(*SCALES),
    "height": number(1e-3, 1e3),
    "width": number(1e-3, 1e3),
    "model": word(*MODELS),
    "sizes": _range(*SIZES),
    "angles": _range(*SLENDERNESS),
}
"""Reader of each field, for the form and for links."""


def changed(shown: GroundView, typed: Mapping[str, str]) -> GroundView:
    """Return the view with new values of some fields; raise Refused with one message per invalid field."""
    read, refused = read_fields(READ, typed)
    if refused:
        raise Refused(refused)
    return _with_block(attrs.evolve(shown, **read))


def _with_block(shown: GroundView) -> GroundView:
    """Return the view if its block has Housner's restitution."""
    try:
        Block(shown.height, shown.width)
    except Refusal as error:  # Housner's restitution, which follows from height and width
        raise Refused(at_width(error)) from None
    return shown


def at_point(shown: GroundView, size: float, degrees: float) -> dict[str, str]:
    """Return height and width, as text, of the block at a point of the map, with digits finer than the points."""
    size = min(max(size, shown.sizes.low), shown.sizes.high)
    angle = math.radians(min(max(degrees, shown.angles.low), shown.angles.high))
    finest = (
        min(math.log(shown.sizes.high / shown.sizes.low), shown.angles.width / shown.angles.high) / INTERVALS
    )
    digits = max(math.ceil(-math.log10(finest)) + 1, 4)
    sides = {"height": 2 * size * math.cos(angle), "width": 2 * size * math.sin(angle)}
    return {name: written(float(f"{side:.{digits}g}")) for name, side in sides.items()}


def address(shown: GroundView) -> str:
    """Return the query string of a view: base motion, scale and block, and all other fields that differ from the defaults."""
    always = ("source", "scale", "height", "width")
    parts = {
        each.name: written(getattr(shown, each.name))
        for each in attrs.fields(GroundView)
        if each.name in always or getattr(shown, each.name) != each.default
    }
    return urlencode({"version": str(VERSION)} | parts, safe=":,/")


def from_address(text: str) -> tuple[GroundView, dict[str, str]]:
    """Return the view of a query string, and an error message for each invalid parameter, which keeps its default."""
    try:
        read, refused = read_fields(READ, parameters(text))
        return _with_block(attrs.evolve(DEFAULT, **read)), refused
    except Refused as unread:
        return DEFAULT, unread.fields
