"""Basins of attraction: which start leads where, and how sharp the boundaries between them are."""

from __future__ import annotations

import os
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.kernels.classify import verdict_record as kernel
from rocking.model import (
    MAX_START,
    Attractor,
    BasinMap,
    Kind,
    Share,
    System,
    UncertaintyExponent,
    check_between,
    instance,
    quantities,
    refusal,
    whole,
)
from rocking.survey.engine.run_survey import run_survey
from rocking.survey.measurement import Measurement
from rocking.survey.measures.attractors import destination, label_attractors, make_attractors
from rocking.survey.sampling.random_points import MAX_SAMPLES, generator, sampled, span
from rocking.survey.sampling.uncertainty_exponent import distances, exponent, perturbed_triples
from rocking.survey.spec import Points, SurveySpec, points, question
from rocking.survey.store.dataset import attributes, coordinate

if TYPE_CHECKING:
    import xarray as xr

TITLE = "Basins of attraction of a free-standing block on a shaking base"


def basin_map(
    system: System,
    *,
    angle: Any,
    velocity: Any,
    samples: int | None = None,
    seed: int = 0,
    max_cycles: int = 10_000,
    max_period: int = 64,
    boundary_runs: int = 100_000,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: bool = False,
    repair: bool = False,
) -> BasinMap:
    """Tell where each of many starts leads: to which orbit, to rest, to chaos, or over.

    Parameters
    ----------
    system : System
        The block, its forcing and its braces.
    angle, velocity : array (n,) or pair
        Θ and Θ' of the starts: the axes of a grid, ascending; with `samples` ranges (low, high) to draw from.
    samples : int, optional
        Random starts instead of a grid, up to 10⁷.
    seed : int
        Of everything drawn at random, 0 to 2³² − 1: the same seed gives the same starts.
    max_cycles, max_period : int
        As in `classify`. Chaotic responses need 10⁴ cycles (with braces 10⁵) to be called so.
    boundary_runs : int
        Runs, about, for the exponents of the boundaries, which need starts of their own; 0 leaves them out.
    store, executor, progress, repair
        As in `parametric_map`; a store holds a grid.

    Returns
    -------
    BasinMap
        `.attractors` with their `.fractions`, `.uncertainty_exponent`, `.attractor_exponent` and `.dataset`; `print` shows
        one line. Two attractors are told apart by their orbits: two unsymmetric ones that are each other's mirror image are two.

    Raises
    ------
    TypeError, ValueError, OSError
        In one line, as in `parametric_map`.

    See Also
    --------
    safe_basin : Fraction of safe initial states over the amplitude.
    find_orbits : Search for periodic orbits.
    rocking.plot.basins : Plot the basins.

    Notes
    -----
    The intervals of the fractions are Wilson's at 95 %, and cover that all that is undetermined leads there. They hold for
    random starts. For a grid they are those of as many
    random starts: its error is about the share of the cells that a boundary cuts, over the root of how many they are,
    and so most often smaller; but nothing that happens between its points is known.

    Not guaranteed: what `classify` does not guarantee. Orbits nearer to each other than 10⁻⁶ count as one. So do all
    quasi-periodic responses, all chaotic ones without losses, and all others whose mean angle on the section differs by less
    than ten standard errors: two chaotic attractors that are each other's mirror image are told apart by it, but two that
    lie the same on average are not. An exponent is of the distances tried, 2⁻⁶ to 2⁻¹³ of the width of the
    starts; a boundary may be smooth on a finer scale.

    References
    ----------
    McDonald, Grebogi, Ott & Yorke, Physica D 17, 125–153 (1985).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=3.5, period=1.0), restitution=0.8)
    >>> starts = np.linspace(-1, 1, 41)
    >>> found = rk.basin_map(system, angle=starts, velocity=starts, boundary_runs=0)
    >>> [each.name for each in found.attractors]
    ['period 1, symmetric', 'overturned', 'period 3, symmetric']
    """
    instance("system", system, System)
    measure = destination(max_cycles, max_period, TITLE)
    runs = whole("boundary_runs", boundary_runs, 0, MAX_SAMPLES)
    random = generator(seed)
    if samples is None:
        asked = question({**asked_of(system), "angle": angle, "velocity": velocity}, 2, "a basin map")
        found = run_survey(asked, measure, store, executor, progress=progress, repair=repair).load()
        ends = {name: (values[0], values[-1]) for name, values in asked.axes.items()}
        starts = grid_starts(asked)
    else:
        if store is not None:
            raise TypeError(refusal("store", "come without samples: it holds a grid", str(store)))
        ends = {name: span(name, v) for name, v in (("velocity", velocity), ("angle", angle))}
        reach = MAX_START if system.braces is None else system.braces.angle
        check_between(max(ends["angle"], key=abs), reach)
        count = whole("samples", samples, 1, MAX_SAMPLES)
        starts = random.uniform(*_corners(ends), (count, 2))
        found = _random_dataset(system, starts, measure, executor).assign_attrs(seed=seed)
    labels, first = label_attractors(system, {str(name): found[name].values for name in found.data_vars})
    attractors = make_attractors(system, starts, first, max_cycles, max_period)
    _attach(found, labels, [each.name for each in attractors])
    fractions = _fractions(np.bincount(labels), attractors)
    exponents = _exponents(system, ends, runs, random, measure, executor) if runs else (None, None)
    return BasinMap(system, found, attractors, fractions, *exponents)


def _fractions(counts: np.ndarray, attractors: tuple[Attractor, ...]) -> tuple[Share, ...]:
    """The share of each attractor; what is undetermined may belong to any."""
    undetermined = [each.kind is Kind.UNDETERMINED for each in attractors]
    unknown = int(counts[undetermined].sum())
    return tuple(
        Share(count, counts.sum(), 0 if not_known else unknown)
        for count, not_known in zip(counts, undetermined, strict=True)
    )


def asked_of(system: System) -> dict[str, float]:
    """Return the quantities of a system as a survey takes them: of period and frequency the period."""
    found = quantities(system)
    return {name: found[name] for name in found if name != "frequency"}


def points_of(system: System, starts: np.ndarray) -> Points:
    """One system from starts (n, 2)."""
    return points({"angle": starts[:, 0], "velocity": starts[:, 1]}, asked_of(system))


def grid_starts(asked: SurveySpec) -> np.ndarray:
    """The starts (n, 2) of a grid, in C order."""
    grid = dict(zip(asked.axes, np.meshgrid(*asked.axes.values(), indexing="ij"), strict=True))
    return np.column_stack([grid["angle"].ravel(), grid["velocity"].ravel()])


def _corners(ends: dict[str, tuple[float, float]]) -> tuple[tuple[float, float], tuple[float, float]]:
    """The lowest and the highest start."""
    (a, b), (c, d) = ends["angle"], ends["velocity"]
    return (a, c), (b, d)


def _random_dataset(
    system: System, starts: np.ndarray, measure: Measurement, executor: Executor | None
) -> xr.Dataset:
    """What random starts lead to, start by start."""
    import xarray as xr

    answers = sampled(points_of(system, starts), measure, executor)
    return xr.Dataset(
        {each.name: ("sample", answers[each.name], each.attributes) for each in measure.variables},
        {
            name: ("sample", starts[:, column], coordinate(name))
            for column, name in enumerate(("angle", "velocity"))
        },
        attributes(SurveySpec({}, asked_of(system)), measure),
    )


def _attach(found: xr.Dataset, labels: np.ndarray, names: list[str]) -> None:
    """Write into the dataset which attractor each start leads to."""
    words = [name.replace(",", "").replace("(", "").replace(")", "").replace(" ", "-") for name in names]
    told = {
        "long_name": "attractor that the start leads to, the largest share first",
        "flag_values": np.arange(len(names), dtype=np.int32),
        "flag_meanings": " ".join(words),
    }
    found["attractor"] = (found.kind.dims, labels.reshape(found.kind.shape).astype(np.int32), told)


def _exponents(
    system: System,
    ends: dict[str, tuple[float, float]],
    runs: int,
    random: np.random.Generator,
    measure: Measurement,
    executor: Executor | None,
) -> tuple[UncertaintyExponent | None, UncertaintyExponent | None]:
    """(of the boundary of overturning, of all boundaries)."""
    low, high = _corners(ends)
    tried = perturbed_triples(low, high, runs, random)
    starts = tried.reshape(-1, 2)
    if system.braces is not None:
        starts[:, 0] = np.clip(starts[:, 0], -system.braces.angle, system.braces.angle)
    answers = sampled(points_of(system, starts), measure, executor)
    labels, _ = label_attractors(system, answers)
    reach = distances((high[0] - low[0], high[1] - low[1]))
    overturned = (answers["kind"] == kernel.OVERTURNS).reshape(tried.shape[:3])
    return exponent(reach, overturned), exponent(reach, labels.reshape(tried.shape[:3]))
