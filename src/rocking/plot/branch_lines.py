"""Plots of branches of periodic orbits over a parameter: branches, cascades, frequency responses; found orbits."""

from collections.abc import Callable, Sequence
from itertools import cycle
from typing import Any, NamedTuple, TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from rocking.model.block import Block
from rocking.model.orbit import Orbit, Stability
from rocking.model.quantity import PHASE
from rocking.model.validation import Refusal, WrongType, instance, one_of
from rocking.model.verdict import Kind
from rocking.orbits.branch import BRANCHES_OFF, Branch
from rocking.orbits.cascade import Cascade
from rocking.orbits.find_orbits import Orbits
from rocking.orbits.frequency_response import FrequencyResponse
from rocking.orbits.special_points import FOLD, GRAZING, PERIOD_DOUBLING, SYMMETRY_BREAKING
from rocking.plot import palette, style
from rocking.plot.axes import Units, parameter, units_of
from rocking.plot.palette import COLOURS
from rocking.plot.sections import at_phase

Drawn = TypeVar("Drawn")

COLUMNS = {"angle": 0, "velocity": 1}
QUANTITIES = (*COLUMNS, "peak")
DASHES: dict[Stability, Any] = {
    Stability.STABLE: "-",
    Stability.NEUTRAL: (0, (5, 1.5, 1, 1.5)),
    Stability.UNSTABLE: (0, (4, 2)),
}


def height_label(quantity: str, units: Units) -> str:
    """Return the label of the vertical axis for a quantity of an orbit."""
    if quantity == "multiplier":
        return r"largest Floquet multiplier $|\mu|$"
    if quantity == "peak":
        symbol, _, unit = units.angle_label.partition("$")[2].partition("$")
        return f"largest $|{symbol.split(' = ')[0]}|${unit}"
    return units.velocity_label if quantity == "velocity" else units.angle_label


class Line(NamedTuple):
    """Branch as it is drawn: one row per orbit, and one more row at each special point, ``between`` two stabilities."""

    values: np.ndarray
    stability: np.ndarray
    heights: np.ndarray
    between: np.ndarray

    def scaled(self, across: Callable[[Any], Any], upright: Callable[[Any], Any]) -> "Line":
        """Return the line in the units of the axes."""
        return self._replace(values=across(self.values), heights=upright(self.heights))


def branch_line(branch: Branch, quantity: str, phase: float) -> Line:
    """Return a branch as one line per cycle of its period, or as one line of its peaks or largest multipliers."""
    points = branch.points
    values, stability = points["parameter"], points["stability"]
    if quantity in COLUMNS:
        heights = branch.section(phase)[:, :, COLUMNS[quantity]]
    else:
        own = points["peak"] if quantity == "peak" else np.abs(points["multipliers"]).max(axis=1)
        heights = own[:, None]
    inner = [one for one in branch._passages if one.kind != GRAZING and 0 < one.index < len(values)]
    places = np.array([one.index for one in inner], int)
    added = np.array([one.parameter for one in inner], float)
    start, span = values[places - 1], values[places] - values[places - 1]
    share = np.divide(added - start, span, out=np.full(len(inner), 0.5), where=span != 0.0)
    share[(share < 0.0) | (share > 1.0)] = 0.5  # a fold lies beyond both of its neighbours
    tips = heights[places - 1] + share[:, None] * (heights[places] - heights[places - 1])
    between = np.zeros(len(values), bool)
    between[0] = branch.ends[0] == BRANCHES_OFF  # at a multiplier of 1
    return Line(
        np.insert(values, places, added),
        np.insert(stability, places, Stability.UNSTABLE),
        np.insert(heights, places, tips, axis=0),
        np.insert(between, places, True),
    )


def heights_of(orbit: Orbit, quantity: str, phase: float) -> np.ndarray:
    """Return the heights of one orbit: its peak or largest multiplier, or its angle or velocity at each section."""
    if quantity == "multiplier":
        return np.array([max(abs(value) for value in orbit.multipliers)])
    if quantity == "peak":
        return np.array([orbit.motion().peak])
    states = [orbit.at(phase + 2.0 * np.pi * cycle) for cycle in range(orbit.period)]
    return np.array([getattr(state, quantity) for state in states])


def part(ax: Axes, drawn: Line, stability: Stability, label: str, **look: Any) -> None:
    """Draw the parts of a branch that have one stability, one line per column, up to the change of stability.

    Only the first line with a label appears in the legend.
    """
    here = (drawn.stability == stability) & ~drawn.between
    near = np.zeros(len(here), bool)
    near[1:] |= here[:-1]
    near[:-1] |= here[1:]
    # where the change itself is not among the special points, the unstable part fills the gap
    own = here | (near & (drawn.between | (stability is Stability.UNSTABLE)))
    if not here.any():
        return
    heights = np.where(own[:, None], drawn.heights, np.nan)
    lines = ax.plot(drawn.values, heights, linestyle=DASHES[stability], **look)
    lines[0].set_label(unless_there(ax, label))


def unless_there(ax: Axes, label: str) -> str:
    """Return a label, or a hidden one if the axes have that label already."""
    return "_" if label in ax.get_legend_handles_labels()[1] else label


def spans(values: np.ndarray, where: np.ndarray) -> np.ndarray:
    """Return the ends of all runs of chosen values, with NaN after each pair.

    An end lies half-way to the next value, or at the last value.
    """
    edges = np.concatenate([values[:1], 0.5 * (values[1:] + values[:-1]), values[-1:]])
    chosen = np.concatenate([[False], where, [False]])
    begins, ends = np.flatnonzero(~chosen[:-1] & chosen[1:]), np.flatnonzero(chosen[:-1] & ~chosen[1:])
    return np.column_stack([edges[begins], edges[ends], np.full(len(begins), np.nan)]).ravel()


def several(result: Any, kind: type[Drawn]) -> list[Drawn]:
    """Return one or several results of a type as a list; raise TypeError for any other argument."""
    each = [result] if isinstance(result, kind) else list(result) if np.iterable(result) else []
    if not each or not all(isinstance(one, kind) for one in each):
        raise WrongType("result", f"be a {kind.__name__} or a sequence of them", result)
    return each


# Type of special point: marker, whether it is filled, name.
MARKERS = {
    FOLD: ("o", False, "fold"),
    SYMMETRY_BREAKING: ("s", True, "symmetry breaking"),
    PERIOD_DOUBLING: ("^", True, "period doubling"),
    GRAZING: ("x", False, "grazing"),
}
COLOURS_BY_SYMMETRY = {True: style.MOTION, False: style.IMPACT}


def branch(
    result: Branch | Sequence[Branch],
    ax: Axes | None = None,
    block: Block | None = None,
    *,
    quantity: str = "peak",
    phase: float = 0.0,
) -> Axes:
    """Plot branches of periodic orbits: stable solid, unstable dashed, neutral dash-dotted, one marker per special point.

    Parameters
    ----------
    result : Branch or sequence of Branch
        Results of `continue_orbit` and `switch_branch`, over one parameter.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.
    quantity : {"peak", "angle", "velocity", "multiplier"}
        Quantity to draw: the largest |Θ|; Θ or Θ' at the section, one line per cycle of the period; or the modulus |μ| of the
        largest Floquet multiplier on a logarithmic axis, with a line at 1. Default: "peak".
    phase : float
        Forcing phase ψ of the section, rad. Default: 0.

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
    quantity = one_of("quantity", quantity, (*QUANTITIES, "multiplier"))
    if quantity == "multiplier" and not any(one.points["multipliers"].any() for one in branches):
        allowed = (
            "be another one for orbits that rest or stay in contact with a brace: their multipliers are 0"
        )
        raise Refusal("quantity", allowed, quantity)
    phase = PHASE.checked(phase)
    units = units_of(block)
    across, x_label = parameter(branches[0].name, block)
    scales: dict[str, Callable[[Any], Any]] = {"velocity": units.velocity, "multiplier": np.asarray}
    upright = scales.get(quantity, units.angle)
    ax = style.own(ax, height=3.0)
    if quantity == "multiplier":
        ax.set_yscale("log")
        ax.axhline(1.0, color=style.TABLE, linewidth=0.8, gid="unit")
    for one in sorted(branches, key=lambda one: not one.symmetric):
        line = branch_line(one, quantity, phase).scaled(across, upright)
        for stability in Stability:
            name = f"{'' if one.symmetric else 'a'}symmetric, {stability}"
            part(
                ax,
                line,
                stability,
                name,
                color=COLOURS_BY_SYMMETRY[one.symmetric],
                linewidth=style.LINE,
                gid=name,
            )
    _marks(ax, branches, lambda orbit: upright(heights_of(orbit, quantity, phase)), across)
    if quantity == "multiplier":
        low, high = ax.get_ylim()
        ax.set_ylim(min(low, 0.5), max(high, 2.0))  # rounding of a modulus of 1 does not fill the axis
        style.logarithmic(ax.yaxis)
        if max(high, 2.0) < 100.0 * min(low, 0.5):
            ax.yaxis.set_major_formatter(FuncFormatter(lambda modulus, _: f"{modulus:g}"))
    style.label(ax, x_label, height_label(quantity, units))
    style.key(ax)
    return ax


def _branches(result: Branch | Sequence[Branch]) -> list[Branch]:
    branches = several(result, Branch)
    for one in branches:
        if one.name != branches[0].name:
            raise Refusal("result", f"hold branches over one parameter, {branches[0].name}", one.name)
    return branches


def _marks(ax: Axes, branches: Sequence[Branch], heights, across) -> None:
    """Draw a marker on every special point, at each of its states on the section."""
    for kind, (marker, filled, name) in MARKERS.items():
        rows = [special for one in branches for special in one._passages if special.kind == kind]
        if not rows:
            continue
        points = [
            (across(special.parameter), height) for special in rows for height in heights(special.orbit)
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


FEIGENBAUM = 4.669201609
"""Limit of the ratio of neighbouring distances with losses (Feigenbaum 1978, J. Stat. Phys. 19, 25)."""
AREA_PRESERVING = 8.721097201
"""Limit of this ratio without losses (Greene et al. 1981, Physica D 3, 468)."""


def cascade(result: Cascade, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the distance of each period doubling to the next one over the period, and the universal ratio of these distances.

    Parameters
    ----------
    result : Cascade
        Result of `rocking.cascade`, with two period doublings or more.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes and a title. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a Cascade, or an argument has the wrong type.
    ValueError
        If there are fewer than two period doublings, so that there is no distance.

    See Also
    --------
    branch : Plot branches.
    rocking.cascade : Follow a cascade.

    Notes
    -----
    Both axes are logarithmic, so that a constant ratio is a straight line. The dashed line passes through the last distance. Its
    ratio is 4.669 with losses (Feigenbaum 1978) and 8.721 without (Greene et al. 1981).

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=10.46, period=1.721328), restitution=0.8)
    >>> doubling = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10.3, 10.9)).special[0]
    >>> rk.plot.cascade(rk.cascade(doubling, (10.3, 10.9), doublings=4)).get_ylabel()
    'distance in amplitude $A$'
    """
    instance("result", result, Cascade)
    if len(result.special) < 2:
        raise Refusal("result", "hold two period doublings or more to be drawn", len(result.special))
    special = result.special[0]
    turn, shown_as = parameter(special.name, block)
    distances = np.abs(np.diff(turn(result.values)))
    periods = result.periods[:-1]
    system = special.orbit.system
    braces = 1.0 if system.braces is None else system.braces.restitution
    ratio = AREA_PRESERVING if system.restitution == braces == 1.0 else FEIGENBAUM
    ax = style.own(ax, height=2.9)
    style.block_title(ax, block)
    ax.plot(
        periods,
        distances[-1] * ratio ** np.log2(periods[-1] / periods),
        color=style.INK,
        linewidth=style.LINE,
        linestyle=(0, (5, 2)),
        label=f"ratio {ratio:.3f}",
        gid="universal",
    )
    ax.plot(
        periods,
        distances,
        "o",
        color=style.MOTION,
        markersize=style.MARK,
        label="to next doubling",
        gid="distances",
    )
    # in one line, the label of a coefficient of restitution is longer than the figure is high
    distance = f"distance in {shown_as}".replace(" coefficient", "\ncoefficient")
    style.label(ax, "period of the orbit (forcing cycles)", distance)
    ax.set_xscale("log", base=2)
    ax.set_xticks(periods, [f"{period}" for period in periods])
    ax.set_yscale("log")
    style.logarithmic(ax.yaxis)
    style.key(ax)
    return ax


# Colour and marker of a stability; an unstable orbit is hollow.
LOOKS = {
    Stability.STABLE: (style.MOTION, "o"),
    Stability.NEUTRAL: (style.BRACE, "s"),
    Stability.UNSTABLE: (style.IMPACT, "o"),
}


def orbits(
    result: Orbits, ax: Axes | None = None, block: Block | None = None, *, phase: float | None = None
) -> Axes:
    """Plot the periodic orbits of a system at one forcing phase: one point per cycle of the period, hollow if unstable.

    Parameters
    ----------
    result : Orbits
        Result of `rocking.find_orbits`.
    ax : matplotlib Axes, optional
        Axes to draw into, for example those of `basins` or `section`. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.
    phase : float, optional
        Forcing phase ψ of the section, rad. Default: the phase of the forcing.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not an Orbits.
    ValueError
        If `phase` lies outside its range.

    See Also
    --------
    section : Plot the section of a motion.
    rocking.find_orbits : Search for orbits.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> ax = rk.plot.orbits(rk.find_orbits(system, 1))
    >>> [text.get_text() for text in ax.get_legend().get_texts()]
    ['stable', 'unstable']
    """
    instance("result", result, Orbits)
    psi = result.system.periodic.phase if phase is None else PHASE.checked(phase)
    units = units_of(block)
    ax = style.own(ax, height=2.9)
    for stability, (colour, marker) in LOOKS.items():
        states = [
            orbit.at(psi + 2.0 * np.pi * cycle)
            for orbit in result
            if orbit.stability is stability
            for cycle in range(orbit.period)
        ]
        if states:
            ax.plot(
                units.angle(np.array([state.angle for state in states])),
                units.velocity(np.array([state.velocity for state in states])),
                linestyle="none",
                marker=marker,
                markersize=style.MARK,
                markerfacecolor="white" if stability is Stability.UNSTABLE else colour,
                markeredgecolor=colour,
                label=str(stability),
                gid=str(stability),
            )
    style.label(ax, units.angle_label, units.velocity_label)
    style.note(ax, at_phase(psi))
    if len(result):
        style.key(ax)
    return ax


# One colour for each n.
LINES = palette.SERIES[:-1]
# Position of the bar that marks overturning, and the room for it below the lines, as fractions of the axes' height.
BAR, ROOM = 0.02, 0.06
THICK = 2.0


def frequency_response(result: FrequencyResponse, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the largest |Θ| over period or frequency: stable orbits solid, unstable dashed, responses from rest as rings.

    Parameters
    ----------
    result : FrequencyResponse
        Result of `rocking.frequency_response`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a FrequencyResponse, or an argument has the wrong type.

    See Also
    --------
    branch : Plot branches.
    rocking.frequency_response : Compute the curve.

    Notes
    -----
    A ring shows the largest |Θ| of the response if it is periodic or at rest. For other responses it shows the largest |Θ| of
    the motion from its start. A bar at the bottom marks overturning from rest.

    Examples
    --------
    >>> import numpy as np, rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.frequency_response(system, period=np.linspace(0.5, 2.5, 9))
    >>> [text.get_text() for text in rk.plot.frequency_response(result).get_legend().get_texts()]
    ['(1, 1), stable', '(1, 3), stable', '(1, 3), unstable', 'from rest: periodic', 'from rest: overturned']
    """
    instance("result", result, FrequencyResponse)
    units = units_of(block)
    across, x_label = parameter(result.parameter, block)
    ax = style.own(ax, height=3.0)
    for n, colour in zip(result.modes, cycle(LINES), strict=False):
        for stability in Stability:
            name = f"(1, {n}), {stability}"
            for branch in result.of(n):
                line = branch_line(branch, "peak", 0.0).scaled(across, units.angle)
                part(ax, line, stability, name, color=colour, linewidth=style.LINE, gid=name)
    _from_rest(ax, result, across, units.angle)
    style.label(ax, x_label, height_label("peak", units))
    low, high = ax.get_ylim()
    ax.set_ylim(min(low, 0.0) - ROOM * (high - low), high)
    style.key(ax)
    return ax


def _from_rest(ax: Axes, result: FrequencyResponse, across, upright) -> None:
    """Draw a ring for each response from rest, in the colour of its type, and bars where the block overturns."""
    rest, values = result.rest, result.values
    heights = np.where(np.isnan(rest["steady_peak"]), rest["peak"], rest["steady_peak"])
    for kind, colour in COLOURS.items():
        here = rest["kind"] == kind.value
        if kind is Kind.OVERTURNED or not here.any():
            continue
        ax.plot(
            across(values[here]),
            upright(heights[here]),
            linestyle="none",
            marker="o",
            markersize=0.75 * style.MARK,
            markerfacecolor="none",
            markeredgecolor=colour,
            markeredgewidth=0.6,
            label=f"from rest: {kind.value}",
            gid=f"rest {kind.value}",
            zorder=2.5,
        )
    fell = rest["kind"] == Kind.OVERTURNED.value
    if fell.any():
        ends = spans(values, fell)
        ax.plot(
            across(ends),
            np.full(len(ends), BAR),
            transform=ax.get_xaxis_transform(),
            color=COLOURS[Kind.OVERTURNED],
            linewidth=THICK,
            solid_capstyle="butt",
            label="from rest: overturned",
            gid="overturned",
        )
