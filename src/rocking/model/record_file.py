"""File that a ground motion was read from, and the comparison of its samples with its header."""

from __future__ import annotations

from attrs import frozen

RELATIVE_TOLERANCE = 0.01
"""Allowed relative difference between the two peaks: that of samples printed with three digits."""


@frozen
class RecordFile:
    """File that a ground motion was read from.

    Attributes
    ----------
    name : str
        Name of the file.
    sha256 : str
        SHA-256 digest of its bytes, hexadecimal.
    format : str
        Format of the file, such as "PEER AT2".
    channel : str
        Channel of the file, such as "channel 1 of 3, 90°"; empty if it has only one.
    pga : float or None
        Peak ground acceleration of the samples as read, in m/s².
    header_pga : float or None
        Peak ground acceleration according to the header, in m/s², without its sign; None if the header gives none.
    header_rounding : float
        Half a unit of the last digit of `header_pga`, in m/s².

    Examples
    --------
    >>> file = RecordFile("a.v2", "0" * 64, "CSMIP V2", pga=2.0, header_pga=2.51, header_rounding=0.005)
    >>> round(file.pga_difference, 3), file.pga_agrees
    (-0.51, False)
    """

    name: str
    sha256: str
    format: str
    channel: str = ""
    pga: float | None = None
    header_pga: float | None = None
    header_rounding: float = 0.0

    @property
    def pga_difference(self) -> float | None:
        """PGA of the samples less PGA of the header, in m/s²; None if one is unknown."""
        return None if self.pga is None or self.header_pga is None else self.pga - self.header_pga

    @property
    def pga_agrees(self) -> bool | None:
        """Agreement of both PGA within 1 % and the rounding of the header; None if one is unknown."""
        difference = self.pga_difference
        if difference is None or self.header_pga is None:
            return None
        return abs(difference) <= self.header_rounding + RELATIVE_TOLERANCE * self.header_pga
