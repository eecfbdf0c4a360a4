"""Transition at a grazing: the orbits beyond it, and the attractor that a motion reaches there.

With one contact more, the multipliers of an orbit are infinite at the grazing (Nordmark 1991). Beside it, an orbit with such a
contact is unstable. A motion on a stable orbit therefore leaves it, even if the orbit persists. It may stay near, on an attractor
that shrinks onto the grazing orbit, or jump to another one. A simulation just beyond the grazing decides.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen
from numpy.typing import ArrayLike, NDArray

from rocking.model.arrays import ReadOnlyArrays, nan_if_none, read_only
from rocking.model.orbit import Orbit
from rocking.model.result import Result, along, described
from rocking.model.system import State
from rocking.model.text import plus_minus
from rocking.model.validation import Refusal, instance, reals, within
from rocking.model.verdict import Kind, Verdict
from rocking.motion.simulate import simulate
from rocking.orbits.continuation import MEETS, PERSISTS, switch_branch
from rocking.orbits.event_chain import clocked
from rocking.orbits.parameter import ALLOWED, coordinate_of, fixed_quantities, kinds_of, with_value
from rocking.orbits.special_points import GRAZING, SpecialPoint, chain_at
from rocking.response.classify import budget, classify

if TYPE_CHECKING:
    import xarray as xr

DISTANCES = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
"""Relative distances of the parameter from the grazing, by default."""
FITTED = 4
"""Number of the smallest distances from which the order is fitted."""
SHRINKS = 0.2
"""Order above which an attractor shrinks onto the grazing orbit; 1/2 and 1 are expected, and 0 of a distant attractor."""
SIGMAS = 2.0
"""Number of standard errors of the order by which it must differ from `SHRINKS`."""
NEARBY = 0.05
"""Relative range of the parameter in which the other branch is searched for."""
MAX_PERIOD = 64
"""Longest period of an attractor, in cycles."""
TRANSIENT, KEPT = 20_000, 4_000
"""Cycles before and with the points of an attractor that is no orbit."""


@frozen(eq=False)
class GrazingTransition(ReadOnlyArrays, Result):
    """Transition at a grazing, with its evidence; returned by `grazing_transition`.

    Attributes
    ----------
    special : SpecialPoint
        The grazing.
    orbits : str
        - "persistence": beyond, an orbit with one contact more or less exists;
        - "fold": this orbit exists on the same side, so that two orbits meet and vanish;
        - "none": no such orbit was found.
    distances : ndarray, shape (n,)
        Distances of the parameter from the grazing, relative to its value there, in descending order.
    values : ndarray, shape (n,)
        Values of the parameter, beyond the grazing.
    verdicts : tuple of Verdict
        Verdict at each value on the motion that starts on the grazing orbit.
    nearest, farthest : ndarray, shape (n,)
        Smallest and largest distance of the points of the attractor from the grazing orbit. The section is that at the forcing
        phase of `special.orbit`. Of the attractor and its mirror image, the closer one counts. Infinite if the block overturns.

    Examples
    --------
    >>> import rocking as rk
    >>> braces = rk.Braces(angle=0.3, restitution=0.7)
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), 0.8, braces)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (0.5, 15.0))
    >>> result = rk.grazing_transition(branch.special[-1])
    >>> result.orbits, result.kind, result.attractor.period
    ('fold', 'jump', 1)

    The distance does not depend on that of the parameter, so that its exponent is 0:

    >>> exponent, error = result.order
    >>> abs(exponent) < 1e-3, error < 1e-3
    (True, True)
    >>> result.to_xarray()["orbit_period"].values.tolist()
    [1, 1, 1, 1, 1]
    """

    PLOT = "grazing_transition"

    special: SpecialPoint
    orbits: str
    distances: NDArray[np.float64] = field(repr=False, converter=read_only)
    values: NDArray[np.float64] = field(repr=False, converter=read_only)
    verdicts: tuple[Verdict, ...] = field(repr=False)
    nearest: NDArray[np.float64] = field(repr=False, converter=read_only)
    farthest: NDArray[np.float64] = field(repr=False, converter=read_only)

    @property
    def kind(self) -> str:
        """Type of the transition of the motion.

        "local": the attractor beyond shrinks continuously onto the grazing orbit. "jump": it does not, so that the motion leaves
        to another attractor, to rest or to overturning. "unstable orbit": motions leave the orbit before the grazing.
        "undecided": the fit of `order` does not decide.
        """
        if not self.special.orbit.stable:
            return "unstable orbit"
        order, error = self.order
        if not np.isfinite(self.farthest[-1]) or order + SIGMAS * error < SHRINKS:
            return "jump"
        return "local" if order - SIGMAS * error > SHRINKS else "undecided"

    @property
    def attractor(self) -> Verdict:
        """Verdict at the smallest distance."""
        return self.verdicts[-1]

    @property
    def order(self) -> tuple[float, float]:
        """Exponent p of the power law `farthest` ∝ `distances` ** p at the four smallest distances, and its standard error.

        The square-root map of a grazing predicts 1/2 for an attractor with contacts (Nordmark 1991, J. Sound Vib. 145, 279). It
        is 1 if a stable orbit without the contact follows, and 0 if the attractor lies elsewhere. Both are NaN if the block
        overturns at one of these distances.
        """
        x, y = np.log(self.distances[-FITTED:]), self.farthest[-FITTED:]
        if not (np.isfinite(y) & (y > 0.0)).all():
            return math.nan, math.nan
        x, y = x - x.mean(), np.log(y) - np.log(y).mean()
        slope = float(x @ y / (x @ x))
        return slope, math.sqrt(float(((y - slope * x) ** 2).sum() / (len(x) - 2) / (x @ x)))

    @property
    def block(self) -> Any:
        """Block of the system, None if there is none."""
        return self.special.orbit.system.block

    def _data(self) -> xr.Dataset:
        import xarray as xr

        special, verdicts = self.special, self.verdicts
        name = special.name
        order, order_error = self.order
        columns = {
            "distance": (self.distances, "relative distance of the parameter from the grazing"),
            "orbit_period": (
                [one.period or 0 for one in verdicts],
                "forcing cycles per response period; 0 if not periodic",
            ),
            "exponent": (
                nan_if_none(one.exponent for one in verdicts),
                "largest Lyapunov exponent per tau",
            ),
            "exponent_error": (
                nan_if_none(one.exponent_error for one in verdicts),
                "error of the largest Lyapunov exponent per tau",
            ),
            "nearest": (self.nearest, "smallest distance of the attractor from the grazing orbit"),
            "farthest": (self.farthest, "largest distance of the attractor from the grazing orbit"),
        }
        kinds = kinds_of(name, [str(one.kind) for one in verdicts], "type of the response")
        attributes = described("Transition at a grazing") | {
            **fixed_quantities(special.orbit.system, name),
            f"grazing_{name}": special.parameter,
            "orbits": self.orbits,
            "transition": self.kind,
            "order": order,
            "order_error": order_error,
            "section_phase": special.orbit.phase,
        }
        coordinate = coordinate_of(name, name, self.values)
        return xr.Dataset(along(name, columns) | {"kind": kinds}, {name: coordinate}, attributes)

    def _repr_html_(self) -> str | None:
        return super()._repr_html_() if np.isfinite(self.farthest).any() else None

    def __str__(self) -> str:
        orbits = {"persistence": PERSISTS, "fold": MEETS, "none": "no other orbit was found"}[self.orbits]
        order, error = self.order
        beyond = {
            "local": f"{_named(self.attractor)}, which shrinks onto the orbit with the order {plus_minus(order, error)}",
            "jump": f"the motion jumps to {_named(self.attractor)}",
            "unstable orbit": f"motions leave the unstable orbit, here to {_named(self.attractor)}",
            "undecided": f"{_named(self.attractor)}; it is undecided if it shrinks onto the orbit",
        }[self.kind]
        if self.kind != "local" and math.isfinite(self.nearest[-1]):
            ends = dict.fromkeys(f"{value:.2g}" for value in (self.nearest[-1], self.farthest[-1]))
            beyond += f", {' to '.join(ends)} away"
        return f"grazing at {self.special.name} {self.special.parameter:.10g}: {orbits}; beyond: {beyond}"


def grazing_transition(
    special: SpecialPoint, distances: ArrayLike = DISTANCES, max_cycles: int = 100_000
) -> GrazingTransition:
    """Determine the transition at a grazing: the orbits beyond it, and the attractor that a motion reaches there.

    At some values of the parameter beyond the grazing, a motion starts on the grazing orbit and is classified. The distances of
    its attractor from the grazing orbit show if the attractor shrinks onto this orbit, or if the motion jumps.

    Parameters
    ----------
    special : SpecialPoint
        Special point of kind "grazing", of a slender block.
    distances : array_like
        Distances of the parameter from the grazing, relative to its value there, at least four different ones in [1e-9, 0.5].
        Default: 1e-3 to 1e-5.
    max_cycles : int
        As in `classify`. Default: 100,000.

    Returns
    -------
    GrazingTransition
        Transition of the orbits and of the motion, with verdicts and distances.

    Raises
    ------
    TypeError
        If an argument is of the wrong type. If the block is not slender, or the orbit rests.
    ValueError
        If `special` is no grazing, or an argument lies outside its range. If a value beyond the grazing lies outside the range of
        the parameter.

    See Also
    --------
    switch_branch : Follow the other branch at a grazing.
    classify : Classify one response.
    rocking.plot.grazing_transition : Plot the distances.

    Notes
    -----
    Limits: the motion starts on the grazing orbit, so that other attractors beyond it are not found. An attractor may change again
    within the distances. `verdicts` then holds different types.

    Examples
    --------
    >>> import rocking as rk
    >>> braces = rk.Braces(angle=0.69, restitution=0.46)
    >>> system = rk.System(rk.Harmonic(amplitude=10.4, period=1.42), 0.79, braces)
    >>> result = rk.find_orbits(system, 1)
    >>> orbit = next(each for each in result if each.stable and not each.symmetric)
    >>> branch = rk.continue_orbit(orbit, "amplitude", (10.2, 10.6))
    >>> result = rk.grazing_transition(branch.special[0])
    >>> result.orbits, result.kind, str(result.attractor.kind)
    ('persistence', 'local', 'chaotic')
    """
    instance("special", special, SpecialPoint)
    if special.kind != GRAZING:
        raise Refusal("special", "be a grazing", special.kind)
    chain_at(special)  # refuses a full block, and an orbit that rests
    ordered = np.unique(reals("distances", distances))[::-1]
    if len(ordered) < FITTED or not (ordered[-1] >= 1e-9 and ordered[0] <= 0.5):
        raise Refusal("distances", f"be at least {FITTED} different numbers in [1e-9, 0.5]", distances)
    budget(max_cycles, MAX_PERIOD)
    beyond = -1.0 if special._origin is None else -special._origin.side
    values = special.parameter * (1.0 + beyond * ordered)
    for value in (values[0], values[-1]):
        within(f"{special.name} beyond the grazing", float(value), *ALLOWED[special.name])
    orbit = special.orbit
    verdicts = [
        classify(
            clocked(with_value(orbit.system, special.name, value), orbit.phase),
            orbit.state,
            max_cycles,
            MAX_PERIOD,
        )
        for value in values.tolist()
    ]
    spans = [_span(verdict, orbit) for verdict in verdicts]
    nearest, farthest = np.array(spans).T.copy()
    return GrazingTransition(
        special, _orbits(special), ordered.copy(), values, tuple(verdicts), nearest, farthest
    )


def _orbits(special: SpecialPoint) -> str:
    """Return the transition of the orbits: "persistence", "fold" or "none"."""
    low, high = ALLOWED[special.name]
    around = special.parameter * (1.0 - NEARBY), special.parameter * (1.0 + NEARBY)
    result = switch_branch(special, (max(low, around[0]), min(high, around[1])), max_points=2)
    if not result:
        return "none"
    return "persistence" if result[0].ends[0].endswith(PERSISTS) else "fold"


def _span(verdict: Verdict, orbit: Orbit) -> tuple[float, float]:
    """Return the smallest and the largest distance of an attractor, or of its mirror image, from an orbit on its section."""
    if verdict.kind is Kind.OVERTURNED:
        return math.inf, math.inf
    own = _points(orbit, orbit.phase)
    spans = []
    for turned, sign in ((0.0, 1.0), (math.pi, -1.0)):
        points = sign * _attractor(verdict, orbit.phase + turned)
        distances = np.linalg.norm(points[:, None] - own, axis=2).min(axis=1)
        spans.append((float(distances.max()), float(distances.min())))
    farthest, nearest = min(spans)
    return nearest, farthest


def _attractor(verdict: Verdict, phase: float) -> np.ndarray:
    """Return points of the attractor of a verdict at a forcing phase, shape (n, 2)."""
    if verdict.orbit is not None and verdict.period is not None:
        return _points(verdict.orbit, phase)
    system, start = verdict.system, verdict.start
    forcing = system.periodic
    wait = (phase - forcing.phase) % math.tau / forcing.frequency
    if wait:
        start = State(*map(float, simulate(system, start, cycles=1).at(wait)))
    motion = simulate(clocked(system, phase), start, cycles=TRANSIENT + KEPT, record="section")
    return np.asarray(motion.section()[-KEPT:])


def _points(orbit: Orbit, phase: float) -> np.ndarray:
    """Return Θ and Θ' of an orbit at a forcing phase in the cycles of its period, shape (period, 2)."""
    states = [orbit.at(phase + math.tau * cycle) for cycle in range(orbit.period)]
    return np.array([(state.angle, state.velocity) for state in states])


def _named(verdict: Verdict) -> str:
    """Return an attractor in words."""
    if verdict.kind is Kind.PERIODIC:
        return f"a stable orbit of period {verdict.period}"
    if verdict.kind is Kind.CHAOTIC and verdict.exponent is not None and verdict.exponent_error is not None:
        return f"a chaotic attractor with the exponent {plus_minus(verdict.exponent, verdict.exponent_error)}"
    return {
        Kind.REST: "rest",
        Kind.OVERTURNED: "overturning",
        Kind.QUASI_PERIODIC: "a torus",
    }.get(verdict.kind, "an undetermined response")
