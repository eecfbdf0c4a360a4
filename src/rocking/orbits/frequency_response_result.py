"""A frequency response: the peaks of branches, and what starts from rest do."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.model import Kind, NotebookPicture, ReadOnlyArrays, read_only
from rocking.orbits.branch import Branch
from rocking.orbits.dataset_attributes import LONG_NAMES, described, named

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class FrequencyResponse(ReadOnlyArrays, NotebookPicture):
    """Peak rotation over the period or the frequency of the forcing; made by `frequency_response`.

    Attributes
    ----------
    amplitude, restitution : float
        A and e.
    modes : tuple of int
        The n of the (1, n) orbits followed: one rocking cycle in n forcing cycles.
    parameter : str
        "period" or "frequency".
    values : ndarray, shape (m,)
        Its values at which a start from rest was judged, ascending; the branches run from the first to the last.
    branches : tuple of Branch
        Of each n in turn the symmetric branches, each followed by the unsymmetric ones born from it; `points["peak"]` is the
        largest |Θ|. Of two branches that are mirror images of each other, and so have the same peaks, one.
    rest : structured array, shape (m,)
        What a start from rest does: "kind" (see `Kind`), "period" in forcing cycles (0 where it has none), "peak", the largest
        |Θ| from the start on, "steady_peak", that of the periodic response reached (NaN where there is none).
    """

    amplitude: float
    restitution: float
    modes: tuple[int, ...]
    parameter: str
    values: NDArray[np.float64] = field(repr=False, converter=read_only)
    branches: tuple[Branch, ...] = field(repr=False)
    rest: NDArray[np.void] = field(repr=False, converter=read_only)

    def of(self, n: int) -> tuple[Branch, ...]:
        """The branches of the (1, n) orbits."""
        return tuple(branch for branch in self.branches if branch.period == n)

    def to_xarray(self) -> xr.Dataset:
        """The start from rest along the parameter, and all branches, one after the other, along `point`."""
        import xarray as xr

        name, rest = self.parameter, self.rest
        kinds = [kind.value for kind in Kind]
        flags = {"flag_values": list(range(len(kinds))), "flag_meanings": " ".join(kinds)}
        codes = np.array([kinds.index(kind) for kind in rest["kind"]], np.uint8)
        variables = {
            "rest_kind": (name, codes, {"long_name": "what a start from rest does"} | flags),
            "rest_period": (
                name,
                rest["period"],
                named("forcing cycles of the response; 0 where it has none"),
            ),
            "rest_peak": (name, rest["peak"], named("largest size of the angle from the start on")),
            "rest_steady_peak": (
                name,
                rest["steady_peak"],
                named("largest size of the angle of the response"),
            ),
        }
        counts = [len(branch) for branch in self.branches]
        for column, text in (
            ("parameter", LONG_NAMES[name]),
            ("stable", "whether the orbit is stable"),
            ("peak", "largest size of the angle of the orbit"),
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
            ("symmetric", [int(branch.symmetric) for branch in self.branches], "whether they are symmetric"),
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
        coordinate = {name: (name, self.values, {"long_name": LONG_NAMES[name], "units": "1"})}
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
        return f"(1,{n}) none found"
    symmetric = sum(branch.symmetric for branch in branches)
    peak = max(float(np.nanmax(branch.points["peak"])) for branch in branches)
    return f"(1,{n}) {symmetric} symmetric, {len(branches) - symmetric} unsymmetric, peak up to {peak:.4g}"
