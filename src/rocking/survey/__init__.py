"""Surveys: one question asked at every point of a grid, on all cores or a cluster, in memory or in a store."""

from rocking.model import percent
from rocking.survey import notebook
from rocking.survey.axes import check_quantity
from rocking.survey.basins import basin_map
from rocking.survey.chaos import chaos_share
from rocking.survey.export import counts, tables, to_netcdf
from rocking.survey.maps import MOST_CYCLES, MOST_PERIOD, parametric_map
from rocking.survey.overturning import overturning_amplitude
from rocking.survey.repeatability import repeatability, repeatability_map
from rocking.survey.safe import safe_basin

__all__ = [
    "MOST_CYCLES",
    "MOST_PERIOD",
    "basin_map",
    "chaos_share",
    "check_quantity",
    "counts",
    "overturning_amplitude",
    "parametric_map",
    "percent",
    "repeatability",
    "repeatability_map",
    "safe_basin",
    "tables",
    "to_netcdf",
]

notebook.register()
