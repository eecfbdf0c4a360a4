"""Rocking spectra: each point ends as `simulate` says, on any executor, in memory and in a store."""

import math
import re
import signal
import subprocess
import sys
import time
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.motion import march_loop
from rocking.motion.march_loop import tables_for
from rocking.survey.ending_measures import VARIABLES, ending, runs_of_equal_tables, sampled
from rocking.survey.measurement import batches
from rocking.survey.spec import Left, motion_spec
from rocking.survey.tiling import finest, levels

GRAVITY = 9.80665
OUTCOMES = tuple(rk.Outcome)
RECORDS = rk.RecordSet(rk.synthetic_ground_motions(2, seed=3, duration=6.0))
ASKED = {
    "size": np.linspace(0.2, 4.0, 150),
    "slenderness": [0.1, 0.2, 0.3],
    "levels": 0.4,
    "intensity": "pga-g",
}
RUN = """
import sys
import numpy as np
import rocking as rk

records = rk.synthetic_ground_motions(2, seed=3, duration=6.0)
asked = dict(size=np.linspace(0.2, 4.0, 150), slenderness=[0.1, 0.2, 0.3], levels=0.4, intensity="pga-g")
asked["levels"] = np.linspace(0.3, 0.5, 3000)  # thousands of times as many runs
print("running", flush=True)
rk.rocking_spectrum(records, **asked, store=sys.argv[1])
"""

# Most blocks do not move, so that millions of points take seconds.
PEAK_MEMORY = """
import resource, sys
import numpy as np
import rocking as rk

sizes, scales = np.linspace(0.5, 4.0, int(sys.argv[2])), np.linspace(0.5, 1.02, int(sys.argv[3]))
rk.rocking_spectrum(
    rk.synthetic_ground_motions(100, seed=1, duration=2.0),
    size=sizes, slenderness=0.2, levels=scales, intensity="pga-ratio", store=sys.argv[1],
)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def files(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def records_of(seed):
    """Synthetic motions, the strong motion of the example, and steps that jump at both ends."""
    strong = rk.example_ground_motion().clipped(5.0, 20.0)
    steps = rk.GroundMotion([2.0, -3.0, 1.0, 4.0, -2.0, -2.0], step=0.15)
    return rk.RecordSet([*rk.synthetic_ground_motions(2, seed=seed, duration=8.0), strong, steps])


def peak_of(motion):
    return math.inf if motion.outcome == "overturned" else motion.peak


def rounding_of_peak(block, ground, start):
    """Spread of the peak over factors that differ by units of the last place, as those of the two computations do."""
    peaks = [
        peak_of(rk.simulate(block.system(ground.scaled(1.0 + k * 2.0**-52), model="slender"), start))
        for k in range(-2, 3)
    ]
    return max(peaks) - min(peaks)


def differing(count, seed):
    """Compare random points with `simulate`: return the certified points that differ, and their number.

    A peak may differ by 1e-9, or by the effect of rounding if that is more: the certificate is that of the outcome.
    """
    random, records = np.random.default_rng(seed), records_of(seed)
    given = {
        "size": np.sort(random.uniform(0.1, 6.0, 12)),
        "slenderness": np.sort(random.uniform(0.05, 0.5, 5)),
        "restitution": np.sort(random.uniform(0.4, 0.98, 3)),
        "levels": np.sort(random.uniform(1.05, 4.0, 6)),
        "angle": np.array([-0.3, 0.0, 0.6]),
        "polarity": np.array([-1.0, 1.0]),
    }
    found = rk.rocking_spectrum(records, **given, intensity="pga-ratio", model="slender").dataset
    wrong, certified = [], 0
    for flat in random.choice(found.outcome.size, count, replace=False):
        index = np.unravel_index(flat, found.outcome.shape)
        at = {name: float(found[name].values[k]) for name, k in zip(found.outcome.dims, index, strict=True)}
        row = {name: found[name].values[index] for name in found.data_vars}
        size, slenderness, start = at["size"], at["slenderness"], rk.State(at["angle"])
        block = rk.Block(
            2 * size * math.cos(slenderness), 2 * size * math.sin(slenderness), at["restitution"]
        )
        ground = records[int(at["record"])].scaled(pga=at["level"] * GRAVITY * math.tan(slenderness))
        ground = ground if at["polarity"] > 0 else ground.reversed()
        motion = rk.simulate(block.system(ground, model="slender"), start)
        certified += bool(row["certified"])
        same = row["peak"] == pytest.approx(peak_of(motion), rel=1e-9)
        if row["certified"] and not same and motion.outcome == "at-rest":
            same = abs(row["peak"] - motion.peak) <= 2.0 * rounding_of_peak(block, ground, start)
        if row["certified"] and not (same and OUTCOMES[row["outcome"]] == motion.outcome):
            wrong.append((at, row, str(motion)))
    return wrong, certified


@pytest.mark.parametrize("model", ["slender", "full"])
def test_without_losses_the_peak_is_that_of_the_free_motion_too(model):
    """A block that falls when the base motion ends rises higher on the other side."""
    ground = rk.GroundMotion([0.7233053866521985, -2.0, -1.5803530364312197], step=0.02)
    found = rk.rocking_spectrum(
        ground, size=[1.0, 1.5], slenderness=0.2, restitution=1.0, angle=-0.5, model=model
    ).dataset
    for size, peak in zip((1.0, 1.5), found.peak.values, strict=True):
        block = rk.Block(2 * size * math.cos(0.2), 2 * size * math.sin(0.2), 1.0)
        motion = rk.simulate(block.system(ground, model=model), rk.State(-0.5), duration=40.0)
        times = np.linspace(0.0, motion.duration, 200_000)
        assert peak == pytest.approx(np.abs(motion.at(times)[0]).max(), rel=1e-6)
        assert peak == pytest.approx(motion.peak, rel=1e-9)
        assert peak > 0.501


def test_random_points_end_as_simulate_says():
    wrong, certified = differing(500, seed=11)
    assert wrong == []
    assert certified > 450


@pytest.mark.long
@pytest.mark.timeout(600)
def test_many_random_points_end_as_simulate_says():
    for seed in range(21, 25):
        wrong, certified = differing(500, seed)
        assert wrong == []
        assert certified > 450


def test_dataset_names_its_axes_records_and_quantities():
    found = rk.rocking_spectrum(RECORDS, **ASKED, model="slender").dataset
    assert found.outcome.dims == ("record", "size", "slenderness")
    assert found.name.values.tolist() == list(RECORDS.names)
    assert found.pga.values.tolist() == [motion.pga for motion in RECORDS]
    np.testing.assert_allclose(
        found.frequency_parameter, np.sqrt(3 * GRAVITY / 4 / ASKED["size"]), rtol=4e-16
    )
    named = {"level": 0.4, "intensity": "pga-g", "angle": 0.0, "polarity": 1.0, "inertia_ratio": 4 / 3}
    assert (named | {"records_sha256": RECORDS.digest}).items() <= found.attrs.items()
    assert {each.name for each in VARIABLES} == set(found.data_vars)
    overturned = found.outcome == OUTCOMES.index("overturned")
    assert np.isinf(found.peak.where(overturned, math.inf)).all()
    assert 0 < int(overturned.sum()) < found.outcome.size
    assert (found.outcome.attrs["flag_meanings"].split()) == list(map(str, OUTCOMES))


def test_one_record_is_no_dimension_and_its_name_an_attribute():
    found = rk.rocking_spectrum(RECORDS[0], size=[1.0, 2.0], slenderness=0.2, model="slender").dataset
    assert found.outcome.dims == ("size",)
    assert found.attrs["record"] == RECORDS.names[0]
    assert found.equals(
        rk.rocking_spectrum(RECORDS, size=[1.0, 2.0], slenderness=0.2, model="slender").dataset.isel(
            record=0, drop=True
        )
    )


def test_motion_of_zeros_moves_no_block():
    found = rk.rocking_spectrum(
        rk.GroundMotion([0.0, 0.0], step=0.1),
        size=[1.0, 2.0],
        slenderness=0.2,
        model="slender",
    ).dataset
    assert found.peak.values.tolist() == [0.0, 0.0]
    assert set(found.outcome.values.tolist()) == {OUTCOMES.index("at-rest")}


def test_reversed_motion_is_that_of_the_other_polarity():
    both = rk.rocking_spectrum(RECORDS, **ASKED, polarity=[-1.0, 1.0], model="slender").dataset
    turned = rk.rocking_spectrum([motion.reversed() for motion in RECORDS], **ASKED, model="slender").dataset
    xr.testing.assert_equal(
        both.sel(polarity=-1.0, drop=True)[["outcome", "peak"]], turned[["outcome", "peak"]]
    )


@pytest.fixture(scope="module")
def plain():
    """The spectrum in memory."""
    return rk.rocking_spectrum(RECORDS, **ASKED, model="slender").dataset


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The spectrum in a store that tests must not change."""
    folder = tmp_path_factory.mktemp("made") / "spectrum.zarr"
    rk.rocking_spectrum(RECORDS, **ASKED, store=folder, model="slender")
    return folder


def test_store_gives_the_spectrum_in_memory_and_is_not_computed_twice(plain, made):
    before = files(made)
    assert rk.rocking_spectrum(RECORDS, **ASKED, store=made, model="slender").dataset.load().equals(plain)
    assert files(made) == before


def test_each_level_refines_the_sizes(plain, made):
    for number, step in ((2, 1), (1, 2), (0, 4)):
        coarse = xr.open_zarr(made, group=f"level-{number}", chunks=None, consolidated=False).load()
        shared = list(coarse.data_vars)
        assert coarse[shared].equals(
            plain[shared].isel(size=slice(None, None, step)).drop_vars(["name", "pga", "frequency_parameter"])
        )
    assert not (made / "level-3").exists()


def test_store_of_other_records_is_refused(made):
    others = rk.RecordSet([RECORDS[0], RECORDS[1].scaled(1.0 + 2**-52)])
    with pytest.raises(ValueError, match="the ground motions are others \\("):
        rk.rocking_spectrum(others, **ASKED, store=made, model="slender")


def test_interrupted_run_says_how_to_go_on(tmp_path):
    folder = tmp_path / "spectrum.zarr"
    with subprocess.Popen(
        [sys.executable, "-c", RUN, folder], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout.readline() == "running\n"
        while not any((folder / "level-0" / "outcome" / "c").rglob("0/0/0/0")):
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=60)
    assert error.splitlines()[-2:] == [
        "KeyboardInterrupt",
        f"The survey was interrupted; completed tiles are in {str(folder)!r}; run it again to resume.",
    ]


@pytest.mark.long
def test_peak_memory_of_a_store_does_not_follow_the_number_of_points(tmp_path):
    """Eight million points need a fifth more than one million; their results alone would double the memory."""

    def peak_memory(sizes, scales):
        line = [sys.executable, "-c", PEAK_MEMORY, tmp_path / f"{sizes}.zarr", str(sizes), str(scales)]
        return int(subprocess.run(line, capture_output=True, text=True, check=True).stdout)

    assert peak_memory(200, 400) < 1.5 * peak_memory(100, 100)


def test_batches_are_stretches_of_neighbours_that_share_tables():
    given = {"size": np.linspace(0.2, 4.0, 400), "level": np.linspace(0.3, 0.6, 400)}
    spec = motion_spec(
        rk.RecordSet(RECORDS[0]),
        given | {"slenderness": 0.2, "angle": 0.0, "polarity": 1.0},
        intensity="pga-g",
        model="slender",
    )
    measure, several = ending("Title"), 0
    for level in (*finest(spec), *levels(spec)):
        for tile in level.tiles():
            wanted = np.arange(math.prod(tile.shape), dtype=np.int32)
            parts = [batch.wanted for batch in batches(tile, spec, wanted, measure)]
            assert np.concatenate(parts).tolist() == wanted.tolist()
            assert all((np.diff(part) == 1).all() for part in parts)
            several += len(parts) > 1
    assert several >= 2


def test_neighbours_with_equal_record_and_frequency_parameter_are_one_stretch():
    spec = motion_spec(
        RECORDS,
        {"size": [1.0, 2.0], "slenderness": [0.1, 0.2], "angle": 0.0, "polarity": 1.0, "level": 1.0},
        intensity="scale",
        model="slender",
    )
    mesh = np.meshgrid(*spec.axes.values(), indexing="ij")
    runs = spec.inputs({name: values.ravel() for name, values in zip(spec.axes, mesh, strict=True)})
    parts = list(runs_of_equal_tables(runs))
    assert [(part.start, part.stop) for part in parts] == list(pairwise(range(0, 9, 2)))


def test_tables_of_a_record_are_kept_until_there_are_too_many_samples(monkeypatch):
    monkeypatch.setattr(march_loop, "MAX_KEPT", 10)
    records = [rk.PiecewiseLinear(np.sin(np.arange(6.0) + k), step=0.1) for k in range(3)]
    first, second, third = (tables_for(record) for record in records)  # two of them have 12 samples
    assert tables_for(records[1]) is second
    assert tables_for(records[2]) is third
    assert tables_for(records[0]) is not first


def test_batches_of_an_unequal_block_share_the_tables_of_both_sides(monkeypatch):
    monkeypatch.setattr(march_loop, "MAX_KEPT", 10)
    record = rk.PiecewiseLinear(np.sin(np.arange(6.0)), step=0.1)
    left = Left(np.array([1.2]), np.array([1.1]), np.array([0.9]), unequal=True)
    one, other = (sampled(record, full=False, left=left) for _ in range(2))
    assert one.forcing.tables is other.forcing.tables
    assert one.left.forcing.tables is other.left.forcing.tables


def test_bar_says_the_number_of_points_and_ends_with_the_outcomes(terminal):
    rk.rocking_spectrum(RECORDS, **ASKED, progress=True, model="slender")
    title, last = terminal()
    assert re.match(r"900 points in \d+ tiles?", title)
    assert "100 %" in last
    assert "overturned" in last
    rk.rocking_spectrum(RECORDS, **ASKED, model="slender")
    assert terminal() == [""]


def test_store_of_version_0_1_is_refused_in_a_sentence(tmp_path):
    """The dimension of the levels was named `scale`."""
    arguments = {"size": [1.0, 2.0], "slenderness": 0.2, "levels": [1.0, 2.0], "store": tmp_path / "a.zarr"}
    rk.rocking_spectrum(RECORDS[0], **arguments, model="slender")
    root = tmp_path / "a.zarr" / "zarr.json"
    root.write_text(root.read_text(encoding="utf-8").replace('"level"', '"scale"'), encoding="utf-8")
    message = "holds a survey of version 0.1, which names its levels `scale`"
    with pytest.raises(ValueError, match=f"^store '.*a.zarr' {message}") as refused:
        rk.rocking_spectrum(RECORDS[0], **arguments, model="slender")
    assert "\n" not in str(refused.value)
