"""Options of `rocking record`, and their conversion to a block, an initial state and a ground motion."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.option_names import START, YourInput, option, options, your_input

if TYPE_CHECKING:
    from rocking.model.block import Block
    from rocking.model.ground_motion import GroundMotion
    from rocking.model.system import Braces, State

EXAMPLE = "example"
MIN_PGA, MAX_PGA = 1e-9, 1e5
OMIT = "omit it for the record as it is"
ARGUMENTS = options(
    "height",
    "width",
    "restitution",
    "inertia_ratio",
    *START,
    "channel",
    "units",
    "step",
    "baseline",
    "scale",
    "pga_g",
    "model",
) | {"pga": option("pga_g"), "factor": option("scale")}


def record_path(text: str) -> Path:
    """Return the path of a record file; `example` stands for that of the package."""
    if not text:
        raise typer.BadParameter("must be the path of a file; got ''")
    if text == EXAMPLE:
        from rocking.records.read import FILE as EXAMPLE_FILE

        return EXAMPLE_FILE
    return Path(text)


def block_and_start(given: Mapping[str, Any]) -> tuple[Block, Braces | None, State]:
    """Return the block, its braces and the initial state of the options; YourInput if invalid."""
    from rocking.model.system import MAX_START, State
    from rocking.model.validation import within

    block, braces = block_of(given), ask.braces(given)
    with your_input(ARGUMENTS):
        return block, braces, State(*(within(name, given[name], -MAX_START, MAX_START) for name in START))


def block_of(given: Mapping[str, Any]) -> Block:
    """Return the block of the options in SI; YourInput if invalid."""
    from rocking.model.block import Block

    ask.require(given, (("height",), ("width",)), "--height and --width")
    more = {name: given[name] for name in ("restitution", "inertia_ratio") if given.get(name) is not None}
    with your_input(ARGUMENTS):
        return Block(given["height"], given["width"], **more)


def ground_motion(given: Mapping[str, Any]) -> tuple[GroundMotion, list[str]]:
    """Return the ground motion of the options, scaled, and the warnings of the reader; YourInput if invalid."""
    from rocking.model.block_formulas import GRAVITY
    from rocking.model.ground_motion import vertical_sentence
    from rocking.model.validation import refuse_if, within
    from rocking.records.read import read_ground_motion
    from rocking.records.text_file import RecordError

    if given["scale"] is not None and given["pga_g"] is not None:
        raise YourInput("give --scale or --pga-g, not both")
    reading = {name: given[name] for name in ("channel", "units", "step")}
    reading["baseline"] = "none" if given["baseline"] is None else given["baseline"]
    with your_input(ARGUMENTS), warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        try:
            ground = read_ground_motion(given["file"], **reading)
        except RecordError as error:
            raise YourInput(as_options(str(error))) from error
    with your_input(ARGUMENTS):
        if given["pga_g"] is not None:
            ground = ground.scaled(
                pga=GRAVITY * within("pga_g", given["pga_g"], MIN_PGA, MAX_PGA, "g", if_below=OMIT)
            )
        elif given["scale"] is not None:
            refuse_if(given["scale"] == 0, "scale", "not be 0", 0, OMIT)
            ground = ground.scaled(given["scale"])
    vertical = vertical_sentence([ground.component]) if ground.vertical else ""
    more = filter(None, (vertical, as_options(ground.drift_doubt)))
    return ground, [*(str(doubt.message) for doubt in doubts), *more]


def as_options(text: str) -> str:
    """Return the message on a file with the arguments that it names as options; the file may be named like one."""
    for said in ("for example ", "do not give ", "; omit ", "one of them as "):
        text = text.replace(said, said + "--")
    return text
