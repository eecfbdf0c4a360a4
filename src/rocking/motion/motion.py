"""Motion: the result of `simulate`, the part of it that figures show, and its dataset."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import frozen

from rocking.model.block import Block
from rocking.model.forcing import Harmonic, PiecewiseLinear, Pulse
from rocking.model.quantity import ANGLE, FRICTION
from rocking.model.restitution import system_attributes
from rocking.model.result import Result, described
from rocking.model.system import System, quantities
from rocking.model.text import counted
from rocking.model.validation import instance, refuse_if, within
from rocking.model.verdict import Overturning
from rocking.motion.trajectory import Trajectory, lying_time, side_at, turns_of_fall
from rocking.motion.validity import Validity, compared, validity

if TYPE_CHECKING:
    import xarray as xr


STEPS = 100
"""Samples in the time in which the base acceleration varies."""
STEPS_OF_RECORD = 32
"""Samples in the unit of τ, at least, of a motion under a sampled base acceleration."""
MAX_STEPS_OF_RECORD = 1_000_000
"""Samples at most of such a motion, if its base acceleration has fewer."""
STRIDE = 0.25
"""Step in τ by which the time of a fall is sought, before and after the time at which it is certain."""
FALLEN = 3.0
"""Value of |Θ| up to which a fall of the slender block is shown, far beyond its small angles."""


def has_cycles(motion: Trajectory) -> bool:
    """Return whether the base motion of a motion is periodic, so that its cycles can be counted."""
    return isinstance(motion.system.forcing, Harmonic)


def end_shown(motion: Trajectory) -> float:
    """Return the last time τ shown: the end of the run, or the instant in the fall of a block with the angle `fallen`."""
    if motion.overturning is None:
        return motion.duration
    return time_of_fall(motion, motion.overturning, fallen(motion))


def fallen(motion: Trajectory) -> float:
    """Return the value of |Θ| up to which a fall is shown: 3, or where a block with the full equation lies flat.

    It is three times the larger critical angle of an unsymmetric slender block.
    """
    critical_angle, left = motion.system.critical_angle, motion.system.left
    if critical_angle is not None:
        return 0.5 * math.pi / critical_angle
    return FALLEN if left is None or motion.system.wall else FALLEN * max(left.angle_ratio, 1.0)


def sample_step(motion: Trajectory) -> float:
    """Return the default sampling step in τ: a hundredth of the forcing's time scale, or of a shorter motion.

    Under a sampled base acceleration it is the step of the samples, or a whole fraction of it. It is longer if a motion lasts
    much longer than its base motion.
    """
    forcing = motion.system.forcing
    if isinstance(forcing, PiecewiseLinear):
        end, most = end_shown(motion), max(MAX_STEPS_OF_RECORD, forcing.values.size)
        step = forcing.step / math.ceil(forcing.step * STEPS_OF_RECORD)
        return min(max(step, end / most), end / STEPS)
    return min(motion.system.forcing.time_scale, end_shown(motion)) / STEPS


def time_of_fall(motion: Trajectory, overturning: Overturning, angle: float) -> float:
    """Return the time τ at which an overturning motion reaches |Θ| = `angle`.

    If it starts beyond this angle: the time at which overturning is certain, or 1 if that is the start.
    """
    from scipy.optimize import brentq

    def beyond(time: float) -> float:
        return abs(float(motion.at(time)[0])) - angle

    before = after = overturning.time
    if lying_time(motion) < math.inf:
        return before
    while before > 0 and beyond(before) >= 0:  # overturning may be certain only later
        before, after = max(before - STRIDE, 0.0), before
    if beyond(before) >= 0:
        return overturning.time or 1.0
    while beyond(after) < 0:
        before, after = after, after + STRIDE
        # The base may raise a block at once that lies flat in the computed motion.
        tops = (turn["time"] for turn in turns_of_fall(motion, after) if abs(turn["angle"]) >= angle)
        after = next((float(time) for time in tops if time >= before), after)
    return brentq(beyond, before, after, xtol=1e-12)


MAX_STEPS = 100_000_000


def margin_speed(motion: Trajectory, block: Block) -> float:
    """Return the margin in rad/s; NaN for a block with unequal sides whose events were not recorded.

    The unit of the margin is αθcr of the side on which the block is at that time.
    """
    if block.left is None or motion.system.wall is not None:
        return float(block.radians_per_second(motion.margin))
    if math.isnan(motion.margin) or motion.record != "all":
        return math.nan
    side = 0 if side_at(motion, motion.margin_time) > 0 else 1
    return motion.margin * block.critical_angles[side] * block.frequency_parameters[side]


Variables = dict[str, tuple[str, Any, dict[str, str]]]

OF_CYCLES = ("cycle", "phase")
"""Quantities of an event that only a periodic base motion gives."""
EVENTS = {
    "time": ("1", "time of the event"),
    "cycle": ("", "forcing cycle of the event, counted from 0"),
    "phase": ("rad", "forcing phase of the event"),
    "angle": ("1", "angle at the event"),
    "before": ("1", "angular velocity just before the event"),
    "after": ("1", "angular velocity just after the event"),
    "kind": (
        "",
        "impact, brace (impact), rest, lift-off, lean (sustained contact with a brace) or leave (release from it)",
    ),
}
"""Unit and description of the fields of an event in datasets."""


def _times(motion: Trajectory, step: float | None, block: Block | None) -> np.ndarray:
    """Normalised times of the samples."""
    second, unit = (1.0, "") if block is None else (block.seconds(1.0), "s")
    if step is None:
        spacing = sample_step(motion)
    else:
        longest = (motion.cycles * motion.system.forcing.span or end_shown(motion)) * second
        spacing = within("step", step, longest / MAX_STEPS, longest, unit) / second
    end = end_shown(motion)
    return np.minimum(spacing * np.arange(int(end / spacing * (1 + 1e-12)) + 1), end)


def _variable(along: str, values: Any, text: str, unit: str = "1") -> tuple[str, Any, dict[str, str]]:
    return along, values, {"units": unit, "long_name": text} if unit else {"long_name": text}


def _samples(motion: Trajectory, times: np.ndarray, block: Block | None) -> tuple[Variables, Variables]:
    angle, velocity = motion.at(times)
    base = motion.system.forcing.acceleration(times)
    variables = {
        "angle": _variable("time", angle, "angle of the block"),
        "velocity": _variable("time", velocity, "angular velocity of the block"),
        "acceleration": _variable("time", motion.acceleration(times), "angular acceleration of the block"),
        "base_acceleration": _variable("time", base, "horizontal acceleration of the base"),
    }
    if motion.system.vertical is not None:
        weight = 1 + motion.system.vertical.acceleration(times)
        text = "weight of the block on the moving base, relative to that on a base at rest"
        variables["weight"] = _variable("time", weight, text)
    if block is not None:
        top = block.top_displacement(angle)
        variables["top_displacement"] = _variable("time", top, "displacement of the block's top", "m")
    return variables, {"time": _variable("time", times, "time")}


def _events(motion: Trajectory) -> Variables:
    return {
        f"event_{name}": _variable("event", motion.events[name], text, unit)
        for name, (unit, text) in EVENTS.items()
        if name not in OF_CYCLES or has_cycles(motion)
    }


def vertical_attributes(system: System) -> dict[str, float]:
    """Return the least and the largest vertical acceleration of the base, in units of g; none if it moves horizontally."""
    if system.vertical is None:
        return {}
    upwards = system.vertical.scale * system.vertical.values
    return {"vertical_least_g": float(upwards.min()), "vertical_largest_g": float(upwards.max())}


def _section(motion: Trajectory) -> tuple[Variables, Variables]:
    angle, velocity = motion.section().T
    cycles = np.arange(angle.size)
    variables = {
        "angle": _variable("cycle", angle, "angle of the block, once per forcing cycle"),
        "velocity": _variable("cycle", velocity, "angular velocity of the block, once per forcing cycle"),
    }
    return variables, {
        "cycle": _variable("cycle", cycles, "forcing cycles since the start", ""),
        "time": _variable("cycle", cycles * motion.system.periodic.period, "time"),
    }


def _attributes(motion: Trajectory) -> dict[str, Any]:
    """Return the attributes of the dataset: system, initial state and results."""
    periodic = has_cycles(motion)
    forcing = motion.system.forcing
    if periodic:
        base = (
            "The base acceleration is amplitude cos(frequency time + phase). "
            "Cycles are counted from 0 in event_cycle and overturning_cycle."
        )
    elif isinstance(forcing, Pulse) and forcing.cosine is not None:
        base = "The base acceleration is a piece of a cosine, and 0 after the end of the pulse."
    else:
        base = "The base acceleration is linear between samples, and 0 before the first and after the last."
    full = (
        "" if motion.system.critical_angle is None else " The equation of motion is that of the full block."
    )
    normalised = described("Motion")
    by_tangent = motion.system.normalised_by == "tangent"
    tangent = " Base accelerations are in units of g tan theta_cr." if by_tangent else ""
    attributes = normalised | {
        "comment": f"{normalised['comment']}{tangent} {base}{full}",
        **({"pulse": forcing.kind} if isinstance(forcing, Pulse) else {}),
        **quantities(motion.system),
        **system_attributes(motion.system),
        **vertical_attributes(motion.system),
        "model": "slender" if motion.system.critical_angle is None else "full",
        "start_angle": motion.start.angle,
        "start_velocity": motion.start.velocity,
        **({"cycles": motion.cycles} if periodic else {}),
        "record": motion.record,
        "outcome": str(motion.outcome),
        "duration": motion.duration,
        "peak": motion.peak,
        "impacts": motion.impacts,
        "brace_hits": motion.brace_hits,
        "impacts_cut_short": motion.record != "all",
        "final_angle": motion.final.angle,
        "final_velocity": motion.final.velocity,
    }
    if not periodic:
        attributes |= {
            "margin": motion.margin,
            "margin_time": motion.margin_time,
            "certified": motion.certified,
        }
    if motion.overturning is not None:
        attributes["overturning_time"] = motion.overturning.time
        attributes["overturning_impacts"] = motion.overturning.impacts
        if periodic:
            attributes["overturning_cycle"] = motion.overturning.cycle
    return attributes


@frozen(eq=False, slots=False)
class Motion(Trajectory, Result):
    """Simulated motion of one block; returned by `simulate`.

    Attributes
    ----------
    system, start : System, State
        System and initial state.
    record : str
        Recorded data: "all", "section" or "none".
    cycles : int
        Number of forcing cycles simulated; 0 for a base motion of finite length. It is smaller than requested only if the
        block overturns; the last cycle is then that of the proof.
    outcome : Outcome
        OVERTURNED or AT_REST if that is proved, else BOUNDED.
    overturning : Overturning or None
        Instant from which overturning is certain.
    impacts, brace_hits : int
        Number of impacts at Θ = 0 and on the braces.
    peak : float
        Largest |Θ| of the run, [0, `duration`]. If the block overturns, the run ends before the angle reaches 90°, and `peak`
        says nothing about the fall.
    margin : float
        What the block lacked to overturn (negative), or had beyond that, in units of αθcr. It is the K₊ of least size over all
        lift-offs and impacts.

        K₊ = v − 1 − σR(τ), with the speed v and the side σ afterwards. R(τ) is the integral of e^(τ−x) a(x) over all later x.

        Of a block with a critical angle it is K = v − v_s. The speed v_s is that of the one motion on this side, continued through
        Θ = 0, which stays bounded for ever. K tends to K₊ for small critical angles.

        The block leaves for good if it is positive, unless it returns before. NaN if the block never moves, for a harmonic base
        motion, and between braces. Under more than 1 g it is possible that no motion stays bounded, or more than one. Lift-offs and
        impacts of which that is so do not count, and the margin is NaN if all are.
    margin_time : float
        Time τ of that lift-off or impact.
    certified : bool
        False if the outcome is undecided in double precision: the accumulated rounding error exceeds |K₊| somewhere, or the
        clearance of a minimum of |Θ| between two impacts, or a lower bound of it, or the base acceleration equals that of lift-off
        up to rounding. Of a block with a critical angle the error must
        be small at the end of each arc, instead of |K₊| at its start. The error is an estimate from the rounding of each arc and
        its growth. True for a harmonic base motion. Between braces, which prevent overturning, only lift-off counts.
    final : State
        Θ and Θ' at the end, just after an event if there is one.
    duration : float
        Length of the run, in τ.
    events, peaks : structured ndarray
        Events and local extremes of Θ; only with record="all".

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> motion = rk.simulate(system, cycles=50)
    >>> print(motion)
    bounded over 50 cycles; 99 impacts, peak |Θ| 0.1875
    >>> motion.events["kind"][:2].tolist(), motion.section().shape
    (['impact', 'impact'], (51, 2))
    """

    PLOT = "overview"

    def _data_for(self, block: Block | None, step: float | None = None) -> xr.Dataset:
        """Return the samples and events, or the section. With a block, `step` is in seconds."""
        import xarray as xr

        if self.record == "section":
            refuse_if(step is not None, "step", 'be omitted for a motion with record="section"', step)
            variables, coordinates = _section(self)
        else:
            variables, coordinates = _samples(self, _times(self, step, block), block)
            variables |= _events(self)
        return xr.Dataset(variables, coordinates, _attributes(self))

    def _summary(self) -> xr.Dataset:
        import xarray as xr

        return xr.Dataset(attrs=_attributes(self))

    def to_xarray(
        self, step: float | None = None, block: Block | None = None, *, units: str | None = None
    ) -> xr.Dataset:
        """Return the motion sampled in time, with its events, or its section, as a dataset with units.

        Parameters
        ----------
        step : float, optional
            Time step of the samples in τ, or in seconds for SI units. Default: a hundredth of the forcing period, or the step of
            a base acceleration that is given by samples (a fraction of a long one). The samples start at 0 and end at the last
            whole step of the run. If the block overturns, they continue to |Θ| = 3. With the full
            equation they continue until it lies flat. A motion that starts beyond is sampled for one unit of time.
        block : Block, optional
            Block of a system that was made without one. Default: that of the system.
        units : {"si", "normalised"}, optional
            Units of the values. Default: SI if the block is known, else normalised.

        Returns
        -------
        xarray.Dataset
            For record="all": `angle`, `velocity`, `acceleration`, `base_acceleration` (in SI also `top_displacement`) along `time`,
            and `event_time`, `event_kind`, … along `event`. Cycle and phase of the events exist only for a periodic base motion.
            For record="section": `angle` and `velocity` along `cycle`. The attributes `units` and `long_name` follow the CF
            conventions. Attributes of the dataset are the system, the initial state and the version of the package.

        Raises
        ------
        TypeError
            If `step` is not a number, or `block` is not a Block.
        ValueError
            If `step` is not positive or is longer than the motion, or if the motion recorded neither events nor section.
            If `units` is "si" without a block.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
        >>> rk.simulate(system, cycles=2).to_xarray(step=0.5).sizes["time"]
        5
        """
        chosen = self._block(units, block)
        return self._dataset(self._data_for(chosen, step), block, chosen)

    def validity(self, block: Block, *, full: bool = False, friction: float | None = None) -> Validity:
        """Assess whether the model applies to this motion of a real block: friction, base reaction and slenderness.

        Parameters
        ----------
        block : Block
            Block in SI units that performs the motion.
        full : bool
            Also follow the full equation of motion under the same base motion, and compare the largest angle and the outcome.
            Default: False.
        friction : float, optional
            Coefficient of friction of the base, in [0.001, 10]. A motion that needs more is refused as a verdict on the block:
            `Validity.slides_from` is the first time at which it does. Default: unlimited.

        Returns
        -------
        Validity
            Required friction, base reaction, errors of the slender-block model, and warnings; `print` shows them.

        Raises
        ------
        TypeError
            If `block` is not a Block, or `friction` is not a real number.
        ValueError
            If the motion was not recorded with record="all", if `block` has other sides than the block of the motion, or if
            `friction` lies outside its range.

        Examples
        --------
        >>> import rocking as rk
        >>> block = rk.Block(height=2.0, width=0.5)
        >>> motion = rk.simulate(block.system(acceleration=4.0, frequency_hz=1.2), cycles=10)
        >>> motion.validity(block).friction > 0.2
        True
        >>> print(motion.validity(block, friction=0.25).refusal)
        slides from t = ... s (motion): no rocking verdict with a friction of 0.25
        """
        available = None if friction is None else FRICTION.checked(friction)
        return validity(self, block, full=instance("full", full, bool), friction=available)

    @property
    def doubt(self) -> str:
        """Reason why the outcome is not certified; empty if it is."""
        return "" if self.certified else "undecided in double precision"

    def __str__(self) -> str:
        counts, block = [counted(self.impacts, "impact")], self.block
        if self.system.braces is not None:
            counts.append(counted(self.brace_hits, "brace impact"))
        if self.overturning is None:
            _, angle, unit = ANGLE.printed(block)
            counts.append(f"peak |{'Θ' if block is None else 'θ'}| {angle(self.peak):.4g}{unit}")
            over = counted(self.cycles, "cycle") if self.cycles else self._time(self.duration)
            how = f"{self.outcome} over {over}"
        else:
            since = ": overturning is certain" if self.certified else ""
            how = f"overturned{since} from {self._time(self.overturning.time)}"
        margin = "" if math.isnan(self.margin) else f", margin {self._margin()}"
        doubt = f" ({self.doubt})" if self.doubt else ""
        name, outcome = compared(self)
        other = f"; {name}: {outcome}" if name else ""
        return f"{how}{doubt}; {', '.join(counts)}{margin}{other}"

    def _margin(self) -> str:
        """Return the margin as text; in °/s if the block is known."""
        speed = math.nan if self.block is None else margin_speed(self, self.block)
        if not math.isnan(speed):
            return f"{math.degrees(speed):.4g}°/s"
        return f"{self.margin:.4g}" + (
            " αθcr of its side" if self.system.left and not self.system.wall else ""
        )

    def _time(self, time: float) -> str:
        """Return a time as text; in s if the block is known."""
        return f"τ = {time:.6g}" if self.block is None else f"t = {self.block.seconds(time):.4g} s"
