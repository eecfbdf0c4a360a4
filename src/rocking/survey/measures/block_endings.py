"""Ends of the motions of many blocks under one ground motion or pulse."""

from __future__ import annotations

import math

import numpy as np

from rocking.kernels.march import ending as ends
from rocking.kernels.march import finite_runs
from rocking.model.forcing import Pulse
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_set import RecordSet
from rocking.survey.measurement import Arrays
from rocking.survey.measures import pulse_ending
from rocking.survey.measures.ending import answers, judge
from rocking.survey.motion_spec import motion_question

WITH_PEAK = {"with_peak": 1}


class BlockEndings:
    """Measurement of the ends at points of size and slenderness, with the results of `rocking_spectrum`.

    Blocks are uniform rectangles with Housner's restitution. They start at rest.

    Parameters
    ----------
    base : GroundMotion or Pulse
        Base motion in SI units.
    scale : float
        Factor of the base motion.
    model : {"slender", "full"}
        Equation of motion.
    """

    def __init__(self, base: GroundMotion | Pulse, scale: float, model: str) -> None:
        self.scale = scale
        self.pulse = base if isinstance(base, Pulse) and base.cosine is not None else None
        motion = base if isinstance(base, GroundMotion) else _samples(base)
        given = {"size": [1.0, 2.0], "slenderness": [0.1, 0.2], "angle": 0.0, "polarity": 1.0, "scale": scale}
        self.asked = motion_question(RecordSet(motion), given, intensity="scale", model=model)

    def at(self, size: np.ndarray, slenderness: np.ndarray, stop: np.ndarray) -> Arrays | None:
        """Return outcome, certified, peak, margin and impacts at n points; None if another thread sets `stop` (1,).

        Neighbouring points of equal size share the tables of the base motion.
        """
        runs = self.asked.inputs({"size": size, "slenderness": slenderness})
        if self.pulse is None:
            return judge(runs, WITH_PEAK, stop)
        assert self.pulse.cosine is not None
        turns, phase = self.pulse.cosine
        asked, rows = (
            np.empty(size.size, finite_runs.PULSE_ROW),
            np.empty(size.size, ends.ENDING_ROW),
        )
        asked["amplitude"] = runs.factor * abs(self.pulse.amplitude)
        asked["duration"] = runs.frequency_parameter * self.pulse.duration
        asked["frequency"] = 2 * math.pi * turns / asked["duration"]
        asked["phase"] = phase if self.pulse.amplitude >= 0 else phase + math.pi
        asked["restitution"], asked["critical_angle"] = runs.restitution, runs.slenderness
        kind = pulse_ending.a_pulse(full=runs.full)
        done = finite_runs.run_pulses(kind, asked, True, rows, stop)
        return answers(rows, with_peak=True, assessed=not runs.full) if done else None


def _samples(pulse: Pulse) -> GroundMotion:
    """Return the samples of a pulse of straight lines or of a Ricker pulse; of a sine or cosine, a motion without use."""
    if pulse.cosine is not None:
        return GroundMotion([0.0], step=1.0)
    forcing = pulse.samples
    return GroundMotion(pulse.amplitude * forcing.values, step=forcing.step, name=pulse.kind)
