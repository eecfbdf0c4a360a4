"""All periodic orbits up to a period, as far as a search can tell."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, overload

import numpy as np
from attrs import field, frozen

from rocking.model import Orbit, Stability, System, instance, pair, refusal, whole, within
from rocking.orbits.event_chain import clocked
from rocking.orbits.find_orbit import newton_from_starts
from rocking.orbits.orbit_registry import OrbitRegistry
from rocking.orbits.saddle_orbits import response

MAX_PERIOD = 64
# Away from the phase of any likely start.
SECTION = 0.3819660112501051
# The first round's starts a map, then twice as many, and so on.
FIRST_ROUND = 2048
MAX_ROUNDS = 6
# How much faster than unforced a block between braces may be.
FASTER = 2.0
# The plane's own golden ratio: multiples of its powers fill a square evenly however many there are.
PLASTIC = 1.324717957244746


@frozen(eq=False)
class Orbits(Sequence[Orbit]):
    """The periodic orbits that `find_orbits` found: a sequence of `Orbit`, by period, the more stable first.

    Attributes
    ----------
    system : System
        Whose orbits they are.
    max_period : int
        Longest period looked for.
    hits : tuple of int
        How many starts led to each orbit or to its mirror image.
    starts : int
        Starts in all, over all maps.
    settled : bool
        Whether the last round, with as many starts as all before it, found nothing new.
    orbits : tuple of Orbit
        What the sequence holds.

    Notes
    -----
    Not guaranteed: completeness. An orbit that few starts lead to may be missing; the least of `hits` tells how near that
    is. Orbits within 10⁻⁶ of each other count as one.
    """

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

    def __str__(self) -> str:
        counts = Counter(orbit.stability for orbit in self)
        stable = f"{counts[Stability.STABLE]} of them stable"
        if counts[Stability.NEUTRAL]:
            stable += f", {counts[Stability.NEUTRAL]} neutral"
        least = min(self.hits, default=0)
        last = (
            "the last half of them found nothing new"
            if self.settled
            else "the last of them still found new ones"
        )
        return (
            f"{len(self)} orbits of period ≤ {self.max_period}, {stable}, from {self.starts} starts; "
            f"{last}, each was met {least} times at least; completeness is not guaranteed"
        )


def find_orbits(
    system: System,
    max_period: int,
    angles: tuple[float, float] | None = None,
    velocities: tuple[float, float] | None = None,
    effort: float = 1.0,
    seed: int = 0,
) -> Orbits:
    """Search for all periodic orbits up to a period, stable and unstable.

    Newton's method with the exact Jacobian on the map over every period, and, for the symmetric orbits of odd periods, on the
    map over half of one and mirrored, whose orbits are less unstable; from evenly spread starts, twice as many in each round,
    until a round with as many starts as all before it finds nothing new.

    Parameters
    ----------
    system : System
        The block, its forcing and its braces.
    max_period : int
        Longest period, in forcing cycles, 1 to 64.
    angles, velocities : (float, float), optional
        The box of starts. By default, without braces, the region in which every periodic orbit must lie: beyond it a
        motion never returns, or never came from the base (the condition of no return, forward and backward in time). With
        braces a box between them, at speeds up to twice what forcing and fall suggest.
    effort : float
        Starts of the first round, as a multiple of 2048 a map, in [0.01, 1000].
    seed : int
        Where the even spread begins.

    Returns
    -------
    Orbits
        A sequence of `Orbit`; `print` says what was done, and what it does not guarantee.

    Raises
    ------
    TypeError, ValueError
        In one line, for arguments of the wrong type or outside their range.

    See Also
    --------
    find_orbit : Find one orbit near a guess.
    basin_map : Basins of the attractors.
    rocking.theory.symmetric_modes : Symmetric modes in closed form.

    Notes
    -----
    Not guaranteed: completeness, see `Orbits`. An orbit is left out if it is so unstable that a run from it overturns
    within one period.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> for orbit in rk.find_orbits(system, 1):
    ...     print("stable  " if orbit.stable else "unstable", orbit)
    stable   symmetric orbit of period 1 with 2 impacts
    unstable unsymmetric orbit of period 1 with 0 impacts
    unstable unsymmetric orbit of period 1 with 0 impacts
    """
    instance("system", system, System)
    max_period = whole("max_period", max_period, 1, MAX_PERIOD)
    effort = within("effort", effort, 0.01, 1000.0)
    seed = whole("seed", seed, 0, 2**32 - 1)
    box = _box(system, angles, velocities)
    forcing = system.forcing
    there = clocked(system, (forcing.phase + math.tau * SECTION) % math.tau)
    known, used = OrbitRegistry(system, there.forcing.phase), 0
    jobs = [(n, False) for n in range(1, max_period + 1)] + [(n, True) for n in range(1, max_period + 1, 2)]
    settled = False
    with ThreadPoolExecutor() as pool:
        for number in range(MAX_ROUNDS):
            count = max(round(effort * FIRST_ROUND * 2 ** max(number - 1, 0)), 1)
            before = len(known.orbits)
            batches = [_starts(there, box, count, used + seed + 7919 * j) for j, _ in enumerate(jobs)]
            outcomes = pool.map(
                lambda job, starts: newton_from_starts(there, job[0], job[1], starts), jobs, batches
            )
            for (period, _), out in zip(jobs, outcomes, strict=True):
                known.add_states(out[out[:, 0] == 1.0, 1:3], period)
            used += count
            if number and len(known.orbits) == before:
                settled = True
                break
    order = sorted(range(len(known.orbits)), key=lambda i: _rank(known.orbits[i]))
    return Orbits(
        system=system,
        max_period=max_period,
        hits=tuple(known.hits[i] for i in order),
        starts=used * len(jobs),
        settled=settled,
        orbits=tuple(known.orbits[i] for i in order),
    )


def _rank(orbit: Orbit) -> tuple[int, float, float]:
    size = 1.0 if orbit.stability is Stability.NEUTRAL else abs(orbit.multipliers[0])
    return orbit.period, size, orbit.state.angle


def _box(system: System, angles: Any, velocities: Any) -> tuple[float, ...] | None:
    """The box of starts, (lowest and highest angle, lowest and highest velocity); None for where all orbits without braces lie."""
    if angles is None and velocities is None and system.braces is None:
        return None
    forcing, braces = system.forcing, system.braces
    beta = response(system)
    reach = 1.0 + beta if braces is None else braces.angle
    fastest = (1.0 + (0.0 if braces is None else reach)) * FASTER * (1.0 + beta * (1.0 + forcing.frequency))
    box: tuple[float, ...] = ()
    for name, bounds, usual in (("angles", angles, reach), ("velocities", velocities, fastest)):
        allowed = "be (lowest, highest), the one below the other"
        ends = (-usual, usual) if bounds is None else pair(name, bounds, allowed)
        low, high = (value if bounds is None else within(name, value, -1e3, 1e3) for value in ends)
        if not low < high:
            raise ValueError(refusal(name, allowed, bounds))
        box = (*box, low, high)
    return box


def _starts(system: System, box: tuple[float, ...] | None, count: int, first: int) -> np.ndarray:
    """Evenly spread starts in the box, or where every periodic orbit without braces must lie."""
    index = np.arange(first, first + count)[:, None] + 0.5
    x, y = np.mod(index * np.array([1.0 / PLASTIC, 1.0 / PLASTIC**2]), 1.0).T
    if box is not None:
        return np.column_stack([box[0] + (box[1] - box[0]) * x, box[2] + (box[3] - box[2]) * y])
    forcing = system.forcing
    beta = response(system)
    in_phase = beta * math.cos(forcing.phase)
    quadrature = beta * forcing.frequency * math.sin(forcing.phase)
    # On either side u + u' and u - u' have each their bound, and u >= 0: a triangle, a parallelogram folded over.
    side = np.where(x < 0.5, 1.0, -1.0)
    x = np.where(x < 0.5, 2.0 * x, 2.0 * x - 1.0)
    over = x + y > 1.0
    x, y = np.where(over, 1.0 - x, x), np.where(over, 1.0 - y, y)
    stays, came = 1.0 + side * (in_phase - quadrature), 1.0 + side * (in_phase + quadrature)
    wide = np.maximum(stays + came, 0.0)
    plus, minus = stays - wide * x, came - wide * y
    return np.column_stack([0.5 * side * (plus + minus), 0.5 * side * (plus - minus)])
