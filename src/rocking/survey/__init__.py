"""Surveys: one question asked at every point of a grid, on all cores or a cluster, in memory or in a store."""

from rocking.survey import notebook
from rocking.survey.attractors import alike, lead
from rocking.survey.axes import check_quantity
from rocking.survey.basins import basin_map
from rocking.survey.chaos import chaos_share
from rocking.survey.export import counts, tables, to_netcdf
from rocking.survey.maps import parametric_map
from rocking.survey.overturning import MOST_PHASES, overturning_amplitude
from rocking.survey.repeatability import repeatability
from rocking.survey.repeatability_map import repeatability_map
from rocking.survey.responses import respond
from rocking.survey.run import cores
from rocking.survey.safe import safe_basin
from rocking.survey.samples import MOST_SAMPLES, MOST_SEED

__all__ = [
    "MOST_PHASES",
    "MOST_SAMPLES",
    "MOST_SEED",
    "alike",
    "basin_map",
    "chaos_share",
    "check_quantity",
    "cores",
    "counts",
    "lead",
    "overturning_amplitude",
    "parametric_map",
    "repeatability",
    "repeatability_map",
    "respond",
    "safe_basin",
    "tables",
    "to_netcdf",
]

notebook.register()
