"""Orbit diagrams by brute force: what is left of a motion after a transient, one value of a parameter after another."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import repeat
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking.kernels.classify import workspace
from rocking.kernels.march import march
from rocking.kernels.march import sweep as kernel
from rocking.model import (
    MAX_PHASE,
    State,
    System,
    TooManyEvents,
    check_start,
    instance,
    one_of,
    reals,
    refusal,
    whole,
    within,
)
from rocking.motion import start_march
from rocking.orbits.orbit_diagram_result import OrbitDiagram
from rocking.orbits.parameter import PARAMETERS, with_value

SWEEPS = {"up": ("up",), "down": ("down",), "both": ("up", "down"), "rest": ("rest",)}
MAX_CYCLES = 1_000_000
# Two numbers each: half a gibibyte.
MAX_POINTS = 2**25
# Compiled code cannot be interrupted: it comes up for air after so many cycles, or one value.
BREATH = 1_000_000


def orbit_diagram(
    system: System,
    parameter: str,
    values: ArrayLike,
    start: State | None = None,
    sweep: str = "both",
    transient: int = 300,
    cycles: int = 100,
    section_phase: float | None = None,
    progress: Callable[[int], object] | None = None,
) -> OrbitDiagram:
    """Run a system at one value of a parameter after another, and keep the section points after a transient.

    Swept, the motion at each value begins where that at the value before has ended, so that a response is followed as
    long as it attracts; up and down may follow different ones. What attracts is found by this, never what repels: for
    that, see `continue_orbit`.

    Parameters
    ----------
    system : System
        The block, its forcing and its braces; the value of the parameter itself does not count.
    parameter : {"amplitude", "period", "frequency", "phase", "restitution", "brace_angle", "brace_restitution"}
        What is varied.
    values : array_like
        Its values, in any order.
    start : State, optional
        Θ and Θ' at τ = 0 of the first motion, or with ``sweep="rest"`` of each; at rest by default.
    sweep : {"both", "up", "down", "rest"}
        In which order, and whether the state is carried on.
    transient : int
        Forcing cycles left out at each value, 0 to 10⁶.
    cycles : int
        Points kept at each value, at least 1; 2²⁵ ≈ 3.4·10⁷ points in all at most.
    section_phase : float, optional
        Forcing phase ψ of the section, rad; by default that of the system's forcing.
    progress : callable, optional
        Called with the number of values done since it was called last.

    Returns
    -------
    OrbitDiagram

    Raises
    ------
    TypeError, ValueError
        In one line, for arguments of the wrong type or outside their range, the values among them.
    TooManyEvents
        More than 10⁷ events in a single cycle.

    See Also
    --------
    continue_orbit : Follow orbits, stable or not.
    parametric_map : Vary two quantities.
    rocking.plot.orbit_diagram : Plot the diagram.

    Notes
    -----
    A motion that overturns has no state to carry on: the next one begins where it began. Braces that come nearer push a block
    that stands beyond them back to them, at its speed. With braces a transient can outlast any number of cycles, and
    without losses all motion is transient.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=9.0, period=1.721328), restitution=0.8)
    >>> diagram = rk.orbit_diagram(system, "amplitude", [10.0, 10.6, 10.9], sweep="up", cycles=8)
    >>> print(diagram)
    orbit diagram over amplitude 10 to 10.9, 3 values, 8 points each after 300 cycles: swept up, overturned at 10.9
    >>> [len(set(angles.round(6).tolist())) for angles in diagram.points[0, :2, :, 0]]
    [1, 2]
    """
    instance("system", system, System)
    parameter = one_of("parameter", parameter, PARAMETERS)
    ordered = _values(values)
    start = State() if start is None else start
    ways = SWEEPS[one_of("sweep", sweep, tuple(SWEEPS))]
    transient = whole("transient", transient, 0, MAX_CYCLES)
    cycles = whole("cycles", cycles, 1, max(MAX_POINTS // (len(ways) * len(ordered)), 1))
    section_phase = system.forcing.phase if section_phase is None else section_phase
    section_phase = within("section_phase", section_phase, -MAX_PHASE, MAX_PHASE)
    rows = np.array([_row(with_value(system, parameter, value), start) for value in ordered.tolist()])
    lanes = _lanes(rows, ways, cycles)
    _run(lanes, start, "rest" not in ways, transient, section_phase, progress)
    points, peak, statuses = (
        np.stack([_ascending(lanes, way, name) for way in ways]) for name in ("section", "peak", "statuses")
    )
    if (statuses == march.CROWDED).any():
        value = ordered[(statuses == march.CROWDED).any(axis=0)][0]
        raise TooManyEvents(
            f"more than {march.MAX_EVENTS:,} events in one forcing cycle at {parameter} {value:.6g}: the block chatters "
            "almost without loss (leave that value out)"
        )
    return OrbitDiagram(
        system=system,
        parameter=parameter,
        values=ordered,
        sweeps=ways,
        points=points,
        overturned=statuses == march.OVERTURNED,
        peak=peak,
        start=start,
        transient=transient,
        section_phase=section_phase,
    )


def _values(values: ArrayLike) -> NDArray[np.float64]:
    ordered = np.unique(reals("values", values))
    if not 0 < len(ordered) <= MAX_POINTS or not np.isfinite(ordered).all():
        raise ValueError(refusal("values", f"be 1 to {MAX_POINTS:,} finite numbers", values))
    return ordered


def _row(system: System, start: State) -> tuple[float, ...]:
    """What the kernel needs of a system; refused if it cannot begin at `start`."""
    check_start(system, start)
    return start_march(system, start)[0][:7]


class _Lane(NamedTuple):
    """Systems in the order in which one thread takes them, and what comes out of them."""

    way: str
    rows: NDArray[np.float64]
    section: NDArray[np.float64]
    peak: NDArray[np.float64]
    statuses: NDArray[np.int64]


def _lanes(rows: np.ndarray, ways: tuple[str, ...], cycles: int) -> list[_Lane]:
    """One for each sweep; motions of their own share out among the processors."""
    if ways == ("rest",):
        parts = [("rest", part) for part in np.array_split(rows, min(os.cpu_count() or 1, len(rows)))]
    else:
        parts = [(way, np.ascontiguousarray(rows[:: -1 if way == "down" else 1])) for way in ways]
    return [
        _Lane(way, part, np.empty((len(part), cycles, 2)), np.empty(len(part)), np.empty(len(part), np.int64))
        for way, part in parts
    ]


def _run(
    lanes: list[_Lane],
    start: State,
    carry: bool,
    transient: int,
    phase: float,
    progress: Callable[[int], object] | None,
) -> None:
    """Fill the lanes, each in a thread, in batches so short that Ctrl-C and progress do not wait long."""
    nothing = workspace.no_recording()
    batch = max(BREATH // (transient + lanes[0].section.shape[1]), 1)
    states = [(start.angle, start.velocity)] * len(lanes)

    def advance(lane: _Lane, state: tuple[float, float], done: slice) -> tuple[float, float]:
        out = lane.section[done], lane.peak[done], lane.statuses[done]
        return kernel.sweep(lane.rows[done], *state, carry, transient, phase, *out, nothing)

    with ThreadPoolExecutor(len(lanes)) as pool:
        for first in range(0, max(len(lane.rows) for lane in lanes), batch):
            done = slice(first, first + batch)
            states = list(pool.map(advance, lanes, states, repeat(done)))
            if progress is not None:
                progress(sum(len(lane.rows[done]) for lane in lanes))


def _ascending(lanes: list[_Lane], way: str, name: str) -> np.ndarray:
    """One output of a sweep, over ascending values."""
    found = np.concatenate([getattr(lane, name) for lane in lanes if lane.way == way])
    return found[::-1] if way == "down" else found
