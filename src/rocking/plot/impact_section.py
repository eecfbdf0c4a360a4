"""Phase and speed of impacts."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator

from rocking.model import Block, refusal, whole
from rocking.motion import Motion
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities
from rocking.response import impact_section as impacts_of

SIDES = ((1, r"onto $\Theta > 0$", style.MOTION), (-1, r"onto $\Theta < 0$", style.IMPACT))
QUARTERS = ("0", r"$\pi/2$", r"$\pi$", r"$3\pi/2$", r"$2\pi$")


def impact_section(
    result: Motion | np.ndarray, ax: Axes | None = None, block: Block | None = None, transient: int = 0
) -> Axes:
    """Draws the impacts at Θ = 0: speed just after each against the forcing phase, the two sides in two colours.

    Parameters
    ----------
    result : Motion or structured array
        A motion (recorded with ``record="all"``), or what `rocking.impact_section` gives.
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.
    block : Block, optional
        Gives the speed in degrees per second; otherwise it is normalised.
    transient : int
        How many forcing cycles are left out at the start.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If `result` holds no impact after the transient, or an argument is of another kind.

    See Also
    --------
    section : Plot the stroboscopic section.
    rocking.impact_section : Compute the impacts.

    Notes
    -----
    Phase, speed and side together are the state of the block just after an impact. Every point is drawn; marks
    shrink, and more than 2,000 are an image inside a vector file, as in `section`.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> ax = rk.plot.impact_section(rk.simulate(system, cycles=900), transient=600)
    >>> [len(line.get_xdata()) for line in ax.lines]
    [100, 100]
    """
    impacts = _impacts(result, transient)
    shown = quantities(block)
    ax = style.own(ax, height=2.9)
    size = style.point_size(style.places(impacts["phase"], impacts["after"]))
    for side, name, colour in SIDES:
        onto = impacts[np.sign(impacts["after"]) == side]
        if not len(onto):
            continue
        ax.plot(
            onto["phase"],
            shown.velocity(np.abs(onto["after"])),
            linestyle="none",
            marker="o",
            markersize=size,
            markeredgewidth=0,
            color=colour,
            rasterized=len(impacts) > style.MAX_MARKS,
            label=name,
            gid=f"impact section {side:+d}",
        )
    style.label(ax, r"forcing phase $\psi$ (rad)", shown.speed_label)
    ax.set_xlim(-0.1, 2 * math.pi + 0.1)
    ax.xaxis.set_major_locator(FixedLocator([quarter * math.pi / 2 for quarter in range(5)]))
    ax.set_xticklabels(QUARTERS)
    ax.set_ylim(0.0, 1.08 * float(shown.velocity(np.abs(impacts["after"]).max())) or 1.0)
    style.key(ax)
    return ax


def _impacts(result, transient) -> np.ndarray:
    if isinstance(result, Motion):
        impacts = impacts_of(result, transient=transient)
    elif isinstance(result, np.ndarray) and {"cycle", "phase", "after"} <= set(result.dtype.names or ()):
        last = int(result["cycle"].max(initial=0))
        impacts = result[result["cycle"] >= whole("transient", transient, 0, last)]
    else:
        raise TypeError(refusal("result", "be a Motion or what impact_section gives", result))
    if not len(impacts):
        raise ValueError(refusal("result", "hold an impact after the transient", len(impacts)))
    return impacts
