"""A spectral density and the lines in it, as values."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.model import ReadOnlyArrays, System, counted, read_only

SHOWN = 16
SHARE_OF_LINES = 0.9


@frozen
class Peak:
    """A line of a spectrum.

    Attributes
    ----------
    frequency : float
        Of the line, refined over the whole record, in cycles per τ.
    height : float
        Spectral density at its bin, Θ² τ; it grows with the segment.
    amplitude : float
        Of its sine, Θ; it does not.
    name : str
        What it is, such as "f/3" or "f − 2f_r"; "" where no combination is it, or more than one.
    forcing_multiple : Fraction or None
        p, in p·f + q·f_r.
    rotation_multiple : int or None
        q.
    offset : float or None
        How far it lies from that combination, in cycles per τ.
    """

    frequency: float
    height: float
    amplitude: float
    name: str
    forcing_multiple: Fraction | None
    rotation_multiple: int | None
    offset: float | None


@frozen(eq=False)
class SpectralDensity(ReadOnlyArrays):
    """One-sided power spectral density of Θ, in Θ² per (cycle per τ); made by `spectral_density`.

    Attributes
    ----------
    system : System
        Whose motion it is.
    frequency, density : ndarray
        In cycles per τ, from 0 to half the sampling rate; the forcing lies at f = 1/T.
    window : str or tuple
        As `scipy.signal.get_window` knows it.
    segment, overlap, segments : int
        Cycles in a segment, cycles by which neighbours overlap, and how many were averaged (Welch 1967).
    transient, cycles : int
        Forcing cycles left out, and used.
    samples : int
        Exact states of the motion taken in each cycle.
    aliased : float
        Share of the variance that lies above half the sampling rate and is folded back, as measured.
    mean, variance : float
        Of Θ over the cycles used; the mean is not part of the density.
    bandwidth : float
        Of white noise in one bin under the window, in cycles per τ.
    resolution : float
        1 over the length of the record, in cycles per τ: how near a peak must be to what it is called.
    period : int or None
        Forcing cycles after which the motion repeats itself.
    symmetric : bool or None
        Of a periodic motion: whether it is its own mirror image half a period later, so that no even multiple appears.
    parts : int
        n of the multiples of f/n.
    rotation : float or None
        Rotation frequency f_r, in cycles per forcing cycle.
    peaks : tuple of Peak
        The lines, the strongest first.
    """

    system: System
    frequency: np.ndarray = field(repr=False, converter=read_only)
    density: np.ndarray = field(repr=False, converter=read_only)
    window: Any
    segment: int
    overlap: int
    segments: int
    transient: int
    cycles: int
    samples: int
    aliased: float
    mean: float
    variance: float
    bandwidth: float
    resolution: float
    period: int | None
    symmetric: bool | None
    parts: int
    rotation: float | None
    peaks: tuple[Peak, ...] = field(repr=False)

    @property
    def forcing_multiples(self) -> np.ndarray:
        """The frequencies, in units of the forcing's."""
        return self.frequency * self.system.forcing.period

    @property
    def highest(self) -> float:
        """Up to where lines are sought, a sixteenth of the sampling rate, in cycles per τ.

        A velocity that jumps gives amplitudes that fall as the square of the frequency. What is folded back onto a line at a
        share x of the sampling rate is then up to (πx/sin πx)² − 1 of its amplitude: 1.3 % here, a sixteenth of that at a
        quarter of this.
        """
        return self.samples / SHOWN / self.system.forcing.period

    @property
    def line_share(self) -> float:
        """Share of the variance that the lines carry."""
        return min(1.0, sum(peak.amplitude**2 / 2 for peak in self.peaks) / self.variance)

    @property
    def broad_band(self) -> bool:
        """Whether more than a tenth of the variance lies in no line."""
        return self.line_share < SHARE_OF_LINES

    def __str__(self) -> str:
        unnamed = sum(not peak.name for peak in self.peaks)
        what = "broad band" if self.broad_band else "lines"
        names = ", ".join(peak.name for peak in self.peaks[:5] if peak.name) or "none named"
        turning = f", f_r = {self.rotation:.6g} f" if self.rotation else ""
        one = len(self.peaks) == 1
        shared = f" overlapping by {self.overlap}" * (self.segments > 1)
        return (
            f"{what}: {counted(len(self.peaks), 'line')} ({names}{', …' * (len(self.peaks) > 5)}"
            f"{turning}; {unnamed} unnamed) {'carries' if one else 'carry'} {100 * self.line_share:.4g} % of the variance; "
            f"{counted(self.segments, 'segment')} of {self.segment} cycles{shared}, "
            f"window {self.window}, {self.samples} samples a cycle, {self.aliased:.1g} of the variance aliased, "
            f"resolution {self.resolution:.3g} cycles per τ"
        )
