"""Simulation of one block: exact march from event to event."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from rocking.kernels.march import event_rows
from rocking.kernels.march import march as kernel
from rocking.model import Overturning, State, System, check_start, one_of, whole
from rocking.motion.event_table import events_of
from rocking.motion.march_loop import outcome_of, parameters, run, start_march, state_of
from rocking.motion.motion import Motion

MAX_CYCLES = 1_000_000_000
MAX_SECTION_CYCLES = 100_000_000


def simulate(system: System, start: State | None = None, cycles: int = 200, record: str = "all") -> Motion:
    """Simulate a block over a number of forcing cycles, with exact arcs and certified events.

    Between events, the motion is the closed form of Yim & Lin (1991), Eq. (5). The first crossing of the base or of a brace
    is proved, not sampled. If overturning becomes certain, the simulation ends with that forcing cycle.

    Parameters
    ----------
    system : System
        Block, base motion and braces.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0. Default: at rest.
    cycles : int
        Number of forcing cycles, in [1, 10⁹] (10⁸ with ``record="section"``). Default: 200.
    record : {"all", "section", "none"}
        Recorded data. Default: "all".

        - "all": every event, so that the state is known at any time;
        - "section": the state once per forcing cycle;
        - "none": only the counters, the peak and the final state. A sequence of impacts that provably ends in rest within
          the run is then cut short, so that the number of impacts is smaller.

    Returns
    -------
    Motion
        Simulated motion.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an argument lies outside its range.
    TooManyEvents
        If there are more than 10⁷ events to record, or more than 10⁷ events in one cycle.

    See Also
    --------
    classify : Classify the response instead of recording it.
    rocking.plot.overview : Plot what was recorded.
    rocking.plot.animation : Animate the motion.

    Notes
    -----
    `classify` and `parametric_map` may follow another chaotic transient of the same system and initial state. They stop at
    checkpoints, or advance many blocks simultaneously, and therefore round differently.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> motion = rk.simulate(system, cycles=100)
    >>> motion.impacts, str(motion.outcome)
    (199, 'bounded')
    """
    start = check_start(system, start)
    record = one_of("record", record, ("all", "section", "none"))
    cycles = whole("cycles", cycles, 1, MAX_SECTION_CYCLES if record == "section" else MAX_CYCLES)
    p = parameters(system)
    progress, hit = kernel.begin_march(p, start.angle, start.velocity)
    first = _first_rows(progress, start, hit)
    status, progress, section, rows = run(p, progress, cycles, 0.0, record, want_peak=True)
    return Motion(
        system=system,
        start=start,
        record=record,
        cycles=progress.cycle,
        final=State(*state_of(progress)),
        outcome=outcome_of(status),
        overturning=_overturning(status, progress, system),
        impacts=progress.impacts,
        brace_hits=progress.brace_hits,
        peak=progress.peak,
        section_rows=section,
        event_rows=np.concatenate([first, *rows]) if record == "all" else first[:0],
    )


def kept_events(
    system: System, start: State | None, cycles: int, keep: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray:
    """March as `simulate` does, and keep of the events after the start only what `keep` returns.

    `keep` is called with the events of each filled buffer, in the form of `Motion.events`, and returns an array. The arrays
    are concatenated. Errors are those of `simulate`.
    """
    start = check_start(system, start)
    cycles = whole("cycles", cycles, 1, MAX_CYCLES)
    duration = cycles * system.forcing.period

    return np.concatenate(
        run(
            *start_march(system, start),
            cycles,
            0.0,
            "all",
            want_peak=False,
            keep=lambda rows: keep(events_of(system, rows, duration)),
        )[3]
    )


def _first_rows(progress: Any, start: State, hit: bool) -> np.ndarray:
    rows = np.empty(2, event_rows.EVENT_ROW)
    return rows[: kernel.note_start(rows, progress, hit, start.velocity)]


def _overturning(status: int, progress: Any, system: System) -> Overturning | None:
    if status != kernel.OVERTURNED:
        return None
    time = progress.cycle * system.forcing.period + progress.no_return
    return Overturning(time=time, cycle=int(time // system.forcing.period), impacts=progress.impacts)
