"""Columns of the datasets of branches, bifurcation curves, cascades, sets of periodic orbits and their manifolds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.orbit import ORBIT_TEXTS, Orbit, facts_of, start_of
from rocking.model.quantity import SYSTEM_QUANTITIES
from rocking.model.result import along, described
from rocking.model.system import quantities
from rocking.orbits.parameter import coordinate_of, fixed_quantities, kinds_of

if TYPE_CHECKING:
    import xarray as xr

    from rocking.orbits.bifurcation_curve import BifurcationCurve
    from rocking.orbits.bifurcation_set import BifurcationSet
    from rocking.orbits.branch import Branch
    from rocking.orbits.cascade import Cascade
    from rocking.orbits.codimension_two import CodimensionTwoPoint
    from rocking.orbits.find_orbits import Orbits
    from rocking.orbits.grazing_transition import GrazingTransition
    from rocking.orbits.orbit_manifolds import OrbitManifolds
    from rocking.orbits.saddle_manifolds import Manifold, SaddleManifolds

Variables = dict[str, Any]


def multipliers(values: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
    """Return Floquet multipliers, shape (n, 2), as columns of real and imaginary parts: netCDF has no complex numbers."""
    return {
        f"multiplier_{number}_{part}": (getattr(column, part), f"Floquet multiplier {number}, {text}")
        for number, column in enumerate(values.T, 1)
        for part, text in (("real", "real part"), ("imag", "imaginary part"))
    }


def facts(orbits: Sequence[Orbit], prefix: str = "", *, start: bool = False) -> dict[str, tuple[Any, ...]]:
    """Return columns of facts on orbits, at τ = 0 only with `start`; -1 stands for infinitely many impacts."""
    rows = [facts_of(each) | (start_of(each) if start else {}) for each in orbits]
    return {
        f"{prefix}{name}": (
            np.array([-1 if row[name] is None else row[name] for row in rows], kind),
            text,
            unit,
        )
        for name, (text, unit, kind) in ORBIT_TEXTS.items()
        if start or not name.startswith("start_")
    }


def parameter(name: str, values: Any) -> tuple[np.ndarray, dict[str, str]]:
    """Return values of a parameter of a system as a column."""
    return np.array(values, float), SYSTEM_QUANTITIES[name].attributes


def of_branch(branch: Branch) -> xr.Dataset:
    """Return a branch as a dataset along `point`, with its special points along `special` and its ends along `end`."""
    import xarray as xr

    points, special, name = branch.points, branch.special, branch.name
    of_points = {
        "event_phase": (points["phase"], "forcing phase of the first event", "rad"),
        "event_velocity": (points["velocity"], "speed just after the first event"),
        "peak": (points["peak"], "largest magnitude of the angle of the orbit"),
        "stability": (points["stability"].astype(str), "stability of the orbit"),
        **multipliers(points["multipliers"]),
    }
    of_special = {
        "special_kind": (np.array([one.kind for one in special], "U17"), "type of the special point"),
        f"special_{name}": parameter(name, [one.parameter for one in special]),
        **facts([one.orbit for one in special], "special_"),
    }
    of_ends = {
        "end_reason": (list(branch.ends), "reason why the branch ends"),
        f"end_{name}": parameter(name, points["parameter"][[0, -1]]),
    }
    attributes = described("Branch of periodic orbits") | {
        **fixed_quantities(branch._middle, name),
        "parameter": name,
        "orbit_period": branch.period,
        "symmetric": branch.symmetric,
        "impacts_per_period": branch.impacts,
        "brace_hits_per_period": branch.brace_hits,
        "points": len(branch),
        "stable_points": int(points["stable"].sum()),
        "peak": float(np.nanmax(points["peak"])),
    }
    variables = along("point", of_points) | along("special", of_special) | along("end", of_ends)
    return xr.Dataset(variables, {name: coordinate_of("point", name, points["parameter"])}, attributes)


def special_points(
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
        columns[f"special_{name}"] = parameter(name, [one.values[place] for one in points])
        errors = np.array([one.errors[place] for one in points], float)
        columns[f"special_{name}_error"] = errors, f"error of the {name}"
    return columns


def of_curve(curve: BifurcationCurve) -> xr.Dataset:
    """Return a bifurcation curve as a dataset along `point`."""
    import xarray as xr

    coefficient = curve.coefficients, "coefficient of the normal form of the return map"
    attributes = described("Bifurcation curve") | {
        **fixed_quantities(curve._rows.chain.system, *curve.names),
        "kind": curve.kind,
        "orbit_period": curve.period,
        "impacts_per_period": curve.impacts,
        "ends": list(curve.ends),
    }
    variables = along("point", {"coefficient": coefficient}) | along(
        "special", special_points(curve.names, curve.special)
    )
    return xr.Dataset(variables, plane(curve.names, curve.points), attributes)


def plane(names: tuple[str, str], points: np.ndarray) -> Variables:
    """Return the values of two parameters, shape (n, 2), as coordinates along `point`."""
    return {name: coordinate_of("point", name, values) for name, values in zip(names, points.T, strict=True)}


def of_curves(result: BifurcationSet) -> xr.Dataset:
    """Return a bifurcation set as a dataset along `point` and `curve`."""
    import xarray as xr

    curves = result.curves
    points = np.concatenate([np.empty((0, 2)), *(curve.points for curve in curves)])
    special = special_points(result.names, [one for curve in curves for one in curve.special])
    number = np.repeat(np.arange(len(curves)), [len(curve.special) for curve in curves])
    special["special_curve"] = number, "number of the curve of the special point"
    of_curve = {
        "curve_kind": (np.array([curve.kind for curve in curves], "U17"), "type of the special points"),
        "curve_orbit_period": (
            np.array([curve.period for curve in curves], int),
            "forcing cycles per response period",
        ),
        "curve_impacts_per_period": (
            np.array([curve.impacts for curve in curves], int),
            "impacts per response period",
        ),
    }
    attributes = described("Bifurcation set") | {
        **fixed_quantities(result.system, *result.names),
        "max_period": result.max_period,
        "not_followed": result.not_followed,
    }
    variables = along("point", {"curve_number": numbers_of(curves)}) | along("curve", of_curve)
    return xr.Dataset(variables | along("special", special), plane(result.names, points), attributes)


def numbers_of(curves: Sequence[Any]) -> tuple[np.ndarray, str]:
    """Return the number of its curve for each point of several curves, as a column."""
    lengths = [len(curve.points) for curve in curves]
    return np.repeat(np.arange(len(curves)), lengths), "number of the curve"


def of_cascade(result: Cascade) -> xr.Dataset:
    """Return a cascade of period doublings as a dataset along `doubling`."""
    import xarray as xr

    first = result.special[0]
    ratios = np.full(len(result.special), np.nan)
    ratios[1:-1] = result.ratios
    accumulation, error = result.accumulation
    ratio = ratios, "distance to the previous period doubling over that to the next"
    attributes = described("Cascade of period doublings") | {
        **fixed_quantities(first.orbit.system, first.name),
        "parameter": first.name,
        f"accumulation_{first.name}": accumulation,
        f"accumulation_{first.name}_error": error,
        "end": result.end,
    }
    variables = along("doubling", {"ratio": ratio, **facts([one.orbit for one in result.special])})
    coordinate = coordinate_of("doubling", first.name, result.values)
    return xr.Dataset(variables, {first.name: coordinate}, attributes)


def of_transition(result: GrazingTransition) -> xr.Dataset:
    """Return the transition at a grazing as a dataset along the parameter."""
    import xarray as xr

    special, verdicts = result.special, result.verdicts
    name = special.name
    order, order_error = result.order
    columns = {
        "distance": (result.distances, "relative distance of the parameter from the grazing"),
        "orbit_period": (
            [one.period or 0 for one in verdicts],
            "forcing cycles per response period; 0 if not periodic",
        ),
        "exponent": (numbers([one.exponent for one in verdicts]), "largest Lyapunov exponent per tau"),
        "exponent_error": (
            numbers([one.exponent_error for one in verdicts]),
            "error of the largest Lyapunov exponent per tau",
        ),
        "nearest": (result.nearest, "smallest distance of the attractor from the grazing orbit"),
        "farthest": (result.farthest, "largest distance of the attractor from the grazing orbit"),
    }
    kinds = kinds_of(name, [str(one.kind) for one in verdicts], "type of the response")
    attributes = described("Transition at a grazing") | {
        **fixed_quantities(special.orbit.system, name),
        f"grazing_{name}": special.parameter,
        "orbits": result.orbits,
        "transition": result.kind,
        "order": order,
        "order_error": order_error,
        "section_phase": special.orbit.phase,
    }
    coordinate = coordinate_of(name, name, result.values)
    return xr.Dataset(along(name, columns) | {"kind": kinds}, {name: coordinate}, attributes)


def numbers(values: Sequence[float | None]) -> np.ndarray:
    """Return numbers as an array, NaN where there is none."""
    return np.array([np.nan if value is None else value for value in values], float)


def points_of(curves: Sequence[Manifold], since: str) -> Variables:
    """Return the points of manifolds along `point`, and their properties along `curve`."""
    points = np.concatenate([one.points for one in curves])
    of_points = {
        "angle": (points[:, 0], "angle"),
        "velocity": (points[:, 1], "angular velocity"),
        "time": (np.concatenate([one.times for one in curves]), f"time {since}"),
        "curve_number": numbers_of(curves),
    }
    of_curves = {
        "curve_stable": ([one.stable for one in curves], "whether the curve is stable"),
        "curve_side": ([one.side for one in curves], "sign of the side to which the curve belongs"),
        "curve_resolved": ([one.resolved for one in curves], "whether the curve is resolved"),
    }
    return along("point", of_points) | along("curve", of_curves)


def of_saddles(result: SaddleManifolds) -> xr.Dataset:
    """Return the manifolds of both saddle orbits as a dataset along `point`, `curve` and `saddle`."""
    import xarray as xr

    saddles = {
        "saddle_angle": (result.saddles[:, 0], "angle of the saddle orbit"),
        "saddle_velocity": (result.saddles[:, 1], "angular velocity of the saddle orbit"),
    }
    curves = points_of(
        (*result.unstable, *result.stable), "from or to a small distance from the saddle orbit"
    )
    variables = curves | along("saddle", saddles)
    attributes = described("Manifolds of the saddle orbits") | {
        **quantities(result.system),
        "section_phase": result.phase,
        "cycles": result.cycles,
    }
    return xr.Dataset(variables, attrs=attributes)


def of_manifolds(result: OrbitManifolds) -> xr.Dataset:
    """Return the manifolds of an orbit as a dataset along `point`, `curve` and `orbit_point`."""
    import xarray as xr

    curves = (*result.unstable, *result.stable)
    # Two halves at each point of the orbit, one after another, first of the unstable manifold.
    starts = np.arange(len(curves)) // 2 % len(result.points)
    orbit = {
        "orbit_angle": (result.points[:, 0], "angle of the orbit"),
        "orbit_velocity": (result.points[:, 1], "angular velocity of the orbit"),
    }
    begins = starts, "number of the point of the orbit where the curve begins"
    variables = {
        **points_of(curves, "from or to a distance of 1e-6 from the orbit"),
        **along("curve", {"curve_orbit_point": begins}),
        **along("orbit_point", orbit),
    }
    attributes = described("Manifolds of a periodic orbit") | {
        **quantities(result.orbit.system),
        "orbit_period": result.orbit.period,
        "section_phase": result.phase,
        "wanted_length": result.wanted,
    }
    return xr.Dataset(variables, attrs=attributes)


def of_orbits(result: Orbits) -> xr.Dataset:
    """Return periodic orbits as a dataset along `orbit`."""
    import xarray as xr

    columns = {
        **facts(result, start=True),
        "hits": (np.array(result.hits, int), "initial guesses that led to the orbit"),
        "proved": (
            np.array([one.proof is not None and one.proof.proved for one in result], bool),
            "whether the orbit is proved",
        ),
    }
    attributes = described("Periodic orbits") | {
        **quantities(result.system),
        "max_period": result.max_period,
        "starts": result.starts,
        "settled": result.settled,
    }
    return xr.Dataset(along("orbit", columns), attrs=attributes)
