"""Computation of an orbit diagram from options, one of which is an axis."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from rocking.cli.input.axis import VARIES, Axis, check_displacement
from rocking.cli.input.options import question
from rocking.cli.option_names import ARGUMENTS, AXIS_FORM, YourInput, option, options, your_input

if TYPE_CHECKING:
    import numpy as np

    from rocking.model.block import Block
    from rocking.model.system import State, System
    from rocking.orbits.orbit_diagram import OrbitDiagram

OWN = options("sweep", "transient", "section_phase", "brace_angle", "brace_restitution")


class Study(NamedTuple):
    """Orbit diagram to compute: one varied parameter, all others fixed."""

    system: System
    start: State
    block: Block | None
    parameter: str
    values: np.ndarray
    typed: str


def study(given: Mapping[str, Any]) -> Study:
    """Return the study described by the options; YourInput unless exactly one of them is an axis."""
    import numpy as np

    axes = [name for name, value in given.items() if isinstance(value, Axis)]
    if len(axes) != 1:
        got = " and ".join(map(option, axes)) or "none"
        raise YourInput(f"exactly one option must be an axis, {AXIS_FORM}; got {got}")
    name, axis = axes[0], given[axes[0]]
    check_displacement(given, name)
    values = np.linspace(axis.start, axis.stop, axis.points)
    # Valid ranges are intervals, so that two valid ends imply valid values between them.
    system, start, block = question({**given, name: axis.start})
    last, _, _ = question({**given, name: axis.stop})
    typed = f"{option(name)} {axis.start:.6g} to {axis.stop:.6g}"
    if name not in VARIES:
        return Study(system, start, block, name, values, typed)
    # Each SI quantity is proportional to the normalised one.
    varied = VARIES[name]
    first, final = (getattr(one.forcing, varied) for one in (system, last))
    return Study(system, start, block, varied, np.linspace(first, final, axis.points), typed)


def compute(
    study: Study, sweep: str, transient: int, cycles: int, section_phase: float | None
) -> OrbitDiagram:
    """Compute the diagram, with progress on stderr."""
    from rocking.model.progress import Bar
    from rocking.orbits.orbit_diagram import orbit_diagram

    total = len(study.values) * (2 if sweep == "both" else 1)
    with your_input(ARGUMENTS | OWN), Bar(total, "orbit diagram") as bar:
        return orbit_diagram(
            study.system,
            study.parameter,
            study.values,
            study.start,
            sweep,
            transient,
            cycles,
            section_phase,
            progress=bar.advance,
        )
