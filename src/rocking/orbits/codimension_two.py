"""Points of codimension two on a bifurcation curve: where a second condition holds.

On a curve of folds the quadratic coefficient of the normal form may vanish. On one of period doublings or symmetry breakings it is
the cubic coefficient (Kuznetsov 2004, Elements of Applied Bifurcation Theory, ch. 9). A grazing curve may meet a curve of another type.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from attrs import evolve, field, frozen

from rocking.kernels.orbits import arclength
from rocking.model import Orbit, plus_minus
from rocking.orbits import normal_form
from rocking.orbits.curve_rows import CurveRows
from rocking.orbits.event_chain import End, Special, equations, orbit_of
from rocking.orbits.normal_form import Reduced
from rocking.orbits.parent_branch import apart_of, parent_of

TOLERANCE = 1e-13
"""Width of a bracket of a zero, in units of the distance of two points of the curve, at which the search ends."""
BLOCK = 2_000_000
"""Largest number of entries of the matrices of a block of points."""
SMALL = 1e-6
"""Largest value of a test function at a zero, relative to those at the points around it: a pole is no zero."""
ALMOST_EQUAL = 0.1
"""Largest distance of the halves of a chain, in rad, at the last point of a curve before a point at which they are equal."""
UNSURE = 0.05
"""Part of the extrapolated distance to such a point that its error contains; 0.03 was the largest one of 45 cases."""
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
        - "double-grazing": the orbit grazes at two instants.
    names : tuple of two str
        Names of the parameters.
    values, errors : tuple of two float
        Values of the parameters, and their errors.
    orbit : Orbit
        Orbit at this point, without grazing impacts. At a degenerate point on a curve of folds it is the nearest orbit of
        the curve.
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


class Test(NamedTuple):
    """Test function of a point of codimension two."""

    kind: str
    # values at rows of the curve, with directions on which their signs depend
    values: Callable[[CurveRows, np.ndarray], Reduced]


def coefficients_of(rows: CurveRows) -> np.ndarray:
    """Return the coefficient of the normal form at each point of a curve, NaN on a curve of grazings."""
    if rows.condition.kind == Special.GRAZING:
        return np.full(len(rows.rows), np.nan)
    (test,) = _tests(rows)
    values, _ = _along(rows, test)
    parameters = rows.chains(rows.rows).parameters
    impacts, hits = rows.chain._replace(mirrored=False).counts()
    kept = parameters["restitution"] ** (2 * impacts) * parameters["brace_restitution"] ** (2 * hits)
    with np.errstate(divide="ignore"):
        if rows.condition.kind == Special.FOLD:
            return np.asarray(-values / (1.0 - kept[:, 0]))
        return np.asarray(0.5 * values / (1.0 - kept[:, 0] ** 2))


def points_of(rows: CurveRows) -> tuple[CodimensionTwoPoint, ...]:
    """Return the points of codimension two of a curve, in order along it."""
    found: list[CodimensionTwoPoint | None] = []
    for test in _tests(rows):
        values, directions = _along(rows, test)
        for i in np.flatnonzero(values[:-1] * values[1:] < 0.0).tolist():
            if test.kind == "cusp" and _passes_parent(rows, i):
                point = _degenerate(rows, (rows.rows[i::-1], rows.rows[i + 1 :]), i + 1)
            else:
                point = _located(rows, test, i, (values[i], values[i + 1]), directions[i])
            found.append(point)
    for end, inwards in zip(rows.ends, (rows.rows, rows.rows[::-1]), strict=True):
        place = 0 if inwards is rows.rows else len(rows.rows) - 1
        if end == End.GRAZED:
            found.append(_grazed_end(rows, inwards[0], place))
        elif end == End.LOST and _name(rows) == "fold":
            found.append(_degenerate(rows, (inwards,), place))
    return tuple(sorted((one for one in found if one is not None), key=lambda one: one.index))


def _grazed_end(rows: CurveRows, row: np.ndarray, place: int) -> CodimensionTwoPoint:
    """Return the end of a curve at a grazing, to the last step."""
    kind = _name(rows)
    reach = arclength.GRAZING_STEP * rows.step
    errors = tuple(reach * (high - low) for low, high in rows.limits)
    return _point(rows, "double-grazing" if kind == "grazing" else f"{kind}-grazing", row, errors, place)


def _passes_parent(rows: CurveRows, i: int) -> bool:
    """Return whether both halves of the chain change places between two neighbouring points of the curve."""
    if parent_of(rows.chain) is None:
        return False
    before, after = apart_of(rows.chain, rows.rows[i : i + 2, :-1])
    return bool(before @ after < 0.0)


def _degenerate(rows: CurveRows, sides: tuple[np.ndarray, ...], index: int) -> CodimensionTwoPoint | None:
    """Return the point of a curve of folds at a degenerate bifurcation of the orbits from which its orbits bifurcate, or None.

    Both halves of the chain are equal there, and the equations of the curve are singular. The parameters are extrapolated, linearly
    in the squared distance of the halves, from pairs of points on each side.
    """
    if parent_of(rows.chain) is None:
        return None
    found = []
    for side in sides:
        squares = (apart_of(rows.chain, side[:, :-1]) ** 2).sum(axis=1)
        places = [int(np.argmax(squares > times * squares[0])) for times in (2.0, 4.0)]
        if 0 in places or squares[0] > ALMOST_EQUAL**2:
            return None
        found += [
            side[0] - squares[0] / (squares[far] - squares[0]) * (side[far] - side[0]) for far in places
        ]
    # near the singular point the rows are less accurate
    error = 2.0 * np.abs(found - found[0]).max(axis=0) + UNSURE * np.abs(found[0] - sides[0][0])
    kind = f"degenerate-{'symmetry-breaking' if rows.chain.period % 2 else 'period-doubling'}"
    values = float(found[0][-2]), float(found[0][-1])
    return evolve(_point(rows, kind, sides[0][0], tuple(error[-2:].tolist()), index), values=values)


def _name(rows: CurveRows) -> str:
    """Return the type of a curve."""
    if rows.condition.kind == Special.GRAZING:
        return "grazing"
    if rows.condition.kind == Special.FOLD:
        return "fold"
    return "symmetry-breaking" if rows.chain.mirrored else "period-doubling"


def _tests(rows: CurveRows) -> tuple[Test, ...]:
    """Return the test functions on a curve."""
    name = _name(rows)
    if name == "fold":
        return (Test("cusp", lambda of, at: normal_form.folds(of.chains(at))),)
    if name != "grazing":
        return (Test(f"degenerate-{name}", lambda of, at: normal_form.doublings(of.chains(at))),)
    doubling = "symmetry-breaking" if rows.chain.mirrored else "period-doubling"
    return (
        Test("fold-grazing", lambda of, at: _multiplier(of, at, -1.0)),
        Test(f"{doubling}-grazing", lambda of, at: _multiplier(of, at, 1.0)),
    )


def _multiplier(rows: CurveRows, at: np.ndarray, sign: float) -> Reduced:
    """Return 1 ± trace + determinant, which vanishes where a multiplier is −1 or 1."""
    values = []
    for row in at:
        chain = rows.chain_at(row)
        *_, trace, determinant = equations(chain, rows.names[1], np.append(chain.phases, row[-1]))
        values.append(1.0 + sign * trace + determinant)
    return Reduced(np.array(values), np.ones((len(at), 1)))


def _along(rows: CurveRows, test: Test) -> tuple[np.ndarray, np.ndarray]:
    """Return a test function at all points of the curve, of one sense of its direction, and these directions."""
    # blocks of rows, which bound the memory for the matrices
    block = max(1, BLOCK // (4 * len(rows.chain.kinds) ** 2))
    parts = [test.values(rows, rows.rows[i : i + block]) for i in range(0, len(rows.rows), block)]
    values, directions = (np.concatenate(part) for part in zip(*parts, strict=True))
    if test.kind == "cusp":
        turned = (directions[:-1] * directions[1:]).sum(axis=1) < 0.0
        signs = np.cumprod(np.append(1.0, np.where(turned, -1.0, 1.0)))
        values, directions = signs * values, signs[:, None] * directions
    return values, directions


class _LostError(Exception):
    """No point of the curve was found."""


def _located(
    rows: CurveRows, test: Test, i: int, ends: tuple[float, float], direction: np.ndarray
) -> CodimensionTwoPoint | None:
    """Return the point between two neighbouring points of the curve at which a test function vanishes, or None.

    Its error is the difference from the same search in the chain that begins at the next event, which rounds differently.
    """
    row = _zero(rows, test, i, direction, max(map(abs, ends)))
    later = rows.rotated()
    other = _zero(later, test, i, np.roll(direction, -1), max(map(abs, ends)))
    if row is None or other is None:
        return None
    ulps = 8.0 * np.finfo(float).eps * np.abs(row[-2:])
    errors = tuple((2.0 * np.abs(row[-2:] - other[-2:]) + ulps).tolist())
    return _point(rows, test.kind, row, errors, i + 1)


def _zero(rows: CurveRows, test: Test, i: int, direction: np.ndarray, size: float) -> np.ndarray | None:
    """Return the point after the point i of a curve at which a test function vanishes, or None."""
    from scipy.optimize import brentq

    start, chord = rows.rows[i], rows.rows[i + 1] - rows.rows[i]

    def at(share: float) -> np.ndarray:
        row = rows.corrected(start + share * chord, chord / np.linalg.norm(chord))
        if row is None:
            raise _LostError
        return row

    def value(share: float) -> float:
        (found,), (along,) = test.values(rows, at(share)[None])
        return float(-found if test.kind == "cusp" and along @ direction < 0.0 else found)

    try:
        share = float(brentq(value, 0.0, 1.0, xtol=TOLERANCE, rtol=TOLERANCE))
        return at(share) if abs(value(share)) <= SMALL * size else None
    except (_LostError, ValueError):
        return None


def _point(
    rows: CurveRows, kind: str, row: np.ndarray, errors: tuple[float, ...], index: int
) -> CodimensionTwoPoint:
    """Return a point of codimension two with its orbit."""
    chain, name = rows.chain_at(row), rows.names[1]
    there = row[:-1].copy()
    there[-1] = row[-1]
    *_, trace, determinant = equations(chain, name, there)
    return CodimensionTwoPoint(
        kind=kind,
        names=rows.names,
        values=(float(row[-2]), float(row[-1])),
        errors=(errors[0], errors[1]),
        orbit=orbit_of(chain, name, there, trace, determinant),
        index=index,
    )
