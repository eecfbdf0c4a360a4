"""Datasets of branches, bifurcation curves, cascades, sets of periodic orbits and their manifolds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

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


def multipliers(along: str, values: np.ndarray) -> dict[str, Any]:
    """Return the real and imaginary parts of Floquet multipliers, shape (n, 2), as variables: netCDF has no complex numbers."""
    return {
        f"multiplier_{part}": (
            (along, "multiplier"),
            getattr(values, part),
            named(f"{text} of the Floquet multipliers"),
        )
        for part, text in (("real", "real part"), ("imag", "imaginary part"))
    }


def of_branch(branch: Branch) -> xr.Dataset:
    """Return a branch as a dataset along `point`."""
    import xarray as xr

    points = branch.points
    variables = {
        "parameter": coordinate_of("point", branch.name, points["parameter"]),
        "event_phase": (
            "point",
            points["phase"],
            {"long_name": "forcing phase of the first event", "units": "rad"},
        ),
        "event_velocity": ("point", points["velocity"], named("speed just after the first event")),
        "peak": ("point", points["peak"], named("largest magnitude of the angle of the orbit")),
        "stability": ("point", points["stability"].astype(str), {"long_name": "stability of the orbit"}),
        "special": (
            "special_point",
            np.array([one.kind for one in branch.special], dtype="U17"),
            {"long_name": "type of the special point"},
        ),
        "special_parameter": coordinate_of(
            "special_point", branch.name, np.array([one.parameter for one in branch.special], float)
        ),
        **multipliers("point", points["multipliers"]),
    }
    attributes = described("Branch of periodic orbits") | {
        **fixed_quantities(branch.orbit(len(branch) // 2).system, branch.name),
        "parameter": branch.name,
        "orbit_period": branch.period,
        "symmetric": int(branch.symmetric),
        "ends": list(branch.ends),
    }
    counts = {"impacts": branch.impacts, "brace_hits": branch.brace_hits}
    attributes |= {name: count for name, count in counts.items() if count is not None}
    return xr.Dataset(variables, attrs=attributes)


def special_points(names: tuple[str, str], points: Sequence[CodimensionTwoPoint]) -> dict[str, Any]:
    """Return points of codimension two as variables along `special_point`."""
    values = np.array([one.values for one in points]).reshape(-1, 2)
    errors = np.array([one.errors for one in points]).reshape(-1, 2)
    kinds = np.array([one.kind for one in points], dtype="U28")
    variables: dict[str, Any] = {
        "special": ("special_point", kinds, {"long_name": "type of the point of codimension two"})
    }
    for name, value, error in zip(names, values.T, errors.T, strict=True):
        variables[f"special_{name}"] = coordinate_of("special_point", name, value)
        variables[f"special_{name}_error"] = ("special_point", error, named(f"error of the {name}"))
    return variables


def of_curve(curve: BifurcationCurve) -> xr.Dataset:
    """Return a bifurcation curve as a dataset along `point`."""
    import xarray as xr

    variables = {
        name: coordinate_of("point", name, values)
        for name, values in zip(curve.names, curve.points.T, strict=True)
    }
    variables["coefficient"] = (
        "point",
        curve.coefficients,
        named("coefficient of the normal form of the return map"),
    )
    variables |= special_points(curve.names, curve.special)
    attributes = described("Bifurcation curve") | {
        **fixed_quantities(curve._rows.chain.system, *curve.names),
        "kind": curve.kind,
        "orbit_period": curve.period,
        "impacts": curve.impacts,
        "ends": list(curve.ends),
    }
    return xr.Dataset(variables, attrs=attributes)


def of_curves(found: BifurcationSet) -> xr.Dataset:
    """Return a bifurcation set as a dataset along `point` and `curve`."""
    import xarray as xr

    lengths = [len(curve) for curve in found.curves]
    points = np.concatenate([np.empty((0, 2)), *(curve.points for curve in found.curves)])
    variables = {
        name: coordinate_of("point", name, values) for name, values in zip(found.names, points.T, strict=True)
    }
    variables["curve_number"] = (
        "point",
        np.repeat(np.arange(len(lengths)), lengths),
        {"long_name": "number of the curve", "units": "1"},
    )
    for name, text in (
        ("kind", "type of the special points"),
        ("period", "forcing cycles per response period"),
        ("impacts", "impacts per response period"),
    ):
        variables[f"curve_{name}"] = (
            "curve",
            np.array([getattr(curve, name) for curve in found.curves], "U17" if name == "kind" else int),
            {"long_name": text} | ({} if name == "kind" else {"units": "1"}),
        )
    specials = [one for curve in found.curves for one in curve.special]
    variables |= special_points(found.names, specials)
    variables["special_curve"] = (
        "special_point",
        np.repeat(np.arange(len(lengths)), [len(curve.special) for curve in found.curves]),
        {"long_name": "number of the curve of the special point", "units": "1"},
    )
    attributes = described("Bifurcation set") | {
        **fixed_quantities(found.system, *found.names),
        "max_period": found.max_period,
        "not_followed": found.not_followed,
    }
    return xr.Dataset(variables, attrs=attributes)


def of_cascade(found: Cascade) -> xr.Dataset:
    """Return a cascade of period doublings as a dataset along `doubling`."""
    import xarray as xr

    def column(text: str, values: Any, unit: str = "1") -> tuple[str, Any, dict[str, str]]:
        return "doubling", values, {"long_name": text, "units": unit}

    first = found.special[0]
    orbits = [one.orbit for one in found.special]
    ratios = np.full(len(orbits), np.nan)
    ratios[1:-1] = found.ratios
    accumulation, error = found.accumulation
    variables = {
        "parameter": coordinate_of("doubling", first.name, found.values),
        "period": column("forcing cycles per response period", found.periods),
        "ratio": column("distance to the previous period doubling over that to the next", ratios),
        "section_phase": column("forcing phase of the section", [one.phase for one in orbits], "rad"),
        "angle": column("angle at the section", [one.state.angle for one in orbits]),
        "velocity": column("angular velocity at the section", [one.state.velocity for one in orbits]),
        **multipliers("doubling", np.array([one.multipliers for one in orbits], complex)),
    }
    attributes = described("Cascade of period doublings") | {
        **fixed_quantities(first.orbit.system, first.name),
        "parameter": first.name,
        "accumulation": accumulation,
        "accumulation_error": error,
        "end": found.end,
    }
    return xr.Dataset(variables, attrs=attributes)


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
            named("error of the largest Lyapunov exponent"),
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
        "grazing": special.parameter,
        "orbits": found.orbits,
        "transition": found.kind,
        "order": order,
        "order_error": order_error,
        "section_phase": special.orbit.phase,
    }
    return xr.Dataset(variables, {name: coordinate_of(name, name, found.values)}, attributes)


def of_manifolds(found: OrbitManifolds) -> xr.Dataset:
    """Return the manifolds of an orbit as a dataset along `point`, `curve` and `orbit_point`."""
    import xarray as xr

    curves = (*found.unstable, *found.stable)
    points = np.concatenate([one.points for one in curves])
    # Two halves at each point of the orbit, one after another, first of the unstable manifold.
    starts = np.arange(len(curves)) // 2 % len(found.points)
    counts = {
        "curve_stable": ("1 if the half is stable, 0 if unstable", [int(one.stable) for one in curves]),
        "curve_side": ("sign of the change of the angle where the half begins", [one.side for one in curves]),
        "curve_resolved": ("1 if the half is resolved", [int(one.resolved) for one in curves]),
        "curve_orbit_point": ("number of the point of the orbit where the half begins", starts),
    }
    variables = {
        "angle": ("point", points[:, 0], named("angle")),
        "velocity": ("point", points[:, 1], named("angular velocity")),
        "time": (
            "point",
            np.concatenate([one.times for one in curves]),
            named("time from or to a distance of 1e-6 from the orbit"),
        ),
        "curve_number": (
            "point",
            np.repeat(np.arange(len(curves)), [len(one.points) for one in curves]),
            named("number of the half"),
        ),
        **{name: ("curve", np.array(values), named(text)) for name, (text, values) in counts.items()},
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

    def column(text: str, values: list[Any], unit: str = "1") -> tuple[str, np.ndarray, dict[str, str]]:
        return "orbit", np.array(values), {"long_name": text, "units": unit}

    def count(values: list[int | None]) -> list[int]:
        return [-1 if value is None else value for value in values]

    variables = {
        "period": column("forcing cycles per response period", [one.period for one in found]),
        "symmetric": column("1 if the orbit is its own mirror image", [int(one.symmetric) for one in found]),
        "stability": (
            "orbit",
            np.array([str(one.stability) for one in found], "U8"),
            {"long_name": "stability"},
        ),
        "impacts": column("impacts per period; -1 if infinitely many", count([one.impacts for one in found])),
        "brace_hits": column(
            "brace impacts per period; -1 if infinitely many", count([one.brace_hits for one in found])
        ),
        "section_phase": column("forcing phase of the section", [one.phase for one in found], "rad"),
        "angle": column("angle at the section", [one.state.angle for one in found]),
        "velocity": column("angular velocity at the section", [one.state.velocity for one in found]),
        "hits": column("initial guesses that led to the orbit", list(found.hits)),
        **multipliers("orbit", np.array([one.multipliers for one in found], complex).reshape(-1, 2)),
    }
    attributes = described("Periodic orbits") | {
        **quantities(found.system),
        "max_period": found.max_period,
        "starts": found.starts,
        "settled": int(found.settled),
    }
    return xr.Dataset(variables, attrs=attributes)
