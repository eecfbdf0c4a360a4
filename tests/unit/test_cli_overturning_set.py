"""`rocking overturning-set`: the numbers of the function, in text, JSON and files."""

import json

import numpy as np
import pytest

import rocking as rk

BLOCK = rk.Block(2.0, 0.5)
SIZE = "--height 2 --width 0.5"
LEVELS = np.linspace(0.9, 1.3, 60)
AXIS = "--pga-g 0.9:1.3:60"


@pytest.fixture(autouse=True)
def push(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "push.csv").write_text(
        "time (s), acceleration (m/s²)\n0, 0\n0.5, 12\n1, 0\n", encoding="utf-8"
    )


@pytest.fixture(scope="module")
def found():
    return rk.overturning_set(rk.example_ground_motion(), BLOCK, LEVELS, intensity="pga-g")


def test_report_has_a_row_per_record(rocking, found):
    both = rk.overturning_set(
        [rk.example_ground_motion(), rk.read_ground_motion("push.csv")], BLOCK, LEVELS, intensity="pga-g"
    )
    code, message, out = rocking(f"overturning-set example push.csv {SIZE} {AXIS}")
    title, missed, heading, first, second, equation = out.splitlines()
    assert (code, message) == (0, "")
    assert [title, missed] == str(both).splitlines()
    assert missed == f"Intervals and gaps narrower than {np.diff(LEVELS).max():.3g} g may be missed"
    assert heading.split()[:3] == ["record", "lowest", "found,"]
    assert f"{found.lowest[0]:.6g}" in first
    assert f"   {len(found.intervals())}   " in first
    assert second.startswith("push")
    assert "0.9 to 1.3" in second
    small = "small angles; moments overestimated by up to 3.1 % (--model full avoids this)"
    assert equation == f"equation of motion: {small}"


def test_direction_and_measure_are_those_of_the_options(rocking):
    reversed_ = rk.overturning_set(
        rk.read_ground_motion("push.csv"), BLOCK, np.linspace(0.1, 3, 50), polarity=-1, angle=0.2
    )
    line = f"overturning-set push.csv {SIZE} --scale 3:0.1:50 --polarity -1 --angle 0.2 --json"
    told = json.loads(rocking(line)[2])
    assert (told["polarity"], told["angle_rad"], told["intensity"]) == (-1.0, BLOCK.radians(0.2), "scale")
    assert [[each["low"], each["high"]] for each in told["interval"]] == reversed_.intervals().tolist()


def test_switches_of_the_full_block_are_not_called_undecided(rocking):
    code, _, out = rocking(f"overturning-set example {SIZE} --pga-g 1:2:40 --model full")
    assert code == 0
    assert "undecided" not in out
