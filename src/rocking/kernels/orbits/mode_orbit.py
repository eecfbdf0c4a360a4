"""Symmetric mode as a fixed point of the return map: no march is needed, only the search for one impact.

The closed form gives the state, and the linear flow the derivative. The search proves that the block meets
nothing on the arc before the impact of the mode. The second arc is the mirror image of the first.
"""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import FLIGHT, IMPACT
from rocking.kernels.forcing.contract import (
    forcing_term,
    guess_from,
    next_event,
    restoring_acceleration,
    transfer,
)
from rocking.kernels.march.tangent import (
    Tangent,
    along,
    carry_along,
    carry_through,
    event_map,
    through,
)
from rocking.kernels.numerics.elementary import size
from rocking.kernels.orbits.fixed_point import FixedPoint, MapImage, newton_correction

UNIT = Tangent(1.0, 0.0, 0.0, 1.0)


@njit(**INTERNAL)
def orbit_of_mode(p, mode):
    """Return a mode (``symmetric_mode.Nearest``) as the ``FixedPoint`` over its period.

    It has converged if the impact that ends its arc agrees with the closed form, to the tolerance of Newton's
    method.
    """
    arc, half, since = mode.arc, mode.half, mode.since
    coming, _ = next_event(p, FLIGHT, arc, guess_from(p, half))
    saltation = event_map(p, arc, coming, FLIGHT, -arc.side)
    to_impact, whole = transfer(p, arc, since, half - since), transfer(p, arc, 0.0, half)
    to_section = transfer(p, arc, 0.0, since)
    tangent = through(along(through(along(UNIT, to_impact), saltation), whole), saltation)
    tangent = along(tangent, to_section)

    # the state after the impact less that of the mode, at the same time, on the side of the next arc
    late, faster = coming.wait - half, -p.block.restitution * coming.velocity - arc.velocity
    bend = -forcing_term(p, arc.side, coming.drive) - 2.0 * restoring_acceleration(p)
    off = -arc.velocity * late, faster - bend * late
    again = carry_through(carry_along(off, whole), *saltation)
    # one half of the orbit mirrors the other
    angle, velocity = carry_along((off[0] - again[0], off[1] - again[1]), to_section)
    missed = arc.side * angle, arc.side * velocity
    residual = max(abs(missed[0]), abs(missed[1]))
    step, enough = newton_correction(tangent, 1.0, missed)
    image = MapImage(
        coming.event == IMPACT,
        mode.angle + missed[0],
        mode.velocity + missed[1],
        tangent,
        2,
        0,
        math.nan,
        (half - since, half),
    )
    converged = coming.event == IMPACT and residual <= enough
    return FixedPoint(converged, mode.angle, mode.velocity, image, residual, size(step[0], step[1]), 1)
