"""Computation of the lowest overturning amplitudes from options and a study file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.input import study_file, survey_quantities
from rocking.cli.input.axis import Axis
from rocking.cli.input.options import kinds, require
from rocking.cli.option_names import AXIS_FORM, COUNTS, SI, YourInput, option
from rocking.cli.output.files import SUFFIXES
from rocking.cli.output.survey_run import carried_out

if TYPE_CHECKING:
    from rocking.model.block import Block
    from rocking.model.survey_results import OverturningCurve

SCANNED_SI = tuple(name for name in SI if name != "displacement")
"""SI options except the displacement, whose acceleration depends on the frequency."""
LEVELS = ("acceleration", "acceleration_g")
ASKED = ("period", "frequency", "restitution", "amplitude", "critical_angle")


def question(typed: Mapping[str, Any], file: Path | None) -> dict[str, Any]:
    """Return the arguments given by options and study file; options take precedence."""
    checks = {
        **survey_quantities.varying(*ASKED, *SCANNED_SI),
        "model": study_file.model,
        **survey_quantities.counts("phases", *COUNTS),
        **survey_quantities.path_checks("store", *SUFFIXES),
    }
    given = study_file.asked(typed, file, checks)
    survey_quantities.require_axes(given, "amplitude", *LEVELS)
    _, physical = kinds(given)
    if physical:
        needs = "--height, --width and --frequency-hz (or --period-s)"
        require(given, (("height",), ("width",), SI[5:]), needs)
    else:
        needs = "--period (or --frequency) and --restitution"
        require(given, (("period", "frequency"), ("restitution",)), needs)
    varied = [
        name
        for name, each in given.items()
        if name in (*ASKED, *SCANNED_SI)
        and name not in ("amplitude", *LEVELS)
        and not isinstance(each, int | float)
    ]
    if "plot" in given and len(varied) > 1:
        raise YourInput(
            f"--plot needs a single axis; got {' and '.join(map(option, varied))} (give one of them as a number)"
        )
    return given


def compute(given: Mapping[str, Any]) -> tuple[OverturningCurve, Block | None]:
    """Compute the curve; return it with the block if it is in SI."""
    from rocking.survey.overturning_amplitude import overturning_amplitude

    shaken = {name: each for name, each in given.items() if name in (*ASKED, *SCANNED_SI, "model")}
    others = {name: each for name, each in given.items() if name not in (*shaken, *SUFFIXES)}
    if shaken.keys() & set(SCANNED_SI):
        asked = _normalised(shaken)
    else:
        asked = {name: survey_quantities.values(each) for name, each in shaken.items()}
    block = survey_quantities.block_of(given)
    return carried_out(overturning_amplitude, asked | others, block), block


def _normalised(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the normalised arguments of a request in SI, without amplitude if no acceleration is given."""
    levels = [name for name in LEVELS if name in given]
    for name in levels:
        if not isinstance(given[name], Axis):
            raise YourInput(f"{option(name)} must be an axis to scan, {AXIS_FORM}; got {given[name]}")
    asked = survey_quantities.normalised(given if levels else {**given, "acceleration": 0.0})
    return {name: asked[name] for name in ASKED if name in asked and (levels or name != "amplitude")}
