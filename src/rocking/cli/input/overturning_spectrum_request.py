"""Computation of an overturning spectrum of pulses from options and a study file."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.input import study_file, survey_quantities
from rocking.cli.input.options import kinds, require
from rocking.cli.input.survey_quantities import Question
from rocking.cli.option_names import YourInput, option
from rocking.cli.output.files import SUFFIXES
from rocking.cli.output.survey_run import carried_out
from rocking.model.validation import instance

if TYPE_CHECKING:
    import xarray as xr

NORMALISED = ("amplitude", "frequency")
IN_SI = ("acceleration", "acceleration_g", "frequency_hz")
SIZE = ("height", "width")
PLACES = ("store", *SUFFIXES)
NEEDS = "--amplitude, --frequency and --restitution"
SI_NEEDS = "--height, --width, --acceleration (or --acceleration-g) and --frequency-hz"


def question(typed: Mapping[str, Any], file: Path | None) -> Question:
    """Return the request given by options and study file; options take precedence."""
    checks: dict[str, study_file.Check] = {
        "pulse": partial(instance, "pulse", kind=str),
        "model": study_file.model,
        **survey_quantities.varying(*NORMALISED, "restitution", "critical_angle", *SIZE, *IN_SI),
        **survey_quantities.path_checks(*PLACES),
    }
    given = study_file.asked(typed, file, checks)
    places = {name: given.pop(name) for name in PLACES if name in given}
    more = {name: given.pop(name) for name in ("repair",) if name in given}
    require(given, (("pulse",),), "the form of the pulse, such as --pulse one-sine")
    pulse = given.pop("pulse")
    _check_axes(given)
    for name in ("restitution", "critical_angle"):
        if "plot" in places and not isinstance(given.get(name, 0.0), int | float):
            raise YourInput(f"--plot needs one value of {option(name)}; got an axis (give a number)")
    numbers = survey_quantities.normalised(given)
    names = (*NORMALISED, "restitution", "critical_angle")
    arguments = {name: numbers[name] for name in names if name in numbers}
    return Question({"kind": pulse} | more | arguments, places, survey_quantities.block_of(given))


def _check_axes(given: Mapping[str, Any]) -> None:
    """Raise YourInput if a quantity is missing, or if an amplitude or a frequency is a number."""
    _, physical = kinds(given)
    if physical:
        require(given, (("height",), ("width",), IN_SI[:2], IN_SI[2:]), SI_NEEDS)
        if "acceleration" in given and "acceleration_g" in given:
            raise YourInput("give --acceleration or --acceleration-g, not both")
    else:
        require(given, (("amplitude",), ("frequency",), ("restitution",)), NEEDS)
    survey_quantities.require_axes(given, *NORMALISED, *IN_SI)


def compute(asked: Question) -> xr.Dataset:
    """Compute the spectrum."""
    from rocking.survey.spectra import overturning_spectrum

    arguments = asked.arguments | {"store": asked.places.get("store")}
    return carried_out(overturning_spectrum, arguments, asked.block)
