"""Frozen, validated values: block, base motion, system, state, verdict, and the results of surveys.

Every subpackage except `kernels` imports this one. It also holds the validation of arguments, the atomic
replacement of files and the images of results in notebooks.
"""

from rocking.model import notebook_renderers
from rocking.model.access_rights import takes_files
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.atomic_files import (
    TILES,
    check_folder,
    check_replaceable,
    check_writable,
    path_of,
    renaming,
    replacing,
    replacing_folder,
    replacing_hdf5,
    resolve_path,
)
from rocking.model.basin_map import Attractor, BasinMap, UncertaintyExponent
from rocking.model.binomial_share import LEVEL, Share, wilson
from rocking.model.block import Block
from rocking.model.block_checks import INERTIA_RATIOS, RECTANGLE, SIZES
from rocking.model.block_formulas import GRAVITY, frequency_parameter, housner_restitution
from rocking.model.citation import cite
from rocking.model.classification import Criterion, Kind
from rocking.model.dataset_attributes import described, named
from rocking.model.forcing import (
    FREQUENCIES,
    MAX_AMPLITUDE,
    MAX_PHASE,
    PERIODS,
    BaseMotion,
    Forcing,
    Harmonic,
)
from rocking.model.formatting import counted, listed, ordinal, percent, percent_with_ends, plus_minus
from rocking.model.fragility import Fragility, LognormalFit, limit_name, runs_of
from rocking.model.ground_motion import GroundMotion
from rocking.model.ground_motion_checks import BASELINES, STEPS
from rocking.model.ground_motion_doubts import pga_doubt, vertical_sentence
from rocking.model.incremental_dynamic_analysis import (
    FRACTILES,
    IncrementalDynamicAnalysis,
    checked_fractions,
)
from rocking.model.input_warning import InputWarning, warn_of_input, warn_of_value
from rocking.model.intensity import INTENSITIES, Intensity, intensity_of
from rocking.model.keywords import explain, similar
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.optional import ExtraMissing, missing_extra, require_extra
from rocking.model.orbit import Orbit, orbit_in_words
from rocking.model.orbit_event import OrbitEvent
from rocking.model.orbit_stability import Stability, stability_of
from rocking.model.outcome import Outcome, Overturning
from rocking.model.overturning_set import SWITCH_ROW, OverturningSet, intervals_of
from rocking.model.piecewise_linear import PiecewiseLinear
from rocking.model.progress import Bar
from rocking.model.proof import Horseshoe, Proof, ProvedShare
from rocking.model.pulse import KINDS, SINES, Pulse
from rocking.model.record_file import RecordFile
from rocking.model.record_set import RecordSet, record_set
from rocking.model.sensitivity import Sensitivity
from rocking.model.short_texts import both_ends, shown, shown_path
from rocking.model.si_units import PHYSICAL, SAME_IN_SI, block_attributes
from rocking.model.start_checks import check_periodic, check_start
from rocking.model.survey_results import (
    ChaosShare,
    OverturningCurve,
    Repeatability,
    RepeatabilityMap,
    SafeBasin,
)
from rocking.model.symmetric_mode import Mode
from rocking.model.system import (
    BRACE_ANGLES,
    CRITICAL_ANGLES,
    MAX_START,
    MODELS,
    NO_BRACES,
    RANGES,
    Braces,
    State,
    System,
    angle_doubt,
    check_below_flat,
    check_between,
    check_constant_restitution,
    quantities,
    system_of,
)
from rocking.model.validation import (
    NoOrbit,
    TooManyEvents,
    TooShort,
    check_progress,
    exactly_one,
    finite,
    instance,
    members,
    one_of,
    pair,
    real,
    reals,
    refusal,
    refuse_if,
    whole,
    within,
)
from rocking.model.verdict import Evidence, Verdict
from rocking.model.version import VERSION
from rocking.model.write_errors import FULL, WriteError, not_written

__all__ = [
    "BASELINES",
    "BRACE_ANGLES",
    "CRITICAL_ANGLES",
    "FRACTILES",
    "FREQUENCIES",
    "FULL",
    "GRAVITY",
    "INERTIA_RATIOS",
    "INTENSITIES",
    "KINDS",
    "LEVEL",
    "MAX_AMPLITUDE",
    "MAX_PHASE",
    "MAX_START",
    "MODELS",
    "NO_BRACES",
    "PERIODS",
    "PHYSICAL",
    "RANGES",
    "RECTANGLE",
    "SAME_IN_SI",
    "SINES",
    "SIZES",
    "STEPS",
    "SWITCH_ROW",
    "TILES",
    "VERSION",
    "Attractor",
    "Bar",
    "BaseMotion",
    "BasinMap",
    "Block",
    "Braces",
    "ChaosShare",
    "Criterion",
    "Evidence",
    "ExtraMissing",
    "Forcing",
    "Fragility",
    "GroundMotion",
    "Harmonic",
    "Horseshoe",
    "IncrementalDynamicAnalysis",
    "InputWarning",
    "Intensity",
    "Kind",
    "LognormalFit",
    "Mode",
    "NoOrbit",
    "NotebookPicture",
    "Orbit",
    "OrbitEvent",
    "Outcome",
    "Overturning",
    "OverturningCurve",
    "OverturningSet",
    "PiecewiseLinear",
    "Proof",
    "ProvedShare",
    "Pulse",
    "ReadOnlyArrays",
    "RecordFile",
    "RecordSet",
    "Repeatability",
    "RepeatabilityMap",
    "SafeBasin",
    "Sensitivity",
    "Share",
    "Stability",
    "State",
    "System",
    "TooManyEvents",
    "TooShort",
    "UncertaintyExponent",
    "Verdict",
    "WriteError",
    "angle_doubt",
    "block_attributes",
    "both_ends",
    "check_below_flat",
    "check_between",
    "check_constant_restitution",
    "check_folder",
    "check_periodic",
    "check_progress",
    "check_replaceable",
    "check_start",
    "check_writable",
    "checked_fractions",
    "cite",
    "counted",
    "described",
    "exactly_one",
    "explain",
    "finite",
    "frequency_parameter",
    "housner_restitution",
    "instance",
    "intensity_of",
    "intervals_of",
    "limit_name",
    "listed",
    "members",
    "missing_extra",
    "named",
    "not_written",
    "notebook_renderers",
    "one_of",
    "orbit_in_words",
    "ordinal",
    "pair",
    "path_of",
    "percent",
    "percent_with_ends",
    "pga_doubt",
    "plus_minus",
    "quantities",
    "read_only",
    "real",
    "reals",
    "record_set",
    "refusal",
    "refuse_if",
    "renaming",
    "replacing",
    "replacing_folder",
    "replacing_hdf5",
    "require_extra",
    "resolve_path",
    "runs_of",
    "shown",
    "shown_path",
    "similar",
    "stability_of",
    "system_of",
    "takes_files",
    "vertical_sentence",
    "warn_of_input",
    "warn_of_value",
    "whole",
    "wilson",
    "within",
]
