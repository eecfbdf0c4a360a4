"""Claims on the damped block, e < 1: Eqs. (20) to (22), figure 11 and its discussion."""

from __future__ import annotations

import numpy as np

import rocking as rk
from rocking.papers.report.claim import PROVABLE, Chapter, Finding, small
from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.cases import PERIODIC

CHAPTER = Chapter("Response of damped systems")


def _grid() -> tuple[np.ndarray, ...]:
    """Return the map of figure 11 as flat arrays.

    Returns
    -------
    tuple of arrays
        Type, response period, symmetry, forcing period and forcing amplitude of each point.
    """
    found = cached_surveys.damped().transpose("amplitude", "period")
    amplitude, period = np.meshgrid(found.amplitude.values, found.period.values, indexing="ij")
    names = ("kind", "response_period", "symmetric")
    return tuple(array.ravel() for array in (*(found[name].values for name in names), period, amplitude))


@CHAPTER.claim(
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


@CHAPTER.claim("Eq. (20b)")
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


@CHAPTER.claim("Eq. (21)", misprint="the right side needs a minus sign, which does not affect (22)")
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


@CHAPTER.claim("Eq. (22)")
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


@CHAPTER.claim("Fig. 11")
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


@CHAPTER.claim("Numerical results")
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


@CHAPTER.claim("Numerical results")
def even_orders() -> Finding:
    """Several asymmetric modes of even order are found."""
    kind, order, symmetric, *_ = _grid()
    even = np.unique(order[(kind == rk.Kind.PERIODIC.code) & (order % 2 == 0) & (symmetric == 0)])
    return Finding(len(even) > 1, f"from rest, orders {', '.join(map(str, even))}")


@CHAPTER.claim(
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
    found = rk.classify(sample.system, sample.start).orbit
    assert found is not None
    for name, symbol, ends in (
        ("amplitude", "A", cached_surveys.AMPLITUDES),
        ("period", "T", cached_surveys.PERIODS),
        ("restitution", "e", (0.2, 1.0)),
    ):
        special = rk.continue_orbit(found, name, ends).special
        folds = [point.parameter for point in special if point.kind == "fold"]
        apart &= len(folds) == 1 and all(point.kind != "symmetry-breaking" for point in special)
        places += [f"{symbol} = {each:.5f}" for each in folds]
    return Finding(
        not continued,
        f"T = 1.721, e = 0.8: {len(pair)} stable asymmetric branches from A = {breaking.parameter:.6f}, where the symmetry breaks "
        f"(closed form {closed:.6f}); simulated at A = 9: period {simulated.period}, "
        f"{'symmetric' if simulated.symmetric else 'asymmetric'}. Branches of figure 2c, period {found.period}: folds at "
        f"{', '.join(places)}, {'no' if apart else 'a'} symmetry breaking",
        shown=continued and apart,
    )


@CHAPTER.claim("Numerical results")
def boundary() -> Finding:
    """The stability boundary is reasonably accurate."""
    kind, order, symmetric, period, amplitude = _grid()
    shares = []
    for n in (1, 3):
        chosen = (kind == rk.Kind.PERIODIC.code) & (order == n) & (symmetric == 1)
        within = amplitude[chosen] <= rk.theory.symmetry_breaking_amplitude(period[chosen], 0.925, n) + 1e-9
        above = amplitude[chosen] >= rk.theory.existence_amplitude(period[chosen], 0.925, n) - 1e-9
        shares.append(rk.Share(int((within & above).sum()), int(chosen.sum())))
    return Finding(
        all(share.value > 0.95 for share in shares),
        f"{shares[0]} of the symmetric responses of period 1 lie where the (1, 1) mode is stable; {shares[1]} of the symmetric "
        "responses of period 3 lie where the (1, 3) mode is stable",
    )


@CHAPTER.claim("Numerical results")
def odd_orders() -> Finding:
    """Symmetric modes of odd order dominate."""
    kind, order, symmetric, *_ = _grid()
    periodic = kind == rk.Kind.PERIODIC.code
    share = rk.Share(int((periodic & (symmetric == 1) & (order % 2 == 1)).sum()), int(periodic.sum()))
    return Finding(share.low > 0.5, f"{share} of the periodic responses")


@CHAPTER.claim("Numerical results")
def unstable_not_overturned() -> Finding:
    """The block need not overturn if the analysis finds the modes unstable."""
    kind, _, _, period, amplitude = _grid()
    beyond = np.ones_like(kind, bool)
    for n in (1, 3):
        beyond &= amplitude > rk.theory.symmetry_breaking_amplitude(period, 0.925, n)
    share = rk.Share(int((kind[beyond] == rk.Kind.PERIODIC.code).sum()), int(beyond.sum()))
    return Finding(share.count > 0, f"beyond both stability curves {share} of the responses are periodic")


@CHAPTER.claim(
    "Fig. 11",
    qualified="a finer map has chaotic responses between the curves too, at less than one point in a thousand",
)
def between_curves() -> Finding:
    """Between the curves, from rest, only periodic and overturning responses are found."""
    kind, _, _, period, amplitude = _grid()
    between = (amplitude >= rk.theory.melnikov_amplitude(period, 0.925)) & (
        amplitude <= rk.theory.symmetry_breaking_amplitude(period, 0.925, 1)
    )
    counts = {
        str(name): int((kind[between] == name.code).sum())
        for name in (rk.Kind.QUASI_PERIODIC, rk.Kind.CHAOTIC)
    }
    return Finding(
        not any(counts.values()),
        f"of {int(between.sum()):,} points between the curves {counts['chaotic']} are chaotic, {counts['quasi-periodic']} quasi-periodic",
        shown=counts["quasi-periodic"] == 0 and rk.Share(counts["chaotic"], int(between.sum())).high < 1e-3,
    )


@CHAPTER.claim(
    "Numerical results; conclusion 4",
    error="every impact contracts areas by e², so that no invariant closed curve can exist; a motion on an apparent curve is a long "
    "transient",
)
def damped_quasi_periodic() -> Finding:
    """Other initial states and parameters give damped quasi-periodic responses."""
    counted, runs = 0, 0
    for e in (0.2, 0.5, 0.8, 0.925, 0.97, 0.99):
        found = cached_surveys.starts(4.0, 0.4, e)
        counted += cached_surveys.count(found, rk.Kind.QUASI_PERIODIC)
        runs += found.kind.size
    contracting = max(
        float(rk.lyapunov(rk.System(rk.Harmonic(4.0, period=0.4), e), cycles=5_000).values.sum())
        for e in (0.97, 0.99)
    )
    return Finding(
        counted > 0,
        f"{counted} of {runs:,} initial states at A = 4, T = 0.4, e from 0.2 to 0.99. At e = 0.97 and 0.99 areas shrink by a factor "
        f"of exp({contracting:.2f}) or less per unit of τ",
        shown=counted == 0 and contracting < 0.0,
    )


@CHAPTER.claim("Numerical results", cost=1.7)
def damped_chaos() -> Finding:
    """Other initial states and parameters give damped chaotic responses."""
    system = rk.System(rk.Harmonic(10.103037, period=1.721328), 0.8)
    found = rk.classify(system)
    text = f"A = 10.103037, T = 1.721328, e = 0.8 from rest: {found.evidence}"
    if PROVABLE:
        text += f" A chaotic invariant set is {rk.horseshoe(system, search=True)}."
    return Finding(found.kind is rk.Kind.CHAOTIC, text)


@CHAPTER.claim(
    "After (22)",
    error="the condition is at best necessary, as the paper states later: intersecting manifolds make a basin boundary fractal but "
    "imply no chaotic attractor",
)
def sufficient() -> Finding:
    """Condition (22) gives the parameters at which chaotic responses exist."""
    kind, _, _, period, amplitude = _grid()
    above = amplitude >= rk.theory.melnikov_amplitude(period, 0.925)
    share = rk.Share(int((kind[above] == rk.Kind.CHAOTIC.code).sum()), int(above.sum()))
    return Finding(
        share.value > 0.5, f"e = 0.925: {share} of the map above A_M is chaotic", shown=share.high < 0.01
    )
