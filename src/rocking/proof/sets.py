"""Sets of states followed from section to section; a section is a forcing phase, once in each cycle.

A set is c + B r. By the mean value theorem its image lies in P(c) + P'(set) B r. So the set follows the contraction of the motion
(Lohner 1987), and 128 bits suffice for many cycles. A box of states alone takes half the time, but it grows.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from rocking.proof.arc import Balls, Refused, largest
from rocking.proof.chain import law
from rocking.proof.trajectory import (
    State,
    after_event,
    flight,
    flight_within,
    half_turns_to_release,
    propagator,
    release,
    rests,
    saltation,
)

# Radius of a set of states beyond which its motion is given up.
BROADEST = 1.0


class States(NamedTuple):
    """Set of states on a section: centre + basis r for all |r_i| <= radii_i, in (u, u') on one side."""

    side: int
    phase: arb
    centre: arb_mat  # exact, or as the orbit is enclosed
    basis: arb_mat
    radii: tuple[arb, arb]

    def box(self) -> State:
        """Return a box that contains the set."""
        rows = ((self.basis[i, 0], self.basis[i, 1]) for i in range(2))
        spread = [arb(0, 1) * spread_of(row, self.radii) for row in rows]
        angle, velocity = (self.centre[i, 0] + spread[i] for i in range(2))
        return State(self.side, self.phase, angle, velocity, 0, False)

    def point(self) -> State:
        """Return the centre."""
        return State(self.side, self.phase, self.centre[0, 0], self.centre[1, 0], 0, False)

    def signed(self) -> arb_mat:
        """Return a box of (Θ, Θ') that contains the set."""
        box = self.box()
        return arb_mat([[self.side * box.angle], [self.side * box.velocity]])


def spread_of(row: Sequence[arb], radii: tuple[arb, arb]) -> arb:
    """Return a bound of the scalar product of a row and r for all |r_i| <= radii_i."""
    return (abs(row[0]) * radii[0] + abs(row[1]) * radii[1]).abs_upper()


def as_set(state: State) -> States:
    """Return the set of a box of states on a section."""
    centre = arb_mat([[state.angle.mid()], [state.velocity.mid()]])
    radii = state.angle.rad(), state.velocity.rad()
    return States(state.side, state.phase, centre, arb_mat([[1, 0], [0, 1]]), radii)


def states_on_sections(p: Balls, state: State, end: arb, last: arb) -> Iterator[State]:
    """Yield the states of a motion on the sections: at a forcing phase and at each cycle later, unless the block rests there.

    A section that may come at the time of an event is left out.
    """
    while state.phase < last:
        if rests(p, state) is not None:
            state = release(p, half_turns_to_release(p, state.phase))
        end = section_after(end, state.phase)
        flown = flight(p, state)
        after = after_event(p, state, flown)
        while end < after.phase:
            here = flown.arc.at((end - state.phase) / p.frequency)
            yield State(state.side, end, here.value, here.first, 0, False)
            end += turn()
        state = after


def sets_on_sections(p: Balls, now: States, last: arb) -> Iterator[States | State]:
    """Yield the sets of states on the sections after that of a set; when the block comes to rest, its state, and no more.

    Every event is shown over a box of states. The box is then narrowed by the mean value theorem. Phase, speed and time of flight
    differ from those of the centre by the derivatives times r. So the box does not grow from event to event.
    """
    state, box, moved, late, end = now.point(), now.box(), now.basis, (arb(0), arb(0)), now.phase
    while state.phase < last:
        if rests(p, box) is not None:
            yield box
            return
        end = section_after(end, box.phase)
        wide = flight(p, box)
        flown = flight_within(p, state, wide)
        after, over = after_event(p, state, flown), after_event(p, box, wide)
        while end < over.phase:
            here = flown.arc.at((end - state.phase) / p.frequency)
            basis = propagator((end - box.phase) / p.frequency) * moved
            yield States(state.side, end, arb_mat([[here.value], [here.first]]), basis, now.radii)
            end += turn()
        kept, before = law(p, flown.event), propagator(wide.time) * moved
        arrival, bend = -over.velocity / kept, over.angle - 1 - box.side * p.amplitude * over.phase.cos()
        later = -before[0, 0] / arrival, -before[0, 1] / arrival  # the time of the event, by r
        faster = [-kept * (before[1, j] + bend * later[j]) for j in range(2)]  # the velocity after it
        longer = [new - old for new, old in zip(later, late, strict=True)]
        time, phase, velocity = (arb(0, 1) * spread_of(row, now.radii) for row in (longer, later, faster))
        over = over._replace(
            phase=over.phase.intersection(after.phase + p.frequency * phase),
            velocity=over.velocity.intersection(after.velocity + velocity),
        )
        time = wide.time.intersection(flown.time + time)
        moved, late = saltation(p, flown.event, box.side, over) * propagator(time) * moved, later
        state, box = after, over


def turn() -> arb:
    """Return 2 pi at the present precision."""
    return 2 * arb.pi()


def section_after(end: arb, phase: arb) -> arb:
    """Return the first section from ``end`` on that certainly comes after a phase."""
    while not end > phase:
        end += turn()
    return end


def renewed(now: States) -> States:
    """Return a set that contains another one, with an exact centre and a rotation for its basis."""
    basis = along(now.basis, now.radii)
    back = basis.inv()
    rounded, turned = (now.centre[0, 0].rad(), now.centre[1, 0].rad()), back * now.basis
    radii = [
        (
            spread_of((turned[i, 0], turned[i, 1]), now.radii) + spread_of((back[i, 0], back[i, 1]), rounded)
        ).upper()
        for i in range(2)
    ]
    if not largest(radii) < BROADEST:
        raise Refused("the set of states that may be reached grows too large")
    centre = arb_mat([[now.centre[i, 0].mid()] for i in range(2)])
    return States(now.side, now.phase, centre, basis, (radii[0], radii[1]))


def along(moved: arb_mat, radii: tuple[arb, arb]) -> arb_mat:
    """Return a rotation whose first column lies along the longer axis of a set."""
    axes = doubles(moved) * [float(radius) for radius in radii]
    x, y = max(axes.T, key=lambda axis: np.hypot(*axis))
    length = np.hypot(x, y)
    cosine, sine = arb(float(x / length)), arb(float(y / length))
    return arb_mat([[cosine, -sine], [sine, cosine]])


def doubles(matrix: arb_mat) -> np.ndarray:
    """Return the middles of a 2 x 2 matrix."""
    return np.array([[float(matrix[i, j]) for j in range(2)] for i in range(2)])
