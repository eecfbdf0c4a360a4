"""Measurements of surveys of ground motions and pulses: how runs end, their largest angles, margins and modes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise, starmap

import numpy as np

from rocking.kernels import system as numbers
from rocking.kernels.block.restrained import restrained_under_pulse, restrained_under_samples
from rocking.kernels.motion import finite_motion, march
from rocking.kernels.restrainer import restrainer_of
from rocking.model.forcing import SINES, PiecewiseLinear, Pulse
from rocking.model.ground_motion import GroundMotion
from rocking.model.quantity import LEFT_QUANTITIES
from rocking.model.record_set import RecordSet
from rocking.model.restitution import Scatter
from rocking.model.verdict import Outcome
from rocking.motion.march_loop import scatter_of, tables_for, under_samples
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.spec import UNRESTRAINED, Left, Pulses, Ratios, Runs, motion_spec

METHOD = 9
"""Version of the method; a change of the results increases it."""
OUTCOMES = tuple(Outcome)
UNDECIDED, CERTIFIED = range(2)
"""Codes of the effect of rounding errors on an outcome."""
OVERTURNED = OUTCOMES.index(Outcome.OVERTURNED)
CODES = {
    march.OVERTURNED: OVERTURNED,
    march.STILL: OUTCOMES.index(Outcome.AT_REST),
}

VARIABLES = (
    Variable(
        "outcome",
        "uint8",
        255,
        {
            "long_name": "end of the motion",
            "flag_values": np.arange(len(OUTCOMES), dtype=np.uint8),
            "flag_meanings": " ".join(OUTCOMES),
        },
    ),
    Variable(
        "certified",
        "uint8",
        255,
        {
            "long_name": "whether no rounding error can have changed the outcome",
            "flag_values": np.arange(2, dtype=np.uint8),
            "flag_meanings": "undecided certified",
        },
    ),
    Variable(
        "peak",
        "float64",
        -1.0,
        {
            "long_name": "largest absolute angle in units of theta_cr",
            "units": "1",
            "comment": "infinite if the block overturns",
        },
    ),
    Variable(
        "margin",
        "float64",
        math.inf,
        {
            "long_name": "K+ of least size over all lift-offs and impacts",
            "units": "1",
            "comment": "negative: lacked to overturn there; NaN: none, such as of a block that never moves",
        },
    ),
    Variable(
        "impacts_since_rest",
        "int32",
        -2,
        {"long_name": "impacts since the block last rested", "comment": "0: overturned without impact"},
    ),
    Variable("impacts", "int32", -2, {"long_name": "impacts", "comment": "chattering is cut short"}),
)


def ending(title: str, *, with_peak: bool = True) -> Measurement:
    """Return the measurement of the end of a motion; without the peak, which is then NaN, it takes half the time."""
    return Measurement(
        title, endings_of_runs, VARIABLES, {"with_peak": int(with_peak)}, METHOD, shares="outcome"
    )


def endings_of_runs(runs: Runs, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Follow runs to their ends; None if another thread sets `stop`. Neighbours with the same record and α share tables."""
    if runs.worse:
        ways = [
            endings_of_runs(runs._replace(factor=sign * runs.factor, worse=False), options, stop)
            for sign in (1.0, -1.0)
        ]
        return None if ways[0] is None or ways[1] is None else worse_of(ways[0], ways[1])
    with_peak = bool(options["with_peak"])
    rows, inputs = (
        np.empty(runs.record.size, finite_motion.ENDING_ROW),
        np.empty(runs.record.size, finite_motion.RUN_ROW),
    )
    inputs["restitution"], inputs["angle"] = runs.restitution, runs.angle
    inputs["critical_angle"] = runs.slenderness
    give_sides(inputs, runs.left)
    inputs["speed_unit"], inputs["stream"] = runs.speed_unit, runs.stream
    law, scatter = np.array(runs.law.rows).reshape(-1, 2), runs.law.scatter
    for part in runs_of_equal_tables(runs):
        motion, alpha = (
            runs.motions[int(runs.record[part.start])],
            float(runs.frequency_parameter[part.start]),
        )
        base = motion.normalised(1.0, alpha)
        inputs["scale"][part] = base.scale * runs.factor[part]
        p = sampled(
            base,
            full=runs.full,
            left=runs.left,
            place=part.start,
            law=law,
            scatter=scatter,
            restrainer=runs.restrainer,
            critical_angle=float(runs.slenderness[part.start]),
        )
        if not finite_motion.run_batch(p, inputs[part], with_peak, rows[part], stop):
            return None
    return answers(rows, with_peak=with_peak)


def worse_of(one: Arrays, other: Arrays) -> Arrays:
    """Return of two runs at each point the one that is worse for the block: it alone overturns, or it has the larger peak.

    Where neither overturns, the outcome is certified only if both are.
    """
    fell, fell_too = one["outcome"] == OVERTURNED, other["outcome"] == OVERTURNED
    taken = (fell_too & ~fell) | (other["peak"] > one["peak"])
    result = {name: np.where(taken, other[name], values) for name, values in one.items()}
    stands = ~(fell | fell_too)
    both = np.minimum(one["certified"], other["certified"])
    result["certified"] = np.where(stands, both, result["certified"]).astype(np.uint8)
    return result


def give_sides(rows: np.ndarray, left: Left) -> None:
    """Give rows of runs or pulses (n,) the left sides of their blocks."""
    for name in LEFT_QUANTITIES:
        rows[name] = getattr(left, name)


def sampled(
    base: PiecewiseLinear,
    *,
    full: bool,
    left: Left,
    place: int = 0,
    law: np.ndarray = numbers.NO_LAW,
    scatter: Scatter | None = None,
    restrainer: Ratios = UNRESTRAINED,
    critical_angle: float = 1.0,
) -> numbers.AnySampledParameters:
    """Return parameters with the tables of a base motion, for runs of any blocks of one kind and law of restitution.

    Batches that share the samples in memory, those of threads, share the tables, too.
    Unsymmetric blocks have the ratio of the frequency parameters of that at a place: their left sides have tables of their own.
    Restrained blocks have those of the balance at a critical angle in rad.
    """
    block = _any_block(full=full, left=left, place=place, law=law, scatter=scatter)
    free = under_samples(block, base, 1.0, numbers.CYCLE * base.step)
    if restrainer == UNRESTRAINED:
        return free
    own = restrainer_of(critical_angle, *restrainer)
    return restrained_under_samples(free, own, tables_for(base, own.rate))


def _any_block(
    *, full: bool, left: Left, law: np.ndarray, scatter: Scatter | None, place: int = 0
) -> numbers.Block:
    if full:
        return numbers.full_block(1.0, 1.0, law=law, scatter=scatter_of(scatter))
    if not left.unequal:
        return numbers.slender_block(1.0)
    return numbers.slender_block(1.0, left=numbers.LeftSide(1.0, float(left.frequency_ratio[place]), 1.0))


def runs_of_equal_tables(runs: Runs) -> Iterator[slice]:
    """Yield the stretches of neighbouring points that share the tables of a record."""
    if not runs.record.size:
        return
    differs = (np.diff(runs.record) != 0) | (np.diff(runs.frequency_parameter) != 0)
    differs |= np.diff(runs.left.frequency_ratio) != 0
    edges = [0, *(np.flatnonzero(differs) + 1).tolist(), runs.record.size]
    yield from starmap(slice, pairwise(edges))


def answers(rows: np.ndarray, *, with_peak: bool) -> Arrays:
    """Return the variables of the rows of the kernel."""
    outcome = np.zeros(rows.size, np.uint8)
    for status, code in CODES.items():
        outcome[rows["status"] == status] = code
    certified = ((rows["decided"] != 0) & (rows["status"] != march.CROWDED)).astype(np.uint8)
    peak = np.where(outcome == OVERTURNED, math.inf, rows["peak"] if with_peak else math.nan)
    return {
        "outcome": outcome,
        "certified": certified,
        "peak": peak,
        "margin": rows["margin"],
        "impacts_since_rest": rows["since_rest"].astype(np.int32),
        "impacts": rows["impacts"].astype(np.int32),
    }


def pulse_ending(title: str) -> Measurement:
    """Return the measurement of the end of a motion under a pulse."""
    return Measurement(title, endings_of_pulses, VARIABLES, {}, METHOD, shares="outcome")


def endings_of_pulses(runs: Pulses, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Follow blocks at rest under pulses to their ends; None if another thread sets `stop`."""
    rows = np.empty(runs.amplitude.size, finite_motion.ENDING_ROW)
    done = _sines(runs, rows, stop) if runs.kind in SINES else _sampled(runs, rows, stop)
    return answers(rows, with_peak=True) if done else None


def _sines(runs: Pulses, rows: np.ndarray, stop: np.ndarray) -> bool:
    """Follow pulses that are pieces of a cosine, with the rounding of `simulate`."""
    form = SINES[runs.kind]
    pulses = np.empty(runs.amplitude.size, finite_motion.PULSE_ROW)
    pulses["amplitude"], pulses["duration"] = runs.amplitude, runs.duration
    pulses["restitution"], pulses["critical_angle"] = runs.restitution, runs.critical_angle
    give_sides(pulses, runs.left)
    pulses["frequency"], pulses["phase"] = (
        math.tau * form.turns / runs.duration,
        numbers.within_a_turn(form.phase),
    )
    kind = a_pulse(
        full=runs.full, left=runs.left, law=runs.law, scatter=runs.scatter, restrainer=runs.restrainer
    )
    return finite_motion.run_pulses(kind, pulses, True, rows, stop)


def a_pulse(
    *,
    full: bool,
    left: Left,
    law: np.ndarray = numbers.NO_LAW,
    scatter: Scatter | None = None,
    restrainer: Ratios = UNRESTRAINED,
) -> numbers.AnyPulseParameters:
    """Return parameters of any pulse, which give the kernel the kind of block and its law of restitution."""
    pulse = {"amplitude": 1.0, "frequency": 1.0, "phase": 0.0, "duration": 1.0, "cycle_length": 1.0}
    free = numbers.pulse_system(_any_block(full=full, left=left, law=law, scatter=scatter), **pulse)
    if restrainer == UNRESTRAINED:
        return free
    return restrained_under_pulse(free, restrainer_of(1.0, *restrainer))


def _sampled(runs: Pulses, rows: np.ndarray, stop: np.ndarray) -> bool:
    """Follow pulses of straight lines and Ricker pulses; pulses of one duration share tables."""
    inputs = np.empty(rows.size, finite_motion.RUN_ROW)
    inputs["scale"], inputs["restitution"], inputs["angle"] = runs.amplitude, runs.restitution, 0.0
    inputs["critical_angle"] = runs.critical_angle
    give_sides(inputs, runs.left)
    inputs["speed_unit"], inputs["stream"] = 1.0, scatter_of(runs.scatter).stream
    durations, places = np.unique(runs.duration, return_inverse=True)
    for number, duration in enumerate(durations.tolist()):
        own = np.flatnonzero(places == number)
        base = Pulse(runs.kind, amplitude=1.0, duration=duration).samples
        p = sampled(
            base,
            full=runs.full,
            left=runs.left,
            law=runs.law,
            scatter=runs.scatter,
            restrainer=runs.restrainer,
            critical_angle=float(runs.critical_angle[own[0]]),
        )
        part = np.empty(own.size, finite_motion.ENDING_ROW)
        if not finite_motion.run_batch(p, inputs[own], True, part, stop):
            return False
        rows[own] = part
    return True


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
    normalised_by : {"angle", "tangent"}, optional
        Unit of the base acceleration, as for `Block.system`.
    """

    def __init__(
        self, base: GroundMotion | Pulse, scale: float, model: str, normalised_by: str | None = None
    ) -> None:
        self.scale = scale
        self.pulse = base if isinstance(base, Pulse) and base.cosine is not None else None
        motion = base if isinstance(base, GroundMotion) else _samples(base)
        values = {
            "size": [1.0, 2.0],
            "slenderness": [0.1, 0.2],
            "angle": 0.0,
            "polarity": 1.0,
            "level": scale,
        }
        self.spec = motion_spec(
            RecordSet(motion), values, intensity="scale", model=model, normalised_by=normalised_by
        )

    def at(self, size: np.ndarray, slenderness: np.ndarray, stop: np.ndarray) -> Arrays | None:
        """Return outcome, certified, peak, margin and impacts at n points; None if another thread sets `stop` (1,).

        Neighbouring points of equal size share the tables of the base motion.
        """
        runs = self.spec.inputs({"size": size, "slenderness": slenderness})
        if self.pulse is None:
            return endings_of_runs(runs, WITH_PEAK, stop)
        assert self.pulse.cosine is not None
        turns, phase = self.pulse.cosine
        inputs, rows = (
            np.empty(size.size, finite_motion.PULSE_ROW),
            np.empty(size.size, finite_motion.ENDING_ROW),
        )
        inputs["amplitude"] = runs.factor * abs(self.pulse.amplitude)
        inputs["duration"] = runs.frequency_parameter * self.pulse.duration
        inputs["frequency"] = 2 * math.pi * turns / inputs["duration"]
        inputs["phase"] = phase if self.pulse.amplitude >= 0 else phase + math.pi
        inputs["restitution"], inputs["critical_angle"] = runs.restitution, runs.slenderness
        give_sides(inputs, runs.left)
        kind = a_pulse(full=runs.full, left=runs.left)
        done = finite_motion.run_pulses(kind, inputs, True, rows, stop)
        return answers(rows, with_peak=True) if done else None


def _samples(pulse: Pulse) -> GroundMotion:
    """Return the samples of a pulse of straight lines or of a Ricker pulse; of a sine or cosine, a motion without use."""
    if pulse.cosine is not None:
        return GroundMotion([0.0], step=1.0)
    forcing = pulse.samples
    return GroundMotion(pulse.amplitude * forcing.values, step=forcing.step, name=pulse.kind)
