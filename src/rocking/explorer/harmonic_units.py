"""Units of the harmonic page: normalised, or SI for a block. Fields and contents of figures are converted here."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from attrs import frozen

from rocking.explorer.fields import Reader, Span, number, optional, span
from rocking.model import quantity as quantities
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.quantity import Quantity
from rocking.plot.axes import parameter, units_of

Contents = dict[str, Any]
"""New contents of a figure: columns by the names of their sources, and its `ranges`, `label`, and more."""


def _angle(block: Block, degrees: float) -> float:
    return block.angle(degrees=degrees)


def _velocity(block: Block, degrees_per_second: float) -> float:
    return block.velocity(math.radians(degrees_per_second))


def _period(block: Block, hertz: float) -> float:
    return math.tau / block.frequency(hertz)


CONVERTED: dict[str, tuple[Quantity, Callable[[Block, float], float]]] = {
    "amplitude": (quantities.AMPLITUDE, Block.amplitude),
    "period": (quantities.PERIOD, Block.time),
    "angle": (quantities.ANGLE, _angle),
    "velocity": (quantities.VELOCITY, _velocity),
    "brace_angle": (quantities.BRACE_ANGLE, _angle),
}
"""Quantities with another unit in SI, and the conversions of numbers from the unit on the screen."""
SPANS = {"amplitudes": "amplitude", "periods": "period", "angles": "angle", "velocities": "velocity"}
"""Quantities of the axes of the maps."""
AXES = {
    "history": ("time", "angle"),
    "portrait": ("angle", "velocity"),
    "section": ("angle", "velocity"),
    "spectrum": ("frequency", "density"),
}
"""Quantities of the axes of figures; those of the diagram depend on the view."""
PLAIN = {
    r"\dot\theta": "θ̇",
    r"\Theta": "Θ",
    r"\theta": "θ",
    r"\tau": "τ",
    "_0": "₀",
    "_x": "ₓ",
    "'": "′",
    "$": "",
}
"""Characters for the mathematical text of labels, which Bokeh would load a library for."""


def plain(label: str) -> str:
    """Return a label without mathematical text."""
    for text, character in PLAIN.items():
        label = label.replace(text, character)
    return label


@frozen
class Units:
    """Units of what the page shows: SI for a block, otherwise normalised.

    `period` is the normalised forcing period; the spectrum is over multiples of the forcing frequency.
    """

    block: Block | None
    period: float

    # ---- numbers

    def shown(self, name: str, value: Any) -> Any:
        """Return a number or range of a normalised quantity as the page shows it."""
        name = SPANS.get(name, name)
        if isinstance(value, Span):
            return Span(self.shown(name, value.low), self.shown(name, value.high))
        if self.block is None or value is None or name not in CONVERTED:
            return value
        return float(parameter(name, self.block)[0](value))

    def texts(self, values: Mapping[str, Any]) -> dict[str, str]:
        """Return the texts of fields in SI: of those of `values` that have another unit, and of the frequency in Hz."""
        if self.block is None:
            return {}
        made = {name: self._text(name, values[name]) for name in CONVERTED if values[name] is not None}
        for name, quantity in SPANS.items():
            made[name] = ":".join(self._text(quantity, end) for end in (values[name].low, values[name].high))
        return made | {"frequency_hz": self.hertz}

    def _text(self, name: str, value: float) -> str:
        assert self.block is not None
        block, back = self.block, CONVERTED[name][1]
        return digits(value, lambda each: self.shown(name, each), lambda each: back(block, each))

    @property
    def hertz(self) -> str:
        """Text of the forcing frequency in Hz."""
        assert self.block is not None
        block = self.block
        return digits(self.period, lambda each: 1 / block.seconds(each), lambda each: _period(block, each))

    def readers(self, fits: Callable[[Span], bool], ends: str) -> dict[str, Reader]:
        """Return the readers of fields in SI, which return normalised values; `fits` and `ends` are those of `span`."""
        block = self.block
        if block is None:
            return {}
        readers = {name: self._reader(name) for name in CONVERTED}
        low, high = (float(block.hertz(each)) for each in quantities.FREQUENCY.range)
        hertz = number(low, high)
        return {
            **readers,
            **{name: self._span_reader(quantity, fits, ends) for name, quantity in SPANS.items()},
            "amplitude": lambda name, text: readers["amplitude"](name, without_g(text)),
            "brace_angle": optional(readers["brace_angle"]),
            "frequency_hz": lambda name, text: _within(quantities.PERIOD, _period(block, hertz(name, text))),
        }

    def _reader(self, quantity: str) -> Reader:
        read = number(*(self.shown(quantity, end) for end in CONVERTED[quantity][0].range))
        return lambda name, text: self._normalised(quantity, read(name, text))

    def _span_reader(self, quantity: str, fits: Callable[[Span], bool], ends: str) -> Reader:
        def normalised(each: Span) -> Span:
            return Span(self._normalised(quantity, each.low), self._normalised(quantity, each.high))

        low, high = (self.shown(quantity, end) for end in CONVERTED[quantity][0].range)
        read = span(low, high, lambda each: fits(normalised(each)), ends)
        return lambda name, text: normalised(read(name, text))

    def _normalised(self, quantity: str, value: float) -> float:
        assert self.block is not None
        of, back = CONVERTED[quantity]
        return _within(of, back(self.block, value))

    # ---- figures

    def label(self, name: str) -> str:
        """Return the label of an axis over a column of a figure."""
        if name == "frequency" and self.block is None:
            return "frequency / forcing frequency"
        if name == "density":
            return f"density S ({'τ' if self.block is None else '°²/Hz'})"
        if name in ("amplitude", "period"):
            return plain(parameter(name, self.block)[1])
        return plain(getattr(units_of(self.block), f"{name}_label").partition(" = ")[0])

    def start_label(self, name: str) -> str:
        """Return the label of an axis over an initial angle or velocity."""
        return plain(parameter(name, self.block)[1])

    def factor(self, name: str) -> float:
        """Return what a normalised value of a column is multiplied by."""
        if self.block is None:
            return 1.0
        if name == "frequency":
            return 1.0 / float(self.block.seconds(self.period))
        if name == "exponent":
            return self.block.rate_unit
        of = parameter(name, self.block)[0] if name == "period" else getattr(units_of(self.block), name)
        return float(of(1.0))

    def contents(self, figure: str, contents: Contents, vary: str) -> Contents:
        """Return the contents of a figure in these units; `vary` is the parameter of the diagram."""
        if self.block is None:
            return contents
        across, up = map(self.factor, axes_of(figure, vary))
        scales = {name: self.factor(name) for name in ("time", "angle", "velocity", "frequency", "density")}
        scales |= {"value": across, "x": across, "w": across, "y": up, "h": up}

        def scaled(columns: Mapping[str, Any]) -> dict[str, Any]:
            return {
                name: np.asarray(values) * scales[name] if name in scales else values
                for name, values in columns.items()
            }

        made = {part: scaled(each) if isinstance(each, Mapping) else each for part, each in contents.items()}
        left, right, bottom, top = contents["ranges"]
        return made | {"ranges": (left * across, right * across, bottom * up, top * up)}

    def headings(self, vary: str) -> dict[str, str]:
        """Return the headings of the columns of tables that have units in SI, by the names of the columns."""
        if self.block is None:
            return {}
        names = {
            name: name
            for name in ("time", "angle", "velocity", "frequency", "density", "amplitude", "period")
        }
        units = {
            name: self.label(of).rpartition("(")[2][:-1] for name, of in (names | {"value": vary}).items()
        }
        return {name: f"{name} [{unit}]" for name, unit in units.items()} | {"exponent": "exponent [1/s]"}


def axes_of(figure: str, vary: str) -> tuple[str, str]:
    """Return the quantities of the axes of a figure."""
    return (vary, "angle") if figure == "diagram" else AXES[figure]


def without_g(text: str) -> str:
    """Return an acceleration in m/s² as text; it may be given in g, such as "0.3 g"."""
    size, unit, rest = text.partition("g")
    try:
        return repr(float(size) * GRAVITY) if unit and not rest.strip() else text
    except ValueError:
        return text


def _within(of: Quantity, value: float) -> float:
    """Return a value at the end of a range if rounding has led beyond it."""
    return min(max(float(value), of.range[0]), of.range[1])


def digits(value: float, physical: Callable[[float], float], normalised: Callable[[float], float]) -> str:
    """Write an SI value with the fewest digits that give the normalised value back, so that a typed 3 stays 3."""
    for count in (15, 16, 17):
        text = f"{physical(value):.{count}g}"
        if normalised(float(text)) == value:
            break
    return text
