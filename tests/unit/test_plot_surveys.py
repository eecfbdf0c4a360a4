"""Figures of surveys: one colour per attractor, thresholds of the theory, intervals."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb

import rocking as rk
from drawn import artist, legend
from rocking.model.record_results import OverturningSet
from rocking.model.text import percent
from rocking.plot.state_surveys import colours

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), 0.925)
STARTS = np.linspace(-1, 1, 31)


@pytest.fixture(scope="module")
def basins():
    return rk.basin_map(SYSTEM, angle=STARTS, velocity=STARTS, boundary_runs=0)


@pytest.fixture(scope="module")
def curve():
    return rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
        period=[1.2, 1.7, 2.2],
        amplitude=np.linspace(1, 6, 21),
        phases=2,
    )


def test_each_start_has_the_colour_of_its_attractor(basins):
    mesh = artist(rk.plot.basins(basins), "basins")
    mesh.update_scalarmappable()
    shown = mesh.get_facecolors()[:, :3].reshape(31, 31, 3)
    hues = np.array([to_rgb(hue) for hue in colours(basins.attractors)])
    assert np.abs(shown - hues[basins.dataset.attractor.transpose("velocity", "angle").values]).max() < 1e-6


def test_colours_of_attractors_differ_however_many_there_are(basins):
    periodic = next(each for each in basins.attractors if each.kind == "periodic")
    assert len(set(colours((periodic,) * 16))) == 16


def test_a_legend_tells_names_and_shares(basins):
    texts = legend(rk.plot.basins(basins))
    pairs = zip(basins.attractors, basins.fractions, strict=True)
    assert texts == [f"{each.name} ({percent(share.value)})" for each, share in pairs]


def test_all_is_a_hundred_percent():
    near = {"angle": np.linspace(0.1, 0.11, 4), "velocity": np.linspace(0.0, 0.01, 4), "boundary_runs": 0}
    one = rk.plot.basins(rk.basin_map(rk.System(rk.Harmonic(2.0, period=1.0), 0.9), **near))
    sure = rk.repeatability_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
        amplitude=[0.5, 0.6],
        period=[0.8, 0.9],
        samples=2,
        max_cycles=100,
    )
    for ax in (one, rk.plot.repeatability_map(sure)):
        (text,) = ax.get_legend().get_texts()
        assert text.get_text().endswith(" (100 %)")


def test_random_starts_are_points():
    found = rk.basin_map(SYSTEM, angle=(-1, 1), velocity=(-1, 1), samples=50, boundary_runs=0)
    assert len(artist(rk.plot.basins(found), "basins").get_offsets()) == 50


def test_a_safe_area_is_drawn_beside_its_thresholds():
    found = rk.safe_basin(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.8), amplitude=[3.0, 4.0, 5.0], samples=200
    )
    ax = rk.plot.safe_basin(found)
    assert artist(ax, "safe").get_ydata() == pytest.approx(100 * found.dataset.safe.values)
    upright = sorted(line.get_xdata()[0] for line in ax.lines if line.get_gid() != "safe")
    assert upright == sorted([found.heteroclinic_amplitude, found.melnikov_amplitude])


def test_an_overturning_curve_lies_over_the_shares(curve):
    ax = rk.plot.overturning(curve)
    assert artist(ax, "lowest").get_ydata() == pytest.approx(curve.dataset.lowest.values, nan_ok=True)
    assert np.asarray(artist(ax, "share").get_array()).ravel() == pytest.approx(
        100 * curve.dataset.overturning_share.values.T.ravel()
    )


def test_shares_of_one_period_are_seen_where_nothing_overturns():
    found = rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=0.3), restitution=0.925), amplitude=[1.0, 2.0], phases=2
    )
    ax = rk.plot.overturning(found)
    assert artist(ax, "share").get_ydata().tolist() == [0.0, 0.0]
    low, high = ax.get_ylim()
    assert low < 0.0
    assert high > 100.0


def test_intervals_of_chaos_are_drawn():
    found = rk.chaos_share(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=1.0), restitution=[0.2, 0.5], samples=30
    )
    ((low, high),) = [
        [segment[:, 1] for segment in bars.get_segments()] for bars in rk.plot.chaos_share(found).collections
    ]
    assert [*low, *high] == pytest.approx(
        100 * np.column_stack([found.dataset.chaotic_low, found.dataset.chaotic_high]).ravel()
    )


def test_points_that_are_not_certain_have_a_colour_of_their_own():
    found = rk.repeatability_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
        amplitude=np.linspace(3, 7, 12),
        period=np.linspace(0.8, 2.0, 12),
        samples=8,
    )
    values = artist(rk.plot.repeatability_map(found), "map").get_array()
    assert np.count_nonzero(np.asarray(values) == len(rk.Kind)) == found.uncertain.count > 0


@pytest.fixture(scope="module")
def levels_that_overturn():
    records = rk.synthetic_ground_motions(3, seed=4)
    return rk.overturning_set(
        records,
        rk.Block(2.0, 0.5),
        np.linspace(0.3, 0.8, 101),
        intensity="pga-g",
        model="slender",
        normalised_by="angle",
    )


def test_bands_are_the_intervals_of_each_record(levels_that_overturn):
    found = levels_that_overturn
    ax = rk.plot.overturning_set(found)
    seen = np.ptp(found.levels) / 400
    for record in range(3):
        boxes = [path.get_extents() for path in artist(ax, f"bands {record}").get_paths()]
        intervals = found.intervals(record)
        assert [box.x0 for box in boxes] == pytest.approx(intervals[:, 0])
        widths = np.maximum(np.ptp(intervals, axis=1), seen)
        assert [box.width for box in boxes] == pytest.approx(widths)
        assert {round((box.y0 + box.y1) / 2) for box in boxes} == {record}
    assert artist(ax, "lowest").get_xdata().tolist() == found.lowest.tolist()
    assert [tick.get_text() for tick in ax.get_yticklabels()] == ["synthetic 1", "synthetic 2", "synthetic 3"]
    assert ax.get_xlim() == (0.3, 0.8)


def test_undecided_switches_are_marked(levels_that_overturn):
    data = levels_that_overturn.dataset.copy(deep=True)
    data.switch_certified.values[:2] = False
    doubtful = OverturningSet(data, levels_that_overturn.records, levels_that_overturn.block)
    marks = artist(rk.plot.overturning_set(doubtful), "undecided")
    assert marks.get_xdata().tolist() == doubtful.switches["level"][:2].tolist()
    assert not any(
        line.get_gid() == "undecided" for line in rk.plot.overturning_set(levels_that_overturn).lines
    )


def test_many_records_are_numbered_and_long_names_are_cut_in_the_middle():
    block, push = rk.Block(2.0, 0.5), [4.0, 4.0]
    many = [rk.GroundMotion(push, step=0.5, name=f"record number {k} of a long series") for k in range(40)]
    few = rk.plot.overturning_set(rk.overturning_set(many[:2], block, [0.1, 2.0], model="slender"))
    assert [tick.get_text() for tick in few.get_yticklabels()] == [
        "0 record … series",
        "1 record … series",
    ]
    ends = [rk.GroundMotion(push, step=0.5, name=f"RSN953_NORTHRIDGE_MUL{k}") for k in ("009", "279")]
    told = rk.plot.overturning_set(
        rk.overturning_set(ends, block, [0.1, 2.0], model="slender")
    ).get_yticklabels()
    assert [tick.get_text() for tick in told] == ["RSN953_NO…E_MUL009", "RSN953_NO…E_MUL279"]
    ax = rk.plot.overturning_set(rk.overturning_set(many, block, [0.1, 2.0], model="slender"))
    assert ax.get_ylabel() == "record"
    assert ax.get_yticks().tolist() == list(range(0, 40, 4))


@pytest.mark.parametrize(
    "intensity, label",
    [
        ("scale", "factor of the ground motion"),
        ("pga", "peak ground acceleration PGA (m/s²)"),
        ("arias", "Arias intensity I_A (m/s)"),
        ("magnitude", "column 'magnitude' of the records"),
    ],
)
def test_axis_of_levels_has_the_name_and_unit_of_the_measure(intensity, label):
    records = rk.RecordSet([rk.GroundMotion([1.0, 1.0], step=0.5)], columns={"magnitude": [6.0]})
    found = rk.overturning_set(records, rk.Block(2.0, 0.5), [0.1, 2.0], intensity=intensity, model="slender")
    assert rk.plot.overturning_set(found).get_xlabel() == label


@pytest.fixture(scope="module")
def one_sine():
    return rk.overturning_spectrum(
        rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), 0.9),
        amplitude=np.linspace(0.5, 9, 40),
        frequency=np.linspace(1, 8, 30),
    ).dataset


def test_colours_are_the_modes_of_overturning(one_sine):
    codes = artist(rk.plot.overturning_spectrum(one_sine), "outcomes").get_array()
    falls, mode = one_sine.outcome.values == 2, one_sine.impacts_since_rest.values
    assert ((codes == 2) == (falls & (mode == 0))).all()
    assert ((codes == 3) == (falls & (mode == 1))).all()
    assert ((codes == 0) == (one_sine.amplitude.values <= 1.0)[:, None]).all()
    assert {2, 3} <= set(codes.ravel().tolist())
    doubtful = one_sine.copy(deep=True)
    doubtful.certified.values[3, 4] = 0
    marked = artist(rk.plot.overturning_spectrum(doubtful), "outcomes").get_array()
    assert np.argwhere(marked == 5).tolist() == [[3, 4]]


def test_several_restitutions_are_refused_and_one_of_them_is_drawn():
    several = rk.overturning_spectrum(
        rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), 1.0),
        amplitude=[1, 2],
        frequency=[1, 2],
        restitution=[0.8, 0.9],
    ).dataset
    with pytest.raises(ValueError, match="result must have one coefficient of restitution"):
        rk.plot.overturning_spectrum(several)
    ax = rk.plot.overturning_spectrum(several.isel(restitution=1))
    assert ax.get_title(loc="right") == "one-sine, e = 0.9"
