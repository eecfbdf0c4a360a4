"""Coefficient of restitution of the full block over the speed before an impact; the law, eq. (2), is in ``impact``.

It is linear between the rows of a table, and constant beyond them. The offset of the impact is added to it (``block.scatter``).
"""

from rocking.kernels import contract
from rocking.kernels.block.scatter import largest_offset
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.system import Full, side_of


@kernel(inline=True)
def piece_at(law, speed):
    """Return the number of rows of a table below a speed: it lies on the piece that ends at the next row."""
    k = 0
    while k < law.shape[0] and speed > law[k, 0]:
        k += 1
    return k


@kernel(inline=True)
def on_piece(law, k, speed):
    """Return e and d(e v)/dv = e + v de/dv on a piece of a table."""
    if k == 0 or k == law.shape[0]:
        e = law[max(k - 1, 0), 1]
        return e, e
    slope = (law[k, 1] - law[k - 1, 1]) / (law[k, 0] - law[k - 1, 0])
    e = law[k - 1, 1] + slope * (speed - law[k - 1, 0])
    return e, e + slope * speed


@kernel
def of_law(p, side, speed):
    """Return e and d(e v)/dv without scatter. A table holds for both directions of impact."""
    law = p.block.law
    if law.shape[0] == 0:
        e = side_of(p.block, side).restitution
        return e, e
    speed *= p.block.speed_unit
    return on_piece(law, piece_at(law, speed), speed)


@kernel(inline=True)
def scattered(p, e, gain):
    """Return e and d(e v)/dv of the coming impact from those without scatter."""
    offset = p.block.scatter.offset
    if offset == 0.0:
        return e, gain
    if not 0.0 < e + offset < 1.0:
        e = 0.0 if offset < 0.0 else 1.0
        return e, e
    return e + offset, gain + offset


@body(contract.restitution_at, Full)
def restitution_at(p, side, speed):
    """Provide ``contract.restitution_at``: e, and d(e v)/dv."""
    return scattered(p, *of_law(p, side, speed))


@kernel(seldom=True)
def bend_within(p, side, speed, reach):
    """Return how far e v may be from its tangent at a speed, at all speeds within ``reach`` of it.

    That is no more than ``reach`` times the largest change of d(e v)/dv. On a piece of the table this derivative is linear, so that it
    is largest or least at an end of the piece, or where e reaches 0 or 1. There it lies between those with and without scatter.
    """
    law, unit, offset = p.block.law, p.block.speed_unit, p.block.scatter.offset
    _, gain = restitution_at(p, side, speed)
    low, high = unit * max(speed - reach, 0.0), unit * (speed + reach)
    first, last = piece_at(law, low), piece_at(law, high)
    most = 0.0
    for k in range(first, last + 1):
        for x in (law[k - 1, 0] if k > first else low, law[k, 0] if k < last else high):
            e, plain = on_piece(law, k, x)
            most = max(most, abs(scattered(p, e, plain)[1] - gain), abs(plain + offset - gain))
    return reach * most


@kernel
def largest_up_to(p, speed):
    """Return the largest coefficient at all speeds up to this one, in both directions and at all impacts."""
    law = p.block.law
    largest = max(of_law(p, 1, speed)[0], of_law(p, -1, speed)[0])
    for k in range(law.shape[0]):
        if k == 0 or law[k, 0] < speed * p.block.speed_unit:
            largest = max(largest, law[k, 1])
    return min(largest + largest_offset(p), 1.0)
