"""Neighbourhood from which all motions converge to a stable orbit, and the proof that one initial state reaches it.

In the norm |V^-1 (x - x*)| the derivative of the return map, over a box of states, is proved to be a contraction. So the map takes
the disc inside the box into itself, and all of it converges to the fixed point x* in it.
"""

from __future__ import annotations

import math
from contextlib import suppress
from itertools import islice
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from rocking.model.orbit import Orbit
from rocking.proof.arc import Balls, Refused, TooLong, above, below, largest, whole
from rocking.proof.periodic import Enclosed, check_equal
from rocking.proof.sets import States, as_set, doubles, renewed, sets_on_sections, states_on_sections, turn
from rocking.proof.trajectory import State

# Radii that are tried: the first one, the factor after a refusal, and the part of the radius at which the norm would be 1.
LARGEST, FACTOR, SHORT, TRIALS = 0.002, 0.3, 0.8, 22
# Radius of a box of states beyond which it is followed as a set.
WIDE = 2.0**-36
# Cycles after which a set gets a new basis: the derivatives over many cycles are less sharp.
RENEWED = 6
# Cycles after which the march to the neighbourhood is given up.
MAX_CYCLES = 1000


class Neighbourhood(NamedTuple):
    """Disc |inverse (x - middle)| < radius of states (Θ, Θ') on the section at a forcing phase."""

    phase: float
    middle: arb_mat
    inverse: arb_mat
    radius: arb
    reach: float  # radius of a circle inside the disc

    def contains(self, state: arb_mat) -> bool:
        """Return whether a state certainly lies in the disc."""
        place = self.inverse * (state - self.middle)
        return bool(place[0, 0] ** 2 + place[1, 0] ** 2 < self.radius**2)


def norm(matrix: arb_mat) -> arb:
    """Return the spectral norm of a 2 x 2 matrix."""
    square = matrix.transpose() * matrix
    half = square.trace() / 2
    return (half + (half * half - square.det()).nonnegative_part().sqrt()).sqrt()


def neighbourhood(orbit: Enclosed, result: Orbit) -> Neighbourhood:
    """Return a disc around a stable orbit, on its section, from which all motions converge to it."""
    p, phase, unit = orbit.p, arb(result.phase), arb_mat([[1, 0], [0, 1]])
    check_equal(p)
    here = orbit.state(phase, result.period)
    at = States(here.side, phase, arb_mat([[here.angle], [here.velocity]]), unit, (arb(0), arb(0)))
    tangent = after_cycles(p, at, result.period)
    matrix = doubles(tangent)
    scaled = matrix / (0.5 * (1.0 + max(abs(np.linalg.eigvals(matrix)))))
    # P = scaled' P scaled + 1 (Stein's equation), row by row
    gram = np.linalg.solve(np.eye(4) - np.kron(scaled.T, scaled.T), np.eye(2).ravel()).reshape(2, 2)
    shape = np.linalg.inv(np.linalg.cholesky(gram)).T
    axes = arb_mat([[arb(float(x)) for x in row] for row in shape / abs(shape).max()])
    inverse, radius = axes.inv(), LARGEST
    still = above(norm(inverse * tangent * axes))  # the norm at the orbit itself
    if not still < 1.0:
        raise Refused("the map is not proved to contract at the orbit")
    for _ in range(TRIALS):
        kept = math.inf
        with suppress(Refused):
            moved = after_cycles(p, at._replace(basis=axes, radii=(arb(radius), arb(radius))), result.period)
            kept = above(norm(inverse * moved))
        if kept < 1.0:
            middle = here.side * at.centre
            return Neighbourhood(result.phase, middle, inverse, arb(radius), below(radius / norm(inverse)))
        # The norm grows about linearly with the radius.
        radius *= SHORT * (1.0 - still) / (kept - still) if kept < math.inf else FACTOR
    raise Refused("no neighbourhood is proved to converge to the orbit")


def after_cycles(p: Balls, now: States, cycles: int) -> arb_mat:
    """Return the derivative of the states some cycles later, by r over the whole set."""
    end = now.phase + cycles * turn()
    for later in sets_on_sections(p, now, end):
        if isinstance(later, States) and later.phase.overlaps(end) and later.side == now.side:
            return later.basis
    raise Refused("the orbit rests, or has an event on its section")


def not_reached() -> TooLong:
    """Return the refusal of a motion that is followed too long."""
    return TooLong(f"the motion does not reach the neighbourhood within {MAX_CYCLES} cycles")


def advanced(p: Balls, now: States | State, goal: Neighbourhood, last: arb) -> States | State | None:
    """Return a motion some cycles later; None once it is proved to lie in the neighbourhood of an orbit."""
    if isinstance(now, State):
        begun = whole(((now.phase - goal.phase) / turn()).mid().floor())
        for state in states_on_sections(p, now, arb(goal.phase) + begun * turn(), last):
            there = as_set(state)
            if goal.contains(there.signed()):
                return None
            if largest(there.radii) > WIDE:
                return there
        raise not_reached()
    reached = now
    for later in islice(sets_on_sections(p, now, last), RENEWED):
        if isinstance(later, State):
            return later
        if goal.contains(later.signed()):
            return None
        reached = later
    if reached is now:
        raise not_reached()
    return renewed(reached)


def follow_to(p: Balls, state: State, goal: Neighbourhood) -> None:
    """Follow a motion until it is proved to lie in the neighbourhood of an orbit; raise Refused if it does not get there."""
    last = state.phase + MAX_CYCLES * turn()
    now: States | State | None = state
    while now is not None:
        if not now.phase < last:
            raise not_reached()
        now = advanced(p, now, goal, last)
