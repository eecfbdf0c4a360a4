"""Maps of the harmonic page: types of response over period and amplitude, and basins of attraction over initial states."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, lru_cache
from typing import Any, ClassVar

import numpy as np

from rocking.explorer.fields import Span
from rocking.explorer.figures import Axes
from rocking.explorer.harmonic_view import HarmonicView
from rocking.explorer.refinement import Measure, Picture, Results
from rocking.model.verdict import Kind
from rocking.plot import palette, style, theory_curves
from rocking.survey.attractors import classify_with_anchor, pairs_of_equal_states
from rocking.survey.verdict_measures import classify_points

PERIOD = 64
"""Largest response period that is sought, in forcing cycles."""
FIRST, ALL = 60, 10_000
"""Maximum number of cycles per point: in the first, coarse map, and in the finer maps."""
STRIPES, STRIPE = 7, 2
"""Spacing and width of the stripes of a hatch, in points."""
SHADES = 3
"""Shades per category; the orbits of a category use them in turn."""
PLAIN = SHADES * len(palette.LOOKS)
"""Number of shades of all categories."""
HATCH, NOTHING = PLAIN, PLAIN + 1
"""Palette indices after the shades: stripe of a hatch, transparent."""
SHADED = [look.shade(number) for number in range(SHADES) for look in palette.LOOKS]
PALETTE = [*SHADED, style.INK, "#00000000"]
"""Palette of a map, indexed by `colours`: shades of all categories, stripe of a hatch, transparent."""
CURVE_POINTS = 300
"""Periods at which a theoretical curve is evaluated."""
DASHES = {
    "existence-1": "2 3",
    "existence-3": "8 3 2 3 2 3",
    "symmetry-breaking-1": "",
    "symmetry-breaking-3": "10 4",
    "melnikov": "14 4 2 4",
    "heteroclinic": "20 4",
}
"""Dash patterns of the theoretical curves."""
DOTTED = "1 3"
"""Dash pattern where the mode is not admissible, as in `rocking.plot.parametric_map`."""
NAMES = {
    "existence-1": ("A<sub>E</sub>, (1, 1)", "Amplitude A_E above which the symmetric (1, 1) mode exists"),
    "existence-3": ("A<sub>E</sub>, (1, 3)", "Amplitude A_E above which the symmetric (1, 3) mode exists"),
    "symmetry-breaking-1": (
        "A<sub>SB</sub>, (1, 1)",
        "Amplitude A_SB up to which the symmetric (1, 1) mode is stable; dotted where the mode is not admissible",
    ),
    "symmetry-breaking-3": (
        "A<sub>SB</sub>, (1, 3)",
        "Amplitude A_SB up to which the symmetric (1, 3) mode is stable; dotted where the mode is not admissible",
    ),
    "melnikov": ("A<sub>M</sub> (Melnikov)", "Amplitude A_M above which the Melnikov function has zeros"),
    "heteroclinic": ("A<sup>*</sup> (tangency)", "Amplitude A* of the exact heteroclinic tangency"),
}

"""Labels of the theoretical curves, and their descriptions."""
MAX_ATTRACTORS = 16
"""Maximum number of distinct orbits per category; a longer list is of no use as a legend."""


class Responses(Measure):
    """Measure of the type of response over two quantities; `look` is the index in `LOOKS`.

    Parameters
    ----------
    across, up : tuple of (str, Span)
        Names and ranges of the two quantities.
    fixed : dict of str to float
        Constant parameters, by name.
    points : int
        Points along each side of the finest grid.
    first : int
        Maximum number of cycles per point in the first map. Default: 60; fewer if cycles are expensive.
    """

    types: ClassVar[Mapping[str, type]] = {
        "look": np.uint8,
        "kind": np.uint8,
        "evidence": np.uint8,
        "response_period": np.int32,
        "impacts_per_period": np.int32,
        "symmetric": np.uint8,
        "exponent": np.float64,
        "orbit": np.uint8,
    }
    classified = staticmethod(classify_points)

    def __init__(
        self,
        across: tuple[str, Span],
        up: tuple[str, Span],
        fixed: Mapping[str, float],
        points: int,
        first: int = FIRST,
    ) -> None:
        self.points, self.fixed, self.first = points, fixed, first
        (self.across, left_right), (self.up, bottom_top) = across, up
        self.columns = np.linspace(left_right.low, left_right.high, points)
        self.rows = np.linspace(bottom_top.low, bottom_top.high, points)

    def coarse(self, columns: np.ndarray, rows: np.ndarray, stop: np.ndarray) -> Results | None:
        """Classify points with few cycles."""
        return self._classify(columns, rows, self.first, stop)

    def fine(self, columns: np.ndarray, rows: np.ndarray, stop: np.ndarray) -> Results | None:
        """Classify points."""
        return self._classify(columns, rows, ALL, stop)

    def _classify(
        self, columns: np.ndarray, rows: np.ndarray, cycles: int, stop: np.ndarray
    ) -> Results | None:
        values = {self.across: self.columns[columns], self.up: self.rows[rows]}
        return self.classified(values, self.fixed, cycles, PERIOD, stop)

    def stored(self, results: Results) -> Results:
        """Return the results with their categories."""
        names = "kind", "response_period", "symmetric"
        return results | {"look": palette.looks(*(results[name] for name in names))}

    def undecided(self, fields: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return the points that the few cycles of the first map do not classify."""
        return np.asarray(fields["kind"] == Kind.UNDETERMINED.code)


class Basins(Responses):
    """Measure of the type of response over initial angle and velocity; angles beyond `reach`, the braces, are invalid."""

    def __init__(
        self,
        angles: Span,
        velocities: Span,
        fixed: Mapping[str, float],
        points: int,
        first: int = FIRST,
        reach: float = np.inf,
    ) -> None:
        super().__init__(("angle", angles), ("velocity", velocities), fixed, points, first)
        self.reach, self.orbits = reach, Orbits()

    def valid(self) -> np.ndarray:
        """Return the initial states between the braces."""
        return np.broadcast_to(np.abs(self.columns) <= self.reach, (self.points, self.points)).copy()

    def blank(self) -> dict[str, np.ndarray]:
        """Return the category of an invalid initial state where there is one."""
        fields = super().blank()
        fields["look"][~self.valid()] = palette.NONE
        return fields


class Attractors(Basins):
    """Measure of the attractors of initial states: orbits of one category are numbered in `orbit`."""

    classified = staticmethod(classify_with_anchor)

    def stored(self, results: Results) -> Results:
        """Return the results with their categories and orbits."""
        stored = super().stored(results)
        states = np.column_stack([stored["orbit_angle"], stored["orbit_velocity"]])
        return stored | {"orbit": self.orbits.numbers(stored["look"], states)}


class Orbits:
    """Orbits so far, numbered from 0 within each category of `LOOKS`, in order of discovery."""

    def __init__(self) -> None:
        self.met: dict[int, list[np.ndarray]] = {}

    def numbers(self, looks: np.ndarray, states: np.ndarray) -> np.ndarray:
        """Return the number of the orbit of each state, and add new orbits.

        Parameters
        ----------
        looks : array of int (n,)
            Indices in `LOOKS`.
        states : array of float (n, 2)
            Reference states (Θ, Θ') of the orbits; NaN without an orbit.

        Returns
        -------
        array of uint8 (n,)
            Numbers of the orbits; 0 also without an orbit and beyond `MAX_ATTRACTORS`.
        """
        numbers = np.zeros(len(looks), np.uint8)
        there = np.isfinite(states).all(axis=1)
        for look in np.unique(looks[there]).tolist():
            places = np.flatnonzero(there & (looks == look))
            self._number(numbers, places, states, self.met.setdefault(look, []))
        return numbers

    def _number(
        self, numbers: np.ndarray, left: np.ndarray, states: np.ndarray, met: list[np.ndarray]
    ) -> None:
        for number in range(MAX_ATTRACTORS):
            if not left.size:
                return
            if number == len(met):
                met.append(states[left[0]].copy())
            rows = pairs_of_equal_states(states[left], met[number][None])[:, 0]
            numbers[left[rows]] = number
            left = np.delete(left, rows)


# ---- contents of the figures


def colours(picture: Picture) -> np.ndarray:
    """Return palette indices, shape (points, points). The finest grid is used at all stages, to keep hatches in place.

    Until the map is done, undetermined points are blank: most of them only await more cycles.
    """
    stride = (picture.points - 1) // (picture.side - 1)
    nearest = (np.arange(picture.points) + stride // 2) // stride
    shades = _shades(picture)[np.ix_(nearest, nearest)]
    return _COLOURS[_stripes(picture.points), shades] if picture.done else _UNFINISHED[shades]


def counts(picture: Picture) -> np.ndarray:
    """Return the number of points per shade (rows) and category (columns)."""
    return np.bincount(_shades(picture).ravel(), minlength=PLAIN + 1)[:PLAIN].reshape(SHADES, -1)


def answers(picture: Picture, rate: float = 1.0) -> dict[str, np.ndarray]:
    """Return the results of all points, for the readout and the table; flat, rows upward. Exponents are multiplied by `rate`."""
    kept = picture.fields
    narrow = np.iinfo(np.int16)
    numbers = {
        name: np.clip(kept[name], narrow.min, narrow.max).astype(np.int16).ravel()
        for name in ("response_period", "impacts_per_period")
    }
    flat = {name: kept[name].ravel() for name in ("look", "evidence", "orbit")}
    return numbers | flat | {"exponent": (rate * kept["exponent"]).astype(np.float32).ravel()}


def _shades(picture: Picture) -> np.ndarray:
    """Return the indices of the shades; `PLAIN` for an invalid initial state."""
    look, shade = picture.fields["look"], picture.fields["orbit"] % SHADES
    return np.where(look == palette.NONE, PLAIN, look + len(palette.LOOKS) * shade)


_HATCHED = [look.hatch is not None for look in palette.LOOKS] * SHADES + [False]
_PLAIN = np.append(np.arange(PLAIN), NOTHING)
_COLOURS = np.array([_PLAIN, np.where(_HATCHED, HATCH, _PLAIN)], np.uint8)
"""Palette indices of all shades and of `PLAIN`: between the stripes (row 0) and on them (row 1)."""
_UNFINISHED = np.where(_HATCHED, NOTHING, _PLAIN).astype(np.uint8)
"""Palette indices of all shades and of `PLAIN` in a map that is not done."""


@cache
def _stripes(points: int) -> np.ndarray:
    """Return the stripes of a hatch: 1 on a stripe, otherwise 0."""
    up, across = np.ogrid[:points, :points]
    return ((up - across) % STRIPES < STRIPE).astype(np.uint8)


# ---- theoretical curves


def curves(view: HarmonicView, axes: Axes) -> dict[str, Any]:
    """Return the visible part of the selected curves, dotted where the mode is not admissible.

    They hold for a slender, symmetric block without braces; otherwise there are none.
    """
    columns: dict[str, Any] = {"xs": [], "ys": [], "dash": []}
    (dx, dy), scale = axes.base, view.units.factor
    hold = view.brace_angle is None and view.critical_angle is None and not view.left
    for name in view.curves if hold else ():
        periods, *lines = _curve(name, view.periods, view.amplitudes, view.restitution)
        for line, dash in zip(lines, (DASHES[name], DOTTED), strict=True):
            if np.isfinite(line).any():
                columns["xs"].append(periods * scale("period") - dx)
                columns["ys"].append(line * scale("amplitude") - dy)
                columns["dash"].append(dash)
    return columns


@lru_cache(64)
def _curve(name: str, across: Span, up: Span, restitution: float) -> tuple[np.ndarray, ...]:
    """Return the periods, and the amplitudes of a curve where its mode is admissible and where it is not."""
    periods = np.linspace(across.low, across.high, CURVE_POINTS)
    return periods, *theory_curves.lines_of(
        theory_curves.CURVES[name], periods, np.full(CURVE_POINTS, restitution), up.low, up.high
    )
