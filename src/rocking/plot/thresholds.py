"""Threshold amplitudes over the forcing period."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from rocking.model.block import Block
from rocking.model.validation import Refusal, WrongType, reals, refuse_if
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import parameter

# Two colours by three dashes: curves in pairs, such as two thresholds at three coefficients of restitution.
LINES = tuple(
    (colour, dashes)
    for dashes in ("-", (0, (5, 2)), (0, (6, 2, 1, 2)))
    for colour in (style.MOTION, style.IMPACT)
)


def thresholds(
    periods: ArrayLike,
    curves: Mapping[str, ArrayLike | tuple[ArrayLike, ArrayLike]],
    ax: Axes | None = None,
    block: Block | None = None,
) -> Axes:
    """Plot threshold amplitudes over the forcing period.

    Parameters
    ----------
    periods : array
        Forcing periods T, increasing.
    curves : dict
        One to six curves by label. A curve is the amplitude A at each period, NaN where it does not exist. A pair of
        amplitudes and booleans is dotted where the boolean is False. Curves 1 and 2, 3 and 4, 5 and 6 share a dash. Odd
        and even curves have one colour each.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes, s and m/s². Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `curves` is not a dict, or an argument has the wrong type.
    ValueError
        If there is no curve or more than six, or a curve and the periods differ in length.

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
    >>> ax = rk.plot.thresholds(periods, {"(1, 1) mode stable below": breaking})
    >>> len(ax.lines)
    1
    """
    (turn_across, x_label), (turn_up, y_label) = (parameter(name, block) for name in ("period", "amplitude"))
    across = np.asarray(reals("periods", periods))
    if not isinstance(curves, Mapping):
        raise WrongType("curves", "be a dict of amplitudes by label", curves)
    refuse_if(not 1 <= len(curves) <= len(LINES), "curves", f"hold 1 to {len(LINES)} of them", len(curves))
    checked = {name: _curve(name, curve, across) for name, curve in curves.items()}
    ax = style.own(ax, height=2.9)
    for (name, (values, holds)), (colour, dashes) in zip(checked.items(), LINES, strict=False):
        up = turn_up(values)
        for part, how, label in ((holds, dashes, name), (~holds, style.DOTTED, None)):
            if part.any():
                # one point more, so that no gap remains where the dots begin
                drawn = part | np.concatenate(([False], part[:-1]))
                line = np.where(drawn, up, np.nan)
                ax.plot(
                    turn_across(across), line, color=colour, linestyle=how, label=label, linewidth=style.LINE
                )
    style.label(ax, x_label, y_label)
    style.key(ax)
    return ax


def _curve(name: str, curve: Any, across: NDArray) -> tuple[NDArray, NDArray]:
    """Return the amplitudes of a curve, and where they are valid; raise if they do not fit the periods."""
    amplitudes, holds = curve if isinstance(curve, tuple) else (curve, np.ones(across.shape, bool))
    values, holds = np.asarray(reals("curves", amplitudes)), np.asarray(holds, bool)
    if not across.ndim == values.ndim == holds.ndim == 1 or not len(across) == len(values) == len(holds):
        raise Refusal("curves", f"have one amplitude per period, {across.size}", f"{name}: {values.size}")
    return values, holds
