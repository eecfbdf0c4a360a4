"""Public values of a branch and of its special points, from the table of the kernel."""

from __future__ import annotations

import numpy as np

from rocking.kernels.orbits import continuation as kernel
from rocking.orbits.branch import Branch, Origin, SpecialPoint
from rocking.orbits.branch_rows import ChainRows
from rocking.orbits.branch_table import table
from rocking.orbits.distinct_points import distinct
from rocking.orbits.event_chain import Chain, End, Special, equations, orbit_of
from rocking.orbits.grazing import grazing_at
from rocking.orbits.parent_branch import special_points

KINDS = {
    Special.FOLD: "fold",
    Special.SYMMETRY_BREAKING: "symmetry-breaking",
    Special.PERIOD_DOUBLING: "period-doubling",
    Special.GRAZING: "grazing",
}
ENDS = {
    End.RANGE: "end of the range",
    End.GRAZED: "grazing",
    End.MERGED: "merges with the branch from which it bifurcates",
    End.CLOSED: "closed loop",
    End.MANY: "maximum number of points",
    End.LOST: "lost: no further point was found with the smallest step",
}


def branch_of(chain: Chain, parameter: str, joined: kernel.BranchTable, ends: tuple[str, str]) -> Branch:
    """Return the public value of a branch."""
    impacts, brace_hits = chain.counts()
    passed = tuple(
        special_of(one.chain, parameter, one.row, one.kind, one.place, _beside(joined.rows, one.place))
        for one in special_points(chain, parameter, joined)
    )
    return Branch(
        name=parameter,
        period=chain.period,
        symmetric=chain.mirrored,
        impacts=impacts,
        brace_hits=brace_hits,
        points=table(joined.rows, joined.facts, chain.mirrored),
        special=distinct(passed),
        ends=ends,
        rows=ChainRows(chain, parameter, joined.rows, joined.facts),
        passed=passed,
    )


def _beside(rows: np.ndarray, index: int) -> float:
    """Return the parameter of a point of a branch near a special point, but not at its end."""
    return float(rows[min(max(index, 1), max(len(rows) - 2, 0)), -1])


def special_of(
    chain: Chain, parameter: str, row: np.ndarray, kind: Special, index: int, beside: float
) -> SpecialPoint:
    """Return a special point with its orbit; ``beside`` is the parameter of a point of its branch near it."""
    touch, counts = None, chain.counts()
    if kind == Special.GRAZING:
        orbit, chain, row, touch = grazing_at(chain, parameter, row)
    else:
        *_, trace, determinant = equations(chain, parameter, row)
        orbit = orbit_of(chain, parameter, row, trace, determinant)
    return SpecialPoint(
        kind=KINDS[kind],
        parameter=float(row[-1]),
        orbit=orbit,
        name=parameter,
        index=index,
        chain=chain,
        row=row.copy(),
        touch=touch,
        origin=Origin(counts, float(np.sign(beside - row[-1]))),
    )
