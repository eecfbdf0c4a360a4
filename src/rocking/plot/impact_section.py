"""Impact sections: phase and speed of base impacts."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator

from rocking.model.block import Block
from rocking.model.validation import WrongType, refuse_if, whole
from rocking.motion.motion import Motion
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities
from rocking.response.impact_section import impact_section as impacts_of

SIDES = ((1, r"onto $\Theta > 0$", style.MOTION), (-1, r"onto $\Theta < 0$", style.IMPACT))
QUARTERS = ("0", r"$\pi/2$", r"$\pi$", r"$3\pi/2$", r"$2\pi$")


def impact_section(
    result: Motion | np.ndarray, ax: Axes | None = None, block: Block | None = None, transient: int = 0
) -> Axes:
    """Plot the impacts at Θ = 0: speed after the impact against forcing phase, one colour per side.

    Parameters
    ----------
    result : Motion or structured array
        Motion recorded with ``record="all"``, or the result of `rocking.impact_section`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for the speed in degrees per second. Default: normalised speed.
    transient : int
        Number of forcing cycles discarded at the start. Default: 0.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If `result` holds no impact after the transient.

    See Also
    --------
    section : Plot the stroboscopic section.
    rocking.impact_section : Compute the impacts.

    Notes
    -----
    Phase, speed and side are the complete state of the block just after an impact. Every point is drawn. Marks shrink as
    their number grows, and more than 2,000 become an image inside a vector file, as in `section`.

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
        raise WrongType("result", "be a Motion or what impact_section gives", result)
    refuse_if(not len(impacts), "result", "hold an impact after the transient", len(impacts))
    return impacts
