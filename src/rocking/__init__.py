"""Exact simulation and nonlinear dynamics of free-standing blocks on a shaking base.

A public name is imported on first use, so that `import rocking` loads no numerical library.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocking import plot, theory
    from rocking.model import VERSION as __version__
    from rocking.model import (
        Attractor,
        BasinMap,
        Block,
        Braces,
        ChaosShare,
        Evidence,
        Fragility,
        GroundMotion,
        Harmonic,
        Horseshoe,
        IncrementalDynamicAnalysis,
        InputWarning,
        Kind,
        LognormalFit,
        Mode,
        NoOrbit,
        Orbit,
        Outcome,
        Overturning,
        OverturningCurve,
        OverturningSet,
        PiecewiseLinear,
        Proof,
        ProvedShare,
        Pulse,
        RecordFile,
        RecordSet,
        Repeatability,
        RepeatabilityMap,
        SafeBasin,
        Sensitivity,
        Share,
        Stability,
        State,
        System,
        TooManyEvents,
        TooShort,
        UncertaintyExponent,
        Verdict,
        cite,
    )
    from rocking.motion import Motion, simulate
    from rocking.orbits import (
        BifurcationCurve,
        BifurcationSet,
        Branch,
        Cascade,
        CodimensionTwoPoint,
        FrequencyResponse,
        GrazingTransition,
        Manifold,
        OrbitDiagram,
        OrbitManifolds,
        Orbits,
        ResponseDiagram,
        SaddleManifolds,
        SpecialPoint,
        bifurcation_curve,
        bifurcation_set,
        cascade,
        continue_orbit,
        find_orbit,
        find_orbits,
        frequency_response,
        grazing_transition,
        horseshoe,
        manifold_gap,
        orbit_diagram,
        orbit_manifolds,
        response_diagram,
        saddle_manifolds,
        switch_branch,
        tangency_amplitude,
    )
    from rocking.proof import prove
    from rocking.records import (
        RecordError,
        example_ground_motion,
        read_ground_motion,
        read_ground_motions,
        read_record_set,
        synthetic_ground_motions,
    )
    from rocking.response import (
        CorrelationDimension,
        LyapunovSpectrum,
        Peak,
        RotationNumber,
        SpectralDensity,
        classify,
        correlation_dimension,
        impact_section,
        lyapunov,
        rotation_number,
        spectral_density,
    )
    from rocking.survey import (
        basin_map,
        chaos_share,
        fragility,
        incremental_dynamic_analysis,
        overturning_amplitude,
        overturning_set,
        overturning_spectrum,
        parametric_map,
        proved_share,
        repeatability,
        repeatability_map,
        rocking_spectrum,
        safe_basin,
        sensitivity,
    )

__all__ = [
    "Attractor",
    "BasinMap",
    "BifurcationCurve",
    "BifurcationSet",
    "Block",
    "Braces",
    "Branch",
    "Cascade",
    "ChaosShare",
    "CodimensionTwoPoint",
    "CorrelationDimension",
    "Evidence",
    "Fragility",
    "FrequencyResponse",
    "GrazingTransition",
    "GroundMotion",
    "Harmonic",
    "Horseshoe",
    "IncrementalDynamicAnalysis",
    "InputWarning",
    "Kind",
    "LognormalFit",
    "LyapunovSpectrum",
    "Manifold",
    "Mode",
    "Motion",
    "NoOrbit",
    "Orbit",
    "OrbitDiagram",
    "OrbitManifolds",
    "Orbits",
    "Outcome",
    "Overturning",
    "OverturningCurve",
    "OverturningSet",
    "Peak",
    "PiecewiseLinear",
    "Proof",
    "ProvedShare",
    "Pulse",
    "RecordError",
    "RecordFile",
    "RecordSet",
    "Repeatability",
    "RepeatabilityMap",
    "ResponseDiagram",
    "RotationNumber",
    "SaddleManifolds",
    "SafeBasin",
    "Sensitivity",
    "Share",
    "SpecialPoint",
    "SpectralDensity",
    "Stability",
    "State",
    "System",
    "TooManyEvents",
    "TooShort",
    "UncertaintyExponent",
    "Verdict",
    "__version__",
    "basin_map",
    "bifurcation_curve",
    "bifurcation_set",
    "cascade",
    "chaos_share",
    "cite",
    "classify",
    "continue_orbit",
    "correlation_dimension",
    "example_ground_motion",
    "find_orbit",
    "find_orbits",
    "fragility",
    "frequency_response",
    "grazing_transition",
    "horseshoe",
    "impact_section",
    "incremental_dynamic_analysis",
    "lyapunov",
    "manifold_gap",
    "orbit_diagram",
    "orbit_manifolds",
    "overturning_amplitude",
    "overturning_set",
    "overturning_spectrum",
    "parametric_map",
    "plot",
    "prove",
    "proved_share",
    "read_ground_motion",
    "read_ground_motions",
    "read_record_set",
    "repeatability",
    "repeatability_map",
    "response_diagram",
    "rocking_spectrum",
    "rotation_number",
    "saddle_manifolds",
    "safe_basin",
    "sensitivity",
    "simulate",
    "spectral_density",
    "switch_branch",
    "synthetic_ground_motions",
    "tangency_amplitude",
    "theory",
]

_NAMES = (
    ("motion", "Motion simulate"),
    (
        "orbits",
        "BifurcationCurve BifurcationSet Branch Cascade FrequencyResponse Manifold OrbitDiagram OrbitManifolds",
    ),
    (
        "orbits",
        "Orbits ResponseDiagram SaddleManifolds SpecialPoint bifurcation_curve bifurcation_set cascade",
    ),
    (
        "orbits",
        "continue_orbit find_orbit find_orbits frequency_response horseshoe manifold_gap orbit_diagram",
    ),
    ("orbits", "orbit_manifolds response_diagram saddle_manifolds switch_branch tangency_amplitude"),
    ("orbits", "CodimensionTwoPoint GrazingTransition grazing_transition"),
    ("proof", "prove"),
    ("records", "RecordError example_ground_motion read_ground_motion read_ground_motions read_record_set"),
    ("records", "synthetic_ground_motions"),
    ("response", "CorrelationDimension LyapunovSpectrum Peak RotationNumber SpectralDensity classify"),
    ("response", "correlation_dimension impact_section lyapunov rotation_number spectral_density"),
    (
        "survey",
        "basin_map chaos_share fragility incremental_dynamic_analysis overturning_amplitude overturning_set",
    ),
    ("survey", "overturning_spectrum parametric_map proved_share repeatability repeatability_map"),
    ("survey", "rocking_spectrum safe_basin sensitivity"),
)
"""Public names by subpackage. Names that are not listed belong to `model`."""
_ALIAS = {"__version__": "VERSION"}
_SUB_NAMESPACES = ("plot", "theory")


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import_module("rocking.model.notebook_renderers").fill_at_first_use(lambda: import_module("rocking.plot"))
    if name in _SUB_NAMESPACES:
        globals()[name] = import_module(f"rocking.{name}")
    else:
        rooms = {each: room for room, names in _NAMES for each in names.split()}
        found = {each: rooms.get(each, "model") for each in __all__ if each not in _SUB_NAMESPACES}
        names = [each for each, room in found.items() if room == found[name]]
        for each in names:
            globals().setdefault(
                each, getattr(import_module(f"rocking.{found[each]}"), _ALIAS.get(each, each))
            )
        import_module("rocking.model.keywords").explain(globals(), names)
    return globals()[name]


def __dir__() -> list[str]:
    return sorted(__all__)
