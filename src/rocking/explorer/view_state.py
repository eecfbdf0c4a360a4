"""What is shown, as one frozen value."""

from __future__ import annotations

import math

from attrs import asdict, evolve, frozen

from rocking.model import NO_BRACES, Block, State, System, system_of

POINTS = 513
"""Points along each side of a map in the end: 2⁹ + 1, so that each grid has every second point of the next."""
APART = 8.0
"""The nearest points may come in units of the last place, unless they lie about zero."""


@frozen
class Span:
    """A stretch of an axis, from `low` to `high`."""

    low: float
    high: float

    @property
    def width(self) -> float:
        """From one end to the other."""
        return self.high - self.low


def closest(span: Span) -> float:
    """The narrowest that a stretch here may be for double precision to tell its points apart."""
    return APART * (POINTS - 1) * math.ulp(max(abs(span.low), abs(span.high), 1e-3))


def nearby(value: float, span: Span) -> float:
    """The number with the fewest digits that a click at `value` cannot be told from: no further off than half a point."""
    digits = math.ceil(-math.log10(span.width / (POINTS - 1)))
    return min(max(round(value, digits), span.low), span.high)


@frozen
class ViewState:
    """What a visitor looks at: a system and its start, the map around it, its basin, and how they are drawn.

    Names and units are those of `Harmonic`, `System`, `Braces` and `State`.
    """

    amplitude: float = 2.0
    period: float = 1.0
    restitution: float = 0.925
    phase: float = 0.0
    angle: float = 0.0
    velocity: float = 0.0
    brace_angle: float | None = None
    brace_restitution: float = 1.0
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
        """The system selected."""
        return system_of(asdict(self, recurse=False) | (NO_BRACES if self.brace_angle is None else {}))

    @property
    def start(self) -> State:
        """Its start."""
        return State(self.angle, self.velocity)

    @property
    def block(self) -> Block | None:
        """The block in metres, where one was given."""
        if self.height is None or self.width is None:
            return None
        return Block(self.height, self.width, self.restitution)

    @property
    def fixed(self) -> dict[str, float]:
        """What does not vary over the map, by name."""
        names = ["restitution", "phase", "angle", "velocity"]
        if self.brace_angle is not None:
            names += ["brace_angle", "brace_restitution"]
        return {name: getattr(self, name) for name in names}

    @property
    def varied(self) -> Span:
        """The values of the orbit diagram: those of the map along that axis."""
        return self.amplitudes if self.vary == "amplitude" else self.periods

    def at(self, value: float) -> ViewState:
        """The same at another place of the orbit diagram."""
        return evolve(self, amplitude=value) if self.vary == "amplitude" else evolve(self, period=value)


DEFAULT = ViewState()
