"""Claims on the effect of damping: figure 12, the rarity of chaos, periodic regions and sensitivity."""

from __future__ import annotations

import itertools

import numpy as np

import rocking as rk
from rocking.papers.report.claim import Chapter, Finding
from rocking.papers.yim_lin_1991 import cached_surveys

CHAPTER = Chapter("Effect of damping")
SMALLEST = 0.8
"""Smallest coefficient of restitution in the figures of the paper."""


@CHAPTER.claim("Fig. 12")
def region_grows() -> Finding:
    """The region between the stability bound of the (1, 1) mode and Melnikov's bound grows with e."""
    low, high = cached_surveys.PERIODS
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


def _shares() -> dict[float, rk.Share]:
    return dict(zip(cached_surveys.RESTITUTIONS, cached_surveys.chaos().shares, strict=True))


def _falls(shares: dict[float, rk.Share], highest: float) -> bool:
    """Return whether the fractions decrease from the lowest e to the highest e given."""
    values = [share.value for e, share in shares.items() if e <= highest]
    return all(after < before for before, after in itertools.pairwise(values))


def _a_fifth(share: rk.Share) -> bool:
    return share.low <= 0.2 <= share.high and share.low > 0.1


def _listed(shares: dict[float, rk.Share]) -> str:
    return "; ".join(f"{e:g}: {share}" for e, share in shares.items())


@CHAPTER.claim(
    "Fig. 12; numerical results",
    qualified="true for the values of e in the paper, from 0.8 to 1. For heavier damping the opposite holds: the chaotic fraction "
    "decreases as e grows to 0.8. Both hold for responses from rest at T from 0.2 to 3 and A up to 16",
)
def chaos_against_losses() -> Finding:
    """Chaos is more likely in lightly damped systems."""
    shares = _shares()
    light = [share for e, share in shares.items() if e >= SMALLEST]
    rises = all(before.value <= after.value for before, after in itertools.pairwise(light))
    rises &= light[-1].low > light[0].high
    falls = shares[0.2].low > light[0].high and _falls(shares, SMALLEST)
    return Finding(
        rises and light[-1].low > shares[0.2].high,
        f"fraction chaotic, with 95 % intervals, by e: {_listed(shares)}",
        shown=rises and falls,
    )


@CHAPTER.claim(
    "Numerical results",
    qualified="it reports the search of the paper. Here, too, no system with e from 0.8 to 0.95 among the random ones is chaotic from "
    "rest. But chaotic responses occur at every e from 0.2 to 0.6. At e = 0.2 about every fifth system is chaotic, at 0.6 less than one in "
    "twenty",
)
def chaos_above_095() -> Finding:
    """The chaotic responses that an extensive search detected have e above 0.95."""
    shares = {e: share for e, share in _shares().items() if e <= 0.95}
    seen = [e for e, share in shares.items() if share.count]
    return Finding(
        not seen,
        f"found at e = {', '.join(f'{e:g}' for e in seen)} ({_listed(shares)})",
        shown=_falls(shares, 0.6)
        and _a_fifth(shares[0.2])
        and shares[0.6].count > 0
        and shares[0.6].high < 0.05
        and all(e < SMALLEST for e in seen),
    )


@CHAPTER.claim(
    "Numerical results; conclusion 4",
    qualified="rare for light damping, but not for heavy damping: about every fifth system is chaotic at e = 0.2",
)
def rare() -> Finding:
    """Chaotic responses of damped systems are rare and hard to find."""
    shares = {e: share for e, share in _shares().items() if e < 1.0}
    return Finding(
        all(share.value < 0.05 for share in shares.values()),
        _listed(shares),
        shown=shares[0.925].high < 0.02 and _a_fifth(shares[0.2]),
    )


@CHAPTER.claim("Figs. 10, 11; conclusion 4")
def region_periodic() -> Finding:
    """Damping produces a large region of periodic responses."""
    with_, without = (
        rk.Share(cached_surveys.count(found, rk.Kind.PERIODIC), found.kind.size)
        for found in (cached_surveys.damped(), cached_surveys.undamped())
    )
    return Finding(
        with_.low > 0.2 and without.count == 0, f"periodic: {with_} at e = 0.925, {without} at e = 1"
    )


@CHAPTER.claim(
    "Figs. 10, 11",
    error="chaos does not fill the whole space without damping: at e = 1 most of the map overturns",
)
def region_chaotic() -> Finding:
    """Damping reduces chaos from the whole parametric space to scattered spots."""
    found = cached_surveys.undamped()
    chaotic, over = (
        rk.Share(cached_surveys.count(found, kind), found.kind.size)
        for kind in (rk.Kind.CHAOTIC, rk.Kind.OVERTURNED)
    )
    damped = rk.Share(
        cached_surveys.count(cached_surveys.damped(), rk.Kind.CHAOTIC), cached_surveys.damped().kind.size
    )
    return Finding(
        chaotic.value > 0.5,
        f"e = 1: chaotic {chaotic}, overturned {over}; e = 0.925: chaotic {damped}",
        shown=over.low > 0.5 and chaotic.high < 0.1,
    )


@CHAPTER.claim("Numerical results; conclusion 4", cost=5.0)
def sensitivity() -> Finding:
    """Damping lowers the sensitivity of the response."""
    found = {e: cached_surveys.repeatable(e).uncertain for e in (1.0, 0.97, 0.925, 0.8, 0.5, 0.2)}
    text = "; ".join(f"{e:g}: {share}" for e, share in found.items())
    return Finding(
        all(found[e].high < found[1.0].low for e in found if e < 1.0),
        "fraction of the map whose outcome is uncertain if amplitude, period, coefficient of restitution and initial state vary by "
        f"1 %, e = {text}",
    )
