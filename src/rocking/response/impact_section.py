"""Impact section: forcing phase and velocity at each impact."""

from __future__ import annotations

import numpy as np

from rocking.model.system import State, System
from rocking.model.validation import WrongType, whole
from rocking.motion.motion import Motion
from rocking.motion.simulate import kept_events

IMPACT = np.dtype([("time", "f8"), ("cycle", "i8"), ("phase", "f8"), ("before", "f8"), ("after", "f8")])
DEFAULT_CYCLES = 1000


def impact_section(
    source: System | Motion, start: State | None = None, cycles: int | None = None, transient: int = 0
) -> np.ndarray:
    """Return the impacts at Θ = 0 in order, with forcing phase and velocities.

    The phase and velocity of an impact determine the next one: Yim & Lin (1991), Eqs. (2) and (5). The stroboscopic section,
    `Motion.section`, has one point per forcing cycle; the impact section has one point per impact. The map from each impact
    to the next is analytic unless an impact grazes. The stroboscopic map is only continuous.

    Parameters
    ----------
    source : System or Motion
        System to simulate, or a motion recorded with ``record="all"``.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0; only with a system. Default: at rest.
    cycles : int, optional
        Number of forcing cycles, in [1, 10⁹]; only with a system. Default: 1,000.
    transient : int
        Number of cycles discarded at the beginning; fewer than the number of cycles. Default: 0.

    Returns
    -------
    structured ndarray
        One row per impact, with the fields

        - `time`: τ;
        - `cycle`: forcing cycle, counted from 0;
        - `phase`: forcing phase ψ, rad, in [0, 2π);
        - `before`, `after`: Θ' just before and just after the impact.

        The array is empty at rest, or if only braces are hit. If the block overturns, it holds the impacts before
        overturning is certain.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or if `start` or `cycles` is given with a motion.
    ValueError
        If an argument lies outside its range, or if the motion recorded no events.
    TooManyEvents
        If there are more than 10⁷ impacts to record, or more than 10⁷ events in one cycle.

    See Also
    --------
    simulate : ``record="section"`` gives the stroboscopic section.
    rocking.plot.impact_section : Plot the impacts.

    Notes
    -----
    Memory grows with the recorded impacts (40 bytes each). It does not grow with cycles, brace impacts or the transient. A
    system and a simulated motion of it yield bit-identical impacts. Brace impacts are not included.

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
                raise WrongType(name, "be omitted with a motion", value)
        transient = whole("transient", transient, 0, max(source.cycles - 1, 0))
        return _impacts(source.events, transient)
    if not isinstance(source, System):
        raise WrongType("source", "be a System or a Motion", source)
    cycles = DEFAULT_CYCLES if cycles is None else cycles
    transient = whole("transient", transient, 0, max(whole("cycles", cycles, 1, 10**9) - 1, 0))
    return kept_events(source, start, cycles, lambda events: _impacts(events, transient))


def _impacts(events: np.ndarray, transient: int) -> np.ndarray:
    """Return the impacts at Θ = 0 among the events after a transient."""
    result = events[(events["kind"] == "impact") & (events["cycle"] >= transient)]
    impacts = np.empty(len(result), IMPACT)
    for name in IMPACT.names or ():
        impacts[name] = result[name]
    return impacts
