"""Set of the levels of ground motions that overturn a block: its switches and intervals."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen

from rocking.model.block import Block
from rocking.model.formatting import counted, percent
from rocking.model.ground_motion import GroundMotion
from rocking.model.ground_motion_checks import MAX_FACTOR
from rocking.model.intensity import Intensity, intensity_of
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.outcome import Outcome
from rocking.model.record_set import RecordSet
from rocking.model.validation import refuse_if, whole, within

if TYPE_CHECKING:
    import xarray as xr

SWITCH_ROW = np.dtype(
    [
        ("record", "i8"),
        ("level", "f8"),
        ("overturns_above", "?"),
        ("impacts_since_rest", "i8"),
        ("certified", "?"),
        ("certified_below", "f8"),
        ("certified_above", "f8"),
    ]
)
"""Row of `OverturningSet.switches`."""


def intervals_of(begins_overturned: bool, switches: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return the intervals (n, 2) of overturning levels in [low, high]; the ends overturn, too.

    A level of the ascending `switches` is the first one on its far side.
    """
    starts = switches["level"][switches["overturns_above"]]
    ends = np.nextafter(switches["level"][~switches["overturns_above"]], 0.0)
    if begins_overturned:
        starts = np.concatenate(([low], starts))
    if starts.size > ends.size:
        ends = np.concatenate((ends, [high]))
    return np.stack([starts, ends], axis=1)


@frozen(eq=False)
class OverturningSet(NotebookPicture):
    """Levels of an intensity measure at which ground motions overturn a block; returned by `overturning_set`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `record` and `scale`, the levels of the grid: `outcome`, `certified` and `impacts_since_rest`. Over
        `record`: `lowest` and `share`. Over `switch`: the columns of `switches`, with the prefix ``switch_``.
    records : RecordSet
        Ground motions.
    block : Block
        Block.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> push = rk.GroundMotion([1.0, 1.0], step=0.4, name="push")
    >>> print(rk.overturning_set(push, rk.Block(2.0, 0.5), np.linspace(0.1, 2, 20), intensity="pga-g"))
    1 record, 20 levels of PGA from 0.1 to 2 g: 1 switch; 85.6 % of the range overturns; lowest found 0.373175 g.
    Intervals and gaps narrower than 0.1 g may be missed
    """

    dataset: xr.Dataset = field(repr=False)
    records: RecordSet
    block: Block

    @property
    def measure(self) -> Intensity:
        """Intensity measure of the levels."""
        return intensity_of(self.dataset.attrs["intensity"], self.records)[0]

    @property
    def scales(self) -> np.ndarray:
        """Levels of the grid, shape (n_levels,)."""
        return np.asarray(self.dataset["scale"].values)

    @property
    def spacing(self) -> float:
        """Largest distance between two neighbouring levels. Intervals and gaps that are narrower may be missed."""
        return float(np.diff(self.scales).max())

    @property
    def overturned(self) -> np.ndarray:
        """Flag at each level of the grid: the block overturns; shape (n_records, n_levels)."""
        return np.asarray(self.dataset["outcome"].values == tuple(Outcome).index(Outcome.OVERTURNED))

    @property
    def outcome(self) -> np.ndarray:
        """Outcome at each level of the grid, as text; shape (n_records, n_levels)."""
        return np.array([str(each) for each in Outcome])[self.dataset["outcome"].values]

    @property
    def switches(self) -> np.ndarray:
        """Switches between standing and overturning, sorted by record and level; structured array (n,).

        - `record`: number of the record, from 0;
        - `level`: first level on the far side; the double below it has the other outcome;
        - `overturns_above`: whether the block overturns at `level`;
        - `impacts_since_rest`: mode of overturning, the impacts since the block last rested;
        - `certified`: whether no rounding error can have changed the outcomes on both sides, so that a switch exists;
        - `certified_below`, `certified_above`: closest levels found to have certified outcomes, NaN if none. A certified
          switch lies between them.
        """
        found = np.empty(self.dataset.sizes["switch"], SWITCH_ROW)
        for name in SWITCH_ROW.names or ():
            found[name] = self.dataset[f"switch_{name}"].values
        return found

    @property
    def undecided(self) -> np.ndarray:
        """Switches that rounding may have made; structured array (n,), empty for a full block, where it is not assessed."""
        found = self.switches
        assessed = self.dataset.attrs.get("model") != "full"
        return found[~found["certified"] & assessed]

    @property
    def lowest(self) -> np.ndarray:
        """Lowest overturning level that was found of each record, NaN if none; shape (n_records,).

        Narrow intervals below it may be missed, see `spacing`. More levels find more of them.
        """
        return np.asarray(self.dataset["lowest"].values)

    @property
    def share(self) -> np.ndarray:
        """Fraction of the range of the levels that overturns, for each record; shape (n_records,)."""
        return np.asarray(self.dataset["share"].values)

    def intervals(self, record: int = 0) -> np.ndarray:
        """Return the intervals of levels at which a record overturns the block.

        Parameters
        ----------
        record : int
            Number of the record, from 0. Default: 0.

        Returns
        -------
        array, shape (n, 2)
            Lowest and highest overturning level of each interval, ascending. They end with the range of the levels.

        Raises
        ------
        TypeError, ValueError
            If there is no such record.

        Examples
        --------
        >>> import rocking as rk
        >>> push = rk.GroundMotion([1.0, 1.0], step=0.4)
        >>> found = rk.overturning_set(push, rk.Block(2.0, 0.5), [2.0, 5.0, 15.0])
        >>> found.intervals().round(6).tolist()
        [[3.659594, 15.0]]
        """
        record = whole("record", record, 0, len(self.records) - 1)
        own = self.switches[self.switches["record"] == record]
        return intervals_of(bool(self.overturned[record, 0]), own, self.scales[0], self.scales[-1])

    def motion(self, record: int, level: float) -> GroundMotion:
        """Return a ground motion scaled to a level, exactly as the survey scales it.

        Parameters
        ----------
        record : int
            Number of the record, from 0.
        level : float
            Level of the intensity measure, in its unit.

        Returns
        -------
        GroundMotion
            Scaled motion, reversed if the polarity is -1.

        Raises
        ------
        TypeError, ValueError
            If there is no such record, or if the level is not positive.

        Examples
        --------
        >>> import rocking as rk
        >>> push = rk.GroundMotion([1.0, 1.0], step=0.4)
        >>> rk.overturning_set(push, rk.Block(2.0, 0.5), [5.0, 15.0], intensity="pga").motion(0, 7.5).pga
        7.5
        """
        record = whole("record", record, 0, len(self.records) - 1)
        level = within("level", level, 1e-300, 1e300)
        measure, values = intensity_of(self.dataset.attrs["intensity"], self.records)
        alpha, slenderness = self.block.frequency_parameter, self.block.critical_angle
        factor = measure.factor(level, float(values[record]), alpha, slenderness)
        refuse_if(factor > MAX_FACTOR, "level", f"scale the record by {MAX_FACTOR:g} at most", level)
        ground = self.records[record].scaled(factor)
        return ground.reversed() if self.dataset.attrs["polarity"] < 0 else ground

    def __str__(self) -> str:
        low, high = self.scales[[0, -1]]
        count = self.dataset.sizes["switch"]
        unit = "" if self.measure.unit in ("1", "") else f" {self.measure.unit}"
        start = (
            f"{counted(len(self.records), 'record')}, {self.scales.size:,} levels of {self.measure.symbol} from {low:.6g} "
            f"to {high:.6g}{unit}: {count:,} switch{'es' * (count != 1)}; "
        )
        if np.isnan(self.lowest).all():
            return f"{start}no level overturns"
        least = np.nanmin(self.lowest)
        return (
            f"{start}{percent(self.share.mean())} of the range overturns; lowest found {least:.6g}{unit}.\n"
            f"Intervals and gaps narrower than {self.spacing:.3g}{unit} may be missed"
        )
