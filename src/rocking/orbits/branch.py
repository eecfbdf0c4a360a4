"""Branches of periodic orbits: their tables, rows and columns, and why they end."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.kernels.orbits import continuation as kernel
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.orbit import Orbit, Stability, multiplier_columns, orbit_columns, stability_of
from rocking.model.quantity import PHASE, SYSTEM_QUANTITIES
from rocking.model.result import Result, along, described
from rocking.model.system import System
from rocking.model.validation import WrongType, whole, within
from rocking.orbits.event_chain import Chain, End, multipliers_of, orbit_of, solved, states
from rocking.orbits.parameter import column_of, coordinate_of, fixed_quantities
from rocking.orbits.special_points import GRAZING, SpecialPoint, distinct, special_points

if TYPE_CHECKING:
    import xarray as xr


class BranchRows(Protocol):
    """Points of a branch in the unknowns of its equations."""

    def orbit(self, index: int) -> Orbit:
        """Return the orbit of a point."""

    def between(self, index: int, share: float, value: float) -> Orbit | None:
        """Return the orbit at a value of the parameter near the point a share of the way to the next one, if there is one."""

    def section(self, phase: float) -> np.ndarray:
        """Return Θ and Θ' of all orbits at a forcing phase in the cycles of a period, shape (points, period, 2)."""


class ChainRows(NamedTuple):
    """Points of a branch of slender blocks: phases of the events of each orbit, and the parameter."""

    chain: Chain
    name: str
    rows: np.ndarray
    facts: np.ndarray

    def orbit(self, index: int) -> Orbit:
        """Return the orbit of a point."""
        facts = self.facts[index]
        return orbit_of(self.chain, self.name, self.rows[index], facts["trace"], facts["determinant"])

    def between(self, index: int, share: float, value: float) -> Orbit | None:
        """Return the orbit at a value of the parameter near the point a share of the way to the next one, if there is one."""
        near = self.rows[index]
        if share:
            near = near + share * (self.rows[index + 1] - near)
        there = solved(self.chain, self.name, value, near)
        if not there.found:
            # a grazing end, where a motion may touch or not, is known although it is not found again
            return None if share else self.orbit(index)
        return orbit_of(self.chain, self.name, there.phases, there.trace, there.determinant)

    def section(self, phase: float) -> np.ndarray:
        """Return Θ and Θ' of all orbits at a forcing phase in the cycles of a period, shape (points, period, 2)."""
        return states(self.chain, self.name, self.rows, phase, self.chain.period)


POINT = np.dtype(
    [
        ("parameter", float),
        ("phase", float),
        ("velocity", float),
        ("multipliers", complex, 2),
        ("stable", bool),
        ("stability", "U8"),
        ("peak", float),
    ]
)


def table(rows: np.ndarray, facts: np.ndarray, mirrored: bool) -> NDArray[np.void]:
    """Return the public table of a branch."""
    points = np.empty(len(rows), POINT)
    points["parameter"] = rows[:, -1]
    points["phase"] = np.mod(rows[:, 0], math.tau)
    points["velocity"] = facts["velocity"]
    traces = facts[["trace", "determinant"]].tolist()
    points["multipliers"] = [multipliers_of(trace, determinant, mirrored) for trace, determinant in traces]
    points["stability"] = [stability_of(trace, determinant) for trace, determinant in traces]
    points["stable"] = points["stability"] == Stability.STABLE
    points["peak"] = facts["peak"]
    points.flags.writeable = False
    return points


# End of a branch at the special point from which ``switch_branch`` follows it.
BRANCHES_OFF = "branches off at a special point"


@frozen(eq=False)
class Branch(ReadOnlyArrays, Result):
    """Branch of periodic orbits over a parameter; returned by `continue_orbit` and `switch_branch`.

    Attributes
    ----------
    name : str
        Name of the parameter.
    period : int
        Number of forcing cycles per response period.
    symmetric : bool
        True if each orbit is its own mirror image half a period later.
    impacts, brace_hits : int or None
        Number of impacts at Θ = 0 and on the braces per response period. None if infinitely many precede rest or sustained
        contact with a brace.
    points : structured ndarray
        One row per orbit, in order along the branch, with the fields

        - "parameter": value of the parameter;
        - "phase", "velocity": forcing phase ψ of the first event, rad, and speed just after it;
        - "multipliers": Floquet multipliers over one period, the larger first;
        - "stability", "stable": see `Stability`, and True if it is "stable";
        - "peak": largest |Θ|.
    special : tuple of SpecialPoint
        Special points, in order along the branch. A branch of asymmetric orbits may pass a symmetry breaking and continue
        along their mirror images. One of orbits that begin at a period doubling may pass it and continue along the same orbits,
        some cycles later. Each special point is listed once, at its first passage.
    ends : tuple of two str
        Reasons why the branch ends at its first and at its last point.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 20))
    >>> branch.symmetric, branch.impacts, branch.ends
    (True, 2, ('end of the range', 'end of the range'))
    """

    PLOT = "branch"
    LONG = ("point",)

    name: str
    period: int
    symmetric: bool
    impacts: int | None
    brace_hits: int | None
    points: NDArray[np.void] = field(repr=False, converter=read_only)
    special: tuple[SpecialPoint, ...] = field(repr=False)
    ends: tuple[str, str]
    _rows: BranchRows = field(repr=False)
    # special points at each passage, if they are known
    _passed: tuple[SpecialPoint, ...] = field(default=(), repr=False)

    @property
    def _passages(self) -> tuple[SpecialPoint, ...]:
        """Special points, also those that the branch passes again with mirror images or later starts of its orbits."""
        return self._passed or self.special

    @property
    def _middle(self) -> System:
        """System of the orbit in the middle of the branch."""
        return self.orbit(len(self) // 2).system

    def __len__(self) -> int:
        return len(self.points)

    def orbit(self, index: int) -> Orbit:
        """Return the orbit of a point.

        Parameters
        ----------
        index : int
            Index of the point; a negative one counts from the end.

        Returns
        -------
        Orbit
            Orbit of this point.

        Raises
        ------
        TypeError
            If `index` is not a whole number.
        IndexError
            If the branch has no point with this index.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
        >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 20))
        >>> print(branch.orbit(0))
        symmetric orbit of period 1 with 2 impacts
        """
        count = len(self)
        try:
            index = whole("index", index, -count, count - 1)
        except WrongType:
            raise
        except ValueError as error:
            raise IndexError(str(error)) from None
        return self._rows.orbit(index)

    def at(self, value: float) -> list[Orbit]:
        """Return every orbit of the branch at a value of the parameter.

        Parameters
        ----------
        value : float
            Value of the parameter, within the range of the branch.

        Returns
        -------
        list of Orbit
            Orbits in order along the branch, each corrected by Newton's method.

        Raises
        ------
        TypeError
            If `value` is not a real number.
        ValueError
            If `value` lies outside the range of the branch.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
        >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 20))
        >>> [orbit.system.forcing.amplitude for orbit in branch.at(12.0)]
        [12.0]
        """
        values = self.points["parameter"]
        value = within("value", value, float(values.min()), float(values.max()))
        before, after = values[:-1] - value, values[1:] - value
        crossed = (before * after < 0.0) | (before == 0.0)
        orbits = []
        for i in np.flatnonzero(crossed).tolist():
            share = -before[i] / (after[i] - before[i]) if after[i] != before[i] else 0.0
            orbits.append(self._rows.between(i, share, value))
        if values[-1] == value:
            orbits.append(self._rows.between(len(values) - 1, 0.0, value))
        return [orbit for orbit in orbits if orbit is not None]

    def section(self, phase: float = 0.0) -> NDArray[np.float64]:
        """Return the section points of all orbits at a forcing phase.

        Parameters
        ----------
        phase : float
            Forcing phase ψ, rad, in [-1000, 1000]. Default: 0.

        Returns
        -------
        ndarray, shape (points, period, 2)
            Θ and Θ' in each cycle of the response period.

        Raises
        ------
        TypeError, ValueError
            If `phase` is not a real number in its range.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
        >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 20))
        >>> branch.section(0.5).shape == (len(branch), 1, 2)
        True
        """
        return self._rows.section(PHASE.checked(phase))

    @property
    def block(self) -> Any:
        """Block of the system, None if there is none."""
        return self._middle.block

    def _data(self) -> xr.Dataset:
        import xarray as xr

        points, special, name = self.points, self.special, self.name
        of_points = {
            "event_phase": (points["phase"], "forcing phase of the first event", "rad"),
            "event_velocity": (points["velocity"], "speed just after the first event"),
            "peak": (points["peak"], "largest magnitude of the angle of the orbit"),
            "stability": (points["stability"].astype(str), "stability of the orbit"),
            **multiplier_columns(points["multipliers"]),
        }
        of_special = {
            "special_kind": (np.array([one.kind for one in special], "U17"), "type of the special point"),
            f"special_{name}": column_of(name, [one.parameter for one in special]),
            **orbit_columns([one.orbit for one in special], "special_"),
        }
        of_ends = {
            "end_reason": (list(self.ends), "reason why the branch ends"),
            f"end_{name}": column_of(name, points["parameter"][[0, -1]]),
        }
        attributes = described("Branch of periodic orbits") | {
            **fixed_quantities(self._middle, name),
            "parameter": name,
            "orbit_period": self.period,
            "symmetric": self.symmetric,
            "impacts_per_period": self.impacts,
            "brace_hits_per_period": self.brace_hits,
            "points": len(self),
            "stable_points": int(points["stable"].sum()),
            "peak": float(np.nanmax(points["peak"])),
        }
        variables = along("point", of_points) | along("special", of_special) | along("end", of_ends)
        return xr.Dataset(variables, {name: coordinate_of("point", name, points["parameter"])}, attributes)

    def __str__(self) -> str:
        name, of, unit = SYSTEM_QUANTITIES[self.name].printed(self.block)
        low, high = (
            of(float(end)) for end in (self.points["parameter"].min(), self.points["parameter"].max())
        )
        symmetry = "symmetric" if self.symmetric else "asymmetric"
        result = ", ".join(f"{one.kind} at {of(one.parameter):.6g}{unit}" for one in self.special)
        return (
            f"branch of {symmetry} orbits of period {self.period}, {name} {low:.6g} to {high:.6g}{unit}, "
            f"{len(self)} points, {self._stable_ranges(of, unit)}: {result or 'no special point'}; "
            f"ends: {self.ends[0]} | {self.ends[1]}"
        )

    def _stable_ranges(self, of: Callable[[Any], Any], unit: str) -> str:
        """Return the ranges of the parameter with stable or neutrally stable orbits, in order along the branch, as text."""
        said = [
            f"{stability} "
            + " and ".join(_extent(f"{of(low):.6g}", f"{of(high):.6g}", unit) for low, high in ranges)
            for stability in (Stability.STABLE, Stability.NEUTRAL)
            if (ranges := self._ranges_of(stability))
        ]
        return ", ".join(said) or "nowhere stable"

    def _ranges_of(self, stability: Stability) -> list[tuple[float, float]]:
        """Return the ranges of the parameter with one stability; a range ends at the adjacent special point, if there is one.

        The parameter may turn back within a range; the range covers all its values.
        """
        values, changes = self.points["parameter"], {one.index: one.parameter for one in self._passages}
        edges = np.flatnonzero(np.diff(self.points["stability"] == stability, prepend=False, append=False))
        ranges = []
        for first, after in edges.reshape(-1, 2).tolist():
            ends = changes.get(first, values[first]), changes.get(after, values[after - 1])
            within = values[first:after]
            ranges.append((min(*ends, within.min()), max(*ends, within.max())))
        return list(dict.fromkeys(ranges))


def _extent(low: str, high: str, unit: str) -> str:
    """Return a range of values in words; with six digits it may be a single value."""
    return f"at {low}{unit}" if low == high else f"from {low} to {high}{unit}"


ENDS = {
    End.RANGE: "end of the range",
    End.GRAZED: GRAZING,
    End.MERGED: "merges with the branch from which it bifurcates",
    End.CLOSED: "closed loop",
    End.MANY: "maximum number of points",
    End.LOST: "lost: no further point was found with the smallest step",
}


def branch_of(chain: Chain, parameter: str, joined: kernel.BranchTable, ends: tuple[str, str]) -> Branch:
    """Return the public value of a branch."""
    impacts, brace_hits = chain.counts()
    passed = special_points(chain, parameter, joined)
    return Branch(
        name=parameter,
        period=chain.period,
        symmetric=chain.mirrored,
        impacts=impacts,
        brace_hits=brace_hits,
        points=table(joined.rows, joined.facts, chain.mirrored),
        special=distinct(passed),
        ends=ends,
        rows=ChainRows(chain, parameter, joined.rows, joined.facts),
        passed=passed,
    )
