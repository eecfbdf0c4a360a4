"""Return map over a number of forcing cycles, and its fixed points by Newton's method with the exact Jacobian.

The map is over whole periods, or over half of an odd number of them followed by reflection.
"""

import math
from typing import NamedTuple

from rocking.kernels.contract import later
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats2
from rocking.kernels.motion.march import DONE, UNKNOWN, NoRecording, Recording, begin, march_on
from rocking.kernels.motion.tangent import Tangent, TangentState, read_tangent, write_tangent
from rocking.kernels.numerics.elementary import size
from rocking.kernels.system import PeriodicParameters

RESIDUAL = 1e-12
# Near a fold Newton's method converges linearly: each step halves the error.
MAX_STEPS = 40
UNBOUNDED = 1 << 62


class Patience(NamedTuple):
    """Limits of Newton's method."""

    failures: int  # maximum number of steps that do not lower the residual by a tenth
    worse: float  # a step that raises the residual by more, overturns or leads out of reach is halved
    halvings: int  # maximum number of halvings of a step
    reach: float  # range of the velocity, and of the angle if no brace is nearer
    first: float  # maximum residual of the guess itself


# For a guess that a motion approaches, and for an arbitrary guess.
NEARBY = Patience(1, math.inf, 0, 10.0, math.inf)
ANYWHERE = Patience(MAX_STEPS, 2.0, 4, 1e3, math.inf)


class ReturnMap(NamedTuple):
    """Map from the state at ``start`` within the first cycle to ``sign`` times that at the end of ``cycles``."""

    p: PeriodicParameters
    cycles: int
    start: float
    sign: float  # -1 if the image is mirrored, else 1


class Guess(NamedTuple):
    """Initial state of a march; ``waits`` as for ``begin``."""

    angle: float
    velocity: float
    waits: tuple[float, float]


class MapImage(NamedTuple):
    """Image of a state under a return map, with its derivative."""

    certain: bool  # neither overturned nor stopped by too many events
    angle: float
    velocity: float
    tangent: Tangent
    impacts: int
    brace_hits: int
    peak: float
    waits: tuple[float, float]  # approximate times from the image to the first event, and on to the next


class FixedPoint(NamedTuple):
    """Fixed point, or the last state of a failed search."""

    converged: bool
    angle: float
    velocity: float
    image: MapImage
    residual: float
    error: float  # size of the next Newton correction
    work: int  # events computed


@kernel
def image_after(mapping, guess, recording, state):
    """Return the ``MapImage`` of a state, before any mirroring; ``state`` carries tangent vectors or none."""
    progress, _ = begin(mapping.p, guess.angle, guess.velocity, guess.waits, mapping.start)
    if state.columns.shape[0] > 0:
        write_tangent(state.columns, Tangent(1.0, 0.0, 0.0, 1.0))
    status, progress, _, _ = march_on(mapping.p, progress, mapping.cycles, recording, state)
    arc = progress.arc
    tangent = read_tangent(state.columns) if state.columns.shape[0] > 0 else Tangent(0.0, 0.0, 0.0, 0.0)
    return MapImage(
        status == DONE,
        arc.side * arc.angle,
        arc.side * arc.velocity,
        tangent,
        progress.impacts,
        progress.brace_hits,
        progress.peak,
        (progress.wait_before, progress.last_wait),
    )


class Trial(NamedTuple):
    """Trial state of Newton's method, its image, the difference of the two, and the number of events computed."""

    accepted: bool
    guess: Guess
    image: MapImage
    missed: tuple[float, float]
    work: int


@kernel
def line_search(mapping, at, to, residual, patience, recording, state):
    """Try a Newton step ``to`` from a state, then halve it until the residual is small enough."""
    angle, velocity, waits, work, accepted = to[0], to[1], at.waits, 0, False
    reach, nowhere = min(mapping.p.block.brace_angle, patience.reach), Tangent(0.0, 0.0, 0.0, 0.0)
    guess, missed = at, (math.inf, math.inf)
    image = MapImage(False, math.nan, math.nan, nowhere, 0, 0, math.nan, waits)
    for _ in range(patience.halvings + 1):
        guess = Guess(at.angle + angle, at.velocity + velocity, waits)
        inside = abs(guess.angle) <= reach and abs(guess.velocity) <= patience.reach
        if inside or residual == math.inf:
            image = image_after(mapping, guess, recording, state)
            waits = image.waits
            work += image.impacts + image.brace_hits
            missed = mapping.sign * image.angle - guess.angle, mapping.sign * image.velocity - guess.velocity
            accepted = image.certain and max(abs(missed[0]), abs(missed[1])) <= patience.worse * residual
        if accepted:
            break
        angle, velocity = 0.5 * angle, 0.5 * velocity
    return Trial(accepted, Guess(guess.angle, guess.velocity, waits), image, missed, work)


@kernel(inline=True)
def newton_correction(tangent, sign, missed):
    """Return the Newton step from a state whose image minus the state is ``missed``.

    Returns
    -------
    tuple of (tuple of (float, float), float)
        Corrections of angle and velocity.
        Residual below which the method has converged.
    """
    a, b, c, d = sign * tangent.a, sign * tangent.b, sign * tangent.c, sign * tangent.d
    # (I - J)^-1 (P(x) - x), with J = [[a, c], [b, d]]
    determinant = (1.0 - a) * (1.0 - d) - b * c
    to_angle = ((1.0 - d) * missed[0] + c * missed[1]) / determinant
    to_velocity = (b * missed[0] + (1.0 - a) * missed[1]) / determinant
    return (to_angle, to_velocity), RESIDUAL * max(1.0, abs(a), abs(b), abs(c), abs(d))


@kernel(inline=True)
def find_fixed_point(mapping, guess, most_work, patience, columns, nothing):
    """Find a fixed point of a map by Newton's method, until the residual is at most RESIDUAL.

    The tolerance is multiplied by the largest entry of the Jacobian if that exceeds 1. If no fixed point is
    found, the state is the last one accepted.
    """
    recording = Recording(0.0, nothing.section, nothing.events, False, False)
    state, at, to = TangentState(columns, nothing.tangent.growth), guess, (0.0, 0.0)
    work, failures, converged, residual, best, error = 0, 0, False, math.inf, math.inf, math.inf
    for _ in range(MAX_STEPS + 1):
        trial = line_search(mapping, at, to, residual, patience, recording, state)
        work += trial.work
        if not trial.accepted:
            break
        at = trial.guess
        residual = max(abs(trial.missed[0]), abs(trial.missed[1]))
        to, enough = newton_correction(trial.image.tangent, mapping.sign, trial.missed)
        converged = residual <= enough
        failures += not residual < 0.9 * best
        best = min(best, residual)
        error = size(to[0], to[1])
        lost = (
            failures > patience.failures or work > most_work or not error < math.inf or best > patience.first
        )
        if converged or lost:
            break
    return FixedPoint(converged, at.angle, at.velocity, trial.image, residual, error, work)


@kernel
def return_map(p, period, mirrored):
    """Return the ``ReturnMap`` over ``period`` cycles, or over half an odd number of them and mirrored.

    The half cycle comes first: the march ends only with a whole one, and p.forcing.period stays that of the forcing.
    """
    if not mirrored:
        return ReturnMap(p, period, 0.0, 1.0)
    half = 0.5 * p.forcing.period
    return ReturnMap(later(p, -half), (period + 1) // 2, half, -1.0)


@entry_point
def newton_from_starts(
    p: PeriodicParameters,
    period: int,
    mirrored: bool,
    starts: Floats2,
    nothing: NoRecording,
    columns: Floats2,
    out: Floats2,
) -> int:
    """Search for fixed points of ``return_map`` by Newton's method from every initial state.

    ``out`` (n, 4) takes (found, angle, velocity, residual). Initial states beyond a brace are skipped.
    Returns the number of fixed points found.
    """
    mapping, count = return_map(p, period, mirrored), 0
    for i in range(starts.shape[0]):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = False, starts[i, 0], starts[i, 1], math.inf
        if abs(starts[i, 0]) > p.block.brace_angle:
            continue
        guess = Guess(starts[i, 0], starts[i, 1], UNKNOWN)
        found = find_fixed_point(mapping, guess, UNBOUNDED, ANYWHERE, columns, nothing)
        out[i, 0], out[i, 1] = found.converged, found.angle
        out[i, 2], out[i, 3] = found.velocity, found.residual
        count += found.converged
    return count
