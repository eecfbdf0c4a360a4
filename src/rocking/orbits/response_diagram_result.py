"""Result of `response_diagram`: verdicts, exponents and rotation numbers over the values of a parameter."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen
from numpy.typing import NDArray

from rocking.model.result import NotebookPicture, ReadOnlyArrays, described, named, read_only
from rocking.model.system import State, System
from rocking.model.verdict import Kind, Verdict
from rocking.orbits.dataset_attributes import coordinate_of, kinds_of
from rocking.orbits.parameter import fixed_quantities
from rocking.response.rotation_number import RotationNumber

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class ResponseDiagram(ReadOnlyArrays, NotebookPicture):
    """Responses over the values of a parameter; returned by `response_diagram`.

    Attributes
    ----------
    system : System
        System of which one parameter is varied.
    parameter : str
        Name of the parameter.
    values : ndarray, shape (n,)
        Values of the parameter, ascending.
    start : State
        Initial state of each motion.
    verdicts : tuple of Verdict
        Verdict at each value, with its evidence.
    rotation, rotation_error : ndarray, shape (n,)
        Rotation number: mean number of impacts per forcing cycle, and its error. NaN without a rotation number. The error is 0
        for a periodic response, and if all cycles of a chaotic run have the same number of impacts. It is infinite if the run
        supports no error.
    rotation_numbers : tuple
        Result of `rotation_number` at each value, with the rotation within an island; None if it was not computed.
    max_cycles, max_period : int
        Limits of each verdict, as in `classify`.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> found = rk.response_diagram(system, "amplitude", [0.5, 2.0])
    >>> print(found)
    response diagram over amplitude 0.5 to 2, 2 values, each from Θ = 0, Θ' = 0: 1 rest, 1 periodic (period 1)
    >>> found.exponent.round(4).tolist(), found.rotation.tolist()
    ([-inf, -0.1559], [0.0, 2.0])
    """

    system: System
    parameter: str
    values: NDArray[np.float64] = field(repr=False, converter=read_only)
    start: State
    verdicts: tuple[Verdict, ...] = field(repr=False)
    rotation: NDArray[np.float64] = field(repr=False, converter=read_only)
    rotation_error: NDArray[np.float64] = field(repr=False, converter=read_only)
    rotation_numbers: tuple[RotationNumber | None, ...] = field(repr=False)
    max_cycles: int
    max_period: int

    @property
    def kind(self) -> NDArray[np.str_]:
        """Types of response, shape (n,), as in `Kind`."""
        return read_only(np.array([verdict.kind.value for verdict in self.verdicts]))

    @property
    def period(self) -> NDArray[np.int64]:
        """Numbers of forcing cycles per response period, shape (n,); 0 if not periodic."""
        return read_only(np.array([verdict.period or 0 for verdict in self.verdicts], np.int64))

    @property
    def symmetric(self) -> NDArray[np.bool_]:
        """True for periodic responses that are their own mirror images half a period later, shape (n,)."""
        return read_only(np.array([bool(verdict.symmetric) for verdict in self.verdicts]))

    @property
    def exponent(self) -> NDArray[np.float64]:
        """Largest Lyapunov exponents per τ, shape (n,), as in `Verdict`; NaN if it is not known."""
        return _numbers([verdict.exponent for verdict in self.verdicts])

    @property
    def exponent_error(self) -> NDArray[np.float64]:
        """Standard errors of the exponents per τ, shape (n,); 0 if multipliers give the exponent, NaN without an error."""
        return _numbers([verdict.exponent_error for verdict in self.verdicts])

    @property
    def evidence(self) -> tuple[str, ...]:
        """Evidence of each verdict in words."""
        return tuple(str(verdict.evidence) for verdict in self.verdicts)

    @property
    def fixed(self) -> dict[str, float]:
        """Parameters that were not varied, by name."""
        return fixed_quantities(self.system, self.parameter)

    def to_xarray(self) -> xr.Dataset:
        """Return the diagram as a dataset.

        Returns
        -------
        xarray.Dataset
            Over the parameter: `kind` (a code, explained by its attributes), `orbit_period`, `symmetric`, `exponent`,
            `exponent_error`, `rotation`, `rotation_error`, and the `evidence` in words with its `level`.
        """
        import xarray as xr

        name = self.parameter
        levels = [verdict.evidence.level for verdict in self.verdicts]
        variables = {
            "kind": kinds_of(name, self.kind.tolist(), "type of the response"),
            "orbit_period": (
                name,
                self.period,
                named("forcing cycles per response period; 0 if not periodic"),
            ),
            "symmetric": (name, self.symmetric.astype(np.int8), named("1 if the response is symmetric")),
            "exponent": (name, self.exponent, named("largest Lyapunov exponent per tau")),
            "exponent_error": (name, self.exponent_error, named("error of the largest Lyapunov exponent")),
            "rotation": (name, self.rotation, named("rotation number: mean number of impacts per cycle")),
            "rotation_error": (name, self.rotation_error, named("error of the rotation number")),
            "evidence": (name, np.array(self.evidence), {"long_name": "evidence of the verdict"}),
            "level": (name, np.array(levels), {"long_name": "level of the evidence"}),
        }
        attributes = described("Response diagram") | {
            "start_angle": self.start.angle,
            "start_velocity": self.start.velocity,
            "max_cycles": self.max_cycles,
            "max_period": self.max_period,
            **self.fixed,
        }
        return xr.Dataset(variables, {name: coordinate_of(name, name, self.values)}, attributes)

    def __str__(self) -> str:
        values = self.values
        span = f"{values[0]:.6g}"
        if len(values) > 1:
            span += f" to {values[-1]:.6g}, {len(values):,} values"
        start = f"Θ = {self.start.angle:.6g}, Θ' = {self.start.velocity:.6g}"
        counts = [(kind, int((self.kind == kind.value).sum())) for kind in Kind]
        found = ", ".join(
            f"{count:,} {kind}{self._periods() * (kind is Kind.PERIODIC)}" for kind, count in counts if count
        )
        return f"response diagram over {self.parameter} {span}, each from {start}: {found}"

    def _periods(self) -> str:
        found = np.unique(self.period[self.period > 0]).tolist()
        return f" (period{'s' * (len(found) > 1)} {', '.join(map(str, found))})"


def _numbers(given: list[float | None]) -> NDArray[np.float64]:
    return read_only(np.array([math.nan if number is None else number for number in given]))
