"""Neighbourhood from which all motions converge to a stable orbit, and the proof that one initial state reaches it.

In the norm |V^-1 (x - x*)| the derivative of the return map, over a box of states, is proved to be a contraction. So the map takes
the disc inside the box into itself, and all of it converges to the fixed point x* in it.

A motion is followed from section to section as a set c + B r of states. By the mean value theorem the image lies in
P(c) + P'(box) B r. So the set follows the contraction of the motion (Lohner 1987), and 128 bits suffice for many cycles.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat
from scipy.linalg import solve_discrete_lyapunov

from rocking.model import Orbit
from rocking.model import State as InitialState
from rocking.proof.balls import Balls, Refused, TooLong, below, largest, whole
from rocking.proof.periodic import Enclosed
from rocking.proof.trajectory import (
    State,
    after_event,
    flight,
    half_turns_to_release,
    jump,
    propagator,
    release,
    rests,
)

# Radii that are tried, from the first one down by a factor.
LARGEST, FACTOR, TRIALS = 0.01, 0.2, 22
# Radius of a box of states beyond which the set of states is followed: a box alone takes half the time, but grows.
WIDE = 2.0**-36
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


class States(NamedTuple):
    """Set of states on a section: centre + basis r for all |r_i| <= radii_i, in (u, u') on one side."""

    side: int
    phase: arb
    centre: arb_mat  # exact
    basis: arb_mat
    radii: tuple[arb, arb]

    def box(self) -> State:
        """Return a box that contains the set."""
        spread = spread_of(self.basis, self.radii)
        angle, velocity = (self.centre[i, 0] + arb(0, 1) * spread[i] for i in range(2))
        return State(self.side, self.phase, angle, velocity, 0, False)

    def point(self) -> State:
        """Return the centre."""
        return State(self.side, self.phase, self.centre[0, 0], self.centre[1, 0], 0, False)

    def signed(self) -> arb_mat:
        """Return a box of (Θ, Θ') that contains the set."""
        box = self.box()
        return arb_mat([[self.side * box.angle], [self.side * box.velocity]])


def spread_of(matrix: arb_mat, radii: tuple[arb, arb]) -> list[arb]:
    """Return bounds of the components of matrix r for all |r_i| <= radii_i."""
    return [sum((abs(matrix[i, j]) * radii[j] for j in range(2)), arb(0)).abs_upper() for i in range(2)]


def norm(matrix: arb_mat) -> arb:
    """Return the spectral norm of a 2 x 2 matrix."""
    square = matrix.transpose() * matrix
    half = square.trace() / 2
    return (half + (half * half - square.det()).nonnegative_part().sqrt()).sqrt()


def followed(p: Balls, state: State, end: arb) -> tuple[State, arb_mat | None]:
    """Return state and tangent at a forcing phase; the tangent is None if the block rests in between.

    If it still rests at the end, the state is that of its next release.
    """
    tangent: arb_mat | None = arb_mat([[1, 0], [0, 1]])
    while True:
        if rests(p, state) is not None:
            state, tangent = release(p, half_turns_to_release(p, state.phase)), None
        if not state.phase < end:
            return state, None
        flown = flight(p, state, (end - state.phase) / p.frequency)
        if flown.event is None:
            here = flown.arc.at(flown.time)
            there = State(state.side, end, here.value, here.first, 0, False)
            return there, None if tangent is None else propagator(flown.time) * tangent
        after = after_event(p, state, flown)
        if tangent is not None:
            tangent = jump(p, state, flown, after) * tangent
        state = after


def neighbourhood(orbit: Enclosed, found: Orbit) -> Neighbourhood:
    """Return a disc around a stable orbit, on its section, from which all motions converge to it."""
    p, phase = orbit.p, arb(found.phase)
    here, end = orbit.state(phase, found.period), phase + 2 * found.period * arb.pi()
    _, tangent = followed(p, here, end)
    if tangent is None:
        raise Refused("the orbit rests")
    matrix = doubles(tangent)
    scaled = matrix / (0.5 * (1.0 + max(abs(np.linalg.eigvals(matrix)))))
    shape = np.linalg.inv(np.linalg.cholesky(solve_discrete_lyapunov(scaled.T, np.eye(2)))).T
    axes = arb_mat([[arb(float(x)) for x in row] for row in shape / abs(shape).max()])
    inverse, radius = axes.inv(), LARGEST
    for _ in range(TRIALS):
        spread = spread_of(axes, (arb(radius), arb(radius)))
        box = here._replace(
            angle=here.angle + arb(0, 1) * spread[0], velocity=here.velocity + arb(0, 1) * spread[1]
        )
        try:
            _, tangent = followed(p, box, end)
        except Refused:
            tangent = None
        if tangent is not None and norm(inverse * tangent * axes) < 1:
            middle = arb_mat([[here.side * here.angle], [here.side * here.velocity]])
            return Neighbourhood(found.phase, middle, inverse, arb(radius), below(radius / norm(inverse)))
        radius *= FACTOR
    raise Refused("no neighbourhood is proved to converge to the orbit")


def doubles(matrix: arb_mat) -> np.ndarray:
    """Return the middles of a 2 x 2 matrix."""
    return np.array([[float(matrix[i, j].mid()) for j in range(2)] for i in range(2)])


def initial(p: Balls, phase: float, start: InitialState) -> State:
    """Return the state of a motion at its start: in flight, pushed away from the base, or at its next release from rest."""
    here, angle, velocity = arb(phase), start.angle, start.velocity
    if angle != 0.0 or velocity != 0.0:
        side = 1 if (angle if angle != 0.0 else velocity) > 0 else -1
        return State(side, here, arb(abs(angle)), arb(side * velocity), int(angle == 0.0), False)
    push = p.amplitude * here.cos()
    if abs(push) > 1:
        return State(-1 if push > 0 else 1, here, arb(0), arb(0), 2, False)
    if abs(push) < 1:
        return release(p, half_turns_to_release(p, here))
    raise Refused("whether the block lifts off at once is not decided")


def next_set(p: Balls, now: States, end: arb) -> States | State:
    """Return the set on the next section; a single state if the block rests in between."""
    after, tangent = followed(p, now.box(), end)
    if tangent is None:
        return after
    point, _ = followed(p, now.point(), end)
    moved = tangent * now.basis
    basis = arb_mat([[arb(float(x)) for x in row] for row in np.linalg.qr(doubles(moved))[0]])
    back = basis.inv()
    centre = arb_mat([[point.angle.mid()], [point.velocity.mid()]])
    rounded = (arb(0, 1) * point.angle.rad()).abs_upper(), (arb(0, 1) * point.velocity.rad()).abs_upper()
    stretched, added = spread_of(back * moved, now.radii), spread_of(back, rounded)
    radii = (stretched[0] + added[0]).abs_upper(), (stretched[1] + added[1]).abs_upper()
    return States(after.side, end, centre, basis, radii)


def as_set(state: State) -> States:
    """Return the set of a box of states on a section."""
    centre = arb_mat([[state.angle.mid()], [state.velocity.mid()]])
    radii = (arb(0, 1) * state.angle.rad()).abs_upper(), (arb(0, 1) * state.velocity.rad()).abs_upper()
    return States(state.side, state.phase, centre, arb_mat([[1, 0], [0, 1]]), radii)


def follow_to(p: Balls, state: State, goal: Neighbourhood) -> None:
    """Follow a motion until it is proved to lie in the neighbourhood of an orbit; raise Refused if it does not get there."""
    turn = 2 * arb.pi()
    first = whole(((state.phase - goal.phase) / turn).mid().floor())
    now: State | States = state
    for cycle in range(1, MAX_CYCLES):
        end = arb(goal.phase) + (first + cycle) * turn
        if isinstance(now, States):
            now = next_set(p, now, end)
        elif now.phase < end:
            now, _ = followed(p, now, end)
        if isinstance(now, State) and now.order:
            continue  # it rests on this section
        there = as_set(now) if isinstance(now, State) else now
        if goal.contains(there.signed()):
            return
        if largest(there.radii) > WIDE:
            now = there
    raise TooLong(f"the motion does not reach the neighbourhood within {MAX_CYCLES} cycles")
