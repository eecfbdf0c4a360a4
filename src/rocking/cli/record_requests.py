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
from attrs import evolve

from rocking.cli.options import LEVELS, SA_PERIOD, STANDING, InvalidInput, option, refusals
from rocking.cli.requests import (
    LAWS,
    Options,
    Request,
    braces_of,
    check_friction,
    own_arguments,
    require,
    restitution_of,
    select,
    standing_of,
    start_of,
    values_of,
)
from rocking.model.block import Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.changed_motion import same_end
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.model.intensity import PERIODS
from rocking.model.record_set import RecordSet, intensity_of
from rocking.model.stations import turned
from rocking.model.system import State, System
from rocking.model.text import formatted_path, listed
from rocking.model.validation import RecordError, refuse_if, within
from rocking.survey.overturning_rate import hazard_curve

MIN_PGA, MAX_PGA = 1e-9, 1e5
OMIT = "omit it for the record as it is"
READING = ("units", "step", "baseline")
OF_SET = (*READING, "component")
OF_BASELINE = ("pgv", "pgd", "pgv_ratio")
"""Options of levels that a wrong baseline changes most."""
NAMES = {"pga": "--pga-g", "factor": "--scale", "stiffness": "--restrainer-stiffness"}
"""Arguments in messages → names of options, where these differ."""


def block_in_si(options: Options) -> Block:
    """Return the block of the options in SI; InvalidInput if invalid."""
    require(options, (("height",), ("width",)), "--height and --width")
    with refusals(NAMES):
        return Block(
            options["height"],
            options["width"],
            restitution_of(options),
            **select(options, "inertia_ratio"),
            **standing_of(options),
        )


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
    sentences += [as_options(str(warning.message)) for warning in caught]


def as_options(text: str) -> str:
    """Return the message on a file with the arguments that it names as options; the file may be named like one."""
    for words in ("for example ", "do not give ", "; omit ", "one of them as "):
        text = text.replace(words, words + "--")
    return text


# One record.


def record(options: Options) -> Request:
    """Return the request of a motion under a recorded ground motion."""
    block, braces, start = block_in_si(options), braces_of(options), start_of(options)
    check_friction(options)
    ground, sentences = ground_motion(options)
    ground, vertical = with_vertical(ground, options, sentences)
    with refusals({**NAMES, "vertical": "--vertical"}):
        grounds = [ground if sign > 0 else ground.reversed() for sign in directions(options)]
        how = {**select(options, "model", "normalised_by"), "vertical": vertical}
        systems = [block.system(each, braces=braces, **how) for each in grounds]
        place = worse(systems, start)
    system, ground = systems[place], grounds[place]
    counted = ("+", "-")[place] if len(grounds) > 1 else ""
    files = tuple(name for name in ("plot", "animate", "csv", "netcdf", "friction") if name in options)
    arguments = {"system": system, "start": start, "cycles": None, "files": files}
    request = Request(arguments, options, system.block, NAMES, sentences, records=ground, counted=counted)
    return evolve(request, vertical=vertical)


def sliding(options: Options) -> Request:
    """Return the request of the slip of a block under a recorded ground motion."""
    require(options, (("friction",),), "--friction")
    check_friction(options)
    ground, sentences = ground_motion(options)
    arguments = {"ground": ground, "friction": options["friction"]}
    return Request(arguments, options, names=NAMES, warnings=sentences, records=ground)


def directions(options: Options) -> list[float]:
    """Return the polarities of one record, as signs; both for the worse one. InvalidInput for any other polarity."""
    from rocking.survey.spec import WORSE, checked_polarity

    polarity = checked_polarity(options.get("polarity", "+"))
    refuse_if(np.ndim(polarity), "polarity", 'be "+", "-" or "worse" for one record', options.get("polarity"))
    return [1.0, -1.0] if polarity == WORSE else [float(polarity)]


def worse(systems: Sequence[System], start: State) -> int:
    """Return the place of the motion that is worse for the block: it alone overturns, or it has the larger peak."""
    if len(systems) == 1:
        return 0
    from rocking.motion.simulate import simulate

    motions = [simulate(each, start, record="none") for each in systems]
    harm = [(each.overturning is not None, each.peak) for each in motions]
    return harm.index(max(harm))


def check_scaling(options: Options) -> None:
    """Raise InvalidInput for both options of `scaling`."""
    if "scale" in options and "pga_g" in options:
        raise InvalidInput("give --scale or --pga-g, not both")


def check_step(name: str, ground: GroundMotion, other: GroundMotion) -> None:
    """Raise InvalidInput if two components, which the option `name` needs, have different steps."""
    if other.step != ground.step:
        raise InvalidInput(
            f"{option(name)} needs two components with the same step; got {ground.step:g} s and {other.step:g} s (resample one of "
            f"them in Python, by .resampled({min(ground.step, other.step):g}))"
        )


def ground_motion(options: Options) -> tuple[GroundMotion, list[str]]:
    """Return the ground motion of the options, scaled, and the warnings of the reader; InvalidInput if invalid."""
    from rocking.records.read import read_ground_motion

    check_scaling(options)
    check_direction(options)
    with reading(NAMES) as sentences:
        ground = read_ground_motion(options["file"], **select(options, "channel", *READING))
        other = None
        if "azimuth_deg" in options:
            refuse_vertical(ground, options)
            other = other_component(options)
            check_step("azimuth_deg", ground, other)
            ground, other = same_end(ground, other, sentences)
    floor = {"period": "--floor-period", "damping": "--floor-damping"}
    with refusals({**NAMES, **floor, "other": "the other component"}):
        if other is not None:
            turn = within("azimuth_deg", options["azimuth_deg"], -360, 360, "°")
            ground = turned(ground, other, math.radians(turn))
        if "pga_g" in options:
            pga = within("pga_g", options["pga_g"], MIN_PGA, MAX_PGA, "g", if_below=OMIT)
            refuse_if(ground.pga == 0, "pga_g", "be omitted for a record whose samples are all 0", pga)
            ground = ground.scaled(pga=GRAVITY * pga)
        elif "scale" in options:
            refuse_if(options["scale"] == 0, "scale", "not be 0", 0, OMIT)
            ground = ground.scaled(options["scale"])
        if "floor_period" in options:
            damping = {"damping": options["floor_damping"]} if "floor_damping" in options else {}
            ground = ground.floor(options["floor_period"], **damping)
    vertical = vertical_sentence([ground.component]) if ground.vertical else ""
    return ground, [*sentences, *filter(None, (vertical, as_options(ground.drift_doubt)))]


def with_vertical(
    ground: GroundMotion, options: Options, sentences: list[str]
) -> tuple[GroundMotion, GroundMotion | None]:
    """Return the horizontal ground motion, and the vertical one of the options, times the same factor; None without the option.

    Both end with the shorter one, which a sentence then states. InvalidInput if the file has not one vertical channel, or one
    channel only.
    """
    if "vertical" not in options:
        return ground, None
    if "floor_period" in options:
        raise InvalidInput("give --vertical or --floor-period, not both: a floor moves horizontally")
    from rocking.records.read import read_ground_motions

    with reading({**NAMES, "source": "--vertical"}) as more:
        motions = read_ground_motions(options["vertical"], **select(options, *READING))
    sentences += [each for each in more if each not in sentences]
    found = [each for each in motions if each.vertical or len(motions) == 1]
    if len(found) != 1:
        raise InvalidInput(
            f"--vertical needs a file with one vertical channel, or with one channel; got {len(found)} of {len(motions)} channels"
        )
    if found[0].component and not found[0].vertical:
        sentences.append(
            f"the component {found[0].component} does not say that it is vertical: --vertical takes it as vertical"
        )
    up = found[0].scaled(ground.factor)
    check_step("vertical", ground, up)
    return same_end(ground, up, sentences)


def check_direction(options: Options) -> None:
    """Raise InvalidInput for options of a second component or a floor without the one that uses them."""
    for name, needed in (("second", "azimuth_deg"), ("floor_damping", "floor_period")):
        if name in options and needed not in options:
            raise InvalidInput(f"{option(name)} needs {option(needed)}")


def refuse_vertical(ground: GroundMotion, options: Options) -> None:
    """Raise InvalidInput for a vertical component that is to be turned."""
    if ground.vertical:
        which = f"channel {options.get('channel', 1)} of the file"
        raise InvalidInput(
            f"--azimuth-deg needs a horizontal component; {which}, {ground.component!r}, is vertical (give another --channel)"
        )


def other_component(options: Options) -> GroundMotion:
    """Return the component towards which `--azimuth-deg` turns; InvalidInput if the file has not two horizontal ones."""
    from rocking.records.read import read_ground_motion, read_ground_motions

    reading_so = select(options, *READING)
    if "second" in options:
        return read_ground_motion(options["second"], **reading_so)
    motions = read_ground_motions(options["file"], **reading_so)
    others = [
        each
        for number, each in enumerate(motions, 1)
        if number != options.get("channel", 1) and not each.vertical
    ]
    if len(others) != 1:
        raise InvalidInput(
            f"--azimuth-deg needs one other horizontal channel; the file has {len(others)} (give --second)"
        )
    return others[0]


# A set of records.


def record_set(options: Options) -> tuple[RecordSet, list[str]]:
    """Return the records of the command line, and the warnings of the reader; InvalidInput if one cannot be read."""
    from rocking.records.record_set import read_record_set

    sources = options["sources"]
    with reading({"source": "SOURCE"}) as sentences:
        records = read_record_set(
            sources[0] if len(sources) == 1 else list(sources), **select(options, *OF_SET)
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
    intensity = measure_of(measure, options)
    block = block_in_si(options)
    records, sentences = record_set(options)
    if measure in OF_BASELINE:
        sentences += drift_warnings(records)
    others = {
        name: value
        for name, value in own_arguments(options).items()
        if name not in (*LEVELS, SA_PERIOD, *OF_SET, *STANDING, "inertia_ratio")
    }
    arguments = {
        "records": records,
        "block": block,
        "levels": values_of(options[measure]),
        "intensity": intensity,
        **others,
        **select(options, "model", "normalised_by"),
    }
    names = {"records": "SOURCE", "levels": option(measure)}
    return Request(arguments, options, block, names, sentences, records=records)


def incremental_dynamic_analysis(options: Options) -> Request:
    """Return the request of an incremental dynamic analysis."""
    return overturning_set(options)


def measure_of(name: str, options: Options) -> str:
    """Return the intensity measure of an option of the levels; InvalidInput if --sa-period stands without --sa, or --sa without it."""
    if (name == "sa") != (SA_PERIOD in options):
        got, missing = ("--sa", "--sa-period") if name == "sa" else ("--sa-period", "--sa")
        raise InvalidInput(f"{got} needs {missing}, too")
    if name != "sa":
        return name.replace("_", "-")
    with refusals():
        return f"sa({within('--sa-period', options[SA_PERIOD], *PERIODS, 's'):.15g})"


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
    if "hazard" in options:
        measure, _ = intensity_of(arguments["intensity"], request.records)
        with refusals():
            return evolve(request, hazard=hazard_curve(options["hazard"], measure.unit))
    return request


# Blocks of many sizes.


def spectrum(options: Options) -> Request:
    """Return the request of a rocking spectrum."""
    arguments = {
        name: values_of(value)
        for name, value in select(
            options,
            *("size", "restitution", "inertia_ratio", "polarity", "model", "normalised_by"),
            *("repair", "store"),
        ).items()
    }
    of_one_block = [name for name in (*LAWS, *STANDING) if name in options]
    if of_one_block and not isinstance(options.get("restitution", 0.0), int | float):
        raise InvalidInput(f"--restitution must be a number with {option(of_one_block[0])}; got an axis")
    if any(name in options for name in LAWS):
        arguments["restitution"] = restitution_of(options)
    check_scaling(options)
    if "scale" in options:
        arguments["levels"] = values_of(options["scale"])
    if "pga_g" in options:
        arguments |= {"levels": values_of(options["pga_g"]), "intensity": "pga-g"}
    arguments |= shape(options)
    if "block" in arguments:  # it has them
        arguments = {
            name: arguments[name] for name in arguments if name not in ("restitution", "inertia_ratio")
        }
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
    """Return size and slenderness of the blocks, or a block with a mass centre; InvalidInput for something missing or given twice."""
    sides = [name for name in ("height", "width") if name in options]
    if sides and "slenderness_deg" in options:
        raise InvalidInput(
            f"give --slenderness-deg or {option(sides[0])}, not both: height and width state the slenderness"
        )
    result = {"size": values_of(options["size"])} if "size" in options else {}
    if "slenderness_deg" in options:
        result["slenderness"] = radians(values_of(options["slenderness_deg"]))
    if select(options, *STANDING):
        return {"block": block_in_si(options)} | result
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
    if records > 1 and "size" in varied and np.size(arguments.get("slenderness", 0.0)) > MOST_SLENDERNESSES:
        most = f"at most {MOST_SLENDERNESSES} values of --slenderness-deg"
        raise InvalidInput(f"--plot draws one record, or {most}; got {records} records")
