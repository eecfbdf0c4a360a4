"""Whether a motion has reached a periodic orbit: what its returns point to, Newton's method from there, and the Floquet stop."""

import math
from typing import NamedTuple

from numba import njit

from rocking.kernels.arc.extrema import largest_on
from rocking.kernels.classify.recurrence import apart, approached, closest_return
from rocking.kernels.compile_options import AST_INLINE, ENTRY_POINT, INTERNAL
from rocking.kernels.march.march import UNKNOWN
from rocking.kernels.march.progress import Recording
from rocking.kernels.march.tangent import Tangent
from rocking.kernels.numerics.elementary import size
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.orbits.fixed_point import (
    NEARBY,
    UNBOUNDED,
    FixedPoint,
    Guess,
    MapImage,
    ReturnMap,
    find_fixed_point,
    image_after,
)
from rocking.kernels.orbits.floquet import adapted_norm, length, spectral_radius
from rocking.kernels.orbits.symmetric_mode import Nearest, nearest
from rocking.kernels.parameters import later

# Where Newton's method starts, in this order; and once more with the least period of what it found.
KNOWN, APPROACHED, CLOSEST, NO_MORE = range(4)
REFINED = -1
# From returns further apart Newton's method seldom finds what the motion approaches.
CLOSE = 0.01
# A symmetric mode is taken for the limit of the returns where it is nearer to that than this share of the way left.
BESIDE = 0.5
# A section must not lie on an event: sides, impacts and derivatives are ambiguous there. In cycles.
CLEARANCE = 1e-6
# How far a return may be from what the multipliers say, as a share of what is left of the distance.
NONLINEAR = 0.2
# Beside a bifurcation an orbit attracts weakly, and its returns obey the multipliers alone only after 10**4 cycles or more. They
# may bend by this share of all of the distance, if they come nearer by this share of what the multipliers promise: what is
# small of second order cannot turn that round on the rest of the way.
BENT, APPROACH = 0.01, 0.3
RETURNS = 3
MAX_FORETOLD = 1 << 20
# States of an orbit as near as this are one.
SAME = 1e-9
# A motion as near as this to a neutral orbit is on it.
NEUTRAL = 1e-10
# A motion that passes an orbit which repels comes this much nearer from look to look.
MUCH_NEARER = 0.5
# Distances below this are rounding.
ROUNDING = 1e-12

NOT_YET, REACHED, ON_EVENT = range(3)


class PeriodicityCheck(NamedTuple):
    """A periodic orbit that a motion was compared with."""

    answer: int  # NOT_YET, REACHED, or ON_EVENT: the section must move
    period: int
    symmetric: bool
    found: FixedPoint
    peak: float  # NaN where it was not asked for
    distance: float  # from the orbit, a period before the last return
    coming: int  # cycles until it may be reached, as far as that can be foretold; 0 where it cannot
    work: int


@njit(**INTERNAL)
def loses(p, impacts, brace_hits):
    """Whether so many events lose energy."""
    return (p.restitution < 1.0 and impacts > 0) or (p.brace_restitution < 1.0 and brace_hits > 0)


@njit(**INTERNAL)
def on_event(p, section, row):
    """Whether an impact or a brace hit lies within CLEARANCE of a row of the section."""
    near = CLEARANCE * p.period
    angle = abs(section[row, 0])
    reach = near * abs(section[row, 1]) + near * near * (1.0 + p.amplitude)
    return angle <= reach or abs(angle - p.brace_angle) <= reach


class Candidate(NamedTuple):
    """Where Newton's method starts: a state whose image after ``lag`` cycles is itself, about."""

    lag: int  # 0 where there is none
    row: int  # of the section
    guess: Guess
    most_work: int  # events that may be computed
    mode: Nearest  # the symmetric mode that may be the limit


answered = replacing(PeriodicityCheck, "answer", "distance", "coming", "work")
with_work = replacing(PeriodicityCheck, "work")


@njit(**INTERNAL)
def known_candidate(clocked, orbit, count, since):
    """Return the candidate of the known orbit, found ``since`` cycles ago; a section too short has none."""
    row = count - 1 - since % max(orbit.period, 1)
    lag = orbit.period if row >= orbit.period else 0
    return Candidate(lag, row, Guess(0.0, 0.0, UNKNOWN), UNBOUNDED, nearest(clocked, 0, 0.0, 0.0))


@njit(**INTERNAL)
def approached_candidate(clocked, section, count, most_lag):
    """Return the limit of the last returns, or the symmetric mode beside it."""
    row = count - 1
    lag, angle, velocity = approached(section, count, most_lag)
    mode, waits = nearest(clocked, lag, angle, velocity), UNKNOWN
    left = size(section[row, 0] - angle, section[row, 1] - velocity)
    if mode.distance <= max(BESIDE * left, SAME):
        angle, velocity, waits = mode.angle, mode.velocity, (mode.half - mode.since, mode.half)
    return Candidate(lag, row, Guess(angle, velocity, waits), UNBOUNDED, mode)


@njit(**INTERNAL)
def closest_candidate(section, count, most_lag, most_work, mode):
    """Return the closest return of the last state, if it is close. Only far from an orbit does Newton's method need much work."""
    row = count - 1
    lag, away = closest_return(section, count, most_lag)
    guess = Guess(section[row, 0], section[row, 1], UNKNOWN)
    return Candidate(lag if away <= CLOSE else 0, row, guess, most_work, mode)


@njit(**INTERNAL)
def propose(clocked, section, count, most_lag, most_work, candidate, trying):
    """Return the next candidate; the known one and the refined one stay as they are."""
    if trying == APPROACHED:
        return approached_candidate(clocked, section, count, most_lag)
    if trying == CLOSEST:
        return closest_candidate(section, count, most_lag, most_work, candidate.mode)
    return candidate


@njit(**INTERNAL)
def refined_candidate(candidate, found, period):
    """Return the fixed point that was found, over its least period."""
    guess = Guess(found.angle, found.velocity, UNKNOWN)
    return Candidate(period, candidate.row, guess, UNBOUNDED, candidate.mode)


@njit(**AST_INLINE)
def orbit_near(clocked, candidate, workspace):
    """Return the orbit that Newton's method finds from a candidate, as a check that is still to be made."""
    lag, mode, symmetric, peak = candidate.lag, candidate.mode, False, math.nan
    mapping = ReturnMap(clocked, lag, 0.0, 1.0)
    found = find_fixed_point(
        mapping, candidate.guess, candidate.most_work, NEARBY, workspace.trial, workspace.nothing
    )
    if lag == mode.order and size(found.angle - mode.angle, found.velocity - mode.velocity) <= SAME:
        symmetric, peak = True, largest_on(clocked, mode.arc, mode.half, 0.0)
    return PeriodicityCheck(NOT_YET, lag, symmetric, found, peak, math.nan, 0, found.work)


@njit(**AST_INLINE)
def check_periodicity(p, run, workspace, most_lag, most_work, known, since, neutral):
    """Compare a motion with the periodic orbit that its last states approach.

    First with the ``known`` one, found ``since`` cycles ago, and with no other while the motion comes nearer to
    it, much nearer if it repels: what was born of it lies beside it; then with the limit of the returns, or the
    symmetric mode beside it; then, if they have none, with what is nearest to a close return. A ``neutral`` orbit
    attracts nothing: the motion must be on it.
    """
    count, clocked = run.count, later(p, run.section_time)
    trying, orbit, seen, work = KNOWN, known, no_cycle(0), 0
    candidate = known_candidate(clocked, known, count, since)
    while trying < NO_MORE:
        candidate = propose(clocked, workspace.section, count, most_lag, most_work - work, candidate, trying)
        now, trying = trying, (NO_MORE if trying == REFINED else trying + 1)
        if candidate.lag == 0 or candidate.most_work <= 0:
            continue
        if now != KNOWN:
            orbit = orbit_near(clocked, candidate, workspace)
            work += orbit.work
            if not orbit.found.converged:
                continue
        answer, away, coming = compare(p, workspace.section, candidate.row, candidate.lag, orbit.found)
        if answer != REACHED and not (neutral and away <= NEUTRAL):
            coming = max(coming - (count - 1 - candidate.row), 0)
            nearer = away < known.distance * (1.0 if attracts(p, orbit.found.image) else MUCH_NEARER)
            if now == KNOWN and answer == NOT_YET and nearer:
                return answered(orbit, NOT_YET, away, coming, work)
            # Of what is found time and again somewhere else nothing is predicted.
            coming = coming if now == APPROACHED and known.period == 0 else 0
            if now != KNOWN or answer == ON_EVENT:
                seen = answered(orbit, answer, away, coming, work)
            if answer == ON_EVENT or now == APPROACHED:
                break
            continue
        if orbit.symmetric:
            return answered(orbit, REACHED, away, 0, work)
        period, mirrored, whole = least_period(p, clocked, orbit.found, candidate.lag, workspace)
        work += whole.impacts + whole.brace_hits
        if period == candidate.lag:
            return PeriodicityCheck(REACHED, period, mirrored, orbit.found, whole.peak, away, 0, work)
        candidate, trying = refined_candidate(candidate, orbit.found, period), REFINED
    return with_work(seen, work)


@njit(**INTERNAL)
def constant_image(impacts, brace_hits):
    """An image that does not depend on the state: its derivative, and so both multipliers, are zero."""
    nothing = Tangent(0.0, 0.0, 0.0, 0.0)
    return MapImage(False, math.nan, math.nan, nothing, impacts, brace_hits, math.nan, UNKNOWN)


@njit(**INTERNAL)
def no_cycle(work):
    """No orbit."""
    nothing = FixedPoint(False, math.nan, math.nan, constant_image(-1, -1), math.nan, math.nan, 0)
    return PeriodicityCheck(NOT_YET, 0, False, nothing, math.nan, math.nan, 0, work)


@njit(**INTERNAL)
def repetition(rows, halves, angle, velocity, lag, same):
    """(least period, whether it is its own mirror image half of that later) of an orbit of ``lag`` cycles through a state.

    ``rows`` are its states on any section, a cycle apart; ``halves`` those half a cycle after the state, and on. States as
    near as ``same`` are one.
    """
    period = lag
    for divisor in range(1, min(lag, rows.shape[0])):
        if lag % divisor == 0 and apart(rows, divisor, 0) <= same:
            period = divisor
            break
    half = (period - 1) // 2
    mirrored = period % 2 == 1 and size(halves[half, 0] + angle, halves[half, 1] + velocity) <= same
    return period, mirrored


@njit(**ENTRY_POINT)
def repetition_plain(rows, halves, angle, velocity, lag, same):
    """``repetition`` for Python."""
    return repetition(rows, halves, angle, velocity, lag, same)


@njit(**INTERNAL)
def attracts(p, image):
    """Whether an orbit is stable, and loses something: else both its multipliers may be inside the unit circle by rounding alone."""
    return spectral_radius(image.tangent) < 1.0 and loses(p, image.impacts, image.brace_hits)


@njit(**INTERNAL)
def least_period(p, clocked, found, lag, workspace):
    """Return (least period, whether the orbit is its own mirror image, its image) of an orbit that closes after ``lag`` cycles."""
    scratch, nothing = workspace.scratch, workspace.nothing
    guess = Guess(found.angle, found.velocity, found.image.waits)
    recording = Recording(0.5 * p.period, scratch, nothing.events, True, False)
    image = image_after(ReturnMap(clocked, lag, 0.0, 1.0), guess, recording, nothing.tangent)
    same = max(SAME, 100.0 * found.error)
    period, mirrored = repetition(scratch, scratch, found.angle, found.velocity, lag, same)
    return period, mirrored, image


@njit(**INTERNAL)
def compare(p, section, row, period, found):
    """(answer, distance from the orbit a period before the row, cycles until it may be reached, 0 where nobody knows): the Floquet stop.

    The orbit must be stable, and each of the last RETURNS returns what its multipliers say, up to a share of
    what is left (or of the distance, where they attract weakly), with the orbit's own impacts: one alone may do so by
    chance, and the map has kinks that only the next ones meet. An orbit that rests or leans in between is not judged
    here: its section need not resolve when.

    What a return is off by, as a share of the distance, shrinks like the distance itself, by the larger multiplier a return;
    of a motion that does not come nearer nothing is foretold.
    """
    angle, velocity, image = found.angle, found.velocity, found.image
    tangent = image.tangent
    radius = spectral_radius(tangent)
    distance = size(section[row - period, 0] - angle, section[row - period, 1] - velocity)
    if not 0.0 < radius < 1.0 or not loses(p, image.impacts, image.brace_hits) or row < RETURNS * period:
        return NOT_YET, distance, 0
    for k in range(period):
        if on_event(p, section, row - k):
            return ON_EVENT, distance, 0
    norm = adapted_norm(tangent, 0.5 * (1.0 + radius))
    # By so much returns are off because the orbit itself is.
    doubt = found.residual * (math.sqrt(norm[0]) + math.sqrt(norm[2]))
    for k in range(RETURNS):
        after = row - k * period
        before = after - period
        x, y = section[before, 0] - angle, section[before, 1] - velocity
        to_x = section[after, 0] - angle - (tangent.a * x + tangent.c * y)
        to_y = section[after, 1] - velocity - (tangent.b * x + tangent.d * y)
        impacts, brace_hits = section[after, 2] - section[before, 2], section[after, 3] - section[before, 3]
        left = length(norm, x, y)
        off = (length(norm, to_x, to_y) - doubt) / (max(NONLINEAR * (1.0 - radius), BENT) * left)
        landed = length(norm, section[after, 0] - angle, section[after, 1] - velocity)
        comes = landed <= (1.0 - APPROACH * (1.0 - radius)) * left
        near = (comes and off <= 1.0) or size(x, y) <= ROUNDING
        if not near or impacts != image.impacts or brace_hits != image.brace_hits:
            more = math.log(off) / -math.log(radius) - 1.0 if k == 0 and off > 1.0 else -float(k)
            coming = period * math.ceil(min(RETURNS + more, MAX_FORETOLD))
            return NOT_YET, distance, coming if comes else 0
    return REACHED, distance, 0
