"""The layout of figures 4 to 6: time history beside phase diagram."""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import Case, cycles


def draw_pair(
    case: Case, history: tuple[int, int] | None = None, portrait: tuple[int, int] | None = None
) -> Figure:
    """Draws a case over the cycles given for (a) the time history and (b) the phase diagram; None is the whole motion."""
    motion = case.motion()
    figure, (left, right) = rk.plot.panels(columns=2, height=3.0, ratios=(3, 2))
    rk.plot.time_history(motion, left, cycles=history)
    rk.plot.phase_portrait(motion, right, cycles=portrait)
    rk.plot.title(left, f"{case.name}, {case.parameters}" + (f", {cycles(history)}" if history else ""))
    rk.plot.title(right, cycles(portrait) if portrait else "")
    return figure
