"""Analysis of responses: sections, spectra, Lyapunov exponents, dimensions, rotation numbers and classification."""

from rocking.response.classify import KINDS, MAX_CYCLES, MAX_PERIOD, budget, classify
from rocking.response.correlation_dimension import CorrelationDimension, correlation_dimension
from rocking.response.impact_section import impact_section
from rocking.response.lyapunov import lyapunov
from rocking.response.lyapunov_spectrum import LyapunovSpectrum
from rocking.response.mean_impacts import MeanImpacts, mean_impacts
from rocking.response.rotation_number import RotationNumber, rotation_number
from rocking.response.spectral_density import Peak, SpectralDensity
from rocking.response.transient import transient_of
from rocking.response.welch_spectrum import spectral_density

__all__ = [
    "KINDS",
    "MAX_CYCLES",
    "MAX_PERIOD",
    "CorrelationDimension",
    "LyapunovSpectrum",
    "MeanImpacts",
    "Peak",
    "RotationNumber",
    "SpectralDensity",
    "budget",
    "classify",
    "correlation_dimension",
    "impact_section",
    "lyapunov",
    "mean_impacts",
    "rotation_number",
    "spectral_density",
    "transient_of",
]
