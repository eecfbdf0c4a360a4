"""Periodic orbits, found and followed through parameters; diagrams; the saddles' manifolds: how responses change with the system."""

from rocking.orbits.branches import Branch, SpecialPoint
from rocking.orbits.continuation import continue_orbit, switch_branch
from rocking.orbits.curves import BifurcationCurve, bifurcation_curve
from rocking.orbits.diagram import orbit_diagram
from rocking.orbits.find import find_orbit
from rocking.orbits.frequency_response import frequency_response
from rocking.orbits.manifolds import Manifold, SaddleManifolds, saddle_manifolds
from rocking.orbits.peaks import FrequencyResponse
from rocking.orbits.search import Orbits, find_orbits
from rocking.orbits.swept import OrbitDiagram
from rocking.orbits.tangency import manifold_gap, tangency_amplitude

__all__ = [
    "BifurcationCurve",
    "Branch",
    "FrequencyResponse",
    "Manifold",
    "OrbitDiagram",
    "Orbits",
    "SaddleManifolds",
    "SpecialPoint",
    "bifurcation_curve",
    "continue_orbit",
    "find_orbit",
    "find_orbits",
    "frequency_response",
    "manifold_gap",
    "orbit_diagram",
    "saddle_manifolds",
    "switch_branch",
    "tangency_amplitude",
]
