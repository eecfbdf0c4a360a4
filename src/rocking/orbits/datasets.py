"""Datasets of branches, bifurcation curves, cascades, sets of periodic orbits and their manifolds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.orbit import ORBIT_TEXTS, Orbit, facts_of, start_of
from rocking.model.result import described, named
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
NUMBER_OF_CURVE = named("number of the curve")


def multipliers(along: str, values: np.ndarray) -> Variables:
    """Return Floquet multipliers, shape (n, 2), as variables of real and imaginary parts: netCDF has no complex numbers."""
    return {
        f"multiplier_{number}_{part}": (
            along,
            getattr(column, part),
            named(f"Floquet multiplier {number}, {text}"),
        )
        for number, column in enumerate(values.T, 1)
        for part, text in (("real", "real part"), ("imag", "imaginary part"))
    }


def orbits_along(
    along: str,
    orbits: Sequence[Orbit],
    prefix: str = "",
    facts: Callable[[Orbit], dict[str, Any]] = facts_of,
) -> Variables:
    """Return facts on orbits, without their names and words, as variables; -1 stands for infinitely many impacts."""
    rows = [facts(each) for each in orbits]
    return {
        f"{prefix}{name}": (
            along,
            np.array([-1 if row[name] is None else row[name] for row in rows], kind),
            {"long_name": text} | ({"units": unit} if unit else {}),
        )
        for name, (text, unit, kind) in ORBIT_TEXTS.items()
        if facts is not facts_of or not name.startswith("start_")
    }


def of_branch(branch: Branch) -> xr.Dataset:
    """Return a branch as a dataset along `point`, with its special points along `special` and its ends along `end`."""
    import xarray as xr

    points, special = branch.points, branch.special
    values = points["parameter"]
    variables = {
        "event_phase": (
            "point",
            points["phase"],
            {"long_name": "forcing phase of the first event", "units": "rad"},
        ),
        "event_velocity": ("point", points["velocity"], named("speed just after the first event")),
        "peak": ("point", points["peak"], named("largest magnitude of the angle of the orbit")),
        "stability": ("point", points["stability"].astype(str), {"long_name": "stability of the orbit"}),
        **multipliers("point", points["multipliers"]),
        "special_kind": (
            "special",
            np.array([one.kind for one in special], "U17"),
            {"long_name": "type of the special point"},
        ),
        f"special_{branch.name}": coordinate_of(
            "special", branch.name, np.array([one.parameter for one in special], float)
        ),
        **orbits_along("special", [one.orbit for one in special], "special_"),
        "end_reason": ("end", list(branch.ends), {"long_name": "reason why the branch ends"}),
        f"end_{branch.name}": coordinate_of("end", branch.name, values[[0, -1]]),
    }
    attributes = described("Branch of periodic orbits") | {
        **fixed_quantities(branch._middle, branch.name),
        "parameter": branch.name,
        "orbit_period": branch.period,
        "symmetric": branch.symmetric,
        "impacts_per_period": branch.impacts,
        "brace_hits_per_period": branch.brace_hits,
        "points": len(branch),
        "stable_points": int(points["stable"].sum()),
        "peak": float(np.nanmax(points["peak"])),
    }
    return xr.Dataset(variables, {branch.name: coordinate_of("point", branch.name, values)}, attributes)


def special_points(names: tuple[str, str], points: Sequence[CodimensionTwoPoint]) -> Variables:
    """Return points of codimension two as variables along `special`."""
    values = np.array([one.values for one in points]).reshape(-1, 2)
    errors = np.array([one.errors for one in points]).reshape(-1, 2)
    kinds = np.array([one.kind for one in points], dtype="U28")
    variables: Variables = {
        "special_kind": ("special", kinds, {"long_name": "type of the point of codimension two"})
    }
    for name, value, error in zip(names, values.T, errors.T, strict=True):
        variables[f"special_{name}"] = coordinate_of("special", name, value)
        variables[f"special_{name}_error"] = ("special", error, named(f"error of the {name}"))
    return variables


def of_curve(curve: BifurcationCurve) -> xr.Dataset:
    """Return a bifurcation curve as a dataset along `point`."""
    import xarray as xr

    coordinates = {
        name: coordinate_of("point", name, values)
        for name, values in zip(curve.names, curve.points.T, strict=True)
    }
    text = "coefficient of the normal form of the return map"
    variables = {"coefficient": ("point", curve.coefficients, named(text))}
    attributes = described("Bifurcation curve") | {
        **fixed_quantities(curve._rows.chain.system, *curve.names),
        "kind": curve.kind,
        "orbit_period": curve.period,
        "impacts_per_period": curve.impacts,
        "ends": list(curve.ends),
    }
    return xr.Dataset(variables | special_points(curve.names, curve.special), coordinates, attributes)


def of_curves(found: BifurcationSet) -> xr.Dataset:
    """Return a bifurcation set as a dataset along `point` and `curve`."""
    import xarray as xr

    lengths = [len(curve) for curve in found.curves]
    points = np.concatenate([np.empty((0, 2)), *(curve.points for curve in found.curves)])
    coordinates = {
        name: coordinate_of("point", name, values) for name, values in zip(found.names, points.T, strict=True)
    }
    variables: Variables = {
        "curve_number": ("point", np.repeat(np.arange(len(lengths)), lengths), NUMBER_OF_CURVE)
    }
    for name, value, text, kind in (
        ("kind", "kind", "type of the special points", "U17"),
        ("orbit_period", "period", "forcing cycles per response period", int),
        ("impacts_per_period", "impacts", "impacts per response period", int),
    ):
        values = np.array([getattr(curve, value) for curve in found.curves], kind)
        variables[f"curve_{name}"] = (
            "curve",
            values,
            {"long_name": text} | ({} if kind == "U17" else {"units": "1"}),
        )
    variables |= special_points(found.names, [one for curve in found.curves for one in curve.special])
    numbers = np.repeat(np.arange(len(lengths)), [len(curve.special) for curve in found.curves])
    variables["special_curve"] = "special", numbers, named("number of the curve of the special point")
    attributes = described("Bifurcation set") | {
        **fixed_quantities(found.system, *found.names),
        "max_period": found.max_period,
        "not_followed": found.not_followed,
    }
    return xr.Dataset(variables, coordinates, attributes)


def of_cascade(found: Cascade) -> xr.Dataset:
    """Return a cascade of period doublings as a dataset along `doubling`."""
    import xarray as xr

    first = found.special[0]
    ratios = np.full(len(found.special), np.nan)
    ratios[1:-1] = found.ratios
    accumulation, error = found.accumulation
    text = "distance to the previous period doubling over that to the next"
    variables = {
        "ratio": ("doubling", ratios, named(text)),
        **orbits_along("doubling", [one.orbit for one in found.special]),
    }
    attributes = described("Cascade of period doublings") | {
        **fixed_quantities(first.orbit.system, first.name),
        "parameter": first.name,
        f"accumulation_{first.name}": accumulation,
        f"accumulation_{first.name}_error": error,
        "end": found.end,
    }
    return xr.Dataset(
        variables, {first.name: coordinate_of("doubling", first.name, found.values)}, attributes
    )


def of_transition(found: GrazingTransition) -> xr.Dataset:
    """Return the transition at a grazing as a dataset along the parameter."""
    import xarray as xr

    special, verdicts = found.special, found.verdicts
    name = special.name

    def numbers(values: list[float | None]) -> np.ndarray:
        return np.array([np.nan if value is None else value for value in values])

    order, order_error = found.order
    variables = {
        "distance": (name, found.distances, named("relative distance of the parameter from the grazing")),
        "kind": kinds_of(name, [str(one.kind) for one in verdicts], "type of the response"),
        "orbit_period": (
            name,
            np.array([one.period or 0 for one in verdicts]),
            named("forcing cycles per response period; 0 if not periodic"),
        ),
        "exponent": (
            name,
            numbers([one.exponent for one in verdicts]),
            named("largest Lyapunov exponent per tau"),
        ),
        "exponent_error": (
            name,
            numbers([one.exponent_error for one in verdicts]),
            named("error of the largest Lyapunov exponent per tau"),
        ),
        "nearest": (
            name,
            found.nearest,
            named("smallest distance of the attractor from the grazing orbit"),
        ),
        "farthest": (
            name,
            found.farthest,
            named("largest distance of the attractor from the grazing orbit"),
        ),
    }
    attributes = described("Transition at a grazing") | {
        **fixed_quantities(special.orbit.system, name),
        f"grazing_{name}": special.parameter,
        "orbits": found.orbits,
        "transition": found.kind,
        "order": order,
        "order_error": order_error,
        "section_phase": special.orbit.phase,
    }
    return xr.Dataset(variables, {name: coordinate_of(name, name, found.values)}, attributes)


def points_of(curves: Sequence[Manifold], since: str) -> Variables:
    """Return the points of manifolds along `point`, and their properties along `curve`."""
    points = np.concatenate([one.points for one in curves])
    numbers = np.repeat(np.arange(len(curves)), [len(one.points) for one in curves])
    return {
        "angle": ("point", points[:, 0], named("angle")),
        "velocity": ("point", points[:, 1], named("angular velocity")),
        "time": ("point", np.concatenate([one.times for one in curves]), named(f"time {since}")),
        "curve_number": ("point", numbers, NUMBER_OF_CURVE),
        "curve_stable": (
            "curve",
            np.array([one.stable for one in curves]),
            {"long_name": "whether the curve is stable"},
        ),
        "curve_side": (
            "curve",
            np.array([one.side for one in curves]),
            named("sign of the side to which the curve belongs"),
        ),
        "curve_resolved": (
            "curve",
            np.array([one.resolved for one in curves]),
            {"long_name": "whether the curve is resolved"},
        ),
    }


def of_saddles(found: SaddleManifolds) -> xr.Dataset:
    """Return the manifolds of both saddle orbits as a dataset along `point`, `curve` and `saddle`."""
    import xarray as xr

    variables = {
        **points_of((*found.unstable, *found.stable), "from or to a small distance from the saddle orbit"),
        "saddle_angle": ("saddle", found.saddles[:, 0], named("angle of the saddle orbit")),
        "saddle_velocity": ("saddle", found.saddles[:, 1], named("angular velocity of the saddle orbit")),
    }
    attributes = described("Manifolds of the saddle orbits") | {
        **quantities(found.system),
        "section_phase": found.phase,
        "cycles": found.cycles,
    }
    return xr.Dataset(variables, attrs=attributes)


def of_manifolds(found: OrbitManifolds) -> xr.Dataset:
    """Return the manifolds of an orbit as a dataset along `point`, `curve` and `orbit_point`."""
    import xarray as xr

    curves = (*found.unstable, *found.stable)
    # Two halves at each point of the orbit, one after another, first of the unstable manifold.
    starts = np.arange(len(curves)) // 2 % len(found.points)
    variables = {
        **points_of(curves, "from or to a distance of 1e-6 from the orbit"),
        "curve_orbit_point": (
            "curve",
            starts,
            named("number of the point of the orbit where the curve begins"),
        ),
        "orbit_angle": ("orbit_point", found.points[:, 0], named("angle of the orbit")),
        "orbit_velocity": ("orbit_point", found.points[:, 1], named("angular velocity of the orbit")),
    }
    attributes = described("Manifolds of a periodic orbit") | {
        **quantities(found.orbit.system),
        "orbit_period": found.orbit.period,
        "section_phase": found.phase,
        "wanted_length": found.wanted,
    }
    return xr.Dataset(variables, attrs=attributes)


def of_orbits(found: Orbits) -> xr.Dataset:
    """Return periodic orbits as a dataset along `orbit`."""
    import xarray as xr

    proved = [one.proof is not None and one.proof.proved for one in found]
    variables = {
        **orbits_along("orbit", found, facts=lambda orbit: facts_of(orbit) | start_of(orbit)),
        "hits": ("orbit", np.array(found.hits, int), named("initial guesses that led to the orbit")),
        "proved": ("orbit", np.array(proved, bool), {"long_name": "whether the orbit is proved"}),
    }
    attributes = described("Periodic orbits") | {
        **quantities(found.system),
        "max_period": found.max_period,
        "starts": found.starts,
        "settled": found.settled,
    }
    return xr.Dataset(variables, attrs=attributes)
