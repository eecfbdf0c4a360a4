"""Following a periodic orbit through a parameter, and from branch to branch."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rocking.kernels.orbits import arclength
from rocking.kernels.orbits import branch_point as codes
from rocking.kernels.orbits import continuation as kernel
from rocking.model import Orbit, instance, one_of, refusal, whole, within
from rocking.motion import simulate
from rocking.orbits.branch import Branch, SpecialPoint, table
from rocking.orbits.event_chain import (
    NAMES,
    Chain,
    chain_of,
    clocked,
    equations,
    null_direction,
    orbit_of,
    parameters,
    solved,
)
from rocking.orbits.grazing import grazing_at
from rocking.orbits.parameter import checked_range, value_of

KINDS = {
    codes.FOLD: "fold",
    codes.SYMMETRY_BREAKING: "symmetry-breaking",
    codes.PERIOD_DOUBLING: "period-doubling",
    codes.GRAZING: "grazing",
}
MAX_SPECIAL = 1000
BORN = -1
ENDS = {
    BORN: "born at a special point",
    codes.RANGE: "end of the range",
    codes.GRAZED: "grazing",
    codes.MERGED: "merges with the branch it was born from",
    codes.CLOSED: "closed loop",
    codes.MANY: "as many points as allowed",
    codes.LOST: "lost: no further point was found, however near",
}
# How far from a special point the first point of another branch lies, in steps.
OFF = 0.1
# How often that distance is halved at most.
MAX_HALVINGS = 20


def continue_orbit(
    orbit: Orbit,
    parameter: str,
    bounds: tuple[float, float],
    step: float = 0.01,
    max_points: int = 10_000,
) -> Branch:
    """Follow a periodic orbit through a parameter, both ways, through folds, to the ends of its branch.

    The unknowns are the forcing phases of the orbit's events; between them every arc is known in closed form, eq. (5), so
    that the equations are smooth and their derivatives exact. Every point is then marched to see that it meets nothing
    else on its way. Special points are located to rounding.

    Parameters
    ----------
    orbit : Orbit
        From `find_orbit`, `find_orbits` or a verdict; one with impacts or brace hits that does not rest or lean.
    parameter : str
        "amplitude", "period", "frequency", "restitution", "brace_angle" or "brace_restitution".
    bounds : (float, float)
        Lowest and highest value; the orbit's own must lie between them.
    step : float
        Largest step, in units of the range (and of a radian of phase).
    max_points : int
        Points either way, at most.

    Returns
    -------
    Branch
        Its points in order, from one end to the other, its special points, and why it ends.

    Raises
    ------
    TypeError, ValueError
        In one line: for an unknown parameter, an empty range, a range without the orbit's own value, a parameter of braces
        of a system without, an orbit that rests or leans.

    Notes
    -----
    Steps are shorter where the multipliers change fast, so that a special point lies between neighbouring points with different
    signs of its test. Not guaranteed: that a multiplier is seen which passes ±1 and comes back within a single step; make the step
    smaller.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    >>> [(point.kind, round(point.parameter, 9)) for point in branch.special]
    [('symmetry-breaking', 23.185055482)]
    """
    instance("orbit", orbit, Orbit)
    one_of("parameter", parameter, tuple(NAMES))
    here = value_of(orbit.system, parameter)
    low, high = checked_range(parameter, bounds)
    if not low <= here <= high:
        raise ValueError(refusal(parameter, f"lie in [{low:.6g}, {high:.6g}] to be followed there", here))
    step = within("step", step, 1e-6, 0.1)
    most = whole("max_points", max_points, 2, 1_000_000)
    chain = chain_of(orbit)
    there = solved(chain, parameter, here, chain.phases)
    if not there.found:
        raise ValueError("orbit must be a motion of its own system; got one whose events do not close")
    halves = [
        _follow(chain, parameter, there.phases, _upward(len(chain.kinds), sense), (low, high), step, most)
        for sense in (-1.0, 1.0)
    ]
    return _joined(chain, parameter, *halves)


def switch_branch(
    special: SpecialPoint, bounds: tuple[float, float], step: float = 0.01, max_points: int = 10_000
) -> tuple[Branch, ...]:
    """Follow what is born at a symmetry breaking (two branches, mirror images of each other) or at a period doubling (one).

    Parameters
    ----------
    special : SpecialPoint
        Of kind "symmetry-breaking" or "period-doubling".
    bounds, step, max_points
        As in `continue_orbit`.

    Returns
    -------
    tuple of Branch
        Each begins at the special point.

    Raises
    ------
    TypeError, ValueError
        In one line, as `continue_orbit`, and at a fold or a grazing, where there is nothing to switch to.
    """
    instance("special", special, SpecialPoint)
    if special.kind not in ("symmetry-breaking", "period-doubling"):
        allowed = "be of kind symmetry-breaking or period-doubling to switch branches"
        raise ValueError(refusal("special", allowed, special.kind))
    low, high = checked_range(special.name, bounds)
    if not low <= special.parameter <= high:
        raise ValueError(refusal("bounds", f"hold the special point's own {special.name}", bounds))
    step = within("step", step, 1e-6, 0.1)
    most = whole("max_points", max_points, 2, 1_000_000)
    chain, row = _twice(special)
    direction = np.append(null_direction(chain, special.name, row), 0.0)
    senses = (1.0, -1.0) if special.kind == "symmetry-breaking" else (1.0,)
    branches = []
    for sense in senses:
        off = _beside(chain, special.name, row, sense * direction, (low, high), step)
        half = _follow(chain, special.name, off, sense * direction, (low, high), step, most)
        branches.append(_branch_from_special(chain, special, row, half))
    return tuple(branches)


def _beside(
    chain: Chain,
    parameter: str,
    row: np.ndarray,
    direction: np.ndarray,
    bounds: tuple[float, float],
    step: float,
) -> np.ndarray:
    """A first point of a branch born at ``row``, so near that its multipliers are still almost those there."""
    for halving in range(MAX_HALVINGS):
        off = row + OFF * step * 0.5**halving * direction
        first = _follow(chain, parameter, off, direction, bounds, step, 1)
        # at the special point a multiplier is 1: the angle is π/4
        if len(first.facts):
            angle = codes.multiplier_angle.py_func(*first.facts[0, :2])
            if abs(angle - 0.25 * np.pi) <= codes.CALM:
                return off
    return row + OFF * step * direction


class _Half(NamedTuple):
    """A branch one way: what the kernel wrote."""

    rows: np.ndarray
    facts: np.ndarray
    specials: np.ndarray
    changes: np.ndarray
    end: int


def _upward(k: int, sense: float) -> np.ndarray:
    """The direction in which the parameter alone changes."""
    direction = np.zeros(k + 1)
    direction[k] = sense
    return direction


def _follow(
    chain: Chain,
    parameter: str,
    y: np.ndarray,
    direction: np.ndarray,
    bounds: tuple[float, float],
    step: float,
    most: int,
) -> _Half:
    """Follow a branch one way from an orbit."""
    k = len(chain.kinds)
    out, facts = np.empty((most, k + 1)), np.empty((most, 4))
    specials, changes = np.empty((MAX_SPECIAL, k + 1)), np.empty((MAX_SPECIAL, 2), np.int64)
    count, found, end = kernel.follow(
        parameters(chain.system),
        NAMES[parameter],
        *chain.fixed,
        chain.mirrored,
        y.copy(),
        direction.copy(),
        bounds,
        step,
        out,
        facts,
        specials,
        changes,
        arclength.make_newton_workspace(k, bounds[1] - bounds[0]),
    )
    return _Half(out[:count].copy(), facts[:count].copy(), specials[:found], changes[:found], end)


def _joined(chain: Chain, parameter: str, back: _Half, on: _Half) -> Branch:
    """One branch of two halves that begin at the same orbit; of a closed one the first half is the whole."""
    if back.end == codes.CLOSED:
        on = _Half(back.rows[-1:], back.facts[-1:], back.specials[:0], back.changes[:0], codes.CLOSED)
        back = _Half(back.rows[::-1], back.facts[::-1], back.specials[::-1], back.changes[::-1], codes.CLOSED)
    first = len(back.rows) - 1
    rows = np.concatenate([back.rows[::-1], on.rows[1:]])
    facts = np.concatenate([back.facts[::-1], on.facts[1:]])
    specials = np.concatenate([back.specials[::-1], on.specials])
    changes = np.concatenate([back.changes[::-1], on.changes])
    indices = np.concatenate([first + 1 - back.changes[::-1, 1], first + on.changes[:, 1]])
    return _branch(chain, parameter, rows, facts, (specials, changes[:, 0], indices), (back.end, on.end))


def _branch_from_special(chain: Chain, special: SpecialPoint, row: np.ndarray, half: _Half) -> Branch:
    """A branch that begins at a special point."""
    _, links, trace, determinant = equations(chain, special.name, row)
    orbit = special.orbit
    peak = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=orbit.period, record="none").peak
    rows = np.concatenate([row[None], half.rows])
    facts = np.concatenate([[[trace, determinant, peak, links[0, 0]]], half.facts])
    found = half.specials, half.changes[:, 0], half.changes[:, 1] + 1
    return _branch(chain, special.name, rows, facts, found, (BORN, half.end))


def _branch(
    chain: Chain,
    parameter: str,
    rows: np.ndarray,
    facts: np.ndarray,
    found: tuple[np.ndarray, np.ndarray, np.ndarray],
    ends: tuple[int, int],
) -> Branch:
    """The value that users get."""
    impacts, brace_hits = chain.counts()
    special = tuple(
        _special(chain, parameter, row, int(kind), int(index))
        for row, kind, index in zip(*found, strict=True)
    )
    return Branch(
        name=parameter,
        period=chain.period,
        symmetric=chain.mirrored,
        impacts=impacts,
        brace_hits=brace_hits,
        points=table(rows, facts, chain.mirrored),
        special=special,
        ends=(ENDS[ends[0]], ENDS[ends[1]]),
        chain=chain,
        rows=rows,
        facts=facts,
    )


def _special(chain: Chain, parameter: str, row: np.ndarray, kind: int, index: int) -> SpecialPoint:
    """A special point with its orbit."""
    touch = None
    if kind == codes.GRAZING:
        orbit, chain, row, touch = grazing_at(chain, parameter, row)
    else:
        *_, trace, determinant = equations(chain, parameter, row)
        orbit = orbit_of(chain, parameter, row, trace, determinant)
    return SpecialPoint(
        kind=KINDS[kind],
        parameter=float(row[-1]),
        orbit=orbit,
        name=parameter,
        index=index,
        chain=chain,
        row=row.copy(),
        touch=touch,
    )


def _twice(special: SpecialPoint) -> tuple[Chain, np.ndarray]:
    """The chain of a special point gone round twice, and its phases: half an orbit becomes a whole one, a whole one its double."""
    chain, row = special._chain, special._row
    twice = chain._replace(
        period=chain.period if chain.mirrored else 2 * chain.period,
        mirrored=False,
        kinds=np.tile(chain.kinds, 2),
        phases=np.tile(chain.phases, 2),
    )
    return twice, np.concatenate([row[:-1], row[:-1] + chain.turn, row[-1:]])
