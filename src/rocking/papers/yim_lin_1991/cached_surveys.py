"""Surveys that test the statistical statements of the paper, each computed once per run.

Period 0.2 to 3, amplitude 0 to 16, from rest with φ = 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from attrs import evolve

import rocking as rk
from rocking.model.survey_results import ChaosShare, RepeatabilityMap
from rocking.papers.report.workers import shared
from rocking.papers.yim_lin_1991.cases import QUASI_PERIODIC
from rocking.response.rotation_number import RotationNumber
from rocking.response.spectrum import SpectralDensity

PERIODS, AMPLITUDES = (0.2, 3.0), (0.0, 16.0)
RESTITUTIONS = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.925, 0.95, 0.97, 0.99, 1.0)
SAMPLES = 400
REPEATED = 32
BRACED_RESTITUTIONS, BRACED_SAMPLES = (0.2, 0.4, 0.6, 0.8, 0.925), 250
SYSTEMS = 900

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
"""Block of the damped maps; amplitude and period vary."""
BRACED = evolve(SYSTEM, braces=rk.Braces(angle=1.0, restitution=1.0))
"""The block between perfectly elastic braces at the critical angle."""


def axes(count: int) -> dict[str, Any]:
    """Return evenly spaced axes of a map."""
    return {"period": np.linspace(*PERIODS, count), "amplitude": np.linspace(*AMPLITUDES, count)}


@shared
def undamped() -> xr.Dataset:
    """Compute the map of figure 10, e = 1."""
    return rk.parametric_map(evolve(SYSTEM, restitution=1.0), **axes(160)).dataset


@shared
def damped() -> xr.Dataset:
    """Compute the map of figure 11, e = 0.925."""
    return rk.parametric_map(SYSTEM, **axes(400)).dataset


@shared
def braced() -> xr.Dataset:
    """Compute the map of figure 13b, e = 0.925 between perfectly elastic braces at the critical angle.

    Motions between braces count as chaotic only after 10⁵ cycles. Most motions that appear chaotic for a thousand
    cycles become periodic later.
    """
    return rk.parametric_map(BRACED, **axes(50), max_cycles=100_000).dataset


@shared
def chaos() -> ChaosShare:
    """Estimate the fraction of chaotic responses at random periods and amplitudes, over e."""
    return rk.chaos_share(SYSTEM, restitution=np.array(RESTITUTIONS), samples=SAMPLES)


@shared
def braced_chaos() -> ChaosShare:
    """Estimate the fraction of chaotic responses between perfectly elastic braces at the critical angle, over e."""
    return rk.chaos_share(
        BRACED, restitution=np.array(BRACED_RESTITUTIONS), samples=BRACED_SAMPLES, max_cycles=100_000
    )


@shared
def starts(amplitude: float, period: float, restitution: float) -> xr.Dataset:
    """Compute a map over initial states with |Θ| ≤ 1 and |Θ'| ≤ 1."""
    axis = np.linspace(-1.0, 1.0, 30)
    system = rk.System(rk.Harmonic(amplitude, period=period), restitution)
    return rk.parametric_map(system, angle=axis, velocity=axis).dataset


@shared
def repeatable(restitution: float) -> RepeatabilityMap:
    """Compute a map of repeatability for inputs that vary by 1 %."""
    return rk.repeatability_map(
        evolve(SYSTEM, restitution=restitution), **axes(REPEATED), samples=8, max_cycles=10_000
    )


@shared
def responses_uncertain(brace_angle: float | None = None) -> rk.Share:
    """Estimate the fraction of random systems with e = 0.925 whose response differs for inputs that vary by 1 %.

    Responses of different period, symmetry or number of impacts count as different.
    """
    rng = np.random.default_rng(13)
    braces = None if brace_angle is None else rk.Braces(brace_angle, 1.0)
    differ = 0
    for _ in range(SYSTEMS):
        system = rk.System(
            rk.Harmonic(rng.uniform(*AMPLITUDES), period=rng.uniform(*PERIODS)), 0.925, braces=braces
        )
        found = rk.repeatability(system, samples=16, max_cycles=10_000)
        differ += len(set(found.responses) - {rk.Kind.UNDETERMINED.value}) > 1
    return rk.Share(differ, SYSTEMS)


@shared
def torus_spectrum() -> SpectralDensity:
    """Compute the power spectral density of figure 8b."""
    return rk.spectral_density(rk.simulate(QUASI_PERIODIC.system, cycles=8_192))


@shared
def torus_turns() -> RotationNumber:
    """Compute the rotation number of the quasi-periodic response."""
    return rk.rotation_number(QUASI_PERIODIC.system, cycles=20_000)


def count(found: xr.Dataset, kind: rk.Kind) -> int:
    """Return the number of points with one type of response."""
    return int((found.kind == kind.code).sum())
