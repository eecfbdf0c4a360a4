"""In which stretch of its arc does each lane's block come down? The order of signs at known points proves it.

At the ends of the stretches, and halfway, cos eta is known and e^t follows by multiplication, so that u = c+ e^t + c- e^-t + 1 +
beta cos eta costs no elementary function. The proof is that of ``walk``.
"""

from numba import njit

from .branchless import EXACT_INNER, choose
from .crossing import LONGEST
from .elementary import fma
from .lanes import (
    BOTTOM,
    CLEARED,
    CONCAVE,
    CUT_PLACE,
    CUT_RATE,
    DECAY_IN,
    DECAY_OUT,
    END,
    GROW_IN,
    GROW_OUT,
    GROWING,
    GUESS,
    HIGH,
    INSIDE,
    LANES,
    LOW,
    MIDDLE,
    MIDDLE_PER_Z,
    MIDDLE_Z,
    OUT_TANH_HALF,
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
    UNSURE,
    WALK,
    Z,
    of,
    put,
)  # fmt: skip
from .walk import MARGIN


@njit(**EXACT_INNER)
def may_dip(u, du, u_right, du_right, tanh):
    """``walk.may_dip`` on a part of a convex stretch, ``tanh`` of its length."""
    crossed = fma(u, du_right, -u_right * du)
    return (u + du < 0.0) & (du_right > u_right) & (crossed < tanh * fma(u, u_right, -du * du_right))


@njit(**EXACT_INNER)
def walk(s):
    """One convex stretch further, and the concave one before it: past them, or to the zero in one of them."""
    for i in range(LANES):
        stage, low, end, z, per_z = (
            of(s, i, STAGE),
            of(s, i, LOW),
            of(s, i, END),
            of(s, i, Z),
            of(s, i, PER_Z),
        )
        grow, shrink, cleared = of(s, i, GROWING), of(s, i, SHRINKING), of(s, i, CLEARED)
        place, rate, response = of(s, i, CUT_PLACE), of(s, i, CUT_RATE), of(s, i, RESPONSE)
        inside, outside, period = of(s, i, INSIDE), of(s, i, OUTSIDE), of(s, i, PERIOD)
        turn_growth, turn_decay = of(s, i, TURN_GROWTH), of(s, i, TURN_DECAY)
        grow_in, decay_in = of(s, i, GROW_IN), of(s, i, DECAY_IN)
        grow_out, decay_out = of(s, i, GROW_OUT), of(s, i, DECAY_OUT)
        concave, middle, high = of(s, i, CONCAVE), of(s, i, MIDDLE), of(s, i, HIGH)
        middle_z, middle_per_z = of(s, i, MIDDLE_Z), of(s, i, MIDDLE_PER_Z)
        time, tries = of(s, i, TIME), of(s, i, TRIES)
        tanh = of(s, i, OUT_TANH_HALF) * (1.0 + MARGIN)
        half_z, half_per_z = z * (grow_out * grow_out), per_z * (decay_out * decay_out)

        growing, shrinking = grow * z, shrink * per_z
        u, du = growing + shrinking + place, growing - shrinking - rate
        error = MARGIN * (abs(growing) + abs(shrinking) + 1.0)
        growing, shrinking = grow * half_z, shrink * half_per_z
        u_half, du_half = growing + shrinking + 1.0 - response, growing - shrinking
        growing, shrinking = growing * (grow_out * grow_out), shrinking * (decay_out * decay_out)
        u_right, du_right = growing + shrinking + place, growing - shrinking + rate
        error_right = error + MARGIN * (abs(growing) + abs(shrinking))
        for_ever = (growing > 0.0) & (growing - abs(shrinking) + 1.0 - response > error_right)

        walking, above = stage == WALK, u > error
        dips = above & (u_half < -error_right)
        found_in = walking & (u < -error)
        found_out = walking & (dips | (above & (u_right < -error_right) & (u_half > error_right)))
        found = found_in | found_out
        passed = walking & above & (u_half > error_right) & (u_right > error_right)
        passed = passed & (end < LONGEST) & (for_ever == False)  # noqa: E712
        doubt = may_dip(u, du, u_half, du_half, tanh) | may_dip(u_half, du_half, u_right, du_right, tanh)
        doubt = doubt & (cleared == 0.0)
        looks = passed & doubt
        on = passed & (cleared + choose(doubt, 0.0, 1.0) > 0.0)
        lost = choose(walking, UNSURE, stage)
        put(s, i, STAGE, choose(found, GUESS, choose(on, WALK, choose(looks, BOTTOM, lost))))
        put(s, i, CONCAVE, choose(found_in, 1.0, choose(found_out, -1.0, concave)))
        halfway_in, halfway_out = fma(-0.5, inside, end), fma(0.5, outside, end)
        put(s, i, MIDDLE, choose(found_in, halfway_in, choose(found_out, halfway_out, middle)))
        z_in, per_z_in = z * (decay_in * decay_in), per_z * (grow_in * grow_in)
        put(s, i, MIDDLE_Z, choose(found_in, z_in, choose(found_out, half_z, middle_z)))
        put(s, i, MIDDLE_PER_Z, choose(found_in, per_z_in, choose(found_out, half_per_z, middle_per_z)))
        right = choose(dips, halfway_out, end + outside)
        put(s, i, HIGH, choose(found_in, end, choose(found_out, right, choose(looks, end + outside, high))))
        put(s, i, LOW, choose(found_out | looks, end, choose(on, end + outside, low)))
        put(s, i, TIME, choose(looks, halfway_out, time))
        put(s, i, TRIES, choose(found | looks, 0.0, tries))
        put(s, i, CLEARED, choose(walking, 0.0, cleared))
        put(s, i, END, choose(on, end + period, end))
        put(s, i, Z, choose(on, z * turn_growth, z))
        put(s, i, PER_Z, choose(on, per_z * turn_decay, per_z))
