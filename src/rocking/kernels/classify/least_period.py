"""Least period and mirror symmetry of a periodic orbit that closes after a known number of cycles."""

from rocking.kernels.classify.recurrence import apart
from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.march.progress import Recording
from rocking.kernels.numerics.elementary import size
from rocking.kernels.orbits.fixed_point import Guess, ReturnMap, image_after
from rocking.kernels.signature import Floats2

# States of an orbit closer than this are equal.
SAME = 1e-9


@njit(**INTERNAL)
def repetition(rows, halves, angle, velocity, lag, same):
    """Return least period and mirror symmetry (bool) of an orbit of ``lag`` cycles through a state.

    ``rows`` are its states on any section, one cycle apart. ``halves`` are those from half a cycle after the
    state on. States closer than ``same`` are equal.
    """
    period = lag
    for divisor in range(1, min(lag, rows.shape[0])):
        if lag % divisor == 0 and apart(rows, divisor, 0) <= same:
            period = divisor
            break
    half = (period - 1) // 2
    mirrored = period % 2 == 1 and size(halves[half, 0] + angle, halves[half, 1] + velocity) <= same
    return period, mirrored


@entry_point(**KERNEL)
def repetition_plain(
    rows: Floats2, halves: Floats2, angle: float, velocity: float, lag: int, same: float
) -> tuple[int, bool]:
    """Return ``repetition``; entry point for Python."""
    return repetition(rows, halves, angle, velocity, lag, same)


@njit(**INTERNAL)
def least_period(p, clocked, found, lag, workspace):
    """Return least period, mirror symmetry and image of an orbit that closes after ``lag`` cycles."""
    scratch, nothing = workspace.scratch, workspace.nothing
    guess = Guess(found.angle, found.velocity, found.image.waits)
    recording = Recording(0.5 * p.forcing.period, scratch, nothing.events, True, False)
    image = image_after(ReturnMap(clocked, lag, 0.0, 1.0), guess, recording, nothing.tangent)
    same = max(SAME, 100.0 * found.error)
    period, mirrored = repetition(scratch, scratch, found.angle, found.velocity, lag, same)
    return period, mirrored, image
