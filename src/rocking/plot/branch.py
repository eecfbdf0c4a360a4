"""Branches of periodic orbits over the continuation parameter, with their special points."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from rocking.model.block import Block
from rocking.model.forcing import MAX_PHASE
from rocking.model.orbit import Stability
from rocking.model.validation import Refusal, one_of, within
from rocking.orbits.branch import Branch
from rocking.plot.parts import branch_lines, style
from rocking.plot.parts.axis_units import parameter, quantities

# Type of special point: marker, whether it is filled, name.
MARKERS = {
    "fold": ("o", False, "fold"),
    "symmetry-breaking": ("s", True, "symmetry breaking"),
    "period-doubling": ("^", True, "period doubling"),
    "grazing": ("x", False, "grazing"),
}
COLOURS = {True: style.MOTION, False: style.IMPACT}


def branch(
    result: Branch | Sequence[Branch],
    ax: Axes | None = None,
    quantity: str = "peak",
    phase: float = 0.0,
    block: Block | None = None,
) -> Axes:
    """Plot branches of periodic orbits: stable solid, unstable dashed, neutral dash-dotted, one marker per special point.

    Parameters
    ----------
    result : Branch or sequence of Branch
        Results of `continue_orbit` and `switch_branch`, over one parameter.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    quantity : {"peak", "angle", "velocity", "multiplier"}
        Quantity to draw: the largest |Θ|; Θ or Θ' at the section, one line per cycle of the period; or the modulus |μ| of the
        largest Floquet multiplier on a logarithmic axis, with a line at 1. Default: "peak".
    phase : float
        Forcing phase ψ of the section, rad. Default: 0.
    block : Block, optional
        Block for SI axes. Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` holds anything but branches.
    ValueError
        If the branches have different parameters, `quantity` is unknown, or `phase` lies outside its range. If `quantity` is
        "multiplier" for orbits that rest.

    See Also
    --------
    orbit_diagram : Plot branches over an orbit diagram.
    rocking.continue_orbit : Compute a branch.
    rocking.switch_branch : Compute the branches at a special point.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> symmetric = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    >>> pair = rk.switch_branch(symmetric.special[0], (10, 30))
    >>> ax = rk.plot.branch([symmetric, *pair], quantity="angle")
    >>> [text.get_text() for text in ax.get_legend().get_texts()][:3]
    ['symmetric, stable', 'symmetric, unstable', 'asymmetric, stable']
    """
    branches = _branches(result)
    quantity = one_of("quantity", quantity, (*branch_lines.QUANTITIES, "multiplier"))
    if quantity == "multiplier" and not any(one.points["multipliers"].any() for one in branches):
        allowed = (
            "be another one for orbits that rest or stay in contact with a brace: their multipliers are 0"
        )
        raise Refusal("quantity", allowed, quantity)
    phase = within("phase", phase, -MAX_PHASE, MAX_PHASE)
    shown = quantities(block)
    across, x_label = parameter(branches[0].name, block)
    scales: dict[str, Callable[[Any], Any]] = {"velocity": shown.velocity, "multiplier": np.asarray}
    upright = scales.get(quantity, shown.angle)
    ax = style.own(ax, height=3.0)
    if quantity == "multiplier":
        ax.set_yscale("log")
        ax.axhline(1.0, color=style.TABLE, linewidth=0.8, gid="unit")
    for one in sorted(branches, key=lambda one: not one.symmetric):
        line = branch_lines.line(one, quantity, phase).shown(across, upright)
        for stability in Stability:
            name = f"{'' if one.symmetric else 'a'}symmetric, {stability}"
            branch_lines.part(
                ax, line, stability, name, color=COLOURS[one.symmetric], linewidth=style.LINE, gid=name
            )
    _marks(ax, branches, lambda orbit: upright(branch_lines.heights_of(orbit, quantity, phase)), across)
    if quantity == "multiplier":
        low, high = ax.get_ylim()
        ax.set_ylim(min(low, 0.5), max(high, 2.0))  # rounding of a modulus of 1 does not fill the axis
        style.logarithmic(ax.yaxis)
        if max(high, 2.0) < 100.0 * min(low, 0.5):
            ax.yaxis.set_major_formatter(FuncFormatter(lambda modulus, _: f"{modulus:g}"))
    style.label(ax, x_label, branch_lines.height_label(quantity, shown))
    style.key(ax)
    return ax


def _branches(result: Branch | Sequence[Branch]) -> list[Branch]:
    branches = branch_lines.several(result, Branch)
    for one in branches:
        if one.name != branches[0].name:
            raise Refusal("result", f"hold branches over one parameter, {branches[0].name}", one.name)
    return branches


def _marks(ax: Axes, branches: Sequence[Branch], heights, across) -> None:
    """Draw a marker on every special point, at each of its states on the section."""
    for kind, (marker, filled, name) in MARKERS.items():
        found = [special for one in branches for special in one._passages if special.kind == kind]
        if not found:
            continue
        points = [
            (across(special.parameter), height) for special in found for height in heights(special.orbit)
        ]
        ax.plot(
            *np.array(points, float).T,
            linestyle="none",
            marker=marker,
            markersize=style.MARK,
            markerfacecolor=style.INK if filled else "white",
            markeredgecolor=style.INK,
            markeredgewidth=0.8,
            label=name,
            gid=kind,
            zorder=3,
        )
