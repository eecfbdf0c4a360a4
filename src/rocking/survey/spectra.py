"""Rocking spectra of blocks under ground motions, and overturning spectra of blocks under one pulse."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.block import RECTANGLE, Block, unrestrained
from rocking.model.block_formulas import frequency_parameter
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_set import RecordSet, record_set
from rocking.model.restitution import Restitution
from rocking.model.survey_results import OverturningSpectrum, RockingSpectrum
from rocking.model.system import System, left_quantities
from rocking.model.validation import Incomplete, Refusal, instance
from rocking.survey.ending_measures import ending, pulse_ending
from rocking.survey.engine import Engine
from rocking.survey.incremental_dynamic_analysis import with_names
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import HOUSNER, MotionSpec, motion_spec, pulse_spec

if TYPE_CHECKING:
    import xarray as xr


ROCKING_SPECTRUM = "Rocking spectrum of free-standing blocks under ground motions"


def rocking_spectrum(
    records: RecordSet | GroundMotion | Iterable[GroundMotion],
    block: Block | None = None,
    levels: Any = 1.0,
    *,
    size: Any = None,
    slenderness: Any = None,
    restitution: Any = None,
    inertia_ratio: float | None = None,
    intensity: str = "scale",
    angle: Any = 0.0,
    polarity: Any = "+",
    model: str = "full",
    normalised_by: str | None = None,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> RockingSpectrum:
    """Follow blocks of many sizes under ground motions to their ends: rocking spectra.

    Each quantity is a number or an ascending array. The arrays, and the records if there are several, are the dimensions of the
    result. Every run is exact and ends by proof, as in `simulate`.

    Parameters
    ----------
    records : RecordSet, GroundMotion or iterable of GroundMotion
        Ground motions.
    block : Block, optional
        Block of which some quantities vary; of an unsymmetric one, or against a wall, only the size. Default: none; then give its
        size and its slenderness.
    levels : float or array (n,)
        Levels of the intensity measure to which each record is scaled. Default: 1, with the measure "scale" the record as it is.
    size : float or array (n,), optional
        Distance R from a corner to the centre of mass, in metres, in [0.001, 1000]. Default: that of the block.
    slenderness : float or array (n,), optional
        Critical angle θcr in rad. Default: that of the block.
    restitution : float, array (n,) or Restitution, optional
        Coefficient of restitution e in [0, 1], or a law. Default: that of the block, or Housner's value for each slenderness.
    inertia_ratio : float, optional
        Io/(MR²), as for `Block`. Default: that of the block, or 4/3, a uniform rectangle.
    intensity : str
        Intensity measure of the levels: "scale" (a factor), "pga" (m/s²), "pga-g", "pgv" (m/s), "pgd" (m), "arias" (m/s) or
        "cav" (m/s). Those of the response spectrum, in m/s², are "sa(T)", "sa(T, ζ)" and the mean "sa-avg(T₁, T₂, …)", with
        periods in s, such as "sa(0.5)". Measures that depend on the block are "pga-ratio", PGA/(g tan θcr), and "pgv-ratio",
        α PGV/(g tan θcr). A column of the records is a measure, too. Default: "scale".
    angle : float or array (n,)
        Initial angle Θ in units of θcr. Default: 0, at rest.
    polarity : {"+", "-", "both", "worse"}
        Direction of the motion: as recorded, reversed, both as an axis, or of both runs the one
        that is worse for the block. A symmetric block at rest does not distinguish them. 1, -1 and [-1, 1] are allowed, too.
        Default: "+".
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`.
        Default: "full".
    normalised_by : {"angle", "tangent"}, optional
        Unit of the base acceleration of slender blocks, as for `Block.system`. Default: "tangent".
    store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    RockingSpectrum
        `.dataset` with `outcome`, `certified`, `peak`, `margin`, `impacts` and `impacts_since_rest`; `print` shows one line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    simulate : One motion, with its events.
    overturning_set : All levels that overturn a block.
    fragility : Probability of overturning.

    References
    ----------
    Makris & Konstantinidis, Earthquake Eng. Struct. Dyn. (2003).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> block = rk.Block(height=2.0, width=0.5)
    >>> result = rk.rocking_spectrum(rk.example_ground_motion(), block, size=np.linspace(0.5, 3, 6))
    >>> result.dataset.peak.dims, result.dataset.attrs["slenderness"] == block.critical_angle
    (('size',), True)
    """
    chosen = record_set(records)
    law, own_law = HOUSNER if block is None else instance("block", block, Block).law, restitution
    if restitution is not None:
        law = restitution if isinstance(restitution, Restitution) else HOUSNER
        restitution = law.value if isinstance(restitution, Restitution) else restitution
    sizes = {"size": size, "slenderness": slenderness, "restitution": restitution}
    if block is not None:
        unrestrained(block, "block", "a stiffness in N/m is for one size")
        given = {name: value for name, value in sizes.items() if value is not None}
        sizes = quantities_of_block(block) | given
        _check_shape(block, slenderness=slenderness, restitution=own_law, inertia_ratio=inertia_ratio)
        if own_law is not None:
            sizes["restitution"] = restitution
        inertia_ratio = block.inertia_ratio if inertia_ratio is None else inertia_ratio
    missing = [f"{{{name}}}" for name in ("size", "slenderness") if sizes.get(name) is None]
    if missing:
        remedy = "or give a {block}, which has both"
        raise Incomplete("a rocking spectrum", " and ".join(missing), remedy=remedy)
    spec = motion_spec(
        chosen,
        sizes | {"angle": angle, "polarity": polarity, "level": levels},
        intensity=intensity,
        inertia_ratio=RECTANGLE if inertia_ratio is None else inertia_ratio,
        model=model,
        normalised_by=normalised_by,
        law=law,
    )
    data = run_survey(spec, ending(ROCKING_SPECTRUM), store, executor, progress=progress, repair=repair)
    return RockingSpectrum(described(data, spec, chosen))


def quantities_of_block(block: Block) -> dict[str, Any]:
    """Return size, slenderness and restitution of a block, and its left side if it differs.

    The restitution is None if its law is no number and the sides are equal.
    """
    restitution = block.restitution if instance("block", block, Block).left is not None else block.law.value
    sizes = {"size": block.radius, "slenderness": block.critical_angle, "restitution": restitution}
    return sizes | left_quantities(block.left)


def _check_shape(block: Block, **given: Any) -> None:
    """Refuse quantities of the shape for an unsymmetric block, or against a wall, of which only the size may vary."""
    for name, value in given.items():
        if block.left is not None and value is not None:
            what = "an unsymmetric block" if block.wall is None else "a block against a wall"
            raise Refusal(name, f"be omitted for {what}, whose shape is that of {{block}}", value)


def described(data: xr.Dataset, spec: MotionSpec, records: RecordSet) -> xr.Dataset:
    """Return a dataset with names and peak accelerations of its records, and α of its sizes."""
    if "record" in data.dims:
        pga = np.array([motion.pga for motion in records])
        metadata = {"long_name": "peak ground acceleration", "units": "m/s²"}
        data = with_names(data, records).assign_coords(pga=("record", pga, metadata))
    else:
        data.attrs["record"] = records.names[0]
    if "size" in data.dims:
        ratio = spec.fixed["inertia_ratio"]
        alpha = [frequency_parameter(size, ratio) for size in data["size"].values.tolist()]
        metadata = {"long_name": "frequency parameter", "symbol": "α", "units": "1/s"}
        data = data.assign_coords(frequency_parameter=("size", np.array(alpha), metadata))
    return data


OVERTURNING_SPECTRUM = "Overturning spectrum of a block under one pulse"


def overturning_spectrum(
    system: System,
    *,
    amplitude: Any,
    frequency: Any,
    restitution: Any = None,
    critical_angle: Any = None,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    progress: bool = False,
    repair: bool = False,
) -> OverturningSpectrum:
    """Follow blocks at rest under one pulse, over its amplitude and frequency: overturning spectrum.

    Parameters
    ----------
    system : System
        Block under one pulse, of any amplitude and duration, without braces.
    amplitude : array (n,)
        Ascending amplitudes A in the unit of the system, in [0, 1000]: g θcr, or g tan θcr as `System.normalised_by` says.
        `system.block.amplitude(acceleration)` converts m/s².
    frequency : array (m,)
        Ascending normalised frequencies Ω = ω/α, in [0.001, 1000]. The pulse lasts one period 2π/Ω, a half-sine half
        of it. For a Ricker pulse the period is Tp.
    restitution, critical_angle : array (k,), optional
        Further axes: coefficient of restitution e, and critical angle θcr in rad of the full equation of motion. Default: those of
        the system.
    store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    OverturningSpectrum
        `.dataset` over the axes with `outcome`, `certified`, `peak`, `margin`, `impacts` and `impacts_since_rest`; `print` shows one
        line.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    overturning_set : All levels of a ground motion that overturn a block.
    rocking_spectrum : Blocks of many sizes under ground motions.
    rocking.plot.overturning_spectrum : Plot the outcomes.

    References
    ----------
    Zhang & Makris, J. Eng. Mech. 127, 473–483 (2001).

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Pulse("one-sine", amplitude=5.0, duration=1.0), restitution=0.9)
    >>> result = rk.overturning_spectrum(system, amplitude=[3.0, 4.0, 7.0, 8.0], frequency=[4, 5]).dataset
    >>> (result.outcome.sel(frequency=5) == 2).values.tolist()
    [False, True, False, True]
    >>> result.impacts_since_rest.sel(frequency=5).values[[1, 3]].tolist()
    [1, 0]
    """
    axes = {
        "amplitude": amplitude,
        "frequency": frequency,
        "restitution": restitution,
        "critical_angle": critical_angle,
    }
    spec, measure = pulse_spec(system, axes), pulse_ending(OVERTURNING_SPECTRUM)
    data = run_survey(spec, measure, store, executor, progress=progress, repair=repair)
    return OverturningSpectrum(data, system=system)
