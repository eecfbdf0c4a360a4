"""Frequency response from options, one of which is an axis of the period or the frequency."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from rocking.cli.input.axis import VARIES, Axis
from rocking.cli.input.options import NORMALISED_NEEDS, kinds, question, require
from rocking.cli.option_names import computing, option, options

if TYPE_CHECKING:
    import numpy as np

    from rocking.model.block import Block
    from rocking.model.system import System
    from rocking.orbits.frequency_response import FrequencyResponse

DEFAULT_MODES = (1, 3)
WORDS = {"modes must": "--modes must", "theory.symmetric_modes": "rocking modes"}
"""Words in messages of `frequency_response` → words on the command line."""
# The displacement is absent: its amplitude of acceleration would vary with the frequency.
NORMALISED = ("amplitude",), ("period", "frequency"), ("restitution",)
SI = ("height",), ("width",), ("acceleration", "acceleration_g"), ("frequency_hz", "period_s")
SI_NEEDS = "--height, --width, --acceleration (or --acceleration-g) and --frequency-hz (or --period-s)"


class Study(NamedTuple):
    """Frequency response to compute: a system at the first value, and the values of its period or frequency."""

    system: System
    block: Block | None
    parameter: str
    values: np.ndarray
    names: dict[str, str]  # argument → option
    typed: str


def study(given: Mapping[str, Any]) -> Study:
    """Return the study described by the options; YourInput unless period or frequency is given once."""
    import numpy as np

    in_si = bool(kinds(given)[1])
    require(
        given, SI if in_si else NORMALISED, SI_NEEDS if in_si else f"{NORMALISED_NEEDS}, or in SI {SI_NEEDS}"
    )
    axes = {name: value for name, value in given.items() if isinstance(value, Axis)}
    system, _, block = question({**given, **{name: axis.start for name, axis in axes.items()}})
    last, _, _ = question({**given, **{name: axis.stop for name, axis in axes.items()}})
    ((name, axis),) = axes.items()
    parameter = VARIES.get(name, name)
    first, final = (getattr(one.forcing, parameter) for one in (system, last))
    # Each SI quantity is proportional to the normalised one.
    amplitude = next(each for each in ("amplitude", *SI[2]) if given[each] is not None)
    return Study(
        system,
        block,
        parameter,
        np.linspace(first, final, axis.points),
        {parameter: option(name), "amplitude": option(amplitude)},
        f"{option(name)} {axis.start:.6g} to {axis.stop:.6g} ({axis.points:,} values)",
    )


def compute(study: Study, modes: Sequence[int] | None, step: float, max_cycles: int) -> FrequencyResponse:
    """Compute the frequency response; YourInput if an argument is invalid."""
    from rocking.orbits.frequency_response import frequency_response

    with computing(study.names | WORDS | options("restitution", "step", "max_cycles")):
        return frequency_response(
            **{study.parameter: study.values},
            amplitude=study.system.periodic.amplitude,
            restitution=study.system.restitution,
            modes=modes or DEFAULT_MODES,
            step=step,
            max_cycles=max_cycles,
        )
