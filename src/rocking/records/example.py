"""Ground motion that comes with the package."""

from __future__ import annotations

from pathlib import Path

from rocking.model import GroundMotion
from rocking.records.read import read_ground_motion

FILE = Path(__file__).with_name("0111a.smc")


def example_ground_motion() -> GroundMotion:
    """Return a record of the Loma Prieta earthquake of 1989: San Francisco, 1295 Shafter, component 360°.

    An instrument of the US Geological Survey recorded it: Open-File Report 89-568, in the public domain.

    Returns
    -------
    GroundMotion
        30 s with a PGA of 1.04 m/s².

    See Also
    --------
    read_ground_motion : The motion in a file of your own.
    synthetic_ground_motions : Motions that no instrument recorded.

    Examples
    --------
    >>> motion = example_ground_motion()
    >>> motion.file.name, motion.component, round(motion.pga, 4), motion.duration
    ('0111a.smc', '360°', 1.0441, 30.0)
    """
    return read_ground_motion(FILE)
