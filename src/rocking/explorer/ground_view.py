"""View of the page of ground motions: its fields, and its base motion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np
from attrs import define, evolve, field, frozen

from rocking.explorer.fields import Refused, Span, View, axis, count, entry, number, optional, word, written
from rocking.explorer.ground_maps import POINTS
from rocking.model import quantity as quantities
from rocking.model.block import Block, unit_for
from rocking.model.block_formulas import GRAVITY, NORMALISATIONS, with_unit
from rocking.model.changed_motion import STEPS, same_end
from rocking.model.forcing import KINDS, Pulse
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.model.restrainer import LARGEST, MASSES, Restrainer
from rocking.model.system import MODELS, RESTRAINED, Wall, critical_angle_for
from rocking.model.validation import Refusal, Text
from rocking.records.read import example_ground_motion, read_apart
from rocking.records.synthetic import synthetic_ground_motions

SOURCES = {
    "example": "Loma Prieta 1989 (example)",
    "synthetic-1": "Synthetic 1",
    "synthetic-2": "Synthetic 2",
    "synthetic-3": "Synthetic 3",
    "pulse": "Pulse",
    "file": "File …",
}
"""Names of base motions, and what the page calls them."""
UNITS = ("", "m/s²", "cm/s²", "mm/s²", "g", "gal")
SCALES = (0.01, 100.0)
SIZES = (0.1, 100.0)
"""Range of half the diagonal of the map, in m."""
SLENDERNESS = (0.5, 54.0)
"""Range of the critical angle of the map, in degrees; up to 54.7° Housner's restitution is positive."""
NARROWEST = 1.001
"""Smallest ratio of the ends of a range, so that the points of a map differ clearly."""
SEED = 1
CHANNELS = 10_000
"""Largest number of a channel."""
MAX_FILE = 50_000_000
"""Largest file, in bytes."""
READING = 5.0
"""Longest time to read a file, s. The reading process is then killed."""
MAX_DRAWN = 4_000
"""Largest number of points of a drawn line."""
PULSE_POINTS = 4_001
"""Points at which a pulse is drawn and integrated; the corners of all forms of straight lines are among them."""


def distinct(span: Span) -> bool:
    """Return whether the ends of a range of the map differ clearly."""
    return span.high >= NARROWEST * span.low


ENDS = "LOW clearly below HIGH"


@frozen
class GroundView(View):
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
    vertical : int or None
        Channel of the file that is the vertical motion; None without it. It has no effect without a file.
    scale : float
        Factor of the base motion.
    height, width, offset : float
        Block, and the distance of its mass centre from the middle of the base towards the edge of θ > 0, in m.
    wall : float or None
        Coefficient of restitution of the wall against which the block stands; None without a wall.
    stiffness, prestress, mass : float or None
        Stiffness of the restrainer in N/m, its force in the block at rest in N, and the mass of the block in kg; None without it.
    friction : float or None
        Coefficient of friction between block and base; None if friction is not considered.
    model : str
        Equation of motion: "slender" or "full".
    normalised_by : str
        Unit of the base acceleration of slender blocks: "tangent" or "angle".
    sizes, angles : Span
        Ranges of the map: half the diagonal R in m, and the critical angle in degrees.
    reading : int
        Number of the file in its session; not a field.
    """

    LINKED: ClassVar[tuple[str, ...]] = ("source", "scale", "height", "width")

    source: str = entry("example", word(*SOURCES))
    kind: str = entry("one-sine", word(*KINDS))
    amplitude: float = entry(0.5, number(1e-3, 20.0))
    duration: float = entry(1.0, number(0.01, 60.0))
    units: str = entry("", word(*UNITS))
    step: float | None = entry(None, optional(number(*STEPS)))
    channel: int = entry(1, count(1, CHANNELS))
    vertical: int | None = entry(None, optional(count(1, CHANNELS)))
    scale: float = entry(5.0, number(*SCALES))
    height: float = entry(2.0, number(*quantities.SIZES))
    width: float = entry(0.5, number(*quantities.SIZES))
    offset: float = entry(0.0, number(-quantities.SIZES[1], quantities.SIZES[1]))
    wall: float | None = entry(None, optional(number(0.0, 1.0)))
    stiffness: float | None = entry(None, optional(number(0.0, LARGEST)))
    prestress: float | None = entry(None, optional(number(0.0, LARGEST)))
    mass: float | None = entry(None, optional(number(*MASSES)))
    friction: float | None = entry(None, optional(number(*quantities.FRICTION.range)))
    model: str = entry("full", word(*MODELS))
    normalised_by: str = entry("tangent", word(*NORMALISATIONS))
    sizes: Span = axis(Span(0.2, 10.0), *SIZES, distinct, ENDS)
    angles: Span = axis(Span(3.0, 30.0), *SLENDERNESS, distinct, ENDS)
    reading: int = 0

    @property
    def block(self) -> Block:
        """Selected block: a rectangle with Housner's restitution or that of a wall, uniform but for the offset of its mass centre."""
        wall = None if self.wall is None else Wall(self.wall)
        block = Block(self.height, self.width, offset=self.offset, wall=wall, restrainer=self.restrainer)
        model, by = self.equation
        return block if self.restrainer is None else with_unit(block, unit_for(block, by, model))

    @property
    def restrainer(self) -> Restrainer | None:
        """Restrainer of the block; None without a stiffness and a force."""
        if self.mass is None or (self.stiffness is None and self.prestress is None):
            return None
        return Restrainer(self.stiffness or 0.0, self.prestress or 0.0, self.mass)

    @property
    def shaking(self) -> tuple[Any, ...]:
        """Fields that decide the base motion, without its scale."""
        chosen = {
            "pulse": (self.kind, self.amplitude, self.duration),
            "file": (self.reading, self.units, self.step, self.channel),
        }
        return (self.source, *chosen.get(self.source, ()))

    @property
    def upward(self) -> int | None:
        """Channel of the vertical motion; None without it."""
        return self.vertical if self.source == "file" else None

    @property
    def left_out(self) -> str:
        """Sentence on what the map leaves out; empty if this is nothing."""
        parts = {"vertical motion": self.upward, "friction": self.friction}
        names = " and ".join(name for name, value in parts.items() if value is not None)
        return f"The map is computed without {names}." if names else ""

    def changed(self, typed: Mapping[str, str]) -> GroundView:
        """Return the view with new values of some fields; another base motion is not scaled, but for that of the first view."""
        view = super().changed(typed)
        return view if "scale" in typed else view.begun_from(self)

    def begun_from(self, before: GroundView) -> GroundView:
        """Return the view with the factor that another base motion begins with."""
        if self.source == before.source:
            return self
        return evolve(self, scale=DEFAULT.scale if self.source == DEFAULT.source else 1.0)

    @property
    def equation(self) -> tuple[str, str | None]:
        """Equation of motion, and the unit of the base acceleration of slender blocks; None for the full equation."""
        return self.model, self.normalised_by if self.model == "slender" else None

    def checked(self) -> GroundView:
        """Return the view; raise Refused if its block has no restitution of Housner, or does not suit the equation of motion.

        Also if its mass centre is not above the base, or if it is restrained and something else does not suit that.
        """
        for name, value in (("stiffness", self.stiffness), ("prestress", self.prestress)):
            if value is not None and self.mass is None:
                raise Refused({name: f"{name} needs the mass of the block"})
        try:
            for angle in self.block.critical_angles:
                critical_angle_for(self.model, angle, self.width)
        except Refusal as error:
            raise self.refused(error) from None
        parts = {"vertical": (self.upward, ""), "friction": (self.friction, ", whose sliding is not checked")}
        unfit = {
            name: f"{name} must {RESTRAINED}{why}"
            for name, (value, why) in parts.items()
            if value is not None
        }
        if unfit and self.restrainer is not None:
            raise Refused(unfit)
        return self

    def at_point(self, size: float, degrees: float) -> dict[str, str]:
        """Return the fields, as text, of the block at a point of the map, with digits finer than the points.

        The blocks of the map are symmetric, and have neither a wall nor a restrainer.
        """
        size = min(max(size, self.sizes.low), self.sizes.high)
        angle = math.radians(min(max(degrees, self.angles.low), self.angles.high))
        steps = math.log(self.sizes.high / self.sizes.low), self.angles.width / self.angles.high
        digits = max(math.ceil(-math.log10(min(steps) / (POINTS - 1))) + 2, 5)
        sides = {"height": 2 * size * math.cos(angle), "width": 2 * size * math.sin(angle)}
        return {name: written(float(f"{side:.{digits}g}")) for name, side in sides.items()} | {
            "offset": "0",
            **dict.fromkeys(("wall", "stiffness", "prestress", "mass"), ""),
        }


DEFAULT = GroundView()


@define(eq=False, slots=False)
class Ground:
    """Base motion before its scale, with what the page says about it.

    Attributes
    ----------
    base : GroundMotion or Pulse
        Base motion in SI units.
    warnings : list of str
        Sentences of the reader of its file.
    vertical : GroundMotion or None
        Vertical motion, before its scale.
    """

    base: GroundMotion | Pulse
    warnings: list[str] = field(factory=list)
    vertical: GroundMotion | None = None

    @cached_property
    def note(self) -> str:
        """Sentence for each warning about a record; empty for none."""
        if not isinstance(self.base, GroundMotion):
            return ""
        vertical = vertical_sentence([self.base.component]) if self.base.vertical else ""
        drift = self.base.drift_doubt.partition(", or for example ")[0]  # the page removes no baseline
        sentences = filter(None, (*self.warnings, vertical, drift))
        return " ".join(f"{each[0].upper()}{each[1:]}." for each in sentences)

    @cached_property
    def sampled(self) -> GroundMotion:
        """Ground motion itself, or the samples of the pulse."""
        if isinstance(self.base, GroundMotion):
            return self.base
        times = np.linspace(0.0, self.base.span, PULSE_POINTS)
        return GroundMotion(
            self.base.acceleration(times), step=float(times[1]), name=f"{self.base.kind} pulse"
        )

    @property
    def name(self) -> str:
        """Name and component."""
        return " ".join(filter(None, (self.sampled.name, self.sampled.component)))

    @cached_property
    def peaks(self) -> tuple[float, float]:
        """Peak acceleration in m/s² and peak velocity in m/s."""
        return self.sampled.pga, self.sampled.pgv

    @cached_property
    def outline(self) -> tuple[np.ndarray, np.ndarray]:
        """Times in s and acceleration in g, thinned to the extremes of equal stretches."""
        times, values = thinned(self.sampled.times, self.sampled.acceleration)
        return times, values / GRAVITY

    @cached_property
    def facts(self) -> list[tuple[str, str]]:
        """Facts that do not depend on the scale, by name."""
        motion = self.sampled
        facts = [
            ("duration", f"{motion.duration:.4g} s"),
            ("significant duration (5–95 %)", f"{motion.significant_duration:.4g} s"),
        ]
        if isinstance(self.base, GroundMotion):
            facts.append(("samples", f"{motion.times.size:,}, every {motion.step:.4g} s"))
        if motion.file is not None:
            digest = motion.file.sha256[:12]
            facts.append(("file", f"{motion.file.name}, {motion.file.format}, SHA-256 {digest}…"))
        return facts

    def lifted(self, other: Ground) -> Ground:
        """Return the record with another one as its vertical motion, both up to the end of the shorter one; Refused for other steps."""
        base, up = self.sampled, other.sampled
        if up.step != base.step:
            allowed = f"have the time step of the horizontal channel, {base.step:g} s"
            raise Refused({"vertical": str(Refusal("vertical", allowed, Text(f"{up.step:g} s")))})
        sentences = [*dict.fromkeys((*self.warnings, *other.warnings))]
        base, up = same_end(base, up, sentences)
        return Ground(base, sentences, up)

    def scaled(self, scale: float) -> GroundMotion | Pulse:
        """Return the base motion times a factor."""
        if isinstance(self.base, GroundMotion):
            return self.base.scaled(scale)
        return Pulse(self.base.kind, amplitude=scale * self.base.amplitude, duration=self.base.duration)

    def line(self, scale: float) -> dict[str, np.ndarray]:
        """Return the scaled acceleration in g over the time in s."""
        times, values = self.outline
        return {"time": times, "acceleration": scale * values}

    def words(self, scale: float) -> dict[str, Any]:
        """Return name, peaks and durations of the scaled motion for the page."""
        pga, pgv = self.peaks
        facts = [
            ("PGA", f"{scale * pga / GRAVITY:.4g} g ({scale * pga:.4g} m/s²)"),
            ("PGV", f"{scale * pgv:.4g} m/s"),
            *self.facts,
        ]
        if self.vertical is not None:
            up = scale * self.vertical.acceleration / GRAVITY
            ends = f"{up.min():.4g} to {up.max():.4g} g".replace("-", "−")
            facts.append(("vertical motion", f"{self.vertical.component}, {ends}, positive upwards"))
        name = self.name or "ground motion"
        return {
            "name": name,
            "title": name if scale == 1.0 else f"{scale:.4g} × {name}",
            "facts": facts,
            "note": self.note,
            "pga": pga / GRAVITY,
        }


def thinned(times: np.ndarray, values: np.ndarray, most: int = MAX_DRAWN) -> tuple[np.ndarray, np.ndarray]:
    """Return a line with at most about `most` points: the smallest and largest value of equal stretches, and both ends."""
    if values.size <= most:
        return times, values
    edges = np.linspace(0, values.size, most // 2 + 1).astype(int)[:-1]
    lengths = np.diff(np.append(edges, values.size))
    place = np.repeat(np.arange(edges.size), lengths)
    order = np.lexsort((values, place))
    kept = np.unique(np.concatenate(([0, values.size - 1], order[edges], order[edges + lengths - 1])))
    return times[kept], values[kept]


@lru_cache(1)
def _synthetic() -> tuple[GroundMotion, ...]:
    return synthetic_ground_motions(3, seed=SEED)


@lru_cache(1)
def _example() -> GroundMotion:
    return example_ground_motion()


def ground_of(view: GroundView, channels: tuple[Ground, ...]) -> Ground:
    """Return the base motion of a view; `channels` are those of the file that the session has read.

    Refused if the vertical motion is none of the vertical channels, or if its time step is another one.
    """
    if view.source == "pulse":
        return Ground(Pulse(view.kind, amplitude=view.amplitude * GRAVITY, duration=view.duration))
    if view.source == "file":
        chosen = channels[min(view.channel, len(channels)) - 1]
        if view.upward is None:
            return chosen
        if view.upward not in vertical_channels(view, channels):
            raise Refused(
                {"vertical": "vertical must be a vertical channel of the file, other than the horizontal one"}
            )
        return chosen.lifted(channels[view.upward - 1])
    if view.source == "example":
        return Ground(_example())
    return Ground(_synthetic()[int(view.source[-1]) - 1])


def vertical_channels(view: GroundView, channels: tuple[Ground, ...]) -> dict[int, str]:
    """Return the names of the vertical channels of a file, by their number, without the one that is the horizontal motion."""
    numbered = enumerate((each.sampled for each in channels), 1)
    return {place: each.component for place, each in numbered if each.vertical and place != view.channel}


def read_file(name: str, data: bytes, view: GroundView) -> tuple[Ground, ...]:
    """Read all channels of a file from memory; RecordError or ValueError with one sentence if that is not possible."""
    if len(data) > MAX_FILE:
        raise ValueError(f"{name}: larger than {MAX_FILE // 1_000_000} MB")
    channels = read_apart(data, READING, name=name, units=view.units or None, step=view.step)
    return tuple(Ground(motion, warnings) for motion, warnings in channels)


def open_file(value: Any) -> tuple[str, bytes]:
    """Return name and bytes of a file that the page sends; ValueError for anything else."""
    name, data = (value.get("name"), value.get("data")) if isinstance(value, Mapping) else (None, None)
    if not isinstance(name, str) or not isinstance(data, bytes | bytearray | memoryview):
        raise ValueError("the file could not be received; please reload the page")
    return name[-255:] or "file", bytes(data)
