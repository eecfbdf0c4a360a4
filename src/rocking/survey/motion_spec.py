"""Survey of blocks under ground motions: the quantities that vary, the values of the others, and the runs at points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from attrs import evolve, field, frozen

from rocking.model.block import INERTIA_RATIOS, RECTANGLE, SIZES
from rocking.model.block_formulas import GRAVITY, frequency_parameter, housner_restitution
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_set import Intensity, RecordSet, intensity_of
from rocking.model.system import MODELS, RANGES
from rocking.model.validation import Refusal, one_of, within
from rocking.survey.spec import SurveySpec, Values, number_or_axis

MAX_LEVEL = 1e6
SLENDERNESSES = 1e-4, 1.57
"""Range of the critical angle, rad."""
QUANTITIES: dict[str, tuple[str, str, str, tuple[float, float]]] = {
    "size": ("R", "distance from a corner to the centre of mass", "m", SIZES),
    "slenderness": ("θcr", "critical angle", "rad", SLENDERNESSES),
    "restitution": ("e", "coefficient of restitution", "1", RANGES["restitution"]),
    "angle": ("Θ", "initial angle in units of theta_cr", "1", RANGES["angle"]),
    "polarity": ("±", "direction of the ground motion", "1", (-1.0, 1.0)),
    "scale": ("s", "factor of the ground motion", "1", (1e-9, MAX_LEVEL)),
}
"""Symbol, description, unit and range of each quantity, in the order of the dimensions; records come first."""


class Runs(NamedTuple):
    """Runs at n points, each an array (n,), and the motions by their number."""

    motions: Mapping[int, GroundMotion]
    record: np.ndarray
    frequency_parameter: np.ndarray  # α, 1/s
    factor: np.ndarray  # of the motion, in 1/(g θcr): what makes it a normalised base acceleration
    restitution: np.ndarray
    angle: np.ndarray
    slenderness: np.ndarray
    full: bool  # whether the blocks follow the full equation of motion


@frozen(eq=False)
class MotionSpec(SurveySpec):
    """Survey of blocks under ground motions.

    The axis `record` holds the numbers of the records. Without `restitution`, it is Housner's. `scale` is a level of the
    intensity measure.
    """

    comment = "A peak is in units of the critical angle; impacts of chattering sequences do not count."
    contiguous = True

    motions: dict[int, GroundMotion] = field(factory=dict)
    intensities: dict[int, float] = field(factory=dict)
    measure: Intensity = field(kw_only=True)
    digest: str = field(kw_only=True)
    model: str = field(kw_only=True)

    @property
    def full(self) -> bool:
        """Flag: the blocks follow the full equation of motion."""
        return self.model == "full"

    def with_axes(self, axes: dict[str, np.ndarray]) -> MotionSpec:
        """Return the survey over other axes of the same names, with the motions of these axes alone."""
        numbers = axes["record"].astype(int).tolist() if "record" in axes else list(self.motions)
        return evolve(
            self,
            axes=axes,
            motions={number: self.motions[number] for number in numbers},
            intensities={number: self.intensities[number] for number in numbers},
        )

    def inputs(self, values: Values) -> Runs:
        """Return the runs at n points."""
        count = next(iter(values.values())).size
        given = {name: np.full(count, value) for name, value in self.fixed.items()} | dict(values)
        record = np.asarray(given["record"], dtype=np.int64)
        ratio, slenderness = self.fixed["inertia_ratio"], given["slenderness"]
        alpha = _each(frequency_parameter, given["size"], ratio)
        restitution = given.get("restitution")
        if restitution is None:
            restitution = _each(housner_restitution, slenderness, ratio)
        own = np.array([self.intensities[number] for number in record.tolist()])
        factor = self.measure.factor(given["scale"], own, alpha, slenderness)
        return Runs(
            self.motions,
            record,
            alpha,
            factor * given["polarity"] / (GRAVITY * slenderness),
            restitution,
            given["angle"],
            slenderness,
            self.full,
        )

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name, and the digest of the records."""
        fixed = {name: self.fixed[name] for name in (*QUANTITIES, "inertia_ratio") if name in self.fixed}
        return fixed | {"model": self.model, "intensity": self.measure.name, "records_sha256": self.digest}

    def coordinate(self, name: str) -> dict[str, str]:
        """Return the attributes of a coordinate."""
        if name == "record":
            return {"long_name": "number of the record, from 0"}
        symbol, long_name, unit, _ = QUANTITIES[name]
        if name == "scale":
            symbol, long_name, unit = self.measure.symbol, self.measure.long_name, self.measure.unit
        return {"long_name": long_name, "symbol": symbol, "units": unit}


def motion_question(
    records: RecordSet,
    given: Mapping[str, Any],
    *,
    intensity: str,
    model: str = "slender",
    inertia_ratio: float = RECTANGLE,
    one_run: bool = False,
) -> MotionSpec:
    """Check the quantities of a survey of ground motions: arrays are axes, and the others are numbers or None.

    With ``one_run``, nothing needs to vary.

    Raises
    ------
    TypeError, ValueError
        If a quantity is missing, of the wrong type or outside its range, or if none varies. Also if a block is too squat for
        Housner's restitution.
    """
    model = one_of("model", model, MODELS)
    spans = {name: span for name, (*_, span) in QUANTITIES.items()}
    if model == "full":
        spans["slenderness"] = RANGES["critical_angle"]
    checked: dict[str, Any] = {
        name: number_or_axis(name, given.get(name), span)
        for name, span in spans.items()
        if given.get(name) is not None or name != "restitution"
    }
    axes = {name: value for name, value in checked.items() if isinstance(value, np.ndarray)}
    fixed = {name: value for name, value in checked.items() if name not in axes}
    _check_polarity(checked["polarity"])
    fixed["inertia_ratio"] = within("inertia_ratio", inertia_ratio, *INERTIA_RATIOS)
    if "restitution" not in checked:
        squattest = float(np.max(checked["slenderness"]))
        if housner_restitution(squattest, fixed["inertia_ratio"]) < 0.0:
            allowed = "be a critical angle in rad for which Housner's restitution is not negative"
            raise Refusal("slenderness", allowed, squattest, "or give {restitution}")
    measure, values = intensity_of(intensity, records)
    if len(records) > 1 or (one_run and not axes):
        axes = {"record": np.arange(float(len(records)))} | axes
    else:
        fixed["record"] = 0.0
    if not axes:
        allowed = "be an array if nothing else varies and there is one record"
        raise Refusal("size", allowed, checked["size"], "rk.simulate follows one motion")
    return MotionSpec(
        axes,
        fixed,
        dict(enumerate(records)),
        dict(enumerate(values.tolist())),
        measure=measure,
        digest=records.digest,
        model=model,
    )


def _check_polarity(polarity: float | np.ndarray) -> None:
    wrong = [value for value in np.atleast_1d(polarity).tolist() if abs(value) != 1.0]
    if wrong:
        raise Refusal("polarity", "be 1, -1 or [-1, 1]", wrong[0])


def _each(formula: Any, values: np.ndarray, inertia_ratio: float) -> np.ndarray:
    """Apply a formula for one block to many, with the rounding of the formula."""
    distinct, places = np.unique(values, return_inverse=True)
    return np.array([formula(value, inertia_ratio) for value in distinct.tolist()])[places]
