"""Motions made of a motion: against independent formulas, with names and changes that state what was done."""

import itertools
import math
import warnings

import attrs
import numpy as np
import pytest
from scipy.linalg import expm

import record_files as write
import rocking as rk
from rocking.model.ground_motion import RecordFile
from rocking.model.stations import stations

STEP = 0.02
SECONDS = STEP * np.arange(600)
SMOOTH = np.sin(2 * np.pi * 1.5 * SECONDS) * np.exp(-(((SECONDS - 4) / 2) ** 2))
FILE = RecordFile("a.v2", "ab" * 32, "CSMIP V2", "channel 1 of 2, 90°", 1.0, 1.0, 0.001, "Town")


def motion(samples=SMOOTH, step=STEP, **more):
    return rk.GroundMotion(samples, step=step, **{"name": "Town", "component": "90°", "file": FILE} | more)


OTHER = motion(np.roll(SMOOTH, 7), component="360°", file=attrs.evolve(FILE, channel="channel 2 of 2, 360°"))


def noise(size, seed=1):
    return np.random.default_rng(seed).normal(size=size)


# Another step.


@pytest.mark.parametrize("parts", [2, 5, 8])
def test_finer_step_that_divides_the_old_one_keeps_the_motion(parts):
    one = motion(noise(60))
    fine = one.resampled(STEP / parts)
    np.testing.assert_array_equal(fine.acceleration[::parts], one.acceleration)
    np.testing.assert_allclose(
        fine.acceleration, np.interp(fine.times, one.times, one.acceleration), atol=1e-14
    )
    assert fine.pgv == pytest.approx(one.pgv, rel=1e-12)
    assert fine.arias_intensity == pytest.approx(one.arias_intensity, rel=1e-12)
    assert fine.duration == pytest.approx(one.duration, rel=1e-14)


def test_coarser_step_keeps_its_samples_exactly():
    np.testing.assert_array_equal(motion().resampled(2 * STEP).acceleration, SMOOTH[::2])


@pytest.mark.parametrize("step", [0.003, 0.013, 0.025])
def test_other_steps_take_values_on_straight_lines_up_to_the_last_multiple(step):
    changed = motion().resampled(step)
    np.testing.assert_allclose(
        changed.acceleration, np.interp(changed.times, SECONDS, SMOOTH), rtol=0, atol=1e-13
    )
    assert 0 <= motion().duration - changed.duration < step


def test_coarser_step_under_which_high_frequencies_would_appear_as_low_ones_is_refused_until_they_are_filtered():
    one = motion(noise(2000))
    with pytest.raises(
        ValueError,
        match=r"step must keep 99.9 % of the energy below half the sampling rate, 12.5 Hz; .* \(filter first: .filtered\(high=6.25\)\)$",
    ):
        one.resampled(0.04)
    assert one.filtered(high=6.25).resampled(0.04).changes == (
        "lowpass 6.25 Hz, Butterworth of order 4, forwards and backwards",
        "resampled from 0.02 s to 0.04 s along straight lines",
    )


# Filters.


@pytest.mark.parametrize(
    ("low", "high", "order"),
    [(None, 8.0, 4), (0.5, None, 2), (0.4, 10.0, 3), (None, 5.0, 1)],
)
def test_filter_halves_the_amplitude_at_its_corners_without_a_shift_of_phase(low, high, order):
    impulse = np.zeros(20001)
    impulse[10000] = 1.0
    filtered = motion(impulse).filtered(low, high, order=order).acceleration
    np.testing.assert_allclose(filtered, filtered[::-1], atol=1e-12)
    times = STEP * (np.arange(20001) - 10000)
    corners = [each for each in (low, high) if each is not None]
    for frequency in corners:
        amplitude = filtered @ np.exp(-2j * np.pi * frequency * times)
        others = [each for each in corners if each != frequency]
        assert amplitude.imag == pytest.approx(0.0, abs=1e-10)
        if not others:
            assert amplitude.real == pytest.approx(0.5, abs=1e-9)
        else:
            assert amplitude.real == pytest.approx(0.5, abs=1e-4)
    # The analogue filter's |H|², at a frequency far below half the sampling rate.
    if len(corners) == 1:
        tested = 0.25
        amplitude = filtered @ np.exp(-2j * np.pi * tested * times)
        ratio = tested / high if low is None else low / tested
        assert amplitude.real == pytest.approx(1 / (1 + ratio ** (2 * order)), rel=5e-3)


def test_filter_takes_the_rest_before_and_after_the_samples_as_zero():
    one = motion()
    rest = np.zeros(5000)
    longer = motion(np.concatenate((rest, SMOOTH, rest))).filtered(0.2, 8.0).acceleration
    np.testing.assert_allclose(one.filtered(0.2, 8.0).acceleration, longer[5000:-5000], atol=2e-4)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ({}, "low must be given, or high: the corners of the filter in Hz; got None"),
        ({"low": 5.0, "high": 2.0}, "low must be below high, 2 Hz; got 5.0"),
        ({"high": 25.0}, "high must lie between 0 and half the sampling rate, 25 Hz; got 25.0"),
        ({"high": 200}, "high must lie between 0 and half the sampling rate, 25 Hz; got 200"),
        ({"low": -1.0}, "low must lie between 0 and half the sampling rate, 25 Hz; got -1.0"),
        ({"low": 1e-5}, "low must be at least 3e-05 Hz; got 1e-05"),
        ({"high": 5.0, "order": 0}, "order must"),
        ({"high": "5"}, "high must"),
    ],
)
def test_wrong_filters_are_refused(arguments, expected):
    with pytest.raises((TypeError, ValueError)) as caught:
        motion().filtered(**arguments)
    assert str(caught.value).startswith(expected)


# Floors.


def by_matrix_exponential(samples, step, period, damping, more):
    """Absolute acceleration of the oscillator, from the exponential of state, acceleration and slope."""
    omega = 2 * math.pi / period
    system = np.zeros((4, 4))
    system[0, 1], system[1, :3] = 1.0, (-(omega**2), -2 * damping * omega, -1.0)
    system[2, 3] = 1.0
    forward = expm(system * step)
    state, result = np.zeros(2), [0.0]
    for first, second in itertools.pairwise(samples):
        state = (forward @ [*state, first, (second - first) / step])[:2]
        result.append(-(omega**2) * state[0] - 2 * damping * omega * state[1])
    for _ in range(more):
        state = (forward @ [*state, 0.0, 0.0])[:2]
        result.append(-(omega**2) * state[0] - 2 * damping * omega * state[1])
    return np.array(result)


@pytest.mark.parametrize(
    ("period", "damping"), [(0.2, 0.05), (0.5, 0.05), (2.5, 0.2), (0.01, 0.02), (1.0, 0.0), (3.0, 0.9)]
)
def test_floor_is_the_absolute_acceleration_of_an_oscillator_exact_at_the_samples(period, damping):
    one = motion(noise(300))
    floor = one.floor(period, damping)
    more = floor.acceleration.size - 300
    expected = by_matrix_exponential(one.acceleration, STEP, period, damping, more)
    np.testing.assert_allclose(floor.acceleration, expected, rtol=0, atol=1e-10 * np.abs(expected).max())
    assert 0 <= more <= 299


def test_free_vibration_of_a_floor_is_followed_until_it_is_small():
    floor = motion(noise(300)).floor(0.5)
    peak = floor.pga
    assert abs(floor.acceleration[-1]) >= 0.01 * peak
    expected = by_matrix_exponential(noise(300), STEP, 0.5, 0.05, 299)
    after = expected[floor.acceleration.size :]
    assert np.abs(after).max() < 0.01 * peak
    assert motion(noise(300)).floor(0.5, 0.0).acceleration.size == 599


def test_stiff_floor_moves_with_the_ground_and_a_soft_one_rests():
    np.testing.assert_allclose(motion().floor(1e-3).acceleration[:600], SMOOTH, atol=2e-4)
    assert motion().floor(1e3).pga < 1e-3


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [((0.0,), "period must lie in [0.0001, 10000] s"), ((1.0, 1.0), "damping must lie in [0, 0.99]")],
)
def test_wrong_floors_are_refused(arguments, expected):
    with pytest.raises(ValueError, match="^.+$") as caught:
        motion().floor(*arguments)
    assert str(caught.value).startswith(expected)


# Components.


@pytest.mark.parametrize("degrees", [0, 30, 90, -45, 180, 270])
def test_component_at_an_angle_and_its_azimuth(degrees):
    turned = motion().rotated(OTHER, math.radians(degrees))
    expected = math.cos(math.radians(degrees)) * SMOOTH + math.sin(math.radians(degrees)) * OTHER.acceleration
    np.testing.assert_allclose(turned.acceleration, expected, rtol=0, atol=1e-15)
    # From 90° towards 360°, that is anticlockwise.
    assert turned.component == f"{(90 - degrees) % 360}°"
    assert turned.file == FILE


def test_factor_of_both_components_is_kept_and_different_ones_are_stated():
    same = motion().scaled(0.5).rotated(OTHER.scaled(0.5), 1.0)
    assert same.factor == 0.5
    np.testing.assert_allclose(same.acceleration, 0.5 * motion().rotated(OTHER, 1.0).acceleration, rtol=1e-15)
    different = motion().scaled(0.5).rotated(OTHER.scaled(2.0), math.pi / 2)
    np.testing.assert_allclose(different.acceleration, 2 * OTHER.acceleration, atol=1e-15)
    assert different.factor == 1.0
    assert different.changes[0].endswith("factors 0.5 and 2")


def test_changes_state_what_was_done_and_the_file_stays():
    one = motion().scaled(3.0)
    changed = (
        one.clipped(1.0, 9.0)
        .filtered(low=0.2)
        .resampled(0.01)
        .rotated(OTHER.scaled(3.0).clipped(1.0, 9.0).resampled(0.01), math.radians(30))
    )
    changed = changed.floor(0.5).reversed()
    assert changed.changes == (
        "clipped to 1–9 s",
        "highpass 0.2 Hz, Butterworth of order 4, forwards and backwards",
        "resampled from 0.02 s to 0.01 s along straight lines",
        (
            "rotated by 30° towards Town, 360°, a.v2, SHA-256 abababababab…, clipped to 1–9 s,"
            " resampled from 0.02 s to 0.01 s along straight lines"
        ),
        "absolute acceleration of a linear oscillator, period 0.5 s, damping 0.05",
    )
    assert changed.file == FILE
    assert changed.file.pga_agrees
    assert (changed.factor, changed.name, changed.component) == (
        -3.0,
        "Town, floor 0.5 s, damping 0.05",
        "60°",
    )
    assert "rotated by 30°" in repr(changed)
    assert motion().clipped() == motion()


def test_baseline_is_not_removed_again():
    one = motion(SMOOTH + 0.1, baseline="linear")
    assert one.resampled(STEP / 2).baseline == "linear"
    np.testing.assert_array_equal(one.resampled(STEP / 2).acceleration[::2], one.acceleration)


def test_changed_motion_may_have_any_peak():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert motion().floor(1e3).pga < 0.01


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        (motion(SMOOTH[:500], component="360°"), "got 500 samples with a step of 0.02 s (take .clipped(end=9.98) of both)"),
        (motion(step=0.01, component="360°"), "got 600 samples with a step of 0.01 s (take .resampled(0.02) of it)"),
        (motion(component="Up"), "other must be horizontal; got 'Up'"),
        (motion(component="120°"), "other must be perpendicular to 90°; got '120°'"),
        (SMOOTH, "other must be a GroundMotion"),
    ],
)  # fmt: skip
def test_components_that_do_not_fit_are_refused(other, expected):
    with pytest.raises((TypeError, ValueError)) as caught:
        motion().rotated(other, 0.5)
    assert expected in str(caught.value)


def test_angle_is_in_radians():
    with pytest.raises(ValueError, match=r"^angle must lie in \[-6.28319, 6.28319\] rad; got 30$"):
        motion().rotated(OTHER, 30)


# Sets.


def test_stations_are_found_by_file_header_and_name():
    plain = motion(file=None)
    members = [
        motion(),
        OTHER,
        motion(file=attrs.evolve(FILE, sha256="cd" * 32), name="x", component="45°"),
        motion(file=attrs.evolve(FILE, sha256="ef" * 32, station="")),
        plain,
        attrs.evolve(plain, component="360°"),
        attrs.evolve(plain, name="B", component=""),
        attrs.evolve(plain, component="Up"),
        attrs.evolve(plain, component="360°"),
    ]
    assert stations(members) == [[0, 1, 2], [3], [4, 5], [6], [7], [8]]


@pytest.fixture
def folder(tmp_path):
    wave = np.round(SMOOTH, 4)
    first = write.peer(wave)
    other = [line.replace(", 180", ", 270") for line in write.peer(-2 * wave)]
    for name, lines in (("a.AT2", first), ("b.AT2", other)):
        (tmp_path / name).write_text("\n".join(lines))
    (tmp_path / "c.V1").write_text(
        "\n".join(write.csmip_v1([0.3 * wave, 0.2 * wave[:500], wave])).replace("270 Deg", "Up")
    )
    return tmp_path


@pytest.mark.parametrize(
    ("rule", "names"),
    [("first", ("a.AT2, 180", "c.V1, 90°")), ("larger", ("b.AT2, 270", "c.V1, 90°"))],
)
def test_one_component_of_each_station_by_a_rule(folder, rule, names):
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message=".*several horizontal")
        warnings.filterwarnings("ignore", message=".*(vertical channel|each copy counts)")
        records = rk.read_record_set(folder, component=rule)
    assert records.names == names
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert rk.read_record_set(folder).one_per_station(rule).names == names


def test_set_at_angles_has_a_motion_per_station_and_angle(folder):
    table = folder / "set.csv"
    table.write_text("file,magnitude,site\na.AT2,6,1\nb.AT2,6,2\nc.V1,7,3\n")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        records = rk.read_record_set(table)
    turned = records.rotated(np.radians([0, 90]))
    assert turned.names == ("a.AT2, 180°", "a.AT2, 270°", "c.V1, 90°", "c.V1, 180°")
    assert turned.columns["magnitude"].tolist() == [6, 6, 7, 7]
    assert turned.columns["azimuth"].tolist() == [0.0, math.pi / 2] * 2
    assert set(turned.columns) == {"magnitude", "azimuth"}
    np.testing.assert_allclose(turned[1].acceleration, records[1].acceleration, atol=1e-14)
    assert [each.acceleration.size for each in turned] == [600, 600, 500, 500]
    assert turned[2].changes[0] == "clipped to 0–4.99 s"
    single = records.rotated(0.5)
    assert set(single.columns) == {"magnitude"}
    with pytest.raises(
        ValueError,
        match=r"^records must hold two horizontal components of each station; got 1 component: a.AT2",
    ):
        records.one_per_station().rotated(0.0)
    with pytest.raises(ValueError, match="angle must be a number or numbers in a row, in rad"):
        records.rotated([[0.0]])
    with pytest.raises(ValueError, match="component must be one of 'first', 'larger'; got 'all'"):
        records.one_per_station("all")
