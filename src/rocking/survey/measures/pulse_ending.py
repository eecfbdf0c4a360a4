"""Measurement of surveys of pulses: how a run ends, its largest angle, its margin and its mode."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from rocking.kernels.forcing import parameters as numbers
from rocking.kernels.march import ending as ends
from rocking.kernels.march import finite_runs as kernel
from rocking.model.forcing import SINES, Pulse
from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.measures.ending import METHOD, VARIABLES, answers, sampled
from rocking.survey.pulse_spec import Pulses


def pulse_ending(title: str) -> Measurement:
    """Return the measurement of the end of a motion under a pulse."""
    return Measurement(title, judge, VARIABLES, {}, METHOD, shares="outcome")


def judge(runs: Pulses, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Follow blocks at rest under pulses to their ends; None if another thread sets `stop`."""
    rows = np.empty(runs.amplitude.size, ends.ENDING_ROW)
    done = _sines(runs, rows, stop) if runs.kind in SINES else _sampled(runs, rows, stop)
    return answers(rows, with_peak=True, assessed=not runs.full) if done else None


def _sines(runs: Pulses, rows: np.ndarray, stop: np.ndarray) -> bool:
    """Follow pulses that are pieces of a cosine, with the rounding of `simulate`."""
    form = SINES[runs.kind]
    pulses = np.empty(runs.amplitude.size, kernel.PULSE_ROW)
    pulses["amplitude"], pulses["duration"] = runs.amplitude, runs.duration
    pulses["restitution"], pulses["critical_angle"] = runs.restitution, runs.critical_angle
    pulses["frequency"], pulses["phase"] = (
        math.tau * form.turns / runs.duration,
        numbers.within_a_turn(form.phase),
    )
    return kernel.run_pulses(a_pulse(full=runs.full), pulses, True, rows, stop)


def a_pulse(*, full: bool) -> numbers.AnyPulseParameters:
    """Return parameters of any pulse, which give the kernel the kind of block."""
    pulse = {"amplitude": 1.0, "frequency": 1.0, "phase": 0.0, "duration": 1.0, "cycle_length": 1.0}
    if full:
        return numbers.full_pulse_parameters(**pulse, block=numbers.full_block(1.0, 1.0))
    return numbers.pulse_parameters(**pulse, block=numbers.BlockParameters(1.0, math.inf, 1.0))


def _sampled(runs: Pulses, rows: np.ndarray, stop: np.ndarray) -> bool:
    """Follow pulses of straight lines and Ricker pulses; pulses of one duration share tables."""
    asked = np.empty(rows.size, kernel.RUN_ROW)
    asked["scale"], asked["restitution"], asked["angle"] = runs.amplitude, runs.restitution, 0.0
    asked["critical_angle"] = runs.critical_angle
    durations, places = np.unique(runs.duration, return_inverse=True)
    for number, duration in enumerate(durations.tolist()):
        own = np.flatnonzero(places == number)
        base = Pulse(runs.kind, amplitude=1.0, duration=duration).samples
        p = sampled(base, full=runs.full)
        part = np.empty(own.size, ends.ENDING_ROW)
        if not kernel.run_batch(p, asked[own], True, part, stop):
            return False
        rows[own] = part
    return True
