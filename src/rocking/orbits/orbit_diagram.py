"""Orbit (bifurcation) diagrams by simulation: section points after a transient, over the values of a parameter."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from itertools import repeat
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from attrs import field, frozen
from numpy.typing import ArrayLike, NDArray

from rocking.kernels.forcing import parameters as numbers
from rocking.kernels.march import march, no_recording
from rocking.kernels.march import sweep as kernel
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.progress import Bar
from rocking.model.quantity import PHASE, SYSTEM_QUANTITIES
from rocking.model.result import Result, along, described
from rocking.model.system import State, System, check_constant_restitution, check_periodic
from rocking.model.validation import TooManyEvents, instance, one_of, whole
from rocking.motion.march_loop import start_march
from rocking.orbits.parameter import coordinate_of, fixed_quantities, varied_parameter, with_value

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class OrbitDiagram(ReadOnlyArrays, Result):
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

    system: System
    parameter: str
    values: NDArray[np.float64] = field(repr=False, converter=read_only)
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

    @property
    def fixed(self) -> dict[str, float]:
        """Parameters that were not varied, by name."""
        return fixed_quantities(self.system, self.parameter)

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
            name: coordinate_of(name, name, self.values),
            "cycle": ("cycle", np.arange(self.cycles), {"long_name": "forcing cycles since the transient"}),
        }
        attributes = described("Orbit diagram") | {
            "parameter": name,
            "start_angle": self.start.angle,
            "start_velocity": self.start.velocity,
            "transient": self.transient,
            "cycles": self.cycles,
            "section_phase": self.section_phase,
            **self.fixed,
        }
        return xr.Dataset(variables, coordinates, attributes)

    def _summary(self) -> xr.Dataset:
        return self._data().drop_dims("cycle")

    def __str__(self) -> str:
        name, of, unit = SYSTEM_QUANTITIES[self.parameter].printed(self.block)
        values = of(self.values)
        span = f"{values[0]:.6g}{unit}"
        if len(values) > 1:
            span = f"{values[0]:.6g} to {values[-1]:.6g}{unit}, {len(values):,} values"
        overturnings = "; ".join(
            _overturnings(direction, fell, values, unit)
            for direction, fell in zip(self.sweeps, self.overturned, strict=True)
        )
        return f"orbit diagram over {name} {span}, {self.cycles:,} points each after {self.transient:,} cycles: {overturnings}"


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
# Compiled code cannot be interrupted. It returns after this number of cycles, or after one value.
BREATH = 1_000_000


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
    progress: bool = False,
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
    progress : bool
        Whether to show the progress on stderr. Default: False.

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
        MAX_POINTS,
    )
    start = State() if start is None else start
    sweeps = SWEEPS[one_of("sweep", sweep, tuple(SWEEPS))]
    transient = whole("transient", transient, 0, MAX_CYCLES)
    cycles = whole("cycles", cycles, 1, max(MAX_POINTS // (len(sweeps) * len(ordered)), 1))
    section_phase = system.periodic.phase if section_phase is None else section_phase
    section_phase = PHASE.checked(section_phase, "section_phase")
    rows = np.array([_row(with_value(system, parameter, value), start) for value in ordered.tolist()])
    lanes = _lanes(rows, sweeps, cycles)
    total = len(ordered) * len(sweeps)
    with Bar(total, "orbit diagram", shown=progress) as bar:
        _run(lanes, start, "rest" not in sweeps, transient, section_phase, bar)
    points, peak, statuses = (
        np.stack([_ascending(lanes, sweep, name) for sweep in sweeps])
        for name in ("section", "peak", "statuses")
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


def _row(system: System, start: State) -> tuple[float, ...]:
    """Return the parameters of a system for the kernel, after checking that it can begin at `start`."""
    check_periodic(system, start)
    check_constant_restitution(system)
    return numbers.row_of(start_march(system, start)[0])


class _Lane(NamedTuple):
    """Systems in the order in which one thread processes them, with the output arrays."""

    sweep: str
    rows: NDArray[np.float64]
    section: NDArray[np.float64]
    peak: NDArray[np.float64]
    statuses: NDArray[np.int64]


def _lanes(rows: np.ndarray, sweeps: tuple[str, ...], cycles: int) -> list[_Lane]:
    """Return one lane for each sweep; independent motions are distributed among the processors."""
    if sweeps == ("rest",):
        parts = [("rest", part) for part in np.array_split(rows, min(os.cpu_count() or 1, len(rows)))]
    else:
        parts = [(sweep, np.ascontiguousarray(rows[:: -1 if sweep == "down" else 1])) for sweep in sweeps]
    return [
        _Lane(
            sweep, part, np.empty((len(part), cycles, 2)), np.empty(len(part)), np.empty(len(part), np.int64)
        )
        for sweep, part in parts
    ]


def _run(
    lanes: list[_Lane],
    start: State,
    carry: bool,
    transient: int,
    phase: float,
    bar: Bar,
) -> None:
    """Fill the lanes, one thread per lane, in batches short enough for Ctrl-C and progress reports."""
    nothing = no_recording.no_recording()
    kind = numbers.parameters_of_row(lanes[0].rows[0])
    batch = max(BREATH // (transient + lanes[0].section.shape[1]), 1)
    states = [(start.angle, start.velocity)] * len(lanes)

    def advance(lane: _Lane, state: tuple[float, float], done: slice) -> tuple[float, float]:
        out = lane.section[done], lane.peak[done], lane.statuses[done]
        return kernel.sweep(kind, lane.rows[done], *state, carry, transient, phase, *out, nothing)

    with ThreadPoolExecutor(len(lanes)) as pool:
        for first in range(0, max(len(lane.rows) for lane in lanes), batch):
            done = slice(first, first + batch)
            states = list(pool.map(advance, lanes, states, repeat(done)))
            bar.advance(sum(len(lane.rows[done]) for lane in lanes))


def _ascending(lanes: list[_Lane], sweep: str, name: str) -> np.ndarray:
    """Return one output of a sweep, over ascending values."""
    values = np.concatenate([getattr(lane, name) for lane in lanes if lane.sweep == sweep])
    return values[::-1] if sweep == "down" else values
