"""Stability of a periodic orbit: the one criterion for modes, orbits and branches."""

from __future__ import annotations

from enum import StrEnum


class Stability(StrEnum):
    """Linear stability of a periodic orbit: a plain string, and one of three.

    An orbit is "stable" where neighbouring motions approach it, "unstable" where one of them leaves it exponentially. It is
    "neutral" where they do neither: the orbit loses no energy, and both multipliers lie on the unit circle.

    Examples
    --------
    >>> import rocking as rk
    >>> [str(rk.theory.symmetric_modes(2.0, 1.0, e, 1)[0].stability) for e in (0.925, 1.0)]
    ['stable', 'neutral']
    """

    STABLE = "stable"
    NEUTRAL = "neutral"
    UNSTABLE = "unstable"


def stability_of(trace: float, determinant: float) -> Stability:
    """Decide the stability of a map of the plane from the trace and the determinant of its tangent.

    Both eigenvalues lie inside the unit circle where |trace| < 1 + determinant and determinant < 1. A determinant of exactly 1
    means that nothing is lost; then |trace| < 2 puts both on the circle, and their computed moduli tell nothing.
    """
    if not abs(trace) < 1.0 + determinant:
        return Stability.UNSTABLE
    return Stability.NEUTRAL if determinant == 1.0 else Stability.STABLE
