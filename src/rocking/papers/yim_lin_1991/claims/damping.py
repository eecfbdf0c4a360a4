"""Claims on responses with and without damping: Eqs. (19) to (22), figures 10 to 12."""

from __future__ import annotations

import itertools

import numpy as np

import rocking as rk
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.report.claim import PROVABLE, Finding, small
from rocking.papers.yim_lin_1991 import surveys
from rocking.papers.yim_lin_1991.surveys import PERIODIC

UNDAMPED = YIM_LIN_1991.chapter("Response of undamped systems")


@UNDAMPED.claim(
    "Existence and stability",
    error="the product of the eigenvalues is 1. For tanh(h/2) < V < coth(h/2), h = nπ/Ω, both lie on the unit circle, and the mode "
    "is neutrally stable",
)
def eigenvalues() -> Finding:
    """With e = 1 one eigenvalue is infinite and the other is 1 for all parameters: unstable or at best neutrally stable."""
    rng = np.random.default_rng(10)
    low, high = surveys.PERIODS
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
        explained=products < 1e-6 and len(sizes) > 0 and max(sizes) < 1e-6,
    )


@UNDAMPED.claim("Eq. (19a), (19b)")
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


@UNDAMPED.claim("After (19b)", error="the zeros are at Ωτ₀ = (k + ½)π; τ₀ = 2nπ is in general no zero")
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


@UNDAMPED.claim("After (19b)")
def always_zeros() -> Finding:
    """For e = 1 Melnikov's function has zeros at all amplitudes and frequencies."""
    periods = np.linspace(0.05, 20.0, 400)
    largest = float(np.max(rk.theory.melnikov_amplitude(periods, 1.0)))
    return Finding(largest == 0.0, f"A_M = {largest:g} at 400 periods from 0.05 to 20")


@UNDAMPED.claim("Fig. 10")
def figure_10() -> Finding:
    """Over period and amplitude only quasi-periodic, chaotic, no response and overturning occur."""
    shares = {kind.value: surveys.share(surveys.undamped(), kind) for kind in rk.Kind}
    text = ", ".join(f"{name} {share}" for name, share in shares.items())
    met = all(shares[kind].count > 0 for kind in ("rest", "quasi-periodic", "chaotic", "overturned"))
    return Finding(shares["periodic"].count == 0 and met, text)


@UNDAMPED.claim(
    "Numerical results; conclusion 3",
    error="neutrally stable periodic responses exist, and the islands of figure 5 surround one; it is true that none attracts and "
    "none is reached from rest",
    main=True,
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
        explained=exists,
    )


@UNDAMPED.claim(
    "Numerical results", qualified="often, but more of them lie in large regions without chaotic responses"
)
def neighbours() -> Finding:
    """Quasi-periodic responses usually appear together with chaotic ones."""
    kind = surveys.undamped().kind.values
    quasi = kind == rk.Kind.QUASI_PERIODIC.code
    restless = np.pad((kind == rk.Kind.CHAOTIC.code) | (kind == rk.Kind.UNDETERMINED.code), 2)
    rows, columns = np.nonzero(quasi)
    near = sum(bool(restless[i : i + 5, j : j + 5].any()) for i, j in zip(rows, columns, strict=True))
    share = rk.Share(near, len(rows))
    return Finding(
        share.low > 0.5,
        f"{share} of the quasi-periodic points have a chaotic or undetermined point within two points of the map (0.035 in T, 0.2 in A)",
        explained=share.low > 0.2,
    )


@UNDAMPED.claim("Numerical results; conclusion 2")
def bounded() -> Finding:
    """Without a stable periodic response the block need not overturn."""
    survey = surveys.undamped()
    count = sum(surveys.count(survey, kind) for kind in (rk.Kind.QUASI_PERIODIC, rk.Kind.CHAOTIC))
    share = rk.Share(count, survey.kind.size)
    return Finding(count > 0, f"e = 1: {share} of the map is quasi-periodic or chaotic")


@UNDAMPED.claim("Numerical results")
def folding() -> Finding:
    """Motions about one corner diverge; the impacts fold them back."""
    chaotic = rk.System(rk.Harmonic(amplitude=2.0, period=0.4), 1.0)
    motion = rk.simulate(chaotic, cycles=5_000)
    per_cycle, spread = surveys.sea()
    rate = per_cycle / chaotic.harmonic.period
    return Finding(
        motion.peak < 1.0
        and motion.outcome is rk.Outcome.BOUNDED
        and 0.0 < rate < 1.0
        and per_cycle > 3.0 * spread,
        f"figure 6: nearby motions diverge as exp τ within an arc, but |Θ| ≤ {motion.peak:.3f} over 5,000 cycles; "
        f"λ₁ = {rate:.2f} per unit of τ, less than the 1 of an arc",
    )


DAMPED = YIM_LIN_1991.chapter("Response of damped systems")


def _grid() -> tuple[np.ndarray, ...]:
    """Return the map of figure 11 as flat arrays.

    Returns
    -------
    tuple of arrays
        Type, response period, symmetry, forcing period and forcing amplitude of each point.
    """
    survey = surveys.damped().transpose("amplitude", "period")
    amplitude, period = np.meshgrid(survey.amplitude.values, survey.period.values, indexing="ij")
    names = ("kind", "response_period", "symmetric")
    return tuple(array.ravel() for array in (*(survey[name].values for name in names), period, amplitude))


@DAMPED.claim(
    "Eq. (20a)",
    misprint="both signs must be reversed: the base acceleration enters with −, and F is already negative",
)
def equation_20a() -> Finding:
    # the forcing term changes its sign after half a period; without forcing the damping term remains
    """Melnikov's integral with the forcing as + εα² cos ω(t + t₀) and the damping as −F."""
    closed = float(rk.theory.melnikov_function(0.1, 4.0, 1.0, 0.8))
    force = float(rk.theory.melnikov_function(0.1, 4.0, 1.0, 1.0))
    loss = rk.theory.melnikov_integral(0.1, 0.0, 1.0, 0.8)
    meant, printed = abs(force + loss - closed), abs(-force - loss - closed)
    return Finding(
        printed < 1e-5,
        f"differs from (20b) by {printed:.3g} as printed, by {small(meant)} with both signs reversed",
        meant < 2e-6,
    )


@DAMPED.claim("Eq. (20b)")
def equation_20b() -> Finding:
    """M⁺ = −2A cos Ωτ₀/(1 + Ω²) − (1 − e²)/2, normalised."""
    off = max(
        abs(
            rk.theory.melnikov_integral(time, 3.0, 1.0, e)
            + 6.0 * np.cos(2.0 * np.pi * time) / (1.0 + 4.0 * np.pi**2)
            + 0.5 * (1.0 - e * e)
        )
        for time in (0.0, 0.2, 0.7)
        for e in (0.2, 0.8, 0.95)
    )
    return Finding(
        bool(off < 2e-6),
        f"agrees with the integral to {small(off)} at nine combinations of phase and coefficient of restitution",
    )


@DAMPED.claim("Eq. (21)", misprint="the right side needs a minus sign, which does not affect (22)")
def equation_21() -> Finding:
    """Zeros where cos Ωτ₀ = (1 − e²)(1 + Ω²)/4A."""
    amplitude, period, e = 4.0, 1.0, 0.8
    omega = 2.0 * np.pi / period
    side = (1.0 - e * e) * (1.0 + omega**2) / (4.0 * amplitude)
    printed, meant = (
        abs(float(rk.theory.melnikov_function(np.arccos(cosine) / omega, amplitude, period, e)))
        for cosine in (side, -side)
    )
    return Finding(
        printed < 1e-12,
        f"|M⁺| = {printed:.3g} at the printed phase, {small(meant)} with the minus sign",
        meant < 1e-12,
    )


@DAMPED.claim("Eq. (22)")
def equation_22() -> Finding:
    """Zeros exist where (1 − e²)(1 + Ω²)/4A ≤ 1."""
    rng = np.random.default_rng(22)
    agreed = 0
    for _ in range(1_000):
        amplitude, period, e = rng.uniform(0.0, 16.0), rng.uniform(0.2, 3.0), rng.uniform(0.0, 1.0)
        omega = 2.0 * np.pi / period
        values = rk.theory.melnikov_function(np.linspace(0.0, period, 721), amplitude, period, e)
        agreed += bool(values.max() >= 0.0) == ((1.0 - e * e) * (1.0 + omega**2) <= 4.0 * amplitude)
    return Finding(
        agreed == 1_000,
        f"agrees with the sign changes of M⁺ over a period in {agreed:,} of 1,000 random systems",
    )


@DAMPED.claim("Fig. 11")
def figure_11() -> Finding:
    """From rest at e = 0.925: harmonic, one-third subharmonic, no response and overturning."""
    kind, order, *_ = _grid()
    parts = {
        "no response": kind == rk.Kind.REST.code,
        "overturned": kind == rk.Kind.OVERTURNED.code,
        "period 1": (kind == rk.Kind.PERIODIC.code) & (order == 1),
        "period 3": (kind == rk.Kind.PERIODIC.code) & (order == 3),
    }
    rest = 1.0 - sum(float(part.mean()) for part in parts.values())
    text = ", ".join(f"{name} {100 * part.mean():.1f} %" for name, part in parts.items())
    return Finding(
        rest < 0.05 and all(part.any() for part in parts.values()), f"{text}, all others {100 * rest:.2f} %"
    )


@DAMPED.claim("Numerical results")
def commonest() -> Finding:
    """The most common response is the (1, 1) mode, the second the (1, 3) mode."""
    kind, order, symmetric, *_ = _grid()
    chosen = (kind == rk.Kind.PERIODIC.code) & (symmetric == 1)
    orders, counts = np.unique(order[chosen], return_counts=True)
    ranking = orders[np.argsort(-counts)]
    text = ", ".join(
        f"period {n}: {100 * c / len(kind):.2f} %"
        for c, n in sorted(zip(counts, orders, strict=True), reverse=True)[:4]
    )
    return Finding(list(ranking[:2]) == [1, 3], f"symmetric responses, fraction of the map: {text}")


@DAMPED.claim("Numerical results")
def even_orders() -> Finding:
    """Several asymmetric modes of even order are found."""
    kind, order, symmetric, *_ = _grid()
    even = np.unique(order[(kind == rk.Kind.PERIODIC.code) & (order % 2 == 0) & (symmetric == 0)])
    return Finding(len(even) > 1, f"from rest, orders {', '.join(map(str, even))}")


@DAMPED.claim(
    "Numerical results",
    qualified="true of its sample, figure 2c: over A, T and e its stable orbits begin at folds, and no symmetry breaks on its branches. "
    "It is not true of the asymmetric modes that branch off the (1, 1) mode where stability analysis finds that this loses its "
    "stability. Both can be continued without simulation",
)
def asymmetric() -> Finding:
    """Asymmetric modes cannot be predicted by stability analysis, only simulated, and show no pattern."""
    mode = rk.theory.symmetric_modes(6.0, 1.721328, 0.8, 1)[0]
    orbit = rk.find_orbit(mode.system, mode.start, period=1)
    branch = rk.continue_orbit(orbit, "amplitude", (5.0, 9.0))
    breaking = next(point for point in branch.special if point.kind == "symmetry-breaking")
    closed = float(rk.theory.symmetry_breaking_amplitude(1.721328, 0.8, 1))
    pair = rk.switch_branch(breaking, (7.0, 10.4))
    predicted = all(not off.symmetric and bool(off.points["stable"].any()) for off in pair)
    simulated = rk.classify(rk.System(rk.Harmonic(9.0, period=1.721328), 0.8))
    continued = predicted and abs(breaking.parameter - closed) < 1e-6 and simulated.symmetric is False
    sample, places, apart = PERIODIC[2], [], True
    sample_orbit = rk.classify(sample.system, sample.start).orbit
    assert sample_orbit is not None
    for name, symbol, ends in (
        ("amplitude", "A", surveys.AMPLITUDES),
        ("period", "T", surveys.PERIODS),
        ("restitution", "e", (0.2, 1.0)),
    ):
        special = rk.continue_orbit(sample_orbit, name, ends).special
        folds = [point.parameter for point in special if point.kind == "fold"]
        apart &= len(folds) == 1 and all(point.kind != "symmetry-breaking" for point in special)
        places += [f"{symbol} = {each:.5f}" for each in folds]
    return Finding(
        not continued,
        f"T = 1.721, e = 0.8: {len(pair)} stable asymmetric branches from A = {breaking.parameter:.6f}, where the symmetry breaks "
        f"(closed form {closed:.6f}); simulated at A = 9: period {simulated.period}, "
        f"{'symmetric' if simulated.symmetric else 'asymmetric'}. Branches of figure 2c, period {sample_orbit.period}: folds at "
        f"{', '.join(places)}, {'no' if apart else 'a'} symmetry breaking",
        explained=continued and apart,
    )


@DAMPED.claim("Numerical results")
def boundary() -> Finding:
    """The stability boundary is reasonably accurate."""
    kind, order, symmetric, period, amplitude = _grid()
    shares = []
    for n in (1, 3):
        chosen = (kind == rk.Kind.PERIODIC.code) & (order == n) & (symmetric == 1)
        within = amplitude <= rk.theory.symmetry_breaking_amplitude(period, 0.925, n) + 1e-9
        above = amplitude >= rk.theory.existence_amplitude(period, 0.925, n) - 1e-9
        shares.append(surveys.share_among(within & above, chosen))
    return Finding(
        all(share.value > 0.95 for share in shares),
        f"{shares[0]} of the symmetric responses of period 1 lie where the (1, 1) mode is stable; {shares[1]} of the symmetric "
        "responses of period 3 lie where the (1, 3) mode is stable",
    )


@DAMPED.claim("Numerical results")
def odd_orders() -> Finding:
    """Symmetric modes of odd order dominate."""
    kind, order, symmetric, *_ = _grid()
    periodic = kind == rk.Kind.PERIODIC.code
    share = surveys.share_among((symmetric == 1) & (order % 2 == 1), periodic)
    return Finding(share.low > 0.5, f"{share} of the periodic responses")


@DAMPED.claim("Numerical results")
def unstable_not_overturned() -> Finding:
    """The block need not overturn if the analysis finds the modes unstable."""
    kind, _, _, period, amplitude = _grid()
    unstable = np.ones_like(kind, bool)
    for n in (1, 3):
        unstable &= amplitude > rk.theory.symmetry_breaking_amplitude(period, 0.925, n)
    share = surveys.share_among(kind == rk.Kind.PERIODIC.code, unstable)
    return Finding(share.count > 0, f"beyond both stability curves {share} of the responses are periodic")


@DAMPED.claim(
    "Fig. 11",
    qualified="a finer map has chaotic responses between the curves too, at less than one point in a thousand",
)
def between_curves() -> Finding:
    """Between the curves, from rest, only periodic and overturning responses are found."""
    kind, _, _, period, amplitude = _grid()
    between = (amplitude >= rk.theory.melnikov_amplitude(period, 0.925)) & (
        amplitude <= rk.theory.symmetry_breaking_amplitude(period, 0.925, 1)
    )
    quasi_periodic, chaotic = (
        surveys.share_among(kind == one.code, between) for one in (rk.Kind.QUASI_PERIODIC, rk.Kind.CHAOTIC)
    )
    return Finding(
        quasi_periodic.count == chaotic.count == 0,
        f"of {chaotic.of:,} points between the curves {chaotic.count} are chaotic, {quasi_periodic.count} quasi-periodic",
        explained=quasi_periodic.count == 0 and chaotic.high < 1e-3,
    )


@DAMPED.claim(
    "Numerical results; conclusion 4",
    error="every impact contracts areas by e², so that no invariant closed curve can exist; a motion on an apparent curve is a long "
    "transient",
    main=True,
)
def damped_quasi_periodic() -> Finding:
    """Other initial states and parameters give damped quasi-periodic responses."""
    counted, runs = 0, 0
    for e in (0.2, 0.5, 0.8, 0.925, 0.97, 0.99):
        survey = surveys.starts(4.0, 0.4, e)
        counted += surveys.count(survey, rk.Kind.QUASI_PERIODIC)
        runs += survey.kind.size
    contracting = max(
        float(rk.lyapunov(rk.System(rk.Harmonic(4.0, period=0.4), e), cycles=5_000).values.sum())
        for e in (0.97, 0.99)
    )
    return Finding(
        counted > 0,
        f"{counted} of {runs:,} initial states at A = 4, T = 0.4, e from 0.2 to 0.99. At e = 0.97 and 0.99 areas shrink by a factor "
        f"of exp({contracting:.2f}) or less per unit of τ",
        explained=counted == 0 and contracting < 0.0,
    )


@DAMPED.claim("Numerical results", cost=1.7)
def damped_chaos() -> Finding:
    """Other initial states and parameters give damped chaotic responses."""
    system = rk.System(rk.Harmonic(10.103037, period=1.721328), 0.8)
    response = rk.classify(system)
    text = f"A = 10.103037, T = 1.721328, e = 0.8 from rest: {response.evidence}"
    if PROVABLE:
        text += f" A chaotic invariant set is {rk.horseshoe(system, search=True)}."
    return Finding(response.kind is rk.Kind.CHAOTIC, text)


@DAMPED.claim(
    "After (22)",
    error="the condition is at best necessary, as the paper states later: intersecting manifolds make a basin boundary fractal but "
    "imply no chaotic attractor",
)
def sufficient() -> Finding:
    """Condition (22) gives the parameters at which chaotic responses exist."""
    kind, _, _, period, amplitude = _grid()
    above = amplitude >= rk.theory.melnikov_amplitude(period, 0.925)
    share = surveys.share_among(kind == rk.Kind.CHAOTIC.code, above)
    return Finding(
        share.value > 0.5, f"e = 0.925: {share} of the map above A_M is chaotic", explained=share.high < 0.01
    )


DAMPING = YIM_LIN_1991.chapter("Effect of damping")
SMALLEST = 0.8
"""Smallest coefficient of restitution in the figures of the paper."""


@DAMPING.claim("Fig. 12")
def region_grows() -> Finding:
    """The region between the stability bound of the (1, 1) mode and Melnikov's bound grows with e."""
    low, high = surveys.PERIODS
    periods = np.linspace(low, high, 561)
    areas = []
    for e in (0.5, 0.6, 0.7, 0.8, 0.9, 0.925, 0.95):
        upper = np.minimum(rk.theory.symmetry_breaking_amplitude(periods, e, 1), 16.0)
        lower = np.minimum(rk.theory.melnikov_amplitude(periods, e), 16.0)
        areas.append(float(np.trapezoid(np.clip(upper - lower, 0.0, None), periods)))
    text = ", ".join(f"{area:.2f}" for area in areas)
    return Finding(
        areas == sorted(areas),
        f"its area within T from 0.2 to 3 and A from 0 to 16. For e = 0.5, 0.6, 0.7, 0.8, 0.9, 0.925, 0.95: {text}",
    )


def _falls(shares: dict[float, rk.Share], highest: float) -> bool:
    """Return whether the fractions decrease from the lowest e to `highest`."""
    values = [share.value for e, share in shares.items() if e <= highest]
    return all(after < before for before, after in itertools.pairwise(values))


def _a_fifth(share: rk.Share) -> bool:
    return share.low <= 0.2 <= share.high and share.low > 0.1


def _listed(shares: dict[float, rk.Share]) -> str:
    return "; ".join(f"{e:g}: {share}" for e, share in shares.items())


@DAMPING.claim(
    "Fig. 12; numerical results",
    qualified="true for the values of e in the paper, from 0.8 to 1. For heavier damping the opposite holds: the chaotic fraction "
    "decreases as e grows to 0.8. Both hold for responses from rest at T from 0.2 to 3 and A up to 16",
)
def chaos_against_losses() -> Finding:
    """Chaos is more likely in lightly damped systems."""
    shares = surveys.chaos_shares()
    light = [share for e, share in shares.items() if e >= SMALLEST]
    rises = all(before.value <= after.value for before, after in itertools.pairwise(light))
    rises &= light[-1].low > light[0].high
    falls = shares[0.2].low > light[0].high and _falls(shares, SMALLEST)
    return Finding(
        rises and light[-1].low > shares[0.2].high,
        f"fraction chaotic, with 95 % intervals, by e: {_listed(shares)}",
        explained=rises and falls,
    )


@DAMPING.claim(
    "Numerical results",
    qualified="it reports the search of the paper. Here, too, no system with e from 0.8 to 0.95 among the random ones is chaotic from "
    "rest. But chaotic responses occur at every e from 0.2 to 0.6. At e = 0.2 about every fifth system is chaotic, at 0.6 less than one in "
    "twenty",
)
def chaos_above_095() -> Finding:
    """The chaotic responses that an extensive search detected have e above 0.95."""
    shares = {e: share for e, share in surveys.chaos_shares().items() if e <= 0.95}
    seen = [e for e, share in shares.items() if share.count]
    return Finding(
        not seen,
        f"found at e = {', '.join(f'{e:g}' for e in seen)} ({_listed(shares)})",
        explained=_falls(shares, 0.6)
        and _a_fifth(shares[0.2])
        and shares[0.6].count > 0
        and shares[0.6].high < 0.05
        and all(e < SMALLEST for e in seen),
    )


@DAMPING.claim(
    "Numerical results; conclusion 4",
    qualified="rare for light damping, but not for heavy damping: about every fifth system is chaotic at e = 0.2",
    main=True,
)
def rare() -> Finding:
    """Chaotic responses of damped systems are rare and hard to find."""
    shares = {e: share for e, share in surveys.chaos_shares().items() if e < 1.0}
    return Finding(
        all(share.value < 0.05 for share in shares.values()),
        _listed(shares),
        explained=shares[0.925].high < 0.02 and _a_fifth(shares[0.2]),
    )


@DAMPING.claim("Figs. 10, 11; conclusion 4")
def region_periodic() -> Finding:
    """Damping produces a large region of periodic responses."""
    with_, without = (
        surveys.share(survey, rk.Kind.PERIODIC) for survey in (surveys.damped(), surveys.undamped())
    )
    return Finding(
        with_.low > 0.2 and without.count == 0, f"periodic: {with_} at e = 0.925, {without} at e = 1"
    )


@DAMPING.claim(
    "Figs. 10, 11",
    error="chaos does not fill the whole space without damping: at e = 1 most of the map overturns",
)
def region_chaotic() -> Finding:
    """Damping reduces chaos from the whole parametric space to scattered spots."""
    chaotic, over = (
        surveys.share(surveys.undamped(), kind) for kind in (rk.Kind.CHAOTIC, rk.Kind.OVERTURNED)
    )
    damped = surveys.share(surveys.damped(), rk.Kind.CHAOTIC)
    return Finding(
        chaotic.value > 0.5,
        f"e = 1: chaotic {chaotic}, overturned {over}; e = 0.925: chaotic {damped}",
        explained=over.low > 0.5 and chaotic.high < 0.1,
    )


@DAMPING.claim("Numerical results; conclusion 4", cost=5.0, main=True)
def sensitivity() -> Finding:
    """Damping lowers the sensitivity of the response."""
    uncertain = {e: surveys.repeatable(e).uncertain for e in (1.0, 0.97, 0.925, 0.8, 0.5, 0.2)}
    text = "; ".join(f"{e:g}: {share}" for e, share in uncertain.items())
    return Finding(
        all(uncertain[e].high < uncertain[1.0].low for e in uncertain if e < 1.0),
        "fraction of the map whose outcome is uncertain if amplitude, period, coefficient of restitution and initial state vary by "
        f"1 %, e = {text}",
    )
