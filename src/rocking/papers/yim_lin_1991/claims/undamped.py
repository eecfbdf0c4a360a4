"""Claims on the undamped block, e = 1: Eq. (19), figure 10 and its discussion."""

from __future__ import annotations

import numpy as np

import rocking as rk
from rocking.papers.report.claim import Chapter, Finding, small
from rocking.papers.yim_lin_1991 import cached_surveys, table_exponents

CHAPTER = Chapter("Response of undamped systems")


@CHAPTER.claim(
    "Existence and stability",
    error="the product of the eigenvalues is 1. For tanh(h/2) < V < coth(h/2), h = nπ/Ω, both lie on the unit circle, and the mode "
    "is neutrally stable",
)
def eigenvalues() -> Finding:
    """With e = 1 one eigenvalue is infinite and the other is 1 for all parameters: unstable or at best neutrally stable."""
    rng = np.random.default_rng(10)
    low, high = cached_surveys.PERIODS
    modes = [
        mode
        for _ in range(600)
        for mode in rk.theory.symmetric_modes(
            rng.uniform(0.0, 16.0), rng.uniform(low, high), 1.0, int(rng.choice((1, 3)))
        )
        if mode.admissible
    ]
    products = max(abs(mode.half_multipliers[0] * mode.half_multipliers[1] - 1.0) for mode in modes)
    sizes = [abs(abs(mode.half_multipliers[0]) - 1.0) for mode in modes if mode.stability == "neutral"]
    largest = max(abs(mode.half_multipliers[0]) for mode in modes)
    return Finding(
        bool(np.isinf(largest)),
        f"{len(sizes)} of {len(modes)} modes have both eigenvalues on the unit circle, to {small(max(sizes))}; the largest eigenvalue "
        f"is {largest:.3g}",
        shown=products < 1e-6 and len(sizes) > 0 and max(sizes) < 1e-6,
    )


@CHAPTER.claim("Eq. (19a), (19b)")
def equation_19() -> Finding:
    """Melnikov's function for e = 1 is −2A cos Ωτ₀/(1 + Ω²)."""
    off = max(
        abs(
            rk.theory.melnikov_integral(time, 3.0, period, 1.0)
            + 6.0 * np.cos(2.0 * np.pi * time / period) / (1.0 + (2.0 * np.pi / period) ** 2)
        )
        for time in (0.0, 0.2, 0.7)
        for period in (0.5, 1.0, 2.5)
    )
    return Finding(
        bool(off < 1e-9), f"agrees with the integral to {small(off)} at nine combinations of phase and period"
    )


@CHAPTER.claim("After (19b)", error="the zeros are at Ωτ₀ = (k + ½)π; τ₀ = 2nπ is in general no zero")
def zeros_19() -> Finding:
    """The zeros of Melnikov's function for e = 1 are at τ₀ = 2nπ."""
    period = 1.3
    k = np.arange(10)
    printed = np.abs(rk.theory.melnikov_function(2.0 * np.pi * k, 3.0, period, 1.0)).max()
    meant = np.abs(rk.theory.melnikov_function((k + 0.5) * period / 2.0, 3.0, period, 1.0)).max()
    return Finding(
        bool(printed < 1e-12),
        f"|M⁺| up to {printed:.3g} at τ₀ = 2nπ, up to {small(meant)} at Ωτ₀ = (k + ½)π",
        bool(meant < 1e-12),
    )


@CHAPTER.claim("After (19b)")
def always_zeros() -> Finding:
    """For e = 1 Melnikov's function has zeros at all amplitudes and frequencies."""
    periods = np.linspace(0.05, 20.0, 400)
    largest = float(np.max(rk.theory.melnikov_amplitude(periods, 1.0)))
    return Finding(largest == 0.0, f"A_M = {largest:g} at 400 periods from 0.05 to 20")


@CHAPTER.claim("Fig. 10")
def figure_10() -> Finding:
    """Over period and amplitude only quasi-periodic, chaotic, no response and overturning occur."""
    found = cached_surveys.undamped()
    shares = {kind.value: rk.Share(cached_surveys.count(found, kind), found.kind.size) for kind in rk.Kind}
    text = ", ".join(f"{name} {share}" for name, share in shares.items())
    met = all(shares[kind].count > 0 for kind in ("rest", "quasi-periodic", "chaotic", "overturned"))
    return Finding(shares["periodic"].count == 0 and met, text)


@CHAPTER.claim(
    "Numerical results; conclusion 3",
    error="neutrally stable periodic responses exist, and the islands of figure 5 surround one; it is true that none attracts and "
    "none is reached from rest",
)
def no_periodic() -> Finding:
    """With e = 1 no periodic response exists."""
    mode = next(mode for mode in rk.theory.symmetric_modes(4.0, 0.4, 1.0, 3) if mode.admissible)
    section = rk.simulate(mode.system, mode.start, cycles=30_000, record="section").section()
    off = float(np.abs(section[::3] - section[0]).max())
    near = rk.classify(mode.system, rk.State(velocity=mode.velocity + 1e-3))
    exists = mode.stability == "neutral" and off < 1e-6 and near.kind is rk.Kind.QUASI_PERIODIC
    return Finding(
        not exists,
        f"the (1, 3) mode at A = 4, T = 0.4 repeats itself for 30,000 cycles to {small(off)}; from a state at a distance of 10⁻³ the "
        f"motion is {near.kind}",
        shown=exists,
    )


@CHAPTER.claim(
    "Numerical results", qualified="often, but more of them lie in large regions without chaotic responses"
)
def neighbours() -> Finding:
    """Quasi-periodic responses usually appear together with chaotic ones."""
    kind = cached_surveys.undamped().kind.values
    quasi = kind == rk.Kind.QUASI_PERIODIC.code
    restless = np.pad((kind == rk.Kind.CHAOTIC.code) | (kind == rk.Kind.UNDETERMINED.code), 2)
    rows, columns = np.nonzero(quasi)
    near = sum(bool(restless[i : i + 5, j : j + 5].any()) for i, j in zip(rows, columns, strict=True))
    share = rk.Share(near, len(rows))
    return Finding(
        share.low > 0.5,
        f"{share} of the quasi-periodic points have a chaotic or undetermined point within two points of the map (0.035 in T, 0.2 in A)",
        shown=share.low > 0.2,
    )


@CHAPTER.claim("Numerical results; conclusion 2")
def bounded() -> Finding:
    """Without a stable periodic response the block need not overturn."""
    found = cached_surveys.undamped()
    count = sum(cached_surveys.count(found, kind) for kind in (rk.Kind.QUASI_PERIODIC, rk.Kind.CHAOTIC))
    share = rk.Share(count, found.kind.size)
    return Finding(count > 0, f"e = 1: {share} of the map is quasi-periodic or chaotic")


@CHAPTER.claim("Numerical results")
def folding() -> Finding:
    """Motions about one corner diverge; the impacts fold them back."""
    chaotic = rk.System(rk.Harmonic(amplitude=2.0, period=0.4), 1.0)
    motion = rk.simulate(chaotic, cycles=5_000)
    per_cycle, spread = table_exponents.sea()
    rate = per_cycle / chaotic.harmonic.period
    return Finding(
        motion.peak < 1.0
        and motion.outcome is rk.Outcome.BOUNDED
        and 0.0 < rate < 1.0
        and per_cycle > 3.0 * spread,
        f"figure 6: nearby motions diverge as exp τ within an arc, but |Θ| ≤ {motion.peak:.3f} over 5,000 cycles; "
        f"λ₁ = {rate:.2f} per unit of τ, less than the 1 of an arc",
    )
