"""The impact section: the motion seen at its impacts, a map of phase and speed."""

from __future__ import annotations

import numpy as np

from rocking.model import State, System, refusal, whole
from rocking.motion import Motion, kept_events

IMPACT = np.dtype([("time", "f8"), ("cycle", "i8"), ("phase", "f8"), ("before", "f8"), ("after", "f8")])
DEFAULT_CYCLES = 1000


def impact_section(
    source: System | Motion, start: State | None = None, cycles: int | None = None, transient: int = 0
) -> np.ndarray:
    """Give the impacts at Θ = 0, in order: phase and velocity of each determine the next (eqs 2, 5 of Yim & Lin 1991).

    Beside the stroboscopic section, `Motion.section`, which has a point a cycle, this one has a point an impact. The map
    from each to the next is analytic where no impact grazes; the stroboscopic map is only continuous.

    Parameters
    ----------
    source : System or Motion
        A system, run here; or a motion recorded with ``record="all"``, whose impacts are read.
    start : State, optional
        Of a system: Θ and Θ' at τ = 0; at rest by default.
    cycles : int, optional
        Of a system: how many forcing cycles are run, 1 to 10⁹; 1,000 by default.
    transient : int
        How many of these cycles are left out at the beginning; at least one must stay.

    Returns
    -------
    structured ndarray
        One row an impact: time (τ), cycle (from 0), phase (ψ in [0, 2π)), and Θ' before and after. Empty where
        nothing strikes: at rest, or where only braces are hit. A block that overturns has those before the proof.

    Raises
    ------
    TypeError, ValueError
        For arguments of another kind or outside their range; `start` or `cycles` given with a motion; a motion that
        kept no events.
    TooManyEvents
        More than 10⁷ impacts to keep, or events in a single cycle.

    See Also
    --------
    simulate : ``record="section"`` gives the stroboscopic section.
    rocking.plot.impact_section : Plot the impacts.

    Notes
    -----
    Memory grows with the impacts kept (40 bytes each), not with cycles, brace hits or the transient. A system and a
    motion of it give the same impacts to the last bit. Hits on braces are no impacts.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> impacts = rk.impact_section(system, cycles=300, transient=298)
    >>> impacts["after"].round(6).tolist()  # mode (1, 1): ±V, half a cycle apart
    [-0.532017, 0.532017, -0.532017, 0.532017]
    """
    if isinstance(source, Motion):
        for name, value in (("start", start), ("cycles", cycles)):
            if value is not None:
                raise TypeError(refusal(name, "be left out with a motion, which has its own", value))
        transient = whole("transient", transient, 0, max(source.cycles - 1, 0))
        return _impacts(source.events, transient)
    if not isinstance(source, System):
        raise TypeError(refusal("source", "be a System or a Motion", source))
    cycles = DEFAULT_CYCLES if cycles is None else cycles
    transient = whole("transient", transient, 0, max(whole("cycles", cycles, 1, 10**9) - 1, 0))
    return kept_events(source, start, cycles, lambda events: _impacts(events, transient))


def _impacts(events: np.ndarray, transient: int) -> np.ndarray:
    """Of the events after a transient, the impacts at Θ = 0."""
    found = events[(events["kind"] == "impact") & (events["cycle"] >= transient)]
    impacts = np.empty(len(found), IMPACT)
    for name in IMPACT.names or ():
        impacts[name] = found[name]
    return impacts
