"""Rocking spectra of blocks under ground motions, and overturning spectra of blocks under one pulse."""

from __future__ import annotations

import os
from collections.abc import Iterable
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.block import RECTANGLE
from rocking.model.block_formulas import frequency_parameter
from rocking.model.ground_motion import GroundMotion
from rocking.model.record_set import RecordSet, record_set
from rocking.survey.ending_measures import ending, pulse_ending
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import MotionSpec, motion_question, pulse_question

if TYPE_CHECKING:
    import xarray as xr


ROCKING_SPECTRUM = "Rocking spectrum of free-standing blocks under ground motions"


def rocking_spectrum(
    records: RecordSet | GroundMotion | Iterable[GroundMotion],
    *,
    size: Any,
    slenderness: Any,
    restitution: Any = None,
    inertia_ratio: float = RECTANGLE,
    scale: Any = 1.0,
    intensity: str = "scale",
    angle: Any = 0.0,
    polarity: Any = 1.0,
    model: str = "slender",
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: bool = False,
    repair: bool = False,
) -> xr.Dataset:
    """Follow blocks of many sizes under ground motions to their ends: rocking spectra.

    Each quantity is a number or an ascending array. The arrays, and the records if there are several, are the dimensions of the
    result. Every run is exact and ends by proof, as in `simulate`.

    Parameters
    ----------
    records : RecordSet, GroundMotion or iterable of GroundMotion
        Ground motions.
    size : float or array (n,)
        Distance R from a corner to the centre of mass, in metres, in [0.001, 1000]: ``block.radius``.
    slenderness : float or array (n,)
        Critical angle θcr in rad: ``block.critical_angle``.
    restitution : float or array (n,), optional
        Coefficient of restitution e in [0, 1]. Default: Housner's value for each slenderness.
    inertia_ratio : float
        Io/(MR²), as for `Block`. Default: 4/3, a uniform rectangle.
    scale : float or array (n,)
        Levels of the intensity measure to which each record is scaled. Default: 1, with the measure "scale" the record as it is.
    intensity : str
        Intensity measure of `scale`: "scale" (a factor), "pga" (m/s²), "pga-g", "pgv" (m/s), "pgd" (m) or "arias" (m/s).
        Measures that depend on the block are "pga-ratio", PGA/(g tan θcr), and "pgv-ratio", α PGV/(g tan θcr). A column of the
        records is a measure, too. Default: "scale".
    angle : float or array (n,)
        Initial angle Θ in units of θcr. Default: 0, at rest.
    polarity : float or array
        1, -1 for the opposite direction of the motion, or [-1, 1] for both. Default: 1.
    model : {"slender", "full"}
        Equation of motion, as for `Block.system`. With "full", `certified` is not assessed and `margin` is NaN.
        Default: "slender".
    store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    xarray.Dataset
        `outcome` and `certified` (codes explained by their attributes), `peak` (largest |Θ|, infinite if the block
        overturns), `margin`, `impacts` and `impacts_since_rest`. Impacts of chattering sequences are cut short.
        Coordinates `name` and `pga` describe the records, `frequency_parameter` the sizes.

    Raises
    ------
    TypeError, ValueError, ImportError, OSError
        As in `parametric_map`.

    See Also
    --------
    simulate : One motion, with its events.
    overturning_set : All scales that overturn a block.
    fragility : Probability of overturning.

    References
    ----------
    Makris & Konstantinidis, Earthquake Eng. Struct. Dyn. (2003).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> found = rk.rocking_spectrum(rk.example_ground_motion(), size=np.linspace(0.5, 3, 6), slenderness=0.2)
    >>> found.peak.dims, found.attrs["slenderness"]
    (('size',), 0.2)
    """
    chosen = record_set(records)
    asked = motion_question(
        chosen,
        {
            "size": size,
            "slenderness": slenderness,
            "restitution": restitution,
            "angle": angle,
            "polarity": polarity,
            "scale": scale,
        },
        intensity=intensity,
        inertia_ratio=inertia_ratio,
        model=model,
    )
    found = run_survey(asked, ending(ROCKING_SPECTRUM), store, executor, progress=progress, repair=repair)
    return described(found, asked, chosen)


def described(found: xr.Dataset, asked: MotionSpec, records: RecordSet) -> xr.Dataset:
    """Return a dataset with names and peak accelerations of its records, and α of its sizes."""
    if "record" in found.dims:
        pga = np.array([motion.pga for motion in records])
        metadata = {"long_name": "peak ground acceleration", "units": "m/s²"}
        found = found.assign_coords(
            name=("record", list(records.names), {"long_name": "record"}), pga=("record", pga, metadata)
        )
    else:
        found.attrs["record"] = records.names[0]
    if "size" in found.dims:
        ratio = asked.fixed["inertia_ratio"]
        alpha = [frequency_parameter(size, ratio) for size in found["size"].values.tolist()]
        metadata = {"long_name": "frequency parameter", "symbol": "α", "units": "1/s"}
        found = found.assign_coords(frequency_parameter=("size", np.array(alpha), metadata))
    return found


OVERTURNING_SPECTRUM = "Overturning spectrum of a block under one pulse"


def overturning_spectrum(
    kind: str,
    *,
    amplitude: Any,
    frequency: Any,
    restitution: Any,
    critical_angle: Any = None,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    progress: bool = False,
    repair: bool = False,
) -> xr.Dataset:
    """Follow blocks at rest under one pulse, over its amplitude and frequency: overturning spectrum.

    Parameters
    ----------
    kind : str
        Form of the pulse, as for `Pulse`.
    amplitude : array (n,)
        Ascending amplitudes A = a/(g θcr), in [0, 1000].
    frequency : array (m,)
        Ascending normalised frequencies Ω = ω/α, in [0.001, 1000]. The pulse lasts one period 2π/Ω, a half-sine half
        of it. For a Ricker pulse the period is Tp.
    restitution : float or array (k,)
        Coefficient of restitution e in [0, 1].
    critical_angle : float or array (l,), optional
        Critical angle θcr in rad of the full equation of motion, in [0.001, 1.2]. Default: the slender block.
    store, executor, progress, repair
        As in `parametric_map`.

    Returns
    -------
    xarray.Dataset
        Variables over `amplitude`, `frequency` and, if they vary, `restitution` and `critical_angle`. `outcome` and `certified` are codes
        that their attributes explain. `peak` is the largest |Θ|, infinite if the block overturns. `margin` and `impacts` are as
        in `rocking_spectrum`. `impacts_since_rest` of a block that overturns is the mode of overturning.

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
    >>> found = rk.overturning_spectrum("one-sine", amplitude=[3.0, 4.0, 7.0, 8.0], frequency=[4, 5], restitution=0.9)
    >>> (found.outcome.sel(frequency=5) == 2).values.tolist()
    [False, True, False, True]
    >>> found.impacts_since_rest.sel(frequency=5).values[[1, 3]].tolist()
    [1, 0]
    """
    asked = pulse_question(kind, amplitude, frequency, restitution, critical_angle)
    return run_survey(
        asked, pulse_ending(OVERTURNING_SPECTRUM), store, executor, progress=progress, repair=repair
    )
