"""Periodic orbits, their continuation and bifurcations, orbit diagrams, and manifolds of the saddle orbits."""

from rocking.orbits.bifurcation_curve import BifurcationCurve, bifurcation_curve
from rocking.orbits.bifurcation_set import BifurcationSet, bifurcation_set
from rocking.orbits.branch import BRANCHES_OFF, Branch, SpecialPoint
from rocking.orbits.cascade import Cascade, cascade
from rocking.orbits.codimension_two import CodimensionTwoPoint
from rocking.orbits.continuation import continue_orbit, switch_branch
from rocking.orbits.find_orbit import find_orbit
from rocking.orbits.find_orbits import Orbits, find_orbits
from rocking.orbits.frequency_response import frequency_response
from rocking.orbits.frequency_response_result import FrequencyResponse
from rocking.orbits.grazing_transition import GrazingTransition, grazing_transition
from rocking.orbits.horseshoe import horseshoe
from rocking.orbits.manifold_tangency import manifold_gap, tangency_amplitude
from rocking.orbits.orbit_diagram import orbit_diagram
from rocking.orbits.orbit_diagram_result import OrbitDiagram
from rocking.orbits.orbit_manifolds import OrbitManifolds, orbit_manifolds
from rocking.orbits.parameter import check_range, check_step
from rocking.orbits.response_diagram import response_diagram
from rocking.orbits.response_diagram_result import ResponseDiagram
from rocking.orbits.saddle_manifolds import Manifold, SaddleManifolds, saddle_manifolds

__all__ = [
    "BRANCHES_OFF",
    "BifurcationCurve",
    "BifurcationSet",
    "Branch",
    "Cascade",
    "CodimensionTwoPoint",
    "FrequencyResponse",
    "GrazingTransition",
    "Manifold",
    "OrbitDiagram",
    "OrbitManifolds",
    "Orbits",
    "ResponseDiagram",
    "SaddleManifolds",
    "SpecialPoint",
    "bifurcation_curve",
    "bifurcation_set",
    "cascade",
    "check_range",
    "check_step",
    "continue_orbit",
    "find_orbit",
    "find_orbits",
    "frequency_response",
    "grazing_transition",
    "horseshoe",
    "manifold_gap",
    "orbit_diagram",
    "orbit_manifolds",
    "response_diagram",
    "saddle_manifolds",
    "switch_branch",
    "tangency_amplitude",
]
