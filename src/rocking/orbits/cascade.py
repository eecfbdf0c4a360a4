"""Cascade of period doublings, and the value of the parameter at which it accumulates."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.orbit import orbit_columns
from rocking.model.quantity import SYSTEM_QUANTITIES
from rocking.model.result import Result, along, described
from rocking.model.text import counted, plus_minus
from rocking.model.validation import Refusal, instance, whole
from rocking.orbits.continuation import switch_branch
from rocking.orbits.parameter import check_range, coordinate_of, fixed_quantities
from rocking.orbits.special_points import PERIOD_DOUBLING, SpecialPoint

if TYPE_CHECKING:
    import xarray as xr

# A branch is followed this far on both sides of its special point, in distances of the last two period doublings: the next one is
# nearer by the ratio of the cascade.
WIDTH = 1.0


@frozen(eq=False)
class Cascade(ReadOnlyArrays, Result):
    """Cascade of period doublings; returned by `cascade`.

    Attributes
    ----------
    special : tuple of SpecialPoint
        Period doublings, each on the branch that bifurcates at the one before.
    end : str
        Reason why the cascade is not followed further.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=10.46, period=1.721328), restitution=0.8)
    >>> orbit = rk.classify(system).orbit
    >>> doubling = rk.continue_orbit(orbit, "amplitude", (10.3, 10.9)).special[0]
    >>> result = rk.cascade(doubling, (10.3, 10.9), doublings=6)
    >>> result.periods.tolist(), result.ratios.round(2).tolist()
    ([1, 2, 4, 8, 16, 32], [6.8, 4.93, 4.69, 4.67])
    """

    PLOT = "cascade"

    special: tuple[SpecialPoint, ...] = field(repr=False)
    end: str

    @property
    def values(self) -> NDArray[np.float64]:
        """Values of the parameter at the period doublings, shape (n,)."""
        return read_only(np.array([one.parameter for one in self.special]))

    @property
    def periods(self) -> NDArray[np.int64]:
        """Periods of the orbits that lose their stability, in forcing cycles, shape (n,)."""
        return read_only(np.array([one.orbit.period for one in self.special], np.int64))

    @property
    def ratios(self) -> NDArray[np.float64]:
        """Ratios of neighbouring distances, shape (n − 2,).

        They tend to 4.6692 with losses (Feigenbaum 1978, J. Stat. Phys. 19, 25), and to 8.7211 without (Greene et al. 1981,
        Physica D 3, 468).
        """
        distances = np.diff(self.values)
        return read_only(distances[:-1] / distances[1:])

    @property
    def accumulation(self) -> tuple[float, float]:
        """Value at which the cascade accumulates, by Aitken's extrapolation of the last three values, and its error.

        The error is the change by the last period doubling. Both are NaN for less than four period doublings.
        """
        if len(self.special) < 4:
            return math.nan, math.nan
        last, before = (
            _limit(self.values[end - 3 : end]) for end in (len(self.special), len(self.special) - 1)
        )
        return last, abs(last - before)

    @property
    def block(self) -> Any:
        """Block of the system, None if there is none."""
        return self.special[0].orbit.system.block

    def _data(self) -> xr.Dataset:
        import xarray as xr

        first = self.special[0]
        ratios = np.full(len(self.special), np.nan)
        ratios[1:-1] = self.ratios
        accumulation, error = self.accumulation
        ratio = ratios, "distance to the previous period doubling over that to the next"
        attributes = described("Cascade of period doublings") | {
            **fixed_quantities(first.orbit.system, first.name),
            "parameter": first.name,
            f"accumulation_{first.name}": accumulation,
            f"accumulation_{first.name}_error": error,
            "end": self.end,
        }
        variables = along("doubling", {"ratio": ratio, **orbit_columns([one.orbit for one in self.special])})
        coordinate = coordinate_of("doubling", first.name, self.values)
        return xr.Dataset(variables, {first.name: coordinate}, attributes)

    def _repr_html_(self) -> str | None:
        return super()._repr_html_() if len(self.special) > 1 else None

    def __str__(self) -> str:
        name, of, unit = SYSTEM_QUANTITIES[self.special[0].name].printed(self.block)
        values, periods = of(self.values), self.periods
        limit, reached = "", f"at {values[0]:.9g}{unit}, period {periods[0]}"
        if len(values) > 1:
            reached = f"{values[0]:.9g} to {values[-1]:.9g}{unit}, periods {periods[0]} to {periods[-1]}"
        if len(values) > 3:
            accumulation = plus_minus(*map(of, self.accumulation))
            limit = f", accumulation at {accumulation}{unit}, last ratio {self.ratios[-1]:.6g}"
        return f"cascade of {counted(len(values), 'period doubling')} over {name}, {reached}{limit}; end: {self.end}"


def cascade(special: SpecialPoint, bounds: tuple[float, float], doublings: int = 7) -> Cascade:
    """Follow a cascade of period doublings, and extrapolate where it accumulates.

    At each period doubling the branch of twice the period is followed to its own first period doubling. The range and the step of
    each branch come from the distance of the last two. If there is no period doubling in this range, `bounds` is the range.

    Parameters
    ----------
    special : SpecialPoint
        First period doubling, of a slender block.
    bounds : (float, float)
        Range of the parameter in which the cascade is followed; it contains the special point.
    doublings : int
        Number of period doublings wanted, with the first, in [2, 10]. Each takes about four times as long as the one before.
        Default: 7.

    Returns
    -------
    Cascade
        Period doublings, their ratios, and the accumulation.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or the block is not slender.
    ValueError
        If an argument lies outside its range, or if `special` is no period doubling.

    See Also
    --------
    continue_orbit : Follow an orbit through a parameter.
    switch_branch : Follow one branch that bifurcates.
    rocking.plot.cascade : Plot the distances.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=10.46, period=1.721328), restitution=0.8)
    >>> doubling = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10.3, 10.9)).special[0]
    >>> value, error = rk.cascade(doubling, (10.3, 10.9), doublings=6).accumulation
    >>> round(value, 5), error < 1e-5
    (10.73261, True)
    """
    instance("special", special, SpecialPoint)
    if special.kind != PERIOD_DOUBLING:
        raise Refusal("special", "be a period doubling", special.kind)
    low, high = check_range(special.name, bounds)
    requested = whole("doublings", doublings, 2, 10)
    rows, around, end = [special], (low, high), "number of period doublings wanted"
    while len(rows) < requested:
        for bounds in (around, (low, high)):
            (branch,) = switch_branch(rows[-1], bounds)
            following = [
                one
                for one in branch.special
                if one.kind == PERIOD_DOUBLING and one.orbit.period == branch.period
            ]
            if following:
                break
        else:
            end = f"no period doubling on the branch of period {branch.period}: {branch.ends[1]}"
            break
        rows.append(min(following, key=lambda one: one.index))
        width = WIDTH * abs(rows[-1].parameter - rows[-2].parameter)
        around = max(low, rows[-1].parameter - width), min(high, rows[-1].parameter + width)
    return Cascade(tuple(rows), end)


def _limit(values: np.ndarray) -> float:
    """Return the limit of a sequence by Aitken's method, from three values whose distances fall by a constant ratio."""
    first, second = np.diff(values)
    return float(values[2] + second * second / (first - second))
