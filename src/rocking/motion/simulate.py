"""Simulate one block: march it through its events, exactly, keeping what is asked for."""

from __future__ import annotations

import math

import numpy as np

from rocking.kernels import events
from rocking.kernels import march as kernel
from rocking.kernels import parameters as numbers
from rocking.model import Outcome, Overturning, State, System, TooManyEvents, check_start, one_of, whole
from rocking.motion.motion import Motion

MOST_CYCLES = 1_000_000_000
MOST_SECTION_CYCLES = 100_000_000
MOST_RECORDED = 10_000_000
# The compiled march cannot be interrupted; it comes up for air after this many cycles.
BREATH = 100_000
NOTHING = np.empty((0, 2))


def parameters(system: System) -> numbers.HarmonicParameters:
    """Return a system as the kernels read it."""
    forcing, braces = system.forcing, system.braces
    return numbers.harmonic_parameters(
        forcing.amplitude,
        forcing.frequency,
        forcing.period,
        forcing.phase,
        system.restitution,
        math.inf if braces is None else braces.angle,
        1.0 if braces is None else braces.restitution,
    )


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

    Examples
    --------
    >>> system = System(Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> motion = simulate(system, cycles=100)
    >>> motion.impacts, str(motion.outcome)
    (199, 'bounded')
    """
    start = State() if start is None else start
    check_start(system, start)
    record = one_of("record", record, ("all", "section", "none"))
    cycles = whole("cycles", cycles, 1, MOST_SECTION_CYCLES if record == "section" else MOST_CYCLES)
    p = parameters(system)
    progress, hit = kernel.begin_march(p, start.angle, start.velocity)
    first = _first_rows(progress, start, hit)
    status, progress, section, rows = _run(p, progress, cycles, 0.0, record, want_peak=True)
    return Motion(
        system=system,
        start=start,
        record=record,
        cycles=progress.cycle,
        final=_state(progress),
        outcome=_outcome(status),
        overturning=_overturning(status, progress, system),
        impacts=progress.impacts,
        brace_hits=progress.brace_hits,
        peak=progress.peak,
        section_rows=section,
        event_rows=np.concatenate([first, *rows]) if record == "all" else first[:0],
    )


def section_of(motion: Motion, phase: float) -> np.ndarray:
    """Run a motion again for its section at another forcing phase."""
    forcing = motion.system.forcing
    time = math.fmod(phase - forcing.phase, 2.0 * math.pi) / forcing.frequency
    p = parameters(motion.system)
    progress, _ = kernel.begin_march(p, motion.start.angle, motion.start.velocity)
    return _run(p, progress, motion.cycles, time % forcing.period, "section", want_peak=False)[2]


def _run(p, progress, cycles, section_time, record, want_peak):  # type: ignore[no-untyped-def]
    """March to the end, in breaths: (status, progress, section, event rows)."""
    section = np.empty((cycles + 1 if record == "section" else 0, 2))
    events = np.empty((4096 if record == "all" else 0, 8))
    rows: list[np.ndarray] = []
    status, recorded, done = kernel.FULL, 0, 0
    while status == kernel.FULL or (status in (kernel.DONE, kernel.STILL) and progress.cycle < cycles):
        until = min(cycles, progress.cycle + BREATH)
        status, progress, taken, written = kernel.march(
            p, progress, until, section_time, section[done:], events, NOTHING, NOTHING[:, 0], want_peak
        )
        done += taken
        recorded += written
        rows.append(events[:written].copy())
        if status == kernel.CROWDED or recorded > MOST_RECORDED:
            raise TooManyEvents(_crowded(status, record))
        if status == kernel.FULL and len(events) < 1_000_000:
            events = np.empty((4 * len(events), 8))
    if record == "section" and section_time == 0.0 and status != kernel.OVERTURNED:
        section[done] = _state(progress).angle, _state(progress).velocity
        done += 1
    return status, progress, section[:done], rows


def _crowded(status: int, record: str) -> str:
    if status == kernel.CROWDED:
        return (
            f"more than {kernel.MOST_EVENTS:,} events in one forcing cycle: the block chatters almost without loss "
            "(start it faster, or take a smaller restitution)"
        )
    return f'more than {MOST_RECORDED:,} events to keep (run fewer cycles, or record="section" or "none")'


def _first_rows(progress, start: State, hit: bool) -> np.ndarray:  # type: ignore[no-untyped-def]
    """The arc that the motion begins with, after a hit on a brace where it starts with one."""
    row = np.empty((1, 8))
    kernel.note(row, 0, 0, progress.mode, progress.arc, events.BRACE if hit else events.NONE, start.velocity)
    return row


def _state(progress) -> State:  # type: ignore[no-untyped-def]
    arc = progress.arc
    return State(angle=arc.side * arc.angle + 0.0, velocity=arc.side * arc.velocity + 0.0)


def _outcome(status: int) -> Outcome:
    return {kernel.OVERTURNED: Outcome.OVERTURNED, kernel.STILL: Outcome.AT_REST}.get(status, Outcome.BOUNDED)


def _overturning(status: int, progress, system: System) -> Overturning | None:  # type: ignore[no-untyped-def]
    if status != kernel.OVERTURNED:
        return None
    time = progress.cycle * system.forcing.period + progress.no_return
    return Overturning(time=time, cycle=int(time // system.forcing.period) + 1, impacts=progress.impacts)
