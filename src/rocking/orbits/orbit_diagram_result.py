"""Result of `orbit_diagram`: section points of sweeps."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.model.result import NotebookPicture, ReadOnlyArrays, described, named, read_only
from rocking.model.system import State, System
from rocking.orbits.dataset_attributes import coordinate_of
from rocking.orbits.parameter import fixed_quantities

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class OrbitDiagram(ReadOnlyArrays, NotebookPicture):
    """Section points over the values of a parameter; returned by `orbit_diagram`.

    Attributes
    ----------
    system : System
        System of which one parameter is varied.
    parameter : str
        Name of the parameter.
    values : ndarray, shape (n,)
        Values of the parameter, ascending.
    sweeps : tuple of str
        "up", "down" or both, or "rest": the first axis of the following arrays.
    points : ndarray, shape (sweeps, n, m, 2)
        Θ and Θ' on the section in successive cycles; NaN if the block overturned.
    overturned : ndarray of bool, shape (sweeps, n)
        True if overturning is proved.
    peak : ndarray, shape (sweeps, n)
        Largest |Θ| over the m cycles after the transient; NaN if the block overturned.
    start : State
        Initial state of the first motion, or of each.
    transient : int
        Number of cycles discarded before.
    section_phase : float
        Forcing phase ψ of the section, rad.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> diagram = rk.orbit_diagram(system, "amplitude", [1.5, 2.0], sweep="rest", cycles=4)
    >>> diagram.points.shape, bool(diagram.overturned.any())
    ((1, 2, 4, 2), False)
    """

    system: System
    parameter: str
    values: NDArray[np.float64] = field(repr=False, converter=read_only)
    sweeps: tuple[str, ...]
    points: NDArray[np.float64] = field(repr=False, converter=read_only)
    overturned: NDArray[np.bool_] = field(repr=False, converter=read_only)
    peak: NDArray[np.float64] = field(repr=False, converter=read_only)
    start: State
    transient: int
    section_phase: float

    @property
    def cycles(self) -> int:
        """Number of points at each value."""
        return self.points.shape[2]

    @property
    def fixed(self) -> dict[str, float]:
        """Parameters that were not varied, by name."""
        return fixed_quantities(self.system, self.parameter)

    def to_xarray(self) -> xr.Dataset:
        """Return the diagram as a dataset.

        Returns
        -------
        xarray.Dataset
            `angle` and `velocity` over `sweep`, the parameter and `cycle`; `overturned` and `peak` over the first two.
        """
        import xarray as xr

        name = self.parameter
        each, all_cycles = ("sweep", name), ("sweep", name, "cycle")
        variables = {
            "angle": (all_cycles, self.points[..., 0], named("angle at the section")),
            "velocity": (all_cycles, self.points[..., 1], named("angular velocity at the section")),
            "peak": (each, self.peak, named("largest magnitude of the angle after the transient")),
            "overturned": (
                each,
                self.overturned.astype(np.int8),
                {"long_name": "1 if overturning is proved", "flag_values": [0, 1]}
                | {"flag_meanings": "bounded overturned"},
            ),
        }
        coordinates = {
            "sweep": ("sweep", np.array(self.sweeps), {"long_name": "order of the values"}),
            name: coordinate_of(name, name, self.values),
            "cycle": ("cycle", np.arange(self.cycles), {"long_name": "forcing cycles since the transient"}),
        }
        attributes = described("Orbit diagram") | {
            "start_angle": self.start.angle,
            "start_velocity": self.start.velocity,
            "transient": self.transient,
            "section_phase": self.section_phase,
            **self.fixed,
        }
        return xr.Dataset(variables, coordinates, attributes)

    def __str__(self) -> str:
        values = self.values
        span = (
            f"{values[0]:.6g} to {values[-1]:.6g}, {len(values):,} values"
            if len(values) > 1
            else f"{values[0]:.6g}"
        )
        overturnings = "; ".join(
            _overturnings(way, fell, values) for way, fell in zip(self.sweeps, self.overturned, strict=True)
        )
        return f"orbit diagram over {self.parameter} {span}, {self.cycles:,} points each after {self.transient:,} cycles: {overturnings}"


def _overturnings(way: str, fell: np.ndarray, values: np.ndarray) -> str:
    how = {"up": "swept up", "down": "swept down", "rest": "each from the initial state"}[way]
    if not fell.any():
        return f"{how}, never overturned"
    found = values[fell]
    where = f"at {found[0]:.6g}" if len(found) == 1 else f"from {found[0]:.6g} to {found[-1]:.6g}"
    return (
        f"{how}, overturned at {len(found):,} ({where})" if len(found) > 1 else f"{how}, overturned {where}"
    )
