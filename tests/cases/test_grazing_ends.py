"""Curves of grazings: each point is an orbit by dense samples of its arcs, none exists beyond the ends, and the ends are named."""

import math
from functools import cache

import numpy as np
import pytest

import rocking as rk

PLANE = "period", "amplitude"
BASE, BRACE = 0, 1
TOUCHES, MET, CLOSED = 1e-9, 1e-6, 1e-7


class Arc:
    """Arc of a chain at a row of a curve, in the closed form of Yim & Lin (1991), Eq. (5)."""

    def __init__(self, system, side, phase, start, speed):
        self.frequency, self.phase = math.tau / system.forcing.period, phase
        self.swing = side * system.forcing.amplitude / (1.0 + self.frequency**2)
        self.even = start - 1.0 - self.swing * math.cos(phase)
        self.odd = speed + self.swing * self.frequency * math.sin(phase)

    def angle(self, t):
        forced = self.swing * np.cos(self.phase + self.frequency * t)
        return 1.0 + forced + self.even * np.cosh(t) + self.odd * np.sinh(t)

    def speed(self, t):
        forced = self.swing * self.frequency * np.sin(self.phase + self.frequency * t)
        return self.even * np.sinh(t) + self.odd * np.cosh(t) - forced


def place(system, kind):
    return system.braces.angle if kind == BRACE else 0.0


def kept(system, kind):
    return system.braces.restitution if kind == BRACE else system.restitution


def initial_speed(system, side, phases, kinds, t):
    """Speed at which an arc must start to be at the place of its last event after a time."""
    start, end = (place(system, kind) for kind in kinds)
    still = Arc(system, side, phases[0], start, 0.0)
    return float((end - still.angle(t)) / math.sinh(t))


def turning_points(arc, end):
    times = np.linspace(0.0, end, 4001)
    speeds = arc.speed(times)
    for i in np.flatnonzero(speeds[:-1] * speeds[1:] < 0.0):
        low, high = times[i : i + 2]
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if arc.speed(middle) * speeds[i] > 0.0 else (low, middle)
        yield 0.5 * (low + high)


def faults(curve, row):
    """Faults of the orbit at a row of a curve: it must close, keep between base and braces, and touch one of them."""
    rows = curve._rows
    chain = rows.chain_at(row)
    system, kinds, side = chain.system, chain.kinds, chain.side
    k, reach = len(kinds), math.inf if chain.system.braces is None else chain.system.braces.angle
    arcs, found, gap = [], [], math.inf
    for j in range(k):
        after = (j + 1) % k
        t = (row[after] + (chain.turn if after == 0 else 0.0) - row[j]) / system.harmonic.frequency
        speed = initial_speed(system, side, row[j : j + 1], (kinds[j], kinds[after]), t)
        arc = Arc(system, side, row[j], place(system, kinds[j]), speed)
        arcs.append((speed, float(arc.speed(t))))
        turns = np.array([*turning_points(arc, t)])
        heights = np.array([*arc.angle(turns), *arc.angle(np.linspace(0.0, t, 2001)[1:-1])])
        if heights.min(initial=1.0) < -TOUCHES or heights.max(initial=0.0) > reach + TOUCHES:
            found.append(f"arc {j} leaves base or brace")
        if (speed if kinds[j] == BASE else -speed) <= 0.0:
            found.append(f"arc {j} starts outwards")
        ends = arc.angle(turns)
        gap = min([gap, *np.abs(ends), *np.abs(reach - ends)])
        side = -side if kinds[after] == BASE else side
    for j in range(k):
        arrives = arcs[j - 1][1]
        if abs(kept(system, kinds[j]) * arrives + arcs[j][0]) > CLOSED * max(1.0, abs(arrives)):
            found.append(f"event {j} breaks the impact law")
    return found if gap <= TOUCHES else [*found, f"nearest contact {gap:.1e}"]


# One grazing of each curve: its parameter, and the value of this parameter.
SYSTEM = rk.System(rk.Harmonic(4.28, period=1.65), 0.7, rk.Braces(0.98, 0.9))
RANGES = {"amplitude": (1.0, 16.0), "period": (0.9, 3.0)}
BOUNDS = RANGES["period"], RANGES["amplitude"]
# Orbits of which a contact that follows on the touch vanishes, or one that precedes it.
CURVES = ("period", 2.1108255576), ("period", 2.1969661557), ("amplitude", 7.9693604097)


def branches(system, name, bounds, longest):
    for orbit in rk.find_orbits(system, longest, effort=0.2):
        if not orbit.superstable and (orbit.impacts or orbit.brace_hits):
            yield rk.continue_orbit(orbit, name, bounds)


@cache
def specials(system, name, bounds, longest):
    return [special for branch in branches(system, name, bounds, longest) for special in branch.special]


@pytest.fixture(scope="module", params=CURVES)
def curve(request):
    name, value = request.param
    found = specials(SYSTEM, name, RANGES[name], 3)
    special = next(one for one in found if one.kind == "grazing" and abs(one.parameter - value) < 1e-6)
    return rk.bifurcation_curve(special, *PLANE, BOUNDS)


def test_each_point_of_a_curve_of_grazings_is_an_orbit(curve):
    for row in curve._rows.rows:
        assert faults(curve, row) == []


def test_a_curve_of_grazings_ends_where_a_second_instant_grazes(curve):
    for index, end, sense in ((0, curve.ends[0], 1), (len(curve) - 1, curve.ends[1], -1)):
        if end == "end of the range":
            continue
        (point,) = (one for one in curve.special if one.index == index)
        assert (end, point.kind) == ("grazing", "double-grazing")
        assert np.abs(np.subtract(point.values, curve.points[index])).max() < 1e-3
        assert max(point.errors) < 1e-9
        inwards = curve._rows.rows[::sense]
        chord = inwards[0] - inwards[1]
        for length in (1e-3, 1e-2):
            beyond = curve._rows.corrected(inwards[0] + length * chord / np.linalg.norm(chord), chord)
            assert beyond is None or faults(curve, beyond)


def test_two_curves_with_and_without_a_contact_end_at_one_point():
    """One of them gains the contact there, and the other one loses it."""
    found = specials(SYSTEM, "period", RANGES["period"], 3)
    ends = []
    for value in (2.2368807383, 2.1969661557):
        special = next(one for one in found if abs(one.parameter - value) < 1e-6)
        curve = rk.bifurcation_curve(special, *PLANE, BOUNDS)
        ends.append(curve.special[0])
    one, other = ends
    assert one.kind == other.kind == "double-grazing"
    assert (np.abs(np.subtract(one.values, other.values)) < 3.0 * np.add(one.errors, other.errors)).all()


def test_folds_and_period_doublings_end_together_where_the_grazing_is_degenerate():
    """The place lies on the curve of grazings of the orbits without the contact."""
    system = rk.System(rk.Harmonic(1.67, period=2.81), 0.7)
    found = specials(system, "amplitude", (0.835, 2.672), 2)
    curves = {
        one.kind: rk.bifurcation_curve(one, *PLANE, ((1.967, 3.934), (0.501, 4.175)))
        for one in found
        if one.orbit.impacts == 4 and one.kind in ("fold", "period-doubling")
    }
    assert sorted(curves) == ["fold", "period-doubling"]
    points = [curve.special[0] for curve in curves.values()]
    for curve, point in zip(curves.values(), points, strict=True):
        assert (curve.ends[0], point.kind, point.index) == ("grazing", "degenerate-grazing", 0)
        # the coefficient grows as an inverse power of the distance, without noise
        far = np.linalg.norm(curve.points - point.values, axis=1)
        near = np.flatnonzero(far < 2e-3)
        order = np.diff(np.log(np.abs(curve.coefficients[near]))) / np.diff(np.log(far[near]))
        assert len(near) > 2
        np.testing.assert_allclose(order, -1.0 if curve.kind == "fold" else -2.0, atol=0.01)
    one, other = points
    assert (np.abs(np.subtract(one.values, other.values)) < 3.0 * np.add(one.errors, other.errors)).all()
    grazing = next(each for each in found if each.kind == "grazing" and each.orbit.impacts == 2)
    met = rk.bifurcation_curve(grazing, *PLANE, ((1.967, 3.934), (0.501, 4.175)))
    assert distance(met.points, one.values) < 1e-4


def distance(points, place):
    """Distance of a place from the straight lines between neighbouring points, where it lies between them."""
    starts, chords = points[:-1], np.diff(points, axis=0)
    shares = np.clip(((place - starts) * chords).sum(axis=1) / (chords**2).sum(axis=1), 0.0, 1.0)
    return np.linalg.norm(starts + shares[:, None] * chords - place, axis=1).min()


def test_a_curve_of_grazings_of_doubled_orbits_ends_where_the_multiplier_of_the_others_is_minus_one():
    system = rk.System(rk.Harmonic(6.44, period=2.56), 0.7, rk.Braces(0.38, 0.8))
    found, plane = specials(system, "amplitude", (3.22, 10.304), 2), ((1.792, 3.584), (1.932, 16.1))
    doubled, single = (
        next(one for one in found if one.orbit.period == period and abs(one.parameter - value) < 1e-8)
        for period, value in ((2, 5.927631208), (1, 6.618921623))
    )
    end = rk.bifurcation_curve(doubled, *PLANE, plane).special[0]
    (met,) = (one for one in rk.bifurcation_curve(single, *PLANE, plane).special if one.kind == end.kind)
    assert (end.kind, end.index, end.orbit.period) == ("period-doubling-grazing", 0, 1)
    assert (np.abs(np.subtract(end.values, met.values)) < 3.0 * np.add(end.errors, met.errors)).all()


def test_a_grazing_at_several_instants_of_a_period_is_refused():
    """It is the grazing of an orbit of a shorter period or of a symmetric one, on whose curve each contact touches."""
    system = rk.System(rk.Harmonic(6.58, period=1.47), 0.925, rk.Braces(0.57, 0.7))
    found = [
        one for one in specials(system, "period", (0.9, 2.0), 2) if abs(one.parameter - 1.764641193) < 1e-8
    ]
    assert {one.orbit.impacts for one in found} == {2, 4}
    for one in found:
        if one.orbit.impacts == 4:
            with pytest.raises(ValueError, match="^special must be a grazing at one instant, not at several"):
                rk.bifurcation_curve(one, *PLANE, ((1.0, 2.0), (2.0, 16.0)))
        else:
            assert len(rk.bifurcation_curve(one, *PLANE, ((1.0, 2.0), (2.0, 16.0)))) > 50


def test_a_grazing_of_an_orbit_that_is_another_one_twice_is_refused_with_any_step():
    system = rk.System(rk.Harmonic(4.19, period=2.44), 0.85, rk.Braces(0.9, 0.7))
    found = [
        one for one in specials(system, "period", (1.5, 3.4), 2) if abs(one.parameter - 2.361599527) < 1e-8
    ]
    twice = [one for one in found if one.orbit.period == 2]
    assert twice
    for step in (0.01, 0.001):
        with pytest.raises(ValueError, match="^special must be a grazing at one instant, not at several"):
            rk.bifurcation_curve(twice[0], *PLANE, ((1.5, 3.4), (1.0, 10.0)), step)
