"""Continuation of periodic orbits that rest, or stay in contact with a brace, in one parameter.

Rest erases what was before. So the orbit is the motion from one of its rests, if the block rests again there after the period.
Both multipliers are zero. The same holds for sustained contact with a brace. Neither equations nor Newton's method are needed.
So the method serves the full block, too.

Between special points the motion is a smooth function of the parameter. At a grazing, an arc just touches the base or a brace,
and the branch goes on. It ends where a rest begins or ends. With e > 0 the number of impacts is finite beyond, and changes ever
faster towards the end. Both are found by bisection.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from attrs import evolve, frozen

from rocking.model.orbit import Orbit
from rocking.model.system import State
from rocking.model.validation import Refusal
from rocking.model.verdict import Kind
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.orbits.branch import ENDS, Branch
from rocking.orbits.event_chain import End, clocked
from rocking.orbits.find_orbit import SAME
from rocking.orbits.follow import Passage, Problem, follow, joined
from rocking.orbits.parameter import value_of, with_value
from rocking.orbits.special_points import GRAZING
from rocking.response.classify import classify

NARROW = 1e-13
"""Width of a bracket of a special point at which the bisection ends, relative to the range."""
SYMMETRIC = 1e-6
"""Largest difference of the two halves of a symmetric orbit: near a grazing it is the root of a rounding error."""
JUMP, LOW = 0.05, 0.1
"""Change from one point to the next that is not small: of the phases, rad, and of the peak relative to itself or to LOW."""
SLIGHT = 1e-4
"""Speed of an impact that counts as grazing, and duration of a rest, in rad, that counts as vanishing, at a special point."""
BEFORE = 0.2
"""Longest wait, in rad, from the start of a motion to the end of its rest."""
SAMPLES = 32
"""Number of instants at which the two halves of a period are compared."""
SHRUNK = "a rest or contact begins or ends"
CYCLES = 2_000
"""Longest motion, in forcing cycles, by which the response beyond an end is judged."""
BEGINS, RELEASES = ("rest", "lean"), ("lift-off", "leave")
HITS = ("impact", "brace")


class RestingMotion(NamedTuple):
    """Motion from the end of a rest, or of contact with a brace, over a period, at one value of the parameter."""

    value: float
    release: float  # forcing phase at which the rest ends
    closes: bool
    symmetric: bool
    resets: tuple[str, ...]  # kinds of the events at which rests and contacts begin and end
    marks: np.ndarray  # their forcing phases
    shortest: float  # duration of the shortest rest or contact, in rad
    turns: int  # number of impacts that are slower than the next one
    slowest: float  # speed of the slowest of them; infinity if there is none
    first: tuple[float, float]  # phase and speed of the first impact
    peak: float
    angle: float  # 0, or the angle of the brace on its side
    trace: float = 0.0  # rest erases what was before
    determinant: float = 0.0

    @property
    def state(self) -> State:
        """State in the middle of the last rest."""
        return State(self.angle)

    @property
    def phase(self) -> float:
        """Forcing phase in the middle of the last rest."""
        return float(0.5 * (self.marks[-2] + self.marks[-1])) % math.tau

    def continues(self, other: RestingMotion) -> bool:
        """Return whether both motions close, with the same order of events, and nearly agree."""
        same = (self.resets, self.turns, self.symmetric) == (other.resets, other.turns, other.symmetric)
        if not (self.closes and other.closes and same):
            return False
        moved = float(np.abs(self.marks - other.marks).max())
        return moved < JUMP and abs(self.peak - other.peak) <= JUMP * max(self.peak, other.peak, LOW)


@frozen
class RestingMap(Problem[RestingMotion]):
    """Motions over a period from rest, or from contact with a brace, for one parameter."""

    side: int  # 0 at the base, else the side of the brace
    before: float  # wait from the start to the end of the rest, in rad
    sense: float = 1.0  # 1 or -1: towards the highest or the lowest value

    SHORTEST = 5e-4
    GROWTH = 2.0

    def value(self, point: RestingMotion) -> float:
        """Return the value of the parameter at a point."""
        return point.value

    def at(self, value: float, release: float) -> RestingMotion:
        """Return the motion whose rest ends near a forcing phase."""
        system, begun = with_value(self.system, self.name, value), release - self.before
        angle = self.side * system.braces.angle if self.side and system.braces else 0.0
        motion = simulate(clocked(system, begun % math.tau), State(angle), cycles=self.period + 1)
        return held(motion, value, begun, angle, math.tau * self.period)

    def corrected(self, here: RestingMotion, length: float) -> RestingMotion | End:
        """Return the next point, if it and the one half-way continue the branch."""
        if here.value == (self.low if self.sense < 0.0 else self.high):
            return End.RANGE
        there = self.next(here, length)
        continues = here.continues(there) and here.continues(
            self.at(0.5 * (here.value + there.value), here.release)
        )
        return there if continues else End.LOST

    def next(self, here: RestingMotion, length: float) -> RestingMotion:
        """Return the motion one step from a point, within the range."""
        return self.at(min(max(here.value + self.sense * length, self.low), self.high), here.release)

    def obstacle(self, here: RestingMotion, length: float, reason: End) -> Passage[RestingMotion]:
        """Return what follows a point from which the smallest step fails: a grazing, or the end of the branch."""
        if reason == End.RANGE:
            return Passage([], end=ENDS[reason])
        there = self.next(here, length)
        if here.continues(there):  # with the smallest step the order of events may change half-way
            return Passage([there])
        last, there = self.bracket(here, there)
        before = [last] if last.value != here.value else []
        kind = _kind(last, there)
        if kind == SHRUNK or not there.closes or there.symmetric != last.symmetric:
            return Passage(before, end=self.ending(kind, there))
        return Passage([*before, there], [] if kind is None else [(kind, last, len(before))])

    def bracket(self, here: RestingMotion, there: RestingMotion) -> tuple[RestingMotion, RestingMotion]:
        """Return the last point that continues a branch, and the first one that does not, by bisection."""
        while abs(there.value - here.value) > NARROW * (self.high - self.low):
            middle = self.at(0.5 * (here.value + there.value), here.release)
            if middle.value in (here.value, there.value):
                break
            if here.continues(middle):
                here = middle
            else:
                there = middle
        return here, self.at(there.value, here.release)  # from the nearest end of the rest

    def ending(self, kind: str | None, there: RestingMotion) -> str:
        """Return the reason for an end, with the response just beyond it."""
        system = clocked(
            with_value(self.system, self.name, there.value), (there.release - self.before) % math.tau
        )
        beyond = classify(system, State(there.angle), max_cycles=CYCLES)
        if beyond.kind is Kind.REST:
            return "the block no longer lifts off"
        return f"{kind or 'the order of events changes'}; beyond: {beyond.orbit or beyond.kind}"

    def at_value(
        self, here: RestingMotion, there: RestingMotion, share: float, value: float
    ) -> RestingMotion | None:
        """Return the motion at a value of the parameter near a point, if it closes."""
        result = self.at(value, here.release)
        return result if result.closes else None


def held(motion: Motion, value: float, begun: float, angle: float, whole: float) -> RestingMotion:
    """Return the data of a motion from rest that starts at a forcing phase, for a period of ``whole`` rad from its first event."""
    phases, kinds = begun + motion.system.periodic.frequency * motion.events["time"], motion.events["kind"]
    release = float(phases[0]) if len(phases) else begun
    taken = (phases > release) & (phases <= release + whole + SAME)
    events, phases, kinds = motion.events[taken], phases[taken], kinds[taken]
    resets = np.isin(kinds, (*BEGINS, *RELEASES))
    marks, names = phases[resets], tuple(kinds[resets].tolist())
    closes = len(names) > 1 and names[-1] in RELEASES and abs(marks[-1] - release - whole) < SAME
    closes = closes and bool(abs(events["angle"][-1] - angle) < SAME)
    speeds, hits = np.abs(events["after"]), np.flatnonzero(np.isin(kinds, HITS))
    slower = hits[:-1][(np.diff(speeds[hits]) > 0.0) & (np.diff(np.cumsum(resets)[hits]) == 0)]
    return RestingMotion(
        value=value,
        release=release,
        closes=closes,
        symmetric=closes and _is_symmetric(motion, release - begun, whole),
        resets=names,
        marks=marks,
        shortest=float((marks[1::2] - marks[0::2]).min()) if closes else math.inf,
        turns=len(slower),
        slowest=float(speeds[slower].min()) if len(slower) else math.inf,
        first=(float(phases[hits[0]]) % math.tau, float(speeds[hits[0]])) if len(hits) else (math.nan, 0.0),
        peak=motion.peak,
        angle=angle,
    )


def _is_symmetric(motion: Motion, begun: float, whole: float) -> bool:
    """Return whether the second half of a period is the mirror image of the first."""
    if motion.system.left is not None or round(whole / math.tau) % 2 == 0:
        return False
    times = (begun + np.linspace(0.0, 0.5 * whole, SAMPLES)) / motion.system.periodic.frequency
    half = 0.5 * whole / motion.system.periodic.frequency
    return bool(np.abs(np.array(motion.at(times)) + np.array(motion.at(times + half))).max() < SYMMETRIC)


def branch_through(orbit: Orbit, name: str, bounds: tuple[float, float], step: float, most: int) -> Branch:
    """Return the branch of an orbit that rests or stays in contact with a brace: ``continue_orbit`` for superstable orbits.

    Raises
    ------
    ValueError
        If the orbit does not close.
    """
    way, first = _first(orbit, name, bounds, step)
    if first is None:
        allowed, remedy = "close after its period", "find it again with find_orbit"
        raise Refusal("orbit", allowed, str(orbit), remedy)
    back, on = (follow(evolve(way, sense=sense), first, most) for sense in (-1.0, 1.0))
    return joined(
        way, back, on, symmetric=first.symmetric, impacts=orbit.impacts, brace_hits=orbit.brace_hits
    )


def _first(
    orbit: Orbit, name: str, bounds: tuple[float, float], step: float
) -> tuple[RestingMap, RestingMotion | None]:
    """Return the map of an orbit, and the orbit from its longest rest or contact."""
    events = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=2 * orbit.period).events
    rows = [
        (float(after["time"] - one["time"]), float(after["time"]), float(one["angle"]))
        for one, after in pairwise(events)
        if one["kind"] in BEGINS and after["kind"] in RELEASES
    ]
    lasts, time, angle = max(rows, default=(0.0, 0.0, 0.0))
    frequency = orbit.system.periodic.frequency
    before = min(BEFORE, 0.5 * frequency * lasts)
    longest = step * (bounds[1] - bounds[0])
    way = RestingMap(orbit.system, name, orbit.period, *bounds, longest, int(np.sign(angle)), before)
    there = way.at(value_of(orbit.system, name), (orbit.phase + frequency * time) % math.tau)
    return way, there if there.closes else None


def _kind(last: RestingMotion, there: RestingMotion) -> str | None:
    """Return what lies between two motions, or None if there is no evidence."""
    if last.continues(there):
        return None
    if min(last.shortest, there.shortest) < SLIGHT:
        return SHRUNK
    if min(last.slowest, there.slowest) < SLIGHT:
        return GRAZING
    return None
