"""Test to second order that a motion near a stable orbit cannot turn away from it.

Near the orbit the return map is z -> J z + D2P(z, z)/2 + ..., with z the deviation from the orbit. Let v and w be the
eigenvectors of J with the multipliers rho and sigma, and z = u v + s w. Just above a fold, an unstable orbit lies
close by in the direction v. A motion beyond it may come nearer for many returns, because its fast part s shrinks.
It leaves afterwards. So neither a small deviation nor returns that come nearer are evidence.
"""

import math
from typing import NamedTuple

from rocking.kernels.classify.section import deviation_and_miss
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.march import Recording
from rocking.kernels.motion.tangent import Tangent, TangentState
from rocking.kernels.numerics.elementary import logarithm, size
from rocking.kernels.orbits.floquet import adapted_norm, length, multipliers
from rocking.kernels.orbits.return_map import Guess, image_after

# Step of the difference quotients of the Jacobian. The image keeps clear of the events near the section.
STEP = 1e-7
# The motion may be this fraction of the way to the nearest unstable orbit. There it still approaches at half the rate
# of the multipliers.
HALF_WAY = 0.5
# Maximum relative change of coordinates that removes the second-order terms.
BENDING = 0.3
# Minimum contraction of the slow part of the deviation, as a fraction of what its multiplier predicts.
SLOWEST = 0.3
# Multipliers are distinct if the rates of their parts differ by this factor. Otherwise both parts are slow.
DISTINCT = 2.0
# The returns of the motion itself give its second-order terms if the sines of the angles between three of them are at
# least SPREAD. If these terms are clearly below their limit, no more motions are computed. In 150,000 verdicts, terms of
# returns below 0.25 of the limit never belonged to terms of ``curvature`` above 0.34 of it.
SPREAD, CLEARLY_BELOW = 0.02, 0.25
# Largest predicted number of returns.
MAX_RETURNS = 1 << 20


class Curvature(NamedTuple):
    """Second derivative of a return map: the derivatives of its Jacobian by angle and velocity."""

    known: bool  # the displaced motions have the impacts and brace impacts of the orbit
    by_angle: Tangent
    by_velocity: Tangent


@kernel
def difference_quotient(after, before, step):
    """Return the difference quotient of two tangents."""
    return Tangent(
        (after.a - before.a) / step,
        (after.b - before.b) / step,
        (after.c - before.c) / step,
        (after.d - before.d) / step,
    )


@kernel
def curvature(mapping, found, columns, nothing):
    """Return the second derivative of a return map at a fixed point, from two displaced motions with tangents.

    If a displaced motion has another number of events, the opposite displacement is tried.
    """
    recording = Recording(0.0, nothing.section, nothing.events, False, False)
    state, image = TangentState(columns, nothing.tangent.growth), found.image
    slopes, known = (image.tangent, image.tangent), False
    for step in (STEP, -STEP):
        one = image_after(mapping, Guess(found.angle + step, found.velocity, image.waits), recording, state)
        two = image_after(mapping, Guess(found.angle, found.velocity + step, image.waits), recording, state)
        known = one.certain and one.impacts == image.impacts and one.brace_hits == image.brace_hits
        known = known and two.certain and two.impacts == image.impacts and two.brace_hits == image.brace_hits
        slopes = (
            difference_quotient(one.tangent, image.tangent, step),
            difference_quotient(two.tangent, image.tangent, step),
        )
        if known:
            break
    return Curvature(known, slopes[0], slopes[1])


@kernel
def curvature_of_returns(section, row, period, found):
    """Estimate the second derivative of a return map from the last three returns of a motion near a fixed point.

    A return from the deviation z differs from the linear map by D2P(z, z)/2. Its value for three deviations gives all others
    (interpolation of Lagrange in the areas between them). Unknown if the directions of two deviations nearly coincide.
    """
    first, second = (
        deviation_and_miss(section, row, period, found),
        deviation_and_miss(section, row - period, period, found),
    )
    third = deviation_and_miss(section, row - 2 * period, period, found)
    xx, xy, yy, known = (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), True
    for (here, value), (one, _), (two, _) in (
        (first, second, third),
        (second, third, first),
        (third, first, second),
    ):
        apart = area(one, here)
        known = known and apart * apart >= SPREAD * SPREAD * squared(one) * squared(here)
        weight = 1.0 / (apart * area(two, here))
        fx, fy = weight * (2.0 * value[0]), weight * (2.0 * value[1])
        across = -0.5 * (one[0] * two[1] + one[1] * two[0])
        xx = xx[0] + fx * one[1] * two[1], xx[1] + fy * one[1] * two[1]
        xy = xy[0] + fx * across, xy[1] + fy * across
        yy = yy[0] + fx * one[0] * two[0], yy[1] + fy * one[0] * two[0]
    return Curvature(known, Tangent(xx[0], xx[1], xy[0], xy[1]), Tangent(xy[0], xy[1], yy[0], yy[1]))


@kernel
def squared(vector):
    """Return the squared length of a vector."""
    return vector[0] * vector[0] + vector[1] * vector[1]


@kernel
def apply(bend, first, second):
    """Return D2P(first, second) of two vectors."""
    one, two, (x, y) = bend.by_angle, bend.by_velocity, second
    return (
        first[0] * (one.a * x + one.c * y) + first[1] * (two.a * x + two.c * y),
        first[0] * (one.b * x + one.d * y) + first[1] * (two.b * x + two.d * y),
    )


@kernel
def eigenvector(tangent, value):
    """Return the right eigenvector, of unit length, of the matrix whose columns are (a, b) and (c, d); ``value`` is real."""
    x, y = tangent.c, value - tangent.a
    other_x, other_y = value - tangent.d, tangent.b
    if abs(other_x) + abs(other_y) > abs(x) + abs(y):
        x, y = other_x, other_y
    shorter = 1.0 / size(x, y)
    return x * shorter, y * shorter


@kernel
def area(first, second):
    """Return the determinant of two vectors."""
    return first[0] * second[1] - first[1] * second[0]


@kernel
def component(vector, along, across):
    """Return the component of a vector along the first of two others."""
    return area(vector, across) / area(along, across)


@kernel
def excess_in_ball(bend, tangent, radius, x, y, residual):
    """Return the second-order terms at (x, y) over their limit, in a norm in which the linear map shrinks.

    Below the limit, the second-order map takes a ball around the orbit into itself. No eigenvectors are needed, but both
    parts of the deviation must be small.
    """
    shrinks = 0.5 * (1.0 + radius)
    norm = adapted_norm(tangent, shrinks)
    # norm = R^T R with an upper triangle R; e1 and e2 are the columns of its inverse, of length 1 in the norm
    r11 = math.sqrt(norm[0])
    r12 = norm[1] / r11
    r22 = math.sqrt(norm[2] - r12 * r12)
    e1, e2 = (1.0 / r11, 0.0), (-r12 / (r11 * r22), 1.0 / r22)
    large = 0.0
    for first, second, twice in ((e1, e1, 1.0), (e1, e2, 2.0), (e2, e2, 1.0)):
        image = apply(bend, first, second)
        large += twice * length(norm, image[0], image[1]) ** 2
    doubt = 2.0 * residual * (math.sqrt(norm[0]) + math.sqrt(norm[2])) / (1.0 - shrinks)
    return 0.5 * math.sqrt(large) * (length(norm, x, y) + doubt) / (HALF_WAY * (1.0 - shrinks))


@kernel
def excess_of_real(bend, tangent, rho, sigma, x, y, residual):
    """Return the second-order terms at (x, y) over their limit, and the multiplier by which they shrink; real multipliers.

    One return is u' = rho u + q u^2 + a u s + b s^2. Let U = u + a u s/(rho (1 - sigma)) + b s^2/(rho - sigma^2).
    To second order U' = rho U + q U^2. The unstable orbit lies at U = (1 - rho)/q. On the other side of the orbit u may
    have any size. For rho < 0 the term q u^2 is removed in the same way, and all terms must be small. Next to a fold the
    ``residual`` of the orbit may exceed (1 - rho)^2/(4 q). Then no orbit need exist, so it counts as well.
    """
    v, w = eigenvector(tangent, rho), eigenvector(tangent, sigma)
    u, s = component((x, y), v, w), component((x, y), w, v)
    q = 0.5 * component(apply(bend, v, v), v, w)
    mixed = abs(component(apply(bend, v, w), v, w) * u * s / (rho * (1.0 - sigma)))
    kicks = mixed + abs(0.5 * component(apply(bend, w, w), v, w) * s * s / (rho - sigma * sigma))
    if rho < 0.0:
        bent = kicks + abs(q * u * u / (rho - rho * rho))
        return bent / (BENDING * (abs(u) + abs(s))), abs(rho)
    towards, doubt = max(0.0, u if q > 0.0 else -u), 4.0 * residual / (abs(area(v, w)) * (1.0 - rho))
    shrinks = abs(sigma) if kicks > towards else rho
    return abs(q) * (towards + kicks + doubt) / (HALF_WAY * (1.0 - rho)), shrinks


@kernel
def excess_of_complex(bend, tangent, real, imaginary, x, y):
    """Return the second-order terms at (x, y) over their limit, for the multiplier l = ``real`` + i ``imaginary``.

    The eigenvectors are p + i q and p - i q. One return is u' = l u + f u^2 + g u u* + h u*^2, where * is the conjugate. Let
    U = u + f u^2/(l - l^2) + g u u*/(l - l l*) + h u*^2/(l - l*^2). To second order U' = l U. This fails if the multiplier
    is near 1 or a cube root of 1: unstable orbits lie close by. A vector z has the component
    |area(z, p) - i area(z, q)|/(2 area(p, q)) along p + i q, so the arithmetic is real.
    """
    p, q = (tangent.c, 0.5 * (tangent.d - tangent.a)), (0.0, imaginary)
    pp, pq, qq = apply(bend, p, p), apply(bend, p, q), apply(bend, q, q)
    # D2P(v, v) = even + 2 i pq and D2P(v, v*) = flat, with v = p + i q
    even, flat = (pp[0] - qq[0], pp[1] - qq[1]), (pp[0] + qq[0], pp[1] + qq[1])
    even_p, even_q, odd_p, odd_q = area(even, p), area(even, q), 2.0 * area(pq, p), 2.0 * area(pq, q)
    own = 0.25 * squared((even_p + odd_q, even_q - odd_p))
    mixed = squared((area(flat, p), area(flat, q)))
    crossed = 0.25 * squared((even_p - odd_q, even_q + odd_p))
    modulus = squared((real, imaginary))
    own_pole = modulus * squared((1.0 - real, imaginary))
    mixed_pole = squared((real - modulus, imaginary))
    crossed_pole = squared((real - real * real + imaginary * imaginary, imaginary + 2.0 * real * imaginary))
    bent = math.sqrt(own / own_pole) + math.sqrt(mixed / mixed_pole) + math.sqrt(crossed / crossed_pole)
    between = 2.0 * area(p, q)
    return bent * size(area((x, y), p), area((x, y), q)) / (BENDING * between * between)


@kernel
def slow_part_shrinks(section, row, period, found, rho, sigma):
    """Return whether the slow part of the deviation shrinks in each of the last returns, and after transients.

    That detects terms of third order, which decide at symmetric orbits and for rho < 0. For rho < 0 a contraction is that
    over two returns. The fast part disturbs each contraction by an amount that shrinks by sigma per return.
    """
    tangent, ahead = found.image.tangent, 1 if rho > 0.0 else 2
    v, w = eigenvector(tangent, rho), eigenvector(tangent, sigma)
    needed = SLOWEST * (1.0 - abs(rho) ** ahead)
    last, spread, least = 0.0, 0.0, math.inf
    for k in range(4 - ahead):
        after, before = row - k * period, row - (k + ahead) * period
        to = component((section[after, 0] - found.angle, section[after, 1] - found.velocity), v, w)
        since = component((section[before, 0] - found.angle, section[before, 1] - found.velocity), v, w)
        shrunk = 1.0 - to / since
        if k == 0:
            last = shrunk
        least, spread = min(least, shrunk), max(spread, abs(shrunk - last))
    damping = abs(sigma) ** (3 - ahead)
    return least >= needed and last - damping / (1.0 - damping) * spread >= needed


@kernel
def excess_at(mapping, found, section, row, columns, nothing):
    """Return the second-order terms over their limit at a row of the section near an orbit.

    Returns
    -------
    tuple of (float, float)
        Terms over their limit: at most 1 if they cannot turn the motion away, infinite if they are unknown.
        Multiplier by which this shrinks per return, 0 if unknown.
    """
    x, y, tangent = section[row, 0] - found.angle, section[row, 1] - found.velocity, found.image.tangent
    real, imaginary, other, _ = multipliers(tangent)
    radius = size(real, imaginary)
    if imaginary != 0.0:
        bend = curvature_of_returns(section, row, mapping.cycles, found)
        excess = excess_of_complex(bend, tangent, real, imaginary, x, y)
        if bend.known and excess <= CLEARLY_BELOW:
            return excess, radius
    bend = curvature(mapping, found, columns, nothing)
    if not bend.known:
        return math.inf, 0.0
    in_ball = excess_in_ball(bend, tangent, radius, x, y, found.residual)
    if imaginary != 0.0:
        return min(in_ball, excess_of_complex(bend, tangent, real, imaginary, x, y)), radius
    if 1.0 - abs(other) < DISTINCT * (1.0 - radius):
        return in_ball, radius
    along, shrinks = excess_of_real(bend, tangent, real, other, x, y, found.residual)
    excess = min(in_ball, along)
    if excess <= 1.0 and not slow_part_shrinks(section, row, mapping.cycles, found, real, other):
        return math.inf, 0.0
    return excess, shrinks


@kernel
def departure(mapping, found, section, row, columns, nothing):
    """Return ``excess_at`` a row, and the predicted number of cycles until it is at most 1; 0 if unknown."""
    excess, shrinks = excess_at(mapping, found, section, row, columns, nothing)
    if excess <= 1.0 or not (0.0 < shrinks < 1.0 and excess < math.inf):
        return excess, 0
    returns = math.ceil(min(1.0 + logarithm(excess) / -logarithm(shrinks), MAX_RETURNS))
    return excess, mapping.cycles * returns
