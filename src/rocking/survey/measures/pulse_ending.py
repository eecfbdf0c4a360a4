"""Measurement of surveys of pulses: how a run ends, its largest angle, its margin and its mode."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from rocking.kernels.forcing import parameters as numbers
from rocking.kernels.march import finite_motion as kernel
from rocking.model import SINES, Pulse
from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.measures.ending import METHOD, VARIABLES, answers
from rocking.survey.pulse_spec import Pulses


def pulse_ending(title: str) -> Measurement:
    """Return the measurement of the end of a motion under a pulse."""
    return Measurement(title, judge, load_kernels, VARIABLES, {}, METHOD, shares="outcome")


def load_kernels(may_last: bool) -> None:
    """Compile or load the kernels of `judge`."""
    kernel.run_batch.load()
    kernel.run_pulses.load()


def judge(runs: Pulses, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Follow blocks at rest under pulses to their ends; None if another thread sets `stop`."""
    rows = np.empty(runs.amplitude.size, kernel.ENDING_ROW)
    done = _sines(runs, rows, stop) if runs.kind in SINES else _sampled(runs, rows, stop)
    return answers(rows, with_peak=True) if done else None


def _sines(runs: Pulses, rows: np.ndarray, stop: np.ndarray) -> bool:
    """Follow pulses that are pieces of a cosine, with the rounding of `simulate`."""
    form = SINES[runs.kind]
    pulses = np.empty(runs.amplitude.size, kernel.PULSE_ROW)
    pulses["amplitude"], pulses["duration"], pulses["restitution"] = (
        runs.amplitude,
        runs.duration,
        runs.restitution,
    )
    pulses["frequency"], pulses["phase"] = (
        math.tau * form.turns / runs.duration,
        numbers.within_a_turn(form.phase),
    )
    return kernel.run_pulses(pulses, True, rows, stop)


def _sampled(runs: Pulses, rows: np.ndarray, stop: np.ndarray) -> bool:
    """Follow pulses of straight lines and Ricker pulses; pulses of one duration share tables."""
    asked = np.empty(rows.size, kernel.RUN_ROW)
    asked["scale"], asked["restitution"], asked["angle"] = runs.amplitude, runs.restitution, 0.0
    durations, places = np.unique(runs.duration, return_inverse=True)
    for number, duration in enumerate(durations.tolist()):
        own = np.flatnonzero(places == number)
        base = Pulse(runs.kind, amplitude=1.0, duration=duration).samples
        p = numbers.sampled_parameters(
            numbers.tables_of(base.values, base.step), 1.0, numbers.CYCLE * base.step, 1.0
        )
        part = np.empty(own.size, kernel.ENDING_ROW)
        if not kernel.run_batch(p, asked[own], True, part, stop):
            return False
        rows[own] = part
    return True
