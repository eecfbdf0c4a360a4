"""Continuation of periodic orbits in one parameter, and switching between branches, also at a grazing."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rocking.kernels.orbits import arclength
from rocking.kernels.orbits import continuation as kernel
from rocking.model.orbit import Orbit
from rocking.model.quantity import LEFT_QUANTITIES
from rocking.model.validation import Refusal, instance, one_of, refuse_if, whole
from rocking.motion.simulate import simulate
from rocking.orbits import resting_branch
from rocking.orbits.branch import BRANCHES_OFF, ENDS, Branch, branch_of
from rocking.orbits.event_chain import (
    IMPACT,
    NAMES,
    Chain,
    End,
    branch_table,
    chain_of,
    check_speeds,
    clocked,
    equations,
    null_direction,
    problem_of,
    solved,
)
from rocking.orbits.find_orbit import SAME, mirrored_half
from rocking.orbits.parameter import check_range, check_step, value_of
from rocking.orbits.return_map import branch_through
from rocking.orbits.special_points import BEGINS_BRANCH, GRAZING, SYMMETRY_BREAKING, SpecialPoint, chain_at

OFFS = (1e-4, 1e-3, 1e-5)
"""Distances of the first point from the grazing, in rad or units of the range, that are tried one after another."""
PERSISTS, MEETS = "the orbit persists", "two orbits meet, as at a fold"


class Beginning(NamedTuple):
    """Chain of the other branch, its solution at the grazing, and directions in which it may continue."""

    chain: Chain
    row: np.ndarray
    directions: tuple[np.ndarray, ...]


def beginning(special: SpecialPoint) -> Beginning | None:
    """Return the beginning of the other branch at a grazing; None if its events were not found."""
    touch, row = special._touch, special._row
    if touch is None or special._origin is None:
        return None
    chain, condition = touch
    if chain.counts() != special._origin.counts:
        chain = _least(chain._replace(phases=row[:-1]))
        return _both_ways(chain, special.name, np.append(chain.phases, row[-1]))
    # the grazing lies on an arc of this chain
    level, after = condition.level, condition.arc + 1
    count = 2 if level == IMPACT else 1
    phase = chain.phases[condition.arc] + chain.system.harmonic.frequency * condition.time
    kinds, row = np.insert(chain.kinds, after, [level] * count), np.insert(row, after, [phase] * count)
    chain = chain._replace(kinds=kinds, phases=row[:-1])
    if count == 1:
        return _both_ways(chain, special.name, row)
    # two impacts at one instant: the arc between them only has a length on one side
    direction = np.zeros(len(row))
    direction[after], direction[after + 1] = -1.0, 1.0
    return Beginning(chain, row, (direction,))


def _least(chain: Chain) -> Chain:
    """Return the chain of an orbit over its least period, or half of it if the other half is the mirror image."""
    for times in range(1 if chain.mirrored else chain.period, 1, -1):
        count = len(chain.kinds) // times
        whole = chain.period % times == 0 and len(chain.kinds) == count * times
        if whole and np.array_equal(chain.kinds, np.tile(chain.kinds[:count], times)):
            later = chain.phases[count:] - chain.phases[:-count]
            if np.abs(later - chain.turn / times).max() <= SAME:
                chain = chain._replace(
                    period=chain.period // times,
                    kinds=chain.kinds[:count].copy(),
                    phases=chain.phases[:count],
                )
                break
    return mirrored_half(chain) or chain


def _both_ways(chain: Chain, name: str, row: np.ndarray) -> Beginning:
    """Return the beginning of a branch that is smooth at the grazing."""
    tangent = np.linalg.svd(equations(chain, name, row)[0])[2][-1]
    return Beginning(chain, row, (tangent, -tangent))


def transition(special: SpecialPoint, value: float) -> str:
    """Return how the orbit changes at a grazing, if the other branch has a point at a value of the parameter."""
    if special._origin is None:
        return "unknown"
    same = (value - special.parameter) * special._origin.side > 0.0
    return MEETS if same else PERSISTS


MAX_SPECIAL = 1000
# Largest relative deviation of the parameter at the first point of a branch from its value for the given orbit.
SAME_VALUE = 1e-8
# Largest difference of phases and parameter for two special points to be identical.
SAME_POINT = 1e-6
# Distance of the first point of a new branch from its special point, in steps.
OFF = 0.1
# Maximum number of halvings of this distance.
MAX_HALVINGS = 20


def continue_orbit(
    orbit: Orbit, parameter: str, bounds: tuple[float, float], step: float = 0.01, max_points: int = 10_000
) -> Branch:
    """Follow a periodic orbit through a parameter in both directions, through folds, to the ends of its branch.

    The unknowns are the forcing phases of the orbit's events. The arcs in between are known in closed form, Yim & Lin (1991),
    Eq. (5), so that the equations are smooth and their derivatives exact. Every point is then checked by simulation for
    further events. Special points are accurate to rounding.

    For a full block the unknowns are the angle and the velocity at a forcing phase, and the equations those of the return map.
    Rest, and sustained contact with a brace, erase what was before. An orbit with them is followed by simulation from there. Its
    branch goes on through grazings, and ends where a rest or contact begins or ends.

    Parameters
    ----------
    orbit : Orbit
        Orbit from `find_orbit`, `find_orbits` or a verdict. It must have impacts or brace impacts.
    parameter : str
        "amplitude", "period", "frequency", "restitution", "brace_angle" or "brace_restitution"; for a full block also
        "critical_angle".
    bounds : (float, float)
        Lowest and highest value of the parameter; its value for `orbit` must lie in between.
    step : float
        Largest step, in units of the range (and of one radian of phase), in [1e-6, 0.1]. Default: 0.01.
    max_points : int
        Maximum number of points in each direction. Default: 10,000.

    Returns
    -------
    Branch
        Points in order from one end to the other, special points, and the reasons for the ends.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If the parameter is unknown, or belongs to braces that the system does not have. If the range is empty or does not
        contain the value for `orbit`. If the orbit grazes or is a branch point, unless it rests. If a slender block loses all
        speed at an impact without a rest, because the coefficient of restitution is 0.

    See Also
    --------
    switch_branch : Follow a branch that begins at a special point.
    bifurcation_curve : Follow a special point through two parameters.
    rocking.plot.branch : Plot branches.

    Notes
    -----
    Steps are shorter where the multipliers change fast. A special point then lies between neighbouring points with different
    signs of its test function. Limit: a multiplier that passes ±1 and returns within one step is not detected. A smaller
    `step` makes this less likely. The same holds for a gap, without the orbit, between two points of a branch of orbits that
    rest.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    >>> [(point.kind, round(point.parameter, 9)) for point in branch.special]
    [('symmetry-breaking', 23.185055482)]
    """
    instance("orbit", orbit, Orbit)
    if orbit._grazes:
        allowed = "not be that of a grazing, where its branch ends"
        raise Refusal("orbit", allowed, str(orbit), "use a neighbouring one: branch.orbit(index)")
    one_of("parameter", parameter, (*NAMES, "critical_angle", *LEFT_QUANTITIES))
    here = value_of(orbit.system, parameter)
    low, high = check_range(parameter, bounds)
    refuse_if(
        not low <= here <= high, parameter, f"lie in [{low:.6g}, {high:.6g}] to be followed there", here
    )
    step = check_step(step)
    most = whole("max_points", max_points, 2, 1_000_000)
    if orbit.superstable:
        return resting_branch.branch_through(orbit, parameter, (low, high), step, most)
    if not orbit.system.has_chains:
        return branch_through(orbit, parameter, (low, high), step, most)
    check_speeds(orbit)
    chain = chain_of(orbit)
    there = solved(chain, parameter, here, chain.phases)
    row = there.phases if there.found else np.append(chain.phases, here)
    problem = _problem(chain, parameter, (low, high), step)
    direction = _first_direction(problem, row, equations(chain, parameter, row)[0])
    if direction is None:
        allowed = "close after its period and lie on one branch alone"
        remedy = "use a neighbouring one, branch.orbit(index), or find it again with find_orbit"
        raise Refusal("orbit", allowed, str(orbit), remedy)
    halves = [_follow(problem, row, sense * direction, most) for sense in (-1.0, 1.0)]
    for half in halves:
        # an orbit at an end of the range may lie beyond it by rounding
        half.table.rows[0, -1] = min(max(half.table.rows[0, -1], low), high)
    return _joined(chain, parameter, *halves)


def switch_branch(
    special: SpecialPoint, bounds: tuple[float, float], step: float = 0.01, max_points: int = 10_000
) -> tuple[Branch, ...]:
    """Follow the branches that begin at a special point: a symmetry breaking, a period doubling or a grazing.

    At a symmetry breaking there are two, mirror images of each other, and at a period doubling one. At a grazing it is the branch
    of the orbit with one contact more or less; its period may be a divisor. The first entry of its `ends` says if the orbit
    persists, or if two orbits meet, as at a fold.

    Parameters
    ----------
    special : SpecialPoint
        Special point of kind "symmetry-breaking", "period-doubling" or "grazing".
    bounds, step, max_points
        As in `continue_orbit`; the value of the parameter at `special` must lie within `bounds`.

    Returns
    -------
    tuple of Branch
        Branches that begin at the special point. Empty at a grazing if the other orbit has no events, or was not found.

    Raises
    ------
    TypeError, ValueError
        As in `continue_orbit`; also if `special` is a fold, at which no branch begins, or of an orbit that rests.

    See Also
    --------
    continue_orbit : Follow an orbit through a parameter.
    grazing_transition : Determine what a motion does beyond a grazing.
    rocking.plot.branch : Plot branches.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    >>> born = rk.switch_branch(branch.special[0], (23, 24))
    >>> len(born), born[0].symmetric, round(float(born[0].points["parameter"][0]), 6)
    (2, False, 23.185055)
    """
    instance("special", special, SpecialPoint)
    if special.kind not in (*BEGINS_BRANCH, GRAZING):
        allowed = "be of kind symmetry-breaking, period-doubling or grazing to switch branches"
        raise Refusal("special", allowed, special.kind)
    chain_at(special)  # refuses a full block, and an orbit that rests
    low, high = check_range(special.name, bounds)
    refuse_if(
        not low <= special.parameter <= high,
        "bounds",
        f"contain the {special.name} of the special point",
        bounds,
    )
    step = check_step(step)
    most = whole("max_points", max_points, 2, 1_000_000)
    if special.kind == GRAZING:
        return _other_side(special, (low, high), step, most)
    chain, row = _twice(special)
    problem = _problem(chain, special.name, (low, high), step)
    direction = np.append(null_direction(chain, special.name, row), 0.0)
    senses = (1.0, -1.0) if special.kind == SYMMETRY_BREAKING else (1.0,)
    branches = []
    for sense in senses:
        half = _follow(problem, _beside(problem, row, sense * direction), sense * direction, most)
        branches.append(_branch_from_special(chain, special, row, half))
    return tuple(branches)


def _other_side(
    special: SpecialPoint, bounds: tuple[float, float], step: float, most: int
) -> tuple[Branch, ...]:
    """Return the other branch at a grazing, if there is one."""
    result = beginning(special)
    if result is None:
        return ()
    problem = _problem(result.chain, special.name, bounds, step)
    for off in OFFS:
        for direction in result.directions:
            start = result.row + off * direction
            if len(_follow(problem, start, direction, 1).table.rows):
                half = _follow(problem, start, direction, most)
                changes = transition(special, float(half.table.rows[0, -1]))
                ends = f"grazing: {changes}", ENDS[half.end]
                return (branch_of(result.chain, special.name, half.table, ends),)
    return ()


def _problem(chain: Chain, name: str, bounds: tuple[float, float], step: float) -> arclength.Problem:
    """Return the problem of following a chain through one parameter in a range, which is the unit of its steps."""
    low, high = bounds
    return problem_of(chain, [name], [bounds], step, [high - low])


def _first_direction(problem: arclength.Problem, row: np.ndarray, jacobian: np.ndarray) -> np.ndarray | None:
    """Return a direction across which Newton's method finds the first point of a branch near ``row``, or None.

    If possible, the parameter keeps its value. Near a special point, the phases are too sensitive to the parameter, and
    rounding prevents convergence. The tangent of the branch is then used.
    """
    alone = np.append(np.zeros(len(row) - 1), 1.0)
    along = np.linalg.svd(jacobian)[2][-1]
    for direction in (alone, along if along[-1] >= 0.0 else -along):
        first = _follow(problem, row, direction, 1).table.rows
        if len(first) and abs(first[0, -1] - row[-1]) <= SAME_VALUE * abs(row[-1]):
            return direction
    return None


def _beside(problem: arclength.Problem, row: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Return a first point of a branch that bifurcates at ``row``, so near that its multipliers are almost those at ``row``."""
    for halving in range(MAX_HALVINGS):
        off = row + OFF * problem.longest * 0.5**halving * direction
        facts = _follow(problem, off, direction, 1).table.facts
        # At the special point a multiplier is 1, so the angle is π/4.
        if len(facts):
            angle = np.arctan(facts["trace"][0] / (1.0 + facts["determinant"][0]))  # ``multiplier_angle``
            if abs(angle - 0.25 * np.pi) <= kernel.MAX_TURN:
                return off
    return row + OFF * problem.longest * direction


class _Half(NamedTuple):
    """Branch in one direction."""

    table: kernel.BranchTable
    end: End


def _follow(problem: arclength.Problem, y: np.ndarray, direction: np.ndarray, most: int) -> _Half:
    """Follow a branch in one direction from an orbit."""
    table = branch_table(len(y), most, MAX_SPECIAL)
    count, result, end = kernel.follow(problem, arclength.Tangent(y, direction), table)
    counts = count, count, result, result
    return _Half(kernel.BranchTable(*(part[:n].copy() for part, n in zip(table, counts, strict=True))), end)


def _joined(chain: Chain, parameter: str, back: _Half, on: _Half) -> Branch:
    """Join the two halves of a branch that begin at the same orbit; of a closed branch, the first half is complete."""
    if back.end == End.CLOSED:
        return branch_of(chain, parameter, _once(back.table), (ENDS[End.CLOSED], ENDS[End.CLOSED]))
    before = kernel.BranchTable(*(part[::-1] for part in back.table))
    first = len(before.rows) - 1
    before.changes["index"] = first + 1 - before.changes["index"]
    on.table.changes["index"] += first
    after = on.table._replace(rows=on.table.rows[1:], facts=on.table.facts[1:])
    joined = kernel.BranchTable(*(np.concatenate(parts) for parts in zip(before, after, strict=True)))
    return branch_of(chain, parameter, joined, (ENDS[back.end], ENDS[on.end]))


def _once(table: kernel.BranchTable) -> kernel.BranchTable:
    """Return a closed branch with every special point once, because its last step overlaps its first point."""
    specials, last = table.specials, len(table.rows) - 1
    met = [(np.abs(specials[:i] - specials[i]) <= SAME_POINT).all(axis=1).any() for i in range(len(specials))]
    kept = (table.changes["index"] < last) | ~np.array(met, bool)
    return table._replace(specials=specials[kept], changes=table.changes[kept])


def _branch_from_special(chain: Chain, special: SpecialPoint, row: np.ndarray, half: _Half) -> Branch:
    """Return the branch that begins at a special point."""
    _, links, trace, determinant = equations(chain, special.name, row)
    orbit = special.orbit
    peak = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=orbit.period, record="none").peak
    first = np.array([(trace, determinant, peak, links["leaves"][0])], kernel.FACTS)
    half.table.changes["index"] += 1
    joined = half.table._replace(
        rows=np.concatenate([row[None], half.table.rows]), facts=np.concatenate([first, half.table.facts])
    )
    return branch_of(chain, special.name, joined, (BRANCHES_OFF, ENDS[half.end]))


def _twice(special: SpecialPoint) -> tuple[Chain, np.ndarray]:
    """Return the chain of a special point traversed twice, with its phases.

    Half a symmetric orbit becomes the whole orbit; any other orbit becomes an orbit of twice the period.
    """
    chain, row = chain_at(special), special._row
    twice = chain._replace(
        period=chain.period if chain.mirrored else 2 * chain.period,
        mirrored=False,
        kinds=np.tile(chain.kinds, 2),
        phases=np.tile(chain.phases, 2),
    )
    return twice, np.concatenate([row[:-1], row[:-1] + chain.turn, row[-1:]])
