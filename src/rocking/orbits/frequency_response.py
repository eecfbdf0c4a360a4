"""Frequency response: peak rotation of the (1, n) orbits, and of the response from rest, over the forcing period."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen
from numpy.typing import ArrayLike, NDArray

from rocking.model.arrays import ReadOnlyArrays, nan_if_none, read_only
from rocking.model.orbit import Mode, Orbit
from rocking.model.progress import Bar
from rocking.model.result import Result, along, described
from rocking.model.system import State, System
from rocking.model.validation import (
    Refusal,
    WrongType,
    exactly_one,
    instance,
    refuse_if,
    whole,
    within,
)
from rocking.model.verdict import Kind, Verdict
from rocking.orbits.branch import Branch
from rocking.orbits.continuation import continue_orbit, switch_branch
from rocking.orbits.event_chain import IMPACT, Chain, chain_of, orbit_of, solved
from rocking.orbits.parameter import check_range, check_step, coordinate_of, different_values, with_value
from rocking.orbits.special_points import SYMMETRY_BREAKING
from rocking.orbits.verdicts import verdicts_over
from rocking.survey.engine import Engine
from rocking.theory import symmetric_modes

if TYPE_CHECKING:
    import xarray as xr


MAX_CYCLES_IN_MODE = 99


@frozen(eq=False)
class FrequencyResponse(ReadOnlyArrays, Result):
    """Peak rotation over the period or the frequency of the forcing; returned by `frequency_response`.

    Attributes
    ----------
    system : System
        System of which the period or the frequency is varied.
    modes : tuple of int
        Numbers n of the (1, n) orbits: one rocking cycle in n forcing cycles.
    parameter : str
        "period" or "frequency".
    values : ndarray, shape (m,)
        Values of the parameter for the response from rest, ascending. The branches extend from the first to the last.
    branches : tuple of Branch
        For each n, the symmetric branches, each followed by the asymmetric ones that bifurcate from it. `points["peak"]` is
        the largest |Θ|. Of two branches that are mirror images, with equal peaks, one is included.
    rest : structured ndarray, shape (m,)
        Responses from rest, with the fields "kind" (see `Kind`), "period" in forcing cycles (0 if not periodic), "peak"
        (largest |Θ| from τ = 0) and "steady_peak" (largest |Θ| of the periodic response, NaN if there is none).

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.frequency_response(system, period=[0.5, 1.0], modes=(1,))
    >>> result.rest["kind"].tolist(), len(result.of(1))
    (['periodic', 'periodic'], 1)
    """

    PLOT = "frequency_response"
    LONG = ("point",)

    system: System
    modes: tuple[int, ...]
    parameter: str
    values: NDArray[np.float64] = field(repr=False, converter=read_only)
    branches: tuple[Branch, ...] = field(repr=False)
    rest: NDArray[np.void] = field(repr=False, converter=read_only)

    def of(self, n: int) -> tuple[Branch, ...]:
        """Return the branches of the (1, n) orbits.

        Parameters
        ----------
        n : int
            Number of forcing cycles per response period, in [1, 99].

        Returns
        -------
        tuple of Branch
            Branches; empty if none was found.

        Raises
        ------
        TypeError, ValueError
            If `n` is not a whole number in its range.
        """
        period = whole("n", n, 1, MAX_CYCLES_IN_MODE)
        return tuple(branch for branch in self.branches if branch.period == period)

    def _data(self) -> xr.Dataset:
        import xarray as xr

        name = self.parameter
        kinds, counts = np.unique(self.rest["kind"], return_counts=True)
        types = {"rest": (kinds.astype("U16"), "type of the response from rest")}
        coordinates = {
            name: coordinate_of("point", name, self._joined("parameter", self.values)),
            **along("rest", types),
        }
        variables = {
            **along("point", self._points()),
            **along("branch", self._branches()),
            **along("special", self._special_points()),
            **along("rest", {"rest_count": (counts, "number of responses from rest of the type")}),
        }
        attributes = described("Frequency response") | {
            "parameter": name,
            f"{name}_range": self.values[[0, -1]].tolist(),
            "values": len(self.values),
            "amplitude": self.system.periodic.amplitude,
            "restitution": self.system.restitution,
            "phase": self.system.periodic.phase,
            "modes": list(self.modes),
        }
        return xr.Dataset(variables, coordinates, attributes)

    def _joined(self, column: str, of_rest: Any) -> NDArray[Any]:
        """Return a column of the points of all branches, then of the responses from rest."""
        return np.concatenate([*(branch.points[column] for branch in self.branches), of_rest])

    def _points(self) -> dict[str, tuple[Any, ...]]:
        """Return the columns of the points of all branches and of the responses from rest."""
        lengths, rest = [len(branch) for branch in self.branches], self.rest
        numbers = np.repeat([f"{number}" for number in range(len(lengths))] or [""], lengths or [0])
        periods = np.repeat([branch.period for branch in self.branches] or [0], lengths or [0])
        none = np.full(sum(lengths), "")
        return {
            "branch_number": (np.append(numbers, np.full(len(rest), "from rest")), "number of the branch"),
            "orbit_period": (
                np.append(periods, rest["period"]),
                "forcing cycles per response period; 0 if not periodic",
            ),
            "stability": (self._joined("stability", np.full(len(rest), "", "U8")), "stability of the orbit"),
            "response": (np.append(none, rest["kind"]).astype("U16"), "type of the response from rest"),
            "peak": (
                self._joined("peak", self.steady_peak),
                "largest magnitude of the angle of the orbit or response",
            ),
        }

    def _branches(self) -> dict[str, tuple[Any, ...]]:
        """Return the columns of the branches, with the point of the largest angle of each."""
        branches, name = self.branches, self.parameter
        highest = [branch.points[int(np.nanargmax(branch.points["peak"]))] for branch in branches]
        return {
            "branch_mode": (np.array([one.period for one in branches], int), "n of the (1, n) orbits"),
            "branch_symmetric": (
                np.array([one.symmetric for one in branches], bool),
                "whether the orbits are symmetric",
            ),
            "branch_points": (np.array([len(one) for one in branches], int), "number of points"),
            "branch_stable_points": (
                np.array([one.points["stable"].sum() for one in branches], int),
                "number of stable orbits",
            ),
            "branch_peak": (
                np.array([one["peak"] for one in highest], float),
                "largest magnitude of the angle",
            ),
            f"branch_{name}": (
                np.array([one["parameter"] for one in highest], float),
                f"{name} of this angle",
            ),
            "branch_first_end": (
                np.array([one.ends[0] for one in branches], str),
                "reason why the branch begins",
            ),
            "branch_last_end": (
                np.array([one.ends[1] for one in branches], str),
                "reason why the branch ends",
            ),
        }

    def _special_points(self) -> dict[str, tuple[Any, ...]]:
        """Return the columns of the special points of all branches."""
        rows = [(number, one) for number, branch in enumerate(self.branches) for one in branch.special]
        name = self.parameter
        return {
            "special_branch": (np.array([number for number, _ in rows], int), "number of the branch"),
            "special_kind": (np.array([one.kind for _, one in rows], "U17"), "type of the special point"),
            f"special_{name}": (
                np.array([one.parameter for _, one in rows], float),
                f"{name} of the special point",
            ),
        }

    @property
    def steady_peak(self) -> NDArray[np.float64]:
        """Largest |Θ| of each response from rest, shape (m,): of the periodic response or, without one, from the start on."""
        return np.where(np.isnan(self.rest["steady_peak"]), self.rest["peak"], self.rest["steady_peak"])

    def __str__(self) -> str:
        result = "; ".join(_of_mode(n, self.of(n)) for n in self.modes)
        kinds = Counter(str(kind) for kind in self.rest["kind"])
        rest = ", ".join(f"{number:,} {kind}" for kind, number in kinds.most_common())
        return (
            f"frequency response at amplitude {self.system.periodic.amplitude:.6g}, "
            f"restitution {self.system.restitution:.6g}, {self.parameter} "
            f"{self.values[0]:.6g} to {self.values[-1]:.6g}: {result}; from rest {rest}"
        )


def _of_mode(n: int, branches: Sequence[Branch]) -> str:
    if not branches:
        return f"(1, {n}) none found"
    symmetric = sum(branch.symmetric for branch in branches)
    peak = max(float(np.nanmax(branch.points["peak"])) for branch in branches)
    return f"(1, {n}) {symmetric} symmetric, {len(branches) - symmetric} asymmetric, peak up to {peak:.4g}"


MAX_VALUES = 100_000
# Longest response period sought, as in `classify`.
MAX_PERIOD = 64
# Largest difference of identical phases, and of the parameter at identical special points.
SAME = 1e-6

REST = np.dtype([("kind", "U14"), ("period", np.int64), ("peak", float), ("steady_peak", float)])


def frequency_response(
    system: System,
    *,
    period: ArrayLike | None = None,
    frequency: ArrayLike | None = None,
    modes: Sequence[int] = (1, 3),
    step: float = 0.01,
    max_cycles: int = 10_000,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> FrequencyResponse:
    """Compute the frequency response at one amplitude: branches of the (1, n) orbits, and verdicts on the response from rest.

    The branches start from the symmetric modes of Yim & Lin (1991), Eqs. (8)–(10), at the given values. They are followed in
    both directions, through folds, together with the asymmetric branches that bifurcate at symmetry breakings.

    Parameters
    ----------
    system : System
        Slender block on a harmonic base, of any period. Its amplitude is above 0, and its coefficient of restitution in [0.001, 1).
        It has no braces.
    period, frequency : array (n,)
        Exactly one of them: forcing period T or angular frequency Ω. At least two different values, in any order; equal ones
        count once.
    modes : sequence of int
        Numbers n of forcing cycles per response period: odd, up to 99. Default: (1, 3).
    step : float
        Largest step, as in `continue_orbit`. Default: 0.01.
    max_cycles : int
        Maximum number of forcing cycles for each response from rest, as in `classify`. A verdict of chaos needs 10⁴.
        Default: 10,000.
    store, executor, progress, repair
        As in `parametric_map`, for the responses from rest. The branches, which take a small part of the time, are followed anew.

    Returns
    -------
    FrequencyResponse
        Branches, and verdicts on the response from rest at each value.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or if not exactly one of `period` and `frequency` is given.
    ValueError
        If an argument lies outside its range, or if a number in `modes` is even.
    ImportError, OSError
        As in `parametric_map`, with a store.

    See Also
    --------
    continue_orbit : Follow one orbit through any parameter.
    rocking.plot.frequency_response : Plot the curve.

    Notes
    -----
    Limits: a branch that lies between two neighbouring values is not found. Asymmetric branches without a connection to a
    symmetric one, and branches from period doublings, are not included. Use `find_orbits` and `switch_branch` for them.

    Examples
    --------
    >>> import numpy as np, rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.frequency_response(system, period=np.linspace(0.5, 2.5, 9))
    >>> print(result)
    frequency response at amplitude 2, ...: (1, 1) 1 symmetric, 0 asymmetric, ...; (1, 3) 2 symmetric, 1 asymmetric, ...
    """
    parameter = exactly_one(period=period, frequency=frequency)
    values = _values(parameter, period if frequency is None else frequency)
    amplitude = instance("system", system, System).harmonic.amplitude
    refuse_if(
        amplitude == 0.0, "amplitude", "be above 0: without forcing there is no (1, n) orbit", amplitude
    )
    refuse_if(
        system.braces is not None,
        "system",
        "have no braces: its (1, n) orbits are those of a free block",
        system,
    )
    _check_lossy(system.restitution)
    followed = tuple(dict.fromkeys(_odd(n) for n in _sequence(modes)))
    step = check_step(step)
    systems = [with_value(system, parameter, value) for value in values.tolist()]
    verdicts = verdicts_over(
        system,
        State(),
        parameter,
        values,
        max_cycles,
        MAX_PERIOD,
        store,
        executor,
        progress=progress,
        repair=repair,
    )
    with Bar(len(systems) * len(followed), "branches", shown=progress) as bar:
        branches = [
            branch
            for n in followed
            for branch in _branches(systems, n, parameter, values[[0, -1]], step, bar)
        ]
    return FrequencyResponse(
        system=system,
        modes=followed,
        parameter=parameter,
        values=values,
        branches=tuple(branches),
        rest=_from_rest(verdicts),
    )


def _values(name: str, values: Any) -> NDArray[np.float64]:
    ordered = different_values(name, values, 2, MAX_VALUES)
    check_range(name, (float(ordered[0]), float(ordered[-1])), name)
    return ordered


def _check_lossy(restitution: float) -> None:
    within("restitution", restitution, 1e-3, 1.0)
    if restitution == 1.0:
        remedy = (
            "an undamped motion never reaches a steady response; theory.symmetric_modes returns the modes"
        )
        raise Refusal("restitution", "lie in [0.001, 1)", restitution, remedy)


def _sequence(modes: Any) -> tuple[int, ...]:
    if isinstance(modes, str) or not np.iterable(modes) or not tuple(modes):
        raise WrongType("modes", "be a sequence of odd numbers, such as (1, 3)", modes)
    return tuple(modes)


def _odd(n: int) -> int:
    n = whole("modes", n, 1, MAX_CYCLES_IN_MODE)
    refuse_if(n % 2 == 0, "modes", "be odd: no symmetric orbit repeats after an even number of cycles", n)
    return n


def _branches(
    systems: Sequence[System], n: int, parameter: str, ends: np.ndarray, step: float, bar: Bar
) -> list[Branch]:
    """Return all branches of the (1, n) orbits: each symmetric one, followed by the asymmetric ones that bifurcate from it."""
    bounds = float(ends[0]), float(ends[1])
    symmetric: list[Branch] = []
    for system in systems:
        value = getattr(system.forcing, parameter)
        known = [phase for branch in symmetric for phase in _phases(branch, value)]
        for mode in symmetric_modes(system.harmonic.amplitude, system.harmonic.period, system.restitution, n):
            if any(abs(math.remainder(mode.phase - phase, math.tau)) <= SAME for phase in known):
                continue
            orbit = _orbit_of_mode(mode, system, parameter) if mode.admissible else None
            if orbit is not None:
                symmetric.append(continue_orbit(orbit, parameter, bounds, step))
                known += _phases(symmetric[-1], value)
        bar.advance(1)
    return [one for branch in symmetric for one in (branch, *_born(branch, bounds, step))]


def _phases(branch: Branch, value: float) -> list[float]:
    """Return the forcing phases at which the symmetric orbits of a branch move to the positive side, which identify the mode."""
    values = branch.points["parameter"]
    chains = [chain_of(orbit) for orbit in branch.at(value)] if values.min() <= value <= values.max() else []
    return [float(chain.phases[0]) + (0.0 if chain.side > 0 else math.pi) for chain in chains]


def _born(branch: Branch, bounds: tuple[float, float], step: float) -> list[Branch]:
    """Return one of each pair of asymmetric branches; a branch between two special points is returned once."""
    born: list[Branch] = []
    for special in branch.special:
        met = [
            abs(other.parameter - special.parameter) <= SAME
            for one in born
            for other in one.special
            if other.kind == special.kind
        ]
        if special.kind == SYMMETRY_BREAKING and not any(met):
            born.append(switch_branch(special, bounds, step)[0])
    return [one for one in born if len(one) > 1]


def _orbit_of_mode(mode: Mode, system: System, parameter: str) -> Orbit | None:
    """Return a symmetric mode as an orbit: half a period with one impact, at the phase of the closed form."""
    chain = Chain(system, mode.n, True, np.array([IMPACT]), 1, np.array([mode.phase]))
    there = solved(chain, parameter, getattr(system.forcing, parameter), chain.phases)
    if not there.found:
        return None
    return orbit_of(chain, parameter, there.phases, there.trace, there.determinant)


def _from_rest(verdicts: Sequence[Verdict]) -> NDArray[np.void]:
    """Return the table of the responses from rest."""
    rest = np.empty(len(verdicts), REST)
    rest["kind"] = [Kind(verdict.kind).value for verdict in verdicts]
    rest["period"] = [verdict.period or 0 for verdict in verdicts]
    rest["peak"] = [verdict.peak for verdict in verdicts]
    rest["steady_peak"] = nan_if_none(verdict.steady_peak for verdict in verdicts)
    return rest
