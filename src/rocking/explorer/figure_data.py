"""From what is shown to what is drawn of one motion: numbers alone, computed on any thread."""

from __future__ import annotations

import math
from asyncio import CancelledError
from functools import lru_cache
from typing import Any

import numpy as np
from attrs import frozen

from rocking.explorer.bokeh_figures import no_image
from rocking.explorer.view_state import Span, ViewState
from rocking.model import MAX_START, Outcome, State, System, TooManyEvents, Verdict
from rocking.motion import Motion, simulate
from rocking.orbits import orbit_diagram
from rocking.plot.parts import sample_times as instants
from rocking.plot.parts import style
from rocking.response import classify, spectral_density

Columns = dict[str, Any]
Ranges = tuple[float, float, float, float]

SOON, LATER = 10_000, 100_000
"""Cycles that a click waits for to be judged; and those after which what is then still open is judged again."""
PROBED = 3
SOON_HITS, LATER_HITS = 3e5, 3e6
"""Impacts and brace hits that a picture may take, of those that a click waits for, and of the others."""
PERIOD = 64
SETTLING, RECORD = 128, 256
"""Cycles left out before a spectrum, and taken for it."""
HIGHEST, DECADES, NAMES = 3.05, 10.0, 6
"""Of a spectrum: up to which multiple of the base's frequency, how deep, and how many lines are named."""
NAME_ACROSS, NAME_UP = 0.45, 1.2
"""Names nearer than this, in multiples across and in decades up, would run into each other."""
NO_SPECTRUM = "no spectrum: the motion ends, or has too many events"
SINGLE = 1_500
"""Places in a section that are drawn as points; of more it is shown how dense they lie."""
CELLS = 360
MAX_RINGS = 64
VALUES, TRANSIENT, KEPT = 240, 200, 32
PIECE_HITS = 3e5
"""Impacts and brace hits of a piece of a diagram, about: it cannot end before a piece does."""
FARTHEST = 1e6
"""Angle up to which a block is drawn that starts beyond return: no double holds where a long cycle takes it."""
ROOM = 0.06
MARGIN = 1e-9
SAME = 1e-6


@lru_cache(256)
def hits_per_cycle(system: System, start: State) -> float:
    """Impacts and brace hits in one of the first cycles, at least 1: what a cycle costs; infinite where it costs too much."""
    for cycles in (1, PROBED):
        try:
            motion = simulate(system, start, cycles=cycles, record="none")
        except TooManyEvents:
            return math.inf
        hits = (motion.impacts + motion.brace_hits) / motion.cycles
        if hits > SOON_HITS:
            return math.inf
    return max(hits, 1.0)


def crowded(shown: ViewState) -> bool:
    """Whether a cycle has more events than a picture can follow."""
    return math.isinf(hits_per_cycle(shown.system, shown.start))


def affordable(shown: ViewState, cycles: int, hits: float = SOON_HITS) -> int:
    """So many cycles, or as many as may be computed for one picture."""
    return int(max(min(cycles, hits / hits_per_cycle(shown.system, shown.start)), 1))


@frozen(eq=False)
class Response:
    """What a system does from its start, as it is drawn."""

    verdict: Verdict
    history: Columns
    portrait: Columns
    hits: Columns
    spans: dict[str, Ranges]


@frozen(eq=False)
class Spectrum:
    """A spectral density as it is drawn, or why there is none."""

    line: Columns
    names: Columns
    ranges: Ranges
    why: str = ""


@frozen(eq=False)
class Drawn:
    """A section as it is drawn: single points, or how dense they lie; and the orbit that it comes to."""

    points: Columns
    dense: Columns
    orbit: Columns
    ranges: Ranges


def response(shown: ViewState) -> Response:
    """The motion over the cycles shown, and what it is."""
    found = classify(shown.system, shown.start, affordable(shown, SOON), PERIOD)
    try:
        if crowded(shown):
            raise TooManyEvents(NO_SPECTRUM)
        motion, begin = _motion(shown)
    except TooManyEvents:
        nothing: Columns = {"time": [], "angle": [], "velocity": []}
        empty: Columns = {"angle": [], "velocity": [], "colour": []}
        plain = (0.0, 1.0, -1.0, 1.0)
        return Response(found, nothing, nothing, empty, {"history": plain, "portrait": plain})
    start, stop = _shown_of(motion)
    trace = np.array(instants.trace(motion, start, stop))
    time, angle, velocity = trace[:, np.abs(trace[1]) <= FARTHEST]
    events = instants.inside(motion.events, start, stop)
    hits = events[np.isin(events["kind"], ("impact", "brace"))]
    colours = np.where(hits["kind"] == "brace", style.BRACE, style.IMPACT)
    time = time + begin
    return Response(
        verdict=found,
        history={"time": time, "angle": angle, "velocity": velocity},
        portrait={"angle": angle, "velocity": velocity},
        hits={"angle": hits["angle"], "velocity": hits["after"], "colour": colours.tolist()},
        spans={
            "history": (time[0], max(time[-1], time[0] + MARGIN), *_around(angle)),
            "portrait": (*_around(angle), *_around(velocity)),
        },
    )


def _motion(shown: ViewState) -> tuple[Motion, float]:
    """The cycles shown with all their events, and the time at which they begin; those before it leave no trace."""
    system, start, before = shown.system, shown.start, 0
    if shown.first:
        earlier = simulate(system, start, cycles=affordable(shown, shown.first), record="none")
        if earlier.outcome is not Outcome.OVERTURNED and _is_start(earlier.final):
            start, before = earlier.final, earlier.cycles
    return simulate(system, start, cycles=affordable(shown, shown.cycles)), before * shown.period


def _is_start(state: State) -> bool:
    """Whether a motion can begin there: what a long one reaches may lie beyond."""
    return max(abs(state.angle), abs(state.velocity)) <= MAX_START


def _shown_of(motion: Motion) -> tuple[float, float]:
    if motion.outcome is Outcome.AT_REST:
        return 0.0, instants.settled(motion)
    return instants.window(motion, None)


def _around(values: np.ndarray) -> tuple[float, float]:
    """A range with some room around values, and more where they are all the same but for rounding."""
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)
    size = max(abs(low), abs(high))
    room = ROOM * (high - low) if high - low > SAME * size else max(0.5 * size, 0.1)
    return low - room, high + room


def spectrum(shown: ViewState) -> Spectrum:
    """The spectral density after the transient, in units of the base's frequency."""
    try:
        if crowded(shown):
            raise TooManyEvents(NO_SPECTRUM)
        motion = simulate(shown.system, shown.start, cycles=affordable(shown, SETTLING + RECORD))
        density = spectral_density(motion, transient=SETTLING)
    except ValueError:
        nothing: Columns = {"frequency": [], "density": []}
        return Spectrum(nothing, nothing | {"name": []}, (0.0, HIGHEST, 1e-6, 1.0), NO_SPECTRUM)
    multiples = density.forcing_multiples
    kept = (multiples > 0) & (multiples <= HIGHEST) & (density.density > 0)
    heights = density.density[kept]
    top = float(heights.max()) if heights.size else 1.0
    bottom = max(top * 10.0**-DECADES, float(heights.min()) if heights.size else 0.0)
    named: list[tuple[float, float, str]] = []
    for peak in density.peaks:
        multiple = peak.frequency * shown.period
        clear = all(
            abs(multiple - across) >= NAME_ACROSS or abs(math.log10(peak.height / up)) >= NAME_UP
            for across, up, _ in named
        )
        if peak.name and multiple <= HIGHEST * 0.97 and clear and len(named) < NAMES:
            named.append((multiple, peak.height, peak.name))
    names = {key: [each[k] for each in named] for k, key in enumerate(("frequency", "density", "name"))}
    ranges = (0.0, HIGHEST, bottom, top * (top / bottom) ** 0.18)
    return Spectrum({"frequency": multiples[kept], "density": heights}, names, ranges)


class Section:
    """A section that grows: the motion goes on from where it was."""

    def __init__(self, shown: ViewState) -> None:
        self.shown, self.last = shown, shown.start
        self.points = np.empty((0, 2))
        self.ended = ""

    def grow(self, cycles: int) -> None:
        """So many cycles more, unless the block overturned or rests, or has too many events."""
        if crowded(self.shown) or len(self.points) + cycles > affordable(self.shown, LATER, LATER_HITS):
            self.ended = "too many events"
            return
        motion = simulate(self.shown.system, self.last, cycles=cycles, record="section")
        self.points = np.concatenate([self.points, motion.section()[:-1]])
        self.last = motion.final
        if motion.outcome is not Outcome.BOUNDED:
            self.ended = str(motion.outcome)
        elif not _is_start(self.last):
            self.ended = "too fast"

    def drawn(self, period: int | None) -> Drawn:
        """What is there of it, with the orbit of that period that it comes to."""
        points, last = self.points, self.points[len(self.points) - (period or 0) :]
        spans = *_around(points[:, 0]), *_around(points[:, 1])
        orbit = {"angle": last[:MAX_RINGS, 0], "velocity": last[:MAX_RINGS, 1]}
        places, first, counts = np.unique(_cells(points, spans), return_index=True, return_counts=True)
        if len(places) <= SINGLE:
            return Drawn({"angle": points[first, 0], "velocity": points[first, 1]}, no_image(), orbit, spans)
        image = np.zeros(CELLS * CELLS, np.uint8)
        image[places] = np.minimum(1 + np.log2(counts), 8)
        left, right, bottom, top = spans
        dense = {
            "image": [image.reshape(CELLS, CELLS)],
            "x": [left],
            "y": [bottom],
            "w": [right - left],
            "h": [top - bottom],
        }
        return Drawn({"angle": [], "velocity": []}, dense, orbit, spans)


def _cells(points: np.ndarray, spans: Ranges) -> np.ndarray:
    """The cell of each point, counted in C order, upward first."""
    left, right, bottom, top = spans
    columns = np.clip((points[:, 0] - left) / (right - left) * CELLS, 0, CELLS - 1).astype(int)
    rows = np.clip((points[:, 1] - bottom) / (top - bottom) * CELLS, 0, CELLS - 1).astype(int)
    return rows * CELLS + columns


def diagram(shown: ViewState, stop: np.ndarray) -> tuple[Columns, Ranges]:
    """What is left of the motion after a transient, at values all along the map's axis, each from the start.

    CancelledError once another thread has set `stop[0]`.
    """
    span: Span = shown.varied
    values = np.linspace(span.low, span.high, VALUES)
    start: State = shown.start
    nothing: Columns = {"value": [], "angle": []}
    ranges = span.low, span.high, *_around(np.empty(0))
    hits = 1.0
    for each in (shown, *(shown.at(value) for value in (span.low, values[VALUES // 2], span.high))):
        if stop[0]:
            raise CancelledError
        hits = max(hits, hits_per_cycle(each.system, start))
        if math.isinf(hits):
            return nothing, ranges
    share = min(LATER_HITS / (hits * VALUES * (TRANSIENT + KEPT)), 1.0)
    lengths = int(share * TRANSIENT), max(int(share * KEPT), 1)
    pieces = []
    for piece in np.array_split(values, min(math.ceil(hits * VALUES * sum(lengths) / PIECE_HITS), VALUES)):
        if stop[0]:
            raise CancelledError
        try:
            found = orbit_diagram(shown.system, shown.vary, piece, start, "rest", *lengths)
        except TooManyEvents:
            return nothing, ranges
        pieces.append(found.points[0, :, :, 0])
    angles = np.concatenate(pieces)
    kept = np.isfinite(angles)
    columns = {"value": np.broadcast_to(values[:, None], angles.shape)[kept], "angle": angles[kept]}
    return columns, (span.low, span.high, *_around(columns["angle"]))


def judge_longer(shown: ViewState) -> Verdict:
    """What is open after `SOON` cycles, after `LATER`."""
    return classify(shown.system, shown.start, affordable(shown, LATER, LATER_HITS), PERIOD)
