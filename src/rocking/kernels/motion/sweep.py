"""Sweep over systems: section and peak of each motion after a transient, and the initial state of the next."""

import math

from rocking.kernels.contract import with_row
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats1, Floats2, Floats3, Integers1
from rocking.kernels.motion.march import (
    CROWDED,
    DONE,
    OVERTURNED,
    UNKNOWN,
    NoRecording,
    Recording,
    begin,
    march_through,
)
from rocking.kernels.system import PeriodicParameters


@kernel
def march_state(p, angle, velocity, cycles, recording, tangent):
    """March a whole number of cycles from a state.

    Returns
    -------
    tuple of (int, float, float, float)
        Status, Theta, Theta' and peak at the end.
    """
    status, progress = march_through(p, begin(p, angle, velocity, UNKNOWN)[0], cycles, recording, tangent)
    arc = progress.arc
    return status, arc.side * arc.angle + 0.0, arc.side * arc.velocity + 0.0, progress.peak


@entry_point
def sweep(
    kind: PeriodicParameters,
    systems: Floats2,
    angle: float,
    velocity: float,
    carry: bool,
    transient: int,
    section_phase: float,
    section: Floats3,
    peaks: Floats1,
    statuses: Integers1,
    nothing: NoRecording,
) -> tuple[float, float]:
    """March through all ``systems`` (n, 8 or 11) in turn, and write sections, peaks and statuses.

    1. A row of ``systems`` is that of ``parameters_of_row``, of the type of ``kind``. Each system runs for ``transient``
       cycles, then for one cycle per row of its ``section`` (n, m, 2). The section is at the forcing phase ``section_phase``.
    2. Without ``carry`` each system starts at (angle, velocity). With it each but the first starts at the end state of the
       one before, or, if that overturned, at its initial state. The angle is clipped to the range between the braces.
    3. If a motion overturns or is crowded (``march.Status``, in ``statuses``), section and peak are NaN.

    Returns
    -------
    tuple of (float, float)
        Theta and Theta' at which a following system would start.
    """
    kept, passing = section.shape[1], Recording(0.0, nothing.section, nothing.events, False, False)
    for k in range(systems.shape[0]):
        p = with_row(kind, systems[k])
        time = (
            ((section_phase - p.forcing.phase) % (2.0 * math.pi))
            * p.forcing.per_frequency
            % p.clock.cycle_length
        )
        first = min(max(angle, -p.block.brace_angle), p.block.brace_angle)
        status, u, v = DONE, first, velocity
        if transient > 0:
            status, u, v, _ = march_state(p, first, velocity, transient, passing, nothing.tangent)
        if status not in (OVERTURNED, CROWDED):
            watched = Recording(time, section[k], nothing.events, True, False)
            status, u, v, peaks[k] = march_state(p, u, v, kept, watched, nothing.tangent)
        statuses[k] = status
        if status in (OVERTURNED, CROWDED):
            section[k] = math.nan
            peaks[k] = math.nan
        elif carry:
            angle, velocity = u, v
    return angle, velocity
