"""Claims on the block between braces, figure 13, and on conclusions that belong to no other chapter."""

from __future__ import annotations

import numpy as np
import xarray as xr

import rocking as rk
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.report.claim import Finding
from rocking.papers.yim_lin_1991 import surveys
from rocking.papers.yim_lin_1991.surveys import BRACED

BRACED_SYSTEM = YIM_LIN_1991.chapter("Braced system")
HITS_PER_CYCLE = 1.0
SHIFT = 1e-13
"""Relative change of the amplitude that reveals where rounding selects the attractor."""


@BRACED_SYSTEM.claim("Braced system")
def unfelt() -> Finding:
    """The braces do not affect responses below the brace angle."""
    axes = surveys.axes(30)
    free = rk.parametric_map(surveys.SYSTEM, **axes).dataset
    shifted = rk.parametric_map(
        surveys.SYSTEM, amplitude=axes["amplitude"] * (1.0 + SHIFT), period=axes["period"]
    ).dataset
    braced = rk.parametric_map(BRACED, **axes, max_cycles=1_000).dataset
    below = (free.peak.values < 1.0) & (free.kind.values != rk.Kind.OVERTURNED.code)
    # after a long chaotic transient rounding selects the attractor, and the two maps locate events in different ways
    compared, same = below & _equal(free, shifted), _equal(free, braced)
    return Finding(
        bool(same[compared].all() and compared.sum() > 0.99 * below.sum()),
        f"type, period, symmetry and the largest |Θ| (to 10⁻⁶) are equal at {int(same[compared].sum())} of "
        f"{int(compared.sum())} points of a map with |Θ| < 1; at {int((below & ~compared).sum())} more a change of A by "
        f"10⁻¹³ changes one of these",
    )


def _equal(one: xr.Dataset, other: xr.Dataset) -> np.ndarray:
    """Return where two maps agree in type, period, symmetry and, to 10⁻⁶, the largest angle."""
    same = np.isclose(one.peak.values, other.peak.values, rtol=1e-6, atol=0.0)
    for name in ("kind", "response_period", "symmetric"):
        same &= one[name].values == other[name].values
    return same


@BRACED_SYSTEM.claim("Fig. 13a")
def figure_13a() -> Finding:
    """A = 15, T = 2, e = 0.925 between elastic braces at the critical angle: a chaotic attractor."""
    spectrum = rk.lyapunov(BRACED, cycles=100_000, transient=1_000)
    (first, second), (error, _) = spectrum.values, spectrum.errors
    return Finding(
        bool(first > 6.0 * error and first + second < 0.0),
        f"λ₁ = {first:.4f} ± {error:.4f}, λ₂ = {second:.4f} per unit of τ; {spectrum.impacts / 1e5:.2f} base impacts and "
        f"{spectrum.brace_hits / 1e5:.2f} brace impacts per cycle",
    )


@BRACED_SYSTEM.claim(
    "Fig. 13b",
    error="most such responses are periodic in the end; many appear chaotic for a thousand cycles",
    cost=0.3,
)
def frequent_hits() -> Finding:
    """Chaos dominates if brace impacts are frequent."""
    survey = surveys.braced()
    amplitude, period = np.meshgrid(survey.amplitude.values, survey.period.values, indexing="ij")
    kinds = survey.kind.transpose("amplitude", "period").values
    peaks = survey.peak.transpose("amplitude", "period").values
    frequent = [
        kinds[index]
        for index in zip(*np.nonzero(peaks >= 1.0), strict=True)
        if _hits_per_cycle(float(amplitude[index]), float(period[index])) >= HITS_PER_CYCLE
    ]
    chaotic = rk.Share(sum(kind == rk.Kind.CHAOTIC.code for kind in frequent), len(frequent))
    periodic = rk.Share(sum(kind == rk.Kind.PERIODIC.code for kind in frequent), len(frequent))
    return Finding(
        chaotic.value > 0.5,
        f"of {len(frequent)} points with one or more brace impacts per cycle, {periodic} are periodic and {chaotic} chaotic",
        explained=periodic.low > 0.5,
    )


def _hits_per_cycle(amplitude: float, period: float) -> float:
    system = rk.System(rk.Harmonic(amplitude, period=period), BRACED.restitution, BRACED.braces)
    return rk.simulate(system, cycles=200, record="none").brace_hits / 200.0


@BRACED_SYSTEM.claim("Fig. 13b")
def scattered() -> Finding:
    """Chaotic responses occur often, but are scattered."""
    share = surveys.share(surveys.braced(), rk.Kind.CHAOTIC)
    chaotic = surveys.braced().kind.transpose("amplitude", "period").values == rk.Kind.CHAOTIC.code
    padded = np.pad(chaotic, 1)
    rows, columns = np.nonzero(chaotic)
    alone = sum(int(padded[i : i + 3, j : j + 3].sum()) <= 5 for i, j in zip(rows, columns, strict=True))
    return Finding(
        share.low > 0.01 and alone > len(rows) // 2,
        f"{share} of the map at 10⁵ cycles; at most half of the neighbours are chaotic at {alone} of {len(rows)} chaotic points",
    )


@BRACED_SYSTEM.claim("Fig. 13b")
def dominant() -> Finding:
    """The (1, 1) mode dominates, with asymmetric modes of even order."""
    survey = surveys.braced()
    periodic = survey.kind == rk.Kind.PERIODIC.code
    first = surveys.share_among(survey.response_period == 1, periodic)
    even = int((periodic & (survey.response_period % 2 == 0)).sum())
    return Finding(
        first.low > 0.5 and even > 0,
        f"of the periodic responses {first} have period 1, and {even} an even period",
    )


@BRACED_SYSTEM.claim("Conclusion 3", cost=8.0, main=True)
def enlarged() -> Finding:
    """Braces enlarge the region of chaos."""
    maps = [surveys.share(survey, rk.Kind.CHAOTIC) for survey in (surveys.damped(), surveys.braced())]
    free = surveys.chaos_shares()
    braced = dict(zip(surveys.BRACED_RESTITUTIONS, surveys.braced_chaos().shares, strict=True))
    text = "; ".join(f"{e:g}: {free[e]} and {share}" for e, share in braced.items())
    return Finding(
        maps[1].low > maps[0].high and all(share.high >= free[e].low for e, share in braced.items()),
        f"fraction chaotic without and with braces, of the maps at e = 0.925: {maps[0]} and {maps[1]}; of random systems, by e: {text}",
    )


@BRACED_SYSTEM.claim("Conclusion 3", cost=12.0)
def more_sensitive() -> Finding:
    """Braces make responses more sensitive."""
    without, with_ = surveys.responses_uncertain(), surveys.responses_uncertain(1.0)
    return Finding(
        with_.low > without.high,
        f"fraction of {without.of} random systems, e = 0.925, in which inputs that vary by 1 % lead to responses of different type, "
        f"period or symmetry: {without} without braces, {with_} with braces",
    )


CONCLUSIONS = YIM_LIN_1991.chapter("Abstract and conclusions")


@CONCLUSIONS.claim("Abstract; conclusion 1", main=True)
def two_new_kinds() -> Finding:
    """Besides periodic and overturning responses there are quasi-periodic and chaotic ones."""
    survey = surveys.undamped()
    counts = {kind: surveys.count(survey, kind) for kind in (rk.Kind.QUASI_PERIODIC, rk.Kind.CHAOTIC)}
    return Finding(
        all(counts.values()),
        ", ".join(f"{count} {kind}" for kind, count in counts.items()) + " points of the map at e = 1",
    )


@CONCLUSIONS.claim("Conclusion 1", cost=0.3, main=True)
def coexist() -> Finding:
    """For some systems chaotic and periodic responses coexist."""
    survey = surveys.starts(10.103037, 1.721328, 0.8)
    kinds = {kind.value: surveys.count(survey, kind) for kind in rk.Kind}
    present = {name: count for name, count in kinds.items() if count}
    return Finding(
        kinds["chaotic"] > 0 and kinds["periodic"] > 0,
        f"A = 10.103, T = 1.721, e = 0.8, {survey.kind.size} initial states: "
        + ", ".join(f"{n} {k}" for k, n in present.items()),
    )


@CONCLUSIONS.claim("Introduction")
def unrepeatable() -> Finding:
    """Experiments with identical set-ups are not repeatable."""
    maps = {e: surveys.repeatable(e) for e in (0.8, 0.925, 1.0)}
    text = "; ".join(
        f"{e:g}: {survey.uncertain}, overturning {survey.overturning_uncertain}" for e, survey in maps.items()
    )
    return Finding(
        all(survey.uncertain.low > 0.0 for survey in maps.values()),
        "fraction of the map where inputs that vary by 1 % lead to more than one type of response, and fraction where overturning "
        f"is uncertain, e = {text}",
    )


@CONCLUSIONS.claim(
    "Conclusion 2",
    qualified="a first approximation: the manifolds touch at A*, above which, up to √(1 + Ω²), the boundary of overturning is fractal",
    main=True,
)
def boundary_given() -> Finding:
    """The analysis gives a boundary for the existence of chaotic response."""
    ratios = {
        (period, e): float(
            rk.theory.melnikov_amplitude(period, e) / rk.theory.heteroclinic_amplitude(period, e)
        )
        for period in (0.5, 1.0, 2.0)
        for e in (0.5, 0.8, 0.925, 0.99)
    }
    text = ", ".join(f"{ratio:.3f}" for ratio in ratios.values())
    gap = np.max(
        rk.theory.manifold_gap(
            np.linspace(0, 2 * np.pi, 100_001), rk.theory.heteroclinic_amplitude(1.0, 0.8), 1.0, 0.8
        )
    )
    return Finding(
        all(abs(ratio - 1.0) < 0.01 for ratio in ratios.values()),
        f"A_M/A* for T = 0.5, 1, 2 and e = 0.5, 0.8, 0.925, 0.99: {text}",
        explained=abs(ratios[0.5, 0.99] - 1.0) < 0.01 and abs(float(gap)) < 1e-8,
    )
