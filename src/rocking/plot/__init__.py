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
from rocking.orbits.frequency_response import FrequencyResponse
from rocking.orbits.grazing_transition import GrazingTransition
from rocking.orbits.orbit_diagram import OrbitDiagram
from rocking.orbits.orbit_manifolds import OrbitManifolds
from rocking.orbits.response_diagram import ResponseDiagram
from rocking.orbits.saddle_manifolds import SaddleManifolds
from rocking.plot import palette as palette
from rocking.plot.branch_lines import branch, cascade, frequency_response, orbits
from rocking.plot.curves import bifurcation_curve, bifurcation_set, grazing_transition
from rocking.plot.figures import picture, save
from rocking.plot.film import animation, schematic
from rocking.plot.manifold_lines import manifolds, orbit_manifolds
from rocking.plot.maps import parametric_map
from rocking.plot.motions import overview, phase_portrait, time_history
from rocking.plot.record_surveys import fragility, incremental_dynamic_analysis, overturning_set
from rocking.plot.rocking_spectra import overturning_spectrum, rocking_spectrum
from rocking.plot.sections import correlation_dimension, impact_section, section
from rocking.plot.shares import chaos_share, overturning, repeatability, repeatability_map
from rocking.plot.spectra import spectrum
from rocking.plot.state_surveys import basins, safe_basin
from rocking.plot.style import panels, title
from rocking.plot.sweeps import orbit_diagram, response_diagram
from rocking.plot.theory_curves import heteroclinic, melnikov, modes, thresholds
from rocking.plot.verdicts import convergence, untitled, verdict
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
