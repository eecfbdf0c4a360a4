"""Computation of basins from options and a study file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.input import study_file, survey_quantities
from rocking.cli.input.axis import Axis
from rocking.cli.input.options import question as system_of
from rocking.cli.option_names import COUNTS, START, SYSTEM
from rocking.cli.output.files import SUFFIXES
from rocking.cli.output.survey_run import carried_out

if TYPE_CHECKING:
    from rocking.model.block import Block
    from rocking.model.survey_results import BasinMap

DEFAULT_STARTS = 200
"""Number of initial states along an axis from -1 to 1, or from brace to brace."""


def question(typed: Mapping[str, Any], file: Path | None) -> dict[str, Any]:
    """Return the arguments given by options and study file; options take precedence."""
    from rocking.model.validation import within
    from rocking.survey.uncertainty_exponent import WIDTHS as BOUNDARY_WIDTHS

    checks: dict[str, Callable[[Any], Any]] = {
        **survey_quantities.fixed(*SYSTEM),
        "model": study_file.model,
        **survey_quantities.varying(*START),
        **survey_quantities.counts("samples", "seed", *COUNTS, "boundary_runs"),
        "boundary_width": partial(within, "boundary_width", low=BOUNDARY_WIDTHS[0], high=BOUNDARY_WIDTHS[1]),
        **survey_quantities.path_checks("store", *SUFFIXES),
    }
    given = study_file.asked(typed, file, checks)
    survey_quantities.require_axes(given, *START)
    return given


def compute(given: Mapping[str, Any]) -> tuple[BasinMap, Block | None]:
    """Compute the basins; return them with the block if they are in SI."""
    from rocking.survey.basins import basin_map

    asked = {name: each for name, each in given.items() if name not in SUFFIXES}
    system, _, block = system_of({name: asked.pop(name) for name in (*SYSTEM, "model") if name in asked})
    reach = 1.0 if system.braces is None else min(system.braces.angle, 1.0)
    usual = {"angle": Axis(-reach, reach, DEFAULT_STARTS), "velocity": Axis(-1.0, 1.0, DEFAULT_STARTS)}
    for name, axis in usual.items():
        asked[name] = _starts(asked.get(name, axis), random="samples" in asked)
    return carried_out(basin_map, {"system": system} | asked, block), block


def _starts(asked: Any, *, random: bool) -> Any:
    """Return the initial values along an axis of a grid, or the ends of the axis for random initial states."""
    return (
        [asked.start, asked.stop] if random and isinstance(asked, Axis) else survey_quantities.values(asked)
    )
