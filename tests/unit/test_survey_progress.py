"""Reports during a survey: predicted cost and progress."""

import re

import numpy as np

import rocking as rk
from rocking.model import percent

ASKED = {
    "amplitude": np.linspace(0.0, 16.0, 80),
    "period": np.linspace(0.2, 3.0, 80),
    "restitution": 0.9,
    "max_cycles": 40,
}


def words(text):
    return " ".join(text.split())


def test_bar_says_the_cost_and_ends_with_the_shares(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("COLUMNS", "160")
    found = rk.parametric_map(**ASKED, progress=True, store=tmp_path / "map.zarr")
    told = words(capsys.readouterr().err)
    assert re.match(r"6,400 points in 13 tiles, about [\d.]+ s on \d+ cores? ", told)
    assert "100%" in told
    shares = [float((found.kind == number).mean()) for number in range(6)]
    for kind, share in zip(rk.Kind, shares, strict=True):
        assert (f"{kind} {percent(share)}" in told) == (share > 0)


def test_what_an_earlier_run_did_counts_as_done(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("COLUMNS", "160")
    rk.parametric_map(**ASKED, store=tmp_path / "map.zarr")
    rk.parametric_map(**ASKED, store=tmp_path / "map.zarr", progress=True)
    told = words(capsys.readouterr().err)
    assert "6,400 points in 13 tiles, 6,400 of them computed before, about 0 s on" in told
    assert "100%" in told
    assert "periodic" in told


def test_nothing_is_said_unless_asked_for(capsys):
    rk.parametric_map(**ASKED)
    assert capsys.readouterr() == ("", "")
