"""Claims on the block between braces: figure 13 and its discussion."""

from __future__ import annotations

import numpy as np
import xarray as xr

import rocking as rk
from rocking.papers.report.claim import Chapter, Finding
from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.cases import BRACED

CHAPTER = Chapter("Braced system")
HITS_PER_CYCLE = 1.0
SHIFT = 1e-13
"""Relative change of the amplitude that reveals where rounding selects the attractor."""


@CHAPTER.claim("Braced system")
def unfelt() -> Finding:
    """The braces do not affect responses below the brace angle."""
    axes = cached_surveys.axes(30)
    free = rk.parametric_map(cached_surveys.SYSTEM, **axes).dataset
    shifted = rk.parametric_map(
        cached_surveys.SYSTEM, amplitude=axes["amplitude"] * (1.0 + SHIFT), period=axes["period"]
    ).dataset
    braced = rk.parametric_map(cached_surveys.BRACED, **axes, max_cycles=1_000).dataset
    below = (free.peak.values < 1.0) & (free.kind.values != rk.Kind.OVERTURNED.code)
    # after a long chaotic transient rounding selects the attractor, and the two maps locate events in different ways
    compared, same = below & _alike(free, shifted), _alike(free, braced)
    return Finding(
        bool(same[compared].all() and compared.sum() > 0.99 * below.sum()),
        f"type, period, symmetry and the largest |Θ| (to 10⁻⁶) are equal at {int(same[compared].sum())} of "
        f"{int(compared.sum())} points of a map with |Θ| < 1; at {int((below & ~compared).sum())} more a change of A by "
        f"10⁻¹³ changes one of these",
    )


def _alike(one: xr.Dataset, other: xr.Dataset) -> np.ndarray:
    """Return where two maps agree in type, period, symmetry and, to 10⁻⁶, the largest angle."""
    same = np.isclose(one.peak.values, other.peak.values, rtol=1e-6, atol=0.0)
    for name in ("kind", "response_period", "symmetric"):
        same &= one[name].values == other[name].values
    return same


@CHAPTER.claim("Fig. 13a")
def figure_13a() -> Finding:
    """A = 15, T = 2, e = 0.925 between elastic braces at the critical angle: a chaotic attractor."""
    spectrum = rk.lyapunov(BRACED, cycles=100_000, transient=1_000)
    (first, second), (error, _) = spectrum.values, spectrum.errors
    return Finding(
        bool(first > 6.0 * error and first + second < 0.0),
        f"λ₁ = {first:.4f} ± {error:.4f}, λ₂ = {second:.4f} per unit of τ; {spectrum.impacts / 1e5:.2f} base impacts and "
        f"{spectrum.brace_hits / 1e5:.2f} brace impacts per cycle",
    )


@CHAPTER.claim(
    "Fig. 13b",
    error="most such responses are periodic in the end; many appear chaotic for a thousand cycles",
    cost=0.3,
)
def frequent_hits() -> Finding:
    """Chaos dominates if brace impacts are frequent."""
    found = cached_surveys.braced()
    amplitude, period = np.meshgrid(found.amplitude.values, found.period.values, indexing="ij")
    kinds = found.kind.transpose("amplitude", "period").values
    peaks = found.peak.transpose("amplitude", "period").values
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
        shown=periodic.low > 0.5,
    )


def _hits_per_cycle(amplitude: float, period: float) -> float:
    system = rk.System(rk.Harmonic(amplitude, period=period), BRACED.restitution, BRACED.braces)
    return rk.simulate(system, cycles=200, record="none").brace_hits / 200.0


@CHAPTER.claim("Fig. 13b")
def scattered() -> Finding:
    """Chaotic responses occur often, but are scattered."""
    found = cached_surveys.braced()
    kind = found.kind.transpose("amplitude", "period").values
    share = rk.Share(int((kind == rk.Kind.CHAOTIC.code).sum()), kind.size)
    padded = np.pad(kind, 1)
    rows, columns = np.nonzero(kind == rk.Kind.CHAOTIC.code)
    alone = sum(
        int((padded[i : i + 3, j : j + 3] == rk.Kind.CHAOTIC.code).sum()) <= 5
        for i, j in zip(rows, columns, strict=True)
    )
    return Finding(
        share.low > 0.01 and alone > len(rows) // 2,
        f"{share} of the map at 10⁵ cycles; at most half of the neighbours are chaotic at {alone} of {len(rows)} chaotic points",
    )


@CHAPTER.claim("Fig. 13b")
def dominant() -> Finding:
    """The (1, 1) mode dominates, with asymmetric modes of even order."""
    found = cached_surveys.braced()
    periodic = found.kind == rk.Kind.PERIODIC.code
    first = rk.Share(int((periodic & (found.response_period == 1)).sum()), int(periodic.sum()))
    even = int((periodic & (found.response_period % 2 == 0)).sum())
    return Finding(
        first.low > 0.5 and even > 0,
        f"of the periodic responses {first} have period 1, and {even} an even period",
    )


@CHAPTER.claim("Conclusion 3", cost=8.0)
def enlarged() -> Finding:
    """Braces enlarge the region of chaos."""
    maps = [
        rk.Share(cached_surveys.count(found, rk.Kind.CHAOTIC), found.kind.size)
        for found in (cached_surveys.damped(), cached_surveys.braced())
    ]
    free = dict(zip(cached_surveys.RESTITUTIONS, cached_surveys.chaos().shares, strict=True))
    braced = dict(zip(cached_surveys.BRACED_RESTITUTIONS, cached_surveys.braced_chaos().shares, strict=True))
    text = "; ".join(f"{e:g}: {free[e]} and {share}" for e, share in braced.items())
    return Finding(
        maps[1].low > maps[0].high and all(share.high >= free[e].low for e, share in braced.items()),
        f"fraction chaotic without and with braces, of the maps at e = 0.925: {maps[0]} and {maps[1]}; of random systems, by e: {text}",
    )


@CHAPTER.claim("Conclusion 3", cost=12.0)
def more_sensitive() -> Finding:
    """Braces make responses more sensitive."""
    without, with_ = cached_surveys.responses_uncertain(), cached_surveys.responses_uncertain(1.0)
    return Finding(
        with_.low > without.high,
        f"fraction of {without.of} random systems, e = 0.925, in which inputs that vary by 1 % lead to responses of different type, "
        f"period or symmetry: {without} without braces, {with_} with braces",
    )
