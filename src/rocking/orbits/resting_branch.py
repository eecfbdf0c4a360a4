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
from attrs import frozen

from rocking.model.orbit import Orbit
from rocking.model.system import State, System
from rocking.model.validation import Refusal
from rocking.model.verdict import Kind
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.orbits.branch import ENDS, POINT, Branch, HalfBranch, joined
from rocking.orbits.event_chain import End, clocked
from rocking.orbits.find_orbit import SAME, orbit_from
from rocking.orbits.parameter import value_of, with_value
from rocking.orbits.special_points import GRAZING, SpecialPoint
from rocking.response.classify import classify

NARROW = 1e-13
"""Width of a bracket of a special point at which the bisection ends, relative to the range."""
SMALLEST = 1e-3
"""Smallest step, in units of the largest: with it the order of events may change."""
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
class RestingMap:
    """Motions over a period from rest, or from contact with a brace, for one parameter."""

    system: System
    name: str
    period: int
    side: int  # 0 at the base, else the side of the brace
    before: float  # wait from the start to the end of the rest, in rad

    def at(self, value: float, release: float) -> RestingMotion:
        """Return the motion whose rest ends near a forcing phase."""
        system, begun = with_value(self.system, self.name, value), release - self.before
        angle = self.side * system.braces.angle if self.side and system.braces else 0.0
        motion = simulate(clocked(system, begun % math.tau), State(angle), cycles=self.period + 1)
        return held(motion, value, begun, angle, math.tau * self.period)

    def orbit(self, point: RestingMotion) -> Orbit:
        """Return the orbit of a point."""
        system = with_value(self.system, self.name, point.value)
        result = orbit_from(system, point.phase, State(point.angle), self.period)
        assert result is not None
        return result


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
    if round(whole / math.tau) % 2 == 0:
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
    way, first = _first(orbit, name)
    if first is None:
        allowed, remedy = "close after its period", "find it again with find_orbit"
        raise Refusal("orbit", allowed, str(orbit), remedy)
    back, on = (_follow(way, first, bounds, sense * step, most) for sense in (-1.0, 1.0))
    points, specials = joined(back, on)
    return Branch(
        name=name,
        period=orbit.period,
        symmetric=first.symmetric,
        impacts=orbit.impacts,
        brace_hits=orbit.brace_hits,
        points=_table(points),
        special=tuple(
            SpecialPoint(kind, point.value, way.orbit(point), name, index, None, np.array([]))
            for kind, point, index in specials
        ),
        ends=(back.end, on.end),
        rows=RestingRows(way, points),
    )


def _first(orbit: Orbit, name: str) -> tuple[RestingMap, RestingMotion | None]:
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
    way = RestingMap(orbit.system, name, orbit.period, int(np.sign(angle)), before)
    there = way.at(value_of(orbit.system, name), (orbit.phase + frequency * time) % math.tau)
    return way, there if there.closes else None


def _follow(
    way: RestingMap, first: RestingMotion, bounds: tuple[float, float], step: float, most: int
) -> HalfBranch[RestingMotion]:
    """Follow a branch in one direction, the sign of ``step``, which is a part of the range."""
    (low, high), points, here = bounds, [first], first
    specials: list[tuple[str, RestingMotion, int]] = []
    longest = step * (high - low)
    length = longest
    while len(points) < most:
        if here.value == (low if step < 0.0 else high):
            return HalfBranch(points, specials, ENDS[End.RANGE])
        there = way.at(min(max(here.value + length, low), high), here.release)
        if abs(length) > SMALLEST * abs(longest) and not (
            here.continues(there) and here.continues(way.at(0.5 * (here.value + there.value), here.release))
        ):
            length *= 0.5
            continue
        if not here.continues(there):
            last, there = _bracket(way, here, there, NARROW * (high - low))
            if last.value != here.value:
                points.append(last)
            kind = _kind(last, there)
            if kind == SHRUNK or not there.closes or there.symmetric != last.symmetric:
                return HalfBranch(points, specials, _end(way, kind, there))
            if kind is not None:
                specials.append((kind, last, len(points)))
        points.append(there)
        here, length = there, longest if abs(2.0 * length) > abs(longest) else 2.0 * length
    return HalfBranch(points, specials, ENDS[End.MANY])


def _bracket(
    way: RestingMap, here: RestingMotion, there: RestingMotion, width: float
) -> tuple[RestingMotion, RestingMotion]:
    """Return the last point that continues a branch, and the first one that does not, by bisection."""
    while abs(there.value - here.value) > width:
        middle = way.at(0.5 * (here.value + there.value), here.release)
        if middle.value in (here.value, there.value):
            break
        if here.continues(middle):
            here = middle
        else:
            there = middle
    return here, way.at(there.value, here.release)  # from the nearest end of the rest


def _kind(last: RestingMotion, there: RestingMotion) -> str | None:
    """Return what lies between two motions, or None if there is no evidence."""
    if last.continues(there):
        return None
    if min(last.shortest, there.shortest) < SLIGHT:
        return SHRUNK
    if min(last.slowest, there.slowest) < SLIGHT:
        return GRAZING
    return None


def _end(way: RestingMap, kind: str | None, there: RestingMotion) -> str:
    """Return the reason for an end, with the response just beyond it."""
    system = clocked(with_value(way.system, way.name, there.value), (there.release - way.before) % math.tau)
    beyond = classify(system, State(there.angle), max_cycles=CYCLES)
    if beyond.kind is Kind.REST:
        return "the block no longer lifts off"
    return f"{kind or 'the order of events changes'}; beyond: {beyond.orbit or beyond.kind}"


def _table(points: tuple[RestingMotion, ...]) -> np.ndarray:
    """Return the public table of a branch."""
    rows = np.zeros(len(points), POINT)
    rows["parameter"] = [point.value for point in points]
    rows["phase"], rows["velocity"] = np.array([point.first for point in points]).T
    rows["stability"], rows["stable"] = "stable", True
    rows["peak"] = [point.peak for point in points]
    rows.flags.writeable = False
    return rows


class RestingRows(NamedTuple):
    """Points of a branch of orbits that rest."""

    map: RestingMap
    points: tuple[RestingMotion, ...]

    def orbit(self, index: int) -> Orbit:
        """Return the orbit of a point."""
        return self.map.orbit(self.points[index])

    def between(self, index: int, share: float, value: float) -> Orbit | None:
        """Return the orbit at a value of the parameter near the point a share of the way to the next one, if there is one."""
        result = self.map.at(value, self.points[index].release)
        return self.map.orbit(result) if result.closes else None

    def section(self, phase: float) -> np.ndarray:
        """Return Θ and Θ' of all orbits at a forcing phase in the cycles of a period, shape (points, period, 2)."""
        out = []
        for index in range(len(self.points)):
            orbit = self.orbit(index)
            forcing = orbit.system.periodic
            motion = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=self.map.period + 1)
            wait = ((phase - orbit.phase) % math.tau) / forcing.frequency
            out.append(np.column_stack(motion.at(wait + forcing.period * np.arange(self.map.period))))
        return np.array(out)
