"""Basins of attraction with the uncertainty exponents of their boundaries, and safe basins over the amplitude."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.kernels.classify import verdict as kernel
from rocking.model.quantity import ANGLE
from rocking.model.share import Share, interval_variables, shares_of
from rocking.model.survey_results import Attractor, BasinMap, SafeBasin
from rocking.model.system import System, check_between
from rocking.model.validation import instance, refuse_if, whole, within
from rocking.model.verdict import Kind
from rocking.survey.attractors import destination, label_attractors, make_attractors
from rocking.survey.engine import Engine
from rocking.survey.memory import attributes
from rocking.survey.random_points import MAX_SAMPLES, generator, random_starts, span
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import (
    HarmonicSpec,
    by_period,
    coordinate,
    harmonic_spec,
    system_quantities,
)
from rocking.survey.uncertainty_exponent import WIDTHS, Boundaries
from rocking.survey.verdict_measures import outcome
from rocking.theory import heteroclinic_amplitude, melnikov_amplitude

if TYPE_CHECKING:
    import xarray as xr


BASINS = "Basins of attraction of a free-standing block on a shaking base"


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
    boundary_width: float | None = None,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> BasinMap:
    """Compute basins of attraction: the attractor, rest or overturning to which each initial state leads.

    Parameters
    ----------
    system : System
        The block, its forcing and its braces.
    angle, velocity : array (n,) or pair
        Initial angles Θ and angular velocities Θ'. Without `samples` the axes of a grid, ascending; with `samples`
        ranges (low, high) from which the initial states are drawn.
    samples : int, optional
        Number of random initial states, which replace the grid, in [1, 10⁷]. Default: a grid.
    seed : int
        Random seed in [0, 2³² − 1]. The same seed gives the same initial states. Default: 0.
    max_cycles, max_period : int
        As in `classify`. A response is classified as chaotic after 10⁴ cycles at the earliest (with braces 10⁵).
        Default: 10,000 and 64.
    boundary_runs : int
        Approximate number of additional runs for the uncertainty exponents; 0 disables them. Default: 100,000.
    boundary_width : float, optional
        Largest width of the intervals of both exponents, in [1e-4, 1]. More runs are added to `boundary_runs` until the intervals
        are narrower, until further runs narrow them no more, or until there are 10⁷ runs. Default: no further runs.
    store, executor, progress, repair
        As in `parametric_map`. A store does not hold the further runs. The progress bars include them.

    Returns
    -------
    BasinMap
        `.attractors` with their `.fractions`, `.uncertainty_exponent`, `.attractor_exponent` and `.dataset`; `print`
        shows one line. Attractors are distinguished by their orbits, so that an asymmetric orbit and its mirror image
        count as two.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    safe_basin : Fraction of safe initial states over the amplitude.
    find_orbits : Search for periodic orbits.
    rocking.plot.basins : Plot the basins.

    Notes
    -----
    The intervals of the fractions are Wilson's at 95 %. Their upper ends assume that all undetermined initial states
    belong to the attractor. They hold for random initial states; a grid is treated as an equal number of random ones.
    The error of a grid is usually smaller: about the fraction of cells on a boundary, divided by the square root of
    their number. A grid does not resolve structure between its points.

    Not guaranteed: what `classify` does not guarantee. Orbits closer to each other than 10⁻⁶ count as one. All
    quasi-periodic responses count as one, and so do all undamped chaotic responses. Other chaotic responses count as
    one if their mean angles on the section differ by less than ten standard errors. This distinguishes two chaotic
    attractors that are mirror images of each other, but not two with equal means. An exponent holds for the tested
    distances, 2⁻⁶ to 2⁻¹³ of the width of the range of initial states. A boundary may be smooth on a finer scale.

    References
    ----------
    McDonald, Grebogi, Ott & Yorke, Physica D 17, 125–153 (1985).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=3.5, period=1.0), restitution=0.8)
    >>> starts = np.linspace(-1, 1, 41)
    >>> result = rk.basin_map(system, angle=starts, velocity=starts, boundary_runs=0)
    >>> [each.name for each in result.attractors]
    ['period 1, symmetric', 'overturned', 'period 3, symmetric']
    """
    instance("system", system, System)
    measure = destination(max_cycles, max_period, BASINS)
    runs = whole("boundary_runs", boundary_runs, 0, MAX_SAMPLES)
    width = math.inf if boundary_width is None else within("boundary_width", boundary_width, *WIDTHS)
    refuse_if(runs == 0 and width < math.inf, "boundary_runs", "be positive to be added to", runs)
    random = generator(seed)
    if samples is None:
        axes = {"angle": angle, "velocity": velocity}
        spec = harmonic_spec(by_period(system), axes, 2, "a basin map")
        data = run_survey(spec, measure, store, executor, progress=progress, repair=repair).load()
        ends = {name: (values[0], values[-1]) for name, values in spec.axes.items()}
        starts = grid_starts(spec)
    else:
        ends = {name: span(name, v) for name, v in (("velocity", velocity), ("angle", angle))}
        reach = ANGLE.range[1] if system.braces is None else system.braces.angle
        check_between(max(ends["angle"], key=abs), reach)
        fixed = HarmonicSpec({}, by_period(system))
        drawn = random_starts(fixed, ends, samples, random, seed)
        data = run_survey(drawn, measure, store, executor, progress=progress, repair=repair).load()
        starts = np.column_stack([drawn.drawn["angle"], drawn.drawn["velocity"]])
        data = _random_dataset(data, starts, attributes(fixed, measure) | {"seed": seed})
    labels, first = label_attractors(system, {str(name): data[name].values for name in data.data_vars})
    attractors = make_attractors(system, starts, first, max_cycles, max_period)
    _attach(data, labels, [each.name for each in attractors])
    fractions = _fractions(np.bincount(labels), attractors)
    boundaries = Boundaries(system, *_corners(ends), random, measure, executor, progress)
    return BasinMap(system, data, attractors, fractions, *boundaries.exponents(runs, width))


def _fractions(counts: np.ndarray, attractors: tuple[Attractor, ...]) -> tuple[Share, ...]:
    """Return the fraction of each attractor; undetermined initial states may belong to any of them."""
    undetermined = np.array([each.kind is Kind.UNDETERMINED for each in attractors])
    return shares_of(counts, counts.sum(), np.where(undetermined, 0, counts[undetermined].sum()))


def grid_starts(spec: HarmonicSpec) -> np.ndarray:
    """Return the initial states (n, 2) of a grid, in C order."""
    grid = dict(zip(spec.axes, np.meshgrid(*spec.axes.values(), indexing="ij"), strict=True))
    return np.column_stack([grid["angle"].ravel(), grid["velocity"].ravel()])


def _corners(ends: dict[str, tuple[float, float]]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the lowest and the highest initial state."""
    (a, b), (c, d) = ends["angle"], ends["velocity"]
    return (a, c), (b, d)


def _random_dataset(data: xr.Dataset, starts: np.ndarray, metadata: dict[str, Any]) -> xr.Dataset:
    """Return the dataset of random initial states, which have their angles and velocities instead of numbers."""
    names = zip(("angle", "velocity"), starts.T, strict=True)
    result = data.drop_vars("sample").assign_coords(
        {name: ("sample", values, coordinate(name)) for name, values in names}
    )
    result.attrs = metadata
    return result


def _attach(data: xr.Dataset, labels: np.ndarray, names: list[str]) -> None:
    """Add the variable `attractor`, the attractor of each initial state, to a dataset."""
    words = [name.replace(",", "").replace("(", "").replace(")", "").replace(" ", "-") for name in names]
    metadata = {
        "long_name": "attractor of the initial state, in descending order of area fraction",
        "flag_values": np.arange(len(names), dtype=np.int32),
        "flag_meanings": " ".join(words),
    }
    data["attractor"] = (data.kind.dims, labels.reshape(data.kind.shape).astype(np.int32), metadata)


SAFE_BASIN = "Safe basin of a free-standing block on a shaking base"


def safe_basin(
    system: System,
    *,
    amplitude: Any,
    angle: Any = (-1.0, 1.0),
    velocity: Any = (-1.0, 1.0),
    samples: int = 10_000,
    seed: int = 0,
    max_cycles: int = 10_000,
    max_period: int = 64,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> SafeBasin:
    """Estimate the fraction of initial states that do not overturn, over the amplitude.

    The result includes the thresholds A* and A_M of the amplitude.

    For e > 0 and A* < A < √(1 + Ω²) the boundary of the overturning initial states is fractal (`horseshoe`).
    The safe fraction does not necessarily decrease
    from there on. Both thresholds hold for a slender, symmetric block without braces, and are NaN
    for any other.

    Parameters
    ----------
    system : System
        Block on a harmonic base, of any amplitude.
    amplitude : array (n,)
        Amplitudes A, ascending.
    angle, velocity : pair
        Ranges (low, high) from which the initial states (Θ, Θ') are drawn. Default: (−1, 1).
    samples : int
        Number of initial states, in [1, 10⁷], the same ones at each amplitude. Default: 10,000.
    seed : int
        Random seed in [0, 2³² − 1]. Default: 0.
    max_cycles, max_period : int
        As in `classify`. Default: 10,000 and 64.
    store, executor, progress, repair
        As in `parametric_map`. More samples of the same seed, and more amplitudes, extend a store.

    Returns
    -------
    SafeBasin
        `.dataset`, `.shares`, `.heteroclinic_amplitude` and `.melnikov_amplitude`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    basin_map : Basins at one amplitude.
    overturning_amplitude : Lowest overturning amplitude from rest.
    rocking.plot.safe_basin : Plot the fraction.

    Notes
    -----
    The intervals are Wilson's at 95 %. Because the initial states are the same, the difference of the fractions at two
    amplitudes is more certain than their intervals suggest.
    Not guaranteed: that undetermined and chaotic responses never overturn. Both count as safe.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=3.5, period=1.0), restitution=0.8)
    >>> result = rk.safe_basin(system, amplitude=[3.3, 3.7, 5.5], samples=500)
    >>> result.dataset.safe.dims, round(result.heteroclinic_amplitude, 4)
    (('amplitude',), 3.6878)
    """
    measure = outcome(max_cycles, max_period, SAFE_BASIN)
    spec = harmonic_spec(system_quantities(system), {"amplitude": amplitude}, 1, "a safe basin")
    reach = ANGLE.range if system.braces is None else (-system.braces.angle, system.braces.angle)
    ends = {"angle": span("angle", angle, reach), "velocity": span("velocity", velocity)}
    drawn = random_starts(spec, ends, samples, generator(seed), seed)
    data = run_survey(drawn, measure, store, executor, progress=progress, repair=repair)
    return SafeBasin(*_summed_up(spec, measure, data.kind.values, drawn.stated), system=system)


def _summed_up(
    spec: HarmonicSpec, measure: Any, kinds: np.ndarray, drawn: dict[str, Any]
) -> tuple[xr.Dataset, tuple[Share, ...], float, float]:
    import xarray as xr

    safe = shares_of(np.count_nonzero(kinds != kernel.OVERTURNS, axis=1), kinds.shape[1])
    period = spec.fixed.get("period") or 2.0 * np.pi / spec.fixed["frequency"]
    exact = first_order = np.nan
    if spec.has_tangency:
        exact = heteroclinic_amplitude(period, spec.fixed["restitution"])
        first_order = melnikov_amplitude(period, spec.fixed["restitution"])
    meaning = "fraction of the initial states that do not overturn"
    variables = interval_variables("amplitude", safe, "safe", meaning)
    variables["undetermined"] = (
        "amplitude",
        np.mean(kinds == kernel.UNDETERMINED, axis=1),
        {"long_name": "fraction of the initial states whose response is undetermined", "units": "1"},
    )
    metadata = attributes(spec, measure) | {
        "samples": kinds.shape[1],
        **drawn,
        "heteroclinic_amplitude": exact,
        "melnikov_amplitude": first_order,
    }
    coordinates = {"amplitude": ("amplitude", spec.axes["amplitude"], coordinate("amplitude"))}
    return xr.Dataset(variables, coordinates, metadata), safe, exact, first_order
