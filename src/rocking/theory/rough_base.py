"""First motion of a block at rest on a rough base: rest, slide, rock, or slide and rock (Shenton 1996)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.model.block import INERTIA_RATIOS, RECTANGLE
from rocking.model.quantity import FRICTION
from rocking.theory.arguments import between, plain, together

ANGLES = (1e-4, 1.57)
MAX_ACCELERATION = 1e6
FIRST_MOTIONS = ("rest", "slide", "rock", "slide-rock")


def slide_rock_acceleration(critical_angle: Any, friction: Any, inertia_ratio: Any = RECTANGLE) -> Any:
    """Base acceleration above which a block at rest starts to slide and rock at once.

    With s = sin θcr, c = cos θcr, and j = Io/(MR²), which is 4/3 for a rectangle,

    A* = (μ(1 − s²/j) − sc/j)/(1 − c²/j − μsc/j).

    Parameters
    ----------
    critical_angle : float or array
        Critical angle θcr in rad, in [0.0001, 1.57].
    friction : float or array
        Coefficient of friction μ, in [0.001, 10].
    inertia_ratio : float or array
        Io/(MR²), in [1, 10]. Default: 4/3. The arguments broadcast.

    Returns
    -------
    float or ndarray
        A* in units of g. NaN for μ ≤ tan θcr: such a block slides and does not rock. Infinite where no acceleration makes a block that
        rocks slide at once, 1 ≤ c²/j + μsc/j.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range, or if the shapes do not broadcast.

    See Also
    --------
    first_motion : Which of the four motions begins.
    rocking.slide : The slip of a block that slides.

    Notes
    -----
    The base accelerates with A g. A block that sticks turns about its edge with θ'' = g(Ac − s)/(jR) at the start, where θ' = 0. Its
    centre is c R above this edge and s R beside it. Relative to the base it moves back with cRθ'', and up with sRθ''. So the base pushes
    with H/M = Ag − cRθ'' and N/M = g + sRθ'', and H ≤ μN is

    A − c(Ac − s)/j ≤ μ(1 + s(Ac − s)/j).

    The terms with A together are A(1 − c²/j − μsc/j) ≤ μ(1 − s²/j) − sc/j. For μ = tan θcr this is A* = tan θcr, where the regions of
    all four motions meet. For μ > tan θcr the right side is positive, so that any A satisfies it if the bracket is not positive.

    References
    ----------
    Shenton (1996).

    Examples
    --------
    >>> import rocking as rk
    >>> round(slide_rock_acceleration(rk.Block(height=2.0, width=0.5).critical_angle, 0.3), 5)
    0.45732
    """
    angle, mu, inertia = together(
        critical_angle=between("critical_angle", critical_angle, *ANGLES),
        friction=between("friction", friction, *FRICTION.range),
        inertia_ratio=between("inertia_ratio", inertia_ratio, *INERTIA_RATIOS),
    )
    s, c = np.sin(angle), np.cos(angle)
    top = mu * (1.0 - s**2 / inertia) - s * c / inertia
    bottom = 1.0 - (c**2 + mu * s * c) / inertia
    with np.errstate(divide="ignore", invalid="ignore"):
        onset = np.where(bottom > 0.0, top / bottom, math.inf)
    return plain(np.where(mu > np.tan(angle), onset, math.nan))


def first_motion(
    critical_angle: Any, friction: Any, acceleration: Any, inertia_ratio: Any = RECTANGLE
) -> Any:
    """Motion that a block at rest begins when the base accelerates: "rest", "slide", "rock" or "slide-rock".

    It slides where μ ≤ tan θcr and A > μ. Where μ > tan θcr, it rocks if A > tan θcr, and also slides if A > A*
    (`slide_rock_acceleration`).

    Parameters
    ----------
    critical_angle : float or array
        Critical angle θcr in rad, in [0.0001, 1.57].
    friction : float or array
        Coefficient of friction μ, in [0.001, 10].
    acceleration : float or array
        Base acceleration in units of g, of either sign, of size up to 10⁶.
    inertia_ratio : float or array
        Io/(MR²), in [1, 10]. Default: 4/3, a rectangle. The arguments broadcast.

    Returns
    -------
    str or ndarray of str
        Motion that begins.

    Raises
    ------
    TypeError, ValueError
        As in `slide_rock_acceleration`.

    See Also
    --------
    slide_rock_acceleration : Where rocking begins to need more friction than there is.
    rocking.slide : The slip of a block that slides.

    References
    ----------
    Shenton (1996).

    Examples
    --------
    >>> import rocking as rk
    >>> angle = rk.Block(height=2.0, width=0.5).critical_angle
    >>> first_motion(angle, 0.3, [0.2, 0.4, 0.6]).tolist(), first_motion(angle, 0.2, 0.4)
    (['rest', 'rock', 'slide-rock'], 'slide')
    """
    onset = np.asarray(slide_rock_acceleration(critical_angle, friction, inertia_ratio))  # checks these
    size = np.abs(between("acceleration", acceleration, -MAX_ACCELERATION, MAX_ACCELERATION))
    values = together(
        critical_angle=critical_angle, friction=friction, inertia_ratio=inertia_ratio, acceleration=size
    )
    angle, mu, _, size = (each.astype(float) for each in values)
    level = np.tan(angle)
    sticks = mu > level
    onset = np.nan_to_num(onset, nan=math.inf, posinf=math.inf)
    code = np.where(sticks, 2 * (size > level) + (size > onset), size > mu)
    found = np.array(FIRST_MOTIONS)[code]
    return found if found.ndim else str(found)
