"""Quantities and initial states of one system, as a survey takes them."""

from __future__ import annotations

import numpy as np

from rocking.model.system import System, check_constant_restitution, check_periodic, quantities
from rocking.survey.harmonic_spec import Points, points


def asked_of(system: System) -> dict[str, float]:
    """Return the quantities of a system as a survey takes them: the period but not the frequency."""
    check_periodic(system, None)
    check_constant_restitution(system)
    found = quantities(system)
    return {name: found[name] for name in found if name != "frequency"}


def points_of(system: System, starts: np.ndarray) -> Points:
    """Return the points of one system with initial states (n, 2)."""
    return points({"angle": starts[:, 0], "velocity": starts[:, 1]}, asked_of(system))
