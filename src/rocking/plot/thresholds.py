"""Amplitudes at which something changes, over the period of the forcing."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from rocking.model import Block, reals, refusal
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import parameter

# Colours, and dashes that tell them apart without colours.
LINES = (
    (style.MOTION, "-"),
    (style.IMPACT, "-"),
    (style.MOTION, (0, (5, 2))),
    (style.IMPACT, (0, (5, 2))),
    (style.BRACE, (0, (6, 2, 1, 2))),
    (style.INK, (0, (3, 1, 1, 1, 1, 1))),
)


def thresholds(
    periods: ArrayLike,
    curves: Mapping[str, ArrayLike | tuple[ArrayLike, ArrayLike]],
    ax: Axes | None = None,
    block: Block | None = None,
) -> Axes:
    """Draws amplitudes over the period, such as those that bound modes.

    Parameters
    ----------
    periods : array
        T, increasing.
    curves : dict
        By label, A at each period, NaN where there is none; or a pair of them and of booleans, dotted where False. Up to six.
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.
    block : Block, optional
        Gives SI axes, s and m/s²; otherwise they are normalised.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If there is no curve or too many, a curve and the periods differ in length, or an argument is of another kind.

    See Also
    --------
    parametric_map : Plot theoretical curves over a map.
    rocking.theory.melnikov_amplitude : Compute A_M.
    rocking.theory.symmetry_breaking_amplitude : Compute A_SB.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> periods = np.linspace(0.2, 3.0, 100)
    >>> breaking = rk.theory.symmetry_breaking_amplitude(periods, 0.9, 1)
    >>> ax = rk.plot.thresholds(periods, {"mode (1,1) stable below": breaking})
    >>> len(ax.lines)
    1
    """
    (turn_across, x_label), (turn_up, y_label) = (parameter(name, block) for name in ("period", "amplitude"))
    across = np.asarray(reals("periods", periods))
    if not isinstance(curves, Mapping):
        raise TypeError(refusal("curves", "be a dict of amplitudes by label", curves))
    if not 1 <= len(curves) <= len(LINES):
        raise ValueError(refusal("curves", f"hold 1 to {len(LINES)} of them", len(curves)))
    ax = style.own(ax, height=2.9)
    for (name, curve), (colour, dashes) in zip(curves.items(), LINES, strict=False):
        amplitudes, holds = curve if isinstance(curve, tuple) else (curve, np.ones(across.shape, bool))
        values, holds = np.asarray(reals("curves", amplitudes)), np.asarray(holds, bool)
        if not across.ndim == values.ndim == holds.ndim == 1 or not len(across) == len(values) == len(holds):
            raise ValueError(
                refusal("curves", f"have one amplitude a period, {across.size}", f"{name}: {values.size}")
            )
        up = turn_up(values)
        for part, how, label in ((holds, dashes, name), (~holds, style.DOTTED, None)):
            if part.any():
                # one point more, so that no gap is left where the dots begin
                drawn = part | np.concatenate(([False], part[:-1]))
                line = np.where(drawn, up, np.nan)
                ax.plot(
                    turn_across(across), line, color=colour, linestyle=how, label=label, linewidth=style.LINE
                )
    style.label(ax, x_label, y_label)
    style.key(ax)
    return ax
