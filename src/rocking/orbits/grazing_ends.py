"""Ends of bifurcation curves at a grazing: where a further contact of the orbit begins, or one of its contacts vanishes."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from rocking.kernels.orbits import arclength
from rocking.orbits import grazing
from rocking.orbits.curve_ends import CurveEnd, mean_halves, zero_between
from rocking.orbits.curve_rows import CurveRows
from rocking.orbits.curve_zeros import Test
from rocking.orbits.event_chain import Chain, Condition, Special, equations
from rocking.orbits.normal_form import Reduced
from rocking.orbits.parent_branch import half_differences, parent_of

AHEAD = (3.0, 5.0, 9.0, -3.0)
"""Distances from the last point, in units of the last step before a grazing, in which it is searched for."""
AROUND = (3.0, -3.0, 9.0, -9.0, 27.0, -27.0, 81.0, -81.0)
"""Distances from the last point on another curve through the end, on both sides."""
EQUAL_AT_GRAZING = 1e-2
"""Largest distance of the halves of a chain, in rad, at the last point of a curve before a grazing at which they are equal.

This point lies within `arclength.GRAZING_STEP`. With any step, such distances were below 2e-4, and others above 0.5.
"""


def grazing_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve at a grazing, or None if its place is not known.

    Parameters
    ----------
    rows : CurveRows
        Curve.
    inwards : ndarray, shape (n, k + 2)
        Its points, beginning at this end. The grazing lies within the last step, which is `arclength.GRAZING_STEP` at most.

    Returns
    -------
    CurveEnd or None
        The end; its kind is "grazing" where a further contact touches.
    """
    if len(inwards) < 2:
        return None
    for search in (_merged_end, _vanished_end, _touching_end):
        found = search(rows, inwards)
        if found is not None:
            return found
    return None


def _merged_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve of grazings, at which its orbits merge with those from which they bifurcate, or None.

    Both halves of such an orbit touch there. The point is solved on the curve of grazings of the other orbits, where a multiplier
    is −1.
    """
    if rows.condition.kind != Special.GRAZING:
        return None
    own = _locally(rows, inwards[0]).condition
    found = _half_of(rows.chain, own, inwards[0])
    if found is None:
        return None
    parent, touch, near = found
    kind = "symmetry-breaking" if parent.mirrored else "period-doubling"
    other = rows._replace(chain=parent, condition=touch, local=True)
    return _around(other, Test(f"{kind}-grazing", lambda of, at: multiplier(of, at, 1.0)), near)


def _half_of(chain: Chain, touch: Condition, row: np.ndarray) -> tuple[Chain, Condition, np.ndarray] | None:
    """Return the chain, the touch and the phases of an orbit that repeats after half a chain, almost; None if it does not."""
    parent = parent_of(chain)
    if parent is None or np.abs(half_differences(chain, row[None, :-1])).max() > EQUAL_AT_GRAZING:
        return None
    return parent, touch._replace(arc=touch.arc % len(parent.kinds)), mean_halves(row, parent)


def _vanished_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve at a grazing, where a contact of its orbits vanishes, or None.

    The orbits without this contact are regular there. On a curve of grazings they touch at two instants, which may be the same
    one of a shorter period. On another curve, and there, their return map is degenerate: with the contact, the multipliers of
    other orbits nearby are without bound.
    """
    chain = rows.chain_at(inwards[0])
    links = equations(chain, rows.names[1], np.append(chain.phases, inwards[0, -1]))[1]
    for touch in grazing.slow_event(chain, links):
        kept, near = touch.chain, np.append(touch.chain.phases, inwards[0, -2:])
        other, test = rows._replace(chain=kept, condition=touch.condition, local=True), DEGENERATE_GRAZING
        if rows.condition.kind == Special.GRAZING:
            own = _without(_locally(rows, inwards[0]).condition, chain, kept)
            found = _half_of(kept, touch.condition, near)
            if found is not None:
                parent, condition, near = found
                other = other._replace(chain=parent, condition=condition)
            else:
                other = other._replace(condition=own)
                test = _touches(other, touch.condition)
        end = _around(other, test, near)
        if end is not None:
            return end
    return None


def _touching_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve at a grazing, where a turning point of an arc reaches the base or a brace, or None.

    Beyond this end the equations of the chain remain regular, so that the clearance of the turning point changes its sign.
    """
    here = _locally(rows, inwards[0])
    chord = _shortest(rows, inwards[0] - inwards[1])
    for contact in _contacts(here, inwards[0]):
        found = zero_between(here, _touches(here, contact), inwards[0], chord, AHEAD)
        if found is not None:
            return found
    return None


def _around(rows: CurveRows, test: Test, near: np.ndarray) -> CurveEnd | None:
    """Return the zero of a test function on a curve close to a point near it, in either direction, or None."""
    across = np.zeros(len(near))
    for which in (-1, -2):
        across[:], across[which] = 0.0, 1.0
        start = rows.corrected(near, across)
        if start is None:
            continue
        off = start.copy()
        off[which] += arclength.GRAZING_STEP * rows.step * (rows.limits[which][1] - rows.limits[which][0])
        other = rows.corrected(off, across)
        if other is None:
            continue
        found = zero_between(rows, test, start, _shortest(rows, other - start), AROUND)
        if found is not None:
            return found
    return None


def _shortest(rows: CurveRows, chord: np.ndarray) -> np.ndarray:
    """Return a chord with the length of the last step before a grazing."""
    spans = np.array([high - low for low, high in rows.limits])
    size = math.sqrt(np.mean(chord[:-2] ** 2) + ((chord[-2:] / spans) ** 2).sum())
    return arclength.GRAZING_STEP * rows.step / size * chord


def _locally(rows: CurveRows, row: np.ndarray) -> CurveRows:
    """Return a curve with the time of the touch at one point, near which a second turning point may be as close."""
    if rows.condition.kind != Special.GRAZING:
        return rows
    time = grazing.turning_time(rows.chain_at(row), rows.names[1], row, rows.condition)
    return rows._replace(condition=rows.condition._replace(time=time), local=True)


def _without(own: Condition, chain: Chain, kept: Chain) -> Condition:
    """Return the condition of a chain in the same one without a contact, which begins at another event."""
    begins = int(np.flatnonzero(chain.phases == kept.phases[0])[0])
    k, last = len(chain.kinds), len(kept.kinds) - 1
    arc, phases = (own.arc - begins) % k, grazing.rotated(chain, begins).phases
    if arc <= last:
        return own._replace(arc=arc)
    later = float(phases[arc] - phases[last]) / chain.system.harmonic.frequency
    return own._replace(arc=last, time=own.time + later)


def _touches(rows: CurveRows, contact: Condition) -> Test:
    """Return the test function that is the clearance of a turning point."""
    later = contact._replace(arc=(contact.arc - 1) % len(rows.chain.kinds))
    return Test("grazing", _clearance_of(contact), _clearance_of(later))


def _contacts(rows: CurveRows, row: np.ndarray) -> list[Condition]:
    """Return the turning points of the arcs at a point of a curve, the closest to the base or a brace first."""
    chain = rows.chain_at(row)
    links = equations(chain, rows.names[1], np.append(chain.phases, row[-1]))[1]
    own = rows.condition
    return [
        touch.condition
        for touch in grazing.near_contacts(chain, links)
        if own.kind != Special.GRAZING
        or (touch.condition.arc, touch.condition.level) != (own.arc, own.level)
        or abs(touch.condition.time - own.time) > grazing.CLOSE
    ]


def _clearance_of(contact: Condition) -> Callable[[CurveRows, np.ndarray], Reduced]:
    """Return the test function that is the clearance of a turning point."""

    def values(rows: CurveRows, at: np.ndarray) -> Reduced:
        found = [grazing.clearance(rows.chain_at(row), rows.names[1], row, contact) for row in at]
        return Reduced(np.array(found), np.ones((len(at), 1)))

    return values


def multiplier(rows: CurveRows, at: np.ndarray, sign: float) -> Reduced:
    """Return 1 ± trace + determinant, which vanishes where a multiplier is −1 or 1."""
    values = []
    for row in at:
        chain = rows.chain_at(row)
        *_, trace, determinant = equations(chain, rows.names[1], np.append(chain.phases, row[-1]))
        values.append(1.0 + sign * trace + determinant)
    return Reduced(np.array(values), np.ones((len(at), 1)))


def _slopes_of_return(rows: CurveRows, at: np.ndarray) -> Reduced:
    """Return the derivative of the angle at a touch by the velocity at the touch before.

    With the contact, this derivative is multiplied by the inverse of its speed in the trace of the return map.
    """
    found = []
    for row in at:
        chain, condition = rows.chain_at(row), rows.condition
        _, time = grazing.turning_point(chain, rows.names[1], row, condition)
        found.append(grazing.slope_of_return(chain, rows.names[1], row, condition._replace(time=time)))
    return Reduced(np.array(found), np.ones((len(at), 1)))


DEGENERATE_GRAZING = Test("degenerate-grazing", _slopes_of_return)
