"""Overturning spectrum: outcomes of blocks under one pulse, over its amplitude and frequency."""

from __future__ import annotations

import os
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

from rocking.survey.engine.run_survey import run_survey
from rocking.survey.measures.pulse_ending import pulse_ending
from rocking.survey.pulse_spec import pulse_question

if TYPE_CHECKING:
    import xarray as xr

TITLE = "Overturning spectrum of a block under one pulse"


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
    return run_survey(asked, pulse_ending(TITLE), store, executor, progress=progress, repair=repair)
