"""Convergence of a Lyapunov exponent with the number of cycles."""

import math

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.text import plus_minus
from rocking.model.validation import instance, whole
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import Quantities, quantities
from rocking.response.lyapunov import LyapunovSpectrum


def convergence(
    spectrum: LyapunovSpectrum, ax: Axes | None = None, exponent: int = 1, block: Block | None = None
) -> Axes:
    """Plot the running average of a Lyapunov exponent against the number of cycles, with its error as a band.

    Parameters
    ----------
    spectrum : LyapunovSpectrum
        Result of `lyapunov`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    exponent : int
        1 for λ₁, 2 for λ₂. Default: 1.
    block : Block, optional
        Block for exponents per second. Default: exponents per τ.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `spectrum` is not a LyapunovSpectrum, or an argument has the wrong type.
    ValueError
        If `exponent` is neither 1 nor 2.

    See Also
    --------
    rocking.lyapunov : Compute the exponents.

    Notes
    -----
    There is no band where the batches are too few for an error. The dashed line is the final value. A thin line marks
    zero if zero lies within the axes. An exponent of −∞ has no line. The axes then state the value and its cause.

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
    shown = quantities(block)
    final, error = (float(shown.frequency(each[row])) for each in (spectrum.values, spectrum.errors))
    ax = style.own(ax)
    ax.set_xscale("log")
    if final == -math.inf:
        _superstable(ax, spectrum.cycles)
    else:
        _running(ax, spectrum, row, shown)
    unit = r"per $\tau$" if block is None else "(1/s)"
    style.label(ax, "cycles averaged over", rf"exponent $\lambda_{exponent}$ {unit}")
    style.logarithmic(ax.xaxis)
    style.note(ax, rf"$\lambda_{exponent}$ = {plus_minus(final, error)}".replace("-", "−"))
    return ax


def _superstable(ax: Axes, cycles: int) -> None:
    """State in empty axes that there is no running average, because perturbations vanish."""
    ax.set(xlim=(1, max(cycles, 2)), yticks=[])
    cause = "no line: perturbations vanish while the block\nrests or stays in contact with a brace"
    ax.text(
        0.5, 0.5, cause, transform=ax.transAxes, ha="center", va="center", fontsize=style.SMALL, gid="cause"
    )


def _running(ax: Axes, spectrum: LyapunovSpectrum, row: int, shown: Quantities) -> None:
    """Draw the running average with its error, its final value, and zero if it lies within the axes."""
    history = spectrum.history
    cycles = history["cycles"]
    values, errors = (shown.frequency(history[name][:, row]) for name in ("values", "errors"))
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
    ax.axhline(
        float(shown.frequency(spectrum.values[row])),
        color=style.GUIDE,
        linewidth=style.THIN,
        linestyle="--",
        gid="final",
    )
    ax.plot(cycles, values, color=style.MOTION, linewidth=style.LINE, gid="running")
    low, high = ax.get_ylim()
    if low <= 0.0 <= high:
        ax.axhline(0.0, color=style.INK, linewidth=style.THIN, gid="zero")
