"""Laws of restitution: Housner's value, a number, a table over the speed, and scatter from impact to impact."""

from __future__ import annotations

from collections.abc import Iterable
from hashlib import sha256
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from attrs import evolve, field, frozen

from rocking.model.quantity import RESTITUTION
from rocking.model.text import counted
from rocking.model.validation import (
    Refusal,
    Text,
    WrongType,
    instance,
    members,
    one_of,
    pair,
    refuse_if,
    whole,
    within,
)

if TYPE_CHECKING:
    from rocking.model.system import System

MAX_SPEED = 1e300
FACTORS = (0.5, 1.5)
"""Range of a factor of Housner's value."""
DEVIATIONS = (0.0, 0.5)
MAX_SEED = 2**32 - 1
SHAPES = ("normal", "uniform")
Rows = tuple[tuple[float, float], ...]


def checked_rows(name: str, value: Iterable[tuple[float, float]], *, from_zero: bool = False) -> Rows:
    """Return rows of speed and coefficient of restitution, after checking them; the first speed may be 0 with ``from_zero``."""
    least = "not negative" if from_zero else "positive"
    allowed = f"be rows (speed, coefficient of restitution), the speeds {least} and ascending"
    rows = [pair(name, row, allowed) for row in members(name, value, allowed)]
    speed, kept = f"a speed of {{{name}}}", f"a coefficient of {{{name}}}"
    checked = tuple(
        (within(speed, row[0], 0, MAX_SPEED), within(kept, row[1], *RESTITUTION.range)) for row in rows
    )
    speeds = [-1.0 if from_zero else 0.0, *(speed for speed, _ in checked)]
    refuse_if(not all(one < two for one, two in pairwise(speeds)), name, allowed, value)
    return checked


@frozen
class Scatter:
    """Scatter of the coefficient of restitution from impact to impact; made by `Restitution.scattered`.

    At an impact, e = e(v) + s z, cut off at 0 and 1. Here e(v) is the law without scatter, and s the deviation. The number z is
    drawn anew at each impact, independently of all others. It is standard normal, truncated to [−3, 3], or uniform in [−1, 1].

    Attributes
    ----------
    deviation : float
        The deviation s: standard deviation of the normal distribution before its truncation, or half the width of the uniform one.
    shape : {"normal", "uniform"}
        Distribution of z.
    seed : int
        Random seed, in [0, 2³² − 1].
    run : int
        Number of the run. Runs with different numbers have different z. `Block.system` and surveys of ground motions number runs by
        the record, at all levels alike. Default: 0.

    Examples
    --------
    >>> import rocking as rk
    >>> rk.Restitution.constant(0.9).scattered(0.02, seed=1).scatter
    Scatter(deviation=0.02, shape='normal', seed=1, run=0)
    """

    deviation: float
    shape: str = "normal"
    seed: int = 0
    run: int = 0

    def __str__(self) -> str:
        return f"{self.shape} scatter of {self.deviation:g} at each impact, seed {self.seed}"

    def stream(self, sample: int = 0) -> int:
        """Return the number of the sequence of deviations of a sample of the run."""
        text = f"{self.seed} {self.run} {sample}".encode()
        return int.from_bytes(sha256(text).digest()[:8], "little", signed=True)


def _value(value: float | None) -> float | None:
    return None if value is None else RESTITUTION.checked(value)


def _factor(value: float) -> float:
    return within("factor", value, *FACTORS)


def _rows(value: Iterable[tuple[float, float]]) -> Rows:
    return checked_rows("rows", value, from_zero=True)


def _scatter(value: Scatter | None) -> Scatter | None:
    return None if value is None else instance("scatter", value, Scatter)


@frozen
class Restitution:
    """Law of restitution of a block in SI units: how much speed it keeps at an impact on the base.

    It is made by one of `housner`, `constant` and `table`, and may be `scattered`. A block takes it as `restitution`.
    A table, and scatter, need the full equation of motion.

    Attributes
    ----------
    value : float or None
        Coefficient of restitution e of a constant law; None for any other.
    factor : float
        Factor of Housner's value; it counts if there are neither a value nor rows.
    rows : tuple of (float, float)
        Rows of the table: angular speed before the impact, rad/s, and coefficient of restitution.
    scatter : Scatter or None
        Scatter from impact to impact.

    See Also
    --------
    fit_restitution : Coefficient of restitution from the times of impacts.

    Notes
    -----
    Housner's value (1963) conserves the angular momentum about the corner of the impact. For a uniform rectangle it is
    e = 1 − (3/2) sin²θcr. It assumes that the impact acts at that corner alone. Measured coefficients lie below and above it.

    References
    ----------
    Housner, Bull. Seismol. Soc. Am. 53, 403–417 (1963).

    Examples
    --------
    >>> import rocking as rk
    >>> law = rk.Restitution.table([(0.1, 0.95), (0.8, 0.9)]).scattered(0.01, seed=3)
    >>> block = rk.Block(height=2.0, width=0.5, restitution=law)
    >>> print(block.law)
    table of 2 speeds, normal scatter of 0.01 at each impact, seed 3
    >>> motion = rk.simulate(block.system(rk.example_ground_motion().scaled(9.0), model="full"))
    >>> motion.impacts > 5
    True
    """

    value: float | None = field(default=None, converter=_value, kw_only=True)
    factor: float = field(default=1.0, converter=_factor, kw_only=True)
    rows: Rows = field(default=(), converter=_rows, kw_only=True)
    scatter: Scatter | None = field(default=None, converter=_scatter, kw_only=True)

    @staticmethod
    def housner(factor: float = 1.0) -> Restitution:
        """Return Housner's law, times a factor.

        Parameters
        ----------
        factor : float
            Factor of Housner's coefficient, in [0.5, 1.5]. A block refuses a product above 1. Default: 1.

        Examples
        --------
        >>> import rocking as rk
        >>> print(rk.Block(2.0, 0.5, rk.Restitution.housner(factor=1.02)))
        Block(height=2.0 m, width=0.5 m, restitution=0.93 by 1.02 × Housner's formula)
        """
        return Restitution(factor=factor)

    @staticmethod
    def constant(value: float) -> Restitution:
        """Return a coefficient of restitution in [0, 1] that is the same at all speeds.

        Examples
        --------
        >>> import rocking as rk
        >>> rk.Block(2.0, 0.5, rk.Restitution.constant(0.9)) == rk.Block(2.0, 0.5, 0.9)
        True
        """
        return Restitution(value=value)

    @staticmethod
    def table(rows: Iterable[tuple[float, float]]) -> Restitution:
        """Return a coefficient of restitution over the speed.

        Parameters
        ----------
        rows : iterable of (float, float)
            Angular speed before the impact in rad/s, ascending, and coefficient of restitution there, in [0, 1]. Between rows it is
            linear, and constant before the first and beyond the last.

        Examples
        --------
        >>> import rocking as rk
        >>> rk.Restitution.table([(0.1, 0.95), (0.8, 0.9)]).rows
        ((0.1, 0.95), (0.8, 0.9))
        """
        law = Restitution(rows=rows)
        refuse_if(not law.rows, "rows", "hold one row (speed, coefficient of restitution) at least", rows)
        return law

    def scattered(self, deviation: float, shape: str = "normal", seed: int = 0) -> Restitution:
        """Return the law with scatter from impact to impact, as described in `Scatter`.

        Parameters
        ----------
        deviation : float
            Standard deviation of the normal distribution before its truncation at three of them, or half the width of the uniform
            one; in (0, 0.5].
        shape : {"normal", "uniform"}
            Distribution. Default: "normal".
        seed : int
            Random seed, in [0, 2³² − 1]. Default: 0.

        Examples
        --------
        >>> import rocking as rk
        >>> print(rk.Restitution.housner().scattered(0.02, shape="uniform", seed=7))
        Housner's formula, uniform scatter of 0.02 at each impact, seed 7
        """
        deviation = within("deviation", deviation, *DEVIATIONS)
        refuse_if(deviation == 0.0, "deviation", "be positive", deviation, "leave out the scatter")
        scatter = Scatter(deviation, one_of("shape", shape, SHAPES), whole("seed", seed, 0, MAX_SEED))
        return evolve(self, scatter=scatter)

    @property
    def is_plain(self) -> bool:
        """True without table and without scatter, so that one number is the coefficient of restitution of a block."""
        return not self.rows and self.scatter is None

    @property
    def is_housner(self) -> bool:
        """True if the coefficient of restitution is Housner's, apart from scatter."""
        return self.value is None and not self.rows and self.factor == 1.0

    @property
    def origin(self) -> str:
        """Text on the law without scatter, such as "Housner's formula"."""
        if self.rows:
            return f"table of {counted(len(self.rows), 'speed')}"
        if self.value is not None:
            return f"e = {self.value:.6g}"
        return "Housner's formula" if self.factor == 1.0 else f"{self.factor:g} × Housner's formula"

    def __str__(self) -> str:
        return self.origin if self.scatter is None else f"{self.origin}, {self.scatter}"

    def coefficient(self, housner: float) -> float:
        """Return e of a block with this value of Housner's: without scatter, and for a table below its first speed."""
        if self.rows:
            return self.rows[0][1]
        return self.factor * housner if self.value is None else self.value

    def normalised_rows(self, unit: float) -> Rows:
        """Return the rows beyond speed 0, in units of a speed in rad/s, as `System` takes them."""
        return tuple((speed / unit, kept) for speed, kept in self.rows if speed > 0.0)

    def attributes(self) -> dict[str, Any]:
        """Return what a dataset states of the law beside the coefficient of restitution; nothing of a plain one.

        The table is one list, speed and coefficient in turn.
        """
        stated: dict[str, Any] = {}
        if self.value is None and self.factor != 1.0:
            stated["restitution_factor"] = self.factor
        if self.rows:
            stated["restitution_table_rad_per_s"] = [number for row in self.rows for number in row]
        return stated | scatter_attributes(self.scatter)


def system_attributes(system: System) -> dict[str, Any]:
    """Return what a dataset states of table and scatter of a system; the speeds are in rad/s if it has a block."""
    if system.block is not None:
        return evolve(system.block.law, scatter=system.restitution_scatter).attributes()
    table = [number for row in system.restitution_table for number in row]
    return ({"restitution_table": table} if table else {}) | scatter_attributes(system.restitution_scatter)


def scatter_attributes(scatter: Scatter | None) -> dict[str, Any]:
    """Return what a dataset states of scatter."""
    if scatter is None:
        return {}
    return {
        "restitution_deviation": scatter.deviation,
        "restitution_shape": scatter.shape,
        "restitution_seed": scatter.seed,
    }


def checked_law(value: float | Restitution | None) -> float | Restitution | None:
    """Return the restitution of a block, after checking: a number, None for Housner's value, or a law that is neither."""
    if not isinstance(value, Restitution):
        return None if value is None else RESTITUTION.checked(value)
    if value.is_plain and (value.value is not None or value.is_housner):
        return value.value
    return value


def law_of(restitution: float | Restitution | None) -> Restitution:
    """Return the law of the restitution that a block was given."""
    return restitution if isinstance(restitution, Restitution) else Restitution(value=restitution)


def check_model(law: Restitution, model: str) -> None:
    """Raise ValueError for a table or scatter with the slender model, which has one coefficient of restitution."""
    what = "a table of the restitution" if law.rows else "a scatter of the restitution"
    refuse_if(model == "slender" and not law.is_plain, "model", f"be 'full' for {what}", model)


def check_certain(scatter: Scatter | None) -> None:
    """Raise ValueError for scatter, with which no motion repeats: analyses of periodic motions and their like refuse it."""
    remedy = "rk.simulate and surveys of ground motions and pulses take it"
    refuse_if(
        scatter is not None,
        "restitution_scatter",
        "be None for an analysis of recurrent motions",
        Text(str(scatter)),
        remedy,
    )


def check_uniform(rows: Rows, what: str) -> None:
    """Raise ValueError for a table, for an analysis that changes the one coefficient of restitution."""
    got = Text(f"a table of {counted(len(rows), 'speed')}")
    if rows:
        raise Refusal("restitution", f"be one number for {what}, not a table over the speed", got)


def check_scatter(value: Any) -> Scatter | None:
    """Return the scatter of a system, after checking."""
    if value is None or isinstance(value, Scatter):
        return value
    remedy = "such as rk.Restitution.constant(0.9).scattered(0.02).scatter"
    raise WrongType("restitution_scatter", "be a Scatter", value, remedy)
