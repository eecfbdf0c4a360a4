"""A branch of periodic orbits, and the points on it where something changes."""

from __future__ import annotations

import math

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.model import NotebookPicture, Orbit, ReadOnlyArrays, Stability, read_only, stability_of, within
from rocking.orbits.event_chain import Chain, multipliers_of, orbit_of, solved, states
from rocking.orbits.grazing import Touch

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


@frozen(eq=False)
class SpecialPoint:
    """A point of a branch where something changes.

    Attributes
    ----------
    kind : str
        "fold" (two orbits meet and vanish), "symmetry-breaking" (two unsymmetric orbits, mirror images, part from a
        symmetric one), "period-doubling" or "grazing" (the block just touches the base or a brace: beyond, an impact is
        lost or gained).
    parameter : float
        Value of the parameter that was followed.
    orbit : Orbit
        The orbit there. At a grazing it is the orbit without the impact that grazes, with which its multipliers would be infinite.
        Rounding decides whether a run meets that impact; where it does, at a speed of about 10⁻⁸, the run leaves the orbit, and
        `residual` says how far. So `continue_orbit` does not take it: take an orbit beside it, `branch.orbit(index)`.
    name : str
        The parameter's name.
    index : int
        It lies between the points `index - 1` and `index` of its branch; a grazing is the branch's first or last point.
    """

    kind: str
    parameter: float
    orbit: Orbit
    name: str
    index: int
    _chain: Chain = field(repr=False)
    _row: np.ndarray = field(repr=False)
    _touch: Touch | None = field(default=None, repr=False)

    def __str__(self) -> str:
        return f"{self.kind} at {self.name} {self.parameter:.10g}: {self.orbit}"


@frozen(eq=False)
class Branch(ReadOnlyArrays, NotebookPicture):
    """Periodic orbits along a parameter; made by `continue_orbit` and `switch_branch`.

    Attributes
    ----------
    name : str
        The parameter followed.
    period : int
        Forcing cycles after which the orbits repeat themselves.
    symmetric : bool
        Whether each is its own mirror image half a period later.
    impacts, brace_hits : int
        Impacts at Θ = 0 and brace hits in a period.
    points : structured array
        One row an orbit, in order along the branch: "parameter"; "phase" and "velocity", the forcing phase ψ (rad) of the
        first event and the speed just after it; "multipliers" over a period, the larger first; "stability", see `Stability`,
        and "stable", whether it is that; "peak", the largest |Θ|.
    special : tuple of SpecialPoint
        In order along the branch. A branch of unsymmetric orbits may pass a symmetry breaking and go on along their mirror
        images. It then has each special point twice, once with either orbit.
    ends : tuple of two str
        Why the branch ends at its first and at its last point.
    """

    name: str
    period: int
    symmetric: bool
    impacts: int
    brace_hits: int
    points: NDArray[np.void] = field(repr=False, converter=read_only)
    special: tuple[SpecialPoint, ...] = field(repr=False)
    ends: tuple[str, str]
    _chain: Chain = field(repr=False)
    _rows: np.ndarray = field(repr=False)
    _facts: np.ndarray = field(repr=False)

    def __len__(self) -> int:
        return len(self.points)

    def orbit(self, index: int) -> Orbit:
        """The orbit of a point, by its index."""
        facts = self._facts[index]
        return orbit_of(self._chain, self.name, self._rows[index], facts["trace"], facts["determinant"])

    def at(self, value: float) -> list[Orbit]:
        """Every orbit of the branch at a value of the parameter, in order along it, corrected there by Newton's method."""
        values = self.points["parameter"]
        value = within("value", value, float(values.min()), float(values.max()))
        before, after = values[:-1] - value, values[1:] - value
        crossed = (before * after < 0.0) | (before == 0.0)
        orbits = []
        for i in np.flatnonzero(crossed):
            share = -before[i] / (after[i] - before[i]) if after[i] != before[i] else 0.0
            near = self._rows[i] + share * (self._rows[i + 1] - self._rows[i])
            orbits.append(self._corrected(value, near))
        if values[-1] == value:
            orbits.append(self._corrected(value, self._rows[-1]))
        return [orbit for orbit in orbits if orbit is not None]

    def _corrected(self, value: float, near: np.ndarray) -> Orbit | None:
        there = solved(self._chain, self.name, value, near)
        if not there.found:
            return None
        return orbit_of(self._chain, self.name, there.phases, there.trace, there.determinant)

    def section(self, phase: float = 0.0) -> NDArray[np.float64]:
        """(Θ, Θ') of every point at a phase of the forcing, rad, in each cycle of its period: (points, period, 2)."""
        return states(self._chain, self.name, self._rows, phase, self.period)

    def __str__(self) -> str:
        low, high = float(self.points["parameter"].min()), float(self.points["parameter"].max())
        symmetry = "symmetric" if self.symmetric else "unsymmetric"
        found = ", ".join(f"{one.kind} at {one.parameter:.6g}" for one in self.special) or "no special point"
        return (
            f"branch of {symmetry} orbits of period {self.period}, {self.name} {low:.6g} to {high:.6g}, "
            f"{len(self)} points, {self._stable_ranges()}: {found}; ends: {self.ends[0]} | {self.ends[1]}"
        )

    def _stable_ranges(self) -> str:
        """Return the ranges of the parameter on which the orbits do not repel, in order along the branch, in words."""
        said = [
            f"{stability} from " + " and from ".join(f"{low:.6g} to {high:.6g}" for low, high in ranges)
            for stability in (Stability.STABLE, Stability.NEUTRAL)
            if (ranges := self._ranges_of(stability))
        ]
        return ", ".join(said) or "nowhere stable"

    def _ranges_of(self, stability: Stability) -> list[tuple[float, float]]:
        """Return the ranges of the parameter with one stability; a range ends at the special point beside it, if any.

        The parameter may turn back within a range: what is told is how far it goes.
        """
        values, changes = self.points["parameter"], {one.index: one.parameter for one in self.special}
        edges = np.flatnonzero(np.diff(self.points["stability"] == stability, prepend=False, append=False))
        ranges = []
        for first, after in edges.reshape(-1, 2).tolist():
            ends = changes.get(first, values[first]), changes.get(after, values[after - 1])
            within = values[first:after]
            ranges.append((min(*ends, within.min()), max(*ends, within.max())))
        return list(dict.fromkeys(ranges))


def table(rows: np.ndarray, facts: np.ndarray, mirrored: bool) -> NDArray[np.void]:
    """The public table of a branch."""
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
