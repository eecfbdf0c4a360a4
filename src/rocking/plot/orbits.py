"""Periodic orbits of a system as points of a Poincaré section."""

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.forcing import MAX_PHASE
from rocking.model.orbit import Stability
from rocking.model.validation import instance, within
from rocking.orbits.find_orbits import Orbits
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities
from rocking.plot.section import at_phase

# Colour and marker of a stability; an unstable orbit is hollow.
LOOKS = {
    Stability.STABLE: (style.MOTION, "o"),
    Stability.NEUTRAL: (style.BRACE, "s"),
    Stability.UNSTABLE: (style.IMPACT, "o"),
}


def orbits(
    result: Orbits, ax: Axes | None = None, phase: float | None = None, block: Block | None = None
) -> Axes:
    """Plot the periodic orbits of a system at one forcing phase: one point per cycle of the period, hollow if unstable.

    Parameters
    ----------
    result : Orbits
        Result of `rocking.find_orbits`.
    ax : matplotlib Axes, optional
        Axes to draw into, for example those of `basins` or `section`. Default: a new figure, one column wide.
    phase : float, optional
        Forcing phase ψ of the section, rad. Default: the phase of the forcing.
    block : Block, optional
        Block for SI axes. Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not an Orbits.
    ValueError
        If `phase` lies outside its range.

    See Also
    --------
    section : Plot the section of a motion.
    rocking.find_orbits : Search for orbits.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> ax = rk.plot.orbits(rk.find_orbits(system, 1))
    >>> [text.get_text() for text in ax.get_legend().get_texts()]
    ['stable', 'unstable']
    """
    instance("result", result, Orbits)
    psi = result.system.periodic.phase if phase is None else within("phase", phase, -MAX_PHASE, MAX_PHASE)
    shown = quantities(block)
    ax = style.own(ax, height=2.9)
    for stability, (colour, marker) in LOOKS.items():
        states = [
            orbit.at(psi + 2.0 * np.pi * cycle)
            for orbit in result
            if orbit.stability is stability
            for cycle in range(orbit.period)
        ]
        if states:
            ax.plot(
                shown.angle(np.array([state.angle for state in states])),
                shown.velocity(np.array([state.velocity for state in states])),
                linestyle="none",
                marker=marker,
                markersize=style.MARK,
                markerfacecolor="white" if stability is Stability.UNSTABLE else colour,
                markeredgecolor=colour,
                label=str(stability),
                gid=str(stability),
            )
    style.label(ax, shown.angle_label, shown.velocity_label)
    style.note(ax, at_phase(psi))
    if len(result):
        style.key(ax)
    return ax
