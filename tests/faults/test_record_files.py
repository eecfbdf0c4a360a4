"""Damaged record files: each gives either one line that says what is wrong, or a motion of finite samples."""

import random
import sys
import warnings

import numpy as np
import pytest

import record_files as write
import rocking as rk

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
