"""Orbit diagrams against plain runs, and against a known period-doubling cascade."""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import rocking as rk
from rocking.model.progress import Bar
from rocking.orbits import sweeps
from stored_surveys import files

CASCADE = rk.System(rk.Harmonic(amplitude=10.0, period=1.721328), restitution=0.8)
MILD = rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)
BRACED = rk.System(rk.Harmonic(amplitude=6.0, period=2.0), 0.925, rk.Braces(angle=1.0, restitution=0.6))


def with_value(system, name, value):
    """Return the system with one parameter changed, written out."""
    forcing, braces = system.forcing, system.braces
    asked = {"amplitude": forcing.amplitude, "phase": forcing.phase, "period": forcing.period}
    asked |= {"restitution": system.restitution, name: value}
    if name == "frequency":
        asked["period"] = 2 * math.pi / value
    if braces is not None:
        braces = rk.Braces(
            asked.get("brace_angle", braces.angle), asked.get("brace_restitution", braces.restitution)
        )
    forcing = rk.Harmonic(asked["amplitude"], period=asked["period"], phase=asked["phase"])
    return rk.System(forcing, asked["restitution"], braces)


def one(system, start, transient, cycles, section_phase):
    """Return section points (None if it overturned), peak and final state by two plain runs."""
    if transient:
        start = rk.simulate(system, start, transient, record="none")
        if start.outcome == "overturned":
            return None, math.nan, None
        start = start.final
    motion = rk.simulate(system, start, cycles)
    if motion.outcome == "overturned":
        return None, math.nan, None
    return motion.section(section_phase)[:cycles], motion.peak, motion.final


def distinct(points):
    """Count the different points of each value."""
    return [len(np.unique(rows[:, 0].round(7))) for rows in points]


def differ(points, other):
    return np.abs(points - other).max()


@pytest.mark.parametrize("way", ["up", "down"])
def test_sweep_is_one_plain_run_after_another(way):
    """Up to where the motion is chaotic differences grow by no more than a hundredfold: 1e-12."""
    values = [7.0, 8.0, 9.5, 10.5, 10.6, 10.7]
    diagram = rk.orbit_diagram(CASCADE, amplitude=values, sweep=way, transient=30, cycles=20)
    state, order = rk.State(), range(6) if way == "up" else range(5, -1, -1)
    for k in order:
        points, peak, state = one(with_value(CASCADE, "amplitude", values[k]), state, 30, 20, 0.0)
        assert differ(diagram.points[0, k], points) < 1e-12
        assert diagram.peak[0, k] == pytest.approx(peak, abs=1e-12)
    assert not diagram.overturned.any()


def test_both_ways_are_the_two_sweeps():
    values = np.linspace(7.0, 10.9, 14)
    both = rk.orbit_diagram(CASCADE, amplitude=values, transient=50, cycles=9)
    for row, way in enumerate(both.sweeps):
        alone = rk.orbit_diagram(CASCADE, amplitude=values[::-1], sweep=way, transient=50, cycles=9)
        np.testing.assert_array_equal(both.points[row], alone.points[0])
        np.testing.assert_array_equal(both.overturned[row], alone.overturned[0])
    assert both.sweeps == ("up", "down")


@pytest.mark.parametrize(
    "system, name, values",
    [
        (CASCADE, "amplitude", [0.5, 5.0, 9.0]),
        (CASCADE, "period", [1.5, 1.6, 1.7]),
        (CASCADE, "frequency", [3.7, 3.9, 4.1]),
        (MILD, "phase", [-7.0, 0.3, 2.0]),
        (CASCADE, "restitution", [0.0, 0.5, 0.75]),
        (BRACED, "brace_angle", [0.5, 0.7, 2.0]),
        (BRACED, "brace_restitution", [0.0, 0.3, 0.9]),
    ],
)
def test_motions_of_their_own_are_plain_runs_for_every_parameter(system, name, values):
    """A few cycles, so that even between braces no difference of rounding grows beyond 1e-9."""
    start = rk.State(0.2, -0.1)
    diagram = rk.orbit_diagram(
        system, start, **{name: values}, sweep="rest", transient=3, cycles=5, section_phase=0.7
    )
    for k, value in enumerate(values):
        points, peak, _ = one(with_value(system, name, value), start, 3, 5, 0.7)
        assert bool(diagram.overturned[0, k]) == (points is None)
        if points is not None:
            assert differ(diagram.points[0, k], points) < 1e-9
            assert diagram.peak[0, k] == pytest.approx(peak, abs=1e-9)
    assert not diagram.overturned.all()


def test_overturned_motion_leaves_no_points_and_the_next_begins_where_it_began():
    values = [10.0, 11.2, 11.5, 10.5]
    diagram = rk.orbit_diagram(CASCADE, amplitude=values, sweep="down", transient=40, cycles=6)
    assert diagram.values.tolist() == sorted(values)
    assert diagram.overturned.tolist() == [[False, False, True, True]]
    assert np.isnan(diagram.points[0, 2:]).all()
    assert np.isnan(diagram.peak[0, 2:]).all()
    points, _, state = one(with_value(CASCADE, "amplitude", 10.5), rk.State(), 40, 6, 0.0)
    assert differ(diagram.points[0, 1], points) < 1e-12
    points, _, _ = one(with_value(CASCADE, "amplitude", 10.0), state, 40, 6, 0.0)
    assert differ(diagram.points[0, 0], points) < 1e-12


def test_overturning_after_the_transient_counts_too():
    falling = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
    after = rk.simulate(falling).overturning.cycle
    diagram = rk.orbit_diagram(falling, amplitude=[1.75], sweep="rest", transient=after - 1, cycles=3)
    assert diagram.overturned.all()
    assert str(diagram).endswith("each from the initial state, overturned at 1.75")
    shorter = rk.orbit_diagram(falling, amplitude=[1.75], sweep="rest", transient=after - 3, cycles=2)
    assert not shorter.overturned.any()


def test_braces_that_come_nearer_push_the_block_back_to_them():
    values, start = [0.3, 2.0], rk.State()
    wide = with_value(BRACED, "brace_angle", 2.0)
    _, _, state = one(wide, start, 0, 7, 0.0)
    assert abs(state.angle) > 0.3
    pushed = rk.State(math.copysign(0.3, state.angle), state.velocity)
    points, _, _ = one(with_value(BRACED, "brace_angle", 0.3), pushed, 0, 7, 0.0)
    diagram = rk.orbit_diagram(BRACED, brace_angle=values, sweep="down", transient=0, cycles=7)
    assert differ(diagram.points[0, 0], points) < 1e-9


def test_at_rest_every_point_is_the_origin():
    diagram = rk.orbit_diagram(CASCADE, amplitude=[0.0, 0.9], sweep="rest", transient=2, cycles=4)
    assert not diagram.points.any()
    assert not diagram.peak.any()


def test_cascade_doubles_turns_chaotic_and_overturns():
    """Periods as the exact multipliers of the branch have them: doublings near 10.473, 10.69, 10.725; the end near 10.75."""
    values = [7.3, 7.4, 10.46, 10.48, 10.68, 10.70, 10.72, 10.727, 10.74, 10.76]
    diagram = rk.orbit_diagram(CASCADE, amplitude=values, sweep="up", transient=5000, cycles=256)
    assert diagram.overturned.tolist() == [[False] * 9 + [True]]
    assert distinct(diagram.points[0, :8]) == [1, 1, 1, 2, 2, 4, 4, 8]
    assert distinct(diagram.points[0, 8:9])[0] > 200


def test_two_sweeps_may_follow_the_two_mirror_images_born_at_symmetry_breaking():
    """Below A_SB = 7.3332 one symmetric orbit, above it two: (Θ, Θ') of the one half a period on is −(Θ, Θ') of the other."""
    tilted = rk.State(0.2, 0.0)
    both = [
        rk.orbit_diagram(
            CASCADE,
            start,
            amplitude=[7.32, 7.35],
            sweep="rest",
            transient=30_000,
            cycles=1,
            section_phase=phase,
        )
        for start, phase in ((rk.State(), 0.0), (tilted, 0.0), (rk.State(), math.pi), (tilted, math.pi))
    ]
    here, there, later, later_there = (one.points[0, :, 0] for one in both)
    assert differ(here[0], there[0]) < 1e-9
    assert differ(here[0], -later[0]) < 1e-9
    assert differ(here[1], -later[1]) > 1e-2
    assert differ(here[1], there[1]) < 1e-9 or differ(here[1], -later_there[1]) < 1e-9


def test_orbit_of_period_three_doubles_into_chaos_beside_it():
    values = [10.04, 10.06, 10.08, 10.088, 10.097, 10.103, 10.12]
    diagram = rk.orbit_diagram(CASCADE, amplitude=values, sweep="rest", transient=5000, cycles=256)
    counts = distinct(diagram.points[0])
    assert counts[:5] + counts[6:] == [1, 3, 3, 6, 12, 1]
    assert counts[5] > 200


def test_dataset_names_everything_and_comes_back_from_a_file(tmp_path):
    import xarray as xr

    diagram = rk.orbit_diagram(BRACED, brace_angle=[0.5, 1.0], transient=5, cycles=3)
    diagram.to_xarray().to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "a.nc") as read:
        assert read["angle"].dims == ("sweep", "brace_angle", "cycle")
        np.testing.assert_array_equal(read["velocity"], diagram.points[..., 1])
        np.testing.assert_array_equal(read["overturned"], diagram.overturned)
        assert read["sweep"].values.tolist() == ["up", "down"]
        assert read.attrs["brace_restitution"] == 0.6
        assert "brace_angle" not in read.attrs


def test_progress_counts_every_value_of_every_sweep(monkeypatch):
    done = []
    monkeypatch.setattr(Bar, "advance", lambda bar, count, before: done.append(count))
    for sweep, times in (("both", 2), ("rest", 1)):
        done.clear()
        amplitudes = np.linspace(2, 5, 37)
        rk.orbit_diagram(CASCADE, amplitude=amplitudes, sweep=sweep, transient=100_000, cycles=1)
        assert sum(done) == 37 * times
        assert len(done) > 1


@pytest.mark.parametrize(
    "change, error, message",
    [
        (dict(system=3), TypeError, "system must be a System; got 3"),
        (dict(amplitude=None), TypeError, "give exactly one of amplitude, period, .*; got none"),
        (dict(amplitude=[]), ValueError, r"amplitude must hold one number or more; got \[\]"),
        (
            dict(amplitude=[1.0, math.nan]),
            ValueError,
            r"amplitude must hold finite numbers; got \[1.0, nan\]",
        ),
        (
            dict(amplitude=[[1.0, 2.0]]),
            ValueError,
            r"amplitude must be a number or an array \(n,\); got an array of shape \(1, 2\)",
        ),
        (dict(amplitude=["a"]), TypeError, "amplitude must be a real number or an array"),
        (dict(amplitude=[1.0, -1.0]), ValueError, r"amplitude must lie in \[0, 1000\]; got -1.0"),
        (dict(amplitude=None, restitution=[1.5]), ValueError, r"restitution must lie in \[0, 1\]"),
        (
            dict(amplitude=None, brace_restitution=[0.5]),
            TypeError,
            r"brace_restitution must be used with a braced system \(give it braces=rk.Braces\(angle=1.0\)\)",
        ),
        (dict(sweep="round"), ValueError, "sweep must be one of 'up', 'down', 'both', 'rest'; got 'round'"),
        (dict(transient=-1), ValueError, "transient must be a whole number"),
        (dict(cycles=2**25), ValueError, r"cycles must be a whole number in \[1, 16777216\]"),
        (dict(start=rk.State(2e3)), ValueError, "angle must lie in"),
        (dict(section_phase=math.inf), ValueError, "section_phase must lie in"),
    ],
)
def test_refusals_are_one_line(change, error, message):
    given = dict(system=CASCADE, amplitude=[1.0]) | change
    with pytest.raises(error, match=f"^{message}") as refused:
        rk.orbit_diagram(**given)
    assert "\n" not in str(refused.value)


PARTS = {"amplitude": np.linspace(8.0, 11.5, 150), "transient": 100, "cycles": 4, "section_phase": 0.7}
"""Values of three parts of 57 values at most with `parted`; some motions overturn."""


@pytest.fixture
def parted(monkeypatch):
    """Parts of 6,000 cycles."""
    monkeypatch.setattr(sweeps, "BREATH", 6_000)


@pytest.mark.parametrize("sweep", ["up", "down", "both", "rest"])
def test_diagram_in_parts_of_a_store_has_the_bits_of_the_one_in_memory(sweep, tmp_path, parted, monkeypatch):
    given = PARTS | {"sweep": sweep}
    with monkeypatch.context() as patch:
        patch.setattr(sweeps, "BREATH", 10**9)
        plain = rk.orbit_diagram(CASCADE, rk.State(0.1, 0.2), **given)
    monkeypatch.setattr(
        sweeps, "TASKS", 1
    )  # the parts of independent motions are as small as those of a sweep
    stored, read = (rk.orbit_diagram(CASCADE, rk.State(0.1, 0.2), **given, store=tmp_path) for _ in range(2))
    monkeypatch.setattr(sweeps, "TASKS", 8)
    with ThreadPoolExecutor(3) as threads:
        computed = rk.orbit_diagram(CASCADE, rk.State(0.1, 0.2), **given, executor=threads)
    assert plain.overturned.any()
    for other in (stored, read, computed):
        assert other.to_xarray().identical(plain.to_xarray())
    assert len(list(tmp_path.glob("part-*"))) == 3


def test_store_of_many_long_motions_has_no_more_parts_than_allowed(tmp_path, parted, monkeypatch):
    monkeypatch.setattr(sweeps, "MAX_PARTS", 2)
    diagram = rk.orbit_diagram(CASCADE, **PARTS, store=tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["part-0", "part-1"]
    assert diagram.to_xarray().identical(rk.orbit_diagram(CASCADE, **PARTS).to_xarray())


@pytest.mark.parametrize(
    ("changed", "differs"),
    [
        ({"transient": 99}, "transient is 100 there and 99 here"),
        ({"cycles": 5}, "cycles is 4 there and 5 here"),
        ({"section_phase": 0.0}, "section_phase is 0.7 there and 0 here"),
        ({"sweep": "up"}, "sweep is 'both' there and 'up' here"),
        ({"start": rk.State(0.1)}, r"states is \[\[0.0, 0.0\], .*\] there and \[\[0.1, 0.0\], .*\] here"),
        ({"amplitude": PARTS["amplitude"] + 1e-12}, r"the values of the parameter are others \("),
        ({"amplitude": PARTS["amplitude"][:-1]}, r"the values of the parameter are others \("),
        ({"system": with_value(CASCADE, "restitution", 0.7)}, "restitution is 0.8 there and 0.7 here"),
    ],
)
def test_other_diagram_is_refused_and_leaves_the_store_as_it_was(tmp_path, parted, changed, differs):
    diagram = {"system": CASCADE, "store": tmp_path} | PARTS
    rk.orbit_diagram(**diagram)
    before = files(tmp_path)
    with pytest.raises(ValueError, match=f"holds a different survey: {differs}"):
        rk.orbit_diagram(**diagram | changed)
    assert files(tmp_path) == before


def test_folder_of_something_else_is_no_store_of_a_diagram(tmp_path):
    rk.find_orbits(MILD, 1, effort=0.01, store=tmp_path)
    with pytest.raises(OSError, match=r"a folder that contains 'round-0'"):
        rk.orbit_diagram(MILD, amplitude=[5.0, 5.5], store=tmp_path)


def test_long_diagram_with_a_store_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"^cycles must be a whole number in \[1, 1000000\]"):
        rk.orbit_diagram(CASCADE, amplitude=8.0, cycles=1_000_001, store=tmp_path)
