"""Contents of the figures of one motion; every function may run on any thread."""

from __future__ import annotations

import math
from asyncio import CancelledError
from collections.abc import Iterable
from functools import cache, lru_cache
from typing import Any

import numpy as np

from rocking.explorer import presets
from rocking.explorer.figures import no_image
from rocking.explorer.harmonic_maps import PERIOD
from rocking.explorer.harmonic_units import Contents
from rocking.explorer.harmonic_view import HarmonicView
from rocking.model.block import Block
from rocking.model.quantity import ANGLE
from rocking.model.system import State, System
from rocking.model.validation import TooManyEvents
from rocking.model.verdict import Outcome, Verdict
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.orbits.diagrams import orbit_diagram
from rocking.plot import motions, style
from rocking.response.classify import classify
from rocking.response.spectrum import Peak, spectral_density

Columns = dict[str, Any]
Ranges = tuple[float, float, float, float]

SOON, LATER = 10_000, 100_000
"""Maximum number of cycles of the first classification, and of the second one if the response is undetermined."""
PROBED = 3
"""Cycles of the run that estimates the cost of a cycle."""
SOON_HITS, LATER_HITS = 3e5, 3e6
"""Maximum number of impacts per figure: for the figures that a click waits for, and for the others."""
SETTLING, RECORD = 128, 256
"""Cycles discarded before the spectrum, and cycles used for it."""
HIGHEST, DECADES, NAMES = 3.05, 10.0, 6
"""Spectrum: highest multiple of the forcing frequency, decades shown below the maximum, and maximum number of named lines."""
NAME_ACROSS, NAME_UP = 0.45, 1.2
"""Distances below which two names of lines overlap: in multiples of the forcing frequency and in decades."""
NO_SPECTRUM = "No spectrum: the motion ends or has too many impacts"
SINGLE = 1_500
"""Maximum number of points drawn singly in a section. Beyond it, an image shows their density."""
CELLS = 360
"""Cells of that image along each side."""
MAX_RINGS = 64
"""Maximum number of points of a periodic orbit that are marked in a section."""
VALUES, TRANSIENT, KEPT = 240, 200, 32
"""Orbit diagram: parameter values, cycles discarded at each value and cycles recorded."""
PIECE_HITS = 3e5
"""Approximate number of impacts per part of an orbit diagram. The computation can stop only between two parts."""
PICTURE, PICTURE_POINTS = (168, 112), 1_200
"""Width and height of a picture of the gallery, in its own units, and about the largest number of its points."""
DRAWN = 4.0, 4.0
"""Height, in m, and slenderness H/B of the moving block, where they are not given."""
FARTHEST = 1e6
"""Largest angle drawn of a block that overturns. Within a long cycle the angle can exceed the range of doubles."""
ROOM = 0.06
"""Margin of an axis, as a fraction of the range of the values."""
MARGIN = 1e-9
"""Minimum length of the time axis."""
SAME = 1e-6
"""Relative range below which values differ only by rounding."""


@lru_cache(256)
def hits_per_cycle(system: System, start: State) -> float:
    """Estimate the impacts per cycle, at least 1, from the first cycles; infinite if there are too many to compute."""
    for cycles in (1, PROBED):
        try:
            motion = simulate(system, start, cycles=cycles, record="none")
        except TooManyEvents:
            return math.inf
        hits = (motion.impacts + motion.brace_hits) / motion.cycles
        if hits > SOON_HITS:
            return math.inf
    return max(hits, 1.0)


def crowded(view: HarmonicView) -> bool:
    """Return whether a cycle has too many impacts for a figure."""
    return math.isinf(hits_per_cycle(view.system, view.start))


def affordable(view: HarmonicView, cycles: int, hits: float = SOON_HITS) -> int:
    """Reduce a number of cycles to those that one figure may take; at least 1."""
    return int(max(min(cycles, hits / hits_per_cycle(view.system, view.start)), 1))


def verdict(view: HarmonicView) -> Verdict:
    """Classify the response."""
    return classify(view.system, view.start, affordable(view, SOON), PERIOD)


def traces(view: HarmonicView) -> dict[str, Contents]:
    """Return the time history and the phase portrait of the cycles shown."""
    try:
        if crowded(view):
            raise TooManyEvents(NO_SPECTRUM)
        motion, begin = _motion(view)
    except TooManyEvents:
        nothing: Columns = {"time": [], "angle": [], "velocity": []}
        hits: Columns = {"angle": [], "velocity": [], "colour": []}
        empty = {"ranges": (0.0, 1.0, -1.0, 1.0), "line": nothing}
        return {"history": empty, "portrait": empty | {"hits": hits}}
    start, stop = _shown_of(motion)
    trace = np.array(motions.trace(motion, start, stop))
    time, angle, velocity = trace[:, np.abs(trace[1]) <= FARTHEST]
    events = motions.inside(motion.events, start, stop)
    struck = events[np.isin(events["kind"], ("impact", "brace"))]
    colours = np.where(struck["kind"] == "brace", style.BRACE, style.IMPACT)
    time = time + begin
    return {
        "history": {
            "ranges": (time[0], max(time[-1], time[0] + MARGIN), *_around(angle)),
            "line": {"time": time, "angle": angle, "velocity": velocity},
        },
        "portrait": {
            "ranges": (*_around(angle), *_around(velocity)),
            "line": {"angle": angle, "velocity": velocity},
            "hits": {"angle": struck["angle"], "velocity": struck["after"], "colour": colours.tolist()},
        },
    }


def _motion(view: HarmonicView) -> tuple[Motion, float]:
    """Simulate the cycles shown; the cycles before them are not recorded.

    Returns
    -------
    tuple of (Motion, float)
        Motion with all events, and its initial time τ.
    """
    system, start, before = view.system, view.start, 0
    if view.first:
        earlier = simulate(system, start, cycles=affordable(view, view.first), record="none")
        if earlier.outcome is not Outcome.OVERTURNED and _is_start(earlier.final):
            start, before = earlier.final, earlier.cycles
    return simulate(system, start, cycles=affordable(view, view.cycles)), before * view.period


def _is_start(state: State) -> bool:
    """Return whether a state is a valid initial state; a long motion can leave the allowed range."""
    return max(abs(state.angle), abs(state.velocity)) <= ANGLE.range[1]


def _shown_of(motion: Motion) -> tuple[float, float]:
    if motion.outcome is Outcome.AT_REST:
        return 0.0, motions.settled(motion)
    return motions.window(motion, None)


def _around(values: np.ndarray) -> tuple[float, float]:
    """Return the range of values with a margin, a wider one if they differ only by rounding."""
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)
    size = max(abs(low), abs(high))
    room = ROOM * (high - low) if high - low > SAME * size else max(0.5 * size, 0.1)
    return low - room, high + room


@cache
def pictures() -> dict[str, str]:
    """Return a small phase portrait of each case of the gallery, as the path of an SVG picture."""
    return {case.name: _path(traces(case.view)["portrait"]) for case in presets.CASES}


def _path(portrait: Contents) -> str:
    left, right, bottom, top = portrait["ranges"]
    angle, velocity = (portrait["line"][name] for name in ("angle", "velocity"))
    wide, high = PICTURE
    across, up = (angle - left) / (right - left) * wide, (top - velocity) / (top - bottom) * high
    places = np.rint(np.column_stack([across, up])).astype(int)[:: max(len(angle) // PICTURE_POINTS, 1)]
    moves = places[np.append(True, np.any(np.diff(places, axis=0) != 0, axis=1))]
    return "M" + "L".join(f"{x} {y}" for x, y in moves.tolist())


def scene(view: HarmonicView) -> dict[str, Any]:
    """Return what the page needs to draw the moving block: lengths in m, and angle and time in the units of the history.

    The base has the displacement −`base` cos(`frequency` t + `phase`). A block that is not given has any size.
    """
    height, slenderness = DRAWN
    width = height * math.tan(view.critical_angle) if view.critical_angle else height / slenderness
    block = view.block or Block(height, width, view.restitution)
    critical, period = view.units.factor("angle"), view.units.shown("period", view.period)
    displacement = block.acceleration(view.amplitude) / (math.tau / block.seconds(view.period)) ** 2
    return {
        "height": block.height,
        "width": block.width,
        "critical": block.critical_angle,
        "centre": [block.offset, block.centre_height] if block.offset else None,
        "unit": 1.0 / critical,
        "base": float(displacement),
        "frequency": math.tau / period,
        "phase": view.phase,
    }


def spectrum(view: HarmonicView) -> Contents:
    """Return the power spectral density after the transient, over multiples of the forcing frequency.

    Its strongest lines have names. If there is no spectrum, `why` gives the reason.
    """
    try:
        if crowded(view):
            raise TooManyEvents(NO_SPECTRUM)
        motion = simulate(view.system, view.start, cycles=affordable(view, SETTLING + RECORD))
        density = spectral_density(motion, transient=SETTLING)
    except ValueError:
        nothing: Columns = {"frequency": [], "density": []}
        names = nothing | {"name": []}
        return {"ranges": (0.0, HIGHEST, 1e-6, 1.0), "line": nothing, "names": names, "why": NO_SPECTRUM}
    multiples = density.forcing_multiples
    kept = (multiples > 0) & (multiples <= HIGHEST) & (density.density > 0)
    heights = density.density[kept]
    top = float(heights.max()) if heights.size else 1.0
    bottom = top * 10.0**-DECADES  # with fewer decades, the labels of all of them overlap
    return {
        "ranges": (0.0, HIGHEST, bottom, top * (top / bottom) ** 0.18),
        "line": {"frequency": multiples[kept], "density": heights},
        "names": _names(density.peaks, view.period),
        "why": "",
    }


def _names(peaks: Iterable[Peak], period: float) -> Columns:
    """Return the names of the strongest lines that do not overlap, and their places."""
    named: list[tuple[float, float, str]] = []
    for peak in peaks:
        multiple = peak.frequency * period
        clear = all(
            abs(multiple - across) >= NAME_ACROSS or abs(math.log10(peak.height / up)) >= NAME_UP
            for across, up, _ in named
        )
        if peak.name and multiple <= HIGHEST * 0.97 and clear and len(named) < NAMES:
            named.append((multiple, peak.height, peak.name))
    return {key: [each[k] for each in named] for k, key in enumerate(("frequency", "density", "name"))}


class Section:
    """Poincaré section that grows by continuing the motion."""

    def __init__(self, view: HarmonicView) -> None:
        self.view, self.last = view, view.start
        self.points = np.empty((0, 2))
        self.ended = ""

    def grow(self, cycles: int) -> None:
        """Add cycles, unless the block overturned, rests or has too many impacts."""
        if crowded(self.view) or len(self.points) + cycles > affordable(self.view, LATER, LATER_HITS):
            self.ended = "too many impacts"
            return
        motion = simulate(self.view.system, self.last, cycles=cycles, record="section")
        self.points = np.concatenate([self.points, motion.section()[:-1]])
        self.last = motion.final
        if motion.outcome is not Outcome.BOUNDED:
            self.ended = motion.outcome.replace("-", " ")
        elif not _is_start(self.last):
            self.ended = "too fast"

    def drawn(self, period: int | None) -> Contents:
        """Return the section without the transient: single points, or an image of their density.

        With it come the periodic orbit that the motion reaches, and all points, for the table.
        """
        omitted = self._omitted()
        points, last = self.points[omitted:], self.points[len(self.points) - (period or 0) :]
        ranges = *_around(points[:, 0]), *_around(points[:, 1])
        drawn = {
            "ranges": ranges,
            "label": _section_label(self.view.units.label("angle"), omitted, len(self.points), self.ended),
            "orbit": {"angle": last[:MAX_RINGS, 0], "velocity": last[:MAX_RINGS, 1]},
            "answers": {"angle": points[:, 0].copy(), "velocity": points[:, 1].copy()},
        }
        places, first, counts = np.unique(_cells(points, ranges), return_index=True, return_counts=True)
        if len(places) <= SINGLE:
            single = {"angle": points[first, 0], "velocity": points[first, 1]}
            return drawn | {"points": single, "dense": no_image()}
        image = np.zeros(CELLS * CELLS, np.uint8)
        image[places] = np.minimum(1 + np.log2(counts), 8)
        left, right, bottom, top = ranges
        dense = {"image": [image.reshape(CELLS, CELLS)], "x": [left], "y": [bottom]}
        dense |= {"w": [right - left], "h": [top - bottom]}
        return drawn | {"points": {"angle": [], "velocity": []}, "dense": dense}

    def _omitted(self) -> int:
        """Return the number of cycles omitted as transient: a tenth of all, at least `TRANSIENT`, at most nine tenths.

        A motion that overturned or rests is all transient and is shown whole. An undamped motion has no transient.
        """
        braced = self.view.brace_angle is not None
        undamped = self.view.restitution == 1.0 and not (braced and self.view.brace_restitution < 1.0)
        if undamped or self.ended in ("overturned", "at rest"):
            return 0
        computed = len(self.points)
        return min(max(computed // 10, TRANSIENT), 9 * computed // 10)


def _section_label(angle: str, omitted: int, last: int, ended: str) -> str:
    """Return the label of the angle, with the cycles shown, counted from 1, and the reason if the motion ended."""
    cycles = f"cycle{'s' * (last > 1)} {omitted + 1:,}{f'–{last:,}' * (last > 1)}" if last else ""
    return ", ".join(filter(None, (angle, cycles, ended)))


def _cells(points: np.ndarray, spans: Ranges) -> np.ndarray:
    """Return the index of the cell of each point, in C order: rows upward, then columns."""
    low, high = np.array(spans[::2]), np.array(spans[1::2])
    columns, rows = np.clip((points - low) / (high - low) * CELLS, 0, CELLS - 1).astype(int).T
    return rows * CELLS + columns


def diagram(view: HarmonicView, stop: np.ndarray) -> Contents:
    """Return the orbit diagram along an axis of the map; it is empty if a value has too many impacts.

    Every run starts from the initial state. CancelledError: if another thread has set `stop[0]`.
    """
    span = view.varied
    values = np.linspace(span.low, span.high, VALUES)
    columns: Columns = {"value": [], "angle": []}
    if (angles := _diagram_angles(view, values, stop)) is not None:
        kept = np.isfinite(angles)
        columns = {"value": np.broadcast_to(values[:, None], angles.shape)[kept], "angle": angles[kept]}
    ranges = span.low, span.high, *_around(np.asarray(columns["angle"]))
    return {"ranges": ranges, "label": view.units.label(view.vary), "points": columns}


def _diagram_angles(view: HarmonicView, values: np.ndarray, stop: np.ndarray) -> np.ndarray | None:
    """Return the angles of the orbit diagram (values, cycles); None if a value has too many impacts."""
    hits = 1.0
    for each in (view, *map(view.at, (values[0], values[VALUES // 2], values[-1]))):
        if stop[0]:
            raise CancelledError
        hits = max(hits, hits_per_cycle(each.system, view.start))
        if math.isinf(hits):
            return None
    share = min(LATER_HITS / (hits * VALUES * (TRANSIENT + KEPT)), 1.0)
    transient, cycles = int(share * TRANSIENT), max(int(share * KEPT), 1)
    arguments: dict[str, Any] = {"sweep": "rest", "transient": transient, "cycles": cycles}
    pieces = []
    for piece in np.array_split(
        values, min(math.ceil(hits * VALUES * (transient + cycles) / PIECE_HITS), VALUES)
    ):
        if stop[0]:
            raise CancelledError
        try:
            piece_diagram = orbit_diagram(view.system, view.start, **arguments | {view.vary: piece})
        except TooManyEvents:
            return None
        pieces.append(piece_diagram.points[0, :, :, 0])
    return np.concatenate(pieces)


def longer_verdict(view: HarmonicView) -> Verdict:
    """Classify again, with up to `LATER` cycles, a response that is undetermined after `SOON` cycles."""
    return classify(view.system, view.start, affordable(view, LATER, LATER_HITS), PERIOD)
