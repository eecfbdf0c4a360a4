"""Full block, of any slenderness: w'' = r^2 (sin w + sigma alpha A cos w) with w = alpha (s - u), Housner's equation.

Angles are in units of alpha, the critical angle of the right side, and times in units of its frequency parameter. A side has the
critical angle alpha s and the frequency parameter r, its ``ratio`` and ``rate``; both are 1 on the right. The block rests, and
stays at a brace, as long as the slender system that it holds. Its arcs are Taylor series (``arc.full_series``).
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.arc import Next
from rocking.kernels.contract import acceleration_of, weight_of
from rocking.kernels.event_kinds import REST
from rocking.kernels.library.kernel import body
from rocking.kernels.numerics.elementary import cosine_of, sine_of
from rocking.kernels.system import Full, Unsymmetric, side_of


@body(contract.acceleration, Full, inline=True)
def acceleration(p, side, angle, drive):
    """Provide ``contract.acceleration``: u'' = -r^2 (W sin(w)/alpha + sigma A cos(w)), w = alpha (s - u), with the weight W."""
    alpha, own = p.block.critical_angle, side_of(p.block, side)
    w = alpha * (own.ratio - angle)
    return own.stiffness * (
        -(weight_of(p, drive) * sine_of(w)) / alpha - side * acceleration_of(p, drive) * cosine_of(w)
    )


@body(contract.forcing_term, Full, inline=True)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``: u'' at the base."""
    return acceleration(p, side, 0.0, drive)


@body(contract.restoring_acceleration, Full, inline=True)
def restoring_acceleration(p, side):
    """Provide ``contract.restoring_acceleration``."""
    return side_of(p.block, side).press


@body(contract.parts_at_base, Full, inline=True)
def parts_at_base(p, side, weight):
    """Provide ``contract.parts_at_base``."""
    return weight * side_of(p.block, side).press


@body(contract.change_of_side, Full, inline=True)
def change_of_side(p, side, after):
    """Provide ``contract.change_of_side``."""
    before, later = side_of(p.block, side), side_of(p.block, after)
    return later.press / before.press, later.cosine / before.cosine


@body(contract.is_symmetric, Full, inline=True)
def is_symmetric(p):
    """Provide ``contract.is_symmetric``."""
    right, left = p.block.right, p.block.left
    return right.ratio == left.ratio and right.rate == left.rate and right.restitution == left.restitution


@body(contract.has_wall, Full, inline=True)
def has_wall(p):
    """Provide ``contract.has_wall``: no base acceleration lifts the block to the left."""
    return p.block.left_level == math.inf


@body(contract.escape_speed, Full)
def escape_speed(p):
    """Provide ``contract.escape_speed``: u'^2/2 is the barrier r^2 (1 - cos(alpha s))/alpha^2, the lower one of both sides."""
    alpha, right, left = p.block.critical_angle, p.block.right, p.block.left
    first = 2.0 * right.rate * sine_of(0.5 * (alpha * right.ratio)) / alpha
    return min(first, 2.0 * left.rate * sine_of(0.5 * (alpha * left.ratio)) / alpha)


@body(contract.impacts_per_trial, Full, inline=True)
def impacts_per_trial(p):
    """Provide ``contract.impacts_per_trial``: an impact costs more than a trial."""
    return 1


@body(contract.resting, Full, inline=True)
def resting(p):
    """Provide ``contract.resting``."""
    return p.resting, p.block.left_level


@body(contract.stays_leaning, Full, inline=True)
def stays_leaning(p, arc):
    """Provide ``contract.stays_leaning``: as the slender block which rests as long."""
    return contract.stays_leaning(p.resting, arc)


@body(contract.held_event, Full)
def held_event(p, mode, arc):
    """Provide ``contract.held_event``: that of the slender block which rests as long."""
    if mode == REST:
        return contract.lift_off(p.resting, arc, p.block.left_level)
    found = contract.held_event(p.resting, mode, arc)
    return Next(found.wait, found.event, found.side, p.block.brace_angle, 0.0, found.drive, 0.0, 0.0)


@body(contract.sensitivities, Unsymmetric, inline=True)
@body(contract.sensitivities, Full, inline=True)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities``: those by parameters are of the slender block with equal sides alone."""
    return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
