"""Simulation of one block: exact march from event to event."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from rocking.kernels import system as numbers
from rocking.kernels.motion import finite_motion as ends
from rocking.kernels.motion import finite_motion as finite_runs
from rocking.kernels.motion import march
from rocking.kernels.motion import observers as event_rows
from rocking.model.forcing import Harmonic
from rocking.model.system import State, System, check_periodic, check_start
from rocking.model.validation import one_of, refuse_if, whole, within
from rocking.model.verdict import Overturning
from rocking.motion.march_loop import is_lossless, outcome_of, parameters, run, start_march, state_of
from rocking.motion.motion import Motion
from rocking.motion.trajectory import events_of
from rocking.motion.validity import check_contact

MAX_CYCLES = 1_000_000_000
MAX_SECTION_CYCLES = 100_000_000
DURATIONS = (1e-9, 1e9)
NO_ENDING = ends.Ending(march.DONE, 0, 0, 0, 0.0, math.nan, math.nan, True)
"""For a harmonic base motion, which has no end."""
NO_CYCLES = "be omitted for a base motion of finite length, which has no cycles"


def simulate(
    system: System,
    start: State | None = None,
    cycles: int | None = None,
    record: str = "all",
    *,
    duration: float | None = None,
) -> Motion:
    """Simulate a block over a number of forcing cycles, with exact arcs and certified events.

    Between events, the motion of a slender block is the closed form of Yim & Lin (1991), Eq. (5). That of a block with a
    critical angle is a Taylor series of order 20, whose truncation error is at rounding level. The first crossing of the base
    or of a brace is proved, not sampled. If overturning becomes certain, the simulation ends with that forcing cycle.

    Parameters
    ----------
    system : System
        Block, base motion and braces.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0. Default: at rest.
    cycles : int, optional
        Number of forcing cycles, in [1, 10⁹] (10⁸ with ``record="section"``). Default: 200. Omit it for a base motion of finite
        length.
    record : {"all", "section", "none"}
        Recorded data. Default: "all".

        - "all": every event, so that the state is known at any time;
        - "section": the state once per forcing cycle;
        - "none": only the counters, the peak and the final state. A sequence of impacts that provably ends in rest within
          the run is then cut short, so that the number of impacts is smaller.

    duration : float, optional
        Length of the run in τ, for a base motion of finite length. Default: until the block is at rest or overturned
        permanently. Without losses that may never come, and the default is the end of the base motion.

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
    ContactLost
        If the weight or the base reaction vanishes under vertical acceleration.

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
    count, cycle_length = _span(system, cycles, duration, record)
    p = parameters(system, cycle_length)
    ending = NO_ENDING
    if not isinstance(system.forcing, Harmonic):
        until = math.inf if duration is None else duration
        ending = finite_runs.run_to_end(p, start.angle, start.velocity, until)
        if ending.status == march.OVERTURNED and duration is None:
            count = march.OPEN
    progress, hit = march.begin_march(p, start.angle, start.velocity)
    first = _first_rows(progress, start, hit)
    status, progress, section, rows = run(p, progress, count, 0.0, record, want_peak=True)
    overturning = _overturning(status, progress, p)
    end = progress.cycle * p.clock.cycle_length
    if count == march.OPEN:
        end = max(end + progress.arc.start, system.forcing.span)
    motion = Motion(
        system=system,
        start=start,
        record=record,
        cycles=progress.cycle if isinstance(system.forcing, Harmonic) else 0,
        duration=end if overturning is None else min(end, overturning.time),
        final=State(*state_of(progress)),
        outcome=outcome_of(status),
        overturning=overturning,
        impacts=progress.impacts,
        brace_hits=progress.brace_hits,
        peak=progress.peak,
        margin=ending.margin,
        margin_time=ending.margin_time,
        certified=ending.decided,
        cycle_length=p.clock.cycle_length,
        section_rows=section,
        event_rows=np.concatenate([first, *rows]) if record == "all" else first[:0],
    )
    if system.vertical is not None:
        check_contact(motion if record == "all" else simulate(system, start, duration=duration))
    return motion


def _span(
    system: System, cycles: int | None, duration: float | None, record: str
) -> tuple[int, float | None]:
    """Return the number of cycles to march, and the length of each if the base motion is finite."""
    forcing = system.forcing
    if isinstance(forcing, Harmonic):
        refuse_if(
            duration is not None, "duration", "be given for a base motion of finite length only", duration
        )
        most = MAX_SECTION_CYCLES if record == "section" else MAX_CYCLES
        return whole("cycles", 200 if cycles is None else cycles, 1, most), None
    refuse_if(cycles is not None, "cycles", NO_CYCLES, cycles)
    refuse_if(record == "section", "record", "be 'all' or 'none', because a section needs a period", record)
    if duration is None and not is_lossless(system):
        return march.OPEN, None
    end = forcing.span if duration is None else within("duration", duration, *DURATIONS)
    count = max(1, math.ceil(end / (numbers.CYCLE * forcing.time_scale)))
    return count, end / count


def kept_events(
    system: System, start: State | None, cycles: int, keep: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray:
    """March as `simulate` does, and keep of the events after the start only what `keep` returns.

    `keep` is called with the events of each filled buffer, in the form of `Motion.events`, and returns an array. The arrays
    are concatenated. Errors are those of `simulate`.
    """
    start = check_periodic(system, start)
    cycles = whole("cycles", cycles, 1, MAX_CYCLES)
    period = system.periodic.period

    return np.concatenate(
        run(
            *start_march(system, start),
            cycles,
            0.0,
            "all",
            want_peak=False,
            keep=lambda rows: keep(events_of(system, rows, period, cycles * period)),
        )[3]
    )


def _first_rows(progress: Any, start: State, hit: bool) -> np.ndarray:
    rows = np.empty(2, event_rows.EVENT_ROW)
    return rows[: march.note_start(rows, progress, hit, start.velocity)]


def _overturning(status: int, progress: Any, p: numbers.SystemParameters) -> Overturning | None:
    if status != march.OVERTURNED:
        return None
    length = p.clock.cycle_length
    time = progress.cycle * length + progress.no_return
    return Overturning(time=time, cycle=int(time // length), impacts=progress.impacts)
