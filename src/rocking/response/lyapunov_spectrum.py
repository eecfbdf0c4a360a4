"""Both Lyapunov exponents of a motion, with what they rest on."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from attrs import field, frozen

from rocking.model import ReadOnlyArrays, State, System, TooShort, counted, plus_minus, read_only
from rocking.response.batch_means import BatchMean, batch_mean

HISTORY = np.dtype([("cycles", "i8"), ("values", "f8", 2), ("errors", "f8", 2)])


@frozen(eq=False, slots=False)
class LyapunovSpectrum(ReadOnlyArrays):
    """Both Lyapunov exponents of a motion, with errors; made by `lyapunov`.

    Attributes
    ----------
    system, start : System, State
        What was followed.
    cycles, transient : int
        Forcing cycles averaged over, and those left out before them.
    values : ndarray, shape (2,)
        λ₁ ≥ λ₂ per τ; −∞ where the motion forgets every small difference.
    errors : ndarray, shape (2,)
        Of each, per τ: a standard error, or a bound where `bounded`; 0 for −∞; infinite in the estimate that a
        `TooShort` carries.
    bounded : bool
        Whether the sum of λ₁ stays within bounds, as on periodic and quasi-periodic motions: the error is then how far
        the running estimate moved over the last three quarters of the run, which is no standard error.
    correlation : float
        Integrated correlation time of λ₁'s growth, in batches of `cycles`/256; where it is near 1 the batches are
        long against it.
    sum_rule_error : float
        λ₁ + λ₂ less what the events take, (2 ln e · impacts + 2 ln r · brace hits)/τ, per τ: rounding, and nothing
        else.
    impacts, brace_hits : int
        In the cycles averaged over.
    growths : ndarray, shape (batches, 2)
        Logarithms of growth along either direction, that of λ₁ first, summed over consecutive batches.
    lengths : ndarray, shape (batches,)
        Cycles in each batch.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=10.103037, period=1.721328), restitution=0.8)
    >>> spectrum = rk.lyapunov(system, cycles=20_000)
    >>> bool(abs(spectrum.values[0] - 0.073) < 4 * spectrum.errors[0] < 0.005)
    True
    """

    system: System
    start: State
    cycles: int
    transient: int
    values: np.ndarray = field(converter=read_only)
    errors: np.ndarray = field(converter=read_only)
    bounded: bool
    correlation: float
    sum_rule_error: float
    impacts: int
    brace_hits: int
    growths: np.ndarray = field(repr=False, converter=read_only)
    lengths: np.ndarray = field(repr=False, converter=read_only)

    @property
    def superstable(self) -> bool:
        """Whether every small difference is forgotten, at rest or leaning: both exponents are −∞."""
        return bool(self.values[0] == -math.inf)

    @property
    def per_cycle(self) -> tuple[np.ndarray, np.ndarray]:
        """Values and errors per forcing cycle instead of per τ."""
        period = self.system.forcing.period
        return self.values * period, self.errors * period

    @cached_property
    def history(self) -> np.ndarray:
        """Running estimates per τ, a structured array: cycles, values (2), errors (2).

        The errors are infinite as long as there are too few batches for one. Empty where superstable.
        """
        if self.superstable:
            return np.empty(0, HISTORY)
        history = np.empty(len(self.lengths), HISTORY)
        period = self.system.forcing.period
        history["cycles"] = np.cumsum(self.lengths)
        for row in range(len(history)):
            means = means_of(self.growths[: row + 1], self.lengths[: row + 1] * period)
            history[row] = (
                history["cycles"][row],
                [mean.value for mean in means],
                [mean.error for mean in means],
            )
        return read_only(history)

    @property
    def kaplan_yorke(self) -> tuple[float, float]:
        """Kaplan–Yorke dimension of the *section* and its error: 1 + λ₁/|λ₂|, or 0 where λ₁ < 0; that of the flow is one more.

        Raises
        ------
        ValueError
            Without contraction, λ₁ + λ₂ ≥ 0: nothing is attracted, and a motion without loss fills what it fills.
        TooShort
            Where λ₁ is within two errors of 0, so that its sign decides between 0 and more than 1.
        """
        if self.superstable:
            raise ValueError(
                "a motion that forgets every difference has no Kaplan–Yorke dimension: its section is finite"
            )
        one, two = (float(value) for value in self.values)
        error, other = (float(value) for value in self.errors)
        if one + two >= -10.0 * abs(self.sum_rule_error):
            raise ValueError(
                f"the Kaplan–Yorke dimension needs contraction, λ₁ + λ₂ < 0; got {one:.4g} and {two:.4g}: "
                "a motion without loss has no attractor"
            )
        if one < 0.0 and abs(one) > 2.0 * error:
            return 0.0, 0.0
        if one <= 2.0 * error:
            raise TooShort(
                f"the sign of λ₁ = {one:.3g} ± {error:.2g} is not settled, and with it the dimension "
                "(take more cycles)",
                1.0 + max(one, 0.0) / abs(two),
            )
        return 1.0 - one / two, error / abs(two) + one * other / two**2

    def __str__(self) -> str:
        over = f"over {counted(self.cycles, 'cycle')} after {self.transient:,}"
        if self.superstable:
            return f"λ = −∞, −∞ {over}: superstable, at rest or leaning every small difference is forgotten"
        one, two = (plus_minus(*pair) for pair in zip(self.values, self.errors, strict=True))
        return f"λ = {one}, {two} per τ {over}" + ("; bounds, no standard errors" if self.bounded else "")


def means_of(growths: np.ndarray, times: np.ndarray) -> list[BatchMean]:
    """The mean of either exponent, per unit of `times`; −∞ without an error where a batch forgets."""
    return [
        batch_mean(column, times)
        if np.isfinite(column).all()
        else BatchMean(-math.inf, 0.0, 1.0, bounded=False, batches=len(column))
        for column in growths.T
    ]
