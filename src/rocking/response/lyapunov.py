"""Lyapunov exponents from the exact tangent map, with errors estimated from the run."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from attrs import evolve, field, frozen

from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.result import Result, along, described
from rocking.model.system import NO_BRACES, State, System, check_periodic, quantities
from rocking.model.text import counted, plus_minus
from rocking.model.validation import TooShort, whole
from rocking.model.verdict import Outcome
from rocking.motion.march_loop import march_on, start_march
from rocking.response.batch_means import MAX_BATCHES, MIN_BATCHES, BatchMean, batch_mean

if TYPE_CHECKING:
    import xarray as xr


# Bound of the relative rounding of the two logarithms of one event.
ROUNDING = 4.0 * np.finfo(float).eps
HISTORY = np.dtype([("cycles", "i8"), ("values", "f8", 2), ("errors", "f8", 2)])


@frozen(eq=False, slots=False)
class LyapunovSpectrum(ReadOnlyArrays, Result):
    """Both Lyapunov exponents of a motion, with errors; returned by `lyapunov`.

    Attributes
    ----------
    system, start : System, State
        System and initial state.
    cycles, transient : int
        Number of forcing cycles of the average, and number of cycles discarded before it.
    values : ndarray, shape (2,)
        λ₁ ≥ λ₂ per τ; −∞ if the motion rests or remains in contact with a brace (superstable).
    errors : ndarray, shape (2,)
        Errors per τ: standard errors, or bounds if `bounded`. 0 for −∞; infinite in the `estimate` of `TooShort`.
    bounded : bool
        True if the sum of λ₁ stays bounded, as on periodic and quasi-periodic motions. The errors are then the largest
        drift of the running estimate over the last three quarters of the run.
    correlation : float
        Integrated correlation time of the growth of λ₁, in batches of `cycles`/256. A value near 1 means that the batches
        are long enough.
    sum_rule_error : float
        Rounding error per τ: λ₁ + λ₂ minus (2 ln e · impacts + 2 ln r · brace hits)/τ.
    impacts, brace_hits : int
        Number of impacts at Θ = 0 and on the braces in the averaged cycles.
    growths : ndarray, shape (batches, 2)
        Logarithmic growth in consecutive batches, that of λ₁ first.
    lengths : ndarray, shape (batches,)
        Number of cycles in each batch.

    Notes
    -----
    In the dataset, `exponent` and `exponent_error` are over `direction`, and `running_exponent` and `running_exponent_error` over
    `cycles` since the transient, too.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=10.103037, period=1.721328), restitution=0.8)
    >>> spectrum = rk.lyapunov(system, cycles=20_000)
    >>> bool(abs(spectrum.values[0] - 0.073) < 4 * spectrum.errors[0] < 0.005)
    True
    """

    PLOT = "convergence"
    LONG = ("cycles_direction",)

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
        """True if both exponents are −∞, because perturbations vanish at rest or in sustained contact with a brace."""
        return bool(self.values[0] == -math.inf)

    @property
    def per_cycle(self) -> tuple[np.ndarray, np.ndarray]:
        """Values and errors per forcing cycle instead of per τ."""
        period = self.system.periodic.period
        return self.values * period, self.errors * period

    @cached_property
    def history(self) -> np.ndarray:
        """Running estimates per τ, a structured array with the fields cycles, values (2) and errors (2).

        Errors are infinite as long as there are too few batches. The array is empty if superstable.
        """
        if self.superstable:
            return np.empty(0, HISTORY)
        history = np.empty(len(self.lengths), HISTORY)
        period = self.system.periodic.period
        rounding = rounding_of(self.impacts + self.brace_hits, self.cycles * period)
        history["cycles"] = np.cumsum(self.lengths)
        for row in range(len(history)):
            means = means_of(self.growths[: row + 1], self.lengths[: row + 1] * period, rounding)
            history[row] = (
                history["cycles"][row],
                [mean.value for mean in means],
                [mean.error for mean in means],
            )
        return read_only(history)

    @property
    def kaplan_yorke(self) -> tuple[float, float]:
        """Kaplan–Yorke dimension of the section and its error: 1 + λ₁/|λ₂|, or 0 if λ₁ < 0.

        The dimension of the flow is one more.

        Raises
        ------
        ValueError
            If there is no contraction, λ₁ + λ₂ ≥ 0: an undamped motion has no attractor. Also if the motion is
            superstable.
        TooShort
            If λ₁ is within two errors of 0, so that the dimension may be 0 or above 1.
        """
        if self.superstable:
            raise ValueError(
                "a superstable motion has no Kaplan–Yorke dimension: its section is a finite set of points"
            )
        one, two = (float(value) for value in self.values)
        error, other = (float(value) for value in self.errors)
        if one + two >= -10.0 * abs(self.sum_rule_error):
            raise ValueError(
                f"the Kaplan–Yorke dimension requires contraction, λ₁ + λ₂ < 0; got {one:.4g} and {two:.4g} "
                "(an undamped motion has no attractor)"
            )
        if one < 0.0 and abs(one) > 2.0 * error:
            return 0.0, 0.0
        if one <= 2.0 * error:
            raise TooShort(
                f"the sign of λ₁ = {one:.3g} ± {error:.2g}, and therefore the dimension, is undecided (increase cycles)",
                1.0 + max(one, 0.0) / abs(two),
            )
        return 1.0 - one / two, error / abs(two) + one * other / two**2

    def _data(self) -> xr.Dataset:
        import xarray as xr

        history = self._final if self.superstable else self.history
        results = {
            "exponent": (self.values, "Lyapunov exponent per tau"),
            "exponent_error": (self.errors, "error of the Lyapunov exponent per tau"),
        }
        estimates = {
            "running_exponent": (history["values"], "running estimate of the Lyapunov exponent per tau"),
            "running_exponent_error": (history["errors"], "error of the running estimate per tau"),
        }
        variables = along("direction", results) | along(("cycles", "direction"), estimates)
        coordinates = {
            **along("direction", {"direction": ([1, 2], "number of the exponent, in descending order")}),
            **along("cycles", {"cycles": (history["cycles"], "forcing cycles since the transient")}),
        }
        dimension, error = dimension_of(self) or (None, None)
        attributes = described("Lyapunov exponents") | {
            **quantities(self.system),
            "start_angle": self.start.angle,
            "start_velocity": self.start.velocity,
            "bounded": self.bounded,
            "superstable": self.superstable,
            "kaplan_yorke": dimension,
            "kaplan_yorke_error": error,
            "cycles": self.cycles,
            "transient": self.transient,
            "impacts": self.impacts,
            "brace_hits": self.brace_hits,
        }
        return xr.Dataset(variables, coordinates, attributes)

    @property
    def _final(self) -> np.ndarray:
        """Result after all cycles, as one row of `history`."""
        return np.array([(self.cycles, self.values, self.errors)], HISTORY)

    def __str__(self) -> str:
        over = f"over {counted(self.cycles, 'cycle')} after {self.transient:,}"
        if self.superstable:
            return f"λ = −∞, −∞ {over}: superstable, perturbations vanish at rest or in contact with a brace"
        rate, unit = (1.0, "τ") if self.block is None else (self.block.rate_unit, "s")
        one, two = (plus_minus(*pair) for pair in zip(rate * self.values, rate * self.errors, strict=True))
        return f"λ = {one}, {two} per {unit} {over}" + (
            "; errors are bounds, not standard errors" if self.bounded else ""
        )


def dimension_of(spectrum: LyapunovSpectrum) -> tuple[float, float] | None:
    """Return the Kaplan–Yorke dimension and its error; None where there is none, or it is undecided."""
    try:
        return spectrum.kaplan_yorke
    except ValueError:
        return None


def rounding_of(events: int, time: float) -> float:
    """Return the bound of the rounding error of an exponent, from the number of events in a time."""
    return float(ROUNDING * (1.0 + events / time))


def means_of(growths: np.ndarray, times: np.ndarray, rounding: float) -> list[BatchMean]:
    """Mean of both exponents per unit of `times`; −∞ without an error if a batch contains rest or sustained contact."""
    return [_mean_of(column, times, rounding) for column in growths.T]


def _mean_of(growths: np.ndarray, times: np.ndarray, rounding: float) -> BatchMean:
    """Mean of an exponent. If the batches agree within their rounding, as on a periodic orbit, that is the error.

    Each batch may be wrong by the rounding, so two of them may differ by twice as much.
    """
    if not np.isfinite(growths).all():
        return BatchMean(-math.inf, 0.0, 1.0, bounded=False, batches=len(growths))
    mean = batch_mean(growths, times)
    if mean.batches >= MIN_BATCHES and np.ptp(growths / times) <= 2.0 * rounding:
        return evolve(mean, error=rounding, correlation=1.0, bounded=True)
    return mean


MAX_CYCLES = 1_000_000_000


def lyapunov(
    system: System, start: State | None = None, cycles: int = 10_000, transient: int | None = None
) -> LyapunovSpectrum:
    """Compute both Lyapunov exponents of a motion from its exact tangent map, with errors.

    Two tangent vectors are propagated through arcs, impacts and brace impacts in closed form. They are orthonormalised at
    every event, and λ₁ and λ₂ are the mean logarithms of the removed factors. The vectors are also propagated through the
    transient, so that the first one has turned to the direction of growth.

    Parameters
    ----------
    system : System
        Block, base motion and braces.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0. Default: at rest.
    cycles : int
        Number of forcing cycles of the average, in [32, 10⁹]. A good estimate of the error needs 256 times the correlation
        time of the motion. Default: 10,000.
    transient : int, optional
        Number of forcing cycles discarded before the average. Default: a tenth of `cycles`.

    Returns
    -------
    LyapunovSpectrum
        Exponents per τ, with errors.

    Raises
    ------
    TooShort
        If the run does not support an error, because its batches are still correlated. Correlation remains during a
        transient, and if the sojourns of a chaotic motion near islands are as long as the run. Its `estimate` is the
        spectrum with infinite errors.
    ValueError
        If the block overturns, or if an argument lies outside its range.
    TypeError
        If an argument is of the wrong type.

    See Also
    --------
    classify : Response type with its evidence.
    correlation_dimension : Dimension of a section.
    rocking.plot.convergence : Plot the convergence of an exponent.

    Notes
    -----
    Without rest and sustained contact, λ₁ + λ₂ is the contraction per τ. It is 2 ln e for each impact and 2 ln r for each
    brace impact. The difference is stored as `sum_rule_error`. Rest or sustained contact makes both exponents
    exactly −∞, however rarely it occurs. A periodic motion with complex multipliers has λ₁ = λ₂ = ln e × impacts/τ. For a
    regular undamped motion, λ₁ tends to 0 as ln N/N over N cycles, because nearby trajectories diverge linearly.

    Limits: the exponents refer to the simulated cycles, and a chaotic transient may last longer than any run. If all 256
    batches are shorter than a sojourn near islands, the run covers one sojourn only. The error then refers to this sojourn.

    References
    ----------
    Benettin, Galgani, Giorgilli & Strelcyn, Meccanica 15, 9–20 (1980).

    Examples
    --------
    For the (1, 1) mode, both exponents are ln e times two impacts per cycle.

    >>> import math
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> spectrum = rk.lyapunov(system)
    >>> bool(abs(spectrum.values - 2 * math.log(0.925)).max() < spectrum.errors.max() < 1e-3)
    True
    """
    start = check_periodic(system, start)
    cycles = whole("cycles", cycles, MIN_BATCHES, MAX_CYCLES)
    transient = cycles // 10 if transient is None else whole("transient", transient, 0, MAX_CYCLES)
    motion = _Carried(system, start)
    motion.to(transient)
    impacts, brace_hits = motion.events
    motion.begin_average()
    edges = np.linspace(0, cycles, min(MAX_BATCHES, cycles) + 1).astype(int)
    growths = np.array([motion.to(transient + edge) for edge in edges[1:].tolist()])
    counted = (motion.events[0] - impacts, motion.events[1] - brace_hits)
    return _spectrum(system, start, cycles, transient, growths, np.diff(edges), counted)


class _Carried:
    """Motion in progress with two orthonormal tangent vectors."""

    def __init__(self, system: System, start: State) -> None:
        self.period = system.periodic.period
        self.p, self.progress = start_march(system, start)
        self.columns = np.eye(2)

    @property
    def events(self) -> tuple[int, int]:
        return self.progress.impacts, self.progress.brace_hits

    def begin_average(self) -> None:
        """Restore tangent vectors that vanished before the average began."""
        if not self.columns.any():
            self.columns[:] = np.eye(2)

    def to(self, cycle: int) -> np.ndarray:
        """March to the end of a cycle and return the logarithmic growth of both tangent vectors, shape (2,)."""
        growth = np.zeros(2)
        if cycle > self.progress.cycle:
            outcome, self.progress = march_on(self.p, self.progress, cycle, self.columns, growth)
            if outcome is Outcome.OVERTURNED:
                raise ValueError(self._overturned())
            if outcome is Outcome.AT_REST:
                self.columns[:] = 0.0
        return growth if self.columns.any() else np.full(2, -math.inf)

    def _overturned(self) -> str:
        proved = self.progress.cycle + math.floor(self.progress.no_return / self.period)
        return (
            f"the block must stay upright for an exponent; overturning is certain in cycle {proved}, counted from 0 "
            "(reduce the forcing, change the initial state, or add braces)"
        )


def _spectrum(
    system: System,
    start: State,
    cycles: int,
    transient: int,
    growths: np.ndarray,
    lengths: np.ndarray,
    counted: tuple[int, int],
) -> LyapunovSpectrum:
    """Return the exponents from the growth in consecutive batches, the larger first.

    Raises
    ------
    TooShort
        If the batches support no error.
    """
    # If the exponents are equal, either vector may have grown more.
    growths = growths[:, np.argsort(-growths.sum(axis=0), kind="stable")]
    time = cycles * system.periodic.period
    floor = rounding_of(sum(counted), time)
    means = means_of(growths, lengths * system.periodic.period, floor)
    spectrum = LyapunovSpectrum(
        system=system,
        start=start,
        cycles=cycles,
        transient=transient,
        values=np.array([mean.value for mean in means]),
        errors=np.array([max(mean.error, floor) if mean.value > -math.inf else 0.0 for mean in means]),
        bounded=means[0].bounded,
        correlation=means[0].correlation,
        sum_rule_error=_sum_rule_error(system, growths, counted) / time,
        impacts=counted[0],
        brace_hits=counted[1],
        growths=growths,
        lengths=lengths,
    )
    if np.isinf(spectrum.errors).any():
        raise TooShort(
            f"{cycles} cycles are too few for an exponent with an error: {len(lengths)} batches are still correlated "
            f"(λ₁ = {spectrum.values[0]:.3g} per τ; increase cycles or transient)",
            spectrum,
        )
    return spectrum


def _sum_rule_error(system: System, growths: np.ndarray, counted: tuple[int, int]) -> float:
    """Return (λ₁ + λ₂) minus the contraction at events, times the averaging time.

    It is 0 if both are −∞, and NaN if the coefficient of restitution depends on the speed.
    """
    if np.isinf(growths).any():
        return 0.0
    if system.restitution_table:
        return math.nan
    kept_by = NO_BRACES | quantities(system)
    taken = sum(
        2.0 * count * math.log(kept)
        for count, kept in zip(counted, (kept_by["restitution"], kept_by["brace_restitution"]), strict=True)
        if count
    )
    return math.fsum(growths.flat) - taken
