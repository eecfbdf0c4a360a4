"""`rocking simulate --pulse`."""

import json

import pytest

import rocking as rk

BLOCK = "--height 2 --width 0.5"
SIZE = "--acceleration-g 0.5 --frequency-hz 1"


@pytest.mark.parametrize(("kind", "part"), [("half-sine", 0.5), ("one-cosine", 1.0)])
def test_period_is_that_of_the_whole_wave(rocking, kind, part):
    out = rocking(f"simulate --pulse {kind} --amplitude 1.5 --period 2 --restitution 0.9 --json")[2]
    summary = json.loads(out)
    assert summary["pulse_duration"] == 2.0 * part
    motion = rk.simulate(rk.System(rk.Pulse(kind, amplitude=1.5, duration=2.0 * part), 0.9))
    assert (summary["outcome"], summary["peak"]) == (motion.outcome, motion.peak)


def test_report_and_files_know_no_cycles(rocking, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, out = rocking(f"simulate --pulse ricker {BLOCK} {SIZE} --plot p.svg --csv p.csv --netcdf p.nc")
    assert code == 0
    assert "cycle" not in out
    assert "margin K₊" in out
    assert all((tmp_path / f"p{suffix}").stat().st_size > 0 for suffix in (".svg", ".csv", ".nc"))
