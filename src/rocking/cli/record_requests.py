"""From the options of a command to ground motions, a block, and the arguments of the function that uses them."""

from __future__ import annotations

import hashlib
import math
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from rocking.cli.options import LEVELS, InvalidInput, option, refusals
from rocking.cli.requests import (
    Options,
    Request,
    braces_of,
    own_arguments,
    require,
    select,
    start_of,
    values_of,
)
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.model.record_set import RecordSet
from rocking.model.text import formatted_path, listed
from rocking.model.validation import RecordError, refuse_if, within

MIN_PGA, MAX_PGA = 1e-9, 1e5
OMIT = "omit it for the record as it is"
READING = ("units", "step", "baseline")
OF_BASELINE = ("pgv", "pgd", "pgv_ratio")
"""Options of levels that a wrong baseline changes most."""
NAMES = {"pga": "--pga-g", "factor": "--scale"}
"""Arguments in messages → names of options, where these differ."""


def block_in_si(options: Options) -> Block:
    """Return the block of the options in SI; InvalidInput if invalid."""
    require(options, (("height",), ("width",)), "--height and --width")
    with refusals(NAMES):
        return Block(options["height"], options["width"], **select(options, "restitution", "inertia_ratio"))


@contextmanager
def reading(names: Mapping[str, str]) -> Iterator[list[str]]:
    """Convert errors of the reader to `InvalidInput`; its warnings are in the list when the block ends."""
    sentences: list[str] = []
    with refusals(names), warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            yield sentences
        except RecordError as error:
            raise InvalidInput(as_options(str(error))) from error
    sentences += [str(warning.message) for warning in caught]


def as_options(text: str) -> str:
    """Return the message on a file with the arguments that it names as options; the file may be named like one."""
    for words in ("for example ", "do not give ", "; omit ", "one of them as "):
        text = text.replace(words, words + "--")
    return text


# One record.


def record(options: Options) -> Request:
    """Return the request of a motion under a recorded ground motion."""
    block, braces, start = block_in_si(options), braces_of(options), start_of(options)
    ground, sentences = ground_motion(options)
    with refusals(NAMES):
        system = block.system(ground, braces=braces, model=options.get("model", "slender"))
    files = tuple(name for name in ("plot", "animate", "csv", "netcdf") if name in options)
    arguments = {"system": system, "start": start, "cycles": None, "files": files}
    return Request(arguments, options, block, NAMES, sentences, records=ground)


def check_scaling(options: Options) -> None:
    """Raise InvalidInput for both options of `scaling`."""
    if "scale" in options and "pga_g" in options:
        raise InvalidInput("give --scale or --pga-g, not both")


def ground_motion(options: Options) -> tuple[GroundMotion, list[str]]:
    """Return the ground motion of the options, scaled, and the warnings of the reader; InvalidInput if invalid."""
    from rocking.records.read import read_ground_motion

    check_scaling(options)
    with reading(NAMES) as sentences:
        ground = read_ground_motion(options["file"], **select(options, "channel", *READING))
    with refusals(NAMES):
        if "pga_g" in options:
            pga = within("pga_g", options["pga_g"], MIN_PGA, MAX_PGA, "g", if_below=OMIT)
            ground = ground.scaled(pga=GRAVITY * pga)
        elif "scale" in options:
            refuse_if(options["scale"] == 0, "scale", "not be 0", 0, OMIT)
            ground = ground.scaled(options["scale"])
    vertical = vertical_sentence([ground.component]) if ground.vertical else ""
    return ground, [*sentences, *filter(None, (vertical, as_options(ground.drift_doubt)))]


# A set of records.


def record_set(options: Options) -> tuple[RecordSet, list[str]]:
    """Return the records of the command line, and the warnings of the reader; InvalidInput if one cannot be read."""
    from rocking.records.record_set import read_record_set

    sources = options["sources"]
    with reading({"source": "SOURCE"}) as sentences:
        records = read_record_set(
            sources[0] if len(sources) == 1 else list(sources), **select(options, *READING)
        )
    check_no_record(select(options, "plot", "csv", "netcdf"), records)
    return records, sentences


def drift_warnings(records: RecordSet) -> list[str]:
    """Return a warning of the records whose PGV and PGD are those of a drift; none without such a record."""
    sentences = {
        name: as_options(motion.drift_doubt) for name, motion in zip(records.names, records, strict=True)
    }
    first, *others = [name for name, sentence in sentences.items() if sentence] or [""]
    if not first:
        return []
    more = f" (and {len(others)} of the other records: {listed(others)})" if others else ""
    return [f"{first}{more}: {sentences[first]}"]


def check_no_record(files: Mapping[str, Path], records: Sequence[GroundMotion]) -> None:
    """Raise InvalidInput for an output that would overwrite a record, also one that a folder or a table names, or a copy."""
    contents = {motion.file.sha256 for motion in records if motion.file is not None}
    for name, path in files.items():
        if digest(path) in contents:
            raise InvalidInput(f"{option(name)} must not overwrite a record; got {formatted_path(path)}")


def digest(path: Path) -> str | None:
    """Return the SHA-256 digest of a file; None if there is none that can be read."""
    with suppress(OSError), path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
    return None


def scaled_records(options: Options) -> Request:
    """Return the request of a function of records, a block and levels."""
    measures = [name for name in LEVELS if name in options]
    if len(measures) != 1:
        got = " and ".join(map(option, measures)) or "none"
        raise InvalidInput(f"give exactly one of {', '.join(map(option, LEVELS))}; got {got}")
    (measure,) = measures
    block = block_in_si(options)
    records, sentences = record_set(options)
    if measure in OF_BASELINE:
        sentences += drift_warnings(records)
    others = {
        name: value
        for name, value in own_arguments(options).items()
        if name not in (*LEVELS, *READING, "inertia_ratio")
    }
    arguments = {
        "records": records,
        "block": block,
        "levels": values_of(options[measure]),
        "intensity": measure.replace("_", "-"),
        **others,
        **select(options, "model"),
    }
    names = {"records": "SOURCE", "levels": option(measure)}
    return Request(arguments, options, block, names, sentences, records=records)


def overturning_set(options: Options) -> Request:
    """Return the request of an overturning set."""
    request = scaled_records(options)
    request.arguments.update(select(options, "angle"))
    return request


def sensitivity(options: Options) -> Request:
    """Return the request of the sensitivity of verdicts."""
    request = scaled_records(options)
    request.names["block"] = "the block"
    return request


def fragility(options: Options) -> Request:
    """Return the request of a fragility."""
    request = scaled_records(options)
    arguments = request.arguments
    arguments["levels"] = np.atleast_1d(arguments["levels"])
    arguments["limits"] = arguments.pop("limit", ())
    request.names["limits"] = option("limit")
    return request


# Blocks of many sizes.


def spectrum(options: Options) -> Request:
    """Return the request of a rocking spectrum."""
    arguments = {
        name: values_of(value)
        for name, value in select(
            options, "size", "restitution", "inertia_ratio", "model", "repair", "store"
        ).items()
    }
    check_scaling(options)
    if "scale" in options:
        arguments["levels"] = values_of(options["scale"])
    if "pga_g" in options:
        arguments |= {"levels": values_of(options["pga_g"]), "intensity": "pga-g"}
    arguments |= shape(options)
    names = {
        "levels": option("pga_g" if "pga_g" in options else "scale"),
        "slenderness": "--slenderness-deg, in rad,",
        "records": "SOURCE",
    }
    records, sentences = record_set(options)
    if "plot" in options:
        check_plot(arguments, names, len(records))
    return Request(
        {"records": records} | arguments, options, names=names, warnings=sentences, records=records
    )


def shape(options: Options) -> dict[str, Any]:
    """Return size and slenderness of the blocks; InvalidInput if something is missing or given twice."""
    sides = [name for name in ("height", "width") if name in options]
    if sides and "slenderness_deg" in options:
        raise InvalidInput(
            f"give --slenderness-deg or {option(sides[0])}, not both: height and width state the slenderness"
        )
    result = {"size": values_of(options["size"])} if "size" in options else {}
    if "slenderness_deg" in options:
        result["slenderness"] = radians(values_of(options["slenderness_deg"]))
    if len(sides) == 2:
        with refusals():
            block = Block(options["height"], options["width"], 0.5)
        result = {"size": block.radius, "slenderness": block.critical_angle} | result
    missing = [name for name in ("size", "slenderness") if name not in result]
    if missing:
        names = " and ".join({"size": "--size", "slenderness": "--slenderness-deg"}[name] for name in missing)
        raise InvalidInput(f"missing {names}: give --size and --slenderness-deg, or --height and --width")
    return result


def radians(degrees: Any) -> Any:
    """Return a slenderness or an axis in rad; InvalidInput outside its range, in degrees as typed."""
    from rocking.survey.spec import SLENDERNESSES, number_or_axis

    low, high = map(math.degrees, SLENDERNESSES)
    with refusals():
        number_or_axis("--slenderness-deg", degrees, (low, high))
    return np.radians(degrees) if np.ndim(degrees) else math.radians(degrees)


def check_plot(arguments: Mapping[str, Any], names: Mapping[str, str], records: int) -> None:
    """Raise InvalidInput for a spectrum that cannot be drawn, before it is computed."""
    from rocking.plot.rocking_spectra import MOST_SLENDERNESSES

    varied = {name for name, value in arguments.items() if np.ndim(value)}
    for name in ("levels", "restitution"):
        if name in varied:
            raise InvalidInput(
                f"--plot needs one value of {names.get(name, option(name))}; got an axis (give a number)"
            )
    if not varied:
        raise InvalidInput("--plot needs an axis: give --size or --slenderness-deg as START:STOP:COUNT")
    if records > 1 and "size" in varied and np.size(arguments["slenderness"]) > MOST_SLENDERNESSES:
        most = f"at most {MOST_SLENDERNESSES} values of --slenderness-deg"
        raise InvalidInput(f"--plot draws one record, or {most}; got {records} records")
