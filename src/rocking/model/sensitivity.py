"""Sensitivity of verdicts to small changes of the ground motion and of the block."""

from __future__ import annotations

from typing import TYPE_CHECKING

from attrs import field, frozen

from rocking.model.block import Block
from rocking.model.formatting import counted, percent_with_ends

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class Sensitivity:
    """Fraction of verdicts that small changes reverse; returned by `sensitivity`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `change`:

        - `share`: fraction of the runs whose verdict (overturned or not) differs;
        - `share_low`, `share_high`: ends of its 95 % interval;
        - `flipped`, `runs`, `undecided`: numbers of runs.

        Variables over `record` and `scale`: `overturned`, the verdict without a change, and, also over `change`, `differs`.
    block : Block
        Block.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.sensitivity(rk.synthetic_ground_motions(5, seed=1), rk.Block(2.0, 0.5), [3.0, 4.0], intensity="pga")
    >>> found.dataset.share.dims, int(found.dataset.runs[0])
    (('change',), 10)
    """

    dataset: xr.Dataset = field(repr=False)
    block: Block

    def __str__(self) -> str:
        data = self.dataset
        parts = [
            f"{name} {percent_with_ends(share, low, high)}"
            for name, share, low, high in zip(
                *(data[name].values.tolist() for name in ("change", "share", "share_low", "share_high")),
                strict=True,
            )
        ]
        records = counted(data.sizes["record"], "record")
        return (
            f"verdicts that change, of {counted(int(data.runs[0]), 'run')} of {records}: {', '.join(parts)}"
        )
