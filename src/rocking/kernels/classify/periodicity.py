"""Test whether a motion has reached a periodic orbit: candidates, Newton's method and the Floquet criterion."""

import math
from typing import NamedTuple

from rocking.kernels.classify.approach import departure
from rocking.kernels.classify.section import (
    apart,
    approached,
    closest_return,
    deviation_and_miss,
    evaluate_lazy_rows,
)
from rocking.kernels.contract import is_symmetric, largest_on, later, nearest_mode
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats2
from rocking.kernels.motion.march import UNKNOWN, Recording
from rocking.kernels.motion.tangent import Tangent
from rocking.kernels.numerics.elementary import logarithm, size
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.orbits.floquet import adapted_norm, length, spectral_radius
from rocking.kernels.orbits.modes import Nearest, orbit_of_mode
from rocking.kernels.orbits.return_map import (
    NEARBY,
    UNBOUNDED,
    FixedPoint,
    Guess,
    MapImage,
    Patience,
    ReturnMap,
    find_fixed_point,
    image_after,
)

# States of an orbit closer than this are equal.
SAME = 1e-9


# Candidates for Newton's method, in this order. REFINED repeats the search with the least period of the orbit
# found.
KNOWN, APPROACHED, CLOSEST, NO_MORE = range(4)
REFINED = -1
# From more distant returns Newton's method seldom finds the orbit that the motion approaches.
CLOSE = 0.01
# A symmetric mode replaces the limit of the returns if it is closer to it than this fraction of the remaining
# distance.
BESIDE = 0.5
# Minimum distance of a section from an event, in cycles. At an event sides, impacts and derivatives are
# ambiguous.
CLEARANCE = 1e-6
# Maximum deviation of a return from the multipliers' prediction, as a fraction of the predicted approach.
NONLINEAR = 0.2
# Near a bifurcation attraction is weak, and returns obey the multipliers alone only after 10**4 cycles or more. There
# they may deviate by BENT of the distance, if they approach by at least APPROACH of what the multipliers predict.
BENT, APPROACH = 0.01, 0.3
RETURNS = 3
MAX_FORETOLD = 1 << 20
# A motion closer than this to a neutral orbit is on it.
NEUTRAL = 1e-10
# A motion that passes an unstable orbit comes closer by this factor from checkpoint to checkpoint.
MUCH_NEARER = 0.5
# Distances below this are rounding.
ROUNDING = 1e-12
NOT_YET, REACHED, ON_EVENT = range(3)


@entry_point
def repetition(
    rows: Floats2, halves: Floats2, angle: float, velocity: float, lag: int, same: float
) -> tuple[int, bool]:
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


@kernel
def least_period(p, clocked, found, lag, workspace):
    """Return least period, mirror symmetry and image of an orbit that closes after ``lag`` cycles."""
    scratch, nothing = workspace.scratch, workspace.nothing
    guess = Guess(found.angle, found.velocity, found.image.waits)
    recording = Recording(0.5 * p.forcing.period, scratch, nothing.events, True, False)
    image = image_after(ReturnMap(clocked, lag, 0.0, 1.0), guess, recording, nothing.tangent)
    same = max(SAME, 100.0 * found.error)
    period, mirrored = repetition(scratch, scratch, found.angle, found.velocity, lag, same)
    return period, mirrored and is_symmetric(p), image


class PeriodicityCheck(NamedTuple):
    """Periodic orbit with which a motion was compared, and the result."""

    answer: int  # NOT_YET, REACHED, or ON_EVENT: the section must move
    period: int
    symmetric: bool
    found: FixedPoint
    peak: float  # NaN if it was not requested
    distance: float  # from the orbit, one period before the last return
    excess: float  # nonlinear terms over their limit, NaN if they were not needed (``approach``)
    coming: int  # predicted number of cycles until it may be reached; 0 if unknown
    work: int


@kernel
def loses(p, impacts, brace_hits):
    """Return whether a motion with the given numbers of impacts dissipates energy."""
    return (p.block.restitution < 1.0 and impacts > 0) or (p.block.brace_restitution < 1.0 and brace_hits > 0)


@kernel
def on_event(p, section, row):
    """Return whether an impact lies within CLEARANCE of a row of the section."""
    near = CLEARANCE * p.forcing.period
    angle = abs(section[row, 0])
    reach = near * abs(section[row, 1]) + near * near * (1.0 + p.forcing.amplitude)
    return angle <= reach or abs(angle - p.block.brace_angle) <= reach


class Candidate(NamedTuple):
    """Start of Newton's method: a state that returns approximately to itself after ``lag`` cycles."""

    lag: int  # 0 if there is none
    row: int  # of the section
    guess: Guess
    most_work: int  # maximum number of events to compute
    left: float  # estimated distance of the last state from the orbit; infinite if unknown
    mode: Nearest  # the symmetric mode that may be the limit


# A guess that the motion approaches has a residual below its distance from the motion.
no_further = replacing(Patience, "first")
measured = replacing(PeriodicityCheck, "distance", "excess")
with_shape = replacing(PeriodicityCheck, "period", "symmetric", "peak")
answered = replacing(PeriodicityCheck, "answer", "coming", "work")
with_work = replacing(PeriodicityCheck, "work")


@kernel
def known_candidate(p, clocked, orbit, run, section, since):
    """Return the candidate of the known orbit, found ``since`` cycles ago; none if the section is too short."""
    row = run.count - 1 - since % max(orbit.period, 1)
    lag = orbit.period if row >= orbit.period else 0
    evaluate_lazy_rows(p, section, row - RETURNS * lag, row + 1, run.section_time)
    return Candidate(
        lag, row, Guess(0.0, 0.0, UNKNOWN), UNBOUNDED, math.inf, nearest_mode(clocked, 0, 0.0, 0.0)
    )


@kernel
def approached_candidate(p, clocked, run, section, most_lag):
    """Return the limit of the last returns, or the symmetric mode close to it."""
    row = run.count - 1
    lag, angle, velocity = approached(p, section, run.count, run.section_time, most_lag)
    mode, waits = nearest_mode(clocked, lag, angle, velocity), UNKNOWN
    left = size(section[row, 0] - angle, section[row, 1] - velocity)
    if mode.distance <= max(BESIDE * left, SAME):
        angle, velocity, waits = mode.angle, mode.velocity, (mode.half - mode.since, mode.half)
    return Candidate(lag, row, Guess(angle, velocity, waits), UNBOUNDED, left, mode)


@kernel
def closest_candidate(p, run, section, most_lag, most_work, mode):
    """Return the closest return of the last state, if it is close enough; far from an orbit it needs much work."""
    row = run.count - 1
    evaluate_lazy_rows(p, section, row - RETURNS * most_lag, run.count, run.section_time)
    lag, away = closest_return(section, run.count, most_lag)
    guess = Guess(section[row, 0], section[row, 1], UNKNOWN)
    return Candidate(lag if away <= CLOSE else 0, row, guess, most_work, math.inf, mode)


@kernel
def propose(p, clocked, run, section, most_lag, most_work, candidate, trying):
    """Return the next candidate; the known one and the refined one stay as they are."""
    if trying == APPROACHED:
        return approached_candidate(p, clocked, run, section, most_lag)
    if trying == CLOSEST:
        return closest_candidate(p, run, section, most_lag, most_work, candidate.mode)
    return candidate


@kernel(inline=True)
def orbit_near(clocked, candidate, workspace):
    """Return the orbit that Newton's method finds from a candidate, as a check without a result yet."""
    lag, mode, symmetric, peak = candidate.lag, candidate.mode, False, math.nan
    found, guess = no_cycle(0).found, candidate.guess
    if lag == mode.order and guess.angle == mode.angle and guess.velocity == mode.velocity:
        found = orbit_of_mode(clocked, mode)
    if not found.converged:
        mapping, patience = ReturnMap(clocked, lag, 0.0, 1.0), no_further(NEARBY, max(candidate.left, SAME))
        found = find_fixed_point(
            mapping, guess, candidate.most_work, patience, workspace.trial, workspace.nothing
        )
    if lag == mode.order and size(found.angle - mode.angle, found.velocity - mode.velocity) <= SAME:
        symmetric, peak = True, largest_on(clocked, mode.arc, mode.half, 0.0)
    return PeriodicityCheck(NOT_YET, lag, symmetric, found, peak, math.nan, math.nan, 0, found.work)


@kernel
def compare_to_second_order(p, clocked, candidate, found, workspace):
    """Compare a motion with an orbit by ``compare``. If it may have reached the orbit, test its ``departure``.

    Returns
    -------
    tuple of (int, float, float, int, int)
        Answer, distance, excess, coming and work, as in ``PeriodicityCheck``.
    """
    section, row = workspace.section, candidate.row
    answer, away, coming = compare(p, section, row, candidate.lag, found)
    if answer != REACHED or away <= ROUNDING:
        return answer, away, math.nan, coming, 0
    mapping = ReturnMap(clocked, candidate.lag, 0.0, 1.0)
    excess, coming = departure(mapping, found, section, row, workspace.trial, workspace.nothing)
    work = 2 * (found.image.impacts + found.image.brace_hits)
    return (REACHED if excess <= 1.0 else NOT_YET), away, excess, coming, work


@kernel(inline=True)
def check_periodicity(p, run, workspace, most_lag, most_work, known, since, neutral):
    """Compare a motion with the periodic orbit that its last states approach.

    1. The first candidate is the ``known`` orbit, found ``since`` cycles ago; no other while the distance to it shrinks. If
       it is unstable, the distance must shrink by MUCH_NEARER, because orbits that branch off from it lie close to it.
    2. The second is the extrapolated limit of the returns, or the symmetric mode close to it.
    3. If there is no limit, the third is the closest return.

    A ``neutral`` orbit does not attract: the motion must be on it.
    """
    count, clocked = run.count, later(p, run.section_time)
    trying, orbit, seen, work = KNOWN, known, no_cycle(0), 0
    candidate = known_candidate(p, clocked, known, run, workspace.section, since)
    while trying < NO_MORE:
        candidate = propose(p, clocked, run, workspace.section, most_lag, most_work - work, candidate, trying)
        now, trying = trying, (NO_MORE if trying == REFINED else trying + 1)
        if candidate.lag == 0 or candidate.most_work <= 0:
            continue
        if now != KNOWN:
            orbit = orbit_near(clocked, candidate, workspace)
            work += orbit.work
            if not orbit.found.converged:
                continue
        answer, distance, excess, coming, compared = compare_to_second_order(
            p, clocked, candidate, orbit.found, workspace
        )
        work += compared
        orbit = measured(orbit, distance, excess)
        if answer != REACHED and not (neutral and distance <= NEUTRAL):
            coming = max(coming - (count - 1 - candidate.row), 0)
            enough = 1.0 if attracts(p, orbit.found.image) else MUCH_NEARER
            # a motion on another orbit stays as far away, but for rounding
            nearer = distance < enough * known.distance - ROUNDING
            if now == KNOWN and answer == NOT_YET and nearer:
                return answered(orbit, NOT_YET, coming, work)
            # An orbit found repeatedly at different places gives no prediction.
            coming = coming if now == APPROACHED and known.period == 0 else 0
            if now != KNOWN or answer == ON_EVENT:
                seen = answered(orbit, answer, coming, work)
            if answer == ON_EVENT or now == APPROACHED:
                break
            continue
        if orbit.symmetric:
            return answered(orbit, REACHED, 0, work)
        period, mirrored, whole = least_period(p, clocked, orbit.found, candidate.lag, workspace)
        work += whole.impacts + whole.brace_hits
        if period == candidate.lag:
            return answered(with_shape(orbit, period, mirrored, whole.peak), REACHED, 0, work)
        guess = Guess(orbit.found.angle, orbit.found.velocity, UNKNOWN)
        candidate = Candidate(period, candidate.row, guess, UNBOUNDED, math.inf, candidate.mode)
        trying = REFINED
    return with_work(seen, work)


@kernel
def constant_image(impacts, brace_hits):
    """Return an image that does not depend on the state: its derivative, and so both multipliers, are zero."""
    nothing = Tangent(0.0, 0.0, 0.0, 0.0)
    return MapImage(False, math.nan, math.nan, nothing, impacts, brace_hits, math.nan, UNKNOWN)


@kernel
def no_cycle(work):
    """Return the check that stands for no orbit."""
    nothing = FixedPoint(False, math.nan, math.nan, constant_image(-1, -1), math.nan, math.nan, 0)
    return PeriodicityCheck(NOT_YET, 0, False, nothing, math.nan, math.nan, math.nan, 0, work)


@kernel
def attracts(p, image):
    """Return whether an orbit is stable and dissipates energy.

    In undamped motion rounding alone may move both multipliers inside the unit circle.
    """
    return spectral_radius(image.tangent) < 1.0 and loses(p, image.impacts, image.brace_hits)


@kernel
def compare(p, section, row, period, found):
    """Compare the last returns with an orbit by the Floquet criterion.

    The orbit must be stable. Each of the last RETURNS returns must obey its multipliers and have the orbit's own impacts. It
    may deviate by NONLINEAR of the predicted approach, (1 - spectral radius) times the distance, or by BENT of the distance.
    One return may do so by chance, and the map may have kinks that only later returns meet. An orbit with rest or sustained
    contact is not tested here: its section need not resolve when they occur.

    The relative deviation of a return shrinks like the distance, by the larger multiplier per return. If the
    motion does not come closer, nothing is predicted.

    Returns
    -------
    tuple of (int, float, int)
        Answer, as in ``PeriodicityCheck``.
        Distance from the orbit one period before the row.
        Predicted number of cycles until the orbit may be reached, 0 if unknown.
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
    # Deviation of the returns because of the residual of the orbit itself.
    doubt = found.residual * (math.sqrt(norm[0]) + math.sqrt(norm[2]))
    for k in range(RETURNS):
        after = row - k * period
        before = after - period
        (x, y), (to_x, to_y) = deviation_and_miss(section, after, period, found)
        impacts, brace_hits = section[after, 2] - section[before, 2], section[after, 3] - section[before, 3]
        left = length(norm, x, y)
        off = (length(norm, to_x, to_y) - doubt) / (max(NONLINEAR * (1.0 - radius), BENT) * left)
        landed = length(norm, section[after, 0] - angle, section[after, 1] - velocity)
        comes = landed <= (1.0 - APPROACH * (1.0 - radius)) * left
        near = (comes and off <= 1.0) or size(x, y) <= ROUNDING
        if not near or impacts != image.impacts or brace_hits != image.brace_hits:
            more = logarithm(off) / -logarithm(radius) - 1.0 if k == 0 and off > 1.0 else -float(k)
            coming = period * math.ceil(min(RETURNS + more, MAX_FORETOLD))
            return NOT_YET, distance, coming if comes else 0
    return REACHED, distance, 0
