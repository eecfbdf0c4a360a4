"""Points of codimension two on a bifurcation curve: where a second condition holds.

On a curve of folds the quadratic coefficient of the normal form may vanish. On one of period doublings or symmetry breakings it is
the cubic coefficient (Kuznetsov 2004, Elements of Applied Bifurcation Theory, ch. 9). A grazing curve may meet a curve of another type.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.model.orbit import Orbit
from rocking.model.text import plus_minus
from rocking.orbits import normal_form
from rocking.orbits.curves import (
    CurveRows,
    Test,
    along,
    degenerate,
    degenerate_end,
    find_brackets,
    grazing_end,
    locate_zero,
    on_grazings,
)
from rocking.orbits.event_chain import End, orbit_at
from rocking.orbits.parameter import column_of
from rocking.orbits.special_points import FOLD, GRAZING, doubling

ROUNDED = 1e-11
"""Relative error below which a value is printed with ten digits, without the error."""


@frozen(eq=False)
class CodimensionTwoPoint:
    """Point of codimension two on a bifurcation curve; see `BifurcationCurve.special`.

    Attributes
    ----------
    kind : str
        Type of the point:

        - "cusp": two curves of folds meet tangentially; three orbits become one;
        - "degenerate-period-doubling": a period doubling changes between super- and subcritical. A curve of folds of orbits of twice
          the period begins there;
        - "degenerate-symmetry-breaking": the same for a symmetry breaking, with folds of asymmetric orbits;
        - "fold-grazing", "period-doubling-grazing", "symmetry-breaking-grazing": the orbit of a bifurcation grazes;
        - "double-grazing": the orbit grazes at two instants;
        - "degenerate-grazing": the curve ends, because a contact of its orbits vanishes. The orbit without the contact grazes there,
          and the velocity at this instant has no effect on the angle one period later.
    names : tuple of two str
        Names of the parameters.
    values, errors : tuple of two float
        Values of the parameters, and their errors.
    orbit : Orbit
        Orbit at this point, without grazing impacts. At the end of a curve of folds at a degenerate point it is the orbit from
        which those of the curve bifurcate.
    index : int
        The point lies between the points `index - 1` and `index` of its curve, or is the first or last one.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.43, period=2.46), restitution=0.18)
    >>> orbit = next(each for each in rk.find_orbits(system, 1) if each.impacts == 2 and not each.symmetric)
    >>> branch = rk.continue_orbit(orbit, "amplitude", (2.0, 3.0))
    >>> doubling = next(each for each in branch.special if each.kind == "period-doubling")
    >>> curve = rk.bifurcation_curve(doubling, "period", "amplitude", ((2, 4), (1, 3)))
    >>> print(curve.special[0])
    degenerate-period-doubling at period 3.571434734, amplitude 1.777171661: asymmetric orbit of period 1 with 2 impacts

    The bifurcation is supercritical before this point, and subcritical after it:

    >>> point = curve.special[0]
    >>> [bool(each > 0.0) for each in curve.coefficients[point.index - 1 : point.index + 1]]
    [True, False]
    >>> max(point.errors) < 1e-12
    True
    """

    kind: str
    names: tuple[str, str]
    values: tuple[float, float]
    errors: tuple[float, float]
    orbit: Orbit = field(repr=False)
    index: int

    def __str__(self) -> str:
        place = ", ".join(
            f"{name} {value:.10g}" if error < ROUNDED * abs(value) else f"{name} {plus_minus(value, error)}"
            for name, value, error in zip(self.names, self.values, self.errors, strict=True)
        )
        return f"{self.kind} at {place}: {self.orbit}"


def codimension_two_columns(
    names: tuple[str, str], points: Sequence[CodimensionTwoPoint]
) -> dict[str, tuple[Any, ...]]:
    """Return columns of points of codimension two."""
    columns: dict[str, tuple[Any, ...]] = {
        "special_kind": (
            np.array([one.kind for one in points], "U28"),
            "type of the point of codimension two",
        )
    }
    for place, name in enumerate(names):
        columns[f"special_{name}"] = column_of(name, [one.values[place] for one in points])
        errors = np.array([one.errors[place] for one in points], float)
        columns[f"special_{name}_error"] = errors, f"error of the {name}"
    return columns


def coefficients_of(rows: CurveRows) -> np.ndarray:
    """Return the coefficient of the normal form at each point of a curve, NaN on a curve of grazings."""
    if rows.kind == GRAZING:
        return np.full(len(rows.rows), np.nan)
    (test,) = _tests(rows)
    values, _ = along(rows, test)
    parameters = rows.chains(rows.rows).parameters
    impacts, hits = rows.chain._replace(mirrored=False).counts()
    kept = parameters["restitution"] ** (2 * impacts) * parameters["brace_restitution"] ** (2 * hits)
    with np.errstate(divide="ignore"):
        if rows.kind == FOLD:
            return np.asarray(-values / (1.0 - kept[:, 0]))
        return np.asarray(0.5 * values / (1.0 - kept[:, 0] ** 2))


def points_of(rows: CurveRows) -> tuple[CodimensionTwoPoint, ...]:
    """Return the points of codimension two of a curve, in order along it."""
    members = []
    for test in _tests(rows):
        for part in find_brackets(rows, test):
            point = locate_zero(rows, test, part)
            if point is not None:
                members.append(_point(rows, test.kind, *point, part.place + 1))
    for end, inwards in zip(rows.ends, (rows.rows, rows.rows[::-1]), strict=True):
        place = 0 if inwards is rows.rows else len(rows.rows) - 1
        if end == End.GRAZED:
            grazed = grazing_end(rows, inwards)
            # without a contact at the end, its place is not known
            if grazed is not None:
                kind = "double-grazing" if rows.kind == GRAZING else f"{rows.kind}-grazing"
                kind = kind if grazed.kind == GRAZING else grazed.kind
                members.append(_point(grazed.rows, kind, grazed.row, grazed.errors, place))
        elif end == End.MERGED:
            merger = degenerate_end(rows, inwards)
            if merger is not None:
                members.append(_point(merger.rows, merger.kind, merger.row, merger.errors, place))
    return tuple(sorted(members, key=lambda one: one.index))


def _tests(rows: CurveRows) -> tuple[Test, ...]:
    """Return the test functions on a curve."""
    if rows.kind == FOLD:
        return (Test("cusp", lambda of, at: normal_form.folds(of.chains(at))),)
    if rows.kind == GRAZING:
        return on_grazings(FOLD), on_grazings(doubling(rows.chain.mirrored))
    return (degenerate(rows.kind),)


def _point(
    rows: CurveRows, kind: str, row: np.ndarray, errors: tuple[float, float], index: int
) -> CodimensionTwoPoint:
    """Return a point of codimension two with its orbit."""
    return CodimensionTwoPoint(
        kind=kind,
        names=rows.names,
        values=(float(row[-2]), float(row[-1])),
        errors=errors,
        orbit=orbit_at(rows.chain_at(row), rows.names[1], np.append(row[:-2], row[-1])),
        index=index,
    )
