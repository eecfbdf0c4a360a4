"""Record files: each format, in files written from its description, and the errors with file and line."""

import hashlib
import sys
import types
import warnings
from pathlib import Path

import numpy as np
import pytest

import record_files as write
import rocking as rk
from rocking.records.read import FILE

pytestmark = pytest.mark.filterwarnings("ignore:.*a PGA of .* is unusual")
G = 9.80665
WAVE = np.round(np.sin(np.arange(37)) * np.exp(-np.arange(37) / 9), 3)
OTHER = np.round(-0.5 * WAVE[:30], 3)
COUNTS = [int(1e5 * value) + 70_000 for value in WAVE]
KNET = np.subtract(COUNTS, np.mean(COUNTS)) * 3920 / 6182761
V2_NEW = "{} points of {} data equally spaced at  {:.3f} sec, in cm/sec2. (8f10.3)"


def changed(lines, old, new):
    assert any(old in line for line in lines)
    return [line.replace(old, new) for line in lines]


# name: (lines, format, m/s² per unit, step, channels, name, components, has the PGA in its header)
FILES = {
    "PEER": (
        write.peer(WAVE),
        "PEER AT2",
        G,
        0.01,
        [WAVE],
        "Valley-02, 1/2/1940, Town Array #9",
        ["180"],
        False,
    ),
    "PEER, old": (
        write.peer(WAVE, old=True),
        "PEER AT2",
        G,
        0.01,
        [WAVE],
        "Valley-02, 1/2/1940, Town Array #9",
        ["180"],
        False,
    ),
    "PEER, component with its station": (
        changed(write.peer(WAVE), ", 180", ", N 05 W (Town station 7)"),
        "PEER AT2",
        G,
        0.01,
        [WAVE],
        "Valley-02, 1/2/1940, Town Array #9",
        ["N 05 W (Town station 7)"],
        False,
    ),
    "PEER, a sentence in place of the station": (
        ["", "Records of a harbour, in units of g", *write.peer(WAVE)[2:]],
        "PEER AT2",
        G,
        0.01,
        [WAVE],
        "Records of a harbour, in units of g",
        [""],
        False,
    ),
    "SMC": (write.smc(100 * WAVE), "SMC", 0.01, 0.005, [100 * WAVE], "Town, 12 Street, F", ["360°"], True),
    "CSMIP V1": (
        write.csmip_v1([WAVE, OTHER]),
        "CSMIP V1",
        G,
        0.01,
        [WAVE, OTHER],
        "Town, Street Rd.",
        ["90°", "180°"],
        True,
    ),
    "CSMIP V1, g/10": (
        write.csmip_v1([WAVE], 50, "g/10"),
        "CSMIP V1",
        G / 10,
        0.02,
        [WAVE],
        "Town, Street Rd.",
        ["90°"],
        True,
    ),
    "CSMIP V2": (
        write.csmip_v2([WAVE, OTHER]),
        "CSMIP V2",
        0.01,
        0.02,
        [WAVE, OTHER],
        "TOWN FAULT ZONE 14",
        ["90°", "180°"],
        True,
    ),
    "CSMIP V2, new": (
        write.csmip_v2([WAVE], announce=V2_NEW),
        "CSMIP V2",
        0.01,
        0.02,
        [WAVE],
        "TOWN FAULT ZONE 14",
        ["90°"],
        True,
    ),
    "USC": (write.usc(WAVE), "USC V2", 0.01, 0.02, [WAVE], "TOWN FAULT ZONE 14", ["90°"], True),
    "COSMOS": (
        write.cosmos([WAVE, OTHER]),
        "COSMOS V2",
        0.01,
        0.005,
        [WAVE, OTHER],
        "Town - Street",
        ["90°", "180°"],
        True,
    ),
    "COSMOS V1": (
        write.cosmos([WAVE], title="Uncorrected acceleration"),
        "COSMOS V1",
        0.01,
        0.005,
        [WAVE],
        "Town - Street",
        ["90°"],
        True,
    ),
    "K-NET": (write.knet(COUNTS), "K-NET", 0.01, 0.01, [KNET], "XYZ005", ["N-S"], True),
    "ESM": (write.esm(WAVE), "ESM", 0.01, 0.005, [WAVE], "Town Hall", ["HNE"], True),
    "GeoNet V2A": (
        write.geonet([np.round(90 * WAVE, 1)] * 3),
        "GeoNet V2A",
        1e-3,
        0.02,
        [np.round(90 * WAVE, 1)] * 3,
        "Town Farm",
        ["N0W", "N1W", "N2W"],
        True,
    ),
    "GeoNet V1A": (
        write.geonet([np.round(90 * WAVE, 1)], raw=True),
        "GeoNet V1A",
        1e-3,
        0.02,
        [np.round(90 * WAVE, 1)],
        "Town Farm",
        ["N0W"],
        True,
    ),
    "columns": (write.columns(WAVE), "text", 1.0, 0.01, [WAVE], "file.x", [""], False),
}


@pytest.fixture
def make(tmp_path):
    def make(lines, end="\n"):
        path = tmp_path / "file.x"
        path.write_bytes((end.join(lines) + end).encode() if isinstance(lines, list) else lines)
        return path

    return make


def refusal_of(path, **arguments):
    with pytest.raises(rk.RecordError, match=r"^.+$") as caught:  # one line
        rk.read_ground_motions(path, **arguments)
    return str(caught.value)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("kind", FILES)
def test_samples_unit_step_and_names_are_those_of_the_file(make, kind, end):
    lines, form, unit, step, channels, name, components, has_peak = FILES[kind]
    path = make(lines, end)
    motions = rk.read_ground_motions(path)
    assert len(motions) == len(channels)
    for number, (motion, samples) in enumerate(zip(motions, channels, strict=True), 1):
        np.testing.assert_allclose(motion.acceleration, samples * unit, rtol=1e-12, atol=1e-15)
        assert (motion.step, motion.name, motion.component) == (step, name, components[number - 1])
        assert motion == rk.read_ground_motion(path, number)
        file = motion.file
        assert (file.name, file.format) == ("file.x", form)
        assert file.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
        assert file.pga == motion.pga
        assert file.pga_agrees is (True if has_peak else None)
        several = f"channel {number} of {len(channels)}, {components[number - 1]}"
        assert file.channel == (several if len(channels) > 1 else "")


@pytest.mark.parametrize(("printed", "component"), [("4", "N-S 2"), ("6", "U-D 2"), ("U-D", "U-D")])
def test_directions_of_kik_net_are_numbers(make, printed, component):
    lines = [line.replace("N-S", printed) for line in write.knet(COUNTS)]
    motion = rk.read_ground_motion(make(lines))
    assert (motion.component, motion.vertical) == (component, component.startswith("U-D"))


def test_cosmos_files_may_hold_velocity_between_the_channels(make):
    raw = write.cosmos([WAVE, OTHER], title="Uncorrected acceleration")
    velocity = changed(changed(raw, "acceleration", "velocity"), "cm/sec2(04)", "cm/sec(05)")
    motions = rk.read_ground_motions(
        make([*velocity, *raw[: len(raw) // 2 + 1], *velocity, *raw[len(raw) // 2 + 1 :], *velocity])
    )
    assert [motion.pga for motion in motions] == pytest.approx(
        [0.01 * np.abs(each).max() for each in (WAVE, OTHER)]
    )
    assert [motion.file.format for motion in motions] == ["COSMOS V1"] * 2


def test_the_example_has_the_peak_of_its_header():
    motion = rk.example_ground_motion()
    assert (motion.step, motion.acceleration.size, motion.component) == (0.005, 6001, "360°")
    assert motion.name == "San Francisco, 1295 Shafter, F"
    assert motion.pga == pytest.approx(1.0441)
    assert motion.times[np.abs(motion.acceleration).argmax()] == pytest.approx(10.170)
    assert motion.file.header_pga == pytest.approx(1.044078)
    assert motion.file.pga_agrees
    assert motion.file.pga_difference == pytest.approx(2.2e-5)
    assert Path(FILE).stat().st_size < 150_000


def test_a_peak_that_differs_from_the_header_is_reported(make):
    lines = [line.replace("PGA_CM/S^2: ", "PGA_CM/S^2: 1") for line in write.esm(WAVE)]
    with pytest.warns(
        rk.InputWarning, match=r"^file.x: the samples have a PGA of 0.00\S+ m/s², the header states"
    ) as caught:
        motion = rk.read_ground_motion(make(lines))
    assert caught[0].filename == __file__
    assert motion.file.pga_agrees is False
    assert motion.file.pga_difference < 0
    with pytest.warns(rk.InputWarning, match="header states") as caught:
        rk.read_ground_motions(make(lines))
    assert caught[0].filename == __file__


WRONG = {
    "count too large": (
        changed(write.peer(WAVE), "NPTS=  37", "NPTS=  47"),
        "line 12: the file ends after 37 samples of 47; it is incomplete: download it again",
    ),
    "count too small": (
        changed(write.peer(WAVE), "NPTS=  37", "NPTS=  35"),
        "line 12: more than the 35 samples of the header",
    ),
    "count no number": (
        changed(write.peer(WAVE), "NPTS=  37", "NPTS=  1e9"),
        "line 4: the number of samples must be a whole number from 1",
    ),
    "step of zero": (
        changed(write.peer(WAVE), "DT=   0.0100", "DT=   0.0000"),
        "line 4: the time step must be positive",
    ),
    "another quantity": (
        write.peer(WAVE, title="VELOCITY TIME SERIES IN UNITS OF CM/S"),
        "line 3: acceleration expected, but the file holds velocity; give the .AT2 file",
    ),
    "unknown unit": (
        write.peer(WAVE, title="ACCELERATION TIME SERIES IN UNITS OF FT/S2"),
        "line 3: a unit of acceleration expected; got 'FT/S2'",
    ),
    "header cut": (
        write.peer(WAVE)[:3],
        "line 3: the file ends in its header; it is incomplete: download it again",
    ),
    "not a number": ([*write.peer(WAVE)[:-1], "  NaN 1.0"], "line 12: numbers expected"),
    "two points": ([*write.peer(WAVE)[:-1], "  1.0.5"], "line 12: numbers expected; got '1.0.5'"),
    "absurd exponent": (
        changed(write.esm(WAVE), "PGA_CM/S^2: ", "PGA_CM/S^2: 1e-99999999999999999999 "),
        "line 8: the peak",
    ),
    "too large": (
        changed(write.esm(WAVE), "0.753000", "8e30"),
        "acceleration must be finite and of size up to 1e+06, unlike sample 1",
    ),
    "overflow": (
        changed(write.smc(100 * WAVE), "    75.300", "    1e9999"),
        "a sample must be a number; got '1e9999'",
    ),
    "stars": (
        changed(write.smc(100 * WAVE), "    75.300", "**********"),
        "line 30: a sample must be a number; got '**********'",
    ),
    "wide columns": (
        changed(write.cosmos([WAVE]), "(8F10.5)", "(8F9.5)"),
        "more than the 37 samples of the header, or more than 8 numbers in a line",
    ),
    "no column": (
        changed(write.cosmos([WAVE]), "(5F15.6)", "(0F15.6)"),
        "line 25: a format such as (8F10.3) expected",
    ),
    "no width": (changed(write.csmip_v1([WAVE]), "(8f9.6)", "(8f0.6)"), "a format such as (8F10.3) expected"),
    "huge width": (
        changed(write.cosmos([WAVE]), "(8F10.5)", f"(8F{'9' * 5000}.5)"),
        "a format such as (8F10.3) expected",
    ),
    "line cut": (
        [*write.smc(WAVE)[:-1], write.smc(WAVE)[-1][:35]],
        "line 34: the line ends before its 5 samples; 32 of 37 were read before it",
    ),
    "velocity": (["4 VELOCITY", *write.smc(WAVE)[1:]], "line 1: acceleration expected"),
    "no step": (
        changed(write.cosmos([WAVE]), "       5.000000", "    -999.000000"),
        "real-header value 62, must be positive",
    ),
    "no data": (write.cosmos([WAVE])[:40], "line 40: no line announces acceleration"),
    "ESM without count": (
        changed(write.esm(WAVE), "NDATA: 37", "NDATA:"),
        "line 64: the header ends here and lacks NDATA",
    ),
    "ESM velocity": (
        changed(write.esm(WAVE), "UNITS: cm/s^2", "UNITS: cm/s"),
        "line 7: a unit of acceleration expected; got 'cm/s'",
    ),
    "K-NET divisor": (
        write.knet(COUNTS, factor="3920(gal)/0"),
        "line 14: the divisor of the scale factor must not be 0",
    ),
    "K-NET rate": (
        [line for line in write.knet(COUNTS) if "Freq" not in line],
        "line 17: the header lacks the sampling frequency",
    ),
    "K-NET empty": (write.knet(COUNTS)[:17], "17 lines of header, then counts expected"),
    "CSMIP unit": (
        changed(write.csmip_v1([WAVE]), "units of g.  ", "units of volts.  "),
        "a unit of acceleration expected; got 'volts'",
    ),
    "CSMIP format": (changed(write.csmip_v1([WAVE]), "(8f9.6)", ""), "format of the samples expected"),
    "CSMIP second channel": (
        changed(write.csmip_v2([WAVE, OTHER]), " 30 POINTS OF ACCEL", " x POINTS OF ACCEL"),
        "number of points, time step or rate, and unit expected",
    ),
    "SMC comments": (
        changed(write.smc(WAVE), "    -32768         2", "    -32768        -2"),
        "line 13: the number of lines of comment must be a whole number from 0",
    ),
    "GeoNet cut": (write.geonet([WAVE])[:30], "line 30: the file ends after 0 samples of 37"),
}


@pytest.mark.parametrize("kind", WRONG)
def test_an_error_names_file_and_line(make, kind):
    lines, expected = WRONG[kind]
    message = refusal_of(make(lines))
    assert message.startswith("file.x")
    assert expected in message


def test_files_that_are_none(tmp_path, make):
    missing = refusal_of(tmp_path / "missing.at2")
    assert missing.endswith("cannot be read: No such file or directory; check the path")
    assert "a folder" in refusal_of(tmp_path)
    assert "is empty" in refusal_of(make(b"\n \n"))
    assert "cannot be read" in refusal_of("null\0byte")
    assert "not a regular file" in refusal_of("/dev/zero")
    large = make(b"1\n")
    with large.open("ab") as file:
        file.truncate(10**10)
    assert "larger than 300 MB" in refusal_of(large)
    with pytest.raises(TypeError, match="source must be a path, bytes, or a Stream or Trace of ObsPy; got 3"):
        rk.read_ground_motion(3)


def test_bytes_in_memory_are_the_file_of_that_name(make):
    path = make("\n".join(write.peer(WAVE)).encode())
    motion = rk.read_ground_motion(path.read_bytes(), name=path.name)
    assert motion == rk.read_ground_motion(path)
    assert motion.file.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert rk.read_ground_motions(path.read_bytes(), name=path.name) == rk.read_ground_motions(path)
    assert rk.read_ground_motion(path.read_bytes()).file.name == "bytes"


def test_errors_of_bytes_in_memory_give_their_name(make):
    for data, message in (
        (b"  \n", "town a: the file is empty"),
        (b"\xef\xbb\xbf", "town a: the file is empty"),
        (b"1\n2\n", "town\na: the file does not state"),
    ):
        with pytest.raises(rk.RecordError, match=f"^{message}"):
            rk.read_ground_motion(data, name="town\na")
    with pytest.raises(TypeError, match="name must be omitted for a source that is not bytes; got 'a'"):
        rk.read_ground_motion(make(b"1\n"), name="a")
    with pytest.raises(TypeError, match="name must be a str; got 3"):
        rk.read_ground_motion(b"1\n", name=3)


@pytest.mark.parametrize(
    ("content", "doubt"),
    [
        (b"MZ\0\1\2", ": a binary file"),
        (
            b"\n some words\nin a letter\n",
            ": neither a record nor a table with a column 'file'; it begins with 'some words'",
        ),
        (b"\xff\xfe\xfd\n\n", ": neither a record nor a table with a column 'file'; it begins with 'ÿþý'"),
        (
            b"0,00,0,01\n0,01,0,02\n",
            ", line 1: commas separate the numbers and stand in them: put ; between the numbers; got '0,00,0,01'",
        ),
        (
            b"1 2 3 4 5\n6 7 8 9 10\n",
            (
                ", line 1: 5 numbers in a line; for samples one after another, put a line with their number and the time step"
                " before them, such as 1560 0.02"
            ),
        ),
        (
            b"time NS\n1 2 3\n4 5 6\n",
            ", line 2: 3 numbers in a line; more than two need a line of 3 titles that begins with the time, such as time,NS,EW",
        ),
    ],
)
def test_unknown_content_names_what_is_expected_and_the_extra_for_more_formats(
    make, monkeypatch, content, doubt
):
    monkeypatch.setitem(sys.modules, "obspy", None)
    told = refusal_of(make(content))
    if doubt.startswith(", line"):
        assert told == f"file.x{doubt}"
        return
    formats = "formats: PEER AT2, COSMOS, CSMIP, USC, SMC, K-NET, ESM, GeoNet, text in columns"
    more = "ObsPy reads more formats: run pip install '.[obspy]' in a copy of the repository"
    assert told == f"file.x{doubt}; {formats}; {more}"


def test_channel_must_be_one_of_the_file(make):
    path = make(write.csmip_v1([WAVE, OTHER]))
    with pytest.raises(ValueError, match=r"^channel must be 1 to 2, the channels of file.x; got 3$"):
        rk.read_ground_motion(path, 3)
    with pytest.raises(ValueError, match="channel must be a whole number"):
        rk.read_ground_motion(path, 0)


@pytest.mark.parametrize(
    "arguments, expected",
    [
        ({"units": "g"}, "file.x: the file states the unit of its samples, g; do not give units"),
        ({"step": 0.01}, "file.x: the file states its time step, 0.01; do not give step"),
    ],
)
def test_unit_and_step_that_the_file_states_are_not_given_again(make, arguments, expected):
    assert refusal_of(make(write.peer(WAVE)), **arguments) == expected


@pytest.mark.parametrize(
    "arguments, expected",
    [
        ({}, "file.x: the file does not state the unit of its samples; give it, for example units='m/s²'"),
        ({"units": "g"}, "file.x: the file does not state its time step; give it, for example step=0.01"),
    ],
)
def test_unit_and_step_are_never_guessed(make, arguments, expected):
    assert refusal_of(make(["1", "2"]), **arguments) == expected


@pytest.mark.parametrize(
    "header, step",
    [
        (["# acceleration in g, dt = 0.01 s"], 0.01),
        (["acceleration (g)", "DT=0.01 s, NPTS=2"], 0.01),
        (["acceleration (g), time step: 1D-2 sec"], 0.01),
        (["acceleration (g)", "sampling interval 0.005"], 0.005),
        (["acceleration (g), step 0.5 s"], 0.5),
        (["sampling rate: 100 Hz", "acceleration (g)"], 0.01),
        (["acceleration (g), dt = 10 ms"], None),
        (["acceleration (g), dt = 0.01 s", "time step 0.02 s"], None),
        (["acceleration (g), dt = 0.01 s", "time step in the table"], None),
        (["acceleration (g), dt = 0"], None),
        (["acceleration (g), dt = 1e999 s"], None),
        (["acceleration (g), dt = 1,5 ms"], None),
        (["acceleration (g), dt = 2,5e-3 s"], None),
        (["acceleration (g)", "Step 1, baseline corrected"], None),
        (["acceleration (g)", "processing step 2"], None),
        (["acceleration (g)", "Step: 3"], None),
        (["acceleration (g), time step = 5", "(ms)"], None),
        (["acceleration (g), original dt = 0.005 s, resampled to 0.01 s"], None),
        (["acceleration (g), sampling rate 100"], None),
        (["acceleration (g), dt = 100 Hz"], None),
    ],
)
def test_step_above_a_column_of_samples_is_taken_if_it_is_the_only_one(make, header, step):
    path = make([*header, "0.1", "-0.2"])
    if step is None:
        assert refusal_of(path).startswith("file.x: the file does not state its time step")
    else:
        assert rk.read_ground_motion(path).step == step


@pytest.mark.parametrize("step", [0.005, 1 / 128])
def test_step_that_a_message_on_rounded_times_names_is_taken(make, step):
    path = make(["time (s),acc (g)", *(f"{step * k:.2f},{WAVE[k]}" for k in range(20))])
    example = refusal_of(path).partition("for example step=")[2]
    motion = rk.read_ground_motion(path, step=float(example))
    assert (motion.step, len(motion.acceleration)) == (float(example), 20)


def test_times_that_do_not_increase_are_not_asked_for_a_step_alone(make):
    """With a step they are refused, too."""
    path = make(["time (s),acc (g)", *(f"{0.01 * k:.3g},0.1" for k in range(1_010))])
    way_out = "correct the times, or remove their column and give the step"
    assert way_out in refusal_of(path)
    assert way_out in refusal_of(path, step=0.01)
    column = make(["acc (g)", *["0.1"] * 1_010])
    assert rk.read_ground_motion(column, step=0.01).step == 0.01


@pytest.mark.parametrize("old", [False, True])
@pytest.mark.parametrize("third", [[], ["ACCELERATION TIME SERIES"]])
def test_peer_file_without_its_line_of_the_unit_takes_the_argument(make, third, old):
    lines = write.peer(WAVE, old=old)
    path = make([*lines[:2], *third, *lines[3:]])
    assert refusal_of(path) == (
        "file.x: line 3, 'ACCELERATION TIME SERIES IN UNITS OF G', is missing: the file does not state the unit of its "
        "samples; give it, for example units='g'"
    )
    motion = rk.read_ground_motion(path, units="g")
    assert (motion.step, motion.name, motion.component) == (0.01, "Valley-02, 1/2/1940, Town Array #9", "180")
    np.testing.assert_allclose(motion.acceleration, G * WAVE, rtol=1e-12)


def test_peer_file_of_another_quantity_without_its_unit_is_refused(make):
    lines = write.peer(WAVE, title="VELOCITY TIME SERIES")
    assert "but the file holds velocity" in refusal_of(make(lines), units="g")


@pytest.mark.parametrize("units", ["m/s", 3, "furlong", ""])
def test_units_are_units_of_acceleration(make, units):
    with pytest.raises(
        (TypeError, ValueError), match="units must be one of 'm/s²', 'cm/s²', 'mm/s²', 'g', 'gal'; got"
    ):
        rk.read_ground_motion(make(["1", "2"]), units=units, step=0.1)


@pytest.mark.parametrize(
    "units, size",
    [
        ("m/s²", 1),
        ("m/s2", 1),
        ("m/s^2", 1),
        ("m/s**2", 1),
        ("m s-2", 1),
        ("cm/s/s", 0.01),
        ("Gal", 0.01),
        ("CMS/SEC/SEC", 0.01),
        ("mm/s2", 1e-3),
        ("g", G),
        ("G", G),
    ],
)
def test_spellings_of_units(make, units, size):
    assert rk.read_ground_motion(make(["1", "-2"]), units=units, step=0.1).pga == 2 * size


@pytest.mark.parametrize("separator", [" ", "\t", ",", ";", " , ", "   "])
def test_separators_of_columns(make, separator):
    lines = [f"{0.02 * k:.2f}{separator}{value}" for k, value in enumerate([0, 1, -3.5, 2e-1])]
    motion = rk.read_ground_motion(make(lines), units="g")
    assert motion.step == 0.02
    np.testing.assert_allclose(motion.acceleration, np.array([0, 1, -3.5, 0.2]) * G)


@pytest.mark.parametrize(
    "header, size",
    [
        (["time,acc (g)"], G),
        (["# recorded somewhere", "", "t [s]; a [cm/s²]"], 0.01),
        (["% Units: gal"], 0.01),
        (["acceleration in units of m/s/s"], 1.0),
        (["units = mm/s2 (mm/s^2)"], 1e-3),
        (["time,acceleration", "s,m/s^2"], 1.0),
        (["time acceleration", "s g"], G),
        (["# time | acc", "# sec | cm/s/s"], 0.01),
        (["acceleration m/s^2"], 1.0),
        (["time,acc_g"], G),
        (["time in s, acceleration in gal"], 0.01),
        (['"t","acceleration (mm/s2)"'], 1e-3),
    ],
)
def test_a_unit_in_the_header_counts_if_it_is_the_only_one(make, header, size):
    path = make([*header, "0, 1", "0.5, 2"])
    assert rk.read_ground_motion(path).pga == pytest.approx(2 * size)
    said = refusal_of(path, units="g" if size < 1.1 else "m/s²")
    assert said.startswith("file.x: the header names ")
    assert said.endswith(
        "s²; omit units, or correct the header" if size < 1.1 else "g; omit units, or correct the header"
    )


@pytest.mark.parametrize(
    "header",
    [
        ["a mass of 5 g"],
        ["velocity (cm/s)"],
        ["time acc"],
        [],
        ["El Centro, recorded in G building", "time,acceleration"],
        ["Accelerations recorded in G building"],
        ["Accelerograph of site G"],
        ["El Centro (G)", "time,acceleration"],
    ],
)
def test_a_unit_that_is_not_clear_must_be_given(make, header):
    assert "give it, for example units=" in refusal_of(make([*header, "0, 1", "0.5, 2"]))


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        (["acc (g) or acc (m/s2)"], "file.x: the header names the units g and m/s², not cm/s²; give one of"),
        (
            ["time,acceleration", "s,cm/s"],
            "file.x, line 2: acceleration in m/s², cm/s², mm/s², g or gal expected",
        ),
        (
            ["time (s), velocity (cm/s)"],
            "file.x, line 1: acceleration in m/s², cm/s², mm/s², g or gal expected",
        ),
        (["# time (s) velocity (cm/s)"], "expected; the header gives 'cm/s'"),
        (["s mg"], "expected; the header gives 'mg'"),
        (["time (ms), acceleration"], "file.x, line 1: times in s expected; the header gives 'ms'"),
    ],
)
def test_a_header_that_contradicts_the_unit_given_is_refused(make, header, expected):
    assert expected in refusal_of(make([*header, "0, 1", "0.5, 2"]), units="gal")


def test_several_units_in_a_header_need_an_argument_and_a_warning(make):
    path = make(["# acceleration (g)", "# units: m/s2", "0, 1", "0.5, 2"])
    assert refusal_of(path) == "file.x: the header names the units g and m/s²; give one of them as units"
    with pytest.warns(rk.InputWarning, match=r"^file.x: units='m/s²' is used; the header names g and m/s²$"):
        assert rk.read_ground_motion(path, units="m/s2").pga == 2.0


def test_the_unit_given_beats_one_that_prose_mentions(make):
    path = make(["El Centro, at most 50 cm/s^2", "time,acceleration", "0, 1", "0.5, 2"])
    assert rk.read_ground_motion(path).pga == 0.02
    assert rk.read_ground_motion(path, units="cm/s2").pga == 0.02
    with pytest.warns(
        rk.InputWarning, match=r"^file.x: units='m/s²' is used, though the header mentions cm/s²$"
    ):
        assert rk.read_ground_motion(path, units="m/s²").pga == 2.0


def test_the_unit_that_a_header_states_beats_one_that_prose_mentions(make):
    path = make(["at most 50 cm/s^2", "time, acceleration (g)", "0, 1", "0.5, 2"])
    assert rk.read_ground_motion(path).pga == pytest.approx(2 * 9.80665)


@pytest.mark.parametrize("third", ["ACCELERATION TIME SERIES (CM/S/S)", "ACCELERATION TIME SERIES IN CM/S/S"])
def test_peer_file_states_its_unit_in_other_words_too(make, third):
    lines = write.peer(WAVE)
    path = make([*lines[:2], third, *lines[3:]])
    np.testing.assert_allclose(rk.read_ground_motion(path).acceleration, 0.01 * WAVE, rtol=1e-12)
    assert "the header names cm/s²; omit units, or correct the header" in refusal_of(path, units="g")


def test_header_in_latin_1_and_with_a_mark_of_utf_8(make):
    assert rk.read_ground_motion(make("t, a (cm/s²)\n0, 1\n1, 2".encode("latin-1"))).pga == 0.02
    assert rk.read_ground_motion(make("\ufefft, a (cm/s²)\n0, 1\n1, 2\x1a".encode())).pga == 0.02


@pytest.mark.parametrize(
    "times, step",
    [
        (["0.000", "0.003", "0.007", "0.010"], 0.0033),
        (["5", "5.1", "5.2", "5.3"], 0.1),
        (["0", "1.0000000E-02", "2.0000000E-02"], 0.01),
        (["-1.000000E+00", "-9.950000E-01", "-9.900000E-01"], 0.005),
        ([str(np.float32(k * 0.02).astype(float)) for k in range(500)], 0.02),
    ],
)
def test_equidistant_times_may_be_rounded(make, times, step):
    motion = rk.read_ground_motion(make([f"{time} 1" for time in times]), units="g")
    assert motion.step == pytest.approx(step, rel=1e-6 if step != 0.0033 else 0.05)


@pytest.mark.parametrize(
    "rows, expected",
    [
        (
            ["0 1", "0.1 1", "0.3 1", "0.4 1"],
            "line 3: the times are not equidistant: 0.3 s follows 0.1 s, and most steps are 0.1 s",
        ),
        (["0 1", "0 1", "0 1"], "line 3: the times must increase"),
        (["0.00 1", "0.01 1", "0.01 1", "0.02 1"], "the times are not equidistant"),
        (["0 1"], "line 1: at least two times expected"),
        (["0 1", "0.1 1", "0.2"], "line 3: 2 numbers expected; got '0.2'"),
        (["0 1", "0.1 1", "nan 1"], "line 3: 2 numbers expected; got 'nan 1'"),
        (["0 1", "1e-99999999999999999999 1", "2 1"], "line 2: 2 numbers expected"),
        (["0,1;1,0", "0,2;1.1"], "line 2: 2 numbers expected; got '0,2;1.1'"),
        (
            [*(f"{0.02 * k:.4f} 1" for k in range(100)), *(f"{2 + 0.0201 * k:.4f} 1" for k in range(50))],
            "line 105: the times are not equidistant: 2.0804 s where 2.08 s is expected, at a step of 0.02 s",
        ),
        (["time,NS,EW", "2026-01-01,0,1"], "file.x, line 2: numbers alone expected; got '2026-01-01,0,1'"),
        (["time,NS,EW", "0,1,2", "1,2"], "line 3: 3 numbers expected; got '1,2'"),
    ],
)
def test_columns_that_are_refused(make, rows, expected):
    assert expected in refusal_of(make(rows), units="g")


@pytest.mark.parametrize(
    ("header", "separator", "units", "sizes"),
    [
        (["time,NS,UD"], ",", "g", [G, G]),
        (["# in units of g", "time,acc_NS,acc_UD"], ",", None, [G, G]),
        (["Town", "t (s); NS (g); UD (cm/s2)"], ";", None, [G, 0.01]),
        (["# t [s]  NS [g]  UD [gal]"], " ", None, [G, 0.01]),
        (["T,NS,UD", "s,g,cm/s2"], "\t", None, [G, 0.01]),
        (["Time (s),Acc (NS),Acc (UD)", "recorded, on, 3 May"], ",", "g", [G, G]),
        (["Elapsed time in s,NS_g,UD_gal"], ",", None, [G, 0.01]),
    ],
)
def test_columns_under_titles_are_channels(make, header, separator, units, sizes):
    rows = (separator.join(row.split()) for row in ("0 1 -2", "0.02 3 1", "0.04 0 0"))
    path = make([*header, *(f"{row}," if separator == "," else row for row in rows)])
    motions = rk.read_ground_motions(path, units=units)
    assert [(each.component, each.vertical, each.step) for each in motions] == [
        ("NS", False, 0.02),
        ("UD", True, 0.02),
    ]
    assert [each.pga for each in motions] == pytest.approx([3 * sizes[0], 2 * sizes[1]])
    assert rk.read_ground_motion(path, 2, units=units).component == "UD"


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        (
            "Time (s),Acc (g),Temperature (C)",
            "'Temperature (C)' is not known as an acceleration; name directions",
        ),
        ("time (s),acc (g),rotation rate (rad/s)", "'rotation rate (rad/s)' is not known as an acceleration"),
        ("Time,Acc (g),Ground velocity", "'Ground velocity' is not known as an acceleration"),
        ("time (s),acc NS (milli-g),acc EW (g)", "'acc NS (milli-g)' is not known as an acceleration"),
        ("time (s),NS (10^-3 g),EW (g)", "'NS (10^-3 g)' is not known as an acceleration"),
        ("time (s),NS (g),EW (mg)", "'EW (mg)' is not known as an acceleration"),
        (
            "time (s),acc NS (m/s2),acc EW",
            "a unit of acceleration expected in the title 'acc EW', as in others",
        ),
        ("time,sample,acc (g)", "'sample' is not known as an acceleration"),
        ("time,a,v", "'v' is not known as an acceleration"),
        ("time,NS_mm,EW_mm", "'NS_mm' is not known as an acceleration"),
        ("time,NS,time", "'time' is not known as an acceleration"),
        ("T (s),Sa (g),Sd (cm)", "'Sa (g)' is not known as an acceleration"),
        ("time,acc,rot\ns,m/s2,rad/s", "line 1: 'rot rad/s' is not known as an acceleration"),
        ("t,NS,EW\ns,g,", "a unit of acceleration expected in the title 'EW', as in others"),
        ("time_ms,acc,NS", "line 1: times in s expected; the header gives 'time_ms'"),
        ("t,NS,EW\nms,g,g", "line 1: times in s expected; the header gives 't ms'"),
        ("NS (g),EW (g),UD (g)", "more than two need a line of 3 titles that begins with the time"),
    ],
)
def test_columns_that_may_be_other_quantities_are_refused(make, header, expected):
    assert expected in refusal_of(make([*header.split("\n"), "0,1,2", "1,2,3"]))


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        (
            "time,velocity",
            "acceleration in m/s², cm/s², mm/s², g or gal expected; the header gives 'velocity'",
        ),
        ("time_ms,acc_g", "times in s expected; the header gives 'time_ms'"),
        ("Time (milliseconds),acc (g)", "times in s expected; the header gives 'milliseconds'"),
    ],
)
def test_titles_of_two_columns_that_are_other_quantities_are_refused(make, header, expected):
    assert expected in refusal_of(make([header, "0,1", "1,2"]), units="g" if "(g)" not in header else None)


@pytest.mark.parametrize(
    ("lines", "vertical"),
    [
        (["time (s),UD (g)", "0,1", "1,2"], True),
        (["time (s),U-D (g)", "0,1", "1,2"], True),
        (["time (s),Vertical component (g)", "0,1", "1,2"], True),
        (["# Component: UP", "# time (s), acc (g)", "0,1", "1,2"], True),
        (["A", "B", "Component: Up", "Unit: g", "NPTS=2, DT=0.01", "0.1 0.2"], True),
        (["Channel: HNZ", "# time (s), acc (g)", "0,1", "1,2"], True),
        (["Component,UP", "# time (s), acc (g)", "0,1", "1,2"], True),
        (["unit: g", "Trigger time (s) 2.3 level (m/s2)", "Zeit,a", "0,1", "0.5,2"], False),
        (["Duration (min) and peak (g)", "time (s), acc (g)", "0,1", "1,2"], False),
        (["Channel: 3", "Component: Vertical", "# time (s), acc (g)", "0,1", "1,2"], True),
        (["Orientation: Down, Component: E", "# time (s), acc (g)", "0,1", "1,2"], False),
        (["t (s),SE (g)", "0,1", "1,2"], False),
        (["Sample time (s),acc (g)", "1,1", "2,2"], False),
        (["Sampling interval (ms) 10 PGA (g) 2", "time (s),acc (g)", "0,1", "1,2"], False),
        (["Time (s)  Vertical acceleration (g)", "0 1", "1 2"], True),
        (["time (s),V (g)", "0,1", "1,2"], True),
        (["time (s),acc (Z) (g)", "0,1", "1,2"], True),
        (["dt = 0.01 s", "Vertical acceleration (g)", "0.1", "0.2"], True),
        (["# Component: A-CZ", "# time (s), acc (g)", "0,1", "1,2"], False),
        (["# Component: N90E", "# time (s), acc (g)", "0,1", "1,2"], False),
        (["# Comp: V2, processed", "# time (s), acc (g)", "0,1", "1,2"], False),
        (["time (s),az 90 (g)", "0,1", "1,2"], False),
        (["time (s),u_g (g)", "0,1", "1,2"], False),
        (["time (s),Acc V2 (g)", "0,1", "1,2"], False),
        (["time (s),acc MQZ (g)", "0,1", "1,2"], False),
        (["time (s),Down-hole acceleration (g)", "0,1", "1,2"], False),
        (["time (s),Acceleration up to 25 Hz (g)", "0,1", "1,2"], False),
        (["time (s),Acc vertical array NS (g)", "0,1", "1,2"], False),
        (["time (s),SA-NS (g)", "0,1", "1,2"], False),
        (["Component: NS", "Component: UP", "# time (s), acc (g)", "0,1", "1,2"], False),
        (["Acceleration in g", "Freq: 200Hz", "Time (sec) Acceleration in g", "0 1", "1.0 2"], False),
        (["Acceleration in g", "Sampling freq;50", "0;1", "1.0;2"], False),
    ],
)
def test_title_of_two_columns_or_a_line_above_names_the_vertical(make, lines, vertical):
    assert rk.read_ground_motion(make(lines)).vertical == vertical


def test_third_direction_of_a_sensor_is_vertical(make):
    records = rk.read_ground_motion(
        make(["PGA 1 g", "time (s),ax (g),ay (g),az (g)", "0,1,2,3", "1,2,3,4"]), channel=3
    )
    assert records.vertical


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (
            ["sample,acc (g)", "0,0.1", "1,0.2"],
            "the first column numbers the samples; if it is no time in s, remove it",
        ),
        (["# dt=0.01 s", ",acc (g)", "0,0.1", "1,0.2"], "the first column numbers the samples"),
        (["# g = 9.81 m/s2", "time,acc", "0,0.1", "0.5,0.2"], "does not state the unit of its samples"),
        (
            ["# PGA 0.25 g (2.45 m/s2)", "time,acc", "0,0.1", "0.5,0.2"],
            "does not state the unit of its samples",
        ),
        (["# multiply by 9.81 to get m/s2", "time,acc", "0,0.1", "0.5,0.2"], "does not state the unit"),
        (["# converted from m/s2 to g", "time,acc", "0,0.1", "0.5,0.2"], "does not state the unit"),
        (["# original units m/s2, now g", "time,acc", "0,0.1", "0.5,0.2"], "does not state the unit"),
        (["# trigger level: 0.02 m/s2", "time,acc", "0,0.1", "0.5,0.2"], "does not state the unit"),
        (["unit: m/s2", "time (s),level (g)", "0,0.1", "0.5,0.2"], "the header names the units g and m/s²"),
        (["# gravity: 9.81 m/s2", "time,acc", "0,0.1", "0.5,0.2"], "does not state the unit"),
        (["Time step,acc (g)", "1,0.1", "2,0.2"], "the first column numbers the samples"),
        (["# sample acc_g", "1.0e+00 0.1", "2.0e+00 0.2"], "the first column numbers the samples"),
        (["Time [ms]  Acceleration [m/s2]", "0 0.1", "1 0.2"], "times in s expected; the header gives 'ms'"),
        (["acceleration (10^-3 m/s2)", "dt = 0.01", "0.1", "0.2"], "does not state the unit of its samples"),
        (["acceleration (x 0.01 m/s2)", "dt = 0.01", "0.1", "0.2"], "does not state the unit of its samples"),
        (
            ["unit: g", "NPTS=2, DT=0.01", "0.1,0.2", "0.3,0.4", "0.5,0.6"],
            "more than the 2 samples of the header",
        ),
        (["unit: g", "NPTS=2, DT=1 ms", "0.1 0.2"], "a time step in s expected; got 1 ms"),
        (["Period (s),Sa (g)", "0.1,0.5", "0.2,0.6"], "times in s and accelerations expected"),
        (["T(s) SA(g)", "0.1 0.5", "0.2 0.6"], "times in s and accelerations expected"),
        (["Period (s) Spectral acceleration (g)", "0.1 0.5", "0.2 0.6"], "times in s and accelerations"),
        (["Periode [s];Sa [m/s²]", "0.1;0.5", "0.2;0.6"], "times in s and accelerations expected"),
        (["Frequency (Hz),Acceleration (g)", "0.1,0.5", "0.2,0.6"], "times in s and accelerations expected"),
        (
            ["acc (gal), dt = 0.01 s", "1560", "0.5", "0.25"],
            "remove each line that is no sample, or write 1560.0 if it is one",
        ),
    ],
)
def test_what_a_file_does_not_state_is_not_guessed(make, lines, expected):
    assert expected in refusal_of(make(lines))


@pytest.mark.parametrize(
    "line",
    [
        "1940,El Centro",
        "Loma Prieta (1989), Gilroy (090)",
        "Sampling frequency (Hz),50",
        "Return period,475 years",
        "Network CS, Station ABC",
        "Motion 1, spectrally matched",
        "Duration: 5 mins, triggered",
        "Acceleration in g (multiply by 9.81 for m/s2)",
        "Acceleration in g (1g=9.81 m/s2)",
        "acceleration due to gravity = 9.81 m/s2",
        "Peak acceleration (m/s2): 1.96",
        "Multiplexed, units: g",
        "PGA 0.2 g, as recorded",
        "Divide by 0.102 for m/s2 - units: g",
    ],
)
def test_words_above_the_titles_do_not_change_the_reading(make, line):
    motion = rk.read_ground_motion(make([line, "Time (s),Acceleration (g)", "0,0.1", "0.02,0.2", "0.04,0.1"]))
    assert (motion.step, motion.pga, motion.vertical) == (0.02, pytest.approx(0.2 * 9.80665), False)


@pytest.mark.parametrize(
    "line",
    [
        "PGA (0.2 m/s2)",
        "Peak acceleration (0.2 m/s2)",
        "Station G, PGA = 0.2 m/s2",
        "Max. 0.2 m/s2 = 0.02 g",
        "Acceleration range -1.2 to 2.3 m/s2",
        "Original acceleration record in m/s2",
        "Digitiser resolution 24 bit. Acceleration in m/s2",
        "Recorded in building (G), Acceleration in m/s2",
    ],
)
def test_the_unit_of_a_peak_is_used_where_there_is_no_other(make, line):
    assert rk.read_ground_motion(make([line, "0 0.1", "0.02 0.2"])).pga == 0.2


@pytest.mark.parametrize(
    ("lines", "stated"),
    [
        (["PGA = 1.96 m/s2 at 0.02 s", "0 0.1", "0.02 0.2"], "1.96"),
        (["PGA = 981 mm/s2", "0 500", "0.02 900"], "0.981"),
        (["Peak acceleration (g): 0.02", "unit: g", "0 0.1", "0.02 0.2"], "0.19613"),
        (["Peak Acc (g),0.02", "Time,Acc", "0,0.1", "0.02,0.2"], "0.19613"),
        (["A", "B", "max. 20 gal", "unit: g", "NPTS=2, DT=0.01", "0.1 0.2"], "0.2"),
    ],
)
def test_peak_in_words_that_is_not_that_of_the_samples_gets_a_warning(make, lines, stated):
    with pytest.warns(rk.InputWarning, match=f"the header states {stated} m/s²"):
        rk.read_ground_motion(make(lines))


def test_empty_rows_of_a_spreadsheet_end_the_samples(make):
    lines = ["A", "B", "unit: g", "NPTS= 4, DT= .02 SEC,,,", "0.1,0.2,0.3,0.4", ",,,", ",,,", "End of file"]
    assert len(rk.read_ground_motion(make(lines)).acceleration) == 4


def test_step_of_the_times_that_the_header_states_otherwise_gets_a_warning(make):
    path = make(["# dt=0.01 s", "time (s),acc (g)", "0,0.1", "0.02,0.2", "0.04,0.1"])
    expected = "the times give a step of 0.02 s, which is taken; the header states 0.01 s"
    with pytest.warns(rk.InputWarning, match=expected):
        assert rk.read_ground_motion(path).step == 0.02


def test_step_that_is_probably_in_ms_gets_a_warning(make):
    with pytest.warns(rk.InputWarning, match=r"^file.x: a time step of 10 s is unusual: times are in s$"):
        rk.read_ground_motion(make(["0 1", "10 2", "20 0"]), units="m/s²")


class Stats(types.SimpleNamespace):
    pass


class Trace:
    def __init__(self, data, delta=0.01):
        self.data = data
        self.stats = Stats(delta=delta, network="XY", station="TOWN", channel="HNE")


def test_traces_of_obspy_need_their_unit_and_no_counts():
    trace = Trace(np.array([0.0, 0.5, -1.0]))
    motion = rk.read_ground_motion(trace, units="cm/s²")
    assert (motion.pga, motion.step, motion.name, motion.component, motion.file) == (
        0.01,
        0.01,
        "XY.TOWN",
        "HNE",
        None,
    )
    both = rk.read_ground_motions(types.SimpleNamespace(traces=[trace, Trace(np.array([2.0]))]), units="m/s²")
    assert [each.pga for each in both] == [1.0, 2.0]
    assert "give it, for example units=" in refusal_of(trace)
    assert "the samples are integers, that is, counts of the recorder" in refusal_of(
        Trace(np.array([1, 2])), units="g"
    )
    assert "fill the gaps" in refusal_of(Trace(np.ma.masked_array([1.0, 2.0], [0, 1])), units="g")
    assert "a row of real numbers" in refusal_of(Trace(np.array([])), units="g")
    assert "no trace" in refusal_of(types.SimpleNamespace(traces=[]), units="g")
    assert "sample 0" in refusal_of(Trace(np.array([np.nan])), units="g")
    assert "step must lie in" in refusal_of(Trace(np.array([1.0]), delta=0.0), units="g")


def test_other_files_are_left_to_obspy(make, monkeypatch):
    formats = []

    def read(file, format):  # noqa: A002
        formats.append(format)
        if format != "SAC":
            raise KeyError(format)
        assert file.read() == b"\0\1\2\n"
        return types.SimpleNamespace(traces=[Trace(np.array([1.0, 3.0]))])

    monkeypatch.setitem(sys.modules, "obspy", types.SimpleNamespace(read=read))
    motion = rk.read_ground_motion(make(b"\0\1\2\n"), units="m/s²")
    assert (motion.pga, motion.file.format, formats) == (3.0, "SAC", ["MSEED", "SAC"])
    monkeypatch.setitem(sys.modules, "obspy", types.SimpleNamespace(read=None))
    assert "text in columns, MSEED, SAC, SACXY," in refusal_of(make(b"\0\1\2\n"))


def test_baseline_is_removed_and_a_wrong_name_is_no_error_of_the_file(make):
    path = make(write.peer(WAVE))
    motion = rk.read_ground_motion(path, baseline="mean")
    assert abs(motion.acceleration.mean()) < 1e-15
    assert motion.file.pga == rk.read_ground_motion(path).pga
    with pytest.raises(ValueError, match="baseline must be one of") as caught:
        rk.read_ground_motion(path, baseline="cubic")
    assert not isinstance(caught.value, rk.RecordError)


DIGEST = "827ed9f28ce58643c2473c8a3e14fbed37d3b1198995584d568eac6f7c20fefc"


def test_synthetic_motions_of_a_seed_are_the_same_on_every_machine():
    motions = rk.synthetic_ground_motions(3, seed=7)
    data = np.concatenate([motion.acceleration for motion in motions]).astype("<f8").tobytes()
    assert hashlib.sha256(data).hexdigest() == DIGEST
    assert [motion.name for motion in motions] == ["synthetic 1", "synthetic 2", "synthetic 3"]
    assert rk.synthetic_ground_motions(1, seed=7)[0] == motions[0]
    assert rk.synthetic_ground_motions(1, seed=8)[0] != motions[0]


def test_synthetic_motions_have_the_spectrum_of_the_filters():
    options = {"rise": 0.02, "strong": 1e4, "duration": 200.0}
    motions = rk.synthetic_ground_motions(60, seed=3, step=0.02, pga=1.0, **options)
    samples = np.array([motion.acceleration / np.std(motion.acceleration) for motion in motions])
    power = (np.abs(np.fft.rfft(samples)) ** 2).mean(axis=0)
    s = 1j * 2 * np.pi * np.fft.rfftfreq(samples.shape[1], 0.02)
    soil = (2 * 0.6 * 15 * s + 15**2) / (s**2 + 2 * 0.6 * 15 * s + 15**2)
    high = s**2 / (s**2 + 2 * 0.6 * 1.5 * s + 1.5**2)
    expected = np.abs(soil * high) ** 2
    bands = [slice(20, 60), slice(60, 200), slice(200, 500), slice(500, 1500)]  # up to 7.5 Hz
    found = np.array([(power[band].sum() / expected[band].sum()) for band in bands])
    np.testing.assert_allclose(found / found[1], 1.0, rtol=0.08)


def test_synthetic_motions_follow_their_envelope():
    motions = rk.synthetic_ground_motions(200, seed=5, rise=4.0, strong=8.0, decay=0.5, pga=2.5)
    assert [motion.pga for motion in motions] == pytest.approx([2.5] * 200)
    spread = np.std([motion.acceleration for motion in motions], axis=0)
    level = spread[450:800].mean()
    assert spread[0] == 0.0
    assert spread[180:220].mean() / level == pytest.approx(0.25, rel=0.15)
    assert spread[1180:1220].mean() / level == pytest.approx(np.exp(-2), rel=0.15)


@pytest.mark.parametrize(
    "wrong",
    [
        {"count": 0},
        {"seed": -1},
        {"step": 0.0},
        {"duration": 1e9},
        {"rise": 30.0},
        {"strong": 1.0},
        {"decay": -1.0},
        {"pga": 0.0},
        {"soil_frequency": 1e3},
        {"filter_damping": 0.0},
        {"count": 10_000, "duration": 1e5},
    ],
)
def test_arguments_of_synthetic_motions(wrong):
    with pytest.raises(ValueError, match=f"^{next(iter(wrong))} must"):
        rk.synthetic_ground_motions(**{"count": 1, "seed": 1} | wrong)


@pytest.mark.parametrize(
    ("samples", "units", "said"),
    [
        ([0, 300, -200], "m/s²", "a PGA of 300 m/s² is unusual: check the unit of the samples, m/s²"),
        ([0, 312, -200], "g", "a PGA of 3060 m/s² is unusual: check the unit of the samples, g"),
        ([0, 0.3, -0.2], "gal", "a PGA of 0.003 m/s² is unusual: check the unit of the samples, cm/s²"),
        ([0, 0.3, -0.2], "g", None),
        ([0, 0, 0], "g", None),
    ],
)
def test_peak_in_another_unit_is_a_warning(make, samples, units, said):
    path = make(list(map(str, samples)))
    for read in (rk.read_ground_motion, rk.read_ground_motions, rk.read_record_set):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            read(path, units=units, step=0.01)
        assert [str(each.message) for each in caught] == ([f"file.x: {said}"] if said else [])
        assert {(each.category, each.filename) for each in caught} <= {(rk.InputWarning, __file__)}
