"""Lyapunov exponents: how fast small differences grow, with an error that the run itself supports."""

from __future__ import annotations

import math

import numpy as np

from rocking.model import NO_BRACES, Outcome, State, System, TooShort, check_start, quantities, whole
from rocking.motion import march_on, start_march
from rocking.response.batch_means import MAX_BATCHES, MIN_BATCHES
from rocking.response.lyapunov_spectrum import LyapunovSpectrum, means_of

MAX_CYCLES = 1_000_000_000
# Relative rounding of one event's two logarithms, with room.
ROUNDING = 4.0 * np.finfo(float).eps


def lyapunov(
    system: System, start: State | None = None, cycles: int = 10_000, transient: int | None = None
) -> LyapunovSpectrum:
    """Measure both Lyapunov exponents of a motion from its exact tangent map, with errors.

    Two differences are carried along arcs, impacts and brace hits in closed form and made orthonormal again at every
    event; λ₁ and λ₂ are the mean logarithms of what that takes out. They are orthonormal when the average begins and
    have been carried through the transient, so that their first direction is the one that grows.

    Parameters
    ----------
    system : System
        The block, its forcing and its braces.
    start : State, optional
        Θ and Θ' at τ = 0; at rest by default.
    cycles : int
        Forcing cycles averaged over, 1 to 10⁹; an error takes 32 at least, a good one 256 times the time over which
        the motion remembers.
    transient : int, optional
        Forcing cycles left out before; a tenth of `cycles` by default.

    Returns
    -------
    LyapunovSpectrum

    Raises
    ------
    TooShort
        If the run cannot support an error: fewer than 32 cycles, or 256 batches of it still correlated, as where a
        transient goes on, or where chaotic motion sticks to islands for times as long as the run. Its `estimate` is
        the spectrum with infinite errors.
    ValueError
        If the block overturns, or for an argument outside its range.
    TypeError
        For an argument of the wrong type.

    See Also
    --------
    classify : Response type with its evidence.
    correlation_dimension : Dimension of a section.
    rocking.plot.convergence : Plot the convergence of an exponent.

    Notes
    -----
    Without rest and leaning λ₁ + λ₂ is what impacts and brace hits take, 2 ln e and 2 ln r each; the difference is
    kept as `sum_rule_error`. Rest and leaning forget: −∞, exactly, for the whole run, however seldom it happens. A
    periodic motion with complex multipliers has λ₁ = λ₂ = ln e × impacts/τ. Without loss and without chaos λ₁ goes to
    0 as ln N/N, because neighbours part linearly.

    Not guaranteed: that the motion stays what it was. Chaotic transients may last longer than any run; an exponent
    belongs to the cycles it was measured over. Where 256 batches are all shorter than the time for which a chaotic
    motion sticks to islands, the run sees one sojourn and its error is that of the sojourn.

    References
    ----------
    Benettin, Galgani, Giorgilli & Strelcyn, Meccanica 15, 9–20 (1980).

    Examples
    --------
    The mode (1, 1): both exponents are ln e times two impacts a cycle.

    >>> import math
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> spectrum = rk.lyapunov(system)
    >>> bool(abs(spectrum.values - 2 * math.log(0.925)).max() < spectrum.errors.max() < 1e-3)
    True
    """
    start = check_start(system, start)
    cycles = whole("cycles", cycles, 1, MAX_CYCLES)
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
    """A block under way with two orthonormal differences."""

    def __init__(self, system: System, start: State) -> None:
        self.period = system.forcing.period
        self.p, self.progress = start_march(system, start)
        self.columns = np.eye(2)

    @property
    def events(self) -> tuple[int, int]:
        return self.progress.impacts, self.progress.brace_hits

    def begin_average(self) -> None:
        """What was forgotten before the average does not count in it."""
        if not self.columns.any():
            self.columns[:] = np.eye(2)

    def to(self, cycle: int) -> np.ndarray:
        """March to the end of a cycle: the logarithms of what the differences grew by, shape (2,)."""
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
            f"the block must stay up for an exponent; it overturns, proved in cycle {proved} counted from 0 "
            "(take a weaker forcing, another start, or braces)"
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
    """The exponents of the growths in consecutive batches, the larger first; TooShort where they support no error."""
    # Of equal exponents either direction may have grown more.
    growths = growths[:, np.argsort(-growths.sum(axis=0), kind="stable")]
    time = cycles * system.forcing.period
    means = means_of(growths, lengths * system.forcing.period)
    floor = ROUNDING * (1.0 + sum(counted) / time)
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
        raise TooShort(_too_short(spectrum), spectrum)
    return spectrum


def _sum_rule_error(system: System, growths: np.ndarray, counted: tuple[int, int]) -> float:
    """λ₁ + λ₂ less what the events take, times the time; 0 where both are −∞."""
    if np.isinf(growths).any():
        return 0.0
    kept_by = NO_BRACES | quantities(system)
    taken = sum(
        2.0 * count * math.log(kept)
        for count, kept in zip(counted, (kept_by["restitution"], kept_by["brace_restitution"]), strict=True)
        if count
    )
    return math.fsum(growths.flat) - taken


def _too_short(spectrum: LyapunovSpectrum) -> str:
    value = f"λ₁ = {spectrum.values[0]:.3g} per τ"
    if len(spectrum.lengths) < MIN_BATCHES:
        return f"cycles must be {MIN_BATCHES} at least for an exponent with an error; got {spectrum.cycles} ({value})"
    return (
        f"{spectrum.cycles} cycles are too few for an exponent with an error: {len(spectrum.lengths)} batches of them still "
        f"hang together ({value}; take more cycles, or a longer transient)"
    )
