"""In which stretch of its arc does each lane's block come down? The order of signs at known points proves it.

At the ends of the stretches, and halfway, cos eta is known and e^t follows by multiplication, so that u = c+ e^t + c- e^-t + 1 +
beta cos eta costs no elementary function. The proof is that of ``arc.bracket``.
"""

from numba import njit

from rocking.kernels.arc.bracket import MARGIN
from rocking.kernels.arc.first_zero import MAX_ARC_TIME
from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.lanes.rows import (  # fmt: skip
    BRACKET,
    CLEARED,
    CONCAVE,
    CUT_PLACE,
    CUT_RATE,
    END,
    FAILED,
    GROWING,
    GUESS,
    HALF_DECAY,
    HALF_GROWTH,
    HALF_TANH,
    HIGH,
    LANES,
    LOW,
    MINIMUM,
    OUTSIDE,
    PER_Z,
    PERIOD,
    RESPONSE,
    SHRINKING,
    STAGE,
    TIME,
    TRIES,
    TURN_DECAY,
    TURN_GROWTH,
    Z,
    load,
    store,
)
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose


@njit(**SIMD_INLINE)
def may_dip(u, du, u_right, du_right, tanh):
    """``arc.bracket.may_dip`` on a part of a convex stretch, ``tanh`` of its length."""
    crossed = fma(u, du_right, -u_right * du)
    return (u + du < 0.0) & (du_right > u_right) & (crossed < tanh * fma(u, u_right, -du * du_right))


@njit(**SIMD_INLINE)
def stretch(grow, shrink, forcing, half_grow, half_decay, tanh, z, per_z, end, cleared):
    """Of a convex stretch: (u at its start, halfway and end; errors at start and end; whether no zero is there; or in a dip only)."""
    place, rate, response = forcing
    growing, shrinking = grow * z, shrink * per_z
    u, du = growing + shrinking + place, growing - shrinking - rate
    error = MARGIN * (abs(growing) + abs(shrinking) + 1.0)
    growing, shrinking = growing * half_grow, shrinking * half_decay
    u_half, du_half = growing + shrinking + 1.0 - response, growing - shrinking
    growing, shrinking = growing * half_grow, shrinking * half_decay
    u_right, du_right = growing + shrinking + place, growing - shrinking + rate
    error_right = error + MARGIN * (abs(growing) + abs(shrinking))
    for_ever = (growing > 0.0) & (growing - abs(shrinking) + 1.0 - response > error_right)
    passed = (u > error) & (u_half > error_right) & (u_right > error_right)
    passed = passed & (end < MAX_ARC_TIME) & (for_ever == False)  # noqa: E712
    doubt = may_dip(u, du, u_half, du_half, tanh) | may_dip(u_half, du_half, u_right, du_right, tanh)
    doubt = doubt & (cleared == 0.0)
    return u, u_half, u_right, error, error_right, passed & (doubt == False), passed & doubt  # noqa: E712


@njit(**SIMD_INLINE)
def next_sign_interval(s, i, end, z, per_z, cleared):
    """The convex stretch of lane i that begins at ``end``: what ``stretch`` says of it."""
    forcing = load(s, i, CUT_PLACE), load(s, i, CUT_RATE), load(s, i, RESPONSE)
    half_grow, half_decay, tanh = load(s, i, HALF_GROWTH), load(s, i, HALF_DECAY), load(s, i, HALF_TANH)
    grow, shrink = load(s, i, GROWING), load(s, i, SHRINKING)
    return stretch(grow, shrink, forcing, half_grow, half_decay, tanh, z, per_z, end, cleared)


@njit(**SIMD_INLINE)
def skip_clear_periods(s):
    """A turn of the forcing further, where certainly no zero lies in the next stretches."""
    for i in range(LANES):
        stage, low, cleared = load(s, i, STAGE), load(s, i, LOW), load(s, i, CLEARED)
        end, z, per_z = load(s, i, END), load(s, i, Z), load(s, i, PER_Z)
        outside, period = load(s, i, OUTSIDE), load(s, i, PERIOD)
        turn_growth, turn_decay = load(s, i, TURN_GROWTH), load(s, i, TURN_DECAY)
        passed = next_sign_interval(s, i, end, z, per_z, cleared)[5] & (stage == BRACKET)
        store(s, i, LOW, choose(passed, end + outside, low))
        store(s, i, CLEARED, choose(passed, 0.0, cleared))
        store(s, i, END, choose(passed, end + period, end))
        store(s, i, Z, choose(passed, z * turn_growth, z))
        store(s, i, PER_Z, choose(passed, per_z * turn_decay, per_z))


@njit(**SIMD_INLINE)
def walk(s):
    """The next convex stretch and the concave one before it: past them, or to the zero in one of them.

    ``skip_clear_periods`` before it does not look for the zero: most often only the last of two turns holds it.
    """
    for i in range(LANES):
        stage, low, end, z, per_z = (
            load(s, i, STAGE),
            load(s, i, LOW),
            load(s, i, END),
            load(s, i, Z),
            load(s, i, PER_Z),
        )
        cleared, concave, high = load(s, i, CLEARED), load(s, i, CONCAVE), load(s, i, HIGH)
        time, tries = load(s, i, TIME), load(s, i, TRIES)
        outside, period = load(s, i, OUTSIDE), load(s, i, PERIOD)
        turn_growth, turn_decay = load(s, i, TURN_GROWTH), load(s, i, TURN_DECAY)
        u, u_half, u_right, error, error_right, passed, looks = next_sign_interval(
            s, i, end, z, per_z, cleared
        )
        above, found_in = u > error, u < -error
        dips = above & (u_half < -error_right)
        found = found_in | dips | (above & (u_right < -error_right) & (u_half > error_right))
        next_stage = choose(found, GUESS, choose(passed, BRACKET, choose(looks, MINIMUM, FAILED)))
        halfway = fma(0.5, outside, end)
        next_high = choose(found_in, end, choose(dips, halfway, end + outside))
        next_low = choose(found_in, low, choose(passed, end + outside, end))
        walking = stage == BRACKET
        store(s, i, STAGE, choose(walking, next_stage, stage))
        store(s, i, CONCAVE, choose(walking, choose(found_in, 1.0, -1.0), concave))
        store(s, i, LOW, choose(walking, next_low, low))
        store(s, i, HIGH, choose(walking, next_high, high))
        store(s, i, TIME, choose(walking, halfway, time))
        store(s, i, TRIES, choose(walking, 0.0, tries))
        store(s, i, CLEARED, choose(walking, 0.0, cleared))
        passed = passed & walking
        store(s, i, END, choose(passed, end + period, end))
        store(s, i, Z, choose(passed, z * turn_growth, z))
        store(s, i, PER_Z, choose(passed, per_z * turn_decay, per_z))
