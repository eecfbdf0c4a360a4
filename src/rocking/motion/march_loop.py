"""Parameters of a system for the kernels, and the loop that calls the compiled march with event buffers of limited size."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable
from threading import Lock
from typing import Any

import numpy as np

from rocking.kernels import system as numbers
from rocking.kernels.block.restrained import restrained_under_pulse, restrained_under_samples
from rocking.kernels.motion import march
from rocking.kernels.motion import observers as event_rows
from rocking.kernels.motion import tangent as differences
from rocking.kernels.restrainer import Restrainer, restrainer_of
from rocking.model.forcing import Harmonic, PiecewiseLinear, Pulse
from rocking.model.restitution import Scatter
from rocking.model.system import State, System, check_periodic
from rocking.model.validation import TooManyEvents
from rocking.model.verdict import Outcome

SMALL = 1e-8
"""Critical angle with which a slender block under vertical acceleration is followed by the full equation.

Up to |Θ| = 2 its sine and tangent are linear, and its cosine is 1, to 2e-16. So the equation is that of the slender block to rounding.
"""
MAX_TABLES, MAX_KEPT = 128, 400_000
"""Number of tables that are kept, one for the samples of a record at a step, and of their samples, which have 80 bytes each.

The last two are kept in any case: a block with unequal sides or with a restrainer has two.
"""
_tables: OrderedDict[tuple[int, float], tuple[np.ndarray, numbers.Tables]] = OrderedDict()
_lock = Lock()


def parameters(system: System, cycle_length: float | None = None) -> numbers.SystemParameters:
    """Return the parameters of a system for the kernels.

    For a base motion of finite length, `cycle_length` is that of the clock: any; by default a number of samples.
    """
    forcing, block = system.forcing, _block_of(system)
    if isinstance(forcing, Harmonic):
        wave = forcing.amplitude, forcing.frequency, forcing.period, forcing.phase
        return numbers.harmonic_system(block, *wave)
    if isinstance(forcing, Pulse):
        if forcing.cosine is not None:
            made = numbers.pulse_system(block, **_cosine_of(forcing, cycle_length))
            return restrained_under_pulse(made, _restrainer_of(system)) if system.is_restrained else made
        forcing = forcing.samples
    assert isinstance(forcing, PiecewiseLinear)
    length = numbers.CYCLE * forcing.step if cycle_length is None else cycle_length
    if system.vertical is not None:
        assert isinstance(block, numbers.FullBlock)
        vertical = system.vertical.scale * system.vertical.values
        return numbers.biaxial_system(block, tables_for(forcing), forcing.scale, vertical, length)
    free = under_samples(block, forcing, forcing.scale, length)
    if not system.is_restrained:
        return free
    own = _restrainer_of(system)
    return restrained_under_samples(free, own, tables_for(forcing, own.rate))


def _restrainer_of(system: System) -> Restrainer:
    assert system.critical_angle is not None
    return restrainer_of(system.critical_angle, system.stiffness_ratio, system.prestress_ratio)


def _block_of(system: System) -> numbers.Block:
    braces = (math.inf, 1.0) if system.braces is None else (system.braces.angle, system.braces.restitution)
    critical_angle = system.critical_angle
    if critical_angle is None:
        if system.vertical is None:
            return numbers.slender_block(system.restitution, *braces, left=_left_of(system))
        critical_angle = SMALL
    rows, unit, block = system.restitution_law, 1.0, system.block
    if block is not None and block.law.rows:  # with the rounding of surveys, whose speeds are in rad/s
        rows, unit = block.law.rows, float(block.radians_per_second(1.0))
    law = np.array(rows).reshape(-1, 2)
    largest = max([system.restitution, *law[:, 1].tolist()])
    scatter, left = scatter_of(system.restitution_scatter), _left_of(system)
    made = numbers.full_block(largest, critical_angle, *braces, law, left=left, scatter=scatter)
    return made._replace(speed_unit=unit)


def _left_of(system: System) -> numbers.LeftSide | None:
    """Return the left side of an unsymmetric block, or that of a wall."""
    if (left := system.left) is None:
        return None
    return numbers.LeftSide(left.angle_ratio, left.frequency_ratio, left.restitution)


def scatter_of(scatter: Scatter | None) -> numbers.Scatter:
    """Return the scatter of the restitution for the kernels."""
    if scatter is None:
        return numbers.NO_SCATTER
    return numbers.Scatter(scatter.deviation, scatter.shape == "uniform", scatter.stream(), 0.0)


def _cosine_of(pulse: Pulse, cycle_length: float | None) -> dict[str, Any]:
    """Return the numbers of a pulse that is a piece of a cosine; a negative amplitude turns the phase by π."""
    assert pulse.cosine is not None
    turns, phase = pulse.cosine
    return {
        "amplitude": abs(pulse.amplitude),
        "frequency": 2 * math.pi * turns / pulse.duration,
        "phase": phase if pulse.amplitude >= 0 else phase + math.pi,
        "duration": pulse.duration,
        "cycle_length": pulse.duration if cycle_length is None else cycle_length,
    }


def under_samples(
    block: numbers.Block, forcing: PiecewiseLinear, scale: float, length: float
) -> numbers.AnySampledParameters:
    """Return the parameters of a block without restrainers under the samples of a forcing at a scale; `length` is that of a cycle."""
    left_tables = None
    if isinstance(block, numbers.UnsymmetricBlock):
        left_tables = tables_for(forcing, block.left.rate)
    return numbers.sampled_system(block, tables_for(forcing), scale, length, left_tables)


def tables_for(forcing: PiecewiseLinear, rate: float = 1.0) -> numbers.Tables:
    """Return the tables of the samples of a forcing, its step multiplied by a rate, made once as long as they are kept."""
    key = id(forcing.values), forcing.step * rate
    with _lock:
        if key in _tables:
            _tables.move_to_end(key)
            return _tables[key][1]
    made = numbers.tables_of(forcing.values, forcing.step * rate)
    with _lock:
        _tables[key] = forcing.values, made  # the samples too, so that no others get their identity
        size = sum(values.size for values, _ in _tables.values())
        while len(_tables) > 2 and (size > MAX_KEPT or len(_tables) > MAX_TABLES):
            size -= _tables.popitem(last=False)[1][0].size
    return made


MAX_RECORDED = 10_000_000


def start_march(system: System, start: State) -> tuple[Any, Any]:
    """Return the parameters of a system for the kernels, and the block at its initial state, for `march_on`."""
    check_periodic(system, start)
    p = parameters(system)
    return p, march.begin_march(p, start.angle, start.velocity)[0]


def march_on(
    p: Any, progress: Any, cycles: int, columns: np.ndarray, growth: np.ndarray
) -> tuple[Outcome, Any]:
    """March to the end of cycle ``cycles`` together with two tangent vectors.

    Parameters
    ----------
    columns : ndarray, shape (2, 2)
        Orthonormal tangent vectors (δΘ, δΘ') as rows, updated in place and kept orthonormal. They become zero at rest and
        in sustained contact with a brace.
    growth : ndarray, shape (2,)
        Logarithms of the factors removed by orthonormalisation, added in place; −∞ where the vectors become zero.

    Returns
    -------
    tuple of (Outcome, Progress)
        Outcome and state of the march.
    """
    status, progress, _, _ = run(
        p, progress, cycles, 0.0, "none", want_peak=False, tangent=differences.TangentState(columns, growth)
    )
    return outcome_of(status), progress


def monodromy(system: System, start: State, cycles: int) -> np.ndarray:
    """Return the derivative (2, 2) of (Θ, Θ') after a number of forcing cycles by the initial state."""
    columns = np.eye(2)
    tangent = differences.TangentState(columns, np.empty(0))
    run(*start_march(system, start), cycles, 0.0, "none", want_peak=False, tangent=tangent)
    return columns.T


def run(
    p: Any,
    progress: Any,
    cycles: int,
    section_time: float,
    record: str,
    *,
    want_peak: bool,
    keep: Callable[[np.ndarray], np.ndarray] = np.copy,
    tangent: differences.TangentState = differences.NO_TANGENT,
) -> tuple[Any, ...]:
    """March to the end, calling the kernel again whenever its event buffer is full.

    Returns
    -------
    tuple
        Status; state of the march; section; list of the results of `keep` for the event rows of each call.
    """
    section = np.empty((cycles + 1 if record == "section" else 0, 2))
    events = np.empty(4096 if record == "all" else 0, event_rows.EVENT_ROW)
    kept: list[np.ndarray] = []
    status, recorded, done = march.PAUSED, 0, 0
    while status == march.PAUSED:
        recording = march.Recording(section_time, section[done:], events, want_peak)
        status, progress, taken, written = march.march(p, progress, cycles, recording, tangent)
        done += taken
        kept.append(keep(events[:written]))
        recorded += len(kept[-1])
        if status == march.CROWDED or recorded > MAX_RECORDED:
            raise TooManyEvents(_crowded(status))
        if status == march.PAUSED and 0 < len(events) < 1_000_000:
            events = np.empty(4 * len(events), event_rows.EVENT_ROW)
    if record == "section" and section_time == 0.0 and status != march.OVERTURNED:
        section[done] = state_of(progress)
        done += 1
    return status, progress, section[:done] + 0.0, kept  # no negative zeros


def _crowded(status: int) -> str:
    if status == march.CROWDED:
        return (
            f"more than {march.MAX_EVENTS:,} events without an end: the block chatters with little energy loss "
            "(reduce restitution)"
        )
    return (
        f'more than {MAX_RECORDED:,} events to record (run fewer cycles, or use record="section" or "none")'
    )


def section_of(system: System, start: State, cycles: int, phase: float) -> np.ndarray:
    """Return the section of a motion at another forcing phase, by simulating it again."""
    forcing = system.periodic
    time = math.fmod(phase - forcing.phase, 2.0 * math.pi) / forcing.frequency
    p = parameters(system)
    progress, _ = march.begin_march(p, start.angle, start.velocity)
    return run(p, progress, cycles, time % forcing.period, "section", want_peak=False)[2]


def is_lossless(system: System) -> bool:
    """Return whether the free motion after the base motion may never end: without losses at the base or at a brace."""
    return system.lossless or (system.braces is not None and system.braces.restitution == 1.0)


def state_of(progress: Any) -> tuple[float, float]:
    """Return Θ and Θ' of a march in progress."""
    arc = progress.arc
    return arc.side * arc.angle + 0.0, arc.side * arc.velocity + 0.0


def outcome_of(status: int) -> Outcome:
    """Return the outcome that corresponds to the final status of a march."""
    return {march.OVERTURNED: Outcome.OVERTURNED, march.STILL: Outcome.AT_REST}.get(status, Outcome.BOUNDED)
