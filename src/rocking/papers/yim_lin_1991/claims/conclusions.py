"""Claims of the abstract, the introduction and the conclusions that belong to no other chapter."""

from __future__ import annotations

import numpy as np

import rocking as rk
from rocking.papers.report.claim import Chapter, Finding
from rocking.papers.yim_lin_1991 import cached_surveys

CHAPTER = Chapter("Abstract and conclusions")


@CHAPTER.claim("Abstract; conclusion 1")
def two_new_kinds() -> Finding:
    """Besides periodic and overturning responses there are quasi-periodic and chaotic ones."""
    found = cached_surveys.undamped()
    counts = {kind: cached_surveys.count(found, kind) for kind in (rk.Kind.QUASI_PERIODIC, rk.Kind.CHAOTIC)}
    return Finding(
        all(counts.values()),
        ", ".join(f"{count} {kind}" for kind, count in counts.items()) + " points of the map at e = 1",
    )


@CHAPTER.claim("Conclusion 1", cost=0.3)
def coexist() -> Finding:
    """For some systems chaotic and periodic responses coexist."""
    found = cached_surveys.starts(10.103037, 1.721328, 0.8)
    kinds = {kind.value: cached_surveys.count(found, kind) for kind in rk.Kind}
    present = {name: count for name, count in kinds.items() if count}
    return Finding(
        kinds["chaotic"] > 0 and kinds["periodic"] > 0,
        f"A = 10.103, T = 1.721, e = 0.8, {found.kind.size} initial states: "
        + ", ".join(f"{n} {k}" for k, n in present.items()),
    )


@CHAPTER.claim("Introduction")
def unrepeatable() -> Finding:
    """Experiments with identical set-ups are not repeatable."""
    maps = {e: cached_surveys.repeatable(e) for e in (0.8, 0.925, 1.0)}
    text = "; ".join(
        f"{e:g}: {found.uncertain}, overturning {found.overturning_uncertain}" for e, found in maps.items()
    )
    return Finding(
        all(found.uncertain.low > 0.0 for found in maps.values()),
        "fraction of the map where inputs that vary by 1 % lead to more than one type of response, and fraction where overturning "
        f"is uncertain, e = {text}",
    )


@CHAPTER.claim(
    "Conclusion 2",
    qualified="a first approximation: the manifolds touch at A*, above which, up to √(1 + Ω²), the boundary of overturning is fractal",
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
        shown=abs(ratios[0.5, 0.99] - 1.0) < 0.01 and abs(float(gap)) < 1e-8,
    )
