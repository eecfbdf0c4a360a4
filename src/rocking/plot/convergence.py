"""A running Lyapunov exponent against the cycles averaged over."""

import math

import numpy as np
from matplotlib.axes import Axes

from rocking.model import instance, plus_minus, refusal, whole
from rocking.plot.parts import style
from rocking.response import LyapunovSpectrum


def convergence(spectrum: LyapunovSpectrum, ax: Axes | None = None, exponent: int = 1) -> Axes:
    """Draws an exponent as it settles, with its error as a band, against the cycles averaged over.

    Parameters
    ----------
    spectrum : LyapunovSpectrum
        From `lyapunov`.
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.
    exponent : int
        1 for λ₁, 2 for λ₂; not one that is −∞.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If `spectrum` is none, or the exponent is −∞, or an argument is of another kind.

    See Also
    --------
    rocking.lyapunov : Compute the exponents.

    Notes
    -----
    There is no band where the batches so far are too few for an error. The dashed line is the final value; zero is
    drawn where it comes into view.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> ax = rk.plot.convergence(rk.lyapunov(system))
    >>> ax.get_xscale(), len(ax.lines)
    ('log', 2)
    """
    instance("spectrum", spectrum, LyapunovSpectrum)
    row = whole("exponent", exponent, 1, 2) - 1
    final, error = float(spectrum.values[row]), float(spectrum.errors[row])
    if final == -math.inf:
        raise ValueError(refusal("exponent", "be finite to be drawn", final))
    ax = style.own(ax)
    ax.set_xscale("log")
    history = spectrum.history
    cycles, values, errors = history["cycles"], history["values"][:, row], history["errors"][:, row]
    known = np.isfinite(errors)
    ax.fill_between(
        cycles[known],
        (values - errors)[known],
        (values + errors)[known],
        color=style.MOTION,
        alpha=0.3,
        linewidth=0,
        gid="error",
    )
    ax.axhline(final, color=style.GUIDE, linewidth=style.THIN, linestyle="--", gid="final")
    ax.plot(cycles, values, color=style.MOTION, linewidth=style.LINE, gid="running")
    low, high = ax.get_ylim()
    if low <= 0.0 <= high:
        ax.axhline(0.0, color=style.INK, linewidth=style.THIN, gid="zero")
    style.label(ax, "cycles averaged over", rf"exponent $\lambda_{exponent}$ per $\tau$")
    style.logarithmic(ax.xaxis)
    style.note(ax, rf"$\lambda_{exponent}$ = {plus_minus(final, error)}")
    return ax
