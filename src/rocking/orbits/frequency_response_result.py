"""Result of `frequency_response`: peaks along branches, and responses from rest."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.model.result import NotebookPicture, ReadOnlyArrays, described, named, read_only
from rocking.model.validation import whole
from rocking.orbits.branch import Branch
from rocking.orbits.dataset_attributes import LONG_NAMES, coordinate_of, kinds_of

if TYPE_CHECKING:
    import xarray as xr

MAX_CYCLES_IN_MODE = 99


@frozen(eq=False)
class FrequencyResponse(ReadOnlyArrays, NotebookPicture):
    """Peak rotation over the period or the frequency of the forcing; returned by `frequency_response`.

    Attributes
    ----------
    amplitude, restitution : float
        A and e.
    modes : tuple of int
        Numbers n of the (1, n) orbits: one rocking cycle in n forcing cycles.
    parameter : str
        "period" or "frequency".
    values : ndarray, shape (m,)
        Values of the parameter for the response from rest, ascending. The branches extend from the first to the last.
    branches : tuple of Branch
        For each n, the symmetric branches, each followed by the asymmetric ones that bifurcate from it. `points["peak"]` is
        the largest |Θ|. Of two branches that are mirror images, with equal peaks, one is included.
    rest : structured ndarray, shape (m,)
        Responses from rest, with the fields "kind" (see `Kind`), "period" in forcing cycles (0 if not periodic), "peak"
        (largest |Θ| from τ = 0) and "steady_peak" (largest |Θ| of the periodic response, NaN if there is none).

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.frequency_response(period=[0.5, 1.0], amplitude=2.0, restitution=0.925, modes=(1,))
    >>> found.rest["kind"].tolist(), len(found.of(1))
    (['periodic', 'periodic'], 1)
    """

    amplitude: float
    restitution: float
    modes: tuple[int, ...]
    parameter: str
    values: NDArray[np.float64] = field(repr=False, converter=read_only)
    branches: tuple[Branch, ...] = field(repr=False)
    rest: NDArray[np.void] = field(repr=False, converter=read_only)

    def of(self, n: int) -> tuple[Branch, ...]:
        """Return the branches of the (1, n) orbits.

        Parameters
        ----------
        n : int
            Number of forcing cycles per response period, in [1, 99].

        Returns
        -------
        tuple of Branch
            Branches; empty if none was found.

        Raises
        ------
        TypeError, ValueError
            If `n` is not a whole number in its range.
        """
        period = whole("n", n, 1, MAX_CYCLES_IN_MODE)
        return tuple(branch for branch in self.branches if branch.period == period)

    def to_xarray(self) -> xr.Dataset:
        """Return the frequency response as a dataset.

        Returns
        -------
        xarray.Dataset
            Response from rest along the parameter; points of all branches, one branch after the other, along `point`.
        """
        import xarray as xr

        name, rest = self.parameter, self.rest
        variables = {
            "rest_kind": kinds_of(name, rest["kind"], "type of the response from rest"),
            "rest_period": (
                name,
                rest["period"],
                named("forcing cycles per response period; 0 if not periodic"),
            ),
            "rest_peak": (
                name,
                rest["peak"],
                named("largest magnitude of the angle from the initial state on"),
            ),
            "rest_steady_peak": (
                name,
                rest["steady_peak"],
                named("largest magnitude of the angle of the steady response"),
            ),
        }
        counts = [len(branch) for branch in self.branches]
        for column, text in (
            ("parameter", LONG_NAMES[name]),
            ("stable", "1 if the orbit is stable"),
            ("peak", "largest magnitude of the angle of the orbit"),
        ):
            points = [branch.points[column] for branch in self.branches]
            together = np.concatenate(points) if points else np.empty(0)
            variables[f"branch_{column}"] = (
                "point",
                together.astype(np.int8 if column == "stable" else float),
                named(text),
            )
        for column, each, text in (
            ("number", range(len(counts)), "number of the branch"),
            ("mode", [branch.period for branch in self.branches], "n of the (1, n) orbits"),
            (
                "symmetric",
                [int(branch.symmetric) for branch in self.branches],
                "1 if the orbits are symmetric",
            ),
        ):
            variables[f"branch_{column}"] = (
                "point",
                np.repeat(np.array(each, np.int64), counts),
                {"long_name": text},
            )
        attributes = described("Frequency response") | {
            "amplitude": self.amplitude,
            "restitution": self.restitution,
            "phase": 0.0,
            "modes": list(self.modes),
        }
        coordinate = {name: coordinate_of(name, name, self.values)}
        return xr.Dataset(variables, coordinate, attributes)

    def __str__(self) -> str:
        found = "; ".join(_told(n, self.of(n)) for n in self.modes)
        kinds = Counter(str(kind) for kind in self.rest["kind"])
        rest = ", ".join(f"{number:,} {kind}" for kind, number in kinds.most_common())
        return (
            f"frequency response at amplitude {self.amplitude:.6g}, restitution {self.restitution:.6g}, {self.parameter} "
            f"{self.values[0]:.6g} to {self.values[-1]:.6g}: {found}; from rest {rest}"
        )


def _told(n: int, branches: Sequence[Branch]) -> str:
    if not branches:
        return f"(1, {n}) none found"
    symmetric = sum(branch.symmetric for branch in branches)
    peak = max(float(np.nanmax(branch.points["peak"])) for branch in branches)
    return f"(1, {n}) {symmetric} symmetric, {len(branches) - symmetric} asymmetric, peak up to {peak:.4g}"
