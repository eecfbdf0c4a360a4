"""What each lane wants before an event between braces, and what the event does: eq. (2), or what a brace gives back."""

from numba import njit

from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.lanes.impact import propagate_tangent, saltation_shear, set_request, turn_clock
from rocking.kernels.lanes.rows import (  # fmt: skip
    ABOUT,
    AMPLITUDE,
    ANGLE,
    AT_BRACE,
    AT_EVENT,
    BRACE_ANGLE,
    BRACE_HITS,
    BRACE_RESTITUTION,
    BRACKET,
    CHECK_ZENO,
    COSINE,
    EXCEEDS,
    KNOT_ANGLE,
    KNOT_COSINE,
    KNOT_RATE,
    KNOT_SINE,
    LANES,
    NEW_ARC,
    NEXT_COSINE,
    NEXT_SINE,
    NO_REQUEST,
    PEAK,
    RESTITUTION,
    SIDE,
    SINE,
    SPEED,
    STAGE,
    TRIES,
    UPDATE_PEAK,
    VELOCITY,
    load,
    store,
)
from rocking.kernels.march.impact_law import SLOW
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose


@njit(**SIMD_INLINE)
def set_requests(s):
    """What each lane wants before its event; whether any wants anything."""
    any_wants = False
    for i in range(LANES):
        at_brace, exceeds = load(s, i, AT_BRACE) > 0.0, load(s, i, EXCEEDS) > 0.0
        restitution = choose(at_brace, load(s, i, BRACE_RESTITUTION), load(s, i, RESTITUTION))
        returned = restitution * load(s, i, SPEED)
        wants = choose(exceeds & (at_brace == False), UPDATE_PEAK, NO_REQUEST)  # noqa: E712
        wants = choose((restitution < 1.0) & (returned < SLOW), CHECK_ZENO, wants)
        any_wants |= set_request(s, i, wants, returned)
    return any_wants


@njit(**SIMD_INLINE)
def apply_events(s):
    """Events: where a lane has arrived, eq. (2) or what a brace does, and the next arc."""
    for i in range(LANES):
        hit, r = load(s, i, AT_BRACE) > 0.0, load(s, i, BRACE_RESTITUTION)
        amplitude, brace_angle, next_cosine = (
            load(s, i, AMPLITUDE),
            load(s, i, BRACE_ANGLE),
            load(s, i, NEXT_COSINE),
        )
        restitution, speed, pulled = load(s, i, RESTITUTION), load(s, i, SPEED), saltation_shear(s, i)
        # as ``tangent.event_map``
        pressed = (1.0 + r) * fma(-amplitude, next_cosine, brace_angle - 1.0)
        propagate_tangent(s, i, choose(hit, -r, restitution), choose(hit, pressed, pulled) / speed)
    for i in range(LANES):
        turn_clock(s, i)
        stage, side, velocity = load(s, i, STAGE), load(s, i, SIDE), load(s, i, VELOCITY)
        cosine, sine, brace_angle = load(s, i, COSINE), load(s, i, SINE), load(s, i, BRACE_ANGLE)
        angle, peak, hits = load(s, i, ANGLE), load(s, i, PEAK), load(s, i, BRACE_HITS)
        speed, next_cosine, next_sine = load(s, i, SPEED), load(s, i, NEXT_COSINE), load(s, i, NEXT_SINE)
        restitution, brace_restitution = load(s, i, RESTITUTION), load(s, i, BRACE_RESTITUTION)
        tries, about = load(s, i, TRIES), load(s, i, ABOUT)
        knot_angle, knot_rate = load(s, i, KNOT_ANGLE), load(s, i, KNOT_RATE)
        knot_cosine, knot_sine = load(s, i, KNOT_COSINE), load(s, i, KNOT_SINE)
        hit, arrived = load(s, i, AT_BRACE) > 0.0, stage == AT_EVENT
        begins = stage >= NEW_ARC
        turned = choose(hit, 1.0, -1.0)
        angle = choose(arrived, choose(hit, brace_angle, 0.0), angle)
        velocity = choose(arrived, choose(hit, -brace_restitution, restitution) * speed, velocity)
        cosine, sine = (
            choose(arrived, turned * next_cosine, cosine),
            choose(arrived, turned * next_sine, sine),
        )
        store(s, i, SIDE, choose(arrived, turned * side, side))
        store(s, i, ANGLE, angle)
        store(s, i, VELOCITY, velocity)
        store(s, i, COSINE, cosine)
        store(s, i, SINE, sine)
        peak = choose(arrived, max(peak, angle), peak)
        store(s, i, PEAK, peak)
        store(s, i, EXCEEDS, choose(peak < brace_angle, 1.0, 0.0))
        store(s, i, BRACE_HITS, choose(arrived & hit, hits + 1.0, hits))
        store(s, i, KNOT_ANGLE, choose(begins, angle, knot_angle))
        store(s, i, KNOT_RATE, choose(begins, velocity, knot_rate))
        store(s, i, KNOT_COSINE, choose(begins, cosine, knot_cosine))
        store(s, i, KNOT_SINE, choose(begins, sine, knot_sine))
        store(s, i, ABOUT, choose(begins, 0.0, about))
        store(s, i, TRIES, choose(begins, 0.0, tries))
        store(s, i, STAGE, choose(begins, BRACKET, stage))
