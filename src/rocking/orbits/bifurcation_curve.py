"""Bifurcation curves in the plane of two parameters: fold, symmetry breaking, period doubling and grazing."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.kernels.orbits import arclength
from rocking.kernels.orbits import bifurcation_curve as kernel
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.result import Result, along, described
from rocking.model.validation import Refusal, instance, one_of, pair, whole
from rocking.orbits.branch import ENDS
from rocking.orbits.codimension_two import (
    CodimensionTwoPoint,
    codimension_two_columns,
    coefficients_of,
    points_of,
)
from rocking.orbits.curves import CurveRows, until_parent
from rocking.orbits.event_chain import IMPACT, NAMES, Chain, Condition, End, Special, problem_of
from rocking.orbits.grazing import touches_again
from rocking.orbits.parameter import check_range, check_step, fixed_quantities, plane, value_of
from rocking.orbits.special_points import FOLD, GRAZING, SpecialPoint, chain_at

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class BifurcationCurve(ReadOnlyArrays, Result):
    """Curve of special points of one kind in the plane of two parameters; returned by `bifurcation_curve`.

    Attributes
    ----------
    kind : str
        "fold", "symmetry-breaking", "period-doubling" or "grazing".
    names : tuple of two str
        Names of the parameters.
    points : ndarray, shape (n, 2)
        Values of the parameters, in order along the curve.
    ends : tuple of two str
        Reasons why the curve ends at its first and at its last point.
    period : int
        Number of forcing cycles per response period of the orbits.
    impacts : int
        Number of impacts per response period; of a grazing, without the grazing impact.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    >>> curve = rk.bifurcation_curve(branch.special[0], "period", "amplitude", ((1, 1.2), (1, 30)))
    >>> curve.kind, curve.names, curve.period
    ('symmetry-breaking', ('period', 'amplitude'), 1)

    The bifurcation is supercritical along the whole curve, on which no point of codimension two lies:

    >>> bool((curve.coefficients > 0.0).all()), curve.special
    (True, ())
    >>> curve.to_xarray().sizes["point"] == len(curve)
    True
    """

    PLOT = "bifurcation_curve"
    LONG = ("point",)

    kind: str
    names: tuple[str, str]
    points: NDArray[np.float64] = field(repr=False, converter=read_only)
    ends: tuple[str, str]
    period: int
    impacts: int
    _rows: CurveRows = field(repr=False)

    @cached_property
    def special(self) -> tuple[CodimensionTwoPoint, ...]:
        """Points of codimension two, in order along the curve; computed at first use."""
        return points_of(self._rows)

    @cached_property
    def coefficients(self) -> NDArray[np.float64]:
        """Coefficients of the normal form of the return map at each point, shape (n,); computed at first use.

        The amplitude s is the root mean square of the changes of the phases of the events, in rad.

        - At a fold the map is s → s + b s². The sign of b is kept along the curve, but has no meaning of its own.
        - At a period doubling it is s → −s + c s³ (Kuznetsov 2004, ch. 4), at a symmetry breaking the same after half a period. For
          c > 0 the bifurcation is supercritical: the new orbits exist where the old one is unstable.
        - On a grazing curve it is NaN.

        Without losses the coefficients are infinite, with the same sign.
        """
        return read_only(coefficients_of(self._rows))

    def __len__(self) -> int:
        return len(self.points)

    @property
    def block(self) -> Any:
        """Block of the system, None if there is none."""
        return self._rows.chain.system.block

    def _data(self) -> xr.Dataset:
        import xarray as xr

        coefficient = self.coefficients, "coefficient of the normal form of the return map"
        attributes = described("Bifurcation curve") | {
            **fixed_quantities(self._rows.chain.system, *self.names),
            "kind": self.kind,
            "orbit_period": self.period,
            "impacts_per_period": self.impacts,
            "ends": list(self.ends),
        }
        variables = along("point", {"coefficient": coefficient}) | along(
            "special", codimension_two_columns(self.names, self.special)
        )
        return xr.Dataset(variables, plane(self.names, self.points), attributes)

    def __str__(self) -> str:
        (low, lower), (high, higher) = self.points.min(axis=0), self.points.max(axis=0)
        first, second = self.names
        return (
            f"{self.kind} of orbits of period {self.period} with {self.impacts} impacts, {first} {low:.6g} to {high:.6g}, "
            f"{second} {lower:.6g} to {higher:.6g}, {len(self)} points; ends: {self.ends[0]} | {self.ends[1]}"
        )


def bifurcation_curve(
    special: SpecialPoint,
    first: str,
    second: str,
    bounds: tuple[tuple[float, float], tuple[float, float]],
    step: float = 0.01,
    max_points: int = 10_000,
) -> BifurcationCurve:
    """Follow a special point through two parameters in both directions, to the ends of its curve.

    Parameters
    ----------
    special : SpecialPoint
        Special point of a branch in one of the two parameters, or in another one.
    first, second : str
        Two different parameters, as in `continue_orbit`; not both "period" and "frequency".
    bounds : ((float, float), (float, float))
        Lowest and highest value of each parameter.
    step : float
        Largest step, in units of the ranges (and of one radian of phase), in [1e-6, 0.1]. Default: 0.01.
    max_points : int
        Maximum number of points in each direction. Default: 10,000.

    Returns
    -------
    BifurcationCurve
        Points of the curve, and the reasons for its ends.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an argument lies outside its range, or if `bounds` does not contain the special point. Also if a grazing orbit has
        no event other than the grazing one or touches at several instants, or if no further point is found.

    See Also
    --------
    continue_orbit : Find special points along a branch.
    rocking.plot.bifurcation_curve : Plot curves of special points.

    Notes
    -----
    Every point is checked by simulation. On a curve of grazings the whole orbit is checked, also after its touch: it reaches
    base and braces at its contacts, and nowhere else. The curve ends where it meets another grazing: a further contact begins
    there, or one of the contacts vanishes. Beyond, no orbit with these contacts exists. A curve of folds also ends where its
    orbits merge with those from which they bifurcate. Beyond this point, the equations have the same orbits again, one half
    of a period later, or their mirror images.

    `special` names these ends, and all points of codimension two between neighbouring points of the curve where a test function
    changes its sign. A step is divided if the slopes of the test function allow two such points within it. Limits: two points
    closer than 1/4096 of a step may be missed. So may two points where the test function varies faster than the steps resolve.
    An end at a grazing is named only where its place is found: a turning point touches there, or a contact of the orbit vanishes.
    Where several contacts change at once, it may have no name. The place of the last point then depends on the step.

    The determinant of the return map is the product of the squared coefficients of restitution of all impacts in a period. It
    has the following consequences:

    - With losses it is below one, so that two complex multipliers lie inside the unit circle. There is no Neimark-Sacker
      bifurcation. Its degenerate form (Chenciner, for flows Bautin) and the strong resonances do not exist either.
    - Two multipliers are 1, or −1, at one point only without losses (e = 1). Then they are so along a whole curve.
    - It is positive, so that multipliers 1 and −1 never occur together. A fold-flip does not exist, with or without losses.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    >>> curve = rk.bifurcation_curve(branch.special[0], "period", "amplitude", ((1, 2), (1, 30)))
    >>> [round(float(value), 9) for value in curve.points[-1]]  # A_SB(2, .9)
    [2.0, 5.78942004]
    """
    instance("special", special, SpecialPoint)
    for name, value in (("first", first), ("second", second)):
        one_of(name, value, tuple(NAMES))
    if first == second or {first, second} == {"period", "frequency"}:
        raise Refusal("second", f"be another parameter than {first}", second)
    ranges = pair("bounds", bounds, f"be two pairs (lowest, highest), of {first} and of {second}")
    limits = [check_range(name, bounds) for name, bounds in zip((first, second), ranges, strict=True)]
    step = check_step(step)
    most = whole("max_points", max_points, 2, 1_000_000)
    here = [value_of(special.orbit.system, name) for name in (first, second)]
    if not all(low <= value <= high for value, (low, high) in zip(here, limits, strict=True)):
        raise Refusal("bounds", f"contain the {first} and the {second} of the special point", bounds)
    chain, condition = _condition(special)
    problem = problem_of(chain, (first, second), limits, step, [high - low for low, high in limits])
    y = np.append(chain.phases, here)
    (back, start), (on, end) = (_half(problem, condition, y, sense, most) for sense in (-1.0, 1.0))
    if not len(back):
        raise Refusal("special", f"be the start of a curve; no further point was found from {special}")
    if start == End.CLOSED:
        back, on, end = back[::-1], back[:1], start
    impacts, _ = chain.counts()
    points = np.concatenate([back[::-1], on[1:]])
    spans = (limits[0], limits[1])
    rows = until_parent(
        CurveRows(chain, condition, (first, second), spans, step, points, (start, end)), len(back) - 1
    )
    return BifurcationCurve(
        kind=special.kind,
        names=(first, second),
        points=rows.rows[:, -2:].copy(),
        ends=(ENDS[rows.ends[0]], ENDS[rows.ends[1]]),
        period=chain.period,
        impacts=impacts,
        rows=rows,
    )


def _half(
    problem: arclength.Problem, condition: Condition, y: np.ndarray, sense: float, most: int
) -> tuple[np.ndarray, End]:
    """Follow the curve in one direction.

    Returns
    -------
    tuple of (ndarray, End)
        Points; reason for the end.
    """
    points, direction = np.empty((most, len(y))), np.zeros(len(y))
    direction[-2] = sense
    count, end = kernel.follow_curve(problem, arclength.Tangent(y, direction), condition, points)
    return points[:count].copy(), end


def _condition(special: SpecialPoint) -> tuple[Chain, Condition]:
    """Return the chain to follow and its condition; of a grazing, the chain without the grazing event."""
    chain = chain_at(special)
    if special.kind != GRAZING:
        kind = Special.FOLD if special.kind == FOLD else Special.PERIOD_DOUBLING
        chain = chain._replace(system=special.orbit.system, phases=special._row[:-1])
        return chain, Condition(kind, -1, IMPACT, 0.0)
    if special._touch is None:
        if special.orbit.impacts or special.orbit.brace_hits:
            remedy = "use that of a branch with another step, or in another parameter"
            raise Refusal("special", "be a grazing whose contact is located; it is not", remedy=remedy)
        raise Refusal("special", "have an event other than the grazing one to be followed; it has none")
    if touches_again(special._touch, special.name):
        remedy = "use that of a shorter period, or of the symmetric orbit"
        raise Refusal("special", "be a grazing at one instant, not at several", remedy=remedy)
    return special._touch
