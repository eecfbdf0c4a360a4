"""Overview of a motion, for a notebook and for `rocking simulate --plot`."""

from __future__ import annotations

from matplotlib.figure import Figure

from rocking.model.block import Block
from rocking.model.forcing import Harmonic
from rocking.model.validation import instance
from rocking.model.verdict import Outcome
from rocking.motion.motion import Motion, has_cycles
from rocking.plot.parts import figures, style
from rocking.plot.parts.axis_units import quantities
from rocking.plot.parts.sample_times import settled
from rocking.plot.phase_portrait import phase_portrait
from rocking.plot.section import section
from rocking.plot.time_history import RATIOS, draw_with_base, time_history

CYCLES_SHOWN = 30


def overview(motion: Motion, block: Block | None = None) -> Figure:
    """Plot the time history and phase portrait of a motion, or its section or final state if only these were recorded.

    A bounded motion is shown by its last 30 cycles. A motion that comes to rest is shown until shortly after its last
    impact. Under a base motion of finite length the whole motion is shown, with the base acceleration below.

    Parameters
    ----------
    motion : Motion
        Motion with any setting of ``record``.
    block : Block, optional
        Block for SI axes. Default: normalised axes.

    Returns
    -------
    matplotlib Figure

    Raises
    ------
    TypeError
        If an argument has the wrong type.

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
    quantities(block)  # refused before there is a figure
    if motion.record != "all":
        figure, (ax,) = style.panels(height=3.0)
        kept = (
            motion.section() if motion.record == "section" else [(motion.final.angle, motion.final.velocity)]
        )
        forcing = motion.system.forcing
        section(kept, ax, block, phase=forcing.phase if isinstance(forcing, Harmonic) else None)
        return figure
    if not has_cycles(motion):
        return _with_base(motion, block)
    cycles = _cycles(motion)
    figure, (left, right) = style.panels(columns=2, height=3.0, ratios=(3, 2))
    time_history(motion, left, block, cycles)
    phase_portrait(motion, right, block, cycles)
    return figure


def _with_base(motion: Motion, block: Block | None) -> Figure:
    """Plot time history, base acceleration and phase portrait."""
    figure = figures.new(style.PAGE, 3.4)
    grid = figure.add_gridspec(2, 2, width_ratios=(3, 2), height_ratios=RATIOS)
    above = figure.add_subplot(grid[0, 0])
    below, right = figure.add_subplot(grid[1, 0], sharex=above), figure.add_subplot(grid[:, 1])
    for letter, ax in zip("abc", (above, below, right), strict=True):
        style.title(ax, f"({letter})")
    style.block_title(above, block, full=motion.system.critical_angle is not None)
    draw_with_base(above, below, motion, block)
    phase_portrait(motion, right, block)
    return figure


def _cycles(motion: Motion) -> tuple[float, float] | None:
    if motion.outcome is Outcome.AT_REST:
        return 0.0, min(settled(motion) / motion.system.periodic.period, motion.cycles)
    if motion.outcome is Outcome.BOUNDED and motion.cycles > CYCLES_SHOWN:
        return motion.cycles - CYCLES_SHOWN, motion.cycles
    return None
