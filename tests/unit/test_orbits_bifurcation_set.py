"""Bifurcation sets: closed forms, searches on both sides of each curve, and special points of lines that are not on the grid."""

import numpy as np
import pytest

import rocking as rk

BOUNDS = {"period": (1.2, 2.6), "amplitude": (2.0, 14.0)}
SYSTEMS = {
    "e 0.925": (rk.System(rk.Harmonic(4.0, period=2.0), 0.925), 2, BOUNDS),
    "e 0.8": (rk.System(rk.Harmonic(4.0, period=2.0), 0.8), 1, BOUNDS),
    "braced": (
        rk.System(rk.Harmonic(4.0, period=2.0), 0.9, rk.Braces(0.6, 0.7)),
        1,
        {"period": (1.2, 2.0), "amplitude": (4.0, 8.0)},
    ),
}


@pytest.fixture(
    scope="module",
    params=[pytest.param(each, marks=() if each == "braced" else pytest.mark.long) for each in SYSTEMS],
)
def case(request):
    system, longest, bounds = SYSTEMS[request.param]
    return system, longest, rk.bifurcation_set(system, longest, grid=8, **bounds)


def at(system, values):
    """The system with other values of period and amplitude."""
    period, amplitude = (float(value) for value in values)
    return rk.System(rk.Harmonic(amplitude, period=period), system.restitution, system.braces)


def spans(found):
    return np.array([high - low for low, high in found.bounds])


def distance(curve, point, unit):
    """Distance of a point from the points of a curve, in units of the ranges."""
    return np.hypot(*((curve.points - point) / unit).T).min()


def test_curves_of_each_system(case):
    _, longest, found = case
    assert found.names == ("period", "amplitude")
    assert {curve.period for curve in found.curves} == set(range(1, longest + 1))
    assert {"period-doubling", "fold", "grazing"} & {curve.kind for curve in found.curves}
    for curve in found.curves:
        assert len(curve) > 1
        for values, (low, high) in zip(curve.points.T, found.bounds, strict=True):
            assert low <= values.min() <= values.max() <= high


def test_special_points_of_other_lines_lie_on_the_curves(case):
    """Brute force: orbits at random places, each followed through the amplitude."""
    system, longest, found = case
    random, near, checked = np.random.default_rng(5), 0.012, 0
    for _ in range(8):
        place = [random.uniform(*ends) for ends in found.bounds]
        for orbit in rk.find_orbits(at(system, place), longest):
            if orbit.superstable or not orbit.impacts:
                continue
            branch = rk.continue_orbit(orbit, "amplitude", found.bounds[1])
            for special in branch.special:
                try:
                    rk.bifurcation_curve(special, *found.names, found.bounds)
                except ValueError:
                    continue  # cannot be followed
                checked += 1
                same = [
                    curve
                    for curve in found.curves
                    if (curve.kind, curve.period) == (special.kind, special.orbit.period)
                ]
                here = np.array([place[0], special.parameter])
                assert min(distance(curve, here, spans(found)) for curve in same) < near, str(special)
    assert checked > 5


def count(system, period, symmetric=None):
    """Number of orbits with impacts of a period that a search finds."""
    return sum(
        orbit.period == period and bool(orbit.impacts) and symmetric in (None, orbit.symmetric)
        for orbit in rk.find_orbits(system, period)
    )


CHANGES = {
    "fold": lambda curve: (curve.period, None),
    "symmetry-breaking": lambda curve: (curve.period, False),
    "period-doubling": lambda curve: (2 * curve.period, None),
}


def test_searches_on_both_sides_of_a_curve_find_other_numbers_of_orbits(case):
    """Two orbits appear at a fold and at a symmetry breaking, or two pairs; one or two of twice the period at a doubling."""
    system, _, found = case
    seen = set()
    for curve in found.curves:
        if curve.kind not in CHANGES or len(curve) < 20:
            continue
        middle = len(curve) // 2
        along = np.diff(curve.points[middle - 1 : middle + 2 : 2], axis=0)[0] / spans(found)
        across = np.array([-along[1], along[0]]) / np.hypot(*along) * spans(found)
        period, symmetric = CHANGES[curve.kind](curve)
        sides = [
            count(at(system, curve.points[middle] + off * across), period, symmetric) for off in (-2e-3, 2e-3)
        ]
        assert sides[0] != sides[1], str(curve)
        seen.add(curve.kind)
    assert seen


def test_symmetry_breaking_is_that_of_the_closed_form():
    system, _, bounds = SYSTEMS["e 0.925"]
    found = rk.bifurcation_set(system, 1, grid=4, **bounds)
    (curve,) = (curve for curve in found.curves if curve.kind == "symmetry-breaking")
    exact = [rk.theory.symmetry_breaking_amplitude(period, 0.925, 1) for period in curve.points[:, 0]]
    np.testing.assert_allclose(curve.points[:, 1], exact, rtol=1e-9)


def test_motions_double_their_period_across_a_curve():
    system, _, bounds = SYSTEMS["e 0.8"]
    found = rk.bifurcation_set(system, 1, grid=6, **bounds)
    curve = max((one for one in found.curves if one.kind == "period-doubling"), key=len)
    for period, amplitude in curve.points[20:-20:20].tolist():
        below = rk.find_orbits(at(system, (period, amplitude * 0.995)), 1)
        stable = next(orbit for orbit in below if orbit.stability == "stable" and not orbit.symmetric)
        branch = rk.continue_orbit(stable, "amplitude", (amplitude * 0.99, amplitude * 1.01))
        verdicts = []
        for factor in (0.999, 1.001):
            (orbit,) = branch.at(amplitude * factor)
            start = rk.State(orbit.state.angle + 1e-7, orbit.state.velocity)
            clocked = rk.Harmonic(orbit.system.forcing.amplitude, period=period, phase=orbit.phase)
            verdicts.append(rk.classify(rk.System(clocked, 0.8), start))
        assert [verdict.period for verdict in verdicts] == [1, 2]


def test_dataset_holds_every_curve():
    system, _, bounds = SYSTEMS["e 0.8"]
    found = rk.bifurcation_set(system, 1, grid=3, **bounds)
    data = found.to_xarray()
    assert data.curve_kind.values.tolist() == [curve.kind for curve in found.curves]
    for number, curve in enumerate(found.curves):
        part = data.isel(point=data.curve_number.values == number)
        np.testing.assert_array_equal(np.column_stack([part.period, part.amplitude]), curve.points)


def test_special_points_that_are_not_followed_lie_on_no_curve():
    """Grazings after which an orbit has no impact: without braces they lie at A = 1 + Ω²."""
    system, longest, _ = SYSTEMS["e 0.8"]
    found = rk.bifurcation_set(system, longest, grid=4, period=(1.8, 2.6), amplitude=(2.0, 14.0))
    periods = 1.8 + 0.8 * (np.arange(4) + 0.5) / 4
    assert found.not_followed == np.count_nonzero(1.0 + (2.0 * np.pi / periods) ** 2 < 14.0) > 0
    assert found.to_xarray().attrs["not_followed"] == found.not_followed
    assert found.to_xarray().attrs["restitution"] == system.restitution


def test_picture_refuses_axes_of_other_quantities():
    system, _, bounds = SYSTEMS["e 0.8"]
    found = rk.bifurcation_set(system, 1, grid=2, **bounds)
    turned = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.8),
        amplitude=np.linspace(2, 14, 3),
        period=np.linspace(1.2, 2.6, 3),
    ).dataset
    ax = rk.plot.parametric_map(turned)
    keys = [text.get_text() for text in ax.get_legend().get_texts()]
    rk.plot.bifurcation_set(found, ax)
    both = [text.get_text() for text in ax.get_legend().get_texts()]
    assert both[: len(keys)] == keys
    assert "symmetry breaking" in both
    other = rk.plot.section(rk.simulate(system, cycles=3))
    with pytest.raises(ValueError, match="^ax must show period .* and amplitude"):
        rk.plot.bifurcation_set(found, other)


@pytest.mark.parametrize("block", [None, rk.Block(2.0, 0.5)])
def test_legend_over_a_map_fits_the_figure_also_with_small_shares(block):
    """One point of 3,600 has a share of 0.03 %, whose name is long."""
    system, _, bounds = SYSTEMS["e 0.8"]
    plane = {name: np.linspace(*ends, 60) for name, ends in bounds.items()}
    found = rk.parametric_map(system, **plane, max_cycles=1).dataset
    found.kind[:], found.response_period[:], found.symmetric[:] = rk.Kind.PERIODIC.code, 1, 0
    found.response_period[0, 0] = 3  # the two longest names, side by side
    check_legend(rk.plot.parametric_map(found, block=block))
    for column, period in enumerate((3, 4, 5)):
        found.response_period[0, column] = period
    for column, kind in enumerate((rk.Kind.QUASI_PERIODIC, rk.Kind.CHAOTIC, rk.Kind.UNDETERMINED), start=3):
        found.kind[0, column] = kind.code
    ax = rk.plot.parametric_map(found, block=block)
    rk.plot.bifurcation_set(rk.bifurcation_set(system, 1, grid=3, **bounds), ax, block)
    assert "undetermined (0.03 %)" in [text.get_text() for text in ax.get_legend().get_texts()]
    check_legend(ax)


def check_legend(ax):
    """It lies within the figure, and the axes fill three quarters of the width."""
    ax.figure.draw_without_rendering()
    legend, figure = ax.get_legend().get_window_extent(), ax.figure.bbox
    assert figure.x0 <= legend.x0
    assert legend.x1 <= figure.x1
    assert figure.y0 <= legend.y0
    assert ax.get_window_extent().width > 0.75 * figure.width


def test_picture_shows_each_curve_and_marks_points_of_codimension_two():
    braced = rk.System(rk.Harmonic(1.19, period=4.2), 0.68, rk.Braces(0.37, 0.81))
    found = rk.bifurcation_set(braced, 1, grid=3, period=(3.0, 5.5), amplitude=(0.8, 2.5))
    ax = rk.plot.bifurcation_set(found)
    drawn = [line for line in ax.lines if line.get_gid() != "codimension-2"]
    assert [line.get_gid() for line in drawn] == [curve.kind for curve in found.curves]
    marks = [line for line in ax.lines if line.get_gid() == "codimension-2"]
    marked = [
        (line.get_marker(), *values)
        for line in marks
        for values in zip(line.get_xdata(), line.get_ydata(), strict=True)
    ]
    points = [point for curve in found.curves for point in curve.special]
    of_kinds = {
        "cusp": "D",
        "degenerate-period-doubling": "*",
        "degenerate-symmetry-breaking": "P",
    }
    assert sorted(marked) == sorted((of_kinds.get(point.kind, "o"), *point.values) for point in points)
    assert {marker for marker, *_ in marked} == {"D", "*", "P", "o"}
    ends = sum(end == "grazing" for curve in found.curves for end in curve.ends)
    assert 0 < ends <= sum(point.kind.endswith("-grazing") for point in points)


def test_dataset_holds_points_of_codimension_two_of_every_curve():
    braced = rk.System(rk.Harmonic(1.19, period=4.2), 0.68, rk.Braces(0.37, 0.81))
    found = rk.bifurcation_set(braced, 1, grid=2, period=(3.0, 5.5), amplitude=(0.8, 2.5))
    data = found.to_xarray()
    points = [(number, point) for number, curve in enumerate(found.curves) for point in curve.special]
    assert data.special_curve.values.tolist() == [number for number, _ in points]
    assert data.special_kind.values.tolist() == [point.kind for _, point in points]
    assert data.special_amplitude.values.tolist() == [point.values[1] for _, point in points]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda s: rk.bifurcation_set(s, 1, period=(1, 2)),
            "ranges must hold the ranges of two different parameters",
        ),
        (
            lambda s: rk.bifurcation_set(s, 1, period=(1, 2), frequency=(3, 6)),
            "ranges must hold the ranges of two different parameters.*; got 'period, frequency'",
        ),
        (lambda s: rk.bifurcation_set(s, 1, period=(1, 2), phase=(0, 1)), "ranges must be"),
        (lambda s: rk.bifurcation_set(s, 1, period=(2, 1), amplitude=(1, 2)), "period must be"),
        (lambda s: rk.bifurcation_set(s, 0, period=(1, 2), amplitude=(1, 2)), "max_period must be"),
        (lambda s: rk.bifurcation_set(s, 1, grid=0, period=(1, 2), amplitude=(1, 2)), "grid must be"),
        (lambda s: rk.bifurcation_set(3, 1, period=(1, 2), amplitude=(1, 2)), "system must be a System"),
        (
            lambda s: rk.bifurcation_set(
                rk.System(s.forcing, 0.9, critical_angle=0.2), 1, period=(1, 2), amplitude=(1, 2)
            ),
            "critical_angle must be None",
        ),
        (
            lambda s: rk.bifurcation_set(
                rk.System(rk.Pulse("one-sine", amplitude=2, duration=1), 0.9),
                1,
                period=(1, 2),
                amplitude=(1, 2),
            ),
            "system must have a periodic base motion",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises((TypeError, ValueError), match=message) as raised:
        call(SYSTEMS["e 0.8"][0])
    assert "\n" not in str(raised.value)
