"""Page of ground motions: its view in a link, its files from memory, its map and the motion of one block."""

import asyncio
import io
import itertools
import json
import math
import re
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import attrs
import numpy as np
import pytest
import xarray as xr
from bokeh.document import Document
from hypothesis import example, given, settings
from hypothesis import strategies as st

import record_files as write
import rocking as rk
from rocking.explorer import ground_page
from rocking.explorer.fields import Refused, Span
from rocking.explorer.ground_block import block_motion, margin_in_words
from rocking.explorer.ground_maps import (
    OVERTURNS,
    POINTS,
    ROCKS,
    SHADES,
    STANDS,
    Endings,
    colours,
    corner,
    netcdf,
    shares,
)
from rocking.explorer.ground_page import GroundSession
from rocking.explorer.ground_view import (
    DEFAULT,
    SCALES,
    SIZES,
    SLENDERNESS,
    SOURCES,
    Ground,
    GroundView,
    ground_of,
    open_file,
    read_file,
    thinned,
    vertical_channels,
)
from rocking.explorer.jobs import Workers
from rocking.explorer.refinement import Refinement
from rocking.model.forcing import KINDS
from rocking.model.quantity import FRICTION
from rocking.model.validation import TooManyEvents
from rocking.model.verdict import Outcome
from rocking.records import read as reading_process
from rocking.survey.ending_measures import BlockEndings

G = 9.80665
CODE = tuple(Outcome).index(Outcome.OVERTURNED)
SHORT = rk.GroundMotion([0.0, 4.0, -6.0, 5.0, -2.0, 0.0], step=0.25, name="short")
RANGES = Span(0.3, 3.0), Span(5.0, 40.0)
WALL = {"wall": "0.5"}
RESTRAINED = {"model": "slender", "stiffness": "2e4", "prestress": "800", "mass": "600"}
"""Fields of a block against a wall, and of a restrained one."""
WAVE = 0.4 * np.sin(0.08 * np.arange(400)) * np.exp(-np.arange(400) / 150)
THREE = "\n".join(write.csmip_v1([WAVE, -WAVE[:350], 0.5 * WAVE[::-1]])).replace("270 Deg", "Up").encode()
"""File of two horizontal channels of different length and a vertical one."""
UPWARD = {"source": "file", "vertical": "3"}
MEASURE = Endings(*RANGES, BlockEndings(SHORT, 1.0, "slender"))


def spans(low, high):
    pairs = st.tuples(st.floats(low, high), st.floats(low, high)).map(sorted).map(lambda ends: Span(*ends))
    return pairs.filter(lambda span: span.high >= 1.001 * span.low)


SHOWN = st.builds(
    GroundView,
    source=st.sampled_from([*SOURCES]),
    kind=st.sampled_from(KINDS),
    amplitude=st.floats(1e-3, 20),
    duration=st.floats(0.01, 60),
    units=st.sampled_from(["", "g", "cm/s²"]),
    step=st.none() | st.floats(1e-6, 1000),
    channel=st.integers(1, 9),
    vertical=st.none() | st.integers(1, 9),
    friction=st.none() | st.floats(*FRICTION.range),
    scale=st.floats(*SCALES),
    height=st.floats(0.1, 100),
    width=st.floats(0.101, 0.14),
    model=st.sampled_from(["slender", "full"]),
    normalised_by=st.sampled_from(["tangent", "angle"]),
    sizes=spans(*SIZES),
    angles=spans(*SLENDERNESS),
)


def run(coroutine):
    """Run a coroutine in a new thread, because a browser leaves an event loop in this one."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, asyncio.wait_for(coroutine, 60)).result()


@pytest.fixture
def workers():
    made = Workers()
    yield made
    made.close()


@given(SHOWN)
@settings(max_examples=60, deadline=None)
def test_link_gives_the_view_back(shown):
    assert GroundView.from_address("?" + shown.address) == (shown, {})


@pytest.mark.parametrize(
    ("typed", "field"),
    [
        ({"scale": "0"}, "scale"),
        ({"scale": "1e9"}, "scale"),
        ({"source": "elsewhere"}, "source"),
        ({"kind": "square"}, "kind"),
        ({"amplitude": "nan"}, "amplitude"),
        ({"duration": ""}, "duration"),
        ({"step": "-1"}, "step"),
        ({"units": "furlong"}, "units"),
        ({"model": "round"}, "model"),
        ({"channel": "0"}, "channel"),
        ({"sizes": "2:1"}, "sizes"),
        ({"sizes": "1:1.0001"}, "sizes"),
        ({"angles": "3"}, "angles"),
        ({"height": "0.1", "width": "50"}, "width"),
        ({"wall": "1.5"}, "wall"),
        ({"stiffness": "-1"}, "stiffness"),
        ({"prestress": "much"}, "prestress"),
        ({"mass": "0"}, "mass"),
        ({"model": "slender", "stiffness": "2e4"}, "stiffness"),
        ({"model": "slender", "prestress": "500"}, "prestress"),
        (RESTRAINED | {"stiffness": "1e6"}, "stiffness"),
        (RESTRAINED | {"wall": "0.5"}, "wall"),
        (RESTRAINED | {"offset": "0.05"}, "offset"),
        ({"vertical": "up"}, "vertical"),
        ({"friction": "0"}, "friction"),
        (RESTRAINED | UPWARD, "vertical"),
        (RESTRAINED | {"friction": "0.4"}, "friction"),
        ({"colour": "red"}, "page"),
    ],
)
def test_invalid_field_is_refused_by_its_name(typed, field):
    with pytest.raises(Refused) as caught:
        DEFAULT.changed(typed)
    assert list(caught.value.fields) == [field]


@pytest.mark.parametrize("typed", [WALL, RESTRAINED, {"model": "slender", "prestress": "500", "mass": "6"}])
def test_wall_and_restrainer_are_part_of_a_link_and_no_block_of_the_map_has_them(typed):
    view = DEFAULT.changed(typed)
    assert GroundView.from_address("?" + view.address) == (view, {})
    assert all(f"{name}={value}" in view.address.replace("20000", "2e4") for name, value in typed.items())
    block = view.changed(view.at_point(1.0, 15.0)).block
    assert (block.wall, block.restrainer) == (None, None)


def test_mass_alone_restrains_no_block_and_a_link_without_it_says_so():
    assert DEFAULT.changed({"mass": "600"}).block == DEFAULT.block
    view, refused = GroundView.from_address("?version=1&scale=2&model=slender&stiffness=2e4&prestress=3")
    assert (view.scale, view.block) == (2.0, DEFAULT.block)
    assert refused == {name: f"{name} needs the mass of the block" for name in ("stiffness", "prestress")}


def test_vertical_motion_without_a_file_has_no_effect():
    view = DEFAULT.changed(RESTRAINED | {"vertical": "3"})
    assert (view.upward, view.left_out) == (None, "")
    assert view.changed({"stiffness": "", "prestress": "", "source": "file"}).upward == 3


@pytest.mark.parametrize(
    "typed, names",
    [({}, ""), (UPWARD, "vertical motion"), (UPWARD | {"friction": "0.4"}, "vertical motion and friction")],
)
def test_page_says_what_the_map_leaves_out(typed, names):
    assert DEFAULT.changed(typed).left_out == (f"The map is computed without {names}." if names else "")


def test_invalid_link_keeps_the_default_of_its_field_and_says_so():
    shown, refused = GroundView.from_address("?version=1&scale=2&height=tall")
    assert (shown.scale, shown.height, list(refused)) == (2.0, DEFAULT.height, ["height"])
    shown, refused = GroundView.from_address("?version=1&scale=2&width=50")
    assert (shown.scale, shown.width, list(refused)) == (2.0, DEFAULT.width, ["width"])
    assert GroundView.from_address("?version=7")[1].keys() == {"page"}
    assert GroundView.from_address("?" + "a" * 3000)[1].keys() == {"page"}


@given(spans(*SIZES), spans(*SLENDERNESS), st.floats(0, 1), st.floats(0, 1))
@example(Span(2.8058422127398788, 38.21875), Span(6.28125, 9.9375), 0.22985258819113535, 0.71484375)
@settings(max_examples=100, deadline=None)
def test_click_selects_a_block_nearer_to_it_than_any_other_point_of_the_map(sizes, angles, across, up):
    shown = attrs.evolve(DEFAULT, sizes=sizes, angles=angles)
    size = sizes.low * (sizes.high / sizes.low) ** across
    degrees = angles.low + up * angles.width
    block = shown.changed(shown.at_point(size, degrees)).block
    assert abs(math.log(block.radius / size)) <= 0.5 * math.log(sizes.high / sizes.low) / (POINTS - 1)
    assert abs(block.degrees(1.0) - degrees) <= 0.5 * angles.width / (POINTS - 1)


@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=400))
@settings(max_examples=100, deadline=None)
def test_thinned_line_keeps_its_ends_and_extremes(values):
    values = np.array(values)
    times, kept = thinned(np.arange(values.size), values, 50)
    assert kept.size <= 52
    assert (kept == values[times]).all()
    assert (np.diff(times) > 0).all()
    assert {times[0], times[-1]} == {0, values.size - 1}
    assert (kept.min(), kept.max()) == (values.min(), values.max())


def test_facts_of_a_motion_follow_its_scale():
    ground = Ground(SHORT)
    facts = dict(ground.words(2.0)["facts"])
    assert facts["PGA"] == "1.224 g (12 m/s²)"
    assert facts["PGV"] == f"{SHORT.scaled(2.0).pgv:.4g} m/s"
    assert facts["duration"] == "1.25 s"
    assert ground.line(2.0)["acceleration"] == pytest.approx(2.0 * SHORT.acceleration / G, rel=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_pulse_is_drawn_with_its_own_peak_and_speed(kind):
    shown = attrs.evolve(DEFAULT, source="pulse", kind=kind, amplitude=0.4, duration=0.8)
    ground = ground_of(shown, ())
    line = ground.line(0.5)
    assert np.abs(line["acceleration"]).max() == pytest.approx(0.2, rel=1e-4)
    assert line["time"][[0, -1]] == pytest.approx([0.0, ground.base.span])
    speeds = {"rectangular": 1.0, "half-sine": 2 / math.pi, "one-sine": 1 / math.pi, "triangular": 0.5}
    if kind in speeds:  # integral of the positive part of the pulse
        assert ground.peaks[1] == pytest.approx(speeds[kind] * 0.4 * G * 0.8, rel=1e-6)


# ---- files


def test_file_in_memory_is_the_file_on_the_disk(tmp_path):
    data = "\n".join(write.peer(np.sin(np.arange(40)))).encode()
    path = tmp_path / "town.AT2"
    path.write_bytes(data)
    (ground,) = read_file("town.AT2", data, DEFAULT)
    assert ground.base == rk.read_ground_motion(path)
    assert ground_of(attrs.evolve(DEFAULT, source="file", channel=3), (ground,)) is ground


def test_file_without_units_asks_for_them_in_one_line_and_then_is_read():
    data = b"0\n1\n-1\n0\n"
    with pytest.raises(rk.RecordError, match="does not state the unit") as caught:
        read_file("bare.txt", data, DEFAULT)
    assert "\n" not in str(caught.value)
    (ground,) = read_file("bare.txt", data, attrs.evolve(DEFAULT, units="g", step=0.02))
    assert (ground.base.pga, ground.base.step) == (G, 0.02)


def test_file_is_refused_beyond_the_limit_and_without_bytes():
    with pytest.raises(ValueError, match="big.txt: larger than 50 MB"):
        read_file("big.txt", bytes(50_000_001), DEFAULT)
    for given_ in (7, {}, {"name": "a"}, {"name": 7, "data": b""}, {"name": "a", "data": "text"}):
        with pytest.raises(ValueError, match="could not be received"):
            open_file(given_)
    assert open_file({"name": "a", "data": memoryview(b"12")}) == ("a", b"12")


def test_reading_ends_at_its_limit_and_the_page_answers_meanwhile(workers, monkeypatch):
    """A process reads, so that no reader can stop the threads of the page; it is killed, so that the next file is read."""
    rows = b"0.0,0.0\n" * 6_000_000

    async def answers():
        reading = asyncio.ensure_future(workers.read(partial(read_file, "long.csv", rows, DEFAULT)))
        turns = 0
        while not reading.done():
            await asyncio.sleep(0.01)
            turns += 1
        with pytest.raises(rk.RecordError, match=r"^reading takes longer than 0.5 s: give a shorter file$"):
            await reading
        return turns

    monkeypatch.setattr("rocking.explorer.ground_view.READING", 0.5)
    begun = time.process_time()
    assert run(answers()) > 5
    monkeypatch.setattr("rocking.explorer.ground_view.READING", 60.0)
    short = "\n".join(write.peer(np.sin(np.arange(40)))).encode()
    assert len(run(workers.read(partial(read_file, "town.AT2", short, DEFAULT)))) == 1
    assert (
        time.process_time() - begun < 2.0
    )  # the reading of the long file itself takes longer, in whatever thread


def test_reading_ends_at_its_limit_of_memory_with_one_sentence(monkeypatch):
    monkeypatch.setattr(reading_process, "MAX_MEMORY", 500 << 20)
    monkeypatch.setattr("rocking.explorer.ground_view.READING", 60.0)
    with pytest.raises(
        rk.RecordError, match=r"^reading takes more than 500 MB of memory: give a shorter file$"
    ):
        read_file("lines.txt", b"\n" * 49_999_990 + b"1", DEFAULT)


def test_remark_states_both_peaks_if_the_header_differs():
    lines = write.smc(100 * np.cos(np.arange(45)))
    assert (
        ground_of(
            attrs.evolve(DEFAULT, source="file"), read_file("a.smc", "\n".join(lines).encode(), DEFAULT)
        ).note
        == ""
    )
    samples = 100 * np.cos(np.arange(45))
    largest = format(min(samples, key=lambda sample: -abs(sample)), "15.7E")
    other = [line.replace(largest, format(150.0, "15.7E")) for line in lines]
    assert other != lines
    channels = read_file("a.smc", "\n".join(other).encode(), DEFAULT)
    note = ground_of(attrs.evolve(DEFAULT, source="file"), channels).note
    assert note.startswith("The samples have a PGA of 1 m/s²")
    assert "header states 1.5 m/s²" in note


def test_remark_tells_each_warning_of_the_reader():
    data = b"time (s), acceleration (g)\n0, 0\n1, 100\n2, -100\n3, -100\n4, 100\n5, 0\n"
    (ground,) = read_file("a.csv", data, DEFAULT)
    with pytest.warns(rk.InputWarning, match="PGA") as caught:
        rk.read_ground_motion(data, name="a.csv")
    assert [f"{each.message}." for each in caught] == [f"a.csv: a{ground.note[1:]}"]
    assert "check the unit of the samples, g" in ground.note


def test_remark_tells_a_vertical_channel_and_a_drift():
    up = rk.GroundMotion([0.0, 1.0, -1.0, -1.0, 1.0, 0.0], step=0.1, component="Up")
    assert Ground(up).note == (
        "The component Up is vertical, and the base moves horizontally: choose a horizontal component."
    )
    pushed = rk.GroundMotion([0.0, 1.0, 0.0], step=0.1)
    doubt, advice, _ = pushed.drift_doubt.partition(", or for example baseline=")
    assert advice
    assert Ground(pushed).note == f"T{doubt[1:]}."
    assert doubt.endswith(": use a corrected record")


@pytest.fixture(scope="module")
def three():
    return read_file("three.v1", THREE, DEFAULT)


def test_vertical_channel_is_that_of_the_file_and_ends_with_the_horizontal_one(three):
    view = DEFAULT.changed(UPWARD)
    assert vertical_channels(view, three) == {3: "Up"}
    ground = ground_of(view, three)
    assert (ground.base, ground.vertical, ground.note) == (three[0].base, three[2].base, three[0].note)
    fact = dict(ground.words(2.0)["facts"])["vertical motion"]
    up = 2.0 * three[2].base.acceleration / G
    assert fact == f"Up, {up.min():.4g} to {up.max():.4g} g, positive upwards".replace("-", "−")
    shorter = ground_of(view.changed({"channel": "2"}), three)
    assert shorter.vertical == three[2].base.clipped(end=3.49)
    assert shorter.base.duration == shorter.vertical.duration == 3.49
    assert "The two components have 350 and 400 samples: both end at 3.49 s." in shorter.note


@pytest.mark.parametrize("channel, vertical", [("1", "2"), ("1", "4"), ("3", "3")])
def test_other_channel_than_a_vertical_one_is_refused(three, channel, vertical):
    view = DEFAULT.changed({"source": "file", "channel": channel, "vertical": vertical})
    with pytest.raises(Refused, match="must be a vertical channel of the file, other than") as caught:
        ground_of(view, three)
    assert list(caught.value.fields) == ["vertical"]


def test_vertical_channel_with_another_step_is_refused_without_python(three):
    coarse = Ground(three[2].base.resampled(0.02))
    with pytest.raises(Refused) as caught:
        ground_of(DEFAULT.changed(UPWARD), (*three[:2], coarse))
    assert caught.value.fields == {
        "vertical": "vertical must have the time step of the horizontal channel, 0.01 s; got 0.02 s"
    }


# ---- map


def pictures(base, scale, workers, model="slender"):
    async def refine():
        measure = Endings(*RANGES, BlockEndings(base, scale, model))
        refinement = Refinement(measure, workers, np.zeros(1, np.int64))
        found = [refinement.coarse()]
        async for picture in refinement.finer():
            found.append(picture)  # noqa: PERF401 (a list comprehension would not be clearer)
        return found

    return run(refine())


@pytest.mark.parametrize("model", ["slender", "full"])
def test_every_point_of_the_map_is_that_of_the_rocking_spectrum(workers, model):
    found = pictures(SHORT, 1.3, workers, model)
    sides = [picture.side for picture in found]
    assert (sides[0], sides[-1], sides) == (26, POINTS, sorted(sides))
    assert {picture.side for picture in found if picture.whole} <= {26, 51, 101, POINTS}
    assert [picture.done for picture in found] == [False] * (len(found) - 1) + [True]
    places = np.arange(0, POINTS, 19)
    sizes, angles = MEASURE.sizes[places], np.radians(MEASURE.angles[places])
    spectrum = rk.rocking_spectrum(SHORT, size=sizes, slenderness=angles, levels=1.3, model=model).dataset
    for name, values in found[-1].fields.items():
        expected = spectrum[name].transpose("slenderness", "size").values
        assert values[np.ix_(places, places)] == pytest.approx(expected, rel=1e-6, nan_ok=True), name
    assert 0.05 < np.mean(found[-1].fields["outcome"] == CODE) < 0.95


def test_coarse_points_stay_in_the_finer_maps(workers, monkeypatch):
    monkeypatch.setattr("rocking.explorer.refinement.SHOWN_EVERY", 0.0)
    found = [picture for picture in pictures(SHORT, 1.3, workers) if picture.whole]
    assert [picture.side for picture in found] == [26, 51, 101, POINTS]
    for coarse, fine in itertools.pairwise(found):
        assert (fine.fields["peak"][::2, ::2] == coarse.fields["peak"]).all()


@pytest.mark.parametrize("model", ["slender", "full"])
@pytest.mark.parametrize("kind", KINDS)
def test_pulse_in_the_map_is_that_of_one_simulation(kind, model):
    pulse = rk.Pulse(kind, amplitude=5.0, duration=0.6)
    sizes, angles = np.array([0.5, 1.0, 2.0]), np.radians([8.0, 14.0, 20.0])
    found = BlockEndings(pulse, 1.5, model).at(sizes, angles, np.zeros(1, np.int64))
    for k, (size, angle) in enumerate(zip(sizes, angles, strict=True)):
        block = rk.Block(2 * size * math.cos(angle), 2 * size * math.sin(angle))
        motion = rk.simulate(block.system(rk.Pulse(kind, amplitude=7.5, duration=0.6), model=model))
        assert (found["outcome"][k] == CODE) == (motion.outcome == "overturned")
        if model == "slender":
            assert found["margin"][k] == pytest.approx(motion.margin, rel=1e-9, abs=1e-9, nan_ok=True)
        else:  # that of the arc of the least estimate, whose error is below 0.1
            excess = abs(found["margin"][k]) - abs(motion.margin)
            assert -1e-4 <= excess <= 0.1, (found["margin"][k], motion.margin)
        if motion.outcome != "overturned":
            assert found["peak"][k] == pytest.approx(motion.peak, rel=1e-9)


@pytest.mark.parametrize("side", [26, POINTS])
def test_blocks_lie_at_the_centres_of_their_cells_in_the_image(side):
    """The horizontal axis is logarithmic, so that all cells have the same ratio of their edges."""
    image = {name: values[0] for name, values in corner(*RANGES, side).items()}
    centres = (np.arange(side) + 0.5) / side
    across = image["x"] * ((image["x"] + image["w"]) / image["x"]) ** centres
    stride = (POINTS - 1) // (side - 1)
    assert across == pytest.approx(MEASURE.sizes[::stride], rel=1e-12)
    assert image["y"] + image["h"] * centres == pytest.approx(MEASURE.angles[::stride], rel=1e-12)


def test_stopped_map_stops():
    assert BlockEndings(SHORT, 1.0, "slender").at(np.ones(2), np.full(2, 0.2), np.ones(1, np.int64)) is None


def test_colours_are_those_of_the_outcomes_and_the_shares_add_up(workers):
    picture = pictures(SHORT, 0.45, workers)[0]
    drawn, peak = colours(picture), picture.fields["peak"]
    overturned = picture.fields["outcome"] == CODE
    assert overturned.any()
    assert ((drawn == OVERTURNS) == overturned).all()
    assert (peak == 0.0).any()
    assert ((drawn == STANDS) == (peak == 0.0)).all()
    rocks = ~overturned & (peak > 0.0)
    assert (drawn[rocks] == ROCKS + np.minimum((peak[rocks] * SHADES).astype(int), SHADES - 1)).all()
    assert sum(shares(picture)) == pytest.approx(1.0)
    assert shares(picture)[2] == np.mean(overturned)


def test_saved_map_has_the_blocks_and_the_results(workers):
    picture = pictures(SHORT, 1.0, workers)[-1]
    data = xr.open_dataset(io.BytesIO(netcdf(MEASURE, picture, {"view": DEFAULT.address})), engine="h5netcdf")
    assert data.outcome.dims == ("slenderness", "size")
    assert (data.peak.values == picture.fields["peak"]).all()
    end = data.isel(slenderness=-1, size=0)
    block = rk.Block(float(end.height), float(end.width))
    assert (block.radius, block.degrees(1.0)) == pytest.approx((0.3, 40.0))
    assert GroundView.from_address(data.attrs["view"]) == (DEFAULT, {})


# ---- one block


def test_time_history_and_verdict_are_those_of_the_simulation():
    shown = attrs.evolve(DEFAULT, source="file", scale=1.4, model="slender")
    drawn, words = block_motion(shown, Ground(SHORT))
    line = drawn["history"]["line"]
    motion = rk.simulate(shown.block.system(SHORT.scaled(1.4), model="slender"))
    angle, _ = motion.at(shown.block.time(line["time"]))
    assert line["angle"] == pytest.approx(shown.block.degrees(angle), abs=1e-9)
    assert np.abs(line["angle"]).max() == pytest.approx(shown.block.degrees(motion.peak), rel=1e-4)
    facts = dict(words["facts"])
    assert facts["impacts"] == str(motion.impacts)
    assert words["kind"] == "rocks and stands"
    assert words["decided"]
    assert f"{motion.validity(shown.block).friction:.3g}" in words["validity"][0]
    assert f"{-motion.margin:.3g} α θcr" in words["margin"]


@pytest.mark.parametrize("model", ["slender", "full"])
def test_block_against_a_wall_is_described_so(model):
    shown = DEFAULT.changed(WALL | {"model": model})
    drawn, words = block_motion(shown, Ground(SHORT))
    motion = rk.simulate(rk.Block(2.0, 0.5, wall=rk.Wall(0.5)).system(SHORT.scaled(5.0), model=model))
    facts = dict(words["facts"])
    assert (facts["impacts"], facts["e"]) == (str(motion.impacts), "0.5 (wall)")
    assert facts["lifts off at"].startswith("−0.25 g")
    assert drawn["history"]["below"] == 0.0 < drawn["history"]["above"]
    assert drawn["history"]["line"]["angle"].min() == 0.0
    assert -0.1 < drawn["history"]["ranges"][2] / drawn["history"]["ranges"][3] < 0.0
    assert words["sentence"].endswith("The blocks of the map have no wall.")
    assert any(sentence.startswith("Wall: ") for sentence in words["validity"])


def test_restrained_block_is_described_by_its_unstable_balance():
    shown = DEFAULT.changed(RESTRAINED | {"scale": "1.4"})
    block = rk.Block(2.0, 0.5).restrained(2e4, 800.0, mass=600.0)
    assert shown.block == block
    drawn, words = block_motion(shown, Ground(SHORT))
    motion = rk.simulate(block.system(SHORT.scaled(1.4), model="slender"))
    block = motion.system.block
    history = drawn["history"]
    assert np.abs(history["line"]["angle"]).max() == pytest.approx(block.degrees(motion.peak), rel=1e-4)
    assert history["above"] == -history["below"] == block.degrees(1.0) > 14.1
    facts = dict(words["facts"])
    assert facts["θcr"] == "14.04°"
    assert facts["restrainer"] == f"κ = {block.stiffness_ratio:.4g}, ρ = {block.prestress_ratio:.4g}"
    assert facts["unstable balance θu"] == f"{block.degrees(1.0):.4g}°"
    assert facts["lifts off at"] == f"{0.25 * (1 + block.prestress_ratio):.4g} g"
    assert facts["largest |θ|"].endswith(" θu")
    assert "θcr" not in words["margin"]
    assert words["sentence"].endswith("The blocks of the map have no restrainer.")
    assert words["validity"][0] == "Sliding and jumping of a restrained block are not checked."


def test_restrained_block_with_the_full_equation_is_described_by_its_critical_angle():
    shown = DEFAULT.changed(RESTRAINED | {"scale": "1.4", "model": "full"})
    drawn, words = block_motion(shown, Ground(SHORT))
    block = rk.Block(2.0, 0.5).restrained(2e4, 800.0, mass=600.0)
    motion = rk.simulate(block.system(SHORT.scaled(1.4)))
    history, facts = drawn["history"], dict(words["facts"])
    assert np.abs(history["line"]["angle"]).max() == pytest.approx(block.degrees(motion.peak), rel=1e-4)
    assert history["above"] == -history["below"] == pytest.approx(math.degrees(block.critical_angle))
    assert "unstable balance θu" not in facts
    assert facts["lifts off at"] == f"{0.25 * (1 + block.prestress_ratio):.4g} g"
    assert facts["largest |θ|"].endswith(" θcr")
    assert words["validity"] == ["Sliding and jumping of a restrained block are not checked."]


@pytest.mark.parametrize("model", ["slender", "full"])
def test_block_under_vertical_motion_is_that_of_the_simulation(three, model):
    view = DEFAULT.changed(UPWARD | {"scale": "1.4", "model": model})
    drawn, words = block_motion(view, ground_of(view, three))
    ground, up = (three[place].base.scaled(1.4) for place in (0, 2))
    motion = rk.simulate(view.block.system(ground, vertical=up, model=model))
    plain = rk.simulate(view.block.system(ground, model=model))
    assert abs(motion.peak - plain.peak) > 0.005
    assert words["kind"] == "rocks and stands"
    assert np.abs(drawn["history"]["line"]["angle"]).max() == pytest.approx(
        view.block.degrees(motion.peak), rel=1e-4
    )
    assert dict(words["facts"])["lifts off at"].endswith("times the weight 1 + a_v")


@pytest.mark.parametrize("typed", [{}, WALL, {"offset": "0.02"}, {"model": "slender"}])
def test_block_with_too_little_friction_slides_and_has_no_rocking_verdict(typed):
    view = DEFAULT.changed(typed | {"scale": "1.4"})
    needed = _validity(view).friction
    least = 0.9 * needed
    _, words = block_motion(attrs.evolve(view, friction=least), Ground(SHORT))
    refusal = _validity(view, least).refusal
    assert words["kind"] == "slides"
    assert words["sentence"].startswith(f"S{refusal[1:]}. The base accelerates")
    assert (words["margin"], words["certified"]) == ("", "")
    assert any(sentence.startswith("Sliding: the motion and its results") for sentence in words["validity"])
    _, plain = block_motion(view, Ground(SHORT))
    _, enough = block_motion(attrs.evolve(view, friction=1.1 * needed), Ground(SHORT))
    told = f"Required coefficient of friction: {needed:.3g}"
    assert (plain["validity"][0], enough["validity"][0]) == (
        f"{told}.",
        f"{told}; {1.1 * needed:g} suffices.",
    )
    assert {name: enough[name] for name in plain if name != "validity"} == {
        name: value for name, value in plain.items() if name != "validity"
    }


def _validity(view, friction=None):
    motion = rk.simulate(view.block.system(SHORT.scaled(view.scale), model=view.model))
    return motion.validity(view.block, friction=friction)


def test_full_equation_of_motion_has_a_margin_and_is_certified():
    shown = attrs.evolve(DEFAULT, source="file", scale=1.4, model="full")
    drawn, words = block_motion(shown, Ground(SHORT))
    line = drawn["history"]["line"]
    motion = rk.simulate(shown.block.system(SHORT.scaled(1.4), model="full"))
    assert np.abs(line["angle"]).max() == pytest.approx(shown.block.degrees(motion.peak), rel=1e-4)
    facts = dict(words["facts"])
    assert facts["lifts off at"] == "0.25 g"  # g tan θcr
    assert f"{abs(motion.margin):.3g} α θcr" in words["margin"]
    assert words["certified"].startswith("Certified")
    assert not any("slender" in sentence for sentence in words["validity"])
    falls, _ = block_motion(attrs.evolve(shown, scale=9.0), Ground(SHORT))
    assert np.abs(falls["history"]["line"]["angle"]).max() == pytest.approx(90.0, abs=1e-9)


def test_block_that_stays_still_or_falls_is_described_so():
    _, words = block_motion(attrs.evolve(DEFAULT, scale=0.1, model="slender"), Ground(SHORT))
    assert (words["kind"], words["margin"]) == ("stands still", "The block never lifts off.")
    falls, words = block_motion(attrs.evolve(DEFAULT, scale=9.0, model="slender"), Ground(SHORT))
    assert words["kind"] == "overturns"
    assert np.abs(falls["history"]["line"]["angle"]).max() > DEFAULT.block.degrees(1.0)
    assert "overturning certain from" in dict(words["facts"])
    assert "largest |θ|" not in dict(words["facts"])


def test_margin_is_the_speed_that_the_block_lacked_or_had_to_spare():
    block = DEFAULT.block
    lacked = rk.simulate(block.system(SHORT.scaled(1.4), model="slender"))
    assert lacked.margin < 0
    assert "lacked a speed" in margin_in_words(lacked, block)
    pushed = rk.Pulse("rectangular", amplitude=block.acceleration(1.7), duration=block.seconds(1.0))
    spared = rk.simulate(block.system(pushed, model="slender"))
    assert spared.margin > 0
    assert "faster than it had to be" in margin_in_words(spared, block)
    stiff = (
        rk.Block(2.0, 0.6)
        .restrained(2e5, 1500.0, mass=600.0)
        .system(rk.example_ground_motion().scaled(pga=8.0))
    )
    without_balance = rk.simulate(stiff)
    assert without_balance.peak > 0.0
    assert margin_in_words(without_balance, stiff.block) == "No margin was found."


# ---- session


def test_invalid_message_or_file_leaves_the_view_and_says_so(workers):
    async def visit():
        session = GroundSession(Document(), workers)
        session.hear("{")
        refused = [session.link.refused]
        session.hear('{"n": 1, "what": "fields", "fields": {"source": "file"}}')
        refused.append(session.link.refused)
        session.receive({"name": "a"})
        refused.append(session.link.refused)
        session.hear('{"n": 2, "what": "open", "fields": {"address": "?source=file"}}')
        refused.append(session.link.refused)
        shown = session.view
        session.jobs.end_all()
        return refused, shown

    refused, shown = run(visit())
    assert shown == DEFAULT
    parts = ("Unknown request", "choose a file", "could not be received", "not part of the link")
    assert [part in text for part, text in zip(parts, refused, strict=True)] == [True] * 4


def test_motion_with_too_many_events_is_not_shown_as_the_one_before(workers, monkeypatch):
    def crowded(*_):
        raise TooManyEvents("more than 3 events")

    async def at_once(change, *arguments):
        change(*arguments)

    async def visit():
        session = GroundSession(Document(), workers)
        monkeypatch.setattr(session, "change", at_once)
        monkeypatch.setattr(ground_page, "block_motion", crowded)
        await session.draw_motion(DEFAULT, np.zeros(1, np.int64))
        return session.link

    link = run(visit())
    told = json.loads(link.verdict)
    assert (told["kind"], told["sentence"], told["facts"]) == ("not computed", "More than 3 events.", [])
    assert link.drawn["history"]["line"]["angle"].size == 0
    assert link.drawn["base"]["line"]["acceleration"].size > 0


def test_session_takes_vertical_motion_for_the_block_and_not_for_the_map(workers, monkeypatch, three):
    mapped = []

    async def at_once(change, *arguments):
        change(*arguments)

    async def unrefined(*_):
        pass

    async def visit():
        session = GroundSession(Document(), workers)
        monkeypatch.setattr(session, "change", at_once)
        monkeypatch.setattr(session, "refine", unrefined)
        monkeypatch.setattr(ground_page, "BlockEndings", lambda base, *_: mapped.append(base))
        short = Ground(three[2].base.clipped(end=3.0))
        session._accept(
            DEFAULT.changed({"source": "file", "channel": "2", "scale": "1"}), (*three[:2], short)
        )
        told = []
        for typed in ({"vertical": "1"}, {"vertical": "3"}, {"channel": "3"}):
            session.hear(json.dumps({"what": "fields", "fields": typed}))
            told.append(json.loads(session.link.refused)["fields"])
        shown, told_view = session.view, json.loads(session.link.view)
        await session.refine_map(shown, np.zeros(1, np.int64))
        fallen = attrs.evolve(shown, scale=20.0)
        await session.draw_motion(fallen, np.zeros(1, np.int64))
        verdict = json.loads(session.link.verdict)
        session.hear('{"what": "open", "fields": {"address": "?source=file&vertical=2&scale=1"}}')
        opened = session.view, json.loads(session.link.refused)["fields"]
        session.jobs.end_all()
        return told, shown, told_view, verdict, opened

    told, shown, told_view, verdict, opened = run(visit())
    assert [list(each) for each in told] == [["vertical"], [], ["vertical"]]
    assert (shown.channel, shown.vertical) == (2, 3)
    assert (told_view["verticals"], told_view["left_out"]) == ([[3, "Up"]], shown.left_out)
    assert mapped[-1] == three[1].base
    assert verdict["kind"] == "not computed"
    assert re.fullmatch(
        r"The base reaction vanishes at t = [\d.]+ s: the block leaves the base\.", verdict["sentence"]
    )
    assert (opened[0].vertical, list(opened[1])) == (None, ["vertical"])


@pytest.mark.parametrize(
    "before, typed, scale",
    [
        (DEFAULT, {"source": "pulse"}, 1.0),
        (DEFAULT, {"source": "pulse", "scale": "3"}, 3.0),
        (DEFAULT, {"height": "3"}, 5.0),
        (attrs.evolve(DEFAULT, source="pulse", scale=2.0), {"amplitude": "0.4"}, 2.0),
        (attrs.evolve(DEFAULT, source="pulse", scale=2.0), {"source": "example"}, 5.0),
    ],
)
def test_another_base_motion_begins_as_it_is(before, typed, scale):
    """Only the example, whose shaking is weak, begins with a factor."""
    assert before.changed(typed).scale == scale
