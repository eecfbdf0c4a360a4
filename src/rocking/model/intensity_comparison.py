"""Result of the comparison of intensity measures: how well each explains the overturning of one block."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen

from rocking.model.block import Block
from rocking.model.result import Result
from rocking.model.text import counted, percent

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class IntensityComparison(Result):
    """Efficiency and sufficiency of intensity measures for one block; returned by `compare_intensities`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `measure`, the most efficient one first:

        - `symbol` and `unit`;
        - `median`: level at which half of the records overturn the block, with the ends `median_low` and `median_high` of its
          95 % interval;
        - `dispersion`: standard deviation β of the logarithm of the level, with `dispersion_low` and `dispersion_high`;
        - `factor_dispersion`: that of the logarithm of the factor of a motion, by which measures are compared. It is β, and β/2
          for the Arias intensity, which grows with the square of the factor. Its interval has the same names;
        - `most_efficient`: fraction of the bootstrap replicates in which this dispersion is the smallest.

        `p_value` over `measure` and `quantity`: the p-value of the hypothesis that the level does not depend on the quantity
        of the records. `capacity` over `measure` and `record`: the overturning level of a record. Over `record`:

        - `factor`: the same as a factor of the record;
        - `within`: standard deviation of the logarithms of its switches about it;
        - `bound`: "at least" where the block stands at the highest level, "at most" where it overturns at the lowest one, else "".

        The attribute `within_dispersion` is the root of the mean square of `within`.
    block : Block
        Block.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(12, seed=1)
    >>> levels = rk.overturning_set(records, rk.Block(2.0, 0.5), np.linspace(0.5, 5, 46))
    >>> result = rk.compare_intensities(levels, ["pga", "pgv"])
    >>> result.dataset.measure.values.tolist(), result.dataset.p_value.dims
    (['pga', 'pgv'], ('measure', 'quantity'))
    """

    LONG = ("measure_record",)

    dataset: xr.Dataset = field(repr=False)
    block: Block

    def _data(self) -> xr.Dataset:
        """Return the dataset with a column of p-values for each quantity in the table of the measures."""
        data = self.dataset
        columns = {
            f"p_{name}": data.p_value.sel(quantity=name, drop=True)
            for name in data["quantity"].values.tolist()
        }
        first = [name for name, each in data.data_vars.items() if each.dims == ("measure",)]
        return data[first].assign(columns).merge(data.drop_vars("p_value"), combine_attrs="override")

    def __str__(self) -> str:
        data = self.dataset
        bounds = data.bound.values
        beyond = [
            f"{count} {place} the levels"
            for count, place in (
                ((bounds == "at least").sum(), "above"),
                ((bounds == "at most").sum(), "below"),
            )
            if count
        ]
        records = ", ".join([counted(data.sizes["record"], "record"), *beyond])
        lines = [f"overturning under {records}; the most efficient measure first:"]
        heads = ["measure", "median", "dispersion of the factor", "smallest in"]
        heads += [f"p: {name}" for name in data["quantity"].values.tolist()]
        rows = [heads, *(self._row(place) for place in range(data.sizes["measure"]))]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines += [
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
            for row in rows
        ]
        within = data.attrs["within_dispersion"]
        lines.append(f"within a record the factor has a dispersion of {within:.3f}, which no measure removes")
        return "\n".join(lines)

    def _row(self, place: int) -> list[str]:
        """Return the cells of a measure."""
        data = self.dataset.isel(measure=place)
        unit = "" if data.unit == "1" else f" {data.unit.item()}"
        deviation, low, high = (data[f"factor_dispersion{end}"].item() for end in ("", "_low", "_high"))
        return [
            data.symbol.item(),
            f"{data['median'].item():.4g}{unit}",
            f"{deviation:.3f} ({low:.3f}–{high:.3f})",
            percent(data.most_efficient.item()),
            *("–" if np.isnan(each) else f"{each:.2g}" for each in data.p_value.values.tolist()),
        ]
