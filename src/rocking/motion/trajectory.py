"""Trajectory of one simulated block: the table of its events, and its exact state at any time."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.kernels import event_kinds as kernel
from rocking.kernels.motion import observers as resample
from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.forcing import Harmonic
from rocking.model.quantity import PHASE
from rocking.model.system import State, System
from rocking.model.validation import Refusal, reals, refuse_if
from rocking.model.verdict import Outcome, Overturning
from rocking.motion.march_loop import parameters, section_of

EVENT = np.dtype(
    [
        ("time", "f8"),
        ("cycle", "i8"),
        ("phase", "f8"),
        ("angle", "f8"),
        ("before", "f8"),
        ("after", "f8"),
        ("kind", "U8"),
    ]
)
KINDS = np.array(["impact", "brace", "rest", "lift-off", "lean", "leave"])


def events_of(system: System, rows: np.ndarray, cycle_length: float, duration: float) -> np.ndarray:
    """Return event rows of the kernel as the structured array of `Motion.events`."""
    rows = rows[rows["event"] != kernel.NONE]
    forcing = system.forcing
    events = np.empty(len(rows), EVENT)
    events["time"] = absolute(rows, cycle_length, duration)
    if isinstance(forcing, Harmonic):
        events["cycle"] = rows["cycle"]
        events["phase"] = np.mod(forcing.frequency * rows["time"] + forcing.phase, 2.0 * math.pi)
    else:
        events["cycle"], events["phase"] = -1, math.nan
    events["angle"] = rows["side"] * rows["angle"] + 0.0
    events["before"] = rows["before"] + 0.0
    events["after"] = rows["side"] * rows["velocity"] + 0.0
    events["kind"] = KINDS[rows["event"].astype(int)]
    return events


def absolute(rows: np.ndarray, cycle_length: float, duration: float) -> np.ndarray:
    """Return the times of event rows, in τ from the start."""
    # Rounding could place the last event after the end of the run.
    return np.minimum(rows["cycle"] * cycle_length + rows["time"], duration)


TURN = np.dtype([("time", "f8"), ("angle", "f8")])
LYING = 1e-12
"""Relative rounding error of the angle at which a block lies flat."""


@frozen(eq=False, slots=False)
class Trajectory(ReadOnlyArrays):
    """Fields of a `Motion`, and the states between its events."""

    system: System
    start: State
    record: str
    cycles: int
    duration: float
    final: State
    outcome: Outcome
    overturning: Overturning | None
    impacts: int
    brace_hits: int
    peak: float
    margin: float
    margin_time: float
    certified: bool
    _cycle_length: float = field(repr=False)
    _section_rows: np.ndarray = field(repr=False, converter=read_only)
    _event_rows: np.ndarray = field(repr=False, converter=read_only)

    @cached_property
    def events(self) -> np.ndarray:
        """All events in order, as a structured array.

        Its fields are time (τ), cycle (counted from 0), phase (ψ in [0, 2π)), angle, before and after (velocities), and kind:

        - "impact" at Θ = 0, "brace" impact;
        - "rest", "lift-off": beginning and end of rest;
        - "lean", "leave": beginning and end of sustained contact with a brace.

        It requires ``record="all"``, as `at` does.
        """
        return read_only(events_of(self.system, self._rows(), self._cycle_length, self.duration))

    @cached_property
    def peaks(self) -> np.ndarray:
        """All local extremes of Θ between events, as a structured array with the fields time (τ) and angle."""
        rows = self._rows()
        begins = absolute(rows, self._cycle_length, self.duration)
        lasts = np.append(
            np.diff(rows["cycle"]) * self._cycle_length + np.diff(rows["time"]),
            self.duration - begins[-1],
        )
        return read_only(self._turns(rows, begins, lasts))

    def _turns(self, rows: np.ndarray, begins: np.ndarray, lasts: np.ndarray) -> np.ndarray:
        """Return the extremes on arcs that begin with event rows, at times, and last so long."""
        values = np.empty((4 * len(rows) + 16, 3))
        count = resample.turns(self._numbers, rows, lasts, values)
        if count > len(values):
            values = np.empty((count, 3))
            resample.turns(self._numbers, rows, lasts, values)
        turns = np.empty(count, TURN)
        turns["time"] = begins[values[:count, 0].astype(int)] + values[:count, 1]
        turns["angle"] = values[:count, 2]
        return turns

    def at(self, times: Any) -> tuple[Any, Any]:
        """Return Θ and Θ' at any times, exact: Yim & Lin (1991), Eq. (5), from the preceding event.

        Parameters
        ----------
        times : float or array_like
            Time τ, from 0 to `duration`. Later times are allowed if no further event can occur. That is the case at rest,
            and after overturning while the angle, which grows like e^τ, is within the range of floats. A block that overturned
            because it lies flat, although its base could raise it, stays as it lies.

        Returns
        -------
        angle, velocity : float or ndarray
            Θ and Θ' in the shape of `times`; at the instant of an event, just after it.

        Raises
        ------
        TypeError
            If `times` holds anything but real numbers.
        ValueError
            If a time lies outside this range, or if the motion was not recorded with ``record="all"``.

        Examples
        --------
        >>> import rocking as rk
        >>> free = rk.System(rk.Harmonic(amplitude=0.0, period=1.0), restitution=0.9)
        >>> angle, velocity = rk.simulate(free, rk.State(angle=0.5), cycles=1).at([0.0, 1.0])
        >>> angle.round(6).tolist()  # 1 − ½ cosh τ
        [0.5, 0.22846]
        """
        values = self._sampled(times)
        return values[..., 0][()], values[..., 1][()]

    def acceleration(self, times: Any) -> Any:
        """Return Θ'' at any times: Yim & Lin (1991), Eq. (4); 0 at rest and in sustained contact with a brace.

        Parameters
        ----------
        times : float or array_like
            Time τ, as in `at`.

        Returns
        -------
        float or ndarray
            Θ'' in the shape of `times`; at the instant of an event, just after it.

        Raises
        ------
        TypeError, ValueError
            If `at` raises it for these times.

        Examples
        --------
        >>> import rocking as rk
        >>> free = rk.System(rk.Harmonic(amplitude=0.0, period=1.0), restitution=0.9)
        >>> float(rk.simulate(free, rk.State(angle=0.5), cycles=1).acceleration(0.0))
        -0.5
        """
        return self._sampled(times)[..., 2][()]

    def section(self, phase: float | None = None) -> np.ndarray:
        """Return the stroboscopic section: Θ and Θ' at every instant with ψ ≡ ``phase`` (mod 2π).

        Parameters
        ----------
        phase : float, optional
            Forcing phase ψ of the section, rad, in [-1000, 1000]. Default: the phase φ of the forcing. The first of
            ``cycles + 1`` rows is then the initial state; if the block overturns, there are no rows after the proof. For
            another phase, or without a recorded section, the motion is simulated again.

        Returns
        -------
        ndarray, shape (n, 2)
            Θ and Θ', just after an event at that instant.

        Raises
        ------
        TypeError
            If `phase` is not a real number.
        ValueError
            If `phase` lies outside its range.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
        >>> motion = rk.simulate(system, cycles=300, record="section")
        >>> motion.section().shape, bool(abs(motion.section()[-1] - motion.section()[-2]).max() < 1e-12)
        ((301, 2), True)
        """
        if phase is None:
            if self.record == "section":
                return self._section_rows
            phase = self.system.periodic.phase
        return section_of(self.system, self.start, self.cycles, PHASE.checked(phase))

    @cached_property
    def _numbers(self) -> Any:
        return parameters(self.system, self._cycle_length)

    def _rows(self) -> np.ndarray:
        refuse_if(
            self.record != "all", "record", "be 'all' for events, peaks and states at any time", self.record
        )
        return self._event_rows

    def _sampled(self, times: Any) -> np.ndarray:
        rows = self._rows()
        times = np.asarray(reals("times", times), dtype=float)
        ends = self.outcome is Outcome.BOUNDED
        last = self.duration if ends else np.finfo(float).max
        if times.size and not (times.min() >= 0.0 and times.max() <= last):
            outside = times[~((times >= 0.0) & (times <= last))].flat[0]
            allowed = f"lie in the run, [0, {last:.6g}]" if ends else "be finite and at least 0"
            raise Refusal("times", allowed, float(outside))
        flat = times.ravel()
        period = self._cycle_length
        begins = absolute(rows, self._cycle_length, self.duration)
        index = np.searchsorted(begins, flat, side="right") - 1
        cycle = np.floor(flat / period)
        elapsed = (cycle - rows["cycle"][index]) * period + ((flat - cycle * period) - rows["time"][index])
        out = np.empty((flat.size, 3))
        elapsed = np.where(flat > begins[index], np.maximum(elapsed, 0.0), 0.0)
        resample.sample(self._numbers, rows, index, elapsed, out)
        out[flat >= lying_time(self)] = self.final.angle, 0.0, 0.0
        if not np.isfinite(out).all():
            first = float(flat[np.flatnonzero(~np.isfinite(out).all(axis=1))[0]])
            allowed = f"lie in the run, [0, {self.duration:.6g}], or little later, while the angle is within the range of floats"
            raise Refusal("times", allowed, first)
        return out.reshape(*times.shape, 3) + 0.0


def side_at(motion: Trajectory, event: float) -> int:
    """Return the side of the arc that begins with the event at a time: 1 or −1; ValueError if no events were recorded."""
    rows = motion._rows()
    rows = rows[rows["mode"] == kernel.FLIGHT]
    begins = absolute(rows, motion._cycle_length, motion.duration)
    return int(rows["side"][np.argmin(np.abs(begins - event))])


def turns_of_fall(motion: Trajectory, until: float) -> np.ndarray:
    """Return the extremes of Θ of the last arc, as `Trajectory.peaks` does, up to a time τ that may be after the end of the run."""
    rows = motion._rows()[-1:]
    begins = absolute(rows, motion._cycle_length, motion.duration)
    return motion._turns(rows, begins, until - begins)


def lying_time(motion: Trajectory) -> float:
    """Return the time τ from which a block lies flat whose base could raise it again: that of its overturning; infinite for others."""
    critical_angle = motion.system.critical_angle
    if motion.overturning is None or critical_angle is None:
        return math.inf
    lies = abs(abs(motion.final.angle) * critical_angle / (0.5 * math.pi) - 1.0) < LYING
    return motion.overturning.time if lies else math.inf
