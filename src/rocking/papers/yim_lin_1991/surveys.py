"""Motions, systems and surveys that figures, tables and claims share; each survey is computed once per run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import evolve, frozen

import rocking as rk
from rocking.papers.report.workers import shared

if TYPE_CHECKING:
    import xarray as xr

    from rocking.model.survey_results import ChaosShare, RepeatabilityMap
    from rocking.motion.motion import Motion
    from rocking.response.correlation_dimension import CorrelationDimension
    from rocking.response.lyapunov import LyapunovSpectrum
    from rocking.response.rotation_number import RotationNumber
    from rocking.response.spectrum import SpectralDensity

# Ranges of the surveys, from rest with φ = 0.
PERIODS, AMPLITUDES = (0.2, 3.0), (0.0, 16.0)
RESTITUTIONS = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.925, 0.95, 0.97, 0.99, 1.0)
SAMPLES = 400
REPEATED = 32
BRACED_RESTITUTIONS, BRACED_SAMPLES = (0.2, 0.4, 0.6, 0.8, 0.925), 250
SYSTEMS = 900
# Number and length of runs as in 1991, and their range of phases, which no experiment can resolve.
SEA_STARTS, SEA_CYCLES, SEA_PHASES = 100, 2_000, 1e-7
# Number of runs for the points of the sea, points per run, and cycles after which the runs have diverged.
SEA_RUNS, SEA_POINTS, SEA_PARTED = 40, 5_000, 500
# Smallest radius, in standard deviations, that a section of some thousand points resolves.
COARSE = 0.1
REST = rk.State()


@frozen
class Case:
    """Motion of the paper: the system, its initial state, and the forcing cycles shown, counted from the start."""

    name: str
    system: rk.System
    cycles: tuple[int, int]
    start: rk.State = REST

    def motion(self) -> Motion:
        """Simulate the motion up to the last cycle shown."""
        return rk.simulate(self.system, self.start, cycles=self.cycles[1])


def _system(amplitude: float, period: float, restitution: float, phase: float = 0.0) -> rk.System:
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution)


PERIODIC = (
    Case("harmonic (1, 1) mode", _system(2.0, 1.0, 0.925), cycles=(200, 210)),
    Case("subharmonic (1, 3) mode", _system(6.5, 0.4, 0.925), cycles=(600, 624)),
    Case("asymmetric (2, 10) mode", _system(5.5, 0.5, 0.925, phase=1.8), (600, 630), rk.State(velocity=0.15)),
)
SYSTEM = PERIODIC[0].system
"""Block of the damped maps, e = 0.925; amplitude and period vary."""
OVERTURNING = Case("overturning", _system(1.75, 2.0, 0.95), cycles=(0, 20))
QUASI_PERIODIC = Case("quasi-periodic", _system(4.0, 0.4, 1.0), cycles=(0, 120))
CHAOTIC = Case("chaotic", _system(2.0, 0.4, 1.0), cycles=(0, 120))
BRACED = rk.System(
    rk.Harmonic(15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0, restitution=1.0)
)


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


def chaos_shares() -> dict[float, rk.Share]:
    """Return the fractions of chaotic responses by e."""
    return dict(zip(RESTITUTIONS, chaos().shares, strict=True))


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
    return rk.parametric_map(_system(amplitude, period, restitution), angle=axis, velocity=axis).dataset


@shared
def repeatable(restitution: float) -> RepeatabilityMap:
    """Compute a map of repeatability for inputs that vary by 1 %."""
    system = evolve(SYSTEM, restitution=restitution)
    return rk.repeatability_map(system, **axes(REPEATED), samples=8, max_cycles=10_000)


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
        responses = rk.repeatability(system, samples=16, max_cycles=10_000).responses
        differ += len(set(responses) - {rk.Kind.UNDETERMINED.value}) > 1
    return rk.Share(differ, SYSTEMS)


@shared
def torus_spectrum() -> SpectralDensity:
    """Compute the power spectral density of figure 8b."""
    return rk.spectral_density(rk.simulate(QUASI_PERIODIC.system, cycles=8_192))


@shared
def torus_turns() -> RotationNumber:
    """Compute the rotation number of the quasi-periodic response."""
    return rk.rotation_number(QUASI_PERIODIC.system, cycles=20_000)


def impacts(motion: Motion) -> np.ndarray:
    """Return the events of a motion that are impacts on the base."""
    return motion.events[motion.events["kind"] == "impact"]


def count(survey: xr.Dataset, kind: rk.Kind) -> int:
    """Return the number of points with one type of response."""
    return int((survey.kind == kind.code).sum())


def share(survey: xr.Dataset, kind: rk.Kind) -> rk.Share:
    """Return the fraction of points with one type of response."""
    return rk.Share(count(survey, kind), survey.kind.size)


def share_among(points: np.ndarray, among: np.ndarray) -> rk.Share:
    """Return the fraction of some points of a survey that are also others; both are arrays of bool."""
    return rk.Share(int((points & among).sum()), int(among.sum()))


@frozen
class Dimension:
    """Correlation dimension of a section, and whether the section scales."""

    estimate: CorrelationDimension
    scales: bool


@shared
def dimension(system: rk.System, points: int, transient: int = 0) -> Dimension:
    """Estimate the correlation dimension of the section of a motion from rest."""
    motion = rk.simulate(system, cycles=transient + points - 1, record="section")
    return _dimension_of(motion.section()[transient:])


def _dimension_of(points: np.ndarray) -> Dimension:
    try:
        return Dimension(rk.correlation_dimension(points), scales=True)
    except rk.TooShort as short:
        return Dimension(short.estimate, scales=False)


def spectrum(system: rk.System, cycles: int, transient: int | None = None) -> LyapunovSpectrum:
    """Return the Lyapunov exponents, even if a single run is too short for an error."""
    try:
        return rk.lyapunov(system, cycles=cycles, transient=transient)
    except rk.TooShort as short:
        return short.estimate


def sea_systems(count: int) -> list[rk.System]:
    """Return the chaotic system with ``count`` forcing phases that no experiment can distinguish."""
    forcing, restitution = CHAOTIC.system.harmonic, CHAOTIC.system.restitution
    return [
        rk.System(rk.Harmonic(forcing.amplitude, period=forcing.period, phase=phase), restitution)
        for phase in np.linspace(0.0, SEA_PHASES, count)
    ]


@shared
def sea() -> tuple[float, float]:
    """Return mean and standard deviation of λ₁ of the chaotic sea over runs of the length of 1991, nats per cycle."""
    spectra = [spectrum(system, SEA_CYCLES, transient=0) for system in sea_systems(SEA_STARTS)]
    per_cycle = np.array([float(each.values[0]) for each in spectra]) * CHAOTIC.system.harmonic.period
    return float(per_cycle.mean()), float(per_cycle.std(ddof=1))


@shared
def sea_dimension() -> Dimension:
    """Estimate the dimension of points of several runs.

    A single run is not representative: of 13 runs of 50,000 cycles, two stayed near islands for long and gave 1.6.
    """
    runs = [
        rk.simulate(system, cycles=SEA_PARTED + SEA_POINTS - 1, record="section").section()[SEA_PARTED:]
        for system in sea_systems(SEA_RUNS)
    ]
    return _dimension_of(np.concatenate(runs))
