"""Curves in the plane of two parameters on which orbits change: fold, symmetry breaking, period doubling, grazing."""

from __future__ import annotations

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.kernels.orbits import arclength
from rocking.kernels.orbits import bifurcation_curve as kernel
from rocking.model import ReadOnlyArrays, instance, one_of, pair, read_only, refusal, whole, within
from rocking.orbits.branch import SpecialPoint
from rocking.orbits.continuation import ENDS
from rocking.orbits.event_chain import IMPACT, NAMES, Chain, Condition, End, Special, problem_of
from rocking.orbits.parameter import checked_range, value_of


@frozen(eq=False)
class BifurcationCurve(ReadOnlyArrays):
    """Special points of one kind through two parameters; made by `bifurcation_curve`.

    Attributes
    ----------
    kind : str
        "fold", "symmetry-breaking", "period-doubling" or "grazing".
    names : tuple of two str
        The parameters.
    points : array (n, 2)
        Their values, in order along the curve.
    ends : tuple of two str
        Why it ends at its first and at its last point.
    period, impacts : int
        Forcing cycles and impacts in a period of the orbits; those of a grazing without the impact that grazes.
    """

    kind: str
    names: tuple[str, str]
    points: NDArray[np.float64] = field(repr=False, converter=read_only)
    ends: tuple[str, str]
    period: int
    impacts: int

    def __len__(self) -> int:
        return len(self.points)

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
    """Follow a special point through two parameters, both ways, to the ends of its curve.

    Parameters
    ----------
    special : SpecialPoint
        From a branch that was followed in one of the two parameters, or in another.
    first, second : str
        Two different parameters, as in `continue_orbit`, "period" and "frequency" not both.
    bounds : ((float, float), (float, float))
        Lowest and highest value of each.
    step : float
        Largest step, in units of the ranges (and of a radian of phase).
    max_points : int
        Points either way, at most.

    Returns
    -------
    BifurcationCurve

    Raises
    ------
    TypeError, ValueError
        In one line, for what cannot be followed.

    See Also
    --------
    continue_orbit : Find special points along a branch.
    rocking.plot.bifurcation_curve : Plot curves of special points.

    Notes
    -----
    Every point is marched to see that its motion is the block's own. Where a curve meets another grazing it ends.

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
        raise ValueError(refusal("second", f"be another parameter than {first}", second))
    ranges = pair("bounds", bounds, f"be two pairs (lowest, highest), of {first} and of {second}")
    limits = [checked_range(name, bounds) for name, bounds in zip((first, second), ranges, strict=True)]
    step = within("step", step, 1e-6, 0.1)
    most = whole("max_points", max_points, 2, 1_000_000)
    here = [value_of(special.orbit.system, name) for name in (first, second)]
    if not all(low <= value <= high for value, (low, high) in zip(here, limits, strict=True)):
        raise ValueError(refusal("bounds", f"hold the special point's own {first} and {second}", bounds))
    chain, condition = _condition(special)
    problem = problem_of(chain, (first, second), limits, step, [high - low for low, high in limits])
    y = np.append(chain.phases, here)
    (back, start), (on, end) = (_half(problem, condition, y, sense, most) for sense in (-1.0, 1.0))
    if not len(back):
        raise ValueError(f"special must be a point to follow from; got one that is not met again: {special}")
    if start == End.CLOSED:
        back, on, end = back[::-1], back[:1], start
    impacts, _ = chain.counts()
    return BifurcationCurve(
        kind=special.kind,
        names=(first, second),
        points=np.concatenate([back[::-1], on[1:]])[:, -2:],
        ends=(ENDS[start], ENDS[end]),
        period=chain.period,
        impacts=impacts,
    )


def _half(
    problem: arclength.Problem, condition: Condition, y: np.ndarray, sense: float, most: int
) -> tuple[np.ndarray, End]:
    """The curve one way: its points, and why it ends."""
    points, direction = np.empty((most, len(y))), np.zeros(len(y))
    direction[-2] = sense
    count, end = kernel.follow_curve(problem, arclength.Tangent(y, direction), condition, points)
    return points[:count].copy(), end


def _condition(special: SpecialPoint) -> tuple[Chain, Condition]:
    """What is followed: of a grazing the chain without the event that grazes."""
    if special.kind != "grazing":
        kind = Special.FOLD if special.kind == "fold" else Special.PERIOD_DOUBLING
        chain = special._chain._replace(system=special.orbit.system, phases=special._row[:-1])
        return chain, Condition(kind, -1, IMPACT, 0.0)
    if special._touch is None:
        raise ValueError(
            "special must have an event beside the one that grazes to be followed; got one without"
        )
    return special._touch
