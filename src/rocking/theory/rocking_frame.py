"""Rocking frame: a rigid beam on free-standing columns, which moves like a block of another inertia and restitution."""

from __future__ import annotations

import math

from rocking.model import RECTANGLE, Block, within

MAX_RATIO = 1e6


def rocking_frame(height: float, width: float, mass_ratio: float) -> Block:
    """Block that moves like a frame of equal columns with a rigid beam on their tops.

    The columns rock together, and the beam moves without rotation. With γ = m_b/(N m_c), of a beam and N columns,

    - α̂ = α √((1 + 2γ)/(1 + 3γ)), by the inertia ratio (4/3)(1 + 3γ)/(1 + 2γ);
    - ê = (1 − (3/2) sin²θcr + 3γ cos 2θcr)/(1 + 3γ), by the angular momentum of the frame at an impact.

    The critical angle and the acceleration of lift-off are those of a column. A heavy beam makes the frame slower, so that it is
    harder to overturn.

    Parameters
    ----------
    height, width : float
        Height and width of a column in metres, in [0.001, 1000].
    mass_ratio : float
        γ, mass of the beam over that of all columns, in [0, 10⁶]. 0 gives the column alone.

    Returns
    -------
    Block
        Block with the size of a column, the inertia ratio and the restitution of the frame.

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value lies outside its range, or if the restitution is negative, for squat columns.

    See Also
    --------
    rocking.Block : A block with any inertia ratio and restitution.
    contact_restitution : Restitution of other impacts.

    References
    ----------
    Makris & Vassiliou (2013).

    Examples
    --------
    >>> import rocking as rk
    >>> column, frame = rk.Block(9.6, 1.6), rocking_frame(9.6, 1.6, mass_ratio=4.0)
    >>> round(frame.frequency_parameter / column.frequency_parameter, 4)
    0.8321
    >>> round(column.restitution, 4), round(frame.restitution, 4)
    (0.9595, 0.9470)
    """
    ratio = within("mass_ratio", mass_ratio, 0.0, MAX_RATIO)
    angle = Block(height, width, restitution=1.0).critical_angle
    column = 1.0 - 1.5 * math.sin(angle) ** 2
    restitution = (column + 3.0 * ratio * math.cos(2.0 * angle)) / (1.0 + 3.0 * ratio)
    inertia_ratio = RECTANGLE * (1.0 + 3.0 * ratio) / (1.0 + 2.0 * ratio)
    return Block(height, width, restitution=restitution, inertia_ratio=inertia_ratio)
