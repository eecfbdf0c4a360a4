"""One motion in the forms in which people have it: the same samples, or a refusal whose advice works."""

import warnings

import numpy as np
import pytest

import rocking as rk

G = 9.80665
STEP = 0.02
A = np.round(0.3 * np.sin(0.7 * np.arange(600)) * np.exp(-np.arange(600) / 150), 5)
TIMES = [f"{STEP * k:.2f}" for k in range(A.size)]
VALUES = [f"{value:.5f}" for value in A]
OTHERS = [f"{-value / 2:.6f}" for value in A]


def table(head, *columns, by=",", decimal="."):
    rows = (by.join(cells).replace(".", decimal) for cells in zip(*columns, strict=True))
    return "\n".join([*head, *rows]) + "\n"


def in_lines(numbers, per_line):
    return [" ".join(numbers[k : k + per_line]) for k in range(0, len(numbers), per_line)]


def text(*lines):
    return "\n".join(lines) + "\n"


PLAIN = table(["time (s),acc (g)"], TIMES, VALUES)
IN_SI = [f"{G * value:.8f}" for value in A]
IN_GAL = [f"{100 * G * value:.6f}" for value in A]
AT2 = text("PEER", "Town, 180", "ACCELERATION TIME SERIES IN UNITS OF G", "NPTS= 600, DT= .0200 SEC")
AT2 += text(*in_lines(VALUES, 5))
COUNTS = "600 0.02"
G_UNIT, CHANNEL_2 = {"units": "g"}, {"units": "g", "channel": 2}

# Content and arguments by name.
FORMS = {
    "plain": (PLAIN.encode(), {}),
    "UTF-8 with a mark": (PLAIN.encode("utf-8-sig"), {}),
    "CRLF": (PLAIN.replace("\n", "\r\n").encode(), {}),
    "CR": (PLAIN.replace("\n", "\r").encode(), {}),
    "UTF-16": (PLAIN.encode("utf-16"), {}),
    "UTF-16, big end first": (b"\xfe\xff" + PLAIN.encode("utf-16-be"), {}),
    "UTF-16 without a mark": (PLAIN.encode("utf-16-le"), {}),
    "UTF-32": (PLAIN.encode("utf-32"), {}),
    "AT2 in UTF-16 with CRLF": (AT2.replace("\n", "\r\n").encode("utf-16"), {}),
    "Latin-1": (table(["Zeit (s);a (m/s²)"], TIMES, IN_SI, by=";").encode("latin-1"), {}),
    "long minus": (PLAIN.replace(",-", ",−").encode(), {}),
    "quotes": (('"' + PLAIN.replace(",", '","').replace("\n", '"\n"'))[:-1].encode(), {}),
    "decimal comma, semicolon": (table(["t (s);acc (g)"], TIMES, VALUES, by=";", decimal=",").encode(), {}),
    "decimal comma, tab": (table(["t (s)\tacc (g)"], TIMES, VALUES, by="\t", decimal=",").encode(), {}),
    "decimal comma, blank": (table([], TIMES, VALUES, by=" ", decimal=",").encode(), G_UNIT),
    "decimal comma, quotes": (
        table(['"t (s)","acc (g)"'], *(['"' + x + '"' for x in c] for c in (TIMES, VALUES)), by='","')
        .replace('""', '"')
        .replace('","', ";")
        .replace(".", ",")
        .replace(";", '","')
        .encode(),
        {},
    ),
    "decimal comma, one column": (table([], VALUES, decimal=",").encode(), {"units": "g", "step": STEP}),
    "decimal comma, three columns": (
        table(["time;NS;EW"], TIMES, OTHERS, VALUES, by=";", decimal=",").encode(),
        CHANNEL_2,
    ),
    "three columns": (table(["time,NS,EW"], TIMES, OTHERS, VALUES).encode(), CHANNEL_2),
    "three components": (
        table(["t (s)  H1 (g)  H2 (g)  V (g)"], TIMES, OTHERS, VALUES, OTHERS, by=" ").encode(),
        {"channel": 2},
    ),
    "line of units": (table(["time,acceleration", "s,m/s^2"], TIMES, IN_SI).encode(), {}),
    "line of units in brackets": (table(["t,NS,EW", "[s],[gal],[gal]"], TIMES, IN_GAL, OTHERS).encode(), {}),
    "gal": (table(["time,acc"], TIMES, IN_GAL).encode(), {"units": "gal"}),
    "times from one step": (
        table([], [f"{STEP * (k + 1):.2f}" for k in range(600)], VALUES).encode(),
        G_UNIT,
    ),
    "the step again": (PLAIN.encode(), {"step": STEP}),
    "name, count and step": (text("Town, 180", COUNTS, *VALUES).encode(), G_UNIT),
    "name, count and step, 8 in a line": (text("Town", COUNTS, *in_lines(VALUES, 8)).encode(), G_UNIT),
    "count and step": (text(COUNTS, *in_lines(VALUES, 5)).encode(), G_UNIT),
    "step and count": (text("acceleration in g", "0.02 600", *VALUES).encode(), {}),
    "count, then step": (text("Town", "600", "0.02", *VALUES).encode(), G_UNIT),
    "count alone": (text("Town", "600", *in_lines(VALUES, 8)).encode(), {"units": "g", "step": STEP}),
    "named counts": (text("Town", "NPTS= 600, DT= .02 SEC", *VALUES).encode(), G_UNIT),
    "named counts above more words": (
        text("NPTS=600, DT=0.02", "Town", "acceleration in g", *in_lines(VALUES, 8)).encode(),
        {},
    ),
    "named counts above columns": (("# NPTS= 600, DT= .02\n" + PLAIN).encode(), {}),
    "count and step with decimal commas": (
        text("Town", "600 0,02", *(value.replace(".", ",") for value in VALUES)).encode(),
        G_UNIT,
    ),
}


def read(content, arguments):
    return rk.read_ground_motion(content, name="file", **arguments)


@pytest.mark.parametrize("form", FORMS)
def test_all_forms_of_one_motion_give_the_same_samples(form):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        motion = read(*FORMS[form])
    assert motion.step == STEP
    assert motion.changes == ()
    np.testing.assert_allclose(motion.acceleration, G * A, rtol=0, atol=5e-8 * G)


@pytest.mark.parametrize(
    ("step", "digits", "given"),
    [(0.005, 2, None), (0.005, 2, 0.005), (0.02, 1, 0.02), (0.0025, 2, 0.0025), (1 / 128, 2, 1 / 128)],
)
def test_step_of_times_rounded_in_print_is_that_of_the_whole_column(step, digits, given):
    content = table([], [f"{step * k:.{digits}f}" for k in range(A.size)], VALUES).encode()
    if given is None:
        with pytest.warns(
            rk.InputWarning,
            match=r"^file: the times are rounded to 0.01 s; the step is taken as 0.005 s, which agrees with all of them$",
        ):
            motion = read(content, G_UNIT)
    else:
        motion = read(content, G_UNIT | {"step": given})
    assert motion.step == step
    np.testing.assert_allclose(motion.acceleration, G * A, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("content", "arguments", "advice"),
    [
        (
            table([], TIMES, VALUES, decimal=","),
            G_UNIT,
            "commas separate the numbers and stand in them: put ; between the numbers; got '0,00,0,00000'",
        ),
        (
            table([], TIMES, OTHERS, VALUES),
            CHANNEL_2,
            "more than two need a line of 3 titles that begins with the time, such as time,NS,EW",
        ),
        (
            text("Town", *in_lines(VALUES, 8)),
            G_UNIT,
            "put a line with their number and the time step before them, such as 1560 0.02",
        ),
        (
            table(["time,acc", "s,m/s^2"], TIMES, IN_SI),
            G_UNIT,
            "the header names m/s²; omit units, or correct the header",
        ),
        (PLAIN, {"step": 0.01}, "the times give a step of 0.02 s; omit step, or correct the times"),
        (text(COUNTS, *VALUES[:-1]), G_UNIT, "the file ends after 599 samples of 600"),
        (text(COUNTS, *VALUES, "0"), G_UNIT, "more than the 600 samples of the header"),
        (
            table([], [f"{0.0125 * k:.1f}" for k in range(20)], VALUES[:20]),
            G_UNIT,
            "or if they are rounded, give a step, for example step=",
        ),
        (PLAIN.encode("utf-16")[:-1], {}, "no text, or an incomplete one"),
    ],
)
def test_what_is_not_clear_is_refused_with_advice(content, arguments, advice):
    with pytest.raises(rk.RecordError) as caught:
        read(content if isinstance(content, bytes) else content.encode(), arguments)
    assert advice in str(caught.value)


UNEVEN = np.cumsum(np.where(np.arange(600) % 7 == 3, 0.031, STEP)) - STEP


def test_uneven_times_are_resampled_at_a_step_along_straight_lines():
    content = table([], [f"{time:.3f}" for time in UNEVEN], VALUES).encode()
    with pytest.raises(
        rk.RecordError,
        match=r"0.071 s follows 0.040 s, .*to resample them along straight lines, .*, for example step=0.02$",
    ):
        read(content, G_UNIT)
    with pytest.warns(rk.InputWarning, match=r"^file: the times are uneven; .* at a step of 0.001 s$"):
        motion = read(content, G_UNIT | {"step": 0.001})
    assert motion.changes == ("resampled from uneven times to 0.001 s along straight lines",)
    kept = np.rint(UNEVEN / 0.001).astype(int)
    np.testing.assert_allclose(motion.acceleration[kept], G * A, rtol=0, atol=1e-12)
    between = np.interp(motion.times, UNEVEN, G * A)
    np.testing.assert_allclose(motion.acceleration, between, rtol=0, atol=1e-12)


@pytest.mark.parametrize("times", [["0", "0.1", "0.1", "0.5", "0.6"], ["0", "0.3", "0.1", "0.5", "0.9"]])
def test_times_that_do_not_increase_are_not_resampled(times):
    content = table([], times, VALUES[:5]).encode()
    with pytest.raises(rk.RecordError, match="the times must increase from line to line to be resampled"):
        read(content, G_UNIT | {"step": 0.01})


def test_counts_need_samples_in_their_number():
    """Two columns whose first row could be a number of samples and a step stay columns."""
    motion = read(b"10 0.5\n11 0.6\n12 0.7\n", G_UNIT)
    assert motion.step == 1.0
    assert motion.acceleration.size == 3


def test_table_of_a_spreadsheet_in_utf_16_with_decimal_commas_is_a_table(tmp_path):
    (tmp_path / "a.csv").write_bytes(PLAIN.encode())
    (tmp_path / "set.csv").write_bytes("file;scale;magnitude\r\na.csv;2,5;6,5\r\n".encode("utf-16"))
    records = rk.read_record_set(tmp_path / "set.csv")
    assert records.columns["magnitude"].tolist() == [6.5]
    assert records[0].factor == 2.5
