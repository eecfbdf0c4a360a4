"""Search for all periodic orbits up to a period; each is stored once with its number of hits."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, overload

import numpy as np
from attrs import evolve, field, frozen

from rocking.kernels import batch
from rocking.model.orbit import Orbit, Stability, orbit_columns
from rocking.model.result import Result, along, described
from rocking.model.system import State, System, check_no_wall, quantities
from rocking.model.text import counted
from rocking.model.validation import instance, pair, refuse_if, whole, within
from rocking.orbits.event_chain import clocked
from rocking.orbits.find_orbit import newton_from_starts, orbit_from
from rocking.orbits.parameter import identity_of
from rocking.orbits.saddles import response
from rocking.proof.prove import check_provable
from rocking.proof.prove import prove as proved
from rocking.survey.engine import Engine
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import SurveySpec, Values
from rocking.survey.store_access import store_in

if TYPE_CHECKING:
    import xarray as xr


# Largest distance of two identical results of Newton's method, and of two identical orbits.
SAME = 1e-6


def mirrored(orbit: Orbit) -> Orbit:
    """Return the mirror image of an orbit, which is an orbit half a forcing period later."""
    state = State(-orbit.state.angle, -orbit.state.velocity)
    events = tuple(
        evolve(one, angle=-one.angle, before=-one.before, after=-one.after) for one in orbit._events
    )
    return evolve(orbit, state=state, phase=(orbit.phase + math.pi) % math.tau, events=events)


class OrbitRegistry:
    """Orbits found so far, with all their states on the section at a forcing phase."""

    def __init__(self, system: System, phase: float) -> None:
        self.system, self.phase = system, phase
        self.orbits: list[Orbit] = []
        self.pairs: list[int] = []
        self.counts: list[int] = []
        self.rows = np.empty((0, 2))
        self.owner = np.empty(0, int)

    @property
    def hits(self) -> list[int]:
        """Number of states that belong to each orbit or to its mirror image."""
        return [self.counts[pair] for pair in self.pairs]

    def add_states(self, states: np.ndarray, period: int) -> None:
        """Count the states that belong to known orbits, and add the orbits of the others with their mirror images."""
        states = states[~self._counted(states)]
        while len(states):
            orbit = orbit_from(self.system, self.phase, State(*map(float, states[0])), period)
            near = np.hypot(*(states - states[0]).T) <= SAME
            if orbit is not None and (
                orbit.impacts != 0 or orbit.brace_hits != 0 or abs(orbit.state.angle) > SAME
            ):
                self.counts[self._pair(orbit)] += int(near.sum())
            states = states[~near]
            states = states[~self._counted(states)]

    def _counted(self, states: np.ndarray) -> np.ndarray:
        """Return which states belong to known orbits, and count them."""
        owners = self._owners(states)
        for owner, number in zip(*np.unique(owners[owners >= 0], return_counts=True), strict=True):
            self.counts[self.pairs[owner]] += int(number)
        return owners >= 0

    def _owners(self, states: np.ndarray) -> np.ndarray:
        """Return the number of the known orbit of each state, -1 for none.

        Each state is compared with the rows whose angle is no further away than `SAME`, not with all.
        """
        order = np.argsort(self.rows[:, 0])
        angles = self.rows[order, 0]
        first = np.searchsorted(angles, states[:, 0] - SAME)
        counts = np.searchsorted(angles, states[:, 0] + SAME, side="right") - first
        owners, nearest = np.full(len(states), -1), np.full(len(states), SAME)
        for k in range(counts.max(initial=0)):
            here = np.flatnonzero(counts > k)
            rows = order[first[here] + k]
            distances = np.hypot(*(states[here] - self.rows[rows]).T)
            closer = distances <= nearest[here]
            owners[here[closer]], nearest[here[closer]] = self.owner[rows[closer]], distances[closer]
        return owners

    def _pair(self, orbit: Orbit) -> int:
        """Return the number under which an orbit and its mirror image are counted, and add them if they are new.

        A known orbit may appear again if Newton's method came near to it, but not within `SAME`.
        """
        here = orbit.at(self.phase)
        (owner,) = self._owners(np.array([[here.angle, here.velocity]]))
        if owner >= 0:
            return self.pairs[owner]
        self.counts.append(0)
        self._add(orbit)
        if not orbit.symmetric and self.system.left is None:
            self._add(mirrored(orbit))
        return len(self.counts) - 1

    def _add(self, orbit: Orbit) -> None:
        there = [orbit.at(self.phase + math.tau * cycle) for cycle in range(orbit.period)]
        self.rows = np.concatenate([self.rows, [(state.angle, state.velocity) for state in there]])
        self.owner = np.concatenate([self.owner, np.full(orbit.period, len(self.orbits))])
        self.orbits.append(orbit)
        self.pairs.append(len(self.counts) - 1)


Map = tuple[int, bool]
"""Forcing cycles of a map, and whether it is mirrored after half of them."""


def maps_up_to(max_period: int, *, symmetric: bool = True) -> list[Map]:
    """Return the maps over each period, then, for a symmetric block, those over half of each odd period and mirrored."""
    periods = range(1, max_period + 1)
    return [(n, False) for n in periods] + [(n, True) for n in periods[::2] if symmetric]


NOT_FOUND, FOUND = 0, 1
DIFFERENT = 7919
"""Distance of the first guesses of two maps in their common sequence, so that maps have different guesses."""


@frozen(eq=False)
class SearchSpec(SurveySpec):
    """Survey of Newton's method over maps and the initial guesses of a round."""

    comment = "Attributes and variables are normalised as in Yim & Lin (1991), Eqs. (1)-(4)."
    contiguous = True
    numbers: ClassVar[dict[str, str]] = {"map": "number of the map", "guess": "number of the initial guess"}

    system: System = field(kw_only=True)
    max_period: int = field(kw_only=True)
    box: tuple[float, ...] | None = field(kw_only=True)
    effort: float = field(kw_only=True)
    seed: int = field(kw_only=True)

    @property
    def refines(self) -> bool:
        """Flag: there is nothing between two guesses."""
        return False

    def inputs(self, values: Values) -> tuple[System, list[tuple[Map, np.ndarray]]]:
        """Return the system, and the initial guesses (n, 2) of each map, in the order of the points."""
        maps, numbers = values["map"].astype(int), values["guess"].astype(int)
        known = maps_up_to(self.max_period)
        parts = [(each, numbers[maps == each]) for each in np.unique(maps).tolist()]
        return self.system, [
            (known[each], _starts(self.system, self.box, guesses + self.seed + DIFFERENT * each))
            for each, guesses in parts
        ]

    def described(self) -> dict[str, Any]:
        """Return the quantities of the system, and what determines the guesses."""
        ends = {} if self.box is None else {"angles": list(self.box[:2]), "velocities": list(self.box[2:])}
        search = {"max_period": self.max_period, "effort": self.effort, "seed": self.seed}
        return identity_of(self.system) | search | ends


def fixed_points_at(
    inputs: tuple[System, list[tuple[Map, np.ndarray]]], options: Mapping[str, int], stop: np.ndarray
) -> Arrays | None:
    """Return the results of Newton's method from initial guesses; None if another thread sets `stop`."""
    system, parts = inputs
    rows = []
    for (period, mirrored), starts in parts:
        if stop[0]:
            return None
        rows.append(newton_from_starts(system, period, mirrored, starts))
    found, angle, velocity, _ = np.concatenate(rows).T
    return {"angle": angle, "velocity": velocity, "found": found.astype(np.uint8)}


FIXED_POINTS = Measurement(
    "Search for periodic orbits of a free-standing block on a shaking base",
    fixed_points_at,
    (
        Variable(
            "angle", "float64", math.inf, {"long_name": "angle at the end of Newton's method", "units": "1"}
        ),
        Variable(
            "velocity",
            "float64",
            math.inf,
            {"long_name": "velocity at the end of Newton's method", "units": "1"},
        ),
        Variable(
            "found",
            "uint8",
            255,
            {
                "long_name": "whether a fixed point was found",
                "flag_values": np.array([NOT_FOUND, FOUND], np.uint8),
                "flag_meanings": "none fixed-point",
            },
        ),
    ),
    {},
    batch.METHOD,
    shares="found",
    batch=1024,
)

MAX_PERIOD = 64
# Number of initial guesses per map in the first round; it doubles in later rounds.
FIRST_ROUND = 2048
MAX_ROUNDS = 6
# Speed limit for a block between braces, relative to the unforced one.
FASTER = 2.0
# Plastic number: multiples of its inverse powers form a low-discrepancy sequence in the plane.
PLASTIC = 1.324717957244746


@frozen(eq=False)
class Orbits(Sequence[Orbit], Result):
    """Periodic orbits found by `find_orbits`: a sequence of `Orbit`, ordered by period, then from stable to unstable.

    Attributes
    ----------
    system : System
        System of the orbits.
    max_period : int
        Longest period of the search.
    hits : tuple of int
        Number of initial guesses that led to each orbit or to its mirror image.
    starts : int
        Number of initial guesses over all maps.
    settled : bool
        True if the last round, with as many guesses as all rounds before, found no new orbit.
    orbits : tuple of Orbit
        Orbits of the sequence.

    Notes
    -----
    Completeness is not guaranteed. An orbit that few guesses lead to may be missing; a small minimum of `hits` is a sign of
    that. Orbits within 10⁻⁶ of each other count as one.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.find_orbits(system, 1)
    >>> len(result), result.settled, result[0].stable
    (3, True, True)
    """

    PLOT = "orbits"

    system: System
    max_period: int
    hits: tuple[int, ...]
    starts: int
    settled: bool
    orbits: tuple[Orbit, ...] = field(repr=False)

    @overload
    def __getitem__(self, index: int) -> Orbit: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Orbit, ...]: ...

    def __getitem__(self, index: Any) -> Any:
        return self.orbits[index]

    def __iter__(self) -> Iterator[Orbit]:
        return iter(self.orbits)

    def __len__(self) -> int:
        return len(self.orbits)

    def _data(self) -> xr.Dataset:
        import xarray as xr

        columns = {
            **orbit_columns(self, start=True),
            "hits": (np.array(self.hits, int), "initial guesses that led to the orbit"),
            "proved": (
                np.array([one.proof is not None and one.proof.proved for one in self], bool),
                "whether the orbit is proved",
            ),
        }
        attributes = described("Periodic orbits") | {
            **quantities(self.system),
            "max_period": self.max_period,
            "starts": self.starts,
            "settled": self.settled,
        }
        return xr.Dataset(along("orbit", columns), attrs=attributes)

    def __str__(self) -> str:
        if not len(self):
            return (
                f"no orbit of period ≤ {self.max_period} was found from {self.starts} initial guesses; "
                "completeness is not guaranteed"
            )
        counts = Counter(orbit.stability for orbit in self)
        stable = f"{counts[Stability.STABLE]} of them stable"
        if counts[Stability.NEUTRAL]:
            stable += f", {counts[Stability.NEUTRAL]} neutral"
        proved = [orbit.proof for orbit in self if orbit.proof is not None]
        if proved:
            stable += f", {sum(proof.proved for proof in proved)} of them proved"
        least = min(self.hits, default=0)
        last = (
            "the last half of them found no new orbit"
            if self.settled
            else "the last of them still found new orbits"
        )
        return (
            f"{counted(len(self), 'orbit')} of period ≤ {self.max_period}, {stable}, from {self.starts} initial guesses; {last}, "
            f"and each orbit was found from at least {least} guesses; completeness is not guaranteed"
        )


def find_orbits(
    system: System,
    max_period: int,
    angles: tuple[float, float] | None = None,
    velocities: tuple[float, float] | None = None,
    effort: float = 1.0,
    seed: int = 0,
    prove: bool = False,
    *,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> Orbits:
    """Search for all periodic orbits up to a period, stable and unstable.

    Newton's method with the exact Jacobian is applied to the map over every period. For symmetric orbits of odd periods it
    is also applied to the map over half a period and mirrored, whose orbits are less unstable. The initial guesses are evenly
    distributed. Their number doubles in each round, until a round finds no new orbit.

    Parameters
    ----------
    system : System
        Block, base motion and braces.
    max_period : int
        Longest period, in forcing cycles, in [1, 64].
    angles, velocities : (float, float), optional
        Ranges of the initial guesses. Default for a slender block without braces: the region that contains every periodic
        orbit, because overturning is certain beyond it, forward or backward in time. Default otherwise: all angles between
        the braces, or up to 1 + A/(1 + Ω²), and speeds up to twice an estimate from forcing and fall.
    effort : float
        Number of initial guesses per map in the first round, in units of 2048, in [0.01, 1000]. Default: 1.
    seed : int
        First index of the sequence of guesses, in [0, 2³² − 1]. Default: 0.
    prove : bool
        Whether to prove each orbit in ball arithmetic, as `orbit.proof`. Default: False.
    store, executor, progress, repair
        As in `parametric_map`, for Newton's method. The store holds one survey for each round, a folder in it.

    Returns
    -------
    Orbits
        Sequence of `Orbit`; `print` shows a summary of the search.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an argument lies outside its range.
    ImportError, OSError
        As in `parametric_map`, with a store.

    See Also
    --------
    find_orbit : Find one orbit near a guess.
    basin_map : Basins of the attractors.
    rocking.theory.symmetric_modes : Symmetric modes in closed form.

    Notes
    -----
    Completeness is not guaranteed, see `Orbits`. An orbit is omitted if it is so unstable that a motion from it overturns
    within one period.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> orbits = rk.find_orbits(system, 1)
    >>> [str(orbit.stability) for orbit in orbits]
    ['stable', 'unstable', 'unstable']
    >>> print(orbits[1])
    asymmetric orbit of period 1 with 0 impacts
    """
    check_no_wall(instance("system", system, System))
    max_period = whole("max_period", max_period, 1, MAX_PERIOD)
    effort = within("effort", effort, 0.01, 1000.0)
    seed = whole("seed", seed, 0, 2**32 - 1)
    if instance("prove", prove, bool):
        check_provable(system)
    box = _box(system, angles, velocities)
    there = clocked(system, (system.periodic.phase + math.tau * batch.SECTION) % math.tau)
    known, used = OrbitRegistry(system, there.periodic.phase), 0
    maps = maps_up_to(max_period, symmetric=system.left is None)
    settled = False
    for number in range(MAX_ROUNDS):
        count = max(round(effort * FIRST_ROUND * 2 ** max(number - 1, 0)), 1)
        before = len(known.orbits)
        axes = {"map": np.arange(float(len(maps))), "guess": np.arange(float(used), float(used + count))}
        spec = SearchSpec(axes, system=there, max_period=max_period, box=box, effort=effort, seed=seed)
        place = store_in(store, "round", number)
        found = run_survey(spec, FIXED_POINTS, place, executor, progress=progress, repair=repair).load()
        for row, (period, _) in enumerate(maps):
            here = found.isel(map=row)
            states = np.column_stack([here["angle"], here["velocity"]])
            known.add_states(states[here["found"].values == FOUND], period)
        used += count
        if number and len(known.orbits) == before:
            settled = True
            break
    order = sorted(range(len(known.orbits)), key=lambda i: _rank(known.orbits[i]))
    orbits = [known.orbits[i] for i in order]
    return Orbits(
        system=system,
        max_period=max_period,
        hits=tuple(known.hits[i] for i in order),
        starts=used * len(maps),
        settled=settled,
        orbits=tuple(evolve(orbit, proof=proved(orbit)) if prove else orbit for orbit in orbits),
    )


def _rank(orbit: Orbit) -> tuple[int, float, float]:
    size = 1.0 if orbit.stability is Stability.NEUTRAL else abs(orbit.multipliers[0])
    return orbit.period, size, orbit.state.angle


def _box(system: System, angles: Any, velocities: Any) -> tuple[float, ...] | None:
    """Return the ranges of the initial guesses, or None for the region of all orbits without braces.

    Returns
    -------
    tuple of float, or None
        Lowest and highest angle, lowest and highest velocity.
    """
    forcing, braces = system.periodic, system.braces
    if angles is None and velocities is None and braces is None and system.has_chains:
        return None
    beta, least = forcing.amplitude / (1.0 + forcing.frequency**2), 1.0
    if system.left is not None:
        beta *= max(1.0, system.left.frequency_ratio**2)
        least = max(1.0, system.left.angle_ratio)
    reach = least + beta if braces is None else braces.angle
    fastest = (1.0 + (0.0 if braces is None else reach)) * FASTER * (1.0 + beta * (1.0 + forcing.frequency))
    box: tuple[float, ...] = ()
    for name, bounds, usual in (("angles", angles, reach), ("velocities", velocities, fastest)):
        allowed = "be (lowest, highest), the one below the other"
        ends = (-usual, usual) if bounds is None else pair(name, bounds, allowed)
        low, high = (value if bounds is None else within(name, value, -1e3, 1e3) for value in ends)
        refuse_if(not low < high, name, allowed, bounds)
        box = (*box, low, high)
    return box


def _starts(system: System, box: tuple[float, ...] | None, numbers: np.ndarray) -> np.ndarray:
    """Return evenly distributed initial guesses in the box, or in the region of all periodic orbits without braces."""
    index = numbers[:, None] + 0.5
    x, y = np.mod(index * np.array([1.0 / PLASTIC, 1.0 / PLASTIC**2]), 1.0).T
    if box is not None:
        return np.column_stack([box[0] + (box[1] - box[0]) * x, box[2] + (box[3] - box[2]) * y])
    forcing = system.periodic
    beta = response(system)
    in_phase = beta * math.cos(forcing.phase)
    quadrature = beta * forcing.frequency * math.sin(forcing.phase)
    # On each side, u + u' and u - u' are bounded and u >= 0. The points of a parallelogram are folded into this triangle.
    side = np.where(x < 0.5, 1.0, -1.0)
    x = np.where(x < 0.5, 2.0 * x, 2.0 * x - 1.0)
    over = x + y > 1.0
    x, y = np.where(over, 1.0 - x, x), np.where(over, 1.0 - y, y)
    stays, came = 1.0 + side * (in_phase - quadrature), 1.0 + side * (in_phase + quadrature)
    wide = np.maximum(stays + came, 0.0)
    plus, minus = stays - wide * x, came - wide * y
    return np.column_stack([0.5 * side * (plus + minus), 0.5 * side * (plus - minus)])
