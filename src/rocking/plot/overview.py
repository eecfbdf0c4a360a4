"""A motion at a glance: in a notebook, and for `rocking simulate --plot`."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from rocking.model import Block
from rocking.plot import style
from rocking.plot.phase_portrait import phase_portrait
from rocking.plot.section import section
from rocking.plot.time_history import time_history

if TYPE_CHECKING:
    from rocking.motion import Motion

CYCLES_SHOWN = 30


def overview(motion: Motion, block: Block | None = None) -> Figure:
    """Draws what was kept of a motion: time history beside phase portrait; or the section; or only the final state.

    A bounded motion is shown by its last 30 cycles: whole, a long one would be a band of ink.

    Parameters
    ----------
    motion : Motion
        However recorded.
    block : Block, optional
        Gives SI axes; otherwise they are normalised.

    Returns
    -------
    matplotlib Figure

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> len(rk.plot.overview(rk.simulate(system, cycles=200)).axes)
    2
    """
    if motion.record != "all":
        figure, (ax,) = style.panels(height=3.0)
        kept = (
            motion.section() if motion.record == "section" else [(motion.final.angle, motion.final.velocity)]
        )
        section(kept, ax, block, phase=motion.system.forcing.phase)
        return figure
    long = motion.outcome == "bounded" and motion.cycles > CYCLES_SHOWN
    cycles = (motion.cycles - CYCLES_SHOWN, motion.cycles) if long else None
    figure, (left, right) = style.panels(columns=2, height=3.0, ratios=(3, 2))
    time_history(motion, left, block, cycles)
    phase_portrait(motion, right, block, cycles)
    return figure


def png(motion: Motion) -> bytes:
    """The overview as the bytes of a PNG, for a notebook."""
    stream = io.BytesIO()
    overview(motion).savefig(stream, format="png", dpi=110)
    return stream.getvalue()
