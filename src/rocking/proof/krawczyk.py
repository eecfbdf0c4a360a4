"""Proof that equations have exactly one solution near a guess: Krawczyk's operator (1969).

For a box X around m let

    K(X) = m - Y F(m) + (I - Y F'(X)) (X - m).

If K(X) lies inside X, there is exactly one solution in X, and it lies in K(X). Y is any matrix. Here it is the inverse of F' near
the solution in double precision.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat, ctx

from rocking.proof.arc import Refused, above, largest

# Largest number of steps of Newton's method with a fixed inverse.
STEPS = 80
# Largest radius that is tried, in radians.
LARGEST = 0.5
# Steps of the bisection for the largest radius.
BISECTIONS = 9
# Factor on a radius that is too small.
WIDER = 16


class Equations(NamedTuple):
    """Equations F(x) = 0, with their derivatives; both functions return None where F is not defined."""

    values: Callable[[list[arb]], arb_mat | None]
    derivatives: Callable[[list[arb]], arb_mat | None]


class Solution(NamedTuple):
    """The only solution in a box."""

    box: list[arb]  # which contains it
    middle: list[arb]  # exact
    uniqueness: float  # radius of a box around the middle that contains ``box``, and no other solution


class Krawczyk(NamedTuple):
    """Operator around an exact middle m, with its matrix Y and the step Y F(m)."""

    equations: Equations
    middle: list[arb]
    inverse: arb_mat
    step: arb_mat

    def image(self, radius: float) -> list[arb] | None:
        """Return K(X) for the box of a radius, if it lies inside the box; else None."""
        box = [x + arb(0, radius) for x in self.middle]
        slope = self.equations.derivatives(box)
        if slope is None:
            return None
        # A ball has a radius of few digits, rounded up.
        product, k, image, reach = self.inverse * slope, len(box), [], largest(x.rad() for x in box)
        for i in range(k):
            spread = sum((abs(int(i == j) - product[i, j]).abs_upper() for j in range(k)), arb(0))
            moved = self.middle[i] - self.step[i, 0] + arb(0, 1) * (spread * reach).abs_upper()
            if not box[i].contains_interior(moved):
                return None
            image.append(moved)
        return image


def operator(equations: Equations, middle: list[arb]) -> Krawczyk:
    """Return the operator around a middle; raise Refused where the equations are singular or not defined."""
    values, slope = equations.values(middle), equations.derivatives(middle)
    if values is None or slope is None:
        raise Refused("the events change their order near the orbit")
    k = len(middle)
    rows = np.array([[float(slope[i, j]) for j in range(k)] for i in range(k)])
    try:
        inverse = np.linalg.inv(rows)
    except np.linalg.LinAlgError:
        raise Refused("the equations of the events are singular") from None
    if not np.isfinite(inverse).all():
        raise Refused("the equations of the events are singular")
    matrix = arb_mat([[arb(float(x)) for x in row] for row in inverse])
    return Krawczyk(equations, middle, matrix, matrix * values)


def size_of(step: arb_mat) -> arb:
    """Return the largest size of the components of a column."""
    return largest(abs(step[i, 0]).upper() for i in range(step.nrows()))


def solve(equations: Equations, guess: list[float]) -> Solution:
    """Return the solution near a guess; raise Refused if none is proved."""
    here = operator(equations, [arb(x) for x in guess])
    for _ in range(STEPS):
        middle = [(x - here.step[i, 0]).mid() for i, x in enumerate(here.middle)]
        values = equations.values(middle)
        if values is None:
            raise Refused("the events change their order near the orbit")
        ahead = here._replace(middle=middle, step=here.inverse * values)
        if not size_of(ahead.step) < size_of(here.step):
            break
        here = ahead
    radius, image = above(4 * size_of(here.step) + arb(2) ** (16 - ctx.prec)), None
    while radius < LARGEST:
        image = here.image(radius)
        if image is not None:
            return Solution(image, here.middle, largest_radius(here, radius))
        radius *= WIDER
    raise Refused("no box around the orbit is proved to contain exactly one solution")


def largest_radius(here: Krawczyk, radius: float) -> float:
    """Return a large radius for which K(X) lies inside X, by bisection of its logarithm; ``radius`` is one of them."""
    low, high = radius, LARGEST
    for _ in range(BISECTIONS):
        trial = (low * high) ** 0.5
        low, high = (trial, high) if here.image(trial) is not None else (low, trial)
    return low
