"""Parts shared by the plots over a parameter: the axis, and branches of orbits as lines, one dash per stability."""

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numpy as np
from matplotlib.axes import Axes

from rocking.model.orbit import Orbit, Stability
from rocking.model.validation import WrongType
from rocking.orbits.branch import BRANCHES_OFF, Branch
from rocking.plot.parts.axis_units import Quantities

Drawn = TypeVar("Drawn")

COLUMNS = {"angle": 0, "velocity": 1}
QUANTITIES = (*COLUMNS, "peak")
DASHES: dict[Stability, Any] = {
    Stability.STABLE: "-",
    Stability.NEUTRAL: (0, (5, 1.5, 1, 1.5)),
    Stability.UNSTABLE: (0, (4, 2)),
}


def height_label(quantity: str, shown: Quantities) -> str:
    """Return the label of the vertical axis for a quantity of an orbit."""
    if quantity == "multiplier":
        return r"largest Floquet multiplier $|\mu|$"
    if quantity == "peak":
        symbol, _, unit = shown.angle_label.partition("$")[2].partition("$")
        return f"largest $|{symbol.split(' = ')[0]}|${unit}"
    return shown.velocity_label if quantity == "velocity" else shown.angle_label


class Line(NamedTuple):
    """Branch as it is drawn: one row per orbit, and one more row at each special point, ``between`` two stabilities."""

    values: np.ndarray
    stability: np.ndarray
    heights: np.ndarray
    between: np.ndarray

    def shown(self, across: Callable[[Any], Any], upright: Callable[[Any], Any]) -> "Line":
        """Return the line in the units of the axes."""
        return self._replace(values=across(self.values), heights=upright(self.heights))


def line(branch: Branch, quantity: str, phase: float) -> Line:
    """Return a branch as one line per cycle of its period, or as one line of its peaks or largest multipliers."""
    points = branch.points
    values, stability = points["parameter"], points["stability"]
    if quantity in COLUMNS:
        heights = branch.section(phase)[:, :, COLUMNS[quantity]]
    else:
        own = points["peak"] if quantity == "peak" else np.abs(points["multipliers"]).max(axis=1)
        heights = own[:, None]
    inner = [one for one in branch._passages if one.kind != "grazing" and 0 < one.index < len(values)]
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
