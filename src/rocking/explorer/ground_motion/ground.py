"""Base motions of the page: records, synthetic ground motions, pulses, and files that are read from memory."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from attrs import define, field

from rocking.explorer.ground_motion.view import GroundView
from rocking.model.block_formulas import GRAVITY
from rocking.model.forcing import Pulse
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.records.read import example_ground_motion, read_apart
from rocking.records.synthetic import synthetic_ground_motions

SEED = 1
MAX_FILE = 50_000_000
"""Largest file, in bytes."""
READING = 5.0
"""Longest time to read a file, s. The reading process is then killed."""
MAX_DRAWN = 4_000
"""Largest number of points of a drawn line."""
PULSE_POINTS = 4_001
"""Points at which a pulse is drawn and integrated; the corners of all forms of straight lines are among them."""


@define(eq=False, slots=False)
class Ground:
    """Base motion before its scale, with what the page says about it.

    Attributes
    ----------
    base : GroundMotion or Pulse
        Base motion in SI units.
    doubts : list of str
        Sentences of the reader of its file.
    """

    base: GroundMotion | Pulse
    doubts: list[str] = field(factory=list)

    @cached_property
    def note(self) -> str:
        """Sentence for each doubt about a record; empty for none."""
        if not isinstance(self.base, GroundMotion):
            return ""
        vertical = vertical_sentence([self.base.component]) if self.base.vertical else ""
        found = filter(None, (*self.doubts, vertical, self.base.drift_doubt))
        return " ".join(f"{each[0].upper()}{each[1:]}." for each in found)

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
        found = [
            ("duration", f"{motion.duration:.4g} s"),
            ("significant duration (5–95 %)", f"{motion.significant_duration:.4g} s"),
        ]
        if isinstance(self.base, GroundMotion):
            found.append(("samples", f"{motion.times.size:,}, every {motion.step:.4g} s"))
        if motion.file is not None:
            digest = motion.file.sha256[:12]
            found.append(("file", f"{motion.file.name}, {motion.file.format}, SHA-256 {digest}…"))
        return found

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
        return {"name": self.name or "ground motion", "facts": facts, "note": self.note, "pga": pga / GRAVITY}


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


def ground_of(shown: GroundView, channels: tuple[Ground, ...]) -> Ground:
    """Return the base motion of a view; `channels` are those of the file that the session has read."""
    if shown.source == "pulse":
        return Ground(Pulse(shown.kind, amplitude=shown.amplitude * GRAVITY, duration=shown.duration))
    if shown.source == "file":
        return channels[min(shown.channel, len(channels)) - 1]
    if shown.source == "example":
        return Ground(_example())
    return Ground(_synthetic()[int(shown.source[-1]) - 1])


def read_file(name: str, data: bytes, shown: GroundView) -> tuple[Ground, ...]:
    """Read all channels of a file from memory; RecordError or ValueError with one sentence if that is not possible."""
    if len(data) > MAX_FILE:
        raise ValueError(f"{name}: larger than {MAX_FILE // 1_000_000} MB")
    found = read_apart(data, READING, name=name, units=shown.units or None, step=shown.step)
    return tuple(Ground(motion, doubts) for motion, doubts in found)


def open_file(given: Any) -> tuple[str, bytes]:
    """Return name and bytes of a file that the page sends; ValueError for anything else."""
    name, data = (given.get("name"), given.get("data")) if isinstance(given, Mapping) else (None, None)
    if not isinstance(name, str) or not isinstance(data, bytes | bytearray | memoryview):
        raise ValueError("the file could not be received; please reload the page")
    return name[-255:] or "file", bytes(data)
