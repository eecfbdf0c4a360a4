"""Coefficient of restitution of an impact that acts between the centre and the corner of the base."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.model import refusal
from rocking.theory.arguments import between, plain, together


def contact_restitution(critical_angle: Any, fraction: Any) -> Any:
    """Coefficient of restitution of a uniform block whose impact acts at a fraction k of half its width.

    The angular momentum about the point of impact is conserved. The block then rotates about its corner:
    e = (4 − 3(1 + k) sin²θcr)/(4 − 3(1 − k) sin²θcr). k = 1 is an impact at the corner, Housner's value 1 − (3/2) sin²θcr. k = 0 is
    one at the centre of the base, without loss.

    Parameters
    ----------
    critical_angle : float or array
        Critical angle θcr in rad, in [0, π/2].
    fraction : float or array
        Distance k of the impact from the centre of the base, in units of half the width, in [0, 1]. The arguments broadcast.

    Returns
    -------
    float or ndarray
        e.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range, or if e is negative, for a squat block.

    See Also
    --------
    equivalent_damping : Damping ratio that design rules derive from e.
    rocking.Block : A block with any restitution.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(height=2.0, width=0.5)
    >>> contact_restitution(block.critical_angle, [0.0, 0.5, 1.0]).round(6).tolist()
    [1.0, 0.954887, 0.911765]
    """
    angle = between("critical_angle", critical_angle, 0.0, math.pi / 2)
    angle, k = together(critical_angle=angle, fraction=between("fraction", fraction, 0.0, 1.0))
    square = np.sin(angle) ** 2
    found = np.asarray((4.0 - 3.0 * (1.0 + k) * square) / (4.0 - 3.0 * (1.0 - k) * square))
    if (found < 0.0).any():
        first = float(np.broadcast_to(angle, found.shape)[found < 0.0].flat[0])
        allowed = "give a restitution that is not negative"
        raise ValueError(refusal("critical_angle", allowed, first, "the block is too squat to rock on"))
    return plain(found)
