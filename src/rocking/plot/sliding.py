"""Plots of sliding: the slip of a block under a base motion, and the first motion of a block over friction and acceleration."""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block, symmetric_block
from rocking.model.quantity import FRICTION
from rocking.model.validation import instance
from rocking.motion.sliding import Slip
from rocking.plot import palette, style
from rocking.theory import first_motion as motion_that_begins
from rocking.theory import slide_rock_acceleration

CM = 100.0
WIDEST, HIGHEST = 2.5, 5.0
"""Largest friction and acceleration drawn, in units of tan θcr."""
POINTS = 400
DIRECT: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": style.TEXT, "color": style.INK}


def slip(result: Slip, ax: Axes | None = None) -> Axes:
    """Plot the slip of a block over time, with bands where it slides.

    Parameters
    ----------
    result : Slip
        Result of `rocking.slide`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a Slip, or `ax` is not Axes.

    See Also
    --------
    rocking.slide : Compute the slip.

    Examples
    --------
    >>> import rocking as rk
    >>> result = rk.slide(rk.example_ground_motion().scaled(pga=5.0), friction=0.3)
    >>> rk.plot.slip(result).get_ylabel()
    'slip (cm)'
    """
    instance("result", result, Slip)
    ax = style.own(ax)
    for number, (start, end) in enumerate(result.intervals.tolist()):
        ax.axvspan(
            start,
            end,
            color=palette.TABLE,
            alpha=0.6,
            linewidth=0.0,
            label=None if number else "slides",
            gid="slides",
        )
    data = result.dataset
    ax.plot(
        data.time_s.values,
        CM * data.slip_m.values,
        color=palette.MOTION,
        linewidth=style.LINE,
        label=f"μ = {result.friction:g}",
        gid="slip",
    )
    ax.set_xlim(data.time_s.values[[0, -1]])
    style.label(ax, "time (s)", "slip (cm)")
    style.key(ax)
    return ax


def first_motion(block: Block, ax: Axes | None = None) -> Axes:
    r"""Plot which motion a block at rest begins, over the coefficient of friction and the base acceleration.

    Parameters
    ----------
    block : Block
        Symmetric block.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes
        The axes end at a friction of 2.5 tan θcr, or 10, and at an acceleration of 5 g tan θcr.

    Raises
    ------
    TypeError
        If `block` is not a Block, or `ax` is not Axes.
    ValueError
        If the block has unequal sides.

    See Also
    --------
    rocking.theory.first_motion : The motion as a word.
    rocking.theory.slide_rock_acceleration : The curve between rocking and slide-rock.

    References
    ----------
    Shenton (1996).

    Examples
    --------
    >>> import rocking as rk
    >>> ax = rk.plot.first_motion(rk.Block(height=2.0, width=0.5))
    >>> [text.get_text() for text in ax.texts]
    ['rest', 'slide', 'rock', 'slide-\nrock']
    """
    symmetric_block(block)
    ax = style.own(ax, height=2.9)
    level, inertia = math.tan(block.critical_angle), block.inertia_ratio
    last, top = min(WIDEST * level, FRICTION.range[1]), HIGHEST * level
    mu = np.linspace(level, last, POINTS)[1:]
    onset = np.asarray(slide_rock_acceleration(block.critical_angle, mu, inertia))
    seen = onset <= top
    seen[np.argmin(seen)] = True
    lines: dict[str, tuple[Any, Any]] = {
        "slide": ([0.0, level], [0.0, level]),
        "rock": ([level, last], [level, level]),
        "slide or rock": ([level, level], [level, top]),
        "slide-rock": (
            np.append(level, mu[seen]),
            np.append(level, np.where(np.isfinite(onset), onset, top)[seen]),
        ),
    }
    for name, (across, upward) in lines.items():
        ax.plot(across, upward, color=style.INK, linewidth=style.LINE, gid=name)
    ax.set_xlim(0.0, last)
    ax.set_ylim(0.0, top)
    grid = np.meshgrid(np.linspace(0.02, 0.98, 49) * last, np.linspace(0.02, 0.98, 49) * top)
    which = np.asarray(
        motion_that_begins(block.critical_angle, np.maximum(grid[0], FRICTION.range[0]), grid[1], inertia)
    )
    for name in ("rest", "slide", "rock", "slide-rock"):
        inside = which == name
        if name == "slide-rock":  # the region is wide enough for its name at the top
            inside &= grid[1] > 0.75 * top
        if inside.any():
            across, upward = (float(each[inside].mean()) for each in grid)
            ax.text(across, upward, name.replace("-", "-\n"), **DIRECT)
    style.block_title(ax, block)
    style.label(ax, FRICTION.label, "base acceleration (g)")
    return ax
