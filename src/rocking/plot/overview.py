"""Overview of a motion, for a notebook and for `rocking simulate --plot`."""

from __future__ import annotations

from matplotlib.figure import Figure

from rocking.model import Block, Outcome, instance
from rocking.motion import Motion
from rocking.plot.parts import style
from rocking.plot.parts.sample_times import settled
from rocking.plot.phase_portrait import phase_portrait
from rocking.plot.section import section
from rocking.plot.time_history import time_history

CYCLES_SHOWN = 30


def overview(motion: Motion, block: Block | None = None) -> Figure:
    """Plot the time history and phase portrait of a motion, or its section or final state if only these were recorded.

    A bounded motion is shown by its last 30 cycles. A motion that comes to rest is shown until shortly after its last
    impact.

    Parameters
    ----------
    motion : Motion
        Motion with any setting of ``record``.
    block : Block, optional
        Block for SI axes. Default: normalised axes.

    Returns
    -------
    matplotlib Figure

    See Also
    --------
    time_history : Plot the time history alone.
    phase_portrait : Plot the phase portrait alone.
    animation : Animate the motion.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> len(rk.plot.overview(rk.simulate(system, cycles=200)).axes)
    2
    """
    instance("motion", motion, Motion)
    if motion.record != "all":
        figure, (ax,) = style.panels(height=3.0)
        kept = (
            motion.section() if motion.record == "section" else [(motion.final.angle, motion.final.velocity)]
        )
        section(kept, ax, block, phase=motion.system.harmonic.phase)
        return figure
    cycles = _cycles(motion)
    figure, (left, right) = style.panels(columns=2, height=3.0, ratios=(3, 2))
    time_history(motion, left, block, cycles)
    phase_portrait(motion, right, block, cycles)
    return figure


def _cycles(motion: Motion) -> tuple[float, float] | None:
    if motion.outcome is Outcome.AT_REST:
        return 0.0, min(settled(motion) / motion.system.harmonic.period, motion.cycles)
    if motion.outcome is Outcome.BOUNDED and motion.cycles > CYCLES_SHOWN:
        return motion.cycles - CYCLES_SHOWN, motion.cycles
    return None
