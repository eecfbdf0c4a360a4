"""Simulate one block: march it through its events, exactly, keeping what is asked for."""

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
    """Simulate a block from a start over whole forcing cycles, with exact, certified events.

    Between events the motion is the closed form (5) of Yim & Lin (1991); the first crossing of the base or
    of a brace is proved, not sampled. A motion that certainly never comes back ends with the cycle in which
    that is proved.

    Parameters
    ----------
    system : System
        The block, its forcing and its braces.
    start : State, optional
        Θ and Θ' at τ = 0; at rest by default.
    cycles : int
        How many forcing cycles to run, 1 to 10⁹ (10⁸ with ``record="section"``).
    record : {"all", "section", "none"}
        What to keep: every event, so that the motion is known at any time; the state once a cycle; or only
        the counters, the peak and the final state. With "none", impacts that certainly accumulate to rest
        within the run are cut short, so that their number is not infinite but smaller.

    Returns
    -------
    Motion

    Raises
    ------
    TypeError, ValueError
        In one line, for arguments of the wrong type or outside their range.
    TooManyEvents
        More than 10⁷ events to keep, or in a single cycle.

    See Also
    --------
    classify : Classify the response instead of recording it.
    rocking.plot.overview : Plot what was recorded.
    rocking.plot.animation : Animate the motion.

    Notes
    -----
    `classify` and `parametric_map` may follow another chaotic transient of the same system and start. They stop at checkpoints,
    or march many blocks at once, and therefore round differently.

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
    """March as `simulate` does, holding of the events after the start no more than `keep` makes of each breath's.

    `keep` is given events as `Motion.events` has them and returns an array; the arrays come back as one. Raises as
    `simulate` does.
    """
    start = check_start(system, start)
    cycles = whole("cycles", cycles, 1, MAX_CYCLES)
    duration = cycles * system.forcing.period

    def of_rows(rows: np.ndarray) -> np.ndarray:
        return keep(events_of(system, rows, duration))

    return np.concatenate(
        run(*start_march(system, start), cycles, 0.0, "all", want_peak=False, keep=of_rows)[3]
    )


def _first_rows(progress: Any, start: State, hit: bool) -> np.ndarray:
    rows = np.empty(2, event_rows.EVENT_ROW)
    return rows[: event_rows.note_start(rows, progress, hit, start.velocity)]


def _overturning(status: int, progress: Any, system: System) -> Overturning | None:
    if status != kernel.OVERTURNED:
        return None
    time = progress.cycle * system.forcing.period + progress.no_return
    return Overturning(time=time, cycle=int(time // system.forcing.period), impacts=progress.impacts)
