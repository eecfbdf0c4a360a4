"""The impact that ends each lane's arc, eq. (2), the arc that begins with it, and whether anything about it is not plain."""

import math

import numpy as np
from numba import njit

from rocking.kernels.arc.fast_path import I2, I4, I6, I8
from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.lanes.rows import (  # fmt: skip
    AMPLITUDE,
    AT_EVENT,
    BRACKET,
    COSINE,
    COUNTED,
    CREST_CURVATURE,
    CUT,
    CUT_LEFT,
    CUT_RIGHT,
    CYCLE,
    DEEP,
    DELTA_ANGLE,
    DELTA_VELOCITY,
    DOUBLINGS,
    END,
    END_LEG,
    EVENTS,
    EXCEEDS,
    FAILED,
    FIND_EVENT,
    FLUSH_LOG,
    FREQUENCY_SQUARE,
    GROWING,
    INSIDE,
    LANES,
    LARGE,
    LATE,
    LOG_ON,
    LOW,
    NEW_ARC,
    NEXT_COSINE,
    NEXT_SINE,
    NEXT_SINH,
    NEXT_VERSINH,
    NO_REQUEST,
    PEAK,
    PER_PERIOD,
    PER_Z,
    PERIOD,
    REQUEST,
    RESPONSE,
    RESPONSE_RATE,
    RESTITUTION,
    SHRINKING,
    SIDE,
    SINE,
    SLOWEST,
    SPEED,
    STAGE,
    START,
    TARGET,
    TO_SCALAR,
    TWICE,
    UPDATE_PEAK,
    VELOCITY,
    WAIT,
    Z,
    load,
    store,
    trail_is_full,
)
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import ROUGHLY, both_exponentials, choose, logarithms_of_ratios

# c+ and c- below this tell a crest and its time well enough.
TOLD = -1e-5
RIGHT_ANGLE = 0.5 * math.pi


@njit(**SIMD_INLINE)
def set_request(s, i, wants, returned):
    """Whether lane i wants anything before its event, which gives back the speed ``returned``: what that ``wants``, or what comes first."""
    stage, start, wait, cycle = load(s, i, STAGE), load(s, i, START), load(s, i, WAIT), load(s, i, CYCLE)
    target, period = load(s, i, TARGET), load(s, i, PERIOD)
    full = trail_is_full(load(s, i, LOG_ON), load(s, i, EVENTS), load(s, i, COUNTED))
    wants = choose(full, FLUSH_LOG, wants)
    wants = choose(returned < SLOWEST, TO_SCALAR, wants)
    wants = choose(start + wait > (target - cycle) * period, END_LEG, wants)
    wants = choose(stage == AT_EVENT, wants, choose(stage == FAILED, FIND_EVENT, NO_REQUEST))
    store(s, i, REQUEST, wants)
    return wants != NO_REQUEST


@njit(**SIMD_INLINE)
def set_requests(s):
    """What each lane wants before its impact; whether any wants anything."""
    any_wants = False
    for i in range(LANES):
        wants = choose(load(s, i, EXCEEDS) == 0.0, NO_REQUEST, UPDATE_PEAK)
        any_wants |= set_request(s, i, wants, load(s, i, RESTITUTION) * load(s, i, SPEED))
    return any_wants


@njit(**SIMD_INLINE)
def saltation_shear(s, i):
    """Of an impact in lane i the shear times the speed, as ``tangent.event_map`` has it."""
    restitution, next_cosine = load(s, i, RESTITUTION), load(s, i, NEXT_COSINE)
    return fma((1.0 - restitution) * load(s, i, AMPLITUDE), next_cosine, -(1.0 + restitution))


@njit(**SIMD_INLINE)
def propagate_tangent(s, i, factor, shear):
    """What an event, [[factor, 0], [shear, factor]], makes of the difference in lane i, where that has arrived."""
    stage, across, along, doublings = (
        load(s, i, STAGE),
        load(s, i, DELTA_ANGLE),
        load(s, i, DELTA_VELOCITY),
        load(s, i, DOUBLINGS),
    )
    sinh, cosh, events = load(s, i, NEXT_SINH), 1.0 + load(s, i, NEXT_VERSINH), load(s, i, EVENTS)
    a, b = fma(cosh, across, sinh * along), fma(sinh, across, cosh * along)
    a, b = factor * a, fma(shear, a, factor * b)
    size = abs(a) + abs(b)
    large, little = size > LARGE, size < 1.0 / LARGE
    scale = choose(large, 1.0 / LARGE, choose(little, LARGE, 1.0))
    times = choose(large, 64.0, choose(little, -64.0, 0.0))
    arrived = stage == AT_EVENT
    store(s, i, DELTA_ANGLE, choose(arrived, a * scale, across))
    store(s, i, DELTA_VELOCITY, choose(arrived, b * scale, along))
    store(s, i, DOUBLINGS, choose(arrived, doublings + times, doublings))
    store(s, i, EVENTS, choose(arrived, events + 1.0, events))


@njit(**SIMD_INLINE)
def turn_clock(s, i):
    """The cycle of the event in lane i, and the time within it, where that has arrived."""
    stage, start, cycle, wait = load(s, i, STAGE), load(s, i, START), load(s, i, CYCLE), load(s, i, WAIT)
    turns, arrived = np.floor((start + wait) * load(s, i, PER_PERIOD)), stage == AT_EVENT
    store(s, i, START, choose(arrived, fma(-turns, load(s, i, PERIOD), start) + wait, start))
    store(s, i, CYCLE, choose(arrived, cycle + turns, cycle))


@njit(**SIMD_INLINE)
def apply_impacts(s):
    """Impacts: where a lane has arrived, eq. (2) and the next arc."""
    for i in range(LANES):
        propagate_tangent(s, i, load(s, i, RESTITUTION), saltation_shear(s, i) / load(s, i, SPEED))
    for i in range(LANES):
        turn_clock(s, i)
        stage, side, velocity = load(s, i, STAGE), load(s, i, SIDE), load(s, i, VELOCITY)
        cosine, sine = load(s, i, COSINE), load(s, i, SINE)
        speed, next_cosine, next_sine = load(s, i, SPEED), load(s, i, NEXT_COSINE), load(s, i, NEXT_SINE)
        restitution, arrived = load(s, i, RESTITUTION), stage == AT_EVENT
        store(s, i, SIDE, choose(arrived, -side, side))
        store(s, i, VELOCITY, choose(arrived, restitution * speed, velocity))
        store(s, i, COSINE, choose(arrived, -next_cosine, cosine))
        store(s, i, SINE, choose(arrived, -next_sine, sine))


@njit(**SIMD_INLINE)
def begin(s):
    """The arc that begins where a lane has arrived, or its block has just come: its c+ and c-, and where the walk along it starts.

    Where c+ and c- are negative u lies within beta of 1 - m cosh(t - middle), m = 2 sqrt(c+ c-): above 0 from ``early`` to
    ``late``, between the roots of c+ z + 1 - beta + c-/z in z = e^t, which need not be walked; and below 1 - m + beta, or
    less where no crest of the forcing is near the middle (``extrema.crest``). In each of three short loops nothing waits
    for the lanes before: the machine works on several of them at once.
    """
    for i in range(LANES):
        stage, start, side, velocity = (
            load(s, i, STAGE),
            load(s, i, START),
            load(s, i, SIDE),
            load(s, i, VELOCITY),
        )
        cosine, sine, response, response_rate = (
            load(s, i, COSINE),
            load(s, i, SINE),
            load(s, i, RESPONSE),
            load(s, i, RESPONSE_RATE),
        )
        period, per_period = load(s, i, PERIOD), load(s, i, PER_PERIOD)
        right, left = load(s, i, CUT_RIGHT), load(s, i, CUT_LEFT)
        growing, shrinking = load(s, i, GROWING), load(s, i, SHRINKING)
        mean, half = fma(-response, cosine, -1.0), fma(response_rate, sine, velocity)
        # 2 c+ and 2 c-
        grow, shrink, q = mean + half, mean - half, 1.0 - response
        m, root = math.sqrt(grow * shrink), math.sqrt(fma(q, q, -grow * shrink))
        late, twice = logarithms_of_ratios(q + root, -grow, -shrink, -grow)
        to_cut = choose(side > 0.0, right, left) - start
        begins = stage >= NEW_ARC
        store(s, i, GROWING, choose(begins, 0.5 * grow, growing))
        store(s, i, SHRINKING, choose(begins, 0.5 * shrink, shrinking))
        store(s, i, DEEP, m)
        store(s, i, TWICE, twice)
        store(s, i, LATE, choose(q > m, late, -math.inf))
        store(s, i, CUT, fma(-np.floor(to_cut * per_period), period, to_cut))
    for i in range(LANES):
        stage, grow, shrink = load(s, i, STAGE), load(s, i, GROWING), load(s, i, SHRINKING)
        m, twice, late, cut = load(s, i, DEEP), load(s, i, TWICE), load(s, i, LATE), load(s, i, CUT)
        square, response, inside = load(s, i, FREQUENCY_SQUARE), load(s, i, RESPONSE), load(s, i, INSIDE)
        period, per_period = load(s, i, PERIOD), load(s, i, PER_PERIOD)
        low, end, exceeds, peak = load(s, i, LOW), load(s, i, END), load(s, i, EXCEEDS), load(s, i, PEAK)
        told = max(grow, shrink) < TOLD
        away = fma(-0.5, inside + twice, cut)
        away = fma(-np.floor(fma(away, per_period, 0.5)), period, away)
        away = max(abs(away) - ROUGHLY, 0.0)
        # 1 - cos y >= y**2 (1/2 - a**2/4! + a**4/6! - a**6/8!) for y up to a, and at least 1 from a = pi/2 to pi
        away_2 = away * away
        a = min(square * away_2, RIGHT_ANGLE * RIGHT_ANGLE)
        bowl = load(s, i, CREST_CURVATURE) * fma(-a, fma(-a, fma(-a, I8, I6), I4), I2)
        above = 1.0 - m + response - peak
        may_exceed = (above > response) | (above * (m + bowl) > 0.5 * away_2 * bowl * m)
        early, late = twice - late + 2.0 * ROUGHLY, late - 2.0 * ROUGHLY
        leaps = told & (cut > early) & (cut < late)
        turns = choose(leaps, np.floor((late - cut) * per_period), 0.0)
        cut = fma(turns, period, cut)
        begins = stage >= NEW_ARC
        store(s, i, EXCEEDS, choose(begins, choose(told & (may_exceed == False), 0.0, 1.0), exceeds))  # noqa: E712
        store(s, i, LOW, choose(begins, max(cut - inside, 0.0), low))
        store(s, i, END, choose(begins, cut, end))
    for i in range(LANES):
        stage, end, z, per_z = load(s, i, STAGE), load(s, i, END), load(s, i, Z), load(s, i, PER_Z)
        new_z, new_per_z = both_exponentials(end)
        begins = stage >= NEW_ARC
        store(s, i, Z, choose(begins, new_z, z))
        store(s, i, PER_Z, choose(begins, new_per_z, per_z))
        store(s, i, STAGE, choose(begins, BRACKET, stage))
