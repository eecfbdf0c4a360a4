"""Forcing at one instant, and the constants of an arc, for each kind of forcing."""

from typing import NamedTuple


class HarmonicDrive(NamedTuple):
    """Harmonic forcing at one instant: eta is its phase psi on the positive side, and psi + pi on the negative side."""

    cosine: float  # of eta
    sine: float


class PulseDrive(NamedTuple):
    """Pulse at one instant: the time since its start, and cos eta and sin eta as for ``HarmonicDrive``."""

    time: float
    cosine: float
    sine: float


class FullHarmonicDrive(NamedTuple):
    """Harmonic forcing of the full block at one instant: its phase is psi on either side."""

    cosine: float  # of psi
    sine: float


class FullSampledDrive(NamedTuple):
    """Place in a sampled forcing of the full block, as ``SampledDrive``."""

    index: int
    offset: float


class FullPulseDrive(NamedTuple):
    """Pulse of the full block at one instant: the time to its end, and cos psi and sin psi, which are 0 from there on."""

    left: float  # negative after the end; near the end its rounding errors are small
    cosine: float
    sine: float


class HarmonicConstants(NamedTuple):
    """Constants of an arc with harmonic forcing."""

    psi: float  # forcing phase at the start
    acceleration: float  # u'' there


class PulseConstants(NamedTuple):
    """Constants of an arc under a pulse, those of ``HarmonicConstants``."""

    psi: float
    acceleration: float


class SampledDrive(NamedTuple):
    """Place in a sampled forcing: interval between samples, and the time since its first sample."""

    index: int
    offset: float


class SampledConstants(NamedTuple):
    """Constants of an arc with sampled forcing: u = 1 + side scale P + (grow e^t + shrink e^-t)/2."""

    grow: float
    shrink: float


class FullHarmonicConstants(NamedTuple):
    """Constant of an arc of the full block with harmonic forcing."""

    psi: float  # forcing phase at the start


class FullSampledConstants(NamedTuple):
    """Constant of an arc of the full block with sampled forcing."""

    acceleration: float  # of the base, at the start


class FullPulseConstants(NamedTuple):
    """Constant of an arc of the full block under a pulse."""

    acceleration: float  # of the base, at the start
