"""View of a session as one frozen value."""

from __future__ import annotations

import math

from attrs import asdict, evolve, frozen

from rocking.model.block import Block
from rocking.model.system import NO_BRACES, State, System, system_of

POINTS = 513
"""Points along each side of the finest map: 2⁹ + 1, so that each grid consists of every second point of the next."""
APART = 8.0
"""Minimum distance of two points of a map, in units of the last place."""


@frozen
class Span:
    """Range of an axis, from `low` to `high`."""

    low: float
    high: float

    @property
    def width(self) -> float:
        """Length of the range."""
        return self.high - self.low


def closest(span: Span) -> float:
    """Return the smallest length of a range here whose points double precision can resolve."""
    return APART * (POINTS - 1) * math.ulp(max(abs(span.low), abs(span.high), 1e-3))


def nearby(value: float, span: Span) -> float:
    """Round the coordinate of a click to the fewest digits within half a point of the map."""
    digits = math.ceil(-math.log10(span.width / (POINTS - 1)))
    return min(max(round(value, digits), span.low), span.high)


@frozen
class ViewState:
    """View of a session: system, initial state, ranges of the maps and options of the figures.

    Names and units are those of `Harmonic`, `System`, `Braces` and `State`. The critical angle selects the full equation of motion.
    """

    amplitude: float = 2.0
    period: float = 1.0
    restitution: float = 0.925
    phase: float = 0.0
    angle: float = 0.0
    velocity: float = 0.0
    brace_angle: float | None = None
    brace_restitution: float = 1.0
    critical_angle: float | None = None
    amplitudes: Span = Span(0.0, 16.0)
    periods: Span = Span(0.2, 3.0)
    angles: Span = Span(-1.2, 1.2)
    velocities: Span = Span(-1.2, 1.2)
    vary: str = "amplitude"
    first: int = 0
    cycles: int = 30
    curves: tuple[str, ...] = ()
    height: float | None = None
    width: float | None = None

    @property
    def system(self) -> System:
        """Selected system."""
        angle = {"critical_angle": self.critical_angle or 0.0}
        return system_of(
            asdict(self, recurse=False) | angle | (NO_BRACES if self.brace_angle is None else {})
        )

    @property
    def start(self) -> State:
        """Initial state."""
        return State(self.angle, self.velocity)

    @property
    def block(self) -> Block | None:
        """Block in SI units, if its height and width are given."""
        if self.height is None or self.width is None:
            return None
        return Block(self.height, self.width, self.restitution)

    @property
    def fixed(self) -> dict[str, float]:
        """Parameters that are constant over the map, by name."""
        names = ["restitution", "phase", "angle", "velocity"]
        if self.brace_angle is not None:
            names += ["brace_angle", "brace_restitution"]
        if self.critical_angle is not None:
            names.append("critical_angle")
        return {name: getattr(self, name) for name in names}

    @property
    def varied(self) -> Span:
        """Parameter range of the orbit diagram: the range of the map along that axis."""
        return self.amplitudes if self.vary == "amplitude" else self.periods

    def at(self, value: float) -> ViewState:
        """Return the view at another parameter value of the orbit diagram."""
        return evolve(self, amplitude=value) if self.vary == "amplitude" else evolve(self, period=value)


DEFAULT = ViewState()
