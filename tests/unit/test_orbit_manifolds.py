"""Manifolds of any saddle orbit: invariance, convergence to the orbit, mirror images, and the boundary of two basins."""

import math

import numpy as np
import pytest

import rocking as rk

SYSTEMS = {
    "period 1": (rk.System(rk.Harmonic(amplitude=6.0, period=2.0), 0.925), 1),
    "period 3": (rk.System(rk.Harmonic(amplitude=6.5, period=0.4), 0.925), 3),
    "negative multiplier": (rk.System(rk.Harmonic(amplitude=8.0, period=2.0), 0.925), 1),
}


def saddle_of(name):
    """An unstable orbit with impacts: symmetric, or one that has doubled its period."""
    system, period = SYSTEMS[name]
    doubled = name == "negative multiplier"
    return next(
        orbit
        for orbit in rk.find_orbits(system, period)
        if orbit.period == period
        and orbit.impacts
        and orbit.stability == "unstable"
        and orbit.symmetric is not doubled
    )


@pytest.fixture(scope="module", params=SYSTEMS)
def case(request):
    orbit = saddle_of(request.param)
    return orbit, rk.orbit_manifolds(orbit, length=4.0)


def after(manifolds, point, cycles):
    """The state some cycles after a state on the section, by simulation; None if the block overturns."""
    forcing = manifolds.orbit.system.forcing
    clocked = rk.Harmonic(forcing.amplitude, period=forcing.period, phase=manifolds.phase)
    system = rk.System(clocked, manifolds.orbit.system.restitution)
    motion = rk.simulate(system, rk.State(*point.tolist()), cycles=cycles)
    return None if motion.outcome == "overturned" else np.array([motion.final.angle, motion.final.velocity])


def distance(curve, point):
    """Distance of a point from the pieces of a curve."""
    start, along = curve[:-1], np.diff(curve, axis=0)
    off = point - start
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.clip((off * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
        return np.nanmin(np.hypot(*(off - share[:, None] * along).T))


def test_multiplier_is_negative_in_one_case():
    signs = {name: min(value.real for value in saddle_of(name).multipliers) for name in SYSTEMS}
    assert [name for name, least in signs.items() if least < 0.0] == ["negative multiplier"]


def test_images_of_an_unstable_manifold_lie_on_it(case):
    orbit, manifolds = case
    cycles = 2 * orbit.period  # so that no half changes its side
    checked = 0
    for one in manifolds.unstable:
        inner = one.points[
            (one.times > 0.0) & (one.times < np.nanmax(one.times) - cycles * orbit.system.forcing.period)
        ]
        for point in inner[:: max(1, len(inner) // 25)]:
            there = after(manifolds, point, cycles)
            if there is not None:
                assert distance(one.points, there) < 1e-3
                checked += 1
    assert checked > 20


def test_motions_on_a_stable_manifold_converge_to_the_orbit(case):
    """Beside a grazing, where the curve is stretched without limit, rounding moves a motion from the curve."""
    orbit, manifolds = case
    length = orbit.period * orbit.system.forcing.period
    missed = []
    for one in manifolds.stable:
        known = np.flatnonzero(one.times > 0.0)
        for row in known[:: max(1, len(known) // 25)]:
            cycles = orbit.period * math.ceil(one.times[row] / length)
            there = after(manifolds, one.points[row], cycles)
            missed.append(np.hypot(*(manifolds.points - there).T).min())
    assert len(missed) > 40
    assert np.quantile(missed, 0.95) < 3e-6


def test_stable_manifold_bounds_the_basins_of_two_mirror_images():
    manifolds = rk.orbit_manifolds(saddle_of("period 1"), length=1.0)
    one = manifolds.stable[0]
    rows = np.flatnonzero(one.times > 0.0)
    rows = rows[(rows > 1) & (rows < len(one.points) - 2)]
    for row in rows[:: max(1, len(rows) // 8)]:
        along = one.points[row + 1] - one.points[row - 1]
        across = 1e-4 * np.array([-along[1], along[0]]) / np.hypot(*along)
        ends = [after(manifolds, one.points[row] + off * across, 400) for off in (-1.0, 1.0)]
        found = [np.hypot(*(manifolds.points - end).T).min() for end in ends]
        assert min(found) > 0.05
        assert np.hypot(*(ends[1] - ends[0])) > 0.1


def test_mirror_images_have_mirror_images_of_manifolds():
    system, period = SYSTEMS["negative multiplier"]
    pair = [
        rk.orbit_manifolds(orbit, length=2.0, phase=phase)
        for orbit, phase in zip(
            [o for o in rk.find_orbits(system, period) if o.impacts and not o.symmetric],
            (0.4, 0.4 + math.pi),
            strict=True,
        )
    ]
    np.testing.assert_allclose(pair[0].points, -pair[1].points, atol=1e-12)
    for one in pair[0].unstable:
        (other,) = (each for each in pair[1].unstable if each.side == -one.side)
        assert other.length == pytest.approx(one.length, rel=1e-3)


def test_curves_begin_along_the_multipliers(case):
    """A return multiplies a small distance by the multiplier, or by its square if it is negative."""
    orbit, manifolds = case
    largest = max(orbit.multipliers, key=abs).real
    factor = largest if largest > 0.0 else largest**2
    returns = orbit.period * orbit.system.forcing.period * (1 if largest > 0.0 else 2)
    for one in manifolds.unstable:
        first = one.points[np.flatnonzero(one.times == 0.0)[0]]
        second = one.points[np.flatnonzero(np.isclose(one.times, returns))[0]]
        nearest = manifolds.points[np.argmin(np.hypot(*(manifolds.points - first).T))]
        assert np.hypot(*(second - nearest)) / np.hypot(*(first - nearest)) == pytest.approx(factor, rel=1e-3)


def test_picture_shows_all_halves():
    manifolds = rk.orbit_manifolds(saddle_of("period 1"), length=1.0)
    ax = rk.plot.orbit_manifolds(manifolds)
    assert [line.get_gid() for line in ax.lines] == ["stable"] * 2 + ["unstable"] * 2 + ["saddle"]


def test_legend_over_basins_with_long_names_fits_the_figure():
    system = rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)
    angle, velocity = np.linspace(-1, 1, 40), np.linspace(-1, 1, 40)
    ax = rk.plot.basins(rk.basin_map(system, angle=angle, velocity=velocity, boundary_runs=0))
    assert len(ax.get_legend().get_texts()) > 5
    saddle = next(each for each in rk.find_orbits(system, 3) if each.stability == "unstable" and each.impacts)
    rk.plot.orbit_manifolds(rk.orbit_manifolds(saddle, length=1.0), ax)
    ax.figure.draw_without_rendering()
    legend, figure = ax.get_legend().get_window_extent(), ax.figure.bbox
    assert figure.x0 <= legend.x0
    assert legend.x1 <= figure.x1
    assert ax.get_window_extent().width > 0.7 * figure.width


def test_halves_that_are_too_short_are_told(case):
    _, manifolds = case
    short = [one.length < 4.0 for one in (*manifolds.unstable, *manifolds.stable)]
    told = f"{sum(short)} of {len(short)} halves end before a length of 4" if any(short) else "points"
    assert str(manifolds).endswith(told)


def test_curves_keep_to_the_region_of_bounded_motions():
    orbit = next(
        each for each in rk.find_orbits(rk.System(rk.Harmonic(6.0, period=2.0), 0.3), 1) if each.symmetric
    )
    manifolds = rk.orbit_manifolds(orbit, length=2.0)
    for one in (*manifolds.unstable, *manifolds.stable):
        assert np.nanmax(np.abs(one.points)) < 6.0


def test_refusals():
    orbit = saddle_of("period 1")
    stable = rk.find_orbits(orbit.system, 1)[0]
    onset = rk.theory.symmetry_breaking_amplitude(2.0, 0.925, 1)
    weak = next(
        each
        for each in rk.find_orbits(rk.System(rk.Harmonic(onset + 1e-3, period=2.0), 0.925), 1)
        if each.symmetric
    )
    braced = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), 0.9, rk.Braces(1.0, 0.5))
    between = rk.find_orbits(braced, 1)[0]
    for call, error, message in (
        (lambda: rk.orbit_manifolds(stable), ValueError, "orbit must be a saddle orbit with impacts"),
        (lambda: rk.orbit_manifolds(weak), ValueError, "orbit must have a multiplier of at least 1.02"),
        (lambda: rk.orbit_manifolds(3), TypeError, "orbit must be an Orbit"),
        (lambda: rk.orbit_manifolds(orbit, length=0), ValueError, "length must"),
        (lambda: rk.orbit_manifolds(orbit, spacing=2), ValueError, "spacing must"),
        (lambda: rk.orbit_manifolds(between), ValueError, "system must have no braces: "),
        (lambda: rk.plot.orbit_manifolds(orbit), TypeError, "result must be an OrbitManifolds"),
    ):
        with pytest.raises(error, match=message) as raised:
            call()
        assert "\n" not in str(raised.value)
