"""View of the page of harmonic motion: its fields, and a block in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

from attrs import asdict, astuple, evolve, frozen

from rocking.explorer.fields import (
    Field,
    Missing,
    Refused,
    Span,
    View,
    axis,
    count,
    entry,
    number,
    optional,
    quantity,
    read_fields,
    word,
    words,
)
from rocking.explorer.figures import Axes
from rocking.explorer.harmonic_units import Units
from rocking.model import quantity as quantities
from rocking.model.block import Block
from rocking.model.quantity import LEFT_QUANTITIES
from rocking.model.system import NO_BRACES, State, System, check_below_flat, check_start, system_of
from rocking.model.validation import Refusal
from rocking.plot import theory_curves

POINTS = 513
"""Points along each side of the finest map: 2⁹ + 1, so that each grid consists of every second point of the next."""
APART = 8.0
"""Minimum distance of two points of a map, in units of the last place."""
SAME = 1e-3
"""Largest relative difference at which a typed critical angle counts as that of the block in SI units."""
LATEST, MAX_SHOWN = 100_000, 200
"""Largest first cycle, and largest number of cycles, of the time history."""

GROUPS = BLOCK, SHAKING, START, BRACES, CYCLES = "Block", "Base motion", "Start", "Braces", "Cycles shown"
"""Groups of fields."""


def closest(span: Span) -> float:
    """Return the smallest length of a range here whose points double precision can resolve."""
    return APART * (POINTS - 1) * math.ulp(max(abs(span.low), abs(span.high), 1e-3))


def nearby(value: float, span: Span) -> float:
    """Round the coordinate of a click to the fewest digits within half a point of the map."""
    digits = math.ceil(-math.log10(span.width / (POINTS - 1)))
    return min(max(round(value, digits), span.low), span.high)


def resolved(span: Span) -> bool:
    """Return whether double precision resolves a range, with a tolerance for rounding, so that the narrowest one is valid."""
    return span.width >= closest(span) * (1.0 - 1e-3)


ENDS = "LOW < HIGH and a range that double precision resolves"


@frozen
class HarmonicView(View):
    """View of a session: system, initial state, ranges of the maps and options of the figures.

    Names and units are those of `Harmonic`, `System`, `Braces` and `State`. The critical angle selects the full equation of motion.
    """

    LINKED: ClassVar[tuple[str, ...]] = ("amplitude", "period", "restitution")
    GROUPS: ClassVar[tuple[str, ...]] = GROUPS
    EXTRA: ClassVar[Mapping[str, Field]] = {
        "frequency_hz": Field(
            number(0.0, math.inf),
            symbol="f",
            words="frequency",
            unit="Hz",
            title="Frequency of the base motion, in Hz",
            group=SHAKING,
            only="si",
        )
    }
    LABELS: ClassVar[Mapping[str, str]] = {"frequency_hz": "frequency"}

    amplitude: float = quantity(quantities.AMPLITUDE, 2.0, group=SHAKING)
    period: float = quantity(quantities.PERIOD, 1.0, group=SHAKING, only="normalised")
    restitution: float = quantity(quantities.RESTITUTION, 0.925, group=BLOCK)
    phase: float = quantity(quantities.PHASE, 0.0, group=SHAKING)
    angle: float = quantity(
        quantities.ANGLE,
        0.0,
        symbol="Θ₀",
        words="initial angle",
        title="Initial angle Θ₀, in units of the critical angle θcr",
        group=START,
    )
    velocity: float = quantity(
        quantities.VELOCITY,
        0.0,
        symbol="Θ′₀",
        words="initial velocity",
        title="Initial angular velocity Θ′₀, in units of α θcr",
        group=START,
    )
    brace_angle: float | None = quantity(
        quantities.BRACE_ANGLE,
        None,
        optional(number(*quantities.BRACE_ANGLE.range)),
        title="Brace angle Θb, in units of the critical angle θcr; empty for no braces",
        group=BRACES,
    )
    brace_restitution: float = quantity(quantities.BRACE_RESTITUTION, 1.0, words="restitution", group=BRACES)
    critical_angle: float | None = quantity(
        quantities.CRITICAL_ANGLE,
        None,
        optional(number(*quantities.CRITICAL_ANGLE.range)),
        title="Critical angle θcr in rad, for the full equation of motion; empty for a slender block and small angles",
        group=BLOCK,
        only="normalised",
    )
    amplitudes: Span = axis(Span(0.0, 16.0), *quantities.AMPLITUDE.range, resolved, ENDS)
    periods: Span = axis(Span(0.2, 3.0), *quantities.PERIOD.range, resolved, ENDS)
    angles: Span = axis(Span(-1.2, 1.2), *quantities.ANGLE.range, resolved, ENDS)
    velocities: Span = axis(Span(-1.2, 1.2), *quantities.VELOCITY.range, resolved, ENDS)
    vary: str = entry("amplitude", word("amplitude", "period"))
    first: int = entry(
        0,
        count(0, LATEST),
        "first cycle",
        words="first cycle",
        group=CYCLES,
        title="First forcing cycle shown in the time history and the phase portrait",
    )
    cycles: int = entry(
        30,
        count(1, MAX_SHOWN),
        words="cycles",
        group=CYCLES,
        title="Number of forcing cycles shown in the time history and the phase portrait",
    )
    curves: tuple[str, ...] = entry((), words(*theory_curves.CURVES))
    height: float | None = entry(
        None,
        optional(number(*quantities.SIZES)),
        symbol="H",
        words="height",
        unit="m",
        title="Height of the block, in m",
        group=BLOCK,
        only="si",
    )
    width: float | None = entry(
        None,
        optional(number(*quantities.SIZES)),
        symbol="B",
        words="width",
        unit="m",
        title="Width of the block in the direction of the base motion, in m",
        group=BLOCK,
        only="si",
    )
    offset: float = entry(
        0.0,
        number(-quantities.SIZES[1], quantities.SIZES[1]),
        symbol="d",
        words="offset",
        unit="m",
        title="Distance of the mass centre from the middle of the base, in m, towards the edge about which the block turns for θ > 0",
        group=BLOCK,
        only="si",
    )

    @property
    def system(self) -> System:
        """Selected system."""
        angle = {"critical_angle": self.critical_angle or 0.0} | self.left
        return system_of(
            asdict(self, recurse=False) | angle | (NO_BRACES if self.brace_angle is None else {})
        )

    @property
    def left(self) -> dict[str, float]:
        """Quantities of the left side of an unsymmetric block in SI units, by name; none of any other."""
        left = None if self.block is None else self.block.left
        return {} if left is None else dict(zip(LEFT_QUANTITIES, astuple(left), strict=True))

    @property
    def start(self) -> State:
        """Initial state."""
        return State(self.angle, self.velocity)

    @property
    def block(self) -> Block | None:
        """Block in SI units, if its height and width are given."""
        if self.height is None or self.width is None:
            return None
        if self.offset == 0:
            return Block(self.height, self.width, self.restitution)
        own = Block(self.height, self.width, 0.5, offset=self.offset).housner_restitutions
        left = own[1] if self.restitution == own[0] else self.restitution
        return Block(self.height, self.width, self.restitution, offset=self.offset, left_restitution=left)

    @property
    def units(self) -> Units:
        """Units of the page: SI with a block."""
        return Units(self.block, self.period)

    def narrowest(self, name: str) -> float:
        """Return the smallest length of a range that double precision resolves, normalised and in the units of the page."""
        span, units = getattr(self, name), self.units
        if units.block is None:
            return closest(span)
        return max(2 * closest(units.shown(name, span)), 1.01 * units.shown(name, 1.0) * closest(span))

    @property
    def shown(self) -> dict[str, str]:
        """Text of each field on the page, in its units."""
        return self.fields | self.units.texts(asdict(self, recurse=False))

    def changed(self, typed: Mapping[str, str]) -> HarmonicView:
        """Return the view with new values of some fields, in the units of the page.

        A first block keeps the normalised system. Another block has Housner's coefficient of restitution, and the values in SI
        are kept. Without both sides, the view is normalised; a block that loses only one of them is refused.

        Parameters
        ----------
        typed : mapping of str to str
            Field names and their text. With a block, the period is in s, and `frequency_hz` replaces it.

        Raises
        ------
        Refused
            If a field is invalid, with one message per field.
        """
        sides = {name: typed[name] for name in ("height", "width", "offset") if name in typed}
        read, refused = read_fields(self.readers(), sides, self.labels())
        if refused:
            raise Refused(refused)
        view = evolve(self, **read)
        block = view._checked_block()
        if self.block is not None and len(sides) == 1 and block is None:
            (name,) = sides
            raise self.refused(Missing(name, ""))
        if block is not None and block != self.block:
            angle = None if self.critical_angle is None else block.critical_angle
            view = evolve(view, critical_angle=angle)
            if self.block is not None:
                view = evolve(view, restitution=self._housner(block))
                kept = self.units.texts(asdict(self, recurse=False))
                typed = {name: text for name, text in kept.items() if name != "frequency_hz"} | dict(typed)
        labels = self.labels() if block is None else {**self.labels(), "amplitude": "acceleration"}
        rest = {name: text for name, text in typed.items() if name not in sides}
        read, refused = read_fields({**self.readers(), **view.units.readers(resolved, ENDS)}, rest, labels)
        if refused:
            raise Refused(refused)
        period = read.pop("frequency_hz", None)
        return evolve(view, **(read if period is None else read | {"period": period})).checked()

    def _checked_block(self) -> Block | None:
        try:
            return self.block
        except Refusal as error:
            raise self.refused(error) from None

    def _housner(self, block: Block) -> float:
        try:
            return Block(block.height, block.width, offset=block.offset).restitution
        except Refusal as error:
            raise self.refused(error) from None

    @property
    def fixed(self) -> dict[str, float]:
        """Parameters that are constant over the map, by name."""
        names = ["restitution", "phase", "angle", "velocity"]
        if self.brace_angle is not None:
            names += ["brace_angle", "brace_restitution"]
        if self.critical_angle is not None:
            names.append("critical_angle")
        return {name: getattr(self, name) for name in names} | self.left

    @property
    def map_axes(self) -> Axes:
        """Axes of the map of responses, in the units of the page."""
        return Axes(*(self.units.shown(name, getattr(self, name)) for name in ("periods", "amplitudes")))

    @property
    def basin_axes(self) -> Axes:
        """Axes of the basin map, in the units of the page."""
        return Axes(*(self.units.shown(name, getattr(self, name)) for name in ("angles", "velocities")))

    @property
    def varied(self) -> Span:
        """Parameter range of the orbit diagram: the range of the map along that axis."""
        return self.amplitudes if self.vary == "amplitude" else self.periods

    @property
    def other(self) -> float:
        """Parameter of the forcing that is constant in the orbit diagram."""
        return self.period if self.vary == "amplitude" else self.amplitude

    def at(self, value: float) -> HarmonicView:
        """Return the view at another parameter value of the orbit diagram."""
        return evolve(self, amplitude=value) if self.vary == "amplitude" else evolve(self, period=value)

    def checked(self) -> HarmonicView:
        """Return the view, with the exact critical angle of its block in SI units.

        Raises
        ------
        Refused
            If the critical angle is that of another block, if a block with an offset loses its size, or if its block cannot have its
            braces or its initial state.
        """
        self._checked_block()
        view = self._with_angle_of_block()
        if view.critical_angle is not None and view.brace_angle is not None:
            try:
                check_below_flat(view.brace_angle, view.critical_angle)
            except Refusal as error:
                raise self.refused(error) from None
        if view.offset and view.block is None:
            raise Refused({"offset": "offset must be 0 in normalised units, which are for a symmetric block"})
        if view.left and view.brace_angle is not None:
            raise Refused({"offset": "offset must be 0 with braces, which are for a symmetric block"})
        try:
            check_start(view.system, view.start)
        except ValueError as error:
            unit = "" if self.block is None else ", in units of the critical angle"
            raise Refused({"angle": f"{error}{unit}"}) from None
        return view

    def _with_angle_of_block(self) -> HarmonicView:
        if self.block is None or self.critical_angle is None:
            return self
        exact = self.block.critical_angle
        if abs(self.critical_angle / exact - 1.0) > SAME:
            allowed = f"be {exact:.4g}, that of the block in SI units, or empty"
            raise self.refused(Refusal("critical_angle", allowed, self.critical_angle))
        return evolve(self, critical_angle=exact)


DEFAULT = HarmonicView()
