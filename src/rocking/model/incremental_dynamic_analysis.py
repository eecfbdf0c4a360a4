"""Incremental dynamic analysis: the peak of a block over the intensity of each ground motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen

from rocking.model.block import Block
from rocking.model.fragility import runs_of
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.validation import reals, refusal

if TYPE_CHECKING:
    import xarray as xr

FRACTILES = (0.16, 0.5, 0.84)
ROUNDING = 1e-9


@frozen(eq=False)
class IncrementalDynamicAnalysis(NotebookPicture):
    """Peak of a block over the intensity of each ground motion; returned by `incremental_dynamic_analysis`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `record` and `scale` (the level of the intensity measure): `peak`, the largest |Θ|, infinite where the
        block overturns; `outcome`; `certified`, 0 where rounding may have changed the outcome; `margin` and `impacts`.
    block : Block
        Block.

    Examples
    --------
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(5, seed=1)
    >>> found = rk.incremental_dynamic_analysis(records, rk.Block(2.0, 0.5), [1.0, 2.0, 4.0])
    >>> found.fractiles().sizes["fractile"], bool(found.fractiles([0.5]).isel(scale=-1).item() == float("inf"))
    (3, True)
    """

    dataset: xr.Dataset = field(repr=False)
    block: Block

    def fractiles(self, of: Any = FRACTILES) -> xr.DataArray:
        """Return fractiles of the peak over the records at each level.

        A fractile is the smallest peak that at least this fraction of the records does not exceed. It is infinite where too
        many records overturn the block.

        Parameters
        ----------
        of : float or array (n,)
            Fractions in (0, 1]. Default: 0.16, 0.5 and 0.84.

        Returns
        -------
        xarray.DataArray
            Peaks |Θ| over `fractile` and `scale`.

        Raises
        ------
        TypeError, ValueError
            If a fraction is not a number in (0, 1].
        """
        import xarray as xr

        fractions = checked_fractions("of", of)
        peaks = np.sort(self.dataset.peak.transpose("record", "scale").values, axis=0)
        # 0.07 · 100 is 7.000000000000001 in double precision
        places = np.ceil(fractions * len(peaks) - ROUNDING).astype(int) - 1
        attributes = {"long_name": "largest absolute angle in units of theta_cr", "units": "1"}
        return xr.DataArray(
            peaks[places],
            {"fractile": ("fractile", fractions), "scale": self.dataset.scale},
            ("fractile", "scale"),
            "peak",
            attributes,
        )

    @property
    def scatter(self) -> xr.DataArray:
        """Record-to-record scatter at each level: ½ ln(peak at 84 %/peak at 16 %).

        It is infinite where more than 16 % of the records overturn the block, and NaN where the fractile at 16 % is 0 or
        infinite.
        """
        import xarray as xr

        low, high = self.fractiles([0.16, 0.84]).values
        with np.errstate(divide="ignore", invalid="ignore"):
            found = 0.5 * np.log(high / np.where((low > 0.0) & np.isfinite(low), low, np.nan))
        attributes = {"long_name": "record-to-record scatter of ln peak", "units": "1"}
        return xr.DataArray(found, {"scale": self.dataset.scale}, ("scale",), "scatter", attributes)

    def __str__(self) -> str:
        data = self.dataset
        fell = np.isinf(data.peak.values).any(axis=data.peak.get_axis_num("scale"))
        first = np.isinf(self.fractiles([0.5]).values[0])
        median = f"no level overturns half of them up to {_level(data, -1)}"
        if first.any():
            median = f"half of them overturn the block at {_level(data, int(first.argmax()))}"
        return f"{int(fell.sum())} of {fell.size} records overturn the block, {median}; {runs_of(data)}"


def checked_fractions(name: str, values: Any) -> np.ndarray:
    """Return fractions in (0, 1] as an array (n,), n >= 1; TypeError or ValueError for anything else."""
    found = np.atleast_1d(reals(name, values))
    if found.ndim != 1 or not found.size or not ((found > 0.0) & (found <= 1.0)).all():
        raise ValueError(refusal(name, "hold fractions in (0, 1]", values))
    return found


def _level(data: Any, place: int) -> str:
    unit = data.scale.attrs.get("units", "1")
    return f"{data.scale.attrs['symbol']} = {float(data.scale[place]):.4g}{'' if unit == '1' else ' ' + unit}"
