"""Set of ground motions with data about each, and the intensity measures by which a survey scales them."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from typing import Any

import numpy as np
from attrs import evolve, field, frozen

from rocking.model.arrays import read_only
from rocking.model.block_formulas import GRAVITY
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.model.intensity import DAMPING, MAX_DAMPING, PERIODS
from rocking.model.stations import RULES, chosen, rotated, shared
from rocking.model.text import counted, formatted
from rocking.model.validation import (
    Refusal,
    WrongType,
    members,
    one_of,
    reals,
    warn_of_input,
    warn_of_value,
    within,
)

ALLOWED = "hold ground motions, one at least"
REMEDY = "read them with rk.read_ground_motion, or a folder with rk.read_record_set"


def _motions(values: Any) -> tuple[GroundMotion, ...]:
    if isinstance(values, str | os.PathLike):
        raise WrongType("records", ALLOWED, values, REMEDY)
    result = (values,) if isinstance(values, GroundMotion) else members("records", values, ALLOWED)
    if not result:
        raise Refusal("records", ALLOWED, values, REMEDY)
    for each in result:
        if not isinstance(each, GroundMotion):
            raise WrongType("records", ALLOWED, each, REMEDY)
    return result


def _columns(values: Mapping[str, Any]) -> dict[str, np.ndarray]:
    if not isinstance(values, Mapping):
        raise WrongType("columns", "be a mapping of names to one number per record", values)
    return {
        str(name): read_only(np.atleast_1d(reals(f"columns[{formatted(name)}]", column)))
        for name, column in values.items()
    }


@frozen(repr=False, eq=False)
class RecordSet(Sequence[GroundMotion]):
    """Ground motions with distinct names, and columns of data about them.

    Parameters
    ----------
    records : GroundMotion or iterable of GroundMotion
        Motions; at least one. A motion without a name is called "record 1", "record 2", ….
    columns : mapping of str to array_like (n,), optional
        One number per motion, such as magnitudes, or an intensity of the user's own. Default: none.

    Raises
    ------
    TypeError, ValueError
        If a value is of the wrong type. Also if two motions have the same name, or if a column has another length.

    Warns
    -----
    InputWarning
        If a motion is a vertical component: the base of a block moves horizontally.

    See Also
    --------
    read_record_set : Read the files of a folder or of a table.

    Examples
    --------
    >>> import rocking as rk
    >>> records = rk.RecordSet(rk.synthetic_ground_motions(3, seed=1), columns={"magnitude": [6.5, 6.9, 7.2]})
    >>> len(records), records.columns["magnitude"].tolist()
    (3, [6.5, 6.9, 7.2])
    """

    motions: tuple[GroundMotion, ...] = field(alias="records", converter=_motions)
    columns: dict[str, np.ndarray] = field(factory=dict, converter=_columns)

    def __attrs_post_init__(self) -> None:
        if names := self.vertical:
            warn_of_value(vertical_sentence(names))
        seen: set[str] = set()
        for name in self.names:
            if name in seen:
                remedy = "attrs.evolve(motion, name=…) gives another name"
                raise Refusal("records", "have distinct names", f"{name} twice", remedy)
            seen.add(name)
        for name, column in self.columns.items():
            if column.shape != (len(self.motions),):
                allowed = f"hold {counted(len(self.motions), 'number')}, one per record"
                raise Refusal(f"columns[{formatted(name)}]", allowed, column.tolist())

    @property
    def names(self) -> tuple[str, ...]:
        """Name and component of each motion."""
        labels = (", ".join(filter(None, (each.name, each.component))) for each in self.motions)
        return tuple(label or f"record {number}" for number, label in enumerate(labels, 1))

    @property
    def digest(self) -> str:
        """SHA-256 of samples, steps and factors of all motions, in their order."""
        digest = sha256()
        for each in self.motions:
            base = each.normalised(1.0, 1.0)  # the samples before the factor
            digest.update(np.array([base.values.size, base.step, base.scale]).tobytes())
            digest.update(base.values.tobytes())
        return digest.hexdigest()

    @property
    def vertical(self) -> tuple[str, ...]:
        """Names of the motions whose component is vertical."""
        return tuple(name for name, each in zip(self.names, self.motions, strict=True) if each.vertical)

    def one_per_station(self, component: str = "first") -> RecordSet:
        """Return the set with one component of each station, so that no two records share an earthquake and a site.

        Components of a station are channels of one file, or records whose headers have the same name, step and number of samples.

        Parameters
        ----------
        component : {"first", "larger"}
            Rule: the first component in the set, or the one with the larger PGA. The larger one is a biased choice: it stands
            for the worse of two directions. Default: "first".

        Returns
        -------
        RecordSet
            Motions in their order, with their values of the columns.

        Raises
        ------
        TypeError, ValueError
            If there is no such rule.

        Examples
        --------
        >>> import rocking as rk
        >>> pair = [rk.GroundMotion([0.0, a, 0.0], step=0.1, name="Town", component=n) for a, n in ((1.0, "90°"), (2.0, "0°"))]
        >>> rk.RecordSet(pair).one_per_station("larger").names
        ('Town, 0°',)
        """
        rule = one_of("component", component, RULES)
        places = sorted(chosen(self.motions, rule))
        return RecordSet(
            [self.motions[place] for place in places],
            {name: column[places] for name, column in self.columns.items()},
        )

    def rotated(self, angle: Any) -> RecordSet:
        """Return the horizontal component of each station at an angle, or those at several.

        A set of several angles shows in how many directions of shaking a block overturns. Its records depend on each other: a
        fraction over them is one over directions, and no interval of a survey applies to it.

        Parameters
        ----------
        angle : float or array_like (m,)
            Angle in rad from the first component of each station towards the second, in [-2π, 2π], as for `GroundMotion.rotated`.

        Returns
        -------
        RecordSet
            One motion per station and angle, the angles of a station in a row. Channels of one file are clipped to the shorter one.
            Columns that have equal values for both components stay. Several angles make a column `azimuth`.

        Raises
        ------
        TypeError, ValueError
            If an angle is of the wrong type or outside its range, or if a station has not two horizontal components, which
            `GroundMotion.rotated` takes.

        Examples
        --------
        >>> import numpy as np, rocking as rk
        >>> pair = [rk.GroundMotion([0.0, a, 0.0], step=0.1, name="Town", component=n) for a, n in ((1.0, "90°"), (2.0, "0°"))]
        >>> turned = rk.RecordSet(pair).rotated(np.radians([0, 45, 90]))
        >>> turned.names, [round(each.pga, 3) for each in turned]
        (('Town, 90°', 'Town, 45°', 'Town, 0°'), [1.0, 2.121, 2.0])
        """
        angles = np.asarray(reals("angle", angle), dtype=float)
        if angles.ndim > 1 or not angles.size:
            raise Refusal("angle", "be a number or numbers in a row, in rad", angle)
        each = angles.ravel().tolist()
        motions, pairs = rotated(self.motions, self.names, each)
        columns = shared(self.columns, pairs, len(each))
        if angles.ndim:
            columns["azimuth"] = np.tile(angles, len(pairs))
        return RecordSet(motions, columns)

    def __len__(self) -> int:
        return len(self.motions)

    def __getitem__(self, place: Any) -> Any:
        return self.motions[place]

    def __iter__(self) -> Iterator[GroundMotion]:
        return iter(self.motions)

    def __repr__(self) -> str:
        more = f", columns {', '.join(self.columns)}" if self.columns else ""
        return f"RecordSet({counted(len(self), 'record')}{more})"


def both_ways(records: RecordSet) -> RecordSet:
    """Return each record followed by its reverse, named "NAME reversed"."""
    motions = []
    for name, motion in zip(records.names, records, strict=True):
        motions += [
            evolve(motion, name=name, component=""),
            evolve(motion.reversed(), name=f"{name} reversed", component=""),
        ]
    return RecordSet(motions, {name: np.repeat(column, 2) for name, column in records.columns.items()})


def record_set(records: RecordSet | GroundMotion | Iterable[GroundMotion]) -> RecordSet:
    """Return a set of records as it is, and one or more ground motions as a set, with a warning of vertical components."""
    if isinstance(records, RecordSet):
        return records
    result = RecordSet(records)
    if names := result.vertical:
        warn_of_input(vertical_sentence(names))
    return result


def _for_any_block(frequency_parameter: Any, critical_angle: Any) -> Any:
    return 1.0


def _per_lift_off(frequency_parameter: Any, critical_angle: Any) -> Any:
    return 1.0 / (GRAVITY * np.tan(critical_angle))


def _per_lift_off_and_time(frequency_parameter: Any, critical_angle: Any) -> Any:
    return frequency_parameter * _per_lift_off(frequency_parameter, critical_angle)


@frozen
class Intensity:
    """Intensity measure.

    Attributes
    ----------
    name : str
        Name in arguments and options.
    symbol, unit, long_name : str
        Symbol, unit and description.
    power : int
        Power of the factor of the motion to which the value is proportional.
    per_block : callable
        (α, θcr) → factor of the value of the motion, for measures that compare the motion with a block.
    """

    name: str
    symbol: str
    unit: str
    long_name: str
    power: int = 1
    per_block: Callable[[Any, Any], Any] = _for_any_block

    def factor(self, level: Any, value: Any, frequency_parameter: Any, critical_angle: Any) -> Any:
        """Return the factor that scales a motion from a `value` to a `level`, for blocks with α in 1/s and θcr in rad."""
        ratio = level / (value * self.per_block(frequency_parameter, critical_angle))
        return ratio if self.power == 1 else ratio ** (1.0 / self.power)

    def level(self, factor: Any, value: Any, frequency_parameter: Any, critical_angle: Any) -> Any:
        """Return the level of a motion times a factor: the inverse of `factor`."""
        return factor**self.power * value * self.per_block(frequency_parameter, critical_angle)


INTENSITIES: dict[str, tuple[Intensity, Callable[[GroundMotion], float]]] = {
    measure.name: (measure, value)
    for measure, value in (
        (Intensity("scale", "factor", "1", "factor of the ground motion"), lambda motion: 1.0),
        (Intensity("pga", "PGA", "m/s²", "peak ground acceleration"), lambda motion: motion.pga),
        (Intensity("pga-g", "PGA", "g", "peak ground acceleration"), lambda motion: motion.pga / GRAVITY),
        (Intensity("pgv", "PGV", "m/s", "peak ground velocity"), lambda motion: motion.pgv),
        (Intensity("pgd", "PGD", "m", "peak ground displacement"), lambda motion: motion.pgd),
        (Intensity("arias", "I_A", "m/s", "Arias intensity", 2), lambda motion: motion.arias_intensity),
        (Intensity("cav", "CAV", "m/s", "cumulative absolute velocity"), lambda motion: motion.cav),
        (
            Intensity(
                "pga-ratio",
                "PGA/(g tan θcr)",
                "1",
                "peak ground acceleration relative to lift-off",
                1,
                _per_lift_off,
            ),
            lambda motion: motion.pga,
        ),
        (
            Intensity(
                "pgv-ratio",
                "α PGV/(g tan θcr)",
                "1",
                "peak ground velocity relative to the block",
                1,
                _per_lift_off_and_time,
            ),
            lambda motion: motion.pgv,
        ),
    )
}
"""Measures by name, with their values for a motion, before `Intensity.per_block`."""


SPECTRAL = re.compile(r"(sa|sa-avg)\(([^()]*)\)")
SPECTRAL_FORMS = ("sa(PERIOD)", "sa(PERIOD, DAMPING)", "sa-avg(PERIOD, PERIOD, …)")
"""Measures of the response spectrum: periods in s; the damping ratio is 0.05 unless it is given."""


def measure_named(name: str) -> tuple[Intensity, Callable[[GroundMotion], float]] | None:
    """Return a measure and its values for a motion, by its name; None if there is no such measure.

    Raises
    ------
    TypeError, ValueError
        If the periods or the damping of a spectral measure are no numbers, or lie outside their ranges.

    Examples
    --------
    >>> measure_named("sa(0.5)")[0].symbol, measure_named("magnitude")
    ('Sa(0.5 s)', None)
    """
    if not isinstance(name, str):
        return None
    if name in INTENSITIES:
        return INTENSITIES[name]
    found = SPECTRAL.fullmatch(name)
    return None if found is None else _spectral(name, found[1], found[2].split(","))


def _spectral(
    name: str, kind: str, cells: Sequence[str]
) -> tuple[Intensity, Callable[[GroundMotion], float]]:
    try:
        numbers = [float(cell) for cell in cells]
    except ValueError:
        numbers = []
    if not numbers or (kind == "sa" and len(numbers) > 2):
        raise Refusal("intensity", f"have the form {' or '.join(SPECTRAL_FORMS)}", name)
    name = f"{kind}({', '.join(repr(number).removesuffix('.0') for number in numbers)})"
    argument = f"intensity {name!r}"
    periods, damping = (numbers[:1], numbers[1:]) if kind == "sa" else (numbers, [])
    for period in periods:
        within(f"the period of {argument}", period, *PERIODS, "s")
    ratio = within(f"the damping of {argument}", damping[0], 0, MAX_DAMPING) if damping else DAMPING
    damped = f", ζ = {ratio:g}" if damping else ""
    text = f"damping {100 * ratio:g} %"
    if kind == "sa":
        (period,) = periods
        measure = Intensity(
            name, f"Sa({period:g} s{damped})", "m/s²", f"pseudo-acceleration at {period:g} s, {text}"
        )
        return measure, lambda motion: float(motion.response_spectrum(period, ratio))
    span = f"{min(periods):g}–{max(periods):g} s"
    long_name = (
        f"geometric mean of the pseudo-acceleration at {counted(len(periods), 'period')}, {span}, {text}"
    )
    return Intensity(name, f"Sa_avg({span})", "m/s²", long_name), lambda motion: motion.average_spectrum(
        periods, ratio
    )


def intensity_of(name: str, records: RecordSet) -> tuple[Intensity, np.ndarray]:
    """Return an intensity measure and its values (n,) for the motions as they are, before `Intensity.per_block`.

    A column of the set is a measure, too. It is taken as proportional to the factor of the motion.

    Raises
    ------
    TypeError, ValueError
        If there is no such measure, or if a column has its name. Also if a motion has no positive value of it.

    Examples
    --------
    >>> import rocking as rk
    >>> from rocking.model.record_set import RecordSet
    >>> measure, values = intensity_of("pga", RecordSet([rk.GroundMotion([0.0, 2.0], step=0.1)]))
    >>> measure.unit, values.tolist()
    ('m/s²', [2.0])
    """
    known = measure_named(name)
    if known is None:
        one_of("intensity", name, (*INTENSITIES, *SPECTRAL_FORMS, *records.columns))
    elif name in records.columns:
        allowed = "name either a measure or a column of the records, not both"
        raise Refusal("intensity", allowed, name, "rename the column")
    if known is None:
        measure, values = Intensity(name, name, "", f"column {name!r} of the records"), records.columns[name]
    else:
        measure, value = known
        values = np.array([value(motion) for motion in records])
    lacking = ~(np.isfinite(values) & (values > 0.0))
    if lacking.any():
        first = int(np.argmax(lacking))
        allowed = f"be positive for each record, unlike for {records.names[first]!r}"
        raise Refusal(f"intensity {name!r}", allowed, float(values[first]))
    return measure, values
