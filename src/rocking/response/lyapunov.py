"""Lyapunov exponents from the exact tangent map, with errors estimated from the run."""

from __future__ import annotations

import math

import numpy as np

from rocking.model import NO_BRACES, Outcome, State, System, TooShort, check_periodic, quantities, whole
from rocking.motion import march_on, start_march
from rocking.response.batch_means import MAX_BATCHES, MIN_BATCHES
from rocking.response.lyapunov_spectrum import LyapunovSpectrum, means_of, rounding_of

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
