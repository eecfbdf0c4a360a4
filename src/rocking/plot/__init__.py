"""Plot functions: each takes a result and an Axes, and returns the Axes.

Units, labels, colours and sizes are set in this package only. The user's matplotlib settings stay unchanged.

Without an Axes, a function makes a figure, which a notebook shows. In a script that has imported `matplotlib.pyplot`, the figure
belongs to pyplot: `plt.show` shows it, and it stays open until `plt.close`.
"""

from rocking.model import result
from rocking.model.record_results import Fragility, IncrementalDynamicAnalysis, OverturningSet
from rocking.model.survey_results import (
    BasinMap,
    ChaosShare,
    OverturningCurve,
    Repeatability,
    RepeatabilityMap,
    SafeBasin,
)
from rocking.model.validation import explain
from rocking.model.verdict import Verdict
from rocking.motion.motion import Motion
from rocking.orbits.bifurcation_curve import BifurcationCurve
from rocking.orbits.bifurcation_set import BifurcationSet
from rocking.orbits.branch import Branch
from rocking.orbits.cascade import Cascade
from rocking.orbits.find_orbits import Orbits
from rocking.orbits.frequency_response_result import FrequencyResponse
from rocking.orbits.grazing_transition import GrazingTransition
from rocking.orbits.orbit_diagram_result import OrbitDiagram
from rocking.orbits.orbit_manifolds import OrbitManifolds
from rocking.orbits.response_diagram_result import ResponseDiagram
from rocking.orbits.saddle_manifolds import SaddleManifolds
from rocking.plot import palette as palette
from rocking.plot.animation import animation
from rocking.plot.basins import basins
from rocking.plot.bifurcation_curve import bifurcation_curve
from rocking.plot.bifurcation_set import bifurcation_set
from rocking.plot.branch import branch
from rocking.plot.cascade import cascade
from rocking.plot.chaos_share import chaos_share
from rocking.plot.convergence import convergence
from rocking.plot.correlation_dimension import correlation_dimension
from rocking.plot.fragility import fragility
from rocking.plot.frequency_response import frequency_response
from rocking.plot.grazing_transition import grazing_transition
from rocking.plot.impact_section import impact_section
from rocking.plot.incremental_dynamic_analysis import incremental_dynamic_analysis
from rocking.plot.manifolds import manifolds
from rocking.plot.melnikov import heteroclinic, melnikov
from rocking.plot.modes import modes
from rocking.plot.orbit_diagram import orbit_diagram
from rocking.plot.orbit_manifolds import orbit_manifolds
from rocking.plot.orbits import orbits
from rocking.plot.overturning import overturning
from rocking.plot.overturning_set import overturning_set
from rocking.plot.overturning_spectrum import overturning_spectrum
from rocking.plot.overview import overview
from rocking.plot.parametric_map import parametric_map
from rocking.plot.parts.figures import picture
from rocking.plot.parts.save import save
from rocking.plot.parts.style import panels, title
from rocking.plot.phase_portrait import phase_portrait
from rocking.plot.repeatability import repeatability, repeatability_map
from rocking.plot.response_diagram import response_diagram
from rocking.plot.rocking_spectrum import rocking_spectrum
from rocking.plot.safe_basin import safe_basin
from rocking.plot.schematic import schematic
from rocking.plot.section import section
from rocking.plot.spectrum import spectrum
from rocking.plot.thresholds import thresholds
from rocking.plot.time_history import time_history
from rocking.plot.verdict import untitled, verdict
from rocking.plot.zoomable_map import tiles
from rocking.response.correlation_dimension import CorrelationDimension
from rocking.response.lyapunov import LyapunovSpectrum
from rocking.response.spectrum import SpectralDensity

__all__ = [
    "animation",
    "basins",
    "bifurcation_curve",
    "bifurcation_set",
    "branch",
    "cascade",
    "chaos_share",
    "convergence",
    "correlation_dimension",
    "fragility",
    "frequency_response",
    "grazing_transition",
    "heteroclinic",
    "impact_section",
    "incremental_dynamic_analysis",
    "manifolds",
    "melnikov",
    "modes",
    "orbit_diagram",
    "orbit_manifolds",
    "orbits",
    "overturning",
    "overturning_set",
    "overturning_spectrum",
    "overview",
    "panels",
    "parametric_map",
    "phase_portrait",
    "repeatability",
    "repeatability_map",
    "response_diagram",
    "rocking_spectrum",
    "safe_basin",
    "save",
    "schematic",
    "section",
    "spectrum",
    "thresholds",
    "tiles",
    "time_history",
    "title",
    "verdict",
]

for kind, draw in (
    (BifurcationCurve, bifurcation_curve),
    (BifurcationSet, bifurcation_set),
    (Branch, branch),
    (Cascade, cascade),
    (CorrelationDimension, correlation_dimension),
    (LyapunovSpectrum, convergence),
    (SpectralDensity, spectrum),
    (FrequencyResponse, frequency_response),
    (GrazingTransition, grazing_transition),
    (Motion, overview),
    (OrbitDiagram, orbit_diagram),
    (OrbitManifolds, orbit_manifolds),
    (Orbits, orbits),
    (ResponseDiagram, response_diagram),
    (SaddleManifolds, manifolds),
    (Verdict, untitled),
    (BasinMap, basins),
    (SafeBasin, safe_basin),
    (OverturningCurve, overturning),
    (OverturningSet, overturning_set),
    (ChaosShare, chaos_share),
    (Fragility, fragility),
    (IncrementalDynamicAnalysis, incremental_dynamic_analysis),
    (Repeatability, repeatability),
    (RepeatabilityMap, repeatability_map),
    ("map", parametric_map),
):
    result.register(kind, picture(draw))

explain(globals(), __all__)
