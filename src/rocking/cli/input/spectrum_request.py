"""Computation of a rocking spectrum from options and a study file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import frozen

from rocking.cli.input import record_source, study_file, survey_quantities
from rocking.cli.option_names import AXIS_FORM, YourInput, option, options, your_input
from rocking.cli.output.files import SUFFIXES
from rocking.cli.output.survey_run import carried_out
from rocking.model.block import Block
from rocking.model.record_set import RecordSet

if TYPE_CHECKING:
    import xarray as xr

VARYING = ("size", "slenderness_deg", "restitution", "scale", "pga_g")
FIXED = ("height", "width", "inertia_ratio")
PLACES = ("store", *SUFFIXES)
WORDS = {
    "slenderness": "--slenderness-deg, in rad,",
    "angle": "angle",  # no option of this command
    "an array": f"an axis, {AXIS_FORM},",
    "rk.simulate": "rocking record",
}
"""Words of messages by those on the command line."""


@frozen
class Question:
    """Request of a spectrum: arguments of `rocking_spectrum`, records with warnings, output paths, names in messages."""

    arguments: dict[str, Any]
    sources: list[Path]
    records: RecordSet
    doubts: list[str]
    places: dict[str, Path]
    typed: dict[str, str]


def question(typed: Mapping[str, Any], file: Path | None) -> Question:
    """Return the request given by options and study file; options take precedence."""
    checks: dict[str, study_file.Check] = {
        **{name: partial(study_file.quantity, name) for name in VARYING},
        **study_file.numbers(*FIXED),
        **record_source.checks(),
        **survey_quantities.path_checks("store", *SUFFIXES),
    }
    given = study_file.asked(typed, file, checks)
    places = {name: given.pop(name) for name in PLACES if name in given}
    reading = {name: given.pop(name) for name in record_source.READING if name in given}
    arguments, names = _arguments(given)
    records, doubts = record_source.record_set(typed["sources"], **reading)
    asked = Question(arguments, typed["sources"], records, doubts, places, names)
    if "plot" in places:
        _check_plot(asked)
    return asked


def _arguments(given: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, str]]:
    """Return the arguments of `rocking_spectrum`, and the names of these arguments in messages."""
    values = {name: survey_quantities.values(each) for name, each in given.items()}
    names = options("size", "restitution", "inertia_ratio", "height", "width", "model") | WORDS
    if "scale" in values and "pga_g" in values:
        raise YourInput("give --scale or --pga-g, not both")
    asked: dict[str, Any] = {
        name: values[name]
        for name in ("size", "restitution", "inertia_ratio", "scale", "model", "repair")
        if name in values
    }
    if "pga_g" in values:
        asked |= {"scale": values["pga_g"], "intensity": "pga-g"}
    names["scale"] = option("pga_g" if "pga_g" in values else "scale")
    if "slenderness_deg" in values:
        asked["slenderness"] = _radians(values["slenderness_deg"])
    _add_shape(asked, values)
    return asked, names


def _radians(degrees: Any) -> Any:
    """Return a slenderness or an axis in rad; YourInput outside its range, in degrees as typed."""
    import numpy as np

    from rocking.survey.spec import SLENDERNESSES, number_or_axis

    low, high = map(math.degrees, SLENDERNESSES)
    with your_input():
        number_or_axis("--slenderness-deg", degrees, (low, high))
    return np.radians(degrees) if np.ndim(degrees) else math.radians(degrees)


def _add_shape(asked: dict[str, Any], values: Mapping[str, Any]) -> None:
    """Add size and slenderness of the block, where they are not given; YourInput if something is missing or given twice."""
    shape = [name for name in ("height", "width") if name in values]
    if shape and "slenderness" in asked:
        raise YourInput(
            f"give --slenderness-deg or {option(shape[0])}, not both: height and width state the slenderness"
        )
    if len(shape) == 2:
        with your_input(options(*shape)):
            block = Block(values["height"], values["width"], 0.5)
        asked["slenderness"] = block.critical_angle
        asked.setdefault("size", block.radius)
    missing = [name for name in ("size", "slenderness") if name not in asked]
    if missing:
        names = " and ".join({"size": "--size", "slenderness": "--slenderness-deg"}[name] for name in missing)
        raise YourInput(f"missing {names}: give --size and --slenderness-deg, or --height and --width")


def _check_plot(asked: Question) -> None:
    """Raise YourInput for a spectrum that cannot be drawn, before it is computed."""
    import numpy as np

    from rocking.plot.rocking_spectra import MOST_SLENDERNESSES

    varied = {name for name, value in asked.arguments.items() if np.ndim(value)}
    for name in ("scale", "restitution"):
        if name in varied:
            raise YourInput(f"--plot needs one value of {asked.typed[name]}; got an axis (give a number)")
    if not varied:
        raise YourInput("--plot needs an axis: give --size or --slenderness-deg as START:STOP:COUNT")
    if (
        len(asked.records) > 1
        and "size" in varied
        and np.size(asked.arguments["slenderness"]) > MOST_SLENDERNESSES
    ):
        most = f"at most {MOST_SLENDERNESSES} values of --slenderness-deg"
        raise YourInput(f"--plot draws one record, or {most}; got {len(asked.records)} records")


def compute(asked: Question) -> xr.Dataset:
    """Compute the spectrum."""
    from rocking.survey.spectra import rocking_spectrum

    arguments = {"records": asked.records, "store": asked.places.get("store")} | asked.arguments
    return carried_out(rocking_spectrum, arguments, typed=asked.typed)
