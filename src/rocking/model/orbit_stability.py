"""Stability of a periodic orbit: one criterion for modes, orbits and branches."""

from __future__ import annotations

from enum import StrEnum


class Stability(StrEnum):
    """Linear stability of a periodic orbit: a string, one of three.

    An orbit is "stable" if nearby motions converge to it, and "unstable" if some of them diverge exponentially. It is
    "neutral" if neither holds: the orbit dissipates no energy, and both multipliers lie on the unit circle.

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
    """Return the stability of a fixed point of a plane map from the trace and the determinant of its Jacobian.

    Both eigenvalues lie inside the unit circle if |trace| < 1 + determinant and determinant < 1. A determinant of
    exactly 1 means that no event dissipates energy. Then |trace| < 2 puts both eigenvalues on the unit circle, although
    their computed moduli may differ from 1 by rounding.
    """
    if not abs(trace) < 1.0 + determinant:
        return Stability.UNSTABLE
    return Stability.NEUTRAL if determinant == 1.0 else Stability.STABLE
