"""Margin of the full block: by how much it leaves the base faster than the motion that ends on its unstable balance.

The arcs of one side are continued smoothly through u = 0, and the base is at rest after its motion. With x = alpha (u - 1),

    x'' = W(t) sin x - sigma a(t) cos x,

with the weight W, which is 1 on a base that moves horizontally, and after the base motion.

(For a left side of its own, alpha and the unit of time are those of the side.)

The state (u, W(t, u)) is that from which the motion stays bounded, for ever. So the speed of such a motion at the base is
v_s(t) = W(t, 0), and the margin of a block that leaves the base at the speed v is K = v - v_s. If K < 0 the block comes back, and if
K > 0 it overturns, unless it meets the base before. After the base motion W = -(2/alpha) sin(x/2). For small alpha, K is the
constant K+ of the slender block.

**Existence.** Let |a| <= m l and W >= l > 0 from now on. If m < 1 and alpha + arctan m < 90 degrees, the difference d of two motions
within |x| <= max(alpha, arctan m) obeys d'' = q d with q > 0, so that one of them is bounded, and only one: q is a mean of
W cos x - sigma a sin x >= l (cos x - m |sin x|), and x W sin x > |a x| cos x beyond arctan m. Otherwise q > 0 is checked along the motion
that is found. If it fails, there is no margin.

**Method.** For any motion the excess e = u' - W(t, u) obeys e' = -W_u e. So K is the excess at a later time, divided by its growth,
which follows from the equation of small perturbations, to first order in K. W is approximated by that of the free block and the
response R of the slender one to a, W = -(2/alpha) sin(x/2) + sigma R. If the excess becomes larger than JUMP, the motion is put
onto this W, and goes on. The sum of all excesses, each divided by the growth so far, is K. An error of W counts less by the
growth. What is left is of second order in each excess: W_uu is about alpha^2/4. On a base that also moves vertically, -W_u may be far
from its approximation, too, which leaves an error of first order: a part of the excess. Repetition from the better speed makes both as
small as is wanted. Each repetition allows larger excesses, so that the error of W causes no jump in the end.
"""

import math
from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.full_biaxial import pushes_at
from rocking.kernels.arc.full_series import brief_biaxial_series, brief_divided_1, brief_linear_series
from rocking.kernels.arc.full_step import lean_of, state_in, step_from
from rocking.kernels.arc.slender_samples import means_at
from rocking.kernels.base.biaxial import Biaxial
from rocking.kernels.base.cosine import Pulse
from rocking.kernels.base.samples import Samples, interval
from rocking.kernels.contract import (
    drive_later,
    elapsed_until,
    growth_constant,
    has_ended,
    lightest_ahead,
    response_ahead,
    smooth_step,
    smooth_time,
)
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import (
    RIGHT_ANGLE,
    arctangent,
    cosine_of,
    exponential,
    fma,
    rough_hyperbolic,
    sine_of,
)
from rocking.kernels.system import Full, Slender, Unsymmetric, side_of

# Excess above which the motion is put onto the approximation of W: at first, and its factor at each repetition.
JUMP, WIDER = 0.2, 4.0
# Growth of the excess at which the error of W, about 0.05, no longer counts: absolutely, in a batch, and for the sign of K.
FAR, FAR_IN_BATCH, CLEAR = 2.0**32, 2.0**14, 2.0**8
# Largest error that jumps may leave.
SETTLED, SETTLED_IN_BATCH = 1e-11, 1e-4
# Length of a step of ``brief_linear_series``: the error of a step is below 1e-11.
LONGEST = 0.1
# |x| at which a pass is given up, although no proof excludes that the motion comes back to the balance.
UPSIDE_DOWN = math.pi


@body(contract.response_ahead, Slender, Samples, inline=True)
@body(contract.response_ahead, Full, Samples, Biaxial, inline=True)
def response_to_samples(p, drive):
    """Provide ``contract.response_ahead`` by the tables."""
    mean, rate = means_at(p, drive)
    return mean + rate


@body(contract.response_ahead, Slender, Pulse)
@body(contract.response_ahead, Full, Pulse)
def response_to_pulse(p, drive):
    """Provide ``contract.response_ahead``: that to the whole cosine, less the part after the end of the pulse."""
    left, wave = p.forcing.duration - drive.time, p.forcing.during
    if left <= 0.0:
        return 0.0
    whole = wave.response * (drive.cosine - wave.frequency * drive.sine)
    return whole - exponential(-left) * p.forcing.end_response


class Approach(NamedTuple):
    """Errors of the approximation of W that the search for the bounded motion admits, and its number of repetitions."""

    bend: float  # W_uu, about
    is_rough: (
        bool  # whether the errors of growths count; else repetition reduces them with those of second order
    )
    widest: float  # of W
    repetitions: int


@kernel(inline=True)
def bend_of(p):
    """Return about W_uu of a free block."""
    return 0.25 * p.block.critical_angle * p.block.critical_angle


@body(contract.approach_of, Full, inline=True)
def approach_of(p):
    """Provide ``contract.approach_of``."""
    return Approach(bend_of(p), False, 1.0, 12)


@body(contract.approach_of, Full, Biaxial, inline=True)
def approach_with_weight(p):
    """Provide ``contract.approach_of``.

    -W_u is about the root of a mean weight, instead of 1, and the weight changes within a step. So a repetition leaves a part of the
    excess.
    """
    return Approach(bend_of(p), True, 8.0, 40)


@body(contract.smooth_step, Full, Samples)
def step_between_samples(p, side, angle, velocity, drive):
    """Provide ``contract.smooth_step`` by a series of low order."""
    alpha, corner = p.block.critical_angle, smooth_time(p, drive)
    h = min(corner, LONGEST)
    start, rate = interval(p, drive.index)
    size = side * alpha
    push = size * (start + rate * drive.offset)
    sine, cosine = lean_of(p.block, side, angle)
    c = brief_linear_series(-alpha * velocity, sine, cosine, -1.0 / alpha, push, size * rate)
    slope, bend = brief_divided_1(angle, velocity, c, h)
    later = drive_later(p, drive, h, h == corner)
    return angle + slope * h, fma(bend, h, slope), cosine - push * sine, h, later


@body(contract.smooth_step, Full, Biaxial)
def step_between_weights(p, side, angle, velocity, drive):
    """Provide ``contract.smooth_step`` by a series of low order."""
    alpha, corner = p.block.critical_angle, smooth_time(p, drive)
    h = min(corner, LONGEST)
    push, rate, weight, lift = pushes_at(p, side, drive)
    sine, cosine = lean_of(p.block, side, angle)
    c = brief_biaxial_series(-alpha * velocity, sine, cosine, -1.0 / alpha, push, rate, weight, lift)
    slope, bend = brief_divided_1(angle, velocity, c, h)
    later, half = drive_later(p, drive, h, h == corner), 0.5 * h
    stiffness = (weight + half * lift) * cosine - (push + half * rate) * sine
    return angle + slope * h, fma(bend, h, slope), stiffness, h, later


@kernel(inline=True)
def stiffness_at(p, side, angle, drive):
    """Return q, the derivative of u'' by u."""
    sine, cosine = lean_of(p.block, side, angle)
    return contract.stiffness(p, side, sine, cosine, drive)


@body(contract.smooth_step, Full, Pulse)
def step_in_pulse(p, side, angle, velocity, drive):
    """Provide ``contract.smooth_step``."""
    step = step_from(p, side, angle, velocity, drive)
    rise, rate = state_in(step, step.length)
    there = angle + rise
    later = drive_later(p, drive, step.length, step.to_corner)
    # at a corner the acceleration just before it, to first order
    end = stiffness_at(p, side, there, drive if step.to_corner else later)
    return there, rate, 0.5 * (stiffness_at(p, side, angle, drive) + end), step.length, later


@body(contract.bounded_velocity, Full, inline=True)
def bounded_velocity(p, side, angle, drive):
    """Provide ``contract.bounded_velocity``: that of the free block, and the response of the slender one."""
    own = side_of(p.block, side)
    half = 0.5 * p.block.critical_angle * (angle - own.ratio)
    square = half * half
    free = (own.ratio - angle) * (1.0 - square * (1.0 / 6.0))
    return own.rate * (free + side * response_ahead(p, drive)), own.rate * (1.0 - 0.5 * square)


@body(contract.excess_at_end, Full)
def excess_at_end(p, side, angle, velocity):
    """Provide ``contract.excess_at_end``, in closed form."""
    own, alpha = side_of(p.block, side), p.block.critical_angle
    half = 0.5 * alpha * (angle - own.ratio)
    return velocity + own.rate * sine_of(half) * 2.0 / alpha, own.rate * cosine_of(half)


@kernel
def excess_of(p, arc, speed, far, jump):
    """Return the excess of a speed by one pass along its motion, the error that jumps leave, and the least q there.

    The pass ends where the growth exceeds ``far``, and that of K, too. If it leaves |x| < 180 degrees, the error is infinite.
    """
    angle, velocity, drive, total, least = 0.0, speed, arc.drive, 0.0, math.inf
    approach, doubt = contract.approach_of(p), 0.0
    by_angle, by_velocity = 0.0, 1.0  # of the perturbation that starts with (0, 1)
    alpha, balance = p.block.critical_angle, side_of(p.block, arc.side).ratio
    while not has_ended(p, drive):
        if not alpha * abs(angle - balance) < UPSIDE_DOWN:
            return math.nan, math.inf, least
        wanted, slope = contract.bounded_velocity(p, arc.side, angle, drive)
        excess, gain = velocity - wanted, by_velocity + slope * by_angle
        if gain > far and abs((arc.velocity - speed + total) * gain + excess) > CLEAR:
            return total + excess / gain, doubt, least
        if abs(excess) > jump:
            total += excess / gain
            doubt += approach.bend * excess * excess / gain
            if approach.is_rough:
                doubt += abs(excess) / gain
            velocity = wanted
        angle, velocity, q, h, drive = smooth_step(p, arc.side, angle, velocity, drive)
        least, z = min(least, q), q * h * h
        cosh = 1.0 + 0.5 * z * (1.0 + z * (1.0 / 12.0) * (1.0 + z * (1.0 / 30.0)))
        sinh = h * (1.0 + z * (1.0 / 6.0) * (1.0 + z * (1.0 / 20.0)))
        by_angle, by_velocity = cosh * by_angle + sinh * by_velocity, q * sinh * by_angle + cosh * by_velocity
    excess, slope = contract.excess_at_end(p, arc.side, angle, velocity)
    gain = by_velocity + slope * by_angle
    return total + excess / gain, doubt + approach.bend * excess * excess / gain, least


@kernel
def is_unique(p, arc):
    """Return whether the bound of the module's text proves that one motion is bounded, and only one."""
    alpha, light = p.block.critical_angle, lightest_ahead(p, arc.drive)
    if light <= 0.0:
        return False
    largest = alpha * contract.largest_push(p) / light
    return largest < 1.0 and alpha * side_of(p.block, arc.side).ratio + arctangent(largest) < RIGHT_ANGLE


@kernel(inline=True)
def speed_unit(p, side):
    """Return the unit of speeds of a side, its critical angle times its frequency parameter."""
    own = side_of(p.block, side)
    return own.ratio * own.rate


@body(contract.margin_of, Full)
def margin_of(p, arc, estimate, in_batch):
    """Provide ``contract.margin_of``; NaN if no bounded motion is found."""
    unit = speed_unit(p, arc.side)
    speed = arc.velocity - estimate * unit
    far, settled = (FAR_IN_BATCH, SETTLED_IN_BATCH) if in_batch else (FAR, SETTLED)
    jump, approach = JUMP, contract.approach_of(p)
    for _ in range(approach.repetitions):
        excess, doubt, least = excess_of(p, arc, speed, far, jump)
        if doubt == math.inf:
            return math.nan
        speed, jump = speed - excess, min(WIDER * jump, approach.widest)
        if approach.is_rough:
            doubt += abs(excess)
        if doubt <= settled:
            return (arc.velocity - speed) / unit if least > 0.0 or is_unique(p, arc) else math.nan
    return math.nan


@body(contract.margin_estimate, Full)
def margin_estimate(p, arc, coming, stretch):
    """Provide ``contract.margin_estimate``: the excess at the end of the arc, divided by its growth."""
    sinh, cosh = rough_hyperbolic(stretch.rate * elapsed_until(p, arc, coming.drive))
    wanted, _ = contract.bounded_velocity(p, arc.side, coming.angle, coming.drive)
    return (coming.velocity - wanted) / ((sinh + cosh) * speed_unit(p, arc.side))


@body(contract.estimate_error, Full, inline=True)
@body(contract.estimate_error, Slender, inline=True)
@body(contract.estimate_error, Unsymmetric, inline=True)
def estimate_error(p):
    """Provide ``contract.estimate_error``."""
    return 0.1


@body(contract.estimate_error, Full, Biaxial, inline=True)
def estimate_error_with_weight(p):
    """Provide ``contract.estimate_error``: the approximation of W knows nothing of the weight."""
    return 0.3


@body(contract.margin_of, Unsymmetric, inline=True)
@body(contract.margin_of, Slender, inline=True)
def slender_margin_of(p, arc, estimate, in_batch):
    """Provide ``contract.margin_of``: the estimate is exact."""
    return estimate


@body(contract.margin_estimate, Unsymmetric, inline=True)
@body(contract.margin_estimate, Slender, inline=True)
def slender_margin_estimate(p, arc, coming, stretch):
    """Provide ``contract.margin_estimate``: K+, exactly."""
    return growth_constant(p, arc)[0]
