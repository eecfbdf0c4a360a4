"""Diagrams over the values of a parameter, by simulation: section points after a transient, and types of response."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen
from numpy.typing import ArrayLike, NDArray

from rocking.kernels import system as numbers
from rocking.kernels.motion import march
from rocking.model.arrays import ReadOnlyArrays, nan_if_none, read_only
from rocking.model.progress import Bar
from rocking.model.quantity import PHASE, SYSTEM_QUANTITIES
from rocking.model.restitution import check_uniform
from rocking.model.result import Result, along, described
from rocking.model.system import State, System, check_periodic
from rocking.model.validation import TooManyEvents, instance, one_of, whole
from rocking.model.verdict import Kind, Verdict
from rocking.motion.march_loop import start_march
from rocking.orbits.parameter import coordinate_of, fixed_quantities, kinds_of, varied_parameter, with_value
from rocking.orbits.sweeps import SweepSpec, run_sweeps
from rocking.orbits.verdicts import verdicts_over
from rocking.response.classify import budget, mean_impacts
from rocking.response.rotation_number import RotationNumber
from rocking.survey.engine import Engine

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class Diagram(ReadOnlyArrays, Result):
    """What all diagrams share: a system of which one parameter is varied."""

    system: System
    parameter: str
    values: NDArray[np.float64] = field(repr=False, converter=read_only)

    @property
    def fixed(self) -> dict[str, float]:
        """Parameters that were not varied, by name."""
        return fixed_quantities(self.system, self.parameter)

    def _attributes(self, what: str, start: State, limits: dict[str, Any]) -> dict[str, Any]:
        """Return the attributes of the dataset: the parameter, the initial state, the limits, and what does not vary."""
        varied = {"parameter": self.parameter, "start_angle": start.angle, "start_velocity": start.velocity}
        return described(what) | varied | limits | self.fixed

    def _coordinate(self) -> dict[str, Any]:
        """Return the values of the parameter as a coordinate."""
        return {self.parameter: coordinate_of(self.parameter, self.parameter, self.values)}

    def _printed(self) -> tuple[str, np.ndarray, str]:
        """Return the parameter with the range of its values as text, the values in these units, and the unit."""
        name, of, unit = SYSTEM_QUANTITIES[self.parameter].printed(self.block)
        values = of(self.values)
        span = f"{values[0]:.6g}{unit}"
        if len(values) > 1:
            span = f"{values[0]:.6g} to {values[-1]:.6g}{unit}, {len(values):,} values"
        return f"{name} {span}", values, unit


PARAMETERS = (
    "amplitude",
    "period",
    "frequency",
    "phase",
    "restitution",
    "brace_angle",
    "brace_restitution",
    "critical_angle",
)


def _varied(
    system: System, progress: bool, most: int, *values: ArrayLike | None
) -> tuple[str, NDArray[np.float64]]:
    """Return the varied parameter and its values, ascending; the values are given in the order of `PARAMETERS`."""
    instance("system", system, System)
    instance("progress", progress, bool)
    return varied_parameter(dict(zip(PARAMETERS, values, strict=True)), most)


def _systems(system: System, start: State, parameter: str, values: np.ndarray) -> list[System]:
    """Return the system at each value; a value that does not take the start is refused before the first motion."""
    systems = [with_value(system, parameter, value) for value in values.tolist()]
    for each in systems:
        check_periodic(each, start)
    return systems


@frozen(eq=False)
class OrbitDiagram(Diagram):
    """Section points over the values of a parameter; returned by `orbit_diagram`.

    Attributes
    ----------
    system : System
        System of which one parameter is varied.
    parameter : str
        Name of the parameter.
    values : ndarray, shape (n,)
        Values of the parameter, ascending.
    sweeps : tuple of str
        "up", "down" or both, or "rest": the first axis of the following arrays.
    points : ndarray, shape (sweeps, n, m, 2)
        Θ and Θ' on the section in successive cycles; NaN if the block overturned.
    overturned : ndarray of bool, shape (sweeps, n)
        True if overturning is proved.
    peak : ndarray, shape (sweeps, n)
        Largest |Θ| over the m cycles after the transient; NaN if the block overturned.
    start : State
        Initial state of the first motion, or of each.
    transient : int
        Number of cycles discarded before.
    section_phase : float
        Forcing phase ψ of the section, rad.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> diagram = rk.orbit_diagram(system, amplitude=[1.5, 2.0], sweep="rest", cycles=4)
    >>> diagram.points.shape, bool(diagram.overturned.any())
    ((1, 2, 4, 2), False)
    """

    PLOT = "orbit_diagram"

    sweeps: tuple[str, ...]
    points: NDArray[np.float64] = field(repr=False, converter=read_only)
    overturned: NDArray[np.bool_] = field(repr=False, converter=read_only)
    peak: NDArray[np.float64] = field(repr=False, converter=read_only)
    start: State
    transient: int
    section_phase: float

    @property
    def cycles(self) -> int:
        """Number of points at each value."""
        return self.points.shape[2]

    def _data(self) -> xr.Dataset:
        import xarray as xr

        name = self.parameter
        sections = {
            "angle": (self.points[..., 0], "angle at the section"),
            "velocity": (self.points[..., 1], "angular velocity at the section"),
        }
        runs = {
            "peak": (self.peak, "largest magnitude of the angle after the transient"),
            "overturned": (self.overturned, "whether overturning is proved"),
        }
        variables = along(("sweep", name, "cycle"), sections) | along(("sweep", name), runs)
        coordinates = {
            **along("sweep", {"sweep": (self.sweeps, "order of the values")}),
            **self._coordinate(),
            "cycle": ("cycle", np.arange(self.cycles), {"long_name": "forcing cycles since the transient"}),
        }
        limits = {
            "transient": self.transient,
            "cycles": self.cycles,
            "section_phase": self.section_phase,
        }
        return xr.Dataset(variables, coordinates, self._attributes("Orbit diagram", self.start, limits))

    def _summary(self) -> xr.Dataset:
        return self._data().drop_dims("cycle")

    def __str__(self) -> str:
        span, values, unit = self._printed()
        overturnings = "; ".join(
            _overturnings(direction, fell, values, unit)
            for direction, fell in zip(self.sweeps, self.overturned, strict=True)
        )
        return f"orbit diagram over {span}, {self.cycles:,} points each after {self.transient:,} cycles: {overturnings}"


def _overturnings(direction: str, fell: np.ndarray, values: np.ndarray, unit: str) -> str:
    how = {"up": "swept up", "down": "swept down", "rest": "each from the initial state"}[direction]
    if not fell.any():
        return f"{how}, never overturned"
    result = values[fell]
    if len(result) == 1:
        return f"{how}, overturned at {result[0]:.6g}{unit}"
    return f"{how}, overturned at {len(result):,} (from {result[0]:.6g} to {result[-1]:.6g}{unit})"


SWEEPS = {"up": ("up",), "down": ("down",), "both": ("up", "down"), "rest": ("rest",)}
MAX_CYCLES = 1_000_000
# Two numbers per point: half a gibibyte.
MAX_POINTS = 2**25


def orbit_diagram(
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
    sweep: str = "both",
    transient: int = 300,
    cycles: int = 100,
    section_phase: float | None = None,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> OrbitDiagram:
    """Compute an orbit (bifurcation) diagram: section points after a transient, over the values of a parameter.

    In a sweep, the motion at each value begins at the final state of the previous value. A response is thus followed as long
    as it is stable, and upward and downward sweeps may follow different responses. Unstable orbits are never found; see
    `continue_orbit`.

    Parameters
    ----------
    system : System
        Block, base motion and braces. The values of the parameter replace its own.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0 of the first motion, or of each motion with ``sweep="rest"``. Default: at rest.
    amplitude, period, frequency, phase, restitution, brace_angle, brace_restitution, critical_angle : float or array (n,)
        Exactly one of them, the varied parameter: a number, or values in any order. Equal ones count once. A sweep follows them
        in ascending or descending order.
    sweep : {"both", "up", "down", "rest"}
        Direction of the sweep; "rest": no sweep, each motion begins at `start`. Default: "both".
    transient : int
        Number of forcing cycles discarded at each value, in [0, 10⁶]. Default: 300.
    cycles : int
        Number of points recorded at each value, at least 1, and at most 2²⁵ ≈ 3.4·10⁷ points in total. Default: 100.
    section_phase : float, optional
        Forcing phase ψ of the section, rad. Default: the phase φ of the forcing.
    store, executor, progress, repair
        As in `parametric_map`. The store holds one survey for each part of the values, a folder in it, and `cycles` is at most 10⁶
        then. A part of a sweep is one task of the executor, which begins after the part before it.

    Returns
    -------
    OrbitDiagram
        Section points of each sweep.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an argument, or one of the values, lies outside its range.
    TooManyEvents
        If there are more than 10⁷ events in one cycle.
    ImportError, OSError
        As in `parametric_map`, with a store.

    See Also
    --------
    continue_orbit : Follow orbits, stable or not.
    response_diagram : Classify the response at each value.
    parametric_map : Vary two quantities.
    rocking.plot.orbit_diagram : Plot the diagram.

    Notes
    -----
    After a motion that overturns, the next one begins at the same state. If braces move closer, a block beyond them is
    placed at the brace, with its velocity. With braces a transient can outlast any number of cycles. An undamped motion has
    no steady state.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=9.0, period=1.721328), restitution=0.8)
    >>> diagram = rk.orbit_diagram(system, amplitude=[10.0, 10.6, 10.9], sweep="up", cycles=8)
    >>> print(diagram)
    orbit diagram over amplitude 10 to 10.9, 3 values, 8 points each after 300 cycles: swept up, overturned at 10.9
    >>> [len(set(angles.round(6).tolist())) for angles in diagram.points[0, :2, :, 0]]
    [1, 2]
    """
    values = amplitude, period, frequency, phase, restitution, brace_angle, brace_restitution, critical_angle
    parameter, ordered = _varied(system, progress, MAX_POINTS, *values)
    start = State() if start is None else start
    sweep = one_of("sweep", sweep, tuple(SWEEPS))
    sweeps = SWEEPS[sweep]
    transient = whole("transient", transient, 0, MAX_CYCLES)
    most = max(MAX_POINTS // (len(sweeps) * len(ordered)), 1)
    cycles = whole("cycles", cycles, 1, most if store is None else min(most, MAX_CYCLES))
    section_phase = system.periodic.phase if section_phase is None else section_phase
    section_phase = PHASE.checked(section_phase, "section_phase")
    systems = _systems(system, start, parameter, ordered)
    if parameter == "restitution":
        check_uniform(system.restitution_table, "an orbit diagram over it")
    rows = np.array([numbers.row_of(start_march(each, start)[0]) for each in systems])
    orders = [slice(None, None, -1 if each == "down" else 1) for each in sweeps]
    request = SweepSpec(
        {},
        system=system,
        parameter=parameter,
        sweep=sweep,
        transient=transient,
        cycles=cycles,
        section_phase=section_phase,
        values=np.stack([ordered[order] for order in orders]),
        rows=np.stack([rows[order] for order in orders]),
        states=np.array([(start.angle, start.velocity)] * len(sweeps)),
    )
    with Bar(request.values.size, "orbit diagram", shown=progress) as bar:
        results = run_sweeps(request, store, executor, bar, repair=repair)
    points, peak, statuses = (
        np.stack([each[order] for each, order in zip(arrays, orders, strict=True)]) for arrays in results
    )
    if (statuses == march.CROWDED).any():
        value = ordered[(statuses == march.CROWDED).any(axis=0)][0]
        raise TooManyEvents(
            f"more than {march.MAX_EVENTS:,} events in one forcing cycle at {parameter} {value:.6g}: the block chatters "
            "with little energy loss (omit this value)"
        )
    return OrbitDiagram(
        system=system,
        parameter=parameter,
        values=ordered,
        sweeps=sweeps,
        points=points,
        overturned=statuses == march.OVERTURNED,
        peak=peak,
        start=start,
        transient=transient,
        section_phase=section_phase,
    )


@frozen(eq=False)
class ResponseDiagram(Diagram):
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
        limits = {"max_cycles": self.max_cycles, "max_period": self.max_period}
        attributes = self._attributes("Response diagram", self.start, limits)
        return xr.Dataset(variables, self._coordinate(), attributes)

    def __str__(self) -> str:
        span, *_ = self._printed()
        start = f"Θ = {self.start.angle:.6g}, Θ' = {self.start.velocity:.6g}"
        counts = [(kind, int((self.kind == kind.value).sum())) for kind in Kind]
        result = ", ".join(
            f"{count:,} {kind}{self._periods() * (kind is Kind.PERIODIC)}" for kind, count in counts if count
        )
        return f"response diagram over {span}, each from {start}: {result}"

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
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
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
    store, executor, progress, repair
        As in `parametric_map`, for the verdicts. The rotation numbers are computed anew.

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
    ImportError, OSError
        As in `parametric_map`, with a store.

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
    values = amplitude, period, frequency, phase, restitution, brace_angle, brace_restitution, critical_angle
    parameter, ordered = _varied(system, progress, MAX_VALUES, *values)
    limits = budget(max_cycles, max_period)
    start = State() if start is None else start
    _systems(system, start, parameter, ordered)
    verdicts = verdicts_over(
        system,
        start,
        parameter,
        ordered,
        max_cycles,
        max_period,
        store,
        executor,
        progress=progress,
        repair=repair,
    )
    means = []
    with ThreadPoolExecutor() as pool, Bar(len(verdicts), "rotation numbers", shown=progress) as bar:
        for mean in pool.map(mean_impacts, verdicts):
            means.append(mean)
            bar.advance(1)
    return ResponseDiagram(
        system=system,
        parameter=parameter,
        values=ordered,
        start=start,
        verdicts=tuple(verdicts),
        rotation=np.array([mean.value for mean in means]),
        rotation_error=np.array([mean.error for mean in means]),
        rotation_numbers=tuple(mean.rotation for mean in means),
        **limits,
    )
