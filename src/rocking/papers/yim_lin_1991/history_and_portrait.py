"""Layout of figures 4 to 6: time history beside phase portrait."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

import rocking as rk
from rocking.motion.motion import Motion
from rocking.papers.yim_lin_1991.cases import Case

# Half the length of an arrow, in forcing periods.
SHORT = 0.005


def draw_pair(
    case: Case,
    history: tuple[int, int] | None = None,
    portrait: tuple[int, int] | None = None,
    arrows: Sequence[float] = (),
    legend: bool = False,
) -> Figure:
    """Draw the time history and the phase portrait of a case over the cycles given; None is the whole motion.

    Arrows stand in the portrait at the cycles given. At e = 1 a legend of the impacts has one mark for both of its rows.
    """
    motion = case.motion()
    figure, (left, right) = rk.plot.panels(columns=2, height=3.0, ratios=(3, 2))
    rk.plot.time_history(motion, left, cycles=history)
    rk.plot.phase_portrait(motion, right, cycles=portrait)
    for cycle in arrows:
        draw_arrow(right, motion, cycle)
    if not legend:
        right.get_legend().remove()
    rk.plot.title(left, "time history")
    rk.plot.title(right, "phase portrait")
    return figure


def draw_arrow(ax: Axes, motion: Motion, cycle: float) -> None:
    """Draw an arrow in the direction of motion on a phase portrait, at a number of cycles from the start."""
    period = motion.system.harmonic.period
    tail, head = (motion.at((cycle + step) * period) for step in (-SHORT, SHORT))
    arrow = {
        "arrowstyle": "-|>",
        "color": rk.plot.palette.MOTION,
        "shrinkA": 0,
        "shrinkB": 0,
        "mutation_scale": 11,
    }
    ax.annotate("", head, tail, arrowprops=arrow)
