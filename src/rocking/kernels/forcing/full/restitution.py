"""Coefficient of restitution over the speed before an impact: linear between the rows of a table, and constant beyond them."""

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit


@njit(**INTERNAL)
def restitution_at(p, speed):
    """Provide ``contract.restitution_at``: e, and d(e v)/dv = e + v de/dv."""
    law = p.block.law
    count = law.shape[0]
    if count == 0:
        return p.block.restitution, p.block.restitution
    if speed <= law[0, 0]:
        return law[0, 1], law[0, 1]
    for k in range(1, count):
        if speed <= law[k, 0]:
            slope = (law[k, 1] - law[k - 1, 1]) / (law[k, 0] - law[k - 1, 0])
            e = law[k - 1, 1] + slope * (speed - law[k - 1, 0])
            return e, e + slope * speed
    return law[count - 1, 1], law[count - 1, 1]


@njit(**INTERNAL)
def largest_up_to(p, speed):
    """Return the largest coefficient at all speeds up to this one."""
    law = p.block.law
    largest, _ = restitution_at(p, speed)
    for k in range(law.shape[0]):
        if k == 0 or law[k, 0] < speed:
            largest = max(largest, law[k, 1])
    return largest
