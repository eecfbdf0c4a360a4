"""Manifolds of the saddles: correct images of each point, no gaps, and tangency at the amplitude of the theory."""

import math
import sys

import numpy as np
import pytest

import rocking as rk
from rocking.orbits.saddles import manifold_gap

SYSTEM = rk.System(rk.Harmonic(amplitude=4.0, period=1.0, phase=0.4), restitution=0.8)
CYCLES = 3
GROWN = rk.saddle_manifolds(SYSTEM, cycles=CYCLES)
ALL = [*GROWN.unstable, *GROWN.stable]


def name(curve):
    return f"{'stable' if curve.stable else 'unstable'} {curve.side:+d}"


def saddle(system, side, phase):
    """Return (Θ, Θ') of ±1 + β cos ψ."""
    forcing = system.forcing
    beta = forcing.amplitude / (1 + forcing.frequency**2)
    return np.array([side + beta * np.cos(phase), -beta * forcing.frequency * np.sin(phase)])


def clocked(system, phase):
    """Return the system with τ = 0 at another phase of the forcing."""
    forcing = rk.Harmonic(system.forcing.amplitude, period=system.forcing.period, phase=phase)
    return rk.System(forcing, system.restitution)


def near(system):
    forcing = system.forcing
    return 0.5 * (1 - forcing.amplitude / (1 + forcing.frequency**2))


def sampled(curve, count=60):
    """Some points that lie on the inner half, with their times."""
    rows = np.flatnonzero(np.isfinite(curve.times))
    rows = rows[:: max(1, len(rows) // count)]
    return zip(curve.points[rows], curve.times[rows], strict=True)


@pytest.mark.parametrize("curve", GROWN.unstable, ids=name)
def test_points_of_an_unstable_manifold_come_from_its_straight_part(curve):
    """Started on the straight part a time before: rounding grows e^3-fold at most between impacts; 1e-12."""
    for point, time in sampled(curve):
        phase = GROWN.phase - SYSTEM.forcing.frequency * time
        begin = saddle(SYSTEM, curve.side, phase) - curve.side * near(SYSTEM)
        motion = rk.simulate(clocked(SYSTEM, phase), rk.State(*begin), cycles=CYCLES + 1)
        assert np.abs(np.array(motion.at(time)) - point).max() < 1e-12 or abs(point[0]) < 1e-9


@pytest.mark.parametrize("curve", GROWN.stable, ids=name)
def test_points_of_a_stable_manifold_end_on_its_straight_part(curve):
    """Run forward by the engine as it is, though grown backward; at e = .8 errors of 1e-15 grow a thousandfold: 1e-11."""
    for point, time in sampled(curve):
        if abs(point[0]) < 1e-9:
            continue  # it strikes in the very instant of the section
        motion = rk.simulate(clocked(SYSTEM, GROWN.phase), rk.State(*point), cycles=CYCLES + 1)
        phase = GROWN.phase + SYSTEM.forcing.frequency * time
        end = saddle(SYSTEM, curve.side, phase) - curve.side * near(SYSTEM) * np.array([1.0, -1.0])
        assert np.abs(np.array(motion.at(time)) - end).max() < 1e-11


@pytest.mark.parametrize("curve", ALL, ids=name)
def test_straight_part_has_the_exact_eigendirection(curve):
    outer, centre, first = curve.points[:3]
    np.testing.assert_allclose(centre, saddle(SYSTEM, curve.side, GROWN.phase), atol=1e-15)
    slope = -1.0 if curve.stable else 1.0
    for point in (outer, first):
        across, up = point - centre
        assert up == pytest.approx(slope * across, abs=1e-14)
    assert curve.times[1] == -math.inf
    assert curve.times[2] == 0.0


@pytest.mark.parametrize("curve", ALL, ids=name)
def test_neighbours_are_near_each_other_and_a_tear_is_an_impact(curve):
    """A curve ends only beyond the picture, or at Θ = 0, where Θ' goes on with e times its value."""
    points = curve.points[2:]
    gaps = np.flatnonzero(np.isnan(points[:, 0]))
    lengths = np.hypot(*np.diff(points, axis=0).T)
    inside = np.hypot(*points.T) < 1.5
    seen = inside[:-1] & inside[1:]
    assert lengths[seen].max() <= 0.02
    torn = [(points[k - 1], points[k + 1]) for k in gaps if inside[k - 1] and inside[k + 1]]
    assert torn
    for before, after in torn:
        assert max(abs(before[0]), abs(after[0])) < 1e-9
        # seen backward in time, or where the curve runs from after to before, it is 1/e
        ratio = after[1] / before[1]
        assert min(abs(ratio - SYSTEM.restitution), abs(1 / ratio - SYSTEM.restitution)) < 1e-9


@pytest.mark.parametrize("curve", ALL, ids=name)
def test_a_cycle_carries_a_curve_into_itself(curve):
    """Times a period apart are images of each other; brute force by a run of one cycle."""
    period, direction = SYSTEM.forcing.period, -1 if curve.stable else 1
    known = np.isfinite(curve.times)
    met = 0
    for point, time in sampled(curve, 200):
        k = np.argmin(np.abs(np.where(known, curve.times, math.inf) - (time + direction * period)))
        if abs(curve.times[k] - time - direction * period) > 1e-12 or abs(point[0]) < 1e-9:
            continue
        end = rk.simulate(clocked(SYSTEM, GROWN.phase), rk.State(*point), cycles=1).section()
        if len(end) == 2 and abs(curve.points[k, 0]) > 1e-9:
            assert np.abs(end[1] - curve.points[k]).max() < 1e-10
            met += 1
    assert met > 20


def test_manifolds_of_the_other_saddle_are_mirror_images_half_a_period_on():
    other = rk.saddle_manifolds(SYSTEM, phase=0.4 + math.pi, cycles=2)
    here = rk.saddle_manifolds(SYSTEM, cycles=2)
    for pair, mirrored in ((here.unstable, other.unstable), (here.stable, other.stable)):
        for curve, image in zip(pair, mirrored[::-1], strict=True):
            times, shared, rows = np.intersect1d(curve.times, image.times, return_indices=True)
            finite = np.isfinite(times)
            assert finite.sum() > 100
            shared, rows = shared[finite], rows[finite]
            off = np.abs(curve.points[shared] + image.points[rows]).max(axis=1)
            # where the section meets an impact rounding decides on which side of it
            away = np.abs(curve.points[shared, 0]) > 1e-9
            assert off[away].max() < 1e-11


def test_curves_grow_with_the_cycles_and_finer_ones_have_more_points():
    shorter = rk.saddle_manifolds(SYSTEM, cycles=2)
    finer = rk.saddle_manifolds(SYSTEM, cycles=2, spacing=0.005)
    for few, many, fine in zip(shorter.unstable, GROWN.unstable, finer.unstable, strict=True):
        assert few.length < many.length
        assert len(fine.points) > 2 * len(few.points)
        assert fine.length == pytest.approx(few.length, rel=2e-2)


def test_what_is_not_resolved_says_so(monkeypatch):
    monkeypatch.setattr(sys.modules["rocking.orbits.manifolds"], "MAX_POINTS", 300)
    rough = rk.saddle_manifolds(SYSTEM, cycles=4)
    assert not rough.unstable[0].resolved
    assert "not resolved (reduce cycles)" in str(rough)
    assert "not resolved" not in str(GROWN)


@pytest.mark.parametrize("period", [0.4, 1.0, 2.0, 5.0])
@pytest.mark.parametrize("restitution", [0.3, 0.8, 0.925, 0.99])
def test_tangency_found_by_bisection_is_the_one_in_closed_form(period, restitution):
    square = (2 * math.pi / period) ** 2
    root = math.sqrt((1 + restitution) ** 2 + square * (1 - restitution) ** 2)
    exact = (1 + square) * (1 - restitution) / root
    system = rk.System(rk.Harmonic(1.0, period=period), restitution)
    assert rk.tangency_amplitude(system) == pytest.approx(exact, abs=1e-8)


@pytest.mark.parametrize(
    "period, restitution, printed", [(1.0, 0.8, 3.687813070284), (2.0, 0.925, 0.420353980151)]
)
def test_tangency_lies_where_it_is_printed(period, restitution, printed):
    system = rk.System(rk.Harmonic(1.0, period=period), restitution)
    assert rk.tangency_amplitude(system) == pytest.approx(printed, abs=1e-9)


@pytest.mark.parametrize("amplitude", [0.0, 1.0, 3.0, 3.7, 6.0])
def test_gap_is_the_difference_of_the_speeds_in_closed_form(amplitude):
    """max(e V_u − V_s) = (e − 1) + β √((1 + e)² + Ω²(1 − e)²); the spline's error is far below 1e-9."""
    e, square = 0.8, (2 * math.pi) ** 2
    exact = (e - 1) + amplitude / (1 + square) * math.sqrt((1 + e) ** 2 + square * (1 - e) ** 2)
    system = rk.System(rk.Harmonic(amplitude, period=1.0), e)
    assert manifold_gap(system) == pytest.approx(exact, abs=1e-9)


def test_past_the_tangency_a_motion_from_one_saddle_overturns_over_the_other():
    """Brute force: of 2,000 motions that leave the lower saddle, the first flight after an impact takes some over the upper."""
    touching = rk.tangency_amplitude(SYSTEM)

    def overturning(amplitude):
        fell = 0
        for phase in np.linspace(0.0, 2 * math.pi, 2000, endpoint=False):
            forcing = rk.Harmonic(amplitude, period=1.0, phase=phase)
            system = rk.System(forcing, SYSTEM.restitution)
            begin = saddle(system, -1, phase) + near(system)
            motion = rk.simulate(system, rk.State(*begin), cycles=9, record="none")
            proof = motion.overturning
            fell += proof is not None and proof.impacts == 1 and motion.final.angle > 0
        return fell

    assert overturning(touching * (1 - 1e-4)) == 0
    assert overturning(touching * (1 + 1e-4)) > 0


@pytest.mark.parametrize(
    "change, message",
    [
        (dict(system=3), "system must be a System; got 3"),
        (
            dict(system=rk.System(rk.Harmonic(1.0, period=1.0), 0.9, rk.Braces(1.0))),
            "system must have no braces: .*; got Braces",
        ),
        (
            dict(system=rk.System(rk.Harmonic(1.0, period=1.0), 0.0)),
            "restitution must be positive, .*; got 0.0",
        ),
        (
            dict(system=rk.System(rk.Harmonic(41.0, period=1.0), 0.9)),
            r"amplitude must be below 1 \+ Ω² = 40.4784, .*; got 41.0",
        ),
        (dict(cycles=0), r"cycles must be a whole number in \[1, 100\]; got 0"),
        (dict(spacing=0.0), r"spacing must lie in \[1e-05, 1\]; got 0.0"),
        (dict(phase=math.nan), "phase must lie in .*; got nan"),
    ],
)
def test_refusals_are_one_line(change, message):
    with pytest.raises((TypeError, ValueError), match=f"^{message}") as refused:
        rk.saddle_manifolds(**({"system": SYSTEM} | change))
    assert "\n" not in str(refused.value)
