"""Spectral densities have the correct level and power; lines are found, refined and named; noise has none."""

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from attrs import evolve
from scipy.integrate import quad
from scipy.signal import get_window, lfilter

import rocking as rk
from rocking.response import spectral_lines
from rocking.response import spectrum as welch

MODE = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
FREE = rk.System(rk.Harmonic(amplitude=0.0, period=1.3), restitution=1.0)


@pytest.fixture(scope="module")
def settled():
    return rk.simulate(MODE, cycles=1_800)


@pytest.fixture(scope="module")
def rocking_freely():
    return rk.simulate(FREE, rk.State(angle=0.5), cycles=1_500)


def signal_of(cycles, samples, tones, mean=0.0):
    time = np.arange(cycles * samples) / samples
    values = sum(a * np.cos(2 * math.pi * f * time + phase) for f, a, phase in tones)
    return (mean + values).reshape(cycles, samples)


def lines_in(values, segment, window="blackmanharris", period=None):
    taper = spectral_lines.Taper(get_window(window, segment * values.shape[1]))
    _, density, segments = welch.welch(values, segment, segment // 2, taper)
    worth = taper.independent(segments, (segment - segment // 2) * values.shape[1])
    return spectral_lines.find_lines(
        values, density, segment, taper, worth, values.shape[1] / 16, period
    ), density


TONES = ((0.1751949705, 0.03, 0.3), (1.0, 0.02, 1.0), (1 / 3, 0.04, -2.0), (math.sqrt(2), 0.001, 0.5))


def test_tones_of_known_frequency_and_amplitude_are_found_and_nothing_else():
    """Four tones, 26 resolutions apart and more: Hann's side lobes fall as 1/k³, so 1e-4 of a resolution for the weakest."""
    found, _ = lines_in(signal_of(2_048, 64, TONES), 256)
    assert len(found) == 4
    by_strength = sorted(TONES, key=lambda tone: -tone[1])
    for line, (frequency, amplitude, _) in zip(found, by_strength, strict=True):
        assert math.isclose(line.frequency, frequency, abs_tol=1e-4 / 2_048)
        assert math.isclose(line.amplitude, amplitude, rel_tol=1e-4)


@pytest.mark.parametrize("cycles", [64, 301, 1_024, 5_000])
@pytest.mark.parametrize("off", [-0.49, 0.0, 0.3])
def test_frequency_of_a_single_tone_is_refined_to_rounding(cycles, off):
    frequency = (round(0.37 * cycles) + off) / cycles
    tone = signal_of(cycles, 32, [(frequency, 0.1, 1.0)])
    found, amplitude = spectral_lines.refined(tone, round(0.37 * cycles) / cycles)
    # the tone's image at −f is 2·0.37·cycles resolutions away: its share falls as the cube of that
    tolerance = 1 / (0.74 * cycles) ** 3
    assert abs(found - frequency) < tolerance / cycles + 1e-14
    assert math.isclose(amplitude, 0.1, rel_tol=2 * tolerance + 1e-12)


@pytest.mark.parametrize("cycles", [64, 1_000, 3_000])
def test_integrals_near_a_frequency_are_those_of_the_record(cycles):
    values = np.random.default_rng(5).standard_normal((cycles, 16))
    near = spectral_lines.Near.of(values, 0.41)
    time = np.arange(values.size) / 16
    offsets = np.array([0.0, 2.3, -3.4]) / cycles
    for offset, found in zip(offsets, near.windowed(offsets), strict=True):
        taper = 1 - np.cos(2 * math.pi * time / cycles)
        direct = (values.ravel() * taper * np.exp(-2j * math.pi * (0.41 + offset) * time)).mean()
        assert abs(found - direct) < 1e-13


def test_lines_closer_than_the_main_lobe_are_not_told_apart_and_farther_ones_are():
    def count(bins):
        return len(lines_in(signal_of(2_048, 32, [(1.0, 1.0, 0.0), (1 + bins / 256, 0.5, 0.0)]), 256)[0])

    assert (count(1), count(10)) == (1, 2)


def test_white_noise_has_its_level_and_no_lines():
    """Variance s² sampled n times a cycle has the one-sided density 2s²/n; the mean over bins errs by 1/√(samples/2)."""
    found = []
    for seed in range(20):
        noise = 0.3 * np.random.default_rng(seed).standard_normal((2_000, 32))
        some, density = lines_in(noise, 250)
        found += some
        error = 5 * math.sqrt(2 / noise.size)
        assert math.isclose(density[10:-10].mean(), 2 * 0.09 / 32, rel_tol=error)
    assert found == []


def test_narrow_resonance_is_no_line(monkeypatch):
    """Noise through a resonance half a bin wide looks like a line in segments, but not over the whole record."""
    damping, turn = 4e-4, 2 * math.pi * 0.61 / 32
    filtered = [1.0, -2 * (1 - damping) * math.cos(turn), (1 - damping) ** 2]
    for seed in range(5):
        noise = np.random.default_rng(seed).standard_normal(4_000 * 32)
        values = lfilter([1.0], filtered, noise).reshape(4_000, 32)
        assert lines_in(values, 250)[0] == []
        with monkeypatch.context() as lax:
            lax.setattr(spectral_lines, "COHERENCE", 0.0)
            assert len(lines_in(values, 250)[0]) >= 1


def test_tone_in_noise_is_a_line_and_alone():
    noise = np.random.default_rng(9).standard_normal((2_000, 32))
    found, _ = lines_in(noise + signal_of(2_000, 32, [(0.7071, 0.2, 1.0)]), 250)
    assert len(found) == 1
    # Rife and Boorstyn 1974: a variance of 6/(SNR N (N² − 1)) radians² a sample; Hann's taper gives 4/3 more deviation
    bound = math.sqrt(6 / (0.2**2 / 2 / 1.0 * noise.size**3)) * 32 / (2 * math.pi)
    assert abs(found[0].frequency - 0.7071) < 6 * bound


def test_segments_worth_are_fewer_the_more_they_overlap():
    """Welch 1967: neighbours under a Hann window that share half have a correlation of 1/6, so 8 are worth 8/(1 + 2·7/8/36)."""
    hann = spectral_lines.Taper(get_window("hann", 1_000))
    assert math.isclose(hann.independent(8, 1_000), 8.0)
    assert math.isclose(hann.independent(8, 500), 8 / (1 + 2 * 7 / 8 / 36), rel_tol=1e-3)


@pytest.mark.parametrize(
    ("window", "lobe", "side_lobes", "bandwidth"),
    [
        ("boxcar", 1, -13.3, 1.0),
        ("hann", 2, -31.5, 1.5),
        ("blackmanharris", 4, -92.0, 2.0),
        ("flattop", 5, -93.0, 3.77),
    ],
)
def test_windows_have_their_known_lobes(window, lobe, side_lobes, bandwidth):
    """Harris 1978, Proc. IEEE 66, 51, table 1; the flat top of SciPy, from its coefficients: 1 + Σ aₖ²/2, and −93 dB."""
    taper = spectral_lines.Taper(get_window(window, 4_096))
    assert taper.lobe == lobe
    assert math.isclose(10 * math.log10(taper.side_lobes), side_lobes, abs_tol=0.2)
    assert math.isclose(taper.bandwidth, bandwidth, abs_tol=0.01)


@pytest.mark.parametrize(
    ("forcing", "rotation", "name"),
    [
        (Fraction(5, 3), 0, "5f/3"),
        (Fraction(1), 0, "f"),
        (Fraction(0), 1, "f_r"),
        (Fraction(-1, 3), 2, "−f/3 + 2f_r"),
        (Fraction(2), -3, "2f − 3f_r"),
        (Fraction(0), 0, "0"),
    ],
)
def test_names_read_as_combinations(forcing, rotation, name):
    assert spectral_lines.Combination(forcing, rotation, 0.0).name == name


def test_simplest_combination_is_named_and_an_ambiguous_one_is_not():
    rotation = (math.sqrt(5) - 1) / 2
    assert spectral_lines.combination(2 - 3 * rotation, 1, rotation, 1e-4).name == "2f − 3f_r"
    assert spectral_lines.combination(0.123456, 1, rotation, 1e-4) is None
    # 3/5: two rotations less a forcing, or one forcing less three rotations more, are nearly the same
    near = 0.6 + 1e-6
    assert spectral_lines.combination(2 * near, 1, near, 1e-4) is None
    assert spectral_lines.combination(2 * near, 1, near, 1e-7).name == "2f_r"


def test_short_records_name_only_what_chance_would_not():
    rotation, line = (math.sqrt(5) - 1) / 2, 7 - 9 * (math.sqrt(5) - 1) / 2
    assert spectral_lines.combination(line, 1, rotation, 1 / 1_000).name == "7f − 9f_r"
    # at 100 cycles ±9 rotations cover 19/50 of all frequencies
    assert spectral_lines.combination(line, 1, rotation, 1 / 100) is None


def test_islands_and_rotation_are_found_from_the_lines():
    third, turn = 1 / 3, 0.1751949705
    telling = [third, turn, 1.0, 2 / 3 - turn, 2 * turn - third, 2 / 3 + turn]
    assert spectral_lines.parts_and_rotation(telling, None, None, 1e-4) == (3, turn)
    assert spectral_lines.parts_and_rotation(telling, None, third - turn, 1e-4) == (3, third - turn)
    # a line that explains only itself is no rotation
    assert spectral_lines.parts_and_rotation([1.0, 0.1237], None, None, 1e-4) == (1, None)


def test_power_of_a_periodic_response_is_its_variance(settled):
    """Parseval: lines on bins, so that the sum over the density is the mean of (Θ − mean)² to rounding."""
    density = rk.spectral_density(settled, transient=600)
    times = (600 + np.arange(3 * 4_096) / 4_096) * 0.4
    variance = settled.at(times)[0].var()
    power = density.density.sum() * density.frequency[1]
    # (Θ²)'' jumps by 2V²(1/e² − 1) at each of 2 impacts in 3 cycles, V = .658; the error of 64 samples a cycle is no more
    # than .0081 h³ of each jump (Euler and Maclaurin)
    jumps = 2 * 2 * 0.658**2 * (1 / 0.925**2 - 1) / (3 * 0.4)
    assert math.isclose(power, variance, abs_tol=0.0081 * (0.4 / 64) ** 3 * jumps)
    assert math.isclose(power, density.variance, rel_tol=1e-12)
    # lines are sought up to 4 forcing frequencies: what lies beyond falls as the cube of that
    assert 0.999_995 < density.line_share < 1


def test_free_rocking_is_odd_multiples_of_its_own_frequency(rocking_freely):
    """A quarter period arccosh 2 at Θ₀ = ½: f_r = 1/(4 arccosh 2), and amplitudes the integrals of 1 − ½ cosh τ."""
    quarter = math.acosh(2.0)
    density = rk.spectral_density(rocking_freely)
    assert density.period is None
    assert math.isclose(density.rotation, 1.3 / (4 * quarter), abs_tol=1e-9)
    assert [peak.name for peak in density.peaks[:4]] == ["f_r", "3f_r", "5f_r", "7f_r"]
    for peak in density.peaks[:4]:
        k = peak.rotation_multiple
        wave = quad(
            lambda t, k=k: (1 - math.cosh(t) / 2) * math.cos(k * math.pi * t / (2 * quarter)), 0, quarter
        )[0]
        assert math.isclose(peak.frequency, k / (4 * quarter), abs_tol=1e-7 * density.resolution * k**3)
        assert math.isclose(peak.amplitude, abs(2 * wave / quarter), rel_tol=1e-6)
        assert abs(peak.offset) < density.resolution


def test_frequencies_are_per_tau_and_in_units_of_the_forcing(settled):
    density = rk.spectral_density(settled, transient=600)
    np.testing.assert_allclose(density.forcing_multiples, density.frequency * 0.4, rtol=1e-15)
    peak = {peak.name: peak for peak in density.peaks}["f"]
    # f/3 stands 800 resolutions off and 1.6 times as high: 1.6/800³ of a resolution
    assert math.isclose(peak.frequency, 2.5, abs_tol=1.6 / 800**3 * 2 * density.resolution)
    place = np.argmin(abs(density.frequency - peak.frequency))
    assert density.density[place] == peak.height
    assert math.isclose(density.resolution, 1 / (1_200 * 0.4))
    assert math.isclose(density.bandwidth, 2.0 / (density.segment * 0.4), rel_tol=0.01)


def test_density_is_that_of_exact_samples_by_the_definition(settled):
    """One segment under a boxcar: 2|∫Θ e^{−iωτ} dτ|²/length, as the sum over the same samples."""
    density = rk.spectral_density(settled, transient=1_650, segment=150, window="boxcar", samples=64)
    times = (1_650 + np.arange(150 * 64) / 64) * 0.4
    angle = settled.at(times)[0]
    for k in (50, 150, 250):
        turns = np.exp(-2j * math.pi * density.frequency[k] * (times - times[0]))
        expected = 2 * abs((angle * turns).sum() * 0.4 / 64) ** 2 / (150 * 0.4)
        assert math.isclose(density.density[k], expected, rel_tol=1e-10)


def test_aliasing_is_measured_and_kept_below_its_level(settled):
    """Velocity jumps: the density falls as f⁻⁴, the power above half the sampling rate as its cube."""
    shares = [rk.spectral_density(settled, transient=600, samples=n).aliased for n in (16, 32, 64, 128)]
    # 8 for lines without end; these are few, and the acceleration jumps too
    assert [a / b for a, b in itertools.pairwise(shares)] == pytest.approx([8, 8, 8], rel=0.2)
    times = (600 + np.arange(3 * 1_024) / 1_024) * 0.4
    angle = settled.at(times)[0]
    power = np.abs(np.fft.rfft(angle - angle.mean())) ** 2
    # a period without window, up to 512 forcing frequencies and not 128: 4⁻³ more, and less is folded
    assert shares[2] == pytest.approx(power[3 * 32 :].sum() / power.sum(), rel=0.1)
    chosen = rk.spectral_density(settled, transient=600)
    assert chosen.aliased < 1e-7
    fine = rk.spectral_density(settled, transient=600, samples=1_024)
    coarse = {peak.name: peak.amplitude for peak in chosen.peaks}
    assert len(coarse) == 6
    for peak in fine.peaks:
        if peak.name in coarse:
            x = peak.frequency * 0.4 / chosen.samples
            folded = (math.pi * x / math.sin(math.pi * x)) ** 2 - 1
            assert coarse[peak.name] == pytest.approx(peak.amplitude, rel=folded)


def test_jerky_motion_is_sampled_more_finely():
    """Bouncing between braces, the velocity jumps by its double: 64 samples a cycle alias 4·10⁻⁵ of the variance."""
    braced = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), 0.925, rk.Braces(angle=1.0))
    motion = rk.simulate(braced, cycles=1_000)
    density = rk.spectral_density(motion)
    assert 64 < density.samples <= 1_024
    assert density.aliased < 1e-7 < rk.spectral_density(motion, samples=density.samples // 2).aliased


def test_in_a_broad_band_no_rotation_is_sought():
    """Four lines that a rotation names, with all of the variance between them or with a third of it."""
    found = [spectral_lines.Line(f, 0.1, 1.0) for f in (1.0, 0.3819, 2 * 0.3819, 1 - 0.3819)]
    carried = 4 * 0.1**2 / 2
    assert welch._parts_and_rotation(found, carried, None, None, 1e-3) == (1, 0.3819)
    assert welch._parts_and_rotation(found, 3 * carried, None, None, 1e-3) == (1, None)


def test_segment_overlap_window_and_samples_are_used_and_told(settled):
    density = rk.spectral_density(settled, 600, segment=300, overlap=0.75, window="hann", samples=32)
    assert (density.segment, density.overlap, density.segments) == (300, 225, 13)
    assert (density.window, density.samples, density.cycles, density.transient) == ("hann", 32, 1_200, 600)
    assert len(density.frequency) == 300 * 32 // 2 + 1
    text = str(density)
    for part in (
        "13 segments of 300 cycles overlapping by 225",
        "window hann",
        "32 samples per cycle",
        "aliased",
    ):
        assert part in text
    assert text.startswith("lines: ")


def test_window_with_a_flat_top_shows_the_same_lines(settled):
    """Its main lobe rises a little off its middle, which is no end of it."""
    flat, usual = (
        rk.spectral_density(settled, 600, window=window) for window in ("flattop", "blackmanharris")
    )
    assert not flat.broad_band
    assert [peak.name for peak in flat.peaks] == [peak.name for peak in usual.peaks]


def test_one_segment_and_one_line_are_told_in_the_singular(settled):
    assert "; 1 segment of 1200 cycles, window" in str(rk.spectral_density(settled, 600, segment=1_200))
    many = rk.spectral_density(settled, transient=600)
    told = str(evolve(many, peaks=many.peaks[:1]))
    assert ": 1 line (f/3; 0 unnamed) carries " in told


def test_period_is_found_by_recurrence_and_only_where_the_motion_repeats(settled, rocking_freely):
    assert rk.spectral_density(settled, transient=600).period == 3
    assert rk.spectral_density(settled, transient=0).period is None
    assert rk.spectral_density(rocking_freely).period is None


def test_unsymmetric_response_has_even_multiples_too():
    system = rk.System(rk.Harmonic(amplitude=5.5, period=0.5, phase=1.8), restitution=0.925)
    density = rk.spectral_density(rk.simulate(system, rk.State(velocity=0.15), cycles=2_000), transient=1_000)
    assert (density.period, density.symmetric) == (10, False)
    tenths = {10 * peak.forcing_multiple for peak in density.peaks}
    assert {1, 2, 3, 4, 5, 6} <= tenths


def test_name_may_use_a_rotation_that_is_given(rocking_freely):
    third = rk.spectral_density(rocking_freely).rotation / 3
    density = rk.spectral_density(rocking_freely, rotation=third)
    assert [peak.rotation_multiple for peak in density.peaks[:3]] == [3, 9, 15]
    assert density.rotation == third


def test_arrays_cannot_be_changed(settled):
    with pytest.raises(ValueError, match="read-only"):
        rk.spectral_density(settled, transient=600).density[0] = 1.0


@pytest.mark.parametrize(
    ("how", "message"),
    [
        ({"motion": 3}, "^motion must be a Motion; got 3$"),
        ({"transient": 1_800}, r"^transient must be a whole number in \[0, 1799\]; got 1800$"),
        (
            {"segment": 100, "transient": 600},
            "^segment must be a multiple of the response period of 3 cycles, at least 24; got 100$",
        ),
        ({"segment": 1_201, "transient": 600}, r"^segment must be a whole number in \[8, 1200\]; got 1201$"),
        ({"overlap": 1.0}, r"^overlap must lie in \[0, 0.95\]; got 1.0$"),
        ({"window": "hamn"}, "^window must be a window of scipy.signal.get_window; got 'hamn'$"),
        ({"window": ("gaussian", 0)}, r"^window must have finite weights; got \('gaussian', 0\)$"),
        (
            {"window": ("exponential", None, 10)},
            r"^window must have side lobes below a tenth of its main lobe; got \('exponential', None, 10\)$",
        ),
        ({"window": None}, "^window must be a window of scipy.signal.get_window; got None$"),
        ({"transient": math.nan}, r"^transient must be a whole number in \[0, 1799\]; got nan$"),
        ({"samples": 33}, "^samples must be even; got 33$"),
        ({"samples": 8}, r"^samples must be a whole number in \[16, 4096\]; got 8$"),
        ({"period": 0}, r"^period must be a whole number in \[1, 1800\]; got 0$"),
        ({"rotation": -1.0}, r"^rotation must lie in \[1e-06, 1000\]; got -1.0$"),
    ],
)
def test_argument_outside_its_range_is_refused_in_one_line(settled, how, message):
    with pytest.raises((TypeError, ValueError), match=message):
        rk.spectral_density(**{"motion": settled, **how})


def test_motion_without_a_spectrum_is_refused_in_one_line():
    falling = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
    still = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    balanced = rk.System(rk.Harmonic(amplitude=0.0, period=1.0), restitution=0.9)
    for motion, message in (
        (rk.simulate(falling), "^motion must not overturn for a spectrum; it overturned in cycle 5$"),
        (rk.simulate(still), "^motion must not come to rest for a spectrum; it is at rest at its end$"),
        (
            rk.simulate(balanced, rk.State(angle=1.0)),
            "^motion must move for a spectrum; its angle is 1 throughout$",
        ),
        (rk.simulate(MODE, record="section"), "^record must be 'all' for events, .+ got 'section'$"),
    ):
        with pytest.raises(ValueError, match=message):
            rk.spectral_density(motion)


def test_short_motion_is_refused_with_what_it_needs(settled):
    with pytest.raises(ValueError, match="^motion must last 64 cycles after its transient .+ it lasts 50"):
        rk.spectral_density(rk.simulate(MODE, cycles=50))
    with pytest.raises(ValueError, match="^motion must last 192 cycles .+ of period 3; it lasts 100"):
        rk.spectral_density(settled, transient=1_700)


def test_memory_has_a_limit_that_is_told():
    long = rk.simulate(FREE, rk.State(angle=0.5), cycles=5_000)
    with pytest.raises(
        ValueError, match="^motion must have at most 4096 cycles .+ 4096 samples in each; got 5000$"
    ):
        rk.spectral_density(long, samples=4_096)
