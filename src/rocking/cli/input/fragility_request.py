"""Options of `rocking fragility`, and their conversion to records, a block and levels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rocking.cli.input import record_source
from rocking.cli.input.axis import Axis
from rocking.cli.input.options import require
from rocking.cli.input.record_request import ARGUMENTS as RECORD_ARGUMENTS
from rocking.cli.option_names import AXIS_FORM, YourInput, option, options, your_input

if TYPE_CHECKING:
    from rocking.model import Block, Fragility

SPREADS = ("height_spread", "width_spread", "restitution_spread")
OWN = ("samples", "replicates", "seed", *SPREADS)
READING = ("units", "step", "baseline")
# On the command line the records are sources, and an array is typed as an axis.
ARGUMENTS = (
    RECORD_ARGUMENTS
    | options(*OWN)
    | {"records": "SOURCE", "levels": option("pga_g"), "limits": option("limit")}
    | {"limit": option("limit")}
)


def compute(given: Mapping[str, Any]) -> tuple[Fragility, list[str]]:
    """Compute the fragility of the options; return it with the warnings of the readers; YourInput if invalid."""
    import sys

    import numpy as np

    from rocking.survey import fragility

    block = _block(given)
    levels = given["pga_g"]
    if not isinstance(levels, Axis):
        found = "nothing" if levels is None else f"{levels:g}"
        raise YourInput(f"{option('pga_g')} must be an axis, {AXIS_FORM}; got {found} (example: 0.1:1.5:15)")
    records, doubts = record_source.record_set(given["sources"], **{name: given[name] for name in READING})
    with your_input(ARGUMENTS):
        return fragility(
            records,
            block,
            np.linspace(levels.start, levels.stop, levels.points),
            intensity="pga-g",
            limits=given["limit"] or (),
            progress=sys.stderr.isatty(),
            **{name: given[name] for name in OWN if given.get(name) is not None},
        ), doubts


def _block(given: Mapping[str, Any]) -> Block:
    from rocking.model import Block

    require(given, (("height",), ("width",)), "--height and --width")
    with your_input(ARGUMENTS):
        return Block(given["height"], given["width"], given["restitution"])
