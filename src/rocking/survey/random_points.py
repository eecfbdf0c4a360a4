"""Points that do not lie on a grid: random numbers, perturbed inputs, and samples of an uncertain block."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from attrs import evolve, field, frozen

from rocking.model.block import Block, unrestrained
from rocking.model.block_formulas import frequency_parameter
from rocking.model.ground_motion import GroundMotion
from rocking.model.progress import Bar
from rocking.model.quantity import AMPLITUDE, LEFT_QUANTITIES, PERIOD, SYSTEM_QUANTITIES
from rocking.model.record_set import RecordSet
from rocking.model.system import LeftSide
from rocking.model.validation import Refusal, Text, WrongType, reals, whole
from rocking.survey.engine import Engine
from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.memory import Memory
from rocking.survey.run_survey import Watcher, run
from rocking.survey.spec import SYSTEM, HarmonicSpec, MotionSpec, Points, Runs, Values, points

MAX_SAMPLES = 10_000_000
MAX_SEED = 2**32 - 1


def generator(seed: int) -> np.random.Generator:
    """Return a random number generator; equal seeds give equal numbers."""
    return np.random.default_rng(whole("seed", seed, 0, MAX_SEED))


def span(name: str, values: Any, widest: tuple[float, float] | None = None) -> tuple[float, float]:
    """Check a range (low, high) of random numbers: low < high, both within the range of the quantity."""
    low, high = widest or SYSTEM_QUANTITIES[name].range
    allowed = f"be a pair (low, high) in [{low:.6g}, {high:.6g}] with low < high"
    try:
        pair = np.asarray(reals(name, values))
    except TypeError:
        raise WrongType(name, allowed, values) from None
    if pair.shape != (2,):
        raise Refusal(name, allowed, Text(_kind_of(pair)))
    if not low <= pair[0] < pair[1] <= high:
        raise Refusal(name, allowed, tuple(pair.tolist()))
    return float(pair[0]), float(pair[1])


def _kind_of(array: np.ndarray) -> str:
    return f"the number {array.item():.6g}" if array.ndim == 0 else f"an array of shape {array.shape}"


@frozen(eq=False)
class RandomSpec(HarmonicSpec):
    """Survey of systems on a harmonic base with random quantities along a further axis `sample`."""

    numbers: ClassVar[dict[str, str]] = {"sample": "number of the sample, from 0"}

    drawn: dict[str, np.ndarray] = field(kw_only=True)
    """Random quantities by name, over the last axes or all."""

    @property
    def refines(self) -> bool:
        """Flag: the samples are the same at all points of the other axes."""
        return all(table.ndim == 1 for table in self.drawn.values())

    def with_axes(self, axes: dict[str, np.ndarray]) -> RandomSpec:
        """Return the survey over other axes of the same names, with their samples alone."""
        drawn = {name: table[np.ix_(*self._places(table, axes))] for name, table in self.drawn.items()}
        return evolve(self, axes=axes, drawn=drawn)

    def inputs(self, values: Values) -> Points:
        """Return the systems and initial states of n points."""
        varied = {name: each for name, each in values.items() if name != "sample"}
        drawn = {name: table[self._places(table, values)] for name, table in self.drawn.items()}
        return points(varied | drawn, self.fixed)

    def _places(self, table: np.ndarray, values: Values) -> tuple[np.ndarray, ...]:
        return tuple(
            np.searchsorted(self.axes[name], values[name]) for name in list(self.axes)[-table.ndim :]
        )


def sampled(
    drawn: Values,
    fixed: Mapping[str, float],
    measure: Measurement,
    executor: Engine | None = None,
    title: str = "",
) -> Arrays:
    """Return the results of a measurement for quantities (n,), in their order; with a progress bar if there is a title."""
    count = next(iter(drawn.values())).size
    spec = RandomSpec({"sample": np.arange(float(count))}, dict(fixed), drawn=dict(drawn))
    results = Memory(spec, measure)
    with Bar(count, title, shown=bool(title)) as bar:
        run(results, executor, Watcher(bar, measure))
    return results.arrays


def random_starts(
    spec: HarmonicSpec,
    ends: dict[str, tuple[float, float]],
    samples: int,
    random: np.random.Generator,
    seed: int,
) -> RandomSpec:
    """Return a survey repeated for random initial states in the ranges `ends` of angle and velocity.

    The first initial states do not depend on their number, so that a store can be extended.
    """
    low, high = zip(ends["angle"], ends["velocity"], strict=True)
    count = whole("samples", samples, 1, MAX_SAMPLES)
    angle, velocity = random.uniform(low, high, (count, 2)).T
    return RandomSpec(
        spec.axes | {"sample": np.arange(float(count))},
        spec.fixed,
        drawn={"angle": angle, "velocity": velocity},
        stated={"seed": seed, "angle_range": list(ends["angle"]), "velocity_range": list(ends["velocity"])},
    )


TITLE = "Repeatability of the response of a free-standing block on a shaking base"
MAX_RELATIVE = 0.5
INPUTS = 5
"""Number of perturbed inputs: A, T, e and the initial Θ and Θ'."""


def spread(count: int) -> np.ndarray:
    """Return points (count, INPUTS) that are evenly spread over [-1, 1].

    They are multiples, modulo one, of powers of the root of g⁶ = g + 1.
    """
    root = 1.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (INPUTS + 1))
    steps = root ** -np.arange(1.0, INPUTS + 1)
    return 2.0 * ((0.5 + np.arange(count)[:, None] * steps) % 1.0) - 1.0


def perturbed(meant: Points, units: np.ndarray, off: float) -> Points:
    """Return n points whose A, T, e, Θ and Θ' deviate by the fraction `off` times `units` (n, INPUTS) in [-1, 1]."""
    factors = 1.0 + off * units
    systems, starts = meant.systems.copy(), meant.starts.copy()
    place = {name: k for k, name in enumerate(SYSTEM)}
    amplitude, period = (systems[:, place[name]] for name in ("amplitude", "period"))
    np.minimum(amplitude * factors[:, 0], AMPLITUDE.range[1], out=amplitude)
    np.clip(period * factors[:, 1], *PERIOD.range, out=period)
    systems[:, place["frequency"]] = 2.0 * np.pi / period
    for name in ("restitution", "left_restitution"):
        # uniform over the part of the range that is possible
        restitution = systems[:, place[name]]
        low, high = restitution * (1.0 - off), np.minimum(restitution * (1.0 + off), 1.0)
        restitution[:] = 0.5 * (low + high) + 0.5 * (high - low) * units[:, 2]
    reach = systems[:, place["brace_angle"]]
    starts[:, 0] = np.clip(starts[:, 0] * factors[:, 3], -reach, reach)
    starts[:, 1] *= factors[:, 4]
    return Points(systems, starts)


DRAWN = ("size", "slenderness", "restitution", *LEFT_QUANTITIES)
"""Quantities of the samples of a block; the last three only of an unsymmetric one."""


@frozen(eq=False)
class UncertainMotionSpec(MotionSpec):
    """Survey of ground motions with a further axis `sample`, the number of the sample of the block.

    Levels that compare the ground motion with a block refer to the nominal block.
    """

    numbers: ClassVar[dict[str, str]] = MotionSpec.numbers | {
        "sample": "number of the sample of the block, from 0"
    }

    drawn: np.ndarray = field(
        kw_only=True
    )  # (records, samples, 3, or 6 for an unsymmetric block), as in DRAWN

    def inputs(self, values: Values) -> Runs:
        """Return the runs at n points."""
        arguments = self.arguments(values)
        record = arguments["record"].astype(int)
        own = dict(zip(DRAWN, self.drawn[record, arguments["sample"].astype(int)].T, strict=False))
        runs = super().inputs({name: each for name, each in values.items() if name != "sample"} | own)
        nominal = (
            frequency_parameter(self.fixed["size"], self.fixed["inertia_ratio"]),
            self.fixed["slenderness"],
        )
        levels = np.array([self.intensities[number] for number in record.tolist()])
        factor = self.measure.factor(arguments["level"], levels, *nominal) * arguments["polarity"]
        streams = self.streams(record, arguments["sample"].astype(int))
        return runs._replace(factor=factor / self.acceleration_units(own["slenderness"]), stream=streams)


def block_samples(
    records: RecordSet, block: Block, samples: int, spreads: tuple[float, float, float], seed: int
) -> np.ndarray:
    """Return the quantities `DRAWN` of the samples of each record, shape (records, samples, 3); 6 for an unsymmetric block.

    The samples of a record are a Latin hypercube of their own, which depends on the seed and on the record only. Height and
    width are lognormal, and the offset of the mass centre is in proportion to the width. The restitution is uniform about the
    nominal value, or about Housner's value of the sample, with the same deviation for impacts in both directions.
    """
    unrestrained(block, "block", "an uncertain block has no certain stiffness ratio")
    return np.array([_of_record(motion, block, samples, spreads, seed) for motion in records])


def _of_record(
    motion: GroundMotion, block: Block, samples: int, spreads: tuple[float, float, float], seed: int
) -> np.ndarray:
    from scipy.special import ndtri

    random = np.random.default_rng([seed, motion.number])
    strata = random.permuted(np.tile(np.arange(samples), (3, 1)), axis=1)
    places = (strata + random.random((3, samples))) / samples
    places = np.clip(places, 1e-9, 1.0 - 1e-9)
    height = block.height * np.exp(spreads[0] * ndtri(places[0]))
    width = block.width * np.exp(spreads[1] * ndtri(places[1]))
    rows = []
    for number, deviation in enumerate((spreads[2] * (2.0 * places[2] - 1.0)).tolist()):
        each = block.resized(float(height[number]), float(width[number]))
        kept, left = (min(max(e + deviation, 0.0), 1.0) for e in (each.restitution, each.left_restitution))
        row = [each.radius, each.critical_angle, kept]
        if isinstance(side := each.left, LeftSide):
            row += [side.angle_ratio, side.frequency_ratio, left]
        rows.append(row)
    return np.array(rows)


def fingerprints(records: RecordSet) -> tuple[str, ...]:
    """Return the digest of each record; ValueError if a record occurs twice, because copies are not independent."""
    seen: dict[str, str] = {}
    for name, motion in zip(records.names, records, strict=True):
        mark = motion.fingerprint
        if mark in seen:
            allowed = "hold independent motions"
            twins = f"{name}, the same as {seen[mark]}"
            remedy = "leave one out: a copy, scaled or reversed, says nothing new"
            raise Refusal("records", allowed, twins, remedy)
        seen[mark] = name
    return tuple(seen)
