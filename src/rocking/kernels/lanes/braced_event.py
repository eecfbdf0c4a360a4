"""What each lane wants before an event between braces, and what the event does: eq. (2), or what a brace gives back."""

from numba import njit

from rocking.kernels.compile_options import EXACT_INNER
from rocking.kernels.lanes.impact import carry, heed, sheared, turn_clock
from rocking.kernels.lanes.rows import (  # fmt: skip
    ABOUT,
    AMPLITUDE,
    ANGLE,
    ARRIVED,
    AT_BRACE,
    BEGUN,
    BRACE_ANGLE,
    BRACE_HITS,
    BRACE_RESTITUTION,
    CONTENT,
    COSINE,
    EXCEEDS,
    KNOT_ANGLE,
    KNOT_COSINE,
    KNOT_RATE,
    KNOT_SINE,
    LANES,
    NEXT_COSINE,
    NEXT_SINE,
    PEAK,
    PEAK_SEEN,
    RESTITUTION,
    SIDE,
    SINE,
    SLOW_SEEN,
    SPEED,
    STAGE,
    TRIES,
    VELOCITY,
    WALK,
    of,
    put,
)
from rocking.kernels.march.impact_law import SLOW
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose


@njit(**EXACT_INNER)
def attend(s):
    """What each lane wants before its event; whether any wants anything."""
    any_wants = False
    for i in range(LANES):
        at_brace, exceeds = of(s, i, AT_BRACE) > 0.0, of(s, i, EXCEEDS) > 0.0
        restitution = choose(at_brace, of(s, i, BRACE_RESTITUTION), of(s, i, RESTITUTION))
        returned = restitution * of(s, i, SPEED)
        wants = choose(exceeds & (at_brace == False), PEAK_SEEN, CONTENT)  # noqa: E712
        wants = choose((restitution < 1.0) & (returned < SLOW), SLOW_SEEN, wants)
        any_wants |= heed(s, i, wants, returned)
    return any_wants


@njit(**EXACT_INNER)
def strike(s):
    """Events: where a lane has arrived, eq. (2) or what a brace does, and the next arc."""
    for i in range(LANES):
        hit, r = of(s, i, AT_BRACE) > 0.0, of(s, i, BRACE_RESTITUTION)
        amplitude, brace_angle, next_cosine = (
            of(s, i, AMPLITUDE),
            of(s, i, BRACE_ANGLE),
            of(s, i, NEXT_COSINE),
        )
        restitution, speed, pulled = of(s, i, RESTITUTION), of(s, i, SPEED), sheared(s, i)
        # as ``tangent.event_map``
        pressed = (1.0 + r) * fma(-amplitude, next_cosine, brace_angle - 1.0)
        carry(s, i, choose(hit, -r, restitution), choose(hit, pressed, pulled) / speed)
    for i in range(LANES):
        turn_clock(s, i)
        stage, side, velocity = of(s, i, STAGE), of(s, i, SIDE), of(s, i, VELOCITY)
        cosine, sine, brace_angle = of(s, i, COSINE), of(s, i, SINE), of(s, i, BRACE_ANGLE)
        angle, peak, hits = of(s, i, ANGLE), of(s, i, PEAK), of(s, i, BRACE_HITS)
        speed, next_cosine, next_sine = of(s, i, SPEED), of(s, i, NEXT_COSINE), of(s, i, NEXT_SINE)
        restitution, brace_restitution = of(s, i, RESTITUTION), of(s, i, BRACE_RESTITUTION)
        tries, about = of(s, i, TRIES), of(s, i, ABOUT)
        knot_angle, knot_rate = of(s, i, KNOT_ANGLE), of(s, i, KNOT_RATE)
        knot_cosine, knot_sine = of(s, i, KNOT_COSINE), of(s, i, KNOT_SINE)
        hit, arrived = of(s, i, AT_BRACE) > 0.0, stage == ARRIVED
        begins = stage >= BEGUN
        turned = choose(hit, 1.0, -1.0)
        angle = choose(arrived, choose(hit, brace_angle, 0.0), angle)
        velocity = choose(arrived, choose(hit, -brace_restitution, restitution) * speed, velocity)
        cosine, sine = (
            choose(arrived, turned * next_cosine, cosine),
            choose(arrived, turned * next_sine, sine),
        )
        put(s, i, SIDE, choose(arrived, turned * side, side))
        put(s, i, ANGLE, angle)
        put(s, i, VELOCITY, velocity)
        put(s, i, COSINE, cosine)
        put(s, i, SINE, sine)
        peak = choose(arrived, max(peak, angle), peak)
        put(s, i, PEAK, peak)
        put(s, i, EXCEEDS, choose(peak < brace_angle, 1.0, 0.0))
        put(s, i, BRACE_HITS, choose(arrived & hit, hits + 1.0, hits))
        put(s, i, KNOT_ANGLE, choose(begins, angle, knot_angle))
        put(s, i, KNOT_RATE, choose(begins, velocity, knot_rate))
        put(s, i, KNOT_COSINE, choose(begins, cosine, knot_cosine))
        put(s, i, KNOT_SINE, choose(begins, sine, knot_sine))
        put(s, i, ABOUT, choose(begins, 0.0, about))
        put(s, i, TRIES, choose(begins, 0.0, tries))
        put(s, i, STAGE, choose(begins, WALK, stage))
