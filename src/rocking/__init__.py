"""Exact simulation and nonlinear dynamics of free-standing blocks on a shaking base.

A public name is imported on first use, so that `import rocking` loads no numerical library. The names stand in `__init__.pyi`:
functions, and the values that one passes to them. A class of results stands in the module that makes or defines it.
"""

from rocking.model.public_names import lazy

_MOVED = {
    "rocking.model.ground_motion": "RecordFile",
    "rocking.model.orbit": "Mode Orbit Stability",
    "rocking.model.proof": "Horseshoe Proof ProvedShare",
    "rocking.model.record_results": "Fragility IncrementalDynamicAnalysis LognormalFit OverturningSet Sensitivity",
    "rocking.model.survey_results": "Attractor BasinMap ChaosShare OverturningCurve "
    "Repeatability RepeatabilityMap SafeBasin UncertaintyExponent",
    "rocking.model.verdict": "Evidence Overturning Verdict",
    "rocking.motion.motion": "Motion",
    "rocking.orbits.bifurcation_curve": "BifurcationCurve",
    "rocking.orbits.bifurcation_set": "BifurcationSet",
    "rocking.orbits.branch": "Branch",
    "rocking.orbits.cascade": "Cascade",
    "rocking.orbits.codimension_two": "CodimensionTwoPoint",
    "rocking.orbits.diagrams": "OrbitDiagram ResponseDiagram",
    "rocking.orbits.find_orbits": "Orbits",
    "rocking.orbits.frequency_response": "FrequencyResponse",
    "rocking.orbits.grazing_transition": "GrazingTransition",
    "rocking.orbits.manifolds": "Manifold OrbitManifolds SaddleManifolds",
    "rocking.orbits.saddles": "manifold_gap",
    "rocking.orbits.special_points": "SpecialPoint",
    "rocking.response.correlation_dimension": "CorrelationDimension",
    "rocking.response.lyapunov": "LyapunovSpectrum",
    "rocking.response.rotation_number": "RotationNumber",
    "rocking.response.spectrum": "Peak SpectralDensity",
}
"""Names of version 0.1 that stand in other modules since version 0.2, by module."""

__getattr__, __dir__, __all__ = lazy(__name__, _MOVED)
