"""Results of surveys over initial states and parameters: a dataset with a one-line summary."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from attrs import field, frozen

from rocking.model.orbit import Orbit
from rocking.model.quantity import IN_SI, LOWEST
from rocking.model.record_results import named_levels
from rocking.model.result import UNITS, Result, along, described
from rocking.model.share import Share, share_variables
from rocking.model.system import State, System, quantities
from rocking.model.tables_and_json import counts
from rocking.model.text import percent
from rocking.model.validation import Refusal, Text, WrongType, instance, one_of, refuse_if
from rocking.model.verdict import Kind, Verdict

if TYPE_CHECKING:
    import xarray as xr


def check_survey(name: str, data: Any, allowed: str, variables: Iterable[str]) -> xr.Dataset:
    """Return the dataset of a survey that has some variables; WrongType, or Refusal if it is in SI units."""
    import xarray as xr

    if not isinstance(data, xr.Dataset) or any(variable not in data for variable in variables):
        raise WrongType(name, allowed, data)
    units = {key: each.attrs.get("units") for key, each in data.coords.items()}
    for key, each in IN_SI.items():
        if units.get(key) == each.units or each.key in data.attrs:
            raise Refusal(
                name, "be normalised", Text("one in SI units"), "take to_xarray(units='normalised')"
            )
    return data


@frozen(eq=False)
class SystemSurvey(Result):
    """Base class of surveys of a system, some of whose quantities are the axes of the dataset.

    Attributes
    ----------
    system : System or None
        System of the survey, without the values of the axes; None for a dataset that was read from a file.
    """

    VARIABLES: ClassVar[tuple[str, ...]] = ()
    """Variables without which a dataset is none of the class."""

    dataset: xr.Dataset = field(repr=False)
    system: System | None = field(default=None, repr=False, kw_only=True)

    def __attrs_post_init__(self) -> None:
        check_survey("dataset", self.dataset, f"be that of a {type(self).__name__}", self.VARIABLES)
        if self.system is not None:
            instance("system", self.system, System)

    @property
    def block(self) -> Any:
        """Block in SI units that the system was made of; None if there is none, or if blocks of several angles were surveyed."""
        known = self.system is not None and "critical_angle" not in self.dataset.coords
        return self.system.block if known else None  # type: ignore[union-attr]

    def _block(self, units: str | None, block: Any) -> Any:
        allowed = "be omitted: the critical angle varies, and with it the units"
        refuse_if(block is not None and "critical_angle" in self.dataset.coords, "block", allowed, block)
        return super()._block(units, block)


def shares_line(data: xr.Dataset, variable: str, what: str, points: str) -> str:
    """Return the size of a grid and the fraction of its points with each flag of a variable, in one line."""
    size = " × ".join(f"{count:,}" for count in data[variable].shape)
    there = {name: count for name, count in counts(data, variable).items() if count}
    total = sum(there.values())
    shares = ", ".join(f"{name} {percent(count / total)}" for name, count in there.items())
    return f"{what} of {size} {points}: {shares or 'none computed yet'}"


def counted_flags(data: xr.Dataset, *variables: str) -> xr.Dataset:
    """Return the number of points with each flag of some variables, with the attributes of the dataset."""
    import xarray as xr

    numbers: dict[str, Any] = {}
    names: dict[str, Any] = {}
    for variable in variables:
        text = str(data[variable].attrs["long_name"])
        result = counts(data, variable)
        names[variable] = variable, list(result), {"long_name": text}
        numbers[f"{variable}_points"] = variable, list(result.values()), {"long_name": "number of points"}
    axes = {f"{name}_range": values[[0, -1]].tolist() for name, values in data[variables[0]].indexes.items()}
    sizes = {f"{name}_count": data.sizes[name] for name in data[variables[0]].dims}
    return xr.Dataset(numbers, names, data.attrs | axes | sizes)


@frozen(eq=False)
class ParametricMap(SystemSurvey):
    """Responses over two quantities; returned by `parametric_map`. A dataset from a file or a store also makes one.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over both axes: `kind`, `evidence`, `symmetric` (codes explained by their attributes `flag_values` and
        `flag_meanings`), `response_period`, `impacts_per_period`, `brace_hits_per_period`, `exponent`, `exponent_error`, `peak`,
        `transient` and `cycles`, as in `Verdict`. That of a store is read on access.

    Examples
    --------
    >>> import numpy as np, rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.9)
    >>> print(rk.parametric_map(system, amplitude=[0.5, 2.0], period=np.linspace(0.8, 1.2, 5)))
    map of 2 × 5 points: rest 50.0 %, periodic 50.0 %
    """

    PLOT = "parametric_map"
    VARIABLES = ("kind", "evidence", "response_period", "symmetric")

    def _summary(self) -> xr.Dataset:
        return counted_flags(self.dataset, "kind", "evidence")

    def __str__(self) -> str:
        return shares_line(self.dataset, "kind", "map", "points")


@frozen(eq=False)
class OverturningSpectrum(SystemSurvey):
    """Outcomes under one pulse over its amplitude and frequency; returned by `overturning_spectrum`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `amplitude`, `frequency` and, if they vary, `restitution` and `critical_angle`. `outcome` and `certified` are
        codes that their attributes explain. `peak` is the largest |Θ|, infinite if the block overturns. `margin` and `impacts` are
        as in `RockingSpectrum`. `impacts_since_rest` of a block that overturns is the mode of overturning.

    Examples
    --------
    >>> import rocking as rk
    >>> pulse = rk.Pulse("one-sine", amplitude=5.0, duration=1.0)
    >>> system = rk.System(pulse, restitution=0.9)
    >>> print(rk.overturning_spectrum(system, amplitude=[3.0, 4.0, 7.0, 8.0], frequency=[4, 5]))
    overturning spectrum of 4 × 2 runs: at-rest 25.0 %, overturned 75.0 %
    """

    PLOT = "overturning_spectrum"
    VARIABLES = ("outcome", "certified", "impacts_since_rest")

    def _summary(self) -> xr.Dataset:
        return counted_flags(self.dataset, "outcome", "certified")

    def __str__(self) -> str:
        return shares_line(self.dataset, "outcome", "overturning spectrum", "runs")


@frozen(eq=False)
class RockingSpectrum(Result):
    """Ends of blocks of many sizes under ground motions; returned by `rocking_spectrum`. A dataset from a file also makes one.

    Angles are in units of the critical angle of each block, and sizes in SI units.

    Attributes
    ----------
    dataset : xarray.Dataset
        `outcome` and `certified` (codes explained by their attributes), `peak` (largest |Θ|, infinite if the block
        overturns), `margin`, `impacts` and `impacts_since_rest`. Impacts of chattering sequences are cut short.
        Coordinates `name` and `pga` describe the records, `frequency_parameter` the sizes.

    Examples
    --------
    >>> import numpy as np, rocking as rk
    >>> strong = rk.example_ground_motion().scaled(5)
    >>> print(rk.rocking_spectrum(strong, rk.Block(2.0, 0.5), size=np.linspace(0.5, 4, 8)))
    rocking spectrum of 8 runs: ...
    """

    PLOT = "rocking_spectrum"

    dataset: xr.Dataset = field(repr=False, converter=named_levels)

    def __attrs_post_init__(self) -> None:
        check_survey(
            "dataset", self.dataset, "be that of a RockingSpectrum", ("outcome", "certified", "peak")
        )

    def _block(self, units: str | None, block: Any) -> None:
        allowed = "be omitted: the angles are in units of the critical angle of each block"
        refuse_if(units is not None and one_of("units", units, UNITS) == "si", "units", allowed, units)
        refuse_if(block is not None, "block", allowed, block)

    def _summary(self) -> xr.Dataset:
        return counted_flags(self.dataset, "outcome", "certified")

    def __str__(self) -> str:
        return shares_line(self.dataset, "outcome", "rocking spectrum", "runs")


@frozen(eq=False)
class SafeBasin(SystemSurvey):
    """Safe fraction of initial states as a function of the amplitude; returned by `safe_basin`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `amplitude`: `safe` with the ends `safe_low` and `safe_high` of its 95 % interval, and
        `undetermined`, the fraction of undetermined initial states. These count as safe.
    shares : tuple of Share
        Safe fractions, as counts.
    heteroclinic_amplitude : float
        Amplitude A*, above which the boundary of the overturning initial states is fractal (exact). NaN with braces, with the full
        equation, and for an unsymmetric block, which have no closed form.
    melnikov_amplitude : float
        Amplitude A_M, the first-order approximation of A* by Melnikov's method. NaN as A*.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.925)
    >>> result = rk.safe_basin(system, amplitude=[0.2, 0.5], samples=100)
    >>> result.shares[0].of, result.melnikov_amplitude < result.heteroclinic_amplitude
    (100, True)
    """

    PLOT = "safe_basin"

    shares: tuple[Share, ...]
    heteroclinic_amplitude: float
    melnikov_amplitude: float

    def __str__(self) -> str:
        amplitudes = self.dataset.amplitude.values
        least = min(range(len(self.shares)), key=lambda k: self.shares[k].value)
        first, last = self.shares[0], self.shares[-1]
        summary = (
            f"safe fraction: {first} of {first.of:,} initial states at A = {amplitudes[0]:.6g}, {last} at A = {amplitudes[-1]:.6g}, "
            f"lowest {self.shares[least]} at A = {amplitudes[least]:.6g}"
        )
        if np.isnan(self.heteroclinic_amplitude):
            return summary
        return f"{summary}; A* = {self.heteroclinic_amplitude:.6g}, A_M = {self.melnikov_amplitude:.6g}"


@frozen(eq=False)
class OverturningCurve(SystemSurvey):
    """Lowest amplitude that overturns a block initially at rest; returned by `overturning_amplitude`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `period` (or `frequency`) and `restitution`, as far as they vary:

        - `lowest`: lowest overturning amplitude found, NaN if none was;
        - `lowest_phase`: forcing phase at which it was found, rad;
        - `resolution`: distance to the next lower amplitude of the scan;
        - `survived_up_to`: highest amplitude of the scan up to which no run overturns;
        - `surviving_above`: fraction of the scanned amplitudes and phases above `lowest` that do not overturn;
        - `overturning_share`, also over `amplitude`: fraction of the phases that overturn;
        - `changes`, also over `phase`: number of changes of the outcome along A;
        - `heteroclinic_amplitude`: A*; NaN as in `SafeBasin`.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=2.0), restitution=0.925)
    >>> print(rk.overturning_amplitude(system, amplitude=[0.5, 1.0], phases=2))
    no overturning from rest at 2 amplitudes from 0.5 to 1 and 2 phases
    """

    PLOT = "overturning"
    QUANTITIES: ClassVar = {"lowest": LOWEST}

    def _data(self) -> xr.Dataset:
        """Return the dataset with the range of the amplitudes scanned, and the numbers of amplitudes and phases."""
        data = self.dataset.copy(deep=False)
        data.attrs = {name: value for name, value in data.attrs.items() if name != "phase"}  # it is scanned
        ends = data.amplitude.values[[0, -1]].tolist()
        return data.assign_attrs(
            amplitude_range=ends, amplitudes=data.sizes["amplitude"], phases=data.sizes["phase"]
        )

    def _summary(self) -> xr.Dataset:
        return self._data().drop_dims(["amplitude", "phase"])

    def __str__(self) -> str:
        lowest, scanned = self.dataset.lowest.values, self.dataset.amplitude.values
        what = f"{scanned.size} amplitudes from {scanned[0]:.6g} to {scanned[-1]:.6g} and {self.dataset.phase.size} phases"
        if np.isnan(lowest).all():
            return f"no overturning from rest at {what}"
        where = np.unravel_index(np.nanargmin(lowest), lowest.shape)
        at = ", ".join(
            f"{name} = {self.dataset[name].values[k]:.6g}"
            for name, k in zip(self.dataset.lowest.dims, where, strict=True)
        )
        above = float(self.dataset.surviving_above.values[where])
        return (
            f"lowest overturning amplitude from rest {lowest[where]:.6g}{' at ' * bool(at)}{at}, from a scan of {what}; "
            f"{100.0 * above:.1f} % of the scanned points above it do not overturn"
        )


@frozen(eq=False)
class ChaosShare(SystemSurvey):
    """Fraction of chaotic responses over random periods and amplitudes; returned by `chaos_share`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `restitution`: `chaotic` with the ends `chaotic_low` and `chaotic_high` of its 95 % interval.
        Variable over `restitution` and `response`: `share`, the fraction of each response type.
    shares : tuple of Share
        Fractions of chaotic responses, as counts.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> print(rk.chaos_share(system, period=(0.5, 1.0), amplitude=(0.1, 0.9), samples=10))
    chaotic fraction: 0 % (0–27.8 %) at e = 0.9, of 10 responses each
    """

    PLOT = "chaos_share"

    shares: tuple[Share, ...]

    def __str__(self) -> str:
        pairs = zip(self.dataset.restitution.values, self.shares, strict=True)
        fractions = ", ".join(f"{share} at e = {restitution:.6g}" for restitution, share in pairs)
        return f"chaotic fraction: {fractions}, of {self.shares[0].of:,} responses each"


@frozen
class Repeatability(Result):
    """Outcomes of one experiment whose inputs are slightly uncertain; returned by `repeatability`.

    Attributes
    ----------
    system, start : System, State
        Nominal system and initial state.
    relative : float
        Largest relative error of each input.
    kinds : dict of Kind to Share
        Fraction of the runs with each response type, the largest first. Undetermined runs come last; they are no outcome
        of their own but widen the intervals of all others.
    responses : dict of str to Share
        Fractions with periodic responses distinguished by period, symmetry and number of impacts.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> result = rk.repeatability(system, samples=100)
    >>> print(result)
    100 runs with inputs off by up to 1 %: rest 100 % (96.3–100 %)
    >>> result.certain
    True
    """

    PLOT = "repeatability"

    system: System
    start: State
    relative: float
    kinds: dict[Kind, Share] = field(hash=False)
    responses: dict[str, Share] = field(repr=False, hash=False)

    def _data(self) -> xr.Dataset:
        import xarray as xr

        variables = share_variables("response", self.responses.values()) | share_variables(
            "kind", self.kinds.values()
        )
        names = {
            **along("response", {"response": (list(self.responses), "response")}),
            **along("kind", {"kind": ([str(kind) for kind in self.kinds], "type of the response")}),
        }
        attributes = described("Repeatability") | {
            **quantities(self.system),
            "start_angle": self.start.angle,
            "start_velocity": self.start.velocity,
            "relative": self.relative,
            "samples": self.repeats.of,
        }
        return xr.Dataset(variables, names, attributes)

    @property
    def certain(self) -> bool:
        """True if all runs have one response type and none is undetermined."""
        return len(self.kinds) == 1 and Kind.UNDETERMINED not in self.kinds

    @property
    def repeats(self) -> Share:
        """Fraction of the most frequent response type; 0 with all runs unknown if all are undetermined."""
        first, share = next(iter(self.kinds.items()))
        return Share(0, share.of, share.of) if first is Kind.UNDETERMINED else share

    def __str__(self) -> str:
        responses = ", ".join(f"{name} {share}" for name, share in self.responses.items())
        return f"{self.repeats.of:,} runs with inputs off by up to {100.0 * self.relative:.3g} %: {responses}"


@frozen(eq=False)
class RepeatabilityMap(SystemSurvey):
    """Map of the repeatability of outcomes over two quantities; returned by `repeatability_map`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over both axes:

        - `kind`: most frequent response type of the runs at a point, undetermined only if all runs are;
        - `agreeing`: fraction of the runs with this type;
        - `overturned`, `undetermined`: fractions of the runs with these types.
    uncertain : Share
        Fraction of points at which the runs have different response types. Points with undetermined runs and otherwise
        equal types count as unknown.
    overturning_uncertain : Share
        Fraction of points at which some runs overturn and others do not. Unknown points are counted likewise.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> print(rk.repeatability_map(system, amplitude=[0.2, 0.5], period=[1.0, 2.0], samples=10))
    inputs off by up to 1 %: response type uncertain at 0 % (0–49.0 %), overturning uncertain at 0 % (0–49.0 %), of 4 points
    """

    PLOT = "repeatability_map"

    uncertain: Share
    overturning_uncertain: Share

    def _data(self) -> xr.Dataset:
        """Return the dataset with both fractions as attributes."""
        shares = {"uncertain": self.uncertain, "overturning_uncertain": self.overturning_uncertain}
        rows = {
            f"{name}{end}": getattr(share, part)
            for name, share in shares.items()
            for end, part in (("", "value"), ("_low", "low"), ("_high", "high"))
        }
        return self.dataset.assign_attrs(rows, points=self.uncertain.of)

    def _summary(self) -> xr.Dataset:
        return self._data().drop_vars(list(self.dataset.data_vars))

    def __str__(self) -> str:
        off = 100.0 * self.dataset.attrs["relative"]
        return (
            f"inputs off by up to {off:.3g} %: response type uncertain at {self.uncertain}, "
            f"overturning uncertain at {self.overturning_uncertain}, of {self.uncertain.of:,} points"
        )


# With a lower end of the interval below this value, both a smooth and a fractal boundary are possible.
SMOOTH_FROM = 0.9


@frozen
class Attractor:
    """Attractor of a basin map, or another outcome such as overturning.

    Attributes
    ----------
    name : str
        Unique name within the map, such as "period 1, asymmetric (a)".
    verdict : Verdict
        Verdict, with its evidence, of one initial state of the basin. `verdict.start` is this state.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> result = rk.basin_map(system, angle=[0.0, 0.1], velocity=[0.0, 0.1], boundary_runs=0)
    >>> print(result.attractors[0])
    rest
    """

    name: str
    verdict: Verdict = field(repr=False)

    @property
    def kind(self) -> Kind:
        """Response type. Overturning is listed as well, although it is not an attractor."""
        return self.verdict.kind

    @property
    def orbit(self) -> Orbit | None:
        """Periodic orbit; None if the response is not periodic."""
        return self.verdict.orbit

    def __str__(self) -> str:
        return self.name


@frozen
class UncertaintyExponent:
    """Uncertainty exponent of a basin boundary: f ~ ε^value.

    f is the fraction of uncertain initial states, and ε is the uncertainty of the initial state. The exponent is 1
    for a smooth boundary in the plane. It is below 1 for a fractal boundary, of box dimension 2 − value.

    Attributes
    ----------
    value : float
        Uncertainty exponent.
    low, high : float
        Ends of its 95 % confidence interval.
    distances : tuple of float
        Uncertainties ε, in the units of Θ and Θ'.
    uncertain : tuple of Share
        Fraction of uncertain initial states for each ε. A random initial state is uncertain if one of two states, at
        distance ε on opposite sides in a random direction, leads to another attractor.
    misfit : float
        χ² per degree of freedom of the power law, about 1 if it holds. If it is larger, the interval is wider by
        its square root.

    References
    ----------
    McDonald, Grebogi, Ott & Yorke, Physica D 17, 125–153 (1985).

    Examples
    --------
    >>> exponent = UncertaintyExponent(0.85, 0.72, 0.98, distances=(), uncertain=(), misfit=1.0)
    >>> print(exponent)
    0.850 (0.720–0.980)
    >>> exponent.fractal, exponent.meaning
    (True, 'below 1: fractal')
    """

    value: float
    low: float
    high: float
    distances: tuple[float, ...] = field(repr=False)
    uncertain: tuple[Share, ...] = field(repr=False)
    misfit: float = field(repr=False)

    @property
    def fractal(self) -> bool:
        """True if the whole interval lies below 1, the exponent of a smooth boundary."""
        return self.high < 1.0

    @property
    def smooth(self) -> bool:
        """True if the interval contains 1 and begins at 0.9 or above: this excludes box dimensions above 1.1."""
        return SMOOTH_FROM <= self.low <= 1.0 <= self.high

    @property
    def meaning(self) -> str:
        """Conclusion from the interval: fractal, smooth or undecided."""
        if self.fractal:
            return "below 1: fractal"
        if self.smooth:
            return f"contains 1, not below {SMOOTH_FROM:g}: smooth"
        where = "contains 1" if self.low <= 1.0 else "lies above 1"
        return f"undecided: {self.low:.2f}–{self.high:.2f} {where}"

    def __str__(self) -> str:
        return f"{self.value:.3f} ({self.low:.3f}–{self.high:.3f})"


@frozen(eq=False)
class BasinMap(Result):
    """Basins of attraction of a system over a grid or a random sample of initial states; returned by `basin_map`.

    Attributes
    ----------
    system : System
        System of the map.
    dataset : xarray.Dataset
        Variables over the initial states: `attractor` (index into `attractors`), `kind`, `evidence`,
        `response_period`, `impacts_per_period`, `brace_hits_per_period`, `symmetric`, `orbit_angle` and
        `orbit_velocity` (the state that represents the orbit), `mean_angle` and `mean_angle_error` (mean over the
        section, for chaotic responses), `transient`, `cycles`.
    attractors : tuple of Attractor
        Attractors, that of the largest basin first.
    fractions : tuple of Share
        Fraction of the initial states in each basin, in the same order.
    uncertainty_exponent : UncertaintyExponent or None
        Exponent of the boundary between initial states that overturn and those that do not. None if there is no
        such boundary, or if it was not estimated.
    attractor_exponent : UncertaintyExponent or None
        Exponent of the boundaries between all basins. None likewise.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> print(rk.basin_map(system, angle=[0.0, 0.1], velocity=[0.0, 0.1], boundary_runs=0))
    4 initial states: rest 50.0 % (15.0–85.0 %), period 1, symmetric 50.0 % (15.0–85.0 %)
    """

    PLOT = "basins"
    LONG = ("velocity_angle", "sample")

    system: System
    dataset: xr.Dataset = field(repr=False)
    attractors: tuple[Attractor, ...]
    fractions: tuple[Share, ...]
    uncertainty_exponent: UncertaintyExponent | None
    attractor_exponent: UncertaintyExponent | None

    def _data(self) -> xr.Dataset:
        """Return the dataset with the basins over `basin`, and the exponents as attributes."""
        verdicts = [each.verdict for each in self.attractors]
        counts = [-1 if each.impacts_per_period is None else each.impacts_per_period for each in verdicts]
        columns = {
            "basin_name": ([each.name for each in self.attractors], "name of the attractor"),
            "basin_kind": ([str(each.kind) for each in verdicts], "type of the response"),
            "basin_response_period": (
                [each.period or 0 for each in verdicts],
                "forcing cycles per response period; 0: not periodic",
            ),
            "basin_impacts_per_period": (counts, "impacts per period; -1: not periodic, or infinitely many"),
            "basin_start_angle": (
                [each.start.angle for each in verdicts],
                "angle of an initial state of the basin",
            ),
            "basin_start_velocity": (
                [each.start.velocity for each in verdicts],
                "velocity of this initial state",
            ),
        }
        exponents = {
            "uncertainty_exponent": self.uncertainty_exponent,
            "attractor_exponent": self.attractor_exponent,
        }
        attributes = {
            f"{name}{end}": None if each is None else getattr(each, part)
            for name, each in exponents.items()
            for end, part in (
                ("", "value"),
                ("_low", "low"),
                ("_high", "high"),
                ("_misfit", "misfit"),
                ("_meaning", "meaning"),
            )
        }
        return self.dataset.assign(
            along("basin", columns) | share_variables("basin", self.fractions)
        ).assign_attrs(attributes)

    @property
    def safe(self) -> Share:
        """Safe fraction: the fraction of initial states that do not overturn."""
        pairs = list(zip(self.attractors, self.fractions, strict=True))
        fallen = sum(share.count for each, share in pairs if each.kind is Kind.OVERTURNED)
        of = self.fractions[0].of
        return Share(of - fallen, of)

    def __str__(self) -> str:
        parts = (f"{each.name} {share}" for each, share in zip(self.attractors, self.fractions, strict=True))
        text = f"{self.fractions[0].of:,} initial states: {', '.join(parts)}"
        exponent = self.uncertainty_exponent
        return (
            text
            if exponent is None
            else f"{text}; uncertainty exponent of the overturning boundary {exponent}"
        )
