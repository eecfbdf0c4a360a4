"""Runs under recorded and synthetic ground motions against stored impacts in 50 digits, made by Taylor series."""

import json
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from oracles import sampled

STORED = json.loads((Path(__file__).parents[1] / "data" / "record_runs.json").read_text())
RUNS = STORED["runs"]
OUTCOMES = {"rest": "at-rest", "overturned": "overturned"}
FAST = 1e-2
ACCURACY = 1e-12
# A change of the scale that measures the growth of errors: it must not turn a run into another.
CHANGE = 1e-11


def simulated(run, change=0.0):
    values = STORED["bases"][run["base"]]
    base = rk.PiecewiseLinear(values, step=run["step"], scale=run["scale"] * (1.0 + change))
    braces = rk.Braces(angle=run["brace"][0], restitution=run["brace"][1]) if "brace" in run else None
    system = rk.System(base, restitution=run["restitution"], braces=braces)
    duration = base.duration if "brace" in run else None
    return rk.simulate(system, rk.State(run.get("angle", 0.0), run.get("velocity", 0.0)), duration=duration)


def impacts_of(motion):
    """Return time, speed and place of each impact of a motion that is fast."""
    events = motion.events[np.isin(motion.events["kind"], ("impact", "brace"))]
    events = events[np.abs(events["before"]) > FAST]
    return np.column_stack((events["time"], np.abs(events["before"]))), events["kind"] == "brace"


@pytest.mark.parametrize("run", RUNS, ids=lambda run: f"{run['base']}, {run['step']}, {run['scale']:.9g}")
def test_impacts_and_outcome_are_the_stored_ones(run):
    motion = simulated(run)
    found, at_brace = impacts_of(motion)
    moved, _ = impacts_of(simulated(run, CHANGE))
    wanted = np.array([[float(time), float(speed)] for time, speed, _ in run["impacts"]]).reshape(-1, 2)
    assert len(found) == len(wanted) == len(moved)
    assert at_brace.tolist() == [place for *_, place in run["impacts"]]
    assert run["outcome"] == "end" or motion.outcome == OUTCOMES[run["outcome"]]
    if len(wanted):
        growth = np.maximum.accumulate(np.abs(moved - found).max(axis=1) / CHANGE)
        assert (np.abs(found - wanted).max(axis=1) <= ACCURACY * np.maximum(growth, 1.0)).all()


def test_stored_runs_cover_chatter_braces_thresholds_and_free_ends():
    ends = {(run["base"], run["step"], run["outcome"]) for run in RUNS}
    thresholds = [one for one in ends if one[2] == "overturned" and (*one[:2], "rest") in ends]
    free = [
        run
        for run in RUNS
        if run["impacts"]
        and float(run["impacts"][-1][0]) > (len(STORED["bases"][run["base"]]) + 50) * run["step"]
    ]
    assert len(RUNS) >= 40
    assert len(thresholds) >= 10
    assert len(free) >= 5
    assert sum(any(place for *_, place in run["impacts"]) for run in RUNS) >= 3


@pytest.mark.parametrize("number", [2, 5])
def test_stored_impacts_are_those_of_the_oracle(number):
    """Two runs of few impacts that overturn, computed again."""
    few = sorted((run for run in RUNS if run["outcome"] == "overturned"), key=lambda run: len(run["impacts"]))
    run = few[number]
    more = {key: run[key] for key in ("angle", "velocity") if key in run}
    values = STORED["bases"][run["base"]]
    impacts, outcome = sampled.motion(values, run["step"], run["restitution"], scale=run["scale"], **more)
    with mp.workdps(50):
        again = [
            [mp.nstr(time, 22), mp.nstr(speed, 22), place] for time, speed, place in impacts if speed > FAST
        ]
    assert (outcome, again[: len(run["impacts"])]) == (run["outcome"], run["impacts"])


def test_stored_bases_are_the_ground_motions_that_they_name():
    example = rk.example_ground_motion().acceleration[::4]
    peak = int(np.abs(example).argmax())
    synthetic = rk.synthetic_ground_motions(
        3, seed=7, duration=4.0, step=0.02, rise=0.8, strong=2.4, decay=1.0
    )
    motions = {
        "San Francisco, strong part": example[peak - 120 : peak + 120],
        "San Francisco, later part": example[peak + 40 : peak + 240],
        **{f"synthetic {k}": motion.acceleration for k, motion in enumerate(synthetic, 1)},
    }
    made = {name: (motion / np.abs(motion).max()).round(4).tolist() for name, motion in motions.items()}
    made["synthetic, cut"] = made["synthetic 1"][30:100]
    assert made == STORED["bases"]
