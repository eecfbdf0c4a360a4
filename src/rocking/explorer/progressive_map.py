"""What the response is at every point of a square of a plane, from coarse to fine."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator
from functools import cache, partial

import numpy as np
from attrs import field, frozen

from rocking.explorer.attractor_labels import Orbits
from rocking.explorer.view_state import Span
from rocking.explorer.worker_pools import Workers
from rocking.model import Kind
from rocking.plot.parts import legend
from rocking.survey import classify_points, classify_with_anchor

PERIOD = 64
FIELDS = {
    "look": np.uint8,
    "kind": np.uint8,
    "evidence": np.uint8,
    "response_period": np.int32,
    "impacts_per_period": np.int32,
    "symmetric": np.uint8,
    "exponent": np.float64,
    "orbit": np.uint8,
}
"""What is kept of each point: how it is drawn, and of the answers."""
UNDETERMINED = Kind.UNDETERMINED.code
FIRST, ALL = 60, 10_000
"""Cycles a point that stays open so long: of the first, coarse picture; of the finer ones."""
COARSEST = 8
PIECE = 0.12
"""Seconds that a piece of work takes, about: so long does a thread need to turn to something else."""
AHEAD = 2
"""Pieces that wait or are under way for each thread, lest it idle until the page's own thread comes to think of the next."""
START, FEW, LARGEST = 16, 256, 16_384
"""Points of the first piece, of the last ones of a grid, and at most; fewer wherever they are dear."""
FASTER = 8
"""Times the size of a piece that the next one may have: a few cheap points say little of the others."""
SHOWN_EVERY = 0.5
"""Seconds between two pictures of a grid that is not yet full."""
STRIPES, STRIPE = 7, 2
"""Points from one stripe of a hatch to the next, and across one."""
SHADES = 3
"""Of each look: orbits of one look have one after the other."""
PLAIN = SHADES * len(legend.LOOKS)
WHITE, DARK, NOTHING = PLAIN, PLAIN + 1, PLAIN + 2
"""Numbers of a picture's colours after those of the looks, shade by shade."""


@frozen
class Plane:
    """Two quantities that vary, by name, with their stretches, and what is fixed; `points` along either side in the end."""

    across: tuple[str, Span]
    up: tuple[str, Span]
    fixed: dict[str, float]
    points: int
    reach: float = np.inf  # no start lies beyond the braces
    first: int = FIRST  # cycles a point of the first picture: fewer where they are dear
    apart: bool = False  # whether orbits of one look are told apart: where one system has many starts

    def values(self, places: np.ndarray, side: int) -> dict[str, np.ndarray]:
        """The quantities at places, counted in C order, upward first, of a grid with `side` points along either side."""
        rows, columns = np.divmod(places, side)
        return {
            name: np.linspace(span.low, span.high, side)[at]
            for (name, span), at in ((self.across, columns), (self.up, rows))
        }


@frozen(eq=False)
class Picture:
    """A plane as far as it is known.

    Attributes
    ----------
    fields : dict of arrays (n, n)
        `FIELDS`, upward first.
    points : int
        Along either side of the finest grid.
    settled, of : int
        Points of this grid that are judged, and all.
    done : bool
        Whether nothing more will come.
    """

    fields: dict[str, np.ndarray] = field(repr=False)
    points: int
    settled: int
    of: int
    done: bool

    @property
    def look(self) -> np.ndarray:
        """Places in `LOOKS` (n, n); `NONE` where there is no start."""
        return self.fields["look"]

    def colours(self) -> np.ndarray:
        """The picture (points, points), of the finest grid whatever is known: stripes stay while it refines."""
        side = len(self.look)
        stride = (self.points - 1) // (side - 1)
        nearest = (np.arange(self.points) + stride // 2) // stride
        return _COLOURS[_stripes(self.points), self._drawn()[np.ix_(nearest, nearest)]]

    def counts(self) -> np.ndarray:
        """How many points of this grid have each shade (rows) of each look (columns)."""
        return np.bincount(self._drawn().ravel(), minlength=PLAIN + 1)[:PLAIN].reshape(SHADES, -1)

    def _drawn(self) -> np.ndarray:
        """The numbers of the shades of the looks; `PLAIN` where there is no start."""
        shade = self.fields["orbit"] % SHADES
        return np.where(self.look == legend.NONE, PLAIN, self.look + len(legend.LOOKS) * shade)


def _colours() -> np.ndarray:
    """The number of the colour of each shade and of nothing: off all stripes, on one of either hatch, where both cross."""
    hatches = np.array([look.hatch or "" for look in legend.LOOKS] * SHADES + [""])
    plain = np.append(np.arange(PLAIN), NOTHING)
    white = np.where(hatches == "white", WHITE, plain)
    dark = np.where((hatches != "white") & (hatches != ""), DARK, plain)
    return np.array([plain, white, dark, np.where(hatches == "white", white, dark)], np.uint8)


_COLOURS = _colours()


@cache
def _stripes(points: int) -> np.ndarray:
    """Where the stripes of the hatches lie: 1 those of white ones, 2 those of dark ones, 3 both."""
    up, across = np.ogrid[:points, :points]
    return ((up + across) % STRIPES < STRIPE) + 2 * ((up - across) % STRIPES < STRIPE).astype(np.uint8)


class Refinement:
    """A plane, judged from coarse to fine on the workers' threads, until `stop[0]` is set."""

    def __init__(self, plane: Plane, workers: Workers, stop: np.ndarray) -> None:
        self.plane, self.workers, self.stop = plane, workers, stop
        self.piece = START
        self.orbits = Orbits()
        self.fields: dict[str, np.ndarray] = {}

    def coarse(self) -> Picture:
        """The first picture, all of it at once: the only one that waits for no thread."""
        self._begin((self.plane.points - 1) // COARSEST + 1)
        places = np.flatnonzero(self.inside)
        self._keep(places, self._judge(places, self.plane.first))
        return self._picture(places.size, places.size)

    async def finer(self) -> AsyncIterator[Picture]:
        """One picture after the other, after `coarse`; the last one is done."""
        side, open_ = len(self.fields["kind"]), self.fields["kind"] == UNDETERMINED
        while side < self.plane.points:
            side = 2 * side - 1
            self._begin(side)
            due = np.ones((side, side), bool)
            due[::2, ::2] = open_
            async for picture in self._settle(np.flatnonzero(due & self.inside)):
                yield picture
            open_ = np.zeros((side, side), bool)

    async def _settle(self, places: np.ndarray) -> AsyncIterator[Picture]:
        """Judge the points at these places, a few at a time, and show how far it is now and then."""
        # all over the picture, and each piece as dear as the next
        order = np.random.default_rng(0).permutation(places)
        under_way: dict[asyncio.Future[tuple[dict[str, np.ndarray], float]], np.ndarray] = {}
        begun, settled, shown = 0, 0, time.perf_counter()
        while settled < order.size:
            while begun < order.size and len(under_way) < AHEAD * self.workers.count:
                piece = order[begun : begun + self._next(order.size - begun)]
                begun += piece.size
                under_way[asyncio.ensure_future(self.workers.later(partial(self._timed, piece)))] = piece
            done, _ = await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
            for future in done:
                piece = under_way.pop(future)
                answers, taken = future.result()
                self._keep(piece, answers)
                settled += piece.size
                times = min(PIECE / max(taken, 1e-6), FASTER)
                self.piece = min(max(int(piece.size * times), 1), LARGEST)
            if time.perf_counter() - shown > SHOWN_EVERY and settled < order.size:
                shown = time.perf_counter()
                yield self._picture(settled, order.size)
        yield self._picture(settled, order.size)

    def _next(self, left: int) -> int:
        """How many points the next piece has; the last ones have few, so that all threads come to the end together."""
        return min(self.piece, max(left // (AHEAD * self.workers.count), FEW))

    def _timed(self, places: np.ndarray) -> tuple[dict[str, np.ndarray], float]:
        begun = time.thread_time()
        return self._judge(places, ALL), time.thread_time() - begun

    def _judge(self, places: np.ndarray, cycles: int) -> dict[str, np.ndarray]:
        ask = classify_with_anchor if self.plane.apart else classify_points
        answers = ask(self.plane.values(places, self.side), self.plane.fixed, cycles, PERIOD, self.stop)
        if answers is None:
            raise asyncio.CancelledError
        return answers

    def _begin(self, side: int) -> None:
        """A grid of `side` × `side` points, each as the nearest one of the grid before."""
        self.side = side
        nearest = (np.arange(side) + 1) // 2
        for name, dtype in FIELDS.items():
            before = self.fields.get(name)
            self.fields[name] = (
                np.zeros((side, side), dtype) if before is None else before[np.ix_(nearest, nearest)]
            )
        values = self.plane.values(np.arange(side * side), side)
        angles = np.abs(values.get("angle", np.zeros(1)))
        self.inside = np.broadcast_to((angles <= self.plane.reach), side * side).reshape(side, side)
        self.fields["look"][~self.inside] = legend.NONE

    def _keep(self, places: np.ndarray, answers: dict[str, np.ndarray]) -> None:
        look = legend.looks(answers["kind"], answers["response_period"], answers["symmetric"])
        answers["look"] = look
        if self.plane.apart:
            states = np.column_stack([answers["orbit_angle"], answers["orbit_velocity"]])
            answers["orbit"] = self.orbits.numbers(look, states)
        for name in FIELDS.keys() & answers.keys():
            self.fields[name].reshape(-1)[places] = answers[name]

    def _picture(self, settled: int, of: int) -> Picture:
        kept = {name: values.copy() for name, values in self.fields.items()}
        done = self.side == self.plane.points and settled == of
        return Picture(kept, self.plane.points, settled, of, done)
