"""Response diagrams: verdict, largest exponent and rotation number over the values of a parameter."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen
from numpy.typing import ArrayLike, NDArray

from rocking.model.arrays import ReadOnlyArrays, nan_if_none, read_only
from rocking.model.progress import Bar
from rocking.model.quantity import SYSTEM_QUANTITIES
from rocking.model.result import Result, along, described
from rocking.model.system import State, System, check_periodic
from rocking.model.validation import instance
from rocking.model.verdict import Kind, Verdict
from rocking.orbits.parameter import (
    coordinate_of,
    fixed_quantities,
    kinds_of,
    varied_parameter,
    with_value,
)
from rocking.response.classify import MeanImpacts, budget, classify, mean_impacts
from rocking.response.rotation_number import RotationNumber

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class ResponseDiagram(ReadOnlyArrays, Result):
    """Responses over the values of a parameter; returned by `response_diagram`.

    Attributes
    ----------
    system : System
        System of which one parameter is varied.
    parameter : str
        Name of the parameter.
    values : ndarray, shape (n,)
        Values of the parameter, ascending.
    start : State
        Initial state of each motion.
    verdicts : tuple of Verdict
        Verdict at each value, with its evidence.
    rotation, rotation_error : ndarray, shape (n,)
        Rotation number: mean number of impacts per forcing cycle, and its error. NaN without a rotation number. The error is 0
        for a periodic response, and if all cycles of a chaotic run have the same number of impacts. It is infinite if the run
        supports no error.
    rotation_numbers : tuple
        Result of `rotation_number` at each value, with the rotation within an island; None if it was not computed.
    max_cycles, max_period : int
        Limits of each verdict, as in `classify`.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.response_diagram(system, amplitude=[0.5, 2.0])
    >>> print(result)
    response diagram over amplitude 0.5 to 2, 2 values, each from Θ = 0, Θ' = 0: 1 rest, 1 periodic (period 1)
    >>> result.exponent.round(4).tolist(), result.rotation.tolist()
    ([-inf, -0.1559], [0.0, 2.0])
    """

    PLOT = "response_diagram"

    system: System
    parameter: str
    values: NDArray[np.float64] = field(repr=False, converter=read_only)
    start: State
    verdicts: tuple[Verdict, ...] = field(repr=False)
    rotation: NDArray[np.float64] = field(repr=False, converter=read_only)
    rotation_error: NDArray[np.float64] = field(repr=False, converter=read_only)
    rotation_numbers: tuple[RotationNumber | None, ...] = field(repr=False)
    max_cycles: int
    max_period: int

    @property
    def kind(self) -> NDArray[np.str_]:
        """Types of response, shape (n,), as in `Kind`."""
        return read_only(np.array([verdict.kind.value for verdict in self.verdicts]))

    @property
    def period(self) -> NDArray[np.int64]:
        """Numbers of forcing cycles per response period, shape (n,); 0 if not periodic."""
        return read_only(np.array([verdict.period or 0 for verdict in self.verdicts], np.int64))

    @property
    def symmetric(self) -> NDArray[np.bool_]:
        """True for periodic responses that are their own mirror images half a period later, shape (n,)."""
        return read_only(np.array([bool(verdict.symmetric) for verdict in self.verdicts]))

    @property
    def exponent(self) -> NDArray[np.float64]:
        """Largest Lyapunov exponents per τ, shape (n,), as in `Verdict`; NaN if it is not known."""
        return read_only(nan_if_none(verdict.exponent for verdict in self.verdicts))

    @property
    def exponent_error(self) -> NDArray[np.float64]:
        """Standard errors of the exponents per τ, shape (n,); 0 if multipliers give the exponent, NaN without an error."""
        return read_only(nan_if_none(verdict.exponent_error for verdict in self.verdicts))

    @property
    def evidence(self) -> tuple[str, ...]:
        """Evidence of each verdict in words."""
        return tuple(str(verdict.evidence) for verdict in self.verdicts)

    @property
    def fixed(self) -> dict[str, float]:
        """Parameters that were not varied, by name."""
        return fixed_quantities(self.system, self.parameter)

    def _data(self) -> xr.Dataset:
        import xarray as xr

        name = self.parameter
        columns = {
            "orbit_period": (self.period, "forcing cycles per response period; 0 if not periodic"),
            "symmetric": (self.symmetric, "whether the response is symmetric"),
            "exponent": (self.exponent, "largest Lyapunov exponent per tau"),
            "exponent_error": (self.exponent_error, "error of the largest Lyapunov exponent per tau"),
            "rotation": (self.rotation, "rotation number: mean number of impacts per cycle"),
            "rotation_error": (self.rotation_error, "error of the rotation number"),
            "evidence": (self.evidence, "evidence of the verdict"),
            "level": ([verdict.evidence.level for verdict in self.verdicts], "level of the evidence"),
        }
        kinds = kinds_of(name, self.kind.tolist(), "type of the response")
        variables = {"kind": kinds} | along(name, columns)
        attributes = described("Response diagram") | {
            "parameter": name,
            "start_angle": self.start.angle,
            "start_velocity": self.start.velocity,
            "max_cycles": self.max_cycles,
            "max_period": self.max_period,
            **self.fixed,
        }
        return xr.Dataset(variables, {name: coordinate_of(name, name, self.values)}, attributes)

    def __str__(self) -> str:
        name, of, unit = SYSTEM_QUANTITIES[self.parameter].printed(self.block)
        values = of(self.values)
        span = f"{values[0]:.6g}{unit}"
        if len(values) > 1:
            span = f"{values[0]:.6g} to {values[-1]:.6g}{unit}, {len(values):,} values"
        start = f"Θ = {self.start.angle:.6g}, Θ' = {self.start.velocity:.6g}"
        counts = [(kind, int((self.kind == kind.value).sum())) for kind in Kind]
        result = ", ".join(
            f"{count:,} {kind}{self._periods() * (kind is Kind.PERIODIC)}" for kind, count in counts if count
        )
        return f"response diagram over {name} {span}, each from {start}: {result}"

    def _periods(self) -> str:
        values = np.unique(self.period[self.period > 0]).tolist()
        return f" (period{'s' * (len(values) > 1)} {', '.join(map(str, values))})"


MAX_VALUES = 100_000


def response_diagram(
    system: System,
    start: State | None = None,
    *,
    amplitude: ArrayLike | None = None,
    period: ArrayLike | None = None,
    frequency: ArrayLike | None = None,
    phase: ArrayLike | None = None,
    restitution: ArrayLike | None = None,
    brace_angle: ArrayLike | None = None,
    brace_restitution: ArrayLike | None = None,
    critical_angle: ArrayLike | None = None,
    max_cycles: int = 100_000,
    max_period: int = 64,
    progress: bool = False,
) -> ResponseDiagram:
    """Compute a response diagram: type of response, exponent and rotation number over the values of a parameter.

    Each value is classified by `classify`, from the same initial state. The exponent is that of the verdict. The rotation
    number is the mean number of impacts per forcing cycle. Where it is constant over an interval of the parameter, the
    response is locked to the forcing.

    Parameters
    ----------
    system : System
        Block, base motion and braces. The values of the parameter replace its own.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0 of each motion. Default: at rest.
    amplitude, period, frequency, phase, restitution, brace_angle, brace_restitution, critical_angle : float or array (n,)
        Exactly one of them, the varied parameter: a number, or values in any order, at most 100,000. Equal ones count once.
    max_cycles, max_period : int
        As in `classify`. Default: 100,000 and 64.
    progress : bool
        Whether to show the progress on stderr. Default: False.

    Returns
    -------
    ResponseDiagram
        Verdicts with their evidence, exponents and rotation numbers with their errors.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or the base motion is not periodic.
    ValueError
        If an argument, or one of the values, lies outside its range.

    See Also
    --------
    classify : Classify one response.
    orbit_diagram : Record section points over a parameter.
    parametric_map : Vary two quantities.
    rocking.plot.response_diagram : Plot the diagram.

    Notes
    -----
    The rotation number comes from

    - periodic: the orbit, as impacts per period over the period, without an error;
    - quasi-periodic: the weighted average of the times between impacts over 20,000 cycles, as in `rotation_number`. The error
      is the difference of the averages over both halves;
    - chaotic: the number of impacts in 20,000 cycles after 2,000, with a standard error;
    - at rest: 0.

    It is NaN if the block overturns, if the response is undetermined, or if infinitely many impacts precede rest. Half of it
    is the mean number of turns of (Θ, Θ') about the origin per forcing cycle.

    Limits: another initial state may lead to another response. Narrow intervals between two values are not found. The run whose
    impacts are counted rounds differently from `classify`, and may follow another chaotic transient.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=9.0, period=1.721328), restitution=0.8)
    >>> result = rk.response_diagram(system, amplitude=[10.2, 10.5, 10.7, 10.9])
    >>> result.kind.tolist(), result.period.tolist()
    (['periodic', 'periodic', 'periodic', 'overturned'], [1, 2, 4, 0])
    >>> result.rotation.tolist()
    [2.0, 2.0, 2.0, nan]
    """
    instance("system", system, System)
    instance("progress", progress, bool)
    parameter, ordered = varied_parameter(
        {
            "amplitude": amplitude,
            "period": period,
            "frequency": frequency,
            "phase": phase,
            "restitution": restitution,
            "brace_angle": brace_angle,
            "brace_restitution": brace_restitution,
            "critical_angle": critical_angle,
        },
        MAX_VALUES,
    )
    limits = budget(max_cycles, max_period)
    systems = [with_value(system, parameter, value) for value in ordered.tolist()]
    # A value that is refused is refused before the first verdict.
    for each in systems:
        check_periodic(each, start)
    start = State() if start is None else start

    def respond(each: System) -> tuple[Verdict, MeanImpacts]:
        verdict = classify(each, start, max_cycles, max_period)
        return verdict, mean_impacts(verdict)

    rows = []
    with ThreadPoolExecutor() as pool, Bar(len(systems), "response diagram", shown=progress) as bar:
        for pair in pool.map(respond, systems):
            rows.append(pair)
            bar.advance(1)
    verdicts, means = zip(*rows, strict=True)
    return ResponseDiagram(
        system=system,
        parameter=parameter,
        values=ordered,
        start=start,
        verdicts=verdicts,
        rotation=np.array([mean.value for mean in means]),
        rotation_error=np.array([mean.error for mean in means]),
        rotation_numbers=tuple(mean.rotation for mean in means),
        **limits,
    )
