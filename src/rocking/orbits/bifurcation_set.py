"""Bifurcation set: all curves of special points that a search finds in the plane of two parameters."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen

from rocking.model.progress import Bar
from rocking.model.result import Result, along, described
from rocking.model.system import System
from rocking.model.text import counted
from rocking.model.validation import WrongType, instance, one_of, whole
from rocking.orbits.bifurcation_curve import BifurcationCurve, bifurcation_curve
from rocking.orbits.branch import Branch
from rocking.orbits.codimension_two import codimension_two_columns
from rocking.orbits.continuation import continue_orbit, switch_branch
from rocking.orbits.event_chain import NAMES
from rocking.orbits.find_orbits import find_orbits
from rocking.orbits.parameter import check_range, check_step, fixed_quantities, plane, value_of, with_value
from rocking.orbits.special_points import BEGINS_BRANCH, PERIOD_DOUBLING, SpecialPoint

if TYPE_CHECKING:
    import xarray as xr

Range = tuple[float, float]
# A special point lies on a curve of its type if its distance is below this number of squared steps: chords cut corners.
ON_CURVE = 2.0


@frozen
class BifurcationSet(Result):
    """Curves of special points in the plane of two parameters; returned by `bifurcation_set`.

    Attributes
    ----------
    system : System
        System of which two parameters are varied.
    names : tuple of two str
        Names of the parameters.
    bounds : tuple of two (float, float)
        Their ranges.
    max_period : int
        Longest period of the orbits that were searched for, in forcing cycles.
    curves : tuple of BifurcationCurve
        Curves by period of their orbits, type and number of impacts.
    not_followed : int
        Number of special points from which no curve could be followed, and which lie on none.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=2.0), restitution=0.9)
    >>> result = rk.bifurcation_set(system, 1, grid=3, period=(1.5, 2.5), amplitude=(3.0, 12.0))
    >>> [(curve.kind, curve.impacts) for curve in result.curves]
    [('period-doubling', 2), ('symmetry-breaking', 2)]
    """

    PLOT = "bifurcation_set"
    LONG = ("point",)

    system: System
    names: tuple[str, str]
    bounds: tuple[Range, Range]
    max_period: int
    curves: tuple[BifurcationCurve, ...] = field(repr=False)
    not_followed: int

    def _data(self) -> xr.Dataset:
        import xarray as xr

        curves = self.curves
        points = np.concatenate([np.empty((0, 2)), *(curve.points for curve in curves)])
        special = codimension_two_columns(self.names, [one for curve in curves for one in curve.special])
        of_special, of_point = (
            np.repeat(np.arange(len(curves)), [len(each) for each in lists])
            for lists in ([curve.special for curve in curves], [curve.points for curve in curves])
        )
        special["special_curve"] = of_special, "number of the curve of the special point"
        of_curve = {
            "curve_kind": (np.array([curve.kind for curve in curves], "U17"), "type of the special points"),
            "curve_orbit_period": (
                np.array([curve.period for curve in curves], int),
                "forcing cycles per response period",
            ),
            "curve_impacts_per_period": (
                np.array([curve.impacts for curve in curves], int),
                "impacts per response period",
            ),
        }
        attributes = described("Bifurcation set") | {
            **fixed_quantities(self.system, *self.names),
            "max_period": self.max_period,
            "not_followed": self.not_followed,
        }
        variables = along("point", {"curve_number": (of_point, "number of the curve")}) | along(
            "curve", of_curve
        )
        return xr.Dataset(variables | along("special", special), plane(self.names, points), attributes)

    def __str__(self) -> str:
        counts = Counter(curve.kind for curve in self.curves)
        result = ", ".join(f"{number} of {kind}" for kind, number in counts.items()) or "none"
        lost = f"; {counted(self.not_followed, 'special point')} not followed" if self.not_followed else ""
        return f"bifurcation curves of orbits up to period {self.max_period}: {result}{lost}"


def bifurcation_set(
    system: System,
    max_period: int,
    *,
    grid: int = 12,
    step: float = 0.01,
    progress: bool = False,
    **ranges: Range,
) -> BifurcationSet:
    """Search for all bifurcation curves of periodic orbits in the plane of two parameters.

    On a grid of points periodic orbits are searched for. Each is followed through the second parameter, and from each special
    point of its branch the branches that bifurcate there. From each special point that lies on no known curve a new curve is
    followed.

    Parameters
    ----------
    system : System
        Slender block, base motion and braces. Its values of the two parameters do not matter.
    max_period : int
        Longest period of the orbits, in forcing cycles, in [1, 64].
    grid : int
        Number of values of each parameter at which orbits are searched for, in [1, 200]. Default: 12.
    step : float
        Largest step along branches and curves, as in `bifurcation_curve`. Default: 0.01.
    progress : bool
        Whether to show on stderr the part of the grid that is done, and the number of curves. Default: False.
    **ranges : (float, float)
        Lowest and highest value of two parameters, by their names as in `continue_orbit`: ``period=(0.5, 3), amplitude=(1, 16)``.

    Returns
    -------
    BifurcationSet
        Curves of folds, symmetry breakings, period doublings and grazings.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or if not two parameters have ranges. If the block is not slender.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    bifurcation_curve : Follow one special point.
    parametric_map : Classify the response at each point of such a plane.
    rocking.plot.bifurcation_set : Plot the set, also over a map.

    Notes
    -----
    Completeness is not guaranteed. A curve is missed if the branches that meet it contain no orbit of the grid, and do not
    bifurcate from branches that do. A larger `grid` and a smaller `step` make this less likely. Orbits with impacts that take
    all speed, because a coefficient of restitution is 0, are not followed.

    A grazing after which an orbit has no impact is not followed. Without braces it lies at A = 1 + Ω², where the saddle orbit
    Θ = ±(1 + β cos ψ) reaches the base, because β = A/(1 + Ω²).

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=2.0), restitution=0.9)
    >>> print(rk.bifurcation_set(system, 1, grid=3, period=(1.5, 2.5), amplitude=(3.0, 12.0)))
    bifurcation curves of orbits up to period 1: 1 of period-doubling, 1 of symmetry-breaking; 2 special points not followed
    """
    instance("system", system, System)
    longest = whole("max_period", max_period, 1, 64)
    number, step = whole("grid", grid, 1, 200), check_step(step)
    if len(ranges) != 2 or set(ranges) == {"period", "frequency"}:
        allowed = "hold the ranges of two different parameters, such as period=(0.5, 3), amplitude=(1, 16)"
        raise WrongType("ranges", allowed, ", ".join(ranges) or "none")
    for name in ranges:
        one_of("ranges", name, tuple(NAMES))
    first, second = ranges
    bounds = check_range(first, ranges[first], first), check_range(second, ranges[second], second)
    _ = system.harmonic  # refuses other base motions, and the full block
    with Bar(number**2, "bifurcation set", shown=instance("progress", progress, bool)) as bar:
        search = _Search((first, second), bounds, longest, step, bar)
        for value in _middles(bounds[0], number):
            at_value = with_value(system, first, value)
            search.along([with_value(at_value, second, other) for other in _middles(bounds[1], number)])
    curves = sorted(search.curves, key=lambda curve: (curve.period, curve.kind, curve.impacts))
    return BifurcationSet(system, (first, second), bounds, longest, tuple(curves), search.not_followed)


class _Search:
    """Curves that are known so far."""

    def __init__(
        self, names: tuple[str, str], bounds: tuple[Range, Range], max_period: int, step: float, bar: Bar
    ) -> None:
        self.names, self.bounds, self.max_period, self.step, self.bar = names, bounds, max_period, step, bar
        self.curves: list[BifurcationCurve] = []
        self.alone: list[SpecialPoint] = []

    def along(self, systems: list[System]) -> None:
        """Follow the orbits of systems that differ in the second parameter, and the branches that bifurcate from them."""
        seen: set[tuple[object, ...]] = set()
        for system in systems:
            branches = list(self.branches_of(system))
            while branches:
                for special in branches.pop().special:
                    key = _identity(special)
                    if key not in seen:
                        seen.add(key)
                        self.add(special)
                        branches += self.born_at(special)
            self.bar.advance(1)

    def branches_of(self, system: System) -> Iterator[Branch]:
        """Yield the branches of all orbits of a system; an orbit without events is a saddle orbit, whose branch has no end."""
        for orbit in find_orbits(system, self.max_period):
            if not orbit.superstable and (orbit.impacts or orbit.brace_hits):
                try:
                    yield continue_orbit(orbit, self.names[1], self.bounds[1], self.step)
                except ValueError:  # the orbit grazes, or is a branch point
                    continue

    def born_at(self, special: SpecialPoint) -> tuple[Branch, ...]:
        """Return the branches that bifurcate at a special point, one of each pair of mirror images."""
        longest = self.max_period // (2 if special.kind == PERIOD_DOUBLING else 1)
        if special.kind not in BEGINS_BRANCH or special.orbit.period > longest:
            return ()
        return switch_branch(special, self.bounds[1], self.step)[:1]

    def add(self, special: SpecialPoint) -> None:
        """Follow a special point through both parameters, unless it lies on a known curve."""
        if any(self.is_on(curve, special) for curve in self.curves):
            return
        try:
            curve = bifurcation_curve(special, *self.names, self.bounds, self.step)
        except ValueError:
            self.alone.append(special)
            return
        if len(curve) > 1:
            self.curves.append(curve)
            self.bar.text = counted(len(self.curves), "curve")
        else:
            self.alone.append(special)

    @property
    def not_followed(self) -> int:
        """Number of special points that lie on no curve."""
        return sum(not any(self.is_on(curve, each) for curve in self.curves) for each in self.alone)

    def is_on(self, curve: BifurcationCurve, special: SpecialPoint) -> bool:
        """Return whether a special point lies on a curve of its type, to the error of its chords."""
        orbit = special.orbit
        if (curve.kind, curve.period, curve.impacts) != (special.kind, orbit.period, orbit.impacts):
            return False
        return self.distance(curve, special) < ON_CURVE

    def distance(self, curve: BifurcationCurve, special: SpecialPoint) -> float:
        """Return the distance of a special point from a curve, in squared steps."""
        spans = np.array([high - low for low, high in self.bounds])
        here = np.array([value_of(special.orbit.system, name) for name in self.names]) / spans
        return _distance(curve.points / spans, here) / self.step**2


def _identity(special: SpecialPoint) -> tuple[object, ...]:
    """Return what mirror images of a special point have in common, to nine digits."""
    orbit = special.orbit
    return special.kind, orbit.period, orbit.impacts, orbit.brace_hits, f"{special.parameter:.8e}"


def _distance(line: np.ndarray, point: np.ndarray) -> float:
    """Return the distance of a point (2,) from a line through points (n, 2)."""
    start, along = line[:-1], np.diff(line, axis=0)
    off = point - start
    length = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
    share = np.clip((off * along).sum(axis=1) / length, 0.0, 1.0)
    return float(np.sqrt(((off - share[:, None] * along) ** 2).sum(axis=1).min()))


def _middles(ends: Range, number: int) -> list[float]:
    """Return the middles of equal parts of a range."""
    low, high = ends
    return [low + (high - low) * (part + 0.5) / number for part in range(number)]
