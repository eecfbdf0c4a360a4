"""Samples of a block whose height, width and restitution are uncertain, and a survey over them."""

from __future__ import annotations

from hashlib import sha256
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY, frequency_parameter
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_set import RecordSet
from rocking.model.validation import Refusal
from rocking.survey.motion_spec import MotionSpec, Runs
from rocking.survey.spec import Values


@frozen(eq=False)
class UncertainMotionSpec(MotionSpec):
    """Survey of ground motions with a further axis `sample`, the number of the sample of the block.

    Levels that compare the ground motion with a block refer to the nominal block.
    """

    drawn: np.ndarray = field(kw_only=True)  # (records, samples, 3): size, slenderness, restitution
    stated: dict[str, float] = field(kw_only=True)

    def inputs(self, values: Values) -> Runs:
        """Return the runs at n points."""
        count = next(iter(values.values())).size
        given = {name: np.full(count, value) for name, value in self.fixed.items()} | dict(values)
        record = given["record"].astype(int)
        own = dict(
            zip(
                ("size", "slenderness", "restitution"),
                self.drawn[record, given["sample"].astype(int)].T,
                strict=True,
            )
        )
        runs = super().inputs({name: each for name, each in values.items() if name != "sample"} | own)
        nominal = (
            frequency_parameter(self.fixed["size"], self.fixed["inertia_ratio"]),
            self.fixed["slenderness"],
        )
        levels = np.array([self.intensities[number] for number in record.tolist()])
        factor = self.measure.factor(given["scale"], levels, *nominal) * given["polarity"]
        return runs._replace(factor=factor / (GRAVITY * own["slenderness"]))

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, and the spreads."""
        return super().described() | self.stated

    def coordinate(self, name: str) -> dict[str, str]:
        """Return the attributes of a coordinate."""
        if name == "sample":
            return {"long_name": "number of the sample of the block, from 0"}
        return super().coordinate(name)


def block_samples(
    records: RecordSet, block: Block, samples: int, spreads: tuple[float, float, float], seed: int
) -> np.ndarray:
    """Return size, slenderness and restitution of the samples of each record, shape (records, samples, 3).

    The samples of a record are a Latin hypercube of their own, which depends on the seed and on the record only. Height and
    width are lognormal. The restitution is uniform about the nominal value, or about Housner's value of the sample.
    """
    return np.array([_of_record(motion, block, samples, spreads, seed) for motion in records])


def _of_record(
    motion: GroundMotion, block: Block, samples: int, spreads: tuple[float, float, float], seed: int
) -> np.ndarray:
    from scipy.special import ndtri

    random = np.random.default_rng([seed, int(fingerprint(motion)[:16], 16)])
    strata = random.permuted(np.tile(np.arange(samples), (3, 1)), axis=1)
    places = (strata + random.random((3, samples))) / samples
    places = np.clip(places, 1e-9, 1.0 - 1e-9)
    height = block.height * np.exp(spreads[0] * ndtri(places[0]))
    width = block.width * np.exp(spreads[1] * ndtri(places[1]))
    found = []
    for number, deviation in enumerate((spreads[2] * (2.0 * places[2] - 1.0)).tolist()):
        given = None if block.has_housner_restitution else block.restitution
        each = Block(float(height[number]), float(width[number]), given, block.inertia_ratio)
        found.append((each.radius, each.critical_angle, min(max(each.restitution + deviation, 0.0), 1.0)))
    return np.array(found)


def fingerprint(motion: GroundMotion) -> str:
    """Return a digest of step and samples, the same for a motion, its scaled copies and its mirror image."""
    base = motion.normalised(1.0, 1.0)
    values = np.asarray(base.values, dtype=float)
    moving = np.flatnonzero(values)
    sign = np.sign(values[moving[0]]) if moving.size else 1.0
    return sha256(
        np.float64(base.step).tobytes() + np.ascontiguousarray(sign * values + 0.0).tobytes()
    ).hexdigest()


def fingerprints(records: RecordSet) -> tuple[str, ...]:
    """Return the digest of each record; ValueError if a record occurs twice, because copies are not independent."""
    seen: dict[str, str] = {}
    for name, motion in zip(records.names, records, strict=True):
        mark = fingerprint(motion)
        if mark in seen:
            allowed = "hold independent motions"
            found = f"{name}, the same as {seen[mark]}"
            remedy = "leave one out: a copy, scaled or reversed, says nothing new"
            raise Refusal("records", allowed, found, remedy)
        seen[mark] = name
    return tuple(seen)
