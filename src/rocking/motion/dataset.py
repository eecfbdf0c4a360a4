"""Motions as xarray datasets with units, parameters and the version of the package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model import VERSION, Block, block_attributes, instance, quantities, refuse_if, within
from rocking.motion.fall import end_shown, has_cycles, sample_step

if TYPE_CHECKING:
    import xarray as xr

    from rocking.motion.trajectory import Trajectory

MAX_STEPS = 100_000_000

Unit = tuple[float, str]
"""Size of the normalised unit in the unit of the output, and name of the latter."""
Variables = dict[str, tuple[str, Any, dict[str, str]]]

OF_CYCLES = ("cycle", "phase")
"""Quantities of an event that only a periodic base motion gives."""
EVENTS = {
    "time": ("time", "time of the event"),
    "cycle": (None, "forcing cycle of the event, counted from 0"),
    "phase": ("phase", "forcing phase of the event"),
    "angle": ("angle", "angle at the event"),
    "before": ("velocity", "angular velocity just before the event"),
    "after": ("velocity", "angular velocity just after the event"),
    "kind": (
        None,
        "impact, brace (impact), rest, lift-off, lean (sustained contact with a brace) or leave (release from it)",
    ),
}


def to_dataset(motion: Trajectory, step: float | None = None, block: Block | None = None) -> xr.Dataset:
    """Return a motion sampled in time, with its events, or its section.

    Parameters
    ----------
    motion : Motion
        Motion recorded with record="all" or "section".
    step : float, optional
        Time step of the samples in τ, or in seconds with a block. Default: a hundredth of the forcing period, or the step of
        a base acceleration that is given by samples (a fraction of a long one). The samples start at 0 and end at the last
        whole step of the run. If the block overturns, they continue to |Θ| = 3. With the full
        equation they continue until it lies flat. A motion that starts beyond is sampled for one unit of time.
    block : Block, optional
        Block for output in s, rad and m, with the displacement of its top. Default: normalised output.

    Returns
    -------
    xarray.Dataset
        For record="all": `angle`, `velocity`, `acceleration`, `base_acceleration` (and `top_displacement`) along `time`, and
        `event_time`, `event_kind`, … along `event`. Cycle and phase of the events exist only for a periodic base motion. For
        record="section": `angle` and `velocity` along `cycle`. The
        attributes `units` and `long_name` follow the CF conventions. Attributes of the dataset are the system and the
        initial state, always normalised, and the version of the package.

    Raises
    ------
    TypeError
        If `step` is not a number.
    ValueError
        If `step` is not positive or is longer than the motion, or if the motion recorded neither events nor section.

    Examples
    --------
    >>> from rocking import Harmonic, System, simulate
    >>> motion = simulate(System(Harmonic(amplitude=2.0, period=1.0), restitution=0.925), cycles=5)
    >>> dict(motion.to_xarray().sizes)
    {'time': 501, 'event': 9}
    """
    import xarray as xr

    units = _units(block)
    if motion.record == "section":
        refuse_if(step is not None, "step", 'be omitted for a motion with record="section"', step)
        variables, coordinates = _section(motion, units)
    else:
        variables, coordinates = _samples(motion, _times(motion, step, units), units, block)
        variables |= _events(motion, units)
    return xr.Dataset(variables, coordinates, _attributes(motion, block))


def _units(block: Block | None) -> dict[str, Unit]:
    if block is None:
        return dict.fromkeys(("time", "angle", "velocity", "acceleration", "base"), (1.0, "1"))
    instance("block", block, Block)
    turn = block.radians_per_second(1.0)
    return {
        "time": (block.seconds(1.0), "s"),
        "angle": (block.radians(1.0), "rad"),
        "velocity": (turn, "rad s-1"),
        "acceleration": (turn * block.frequency_parameter, "rad s-2"),
        "base": (block.acceleration(1.0), "m s-2"),
    }


def _times(motion: Trajectory, step: float | None, units: dict[str, Unit]) -> np.ndarray:
    """Normalised times of the samples."""
    second, unit = units["time"]
    if step is None:
        spacing = sample_step(motion)
    else:
        longest = (motion.cycles * motion.system.forcing.span or end_shown(motion)) * second
        spacing = within("step", step, longest / MAX_STEPS, longest, "" if unit == "1" else unit) / second
    end = end_shown(motion)
    return np.minimum(spacing * np.arange(int(end / spacing * (1 + 1e-12)) + 1), end)


def _variable(along: str, values: Any, unit: Unit, long_name: str) -> tuple[str, Any, dict[str, str]]:
    size, name = unit
    return along, values * size, {"units": name, "long_name": long_name}


def _samples(
    motion: Trajectory, times: np.ndarray, units: dict[str, Unit], block: Block | None
) -> tuple[Variables, Variables]:
    angle, velocity = motion.at(times)
    turning, base = motion.acceleration(times), motion.system.forcing.acceleration(times)
    variables = {
        "angle": _variable("time", angle, units["angle"], "angle of the block"),
        "velocity": _variable("time", velocity, units["velocity"], "angular velocity of the block"),
        "acceleration": _variable(
            "time", turning, units["acceleration"], "angular acceleration of the block"
        ),
        "base_acceleration": _variable("time", base, units["base"], "horizontal acceleration of the base"),
    }
    if block is not None:
        top = block.top_displacement(angle)
        variables["top_displacement"] = _variable("time", top, (1.0, "m"), "displacement of the block's top")
    return variables, {"time": _variable("time", times, units["time"], "time")}


def _events(motion: Trajectory, units: dict[str, Unit]) -> Variables:
    units = units | {"phase": (1.0, "rad")}
    variables: Variables = {}
    for name, (quantity, long_name) in EVENTS.items():
        if name in OF_CYCLES and not has_cycles(motion):
            continue
        values = motion.events[name]
        if quantity is None:
            variables[f"event_{name}"] = "event", values, {"long_name": long_name}
        else:
            variables[f"event_{name}"] = _variable("event", values, units[quantity], long_name)
    return variables


def _section(motion: Trajectory, units: dict[str, Unit]) -> tuple[Variables, Variables]:
    angle, velocity = motion.section().T
    cycles = np.arange(angle.size)
    variables = {
        "angle": _variable("cycle", angle, units["angle"], "angle of the block, once per forcing cycle"),
        "velocity": _variable(
            "cycle", velocity, units["velocity"], "angular velocity of the block, once per forcing cycle"
        ),
    }
    return variables, {
        "cycle": ("cycle", cycles, {"long_name": "forcing cycles since the start"}),
        "time": _variable("cycle", cycles * motion.system.periodic.period, units["time"], "time"),
    }


def _attributes(motion: Trajectory, block: Block | None) -> dict[str, Any]:
    """Return the attributes of the dataset: normalised system and initial state, results, and the block if there is one."""
    periodic = has_cycles(motion)
    base = (
        "The base acceleration is amplitude cos(frequency time + phase). "
        "Cycles are counted from 0 in event_cycle and overturning_cycle."
        if periodic
        else "The base acceleration is linear between samples, and 0 before the first and after the last."
    )
    full = (
        "" if motion.system.critical_angle is None else " The equation of motion is that of the full block."
    )
    attributes = {
        "Conventions": "CF-1.11",
        "title": "Motion of a free-standing block on a shaking base",
        "source": f"rocking {VERSION}",
        "comment": f"Attributes without a unit are normalised as in Yim & Lin (1991), Eqs. (1)-(4). {base}{full}",
        **quantities(motion.system),
        "start_angle": motion.start.angle,
        "start_velocity": motion.start.velocity,
        **({"cycles": motion.cycles} if periodic else {}),
        "record": motion.record,
        "outcome": str(motion.outcome),
        "peak": motion.peak,
        "impacts": motion.impacts,
        "brace_hits": motion.brace_hits,
    }
    if not periodic:
        attributes |= {
            "margin": motion.margin,
            "margin_time": motion.margin_time,
            "certified": int(motion.certified),
        }
    if motion.overturning is not None:
        attributes["overturning_time"] = motion.overturning.time
        if periodic:
            attributes["overturning_cycle"] = motion.overturning.cycle
    if block is not None:
        attributes |= block_attributes(block)
    return attributes
