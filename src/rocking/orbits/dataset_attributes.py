"""Names of parameters in datasets, and a parameter as a variable of a dataset."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from rocking.model.verdict import Kind

LONG_NAMES = {
    "amplitude": "amplitude of the base acceleration, A",
    "period": "forcing period, T",
    "frequency": "angular frequency of the forcing, Omega",
    "phase": "initial forcing phase, phi",
    "restitution": "coefficient of restitution of an impact, e",
    "brace_angle": "brace angle, Theta_b",
    "brace_restitution": "coefficient of restitution of a brace impact, r",
    "critical_angle": "critical angle of the block, theta_cr",
}
IN_RADIANS = ("phase", "critical_angle")


def coordinate_of(along: str, name: str, values: Any) -> tuple[str, Any, dict[str, str]]:
    """Return the values of a parameter as a variable."""
    return along, values, {"long_name": LONG_NAMES[name], "units": "rad" if name in IN_RADIANS else "1"}


def kinds_of(along: str, kinds: Iterable[str], text: str) -> tuple[str, Any, dict[str, Any]]:
    """Return types of response as a variable of codes, which its attributes explain."""
    names = [kind.value for kind in Kind]
    flags = {"flag_values": list(range(len(names))), "flag_meanings": " ".join(names)}
    return along, np.array([names.index(kind) for kind in kinds], np.uint8), {"long_name": text} | flags
