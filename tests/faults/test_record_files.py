"""Damaged record files: each gives either one line that says what is wrong, or a motion of finite samples."""

import random
import re
import sys
import time
import warnings
from contextlib import suppress
from itertools import product

import numpy as np
import pytest

import record_files as write
import rocking as rk
from rocking.records import text_file

WAVE = np.round(20 * np.sin(np.arange(43)) * np.exp(-np.arange(43) / 9), 3)
FORMATS = {
    "PEER": write.peer(WAVE / 20),
    "PEER, old": write.peer(WAVE / 20, old=True),
    "SMC": write.smc(WAVE),
    "CSMIP V1": write.csmip_v1([WAVE / 30, WAVE[:20] / 30]),
    "CSMIP V2": write.csmip_v2([WAVE, WAVE[:20]]),
    "USC": write.usc(WAVE),
    "COSMOS": write.cosmos([WAVE, WAVE[:20]]),
    "K-NET": write.knet([int(1e4 * value) for value in WAVE]),
    "ESM": write.esm(WAVE),
    "GeoNet V2A": write.geonet([WAVE, WAVE[:20]]),
    "GeoNet V1A": write.geonet([WAVE, WAVE[:20]], raw=True),
    "columns": write.columns(WAVE),
}
PIECES = [
    b"NaN",
    b"inf",
    b"-",
    b"1e400",
    b"1e30",
    b"-9" * 40,
    b"1_0",
    b"\xe9\xb2",
    b"\0",
    b"\x85\x1c",
    b"\r",
    b"\n",
    b"0",
    b"-1",
    b" ",
]
PIECES += [
    b"",
    b"99999999",
    b"1e8",
    b"0x1F",
    b"1,5",
    b"*" * 10,
    b"g",
    b"(UNITS: X)",
    b"1d5",
    b"\xef\xbb\xbf",
    "²١".encode(),
]


def truncated(rng, data):
    return data[: rng.randrange(len(data))]


def replaced(rng, data):
    """Replace a few bytes somewhere, half of the time in the header."""
    at = rng.randrange(len(data) if rng.random() < 0.5 else min(len(data), 1_000))
    return data[:at] + rng.choice(PIECES) + data[at + rng.randrange(12) :]


def word_replaced(rng, data):
    words = data.split(b" ")
    words[rng.randrange(len(words))] = rng.choice(PIECES)
    return b" ".join(words)


def digit_replaced(rng, data):
    places = [k for k, byte in enumerate(data) if 48 <= byte <= 57]
    if not places:
        return data
    at = rng.choice(places)
    return data[:at] + bytes([rng.randrange(48, 58)]) + data[at + 1 :]


def binary(rng, data):
    at = rng.randrange(len(data))
    return data[:at] + rng.randbytes(rng.randrange(1, 40)) + data[at:]


def lines_changed(rng, data):
    lines = data.split(b"\n")
    first = rng.randrange(len(lines))
    last = first + rng.choice((1, 1, 2, 10))
    lines[first:last] = rng.choice(
        ([], 2 * lines[first:last], lines[first:last][::-1], [b""], [rng.choice(lines)])
    )
    return b"\n".join(lines)


def line_ends(rng, data):
    return data.replace(b"\n", rng.choice((b"\r\n", b"\r", b"\n\n", b" \n", b"\n\r")))


MUTATIONS = [
    truncated,
    replaced,
    replaced,
    word_replaced,
    word_replaced,
    digit_replaced,
    binary,
    lines_changed,
    lines_changed,
    line_ends,
]


def run_many(kind, seeds, folder):
    """Damage a file for each seed; return the numbers of errors and of motions."""
    clean, path, errors = "\n".join(FORMATS[kind]).encode(), folder / "file.x", 0
    for seed in seeds:
        rng, data = random.Random(f"{kind} {seed}"), clean
        for _ in range(rng.randint(1, 3)):
            data = rng.choice(MUTATIONS)(rng, data) or b"x"
        path.write_bytes(data)
        given = rng.choice(({}, {}, {}, {"units": "g"}, {"units": "g", "step": 0.01}))
        try:
            errors += check(path, given)
        except BaseException as error:
            error.add_note(f"{kind}, seed {seed}, {given}")
            raise
    return errors, len(seeds) - errors


def check(path, given):
    """Read a damaged file; return whether it is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # a peak that differs
        try:
            found = rk.read_ground_motions(path, **given)
        except rk.RecordError as error:
            found = str(error)
    if isinstance(found, str):
        assert found.isprintable()  # and so has one line
        assert path.name in found
        assert len(found) < 300
        return True
    assert found
    for motion in found:
        assert np.isfinite(motion.acceleration).all()
        assert 0 < motion.step < np.inf
        assert "\n" not in repr(motion)
    return False


@pytest.fixture(autouse=True)
def _without_obspy(monkeypatch):
    monkeypatch.setitem(sys.modules, "obspy", None)


@pytest.mark.parametrize("kind", FORMATS)
def test_damaged_files_give_one_line_or_a_motion(kind, tmp_path):
    errors, motions = run_many(kind, range(200), tmp_path)
    assert min(errors, motions) > 10


@pytest.mark.long
@pytest.mark.parametrize("kind", FORMATS)
def test_many_damaged_files_give_one_line_or_a_motion(kind, tmp_path):
    errors, motions = run_many(kind, range(200, 2_200), tmp_path)
    assert min(errors, motions) > 100


NASTY = {
    "blanks": " ",
    "tabs": "\t",
    "digits": "1",
    "open brackets": "(",
    "bracket and blanks": ("[", " "),
    "signs": "-",
    "dots": ".",
    "e": "e",
    "numbers that end": ("1" * 30, "x"),
    "commas": ",",
    "colons": " :",
    "quotes": "\"'",
    "nested": "units=(",
    "counts": "NPTS=",
}
"""Text that is repeated, or text and what is repeated after it."""
LONG = 20_000
MOST = 2.0
"""Processor time in s: that of a reader is a hundredth, unless it grows faster than the line."""


def nasty(kind, length):
    first, again = NASTY[kind] if isinstance(NASTY[kind], tuple) else ("", NASTY[kind])
    return (first + again * (length // len(again)))[:length]


def seconds(outcome, **given):
    """Return the processor time in s of reading a file."""
    begun = time.process_time()
    with outcome:
        rk.read_ground_motions(**given)
    return time.process_time() - begun


@pytest.mark.parametrize("kind", FORMATS)
def test_a_long_line_is_refused_at_once(kind, tmp_path):
    path, lines = tmp_path / "file.x", FORMATS[kind]
    cases = [(what, 100_000, line) for what in NASTY for line in (0, len(lines) - 1)]
    for what, length, line in [*cases, ("digits", 10_000_000, 2)]:
        data = "\n".join(
            [*lines[:line], f"{lines[line]} {nasty(what, length)}x", *lines[line + 1 :]]
        ).encode()
        path.write_bytes(data)
        rule = rf"^file.x, line {line + 1}: a line must have at most 10,000 characters; got [\d,]+; put each"
        for given in ({"source": path}, {"source": data, "name": "file.x"}):
            assert seconds(pytest.raises(rk.RecordError, match=rule), **given) < MOST


def slow_lines(kind, places, nasties):
    """Return the lines on which a reader spends too long, each with text at a place in the header; none is expected."""
    lines, slow = FORMATS[kind], []
    header = {line: index for index, line in enumerate(lines) if re.search("[A-Za-z]", line)}
    for line, index in header.items():
        for at in sorted({found.start() for found in re.finditer(places, line)}):
            for what, end in product(nasties, {"", line[at:]}):
                changed = line[:at] + nasty(what, LONG) + end
                text = "\n".join([*lines[:index], changed, *lines[index + 1 :]])
                took = seconds(suppress(rk.RecordError), source=text.encode())
                slow += [(line, at, what, took)] * (took > MOST)
    return slow


@pytest.mark.filterwarnings("ignore::UserWarning")  # a peak that differs
@pytest.mark.parametrize("kind", FORMATS)
def test_the_time_of_a_line_grows_no_faster_than_its_length(kind, monkeypatch):
    monkeypatch.setattr(text_file, "MAX_LINE", 10**9)  # the limit hides a slow expression
    assert not slow_lines(kind, r"(?<=[=:(])|$", ("blanks", "digits"))


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("kind", FORMATS)
def test_the_time_grows_no_faster_at_any_place_of_the_header(kind, monkeypatch):
    monkeypatch.setattr(text_file, "MAX_LINE", 10**9)
    assert not slow_lines(kind, r"\b|$|(?<=[=:(])", NASTY)
