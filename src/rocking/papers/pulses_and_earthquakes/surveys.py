"""Ground motions of the report, and the surveys of them that figures and rows share."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from attrs import frozen

import rocking as rk
from rocking.papers.pulses_and_earthquakes import runge_kutta
from rocking.papers.pulses_and_earthquakes.thresholds import GRAVITY
from rocking.papers.report.workers import shared

if TYPE_CHECKING:
    import xarray as xr

NO_RECORD = "needs a record that does not come with the package"
"""Reason why a row is not judged."""
SIZE, SLENDERNESS = 1.0, 0.25
"""R in m and θcr in rad of the block whose scales are followed."""
RATIOS = np.linspace(1.0, 6.0, 10_001)
"""PGA/(gθcr): the block leaves the base above 1."""
STRIDES = (100, 50, 20, 10, 5, 2, 1)
SLENDERNESSES = np.radians([10.0, 15.0, 20.0])
PERIODS = np.linspace(0.8, 8.0, 361)
"""2π/α in s."""
SPECTRUM_PGA = 0.6
"""PGA of the spectrum, in g."""
SUBSTEPS = (1, 2, 5, 10, 20)
COARSE_SIZE, COARSE_SLENDERNESS = 1.0, 0.15
COARSE_RATIOS = np.linspace(1.05, 4.0, 150)


@shared
def synthetic() -> tuple[rk.GroundMotion, ...]:
    """Return four synthetic motions."""
    return rk.synthetic_ground_motions(4, seed=1, step=0.02)


def fallen(survey: xr.Dataset) -> np.ndarray:
    """Return whether each run overturned."""
    code = str(survey.outcome.attrs["flag_meanings"]).split().index(rk.Outcome.OVERTURNED)
    return survey.outcome.values == code


def switches(over: np.ndarray) -> int:
    """Return the number of changes between standing and overturning along a grid of scales."""
    return int(np.count_nonzero(np.diff(over)))


@shared
def scales() -> xr.Dataset:
    """Return the ends of the block under the recorded motion at all scales."""
    record = rk.example_ground_motion()
    factor = RATIOS * (GRAVITY * SLENDERNESS / record.pga)
    return rk.rocking_spectrum(
        record, size=SIZE, slenderness=SLENDERNESS, levels=factor, model="slender", normalised_by="angle"
    ).dataset


@shared
def synthetic_scales() -> xr.Dataset:
    """Return the ends of the block under the synthetic motions at every fifth scale."""
    motions = synthetic()
    factor = RATIOS[::5] * (GRAVITY * SLENDERNESS / motions[0].pga)
    return rk.rocking_spectrum(
        motions, size=SIZE, slenderness=SLENDERNESS, levels=factor, model="slender", normalised_by="angle"
    ).dataset


@shared
def spectrum() -> xr.Dataset:
    """Return the rocking spectrum of the recorded motion."""
    alpha = 2 * np.pi / PERIODS
    return rk.rocking_spectrum(
        rk.example_ground_motion(),
        size=3 * GRAVITY / (4 * alpha**2),
        slenderness=SLENDERNESSES,
        levels=SPECTRUM_PGA,
        intensity="pga-g",
        model="slender",
        normalised_by="angle",
    ).dataset


@frozen
class Wrong:
    """Shares of verdicts of the Runge–Kutta method that differ from the exact ones, by the number of steps per sample."""

    at_end: tuple[rk.Share, ...]
    interpolated: tuple[rk.Share, ...]


@shared
def wrong_verdicts() -> Wrong:
    """Compare the Runge–Kutta method with the exact motions, where the exact verdict is certified."""
    motions = synthetic()
    factor = COARSE_RATIOS * (GRAVITY * COARSE_SLENDERNESS / motions[0].pga)
    exact = rk.rocking_spectrum(
        motions,
        size=COARSE_SIZE,
        slenderness=COARSE_SLENDERNESS,
        levels=factor,
        model="slender",
        normalised_by="angle",
    ).dataset.transpose("record", "level")
    sure = exact.certified.values.astype(bool).ravel()
    alpha = float(np.sqrt(3 * GRAVITY / (4 * COARSE_SIZE)))
    samples = np.concatenate(
        [np.outer(motion.acceleration / motion.pga, COARSE_RATIOS) for motion in motions], axis=1
    )
    restitution = 1 - 1.5 * np.sin(COARSE_SLENDERNESS) ** 2

    def share(substeps: int, interpolated: bool) -> rk.Share:
        fell = runge_kutta.overturned(
            samples, alpha * motions[0].step, restitution, substeps, interpolated=interpolated
        )
        return rk.Share(int((fell != fallen(exact).ravel())[sure].sum()), int(sure.sum()))

    return Wrong(
        *(tuple(share(substeps, interpolated) for substeps in SUBSTEPS) for interpolated in (False, True))
    )
