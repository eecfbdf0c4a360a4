"""Power spectral density and its spectral lines, as values."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen

from rocking.model import (
    NotebookPicture,
    ReadOnlyArrays,
    System,
    counted,
    described,
    named,
    quantities,
    read_only,
)

if TYPE_CHECKING:
    import xarray as xr

SHOWN = 16
SHARE_OF_LINES = 0.9


@frozen
class Peak:
    """Spectral line.

    Attributes
    ----------
    frequency : float
        Frequency in cycles per τ, refined over the whole record.
    height : float
        Spectral density at the frequency bin of the line, Θ² τ. It grows with the segment length.
    amplitude : float
        Amplitude of the sine, in Θ. It does not depend on the segment length.
    name : str
        Combination of the forcing frequency f and the rotation frequency f_r, such as "f/3" or "f − 2f_r". "" if no
        combination fits, or more than one.
    forcing_multiple : Fraction or None
        p in p·f + q·f_r.
    rotation_multiple : int or None
        q in p·f + q·f_r.
    offset : float or None
        Distance from this combination, in cycles per τ.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> peak = rk.spectral_density(rk.simulate(system, cycles=1200), transient=600).peaks[0]
    >>> peak.name, str(peak.forcing_multiple), round(peak.frequency, 6)
    ('f/3', '1/3', 0.833333)
    """

    frequency: float
    height: float
    amplitude: float
    name: str
    forcing_multiple: Fraction | None
    rotation_multiple: int | None
    offset: float | None


@frozen(eq=False)
class SpectralDensity(ReadOnlyArrays, NotebookPicture):
    """One-sided power spectral density of Θ, in Θ² per (cycle per τ); returned by `spectral_density`.

    Attributes
    ----------
    system : System
        System of the motion.
    frequency : ndarray
        Frequency in cycles per τ, from 0 to half the sampling rate. The forcing frequency is f = 1/T.
    density : ndarray
        Power spectral density, Θ² τ.
    window : str or tuple
        Window, as in `scipy.signal.get_window`.
    segment, overlap, segments : int
        Cycles per segment, cycles by which neighbouring segments overlap, and number of segments averaged (Welch 1967).
    transient, cycles : int
        Number of forcing cycles discarded, and number of cycles used.
    samples : int
        Number of exact samples per forcing cycle.
    aliased : float
        Fraction of the variance above half the sampling rate, which is aliased; measured.
    mean, variance : float
        Mean and variance of Θ over the cycles used. The mean is not part of the density.
    bandwidth : float
        Noise bandwidth of the window, in cycles per τ.
    resolution : float
        1 over the length of the record, in cycles per τ: the largest distance of a line from its named combination.
    period : int or None
        Number of forcing cycles per response period; None if the motion is not periodic.
    symmetric : bool or None
        For a periodic motion, True if it is its own mirror image half a period later. It then has no even multiples.
    parts : int
        n of the multiples of f/n in names.
    rotation : float or None
        Rotation frequency f_r, in cycles per forcing cycle.
    peaks : tuple of Peak
        Spectral lines, the strongest first.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> density = rk.spectral_density(rk.simulate(system, cycles=1200), transient=600)
    >>> density.period, density.segments, density.broad_band
    (3, 14, False)
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
        """Frequencies in units of the forcing frequency."""
        return self.frequency * self.system.periodic.period

    @property
    def highest(self) -> float:
        """Highest frequency of the search for lines, in cycles per τ: a sixteenth of the sampling rate.

        The amplitudes of a signal with jumps in its velocity fall as the square of the frequency. Aliasing then changes a
        line at a fraction x of the sampling rate by up to (πx/sin πx)² − 1 of its amplitude. This is 1.3 % at a sixteenth,
        and a sixteenth of that at a quarter of this frequency.
        """
        return self.samples / SHOWN / self.system.periodic.period

    @property
    def line_share(self) -> float:
        """Fraction of the variance in spectral lines."""
        return min(1.0, sum(peak.amplitude**2 / 2 for peak in self.peaks) / self.variance)

    @property
    def broad_band(self) -> bool:
        """True if more than a tenth of the variance lies outside the spectral lines."""
        return self.line_share < SHARE_OF_LINES

    def to_xarray(self) -> xr.Dataset:
        """Return the density and its lines as a dataset, which xarray writes to netCDF and pandas to CSV.

        Returns
        -------
        xarray.Dataset
            `density` over `frequency`; `line_frequency`, `line_amplitude` and `line_name` along `line`, the strongest first.
        """
        import xarray as xr

        variables = {
            "density": ("frequency", self.density, named("power spectral density of the angle")),
            "line_frequency": (
                "line",
                np.array([peak.frequency for peak in self.peaks], float),
                named("frequency of a spectral line in cycles per tau"),
            ),
            "line_amplitude": (
                "line",
                np.array([peak.amplitude for peak in self.peaks], float),
                named("amplitude of a spectral line"),
            ),
            "line_name": (
                "line",
                np.array([peak.name for peak in self.peaks], str),
                {"long_name": "combination of the forcing frequency f and the rotation frequency f_r"},
            ),
        }
        frequency = "frequency", self.frequency, named("frequency in cycles per tau")
        attributes = described("Power spectral density of the angle") | {
            **quantities(self.system),
            "transient": self.transient,
            "cycles": self.cycles,
            "window": str(self.window),
            "segment": self.segment,
            "segments": self.segments,
            "overlap": self.overlap,
            "samples": self.samples,
            "mean": self.mean,
            "variance": self.variance,
        }
        return xr.Dataset(variables, {"frequency": frequency}, attributes)

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
            f"window {self.window}, {self.samples} samples per cycle, {self.aliased:.1g} of the variance aliased, "
            f"resolution {self.resolution:.3g} cycles per τ"
        )
