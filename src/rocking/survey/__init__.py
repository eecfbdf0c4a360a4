"""Surveys: responses at the points of a grid or sample, on all cores or a cluster, in memory or in a store."""

from rocking.survey import notebook
from rocking.survey.basin_boundaries import WIDTHS as BOUNDARY_WIDTHS
from rocking.survey.basin_map import basin_map
from rocking.survey.chaos_share import chaos_share
from rocking.survey.engine.tile_loop import cores
from rocking.survey.fragility import fragility
from rocking.survey.harmonic_spec import check_quantity, question
from rocking.survey.incremental_dynamic_analysis import incremental_dynamic_analysis
from rocking.survey.measures.attractors import alike, classify_with_anchor
from rocking.survey.measures.block_endings import BlockEndings
from rocking.survey.measures.response import classify_points
from rocking.survey.motion_spec import SLENDERNESSES
from rocking.survey.overturning_amplitude import MAX_PHASES, overturning_amplitude
from rocking.survey.overturning_set import overturning_set
from rocking.survey.overturning_spectrum import overturning_spectrum
from rocking.survey.parametric_map import parametric_map
from rocking.survey.proved_share import proved_share
from rocking.survey.repeatability import repeatability
from rocking.survey.repeatability_map import repeatability_map
from rocking.survey.rocking_spectrum import rocking_spectrum
from rocking.survey.safe_basin import safe_basin
from rocking.survey.sampling.random_points import MAX_SAMPLES, MAX_SEED
from rocking.survey.sensitivity import sensitivity
from rocking.survey.spec import number_or_axis
from rocking.survey.store.export import counts, tables, to_netcdf

__all__ = [
    "BOUNDARY_WIDTHS",
    "MAX_PHASES",
    "MAX_SAMPLES",
    "MAX_SEED",
    "SLENDERNESSES",
    "BlockEndings",
    "alike",
    "basin_map",
    "chaos_share",
    "check_quantity",
    "classify_points",
    "classify_with_anchor",
    "cores",
    "counts",
    "fragility",
    "incremental_dynamic_analysis",
    "number_or_axis",
    "overturning_amplitude",
    "overturning_set",
    "overturning_spectrum",
    "parametric_map",
    "proved_share",
    "question",
    "repeatability",
    "repeatability_map",
    "rocking_spectrum",
    "safe_basin",
    "sensitivity",
    "tables",
    "to_netcdf",
]

notebook.register()
