"""Animation of the block on its moving base."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from numpy.typing import NDArray

from rocking.model.block import Block
from rocking.model.system import System
from rocking.model.validation import instance, within
from rocking.model.verdict import Outcome
from rocking.motion.motion import Motion, has_cycles, time_of_fall
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities
from rocking.plot.parts.base_displacement import base_displacement
from rocking.plot.parts.film_scene import Scene
from rocking.plot.parts.sample_times import settled, window
from rocking.plot.parts.video import check_film, write_film
from rocking.plot.time_history import draw_history

NOMINAL = Block(height=2.0, width=0.5)
CYCLES_SHOWN, DECAY_SHOWN = 10, 30
# Time before the lift-off and after the fall, as a share of the time between.
ROOM = 0.08
SIZE, DOTS = (6.4, 5.6), 100


def animation(
    motion: Motion,
    path: str | Path,
    block: Block | None = None,
    seconds: float = 10.0,
    fps: float = 25.0,
    cycles: tuple[float, float] | None = None,
) -> Path:
    """Animate the block on its moving base, above its time history, as a GIF or an MP4.

    Parameters
    ----------
    motion : Motion
        Motion recorded with ``record="all"``.
    path : str or Path
        Path of the animation; ``.gif`` or ``.mp4``.
    block : Block, optional
        Block for proportions and SI units. Default: a nominal block of 4 to 1 and normalised units.
    seconds : float
        Length of the animation, 0.1 to 600 s. Default: 10.
    fps : float
        Frames per second, 1 to 100. A GIF runs at exactly `fps` only if `fps` divides 100. Default: 25.
    cycles : tuple of float, optional
        First and last forcing cycle shown, counted from the start. Default: the last ten cycles. For a motion that
        overturned, ten cycles and the complete fall; for a motion that came to rest, thirty cycles up to rest. Units of τ
        replace cycles if the base does not move. Omit it for a base motion of finite length. The film then
        begins before the first lift-off and ends with rest or the complete fall.

    Returns
    -------
    Path
        Path of the animation, which exists only once it is complete.

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If a value lies outside its range, or the motion kept no events.
    ImportError
        If `path` is that of an MP4, and the extra ``film`` is not installed.

    See Also
    --------
    overview : Plot the motion.
    time_history : Plot the time history alone.

    Notes
    -----
    Small angles are exaggerated, and the displacement of the base is scaled to a visible size; the animation shows both
    factors. The displacement of a sampled base is its acceleration, integrated twice from rest. The animation states the
    drift, the displacement when the acceleration ends. A fall follows Eq. (4) (Yim & Lin 1991), which holds for small angles, up to 90°.

    Examples
    --------
    >>> import rocking as rk, tempfile
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     rk.plot.animation(rk.simulate(system, cycles=20), f"{folder}/block.gif", seconds=0.4).name
    'block.gif'
    """
    instance("motion", motion, Motion)
    body = NOMINAL if block is None else instance("block", block, Block)
    path = check_film(path)
    count = max(2, round(within("seconds", seconds, 0.1, 600.0) * within("fps", fps, 1.0, 100.0)))
    start, stop = _window(motion, body, cycles)
    return write_film(path, _Film(motion, block, np.linspace(start, stop, count), seconds).frames(), fps)


def _window(motion: Motion, block: Block, cycles: tuple[float, float] | None) -> tuple[float, float]:
    if cycles is not None:
        return window(motion, cycles)
    if not has_cycles(motion):
        return _moving(motion, block)
    unit = motion.system.forcing.span if motion.system.forcing.largest else 1.0
    if motion.outcome is Outcome.AT_REST:
        stop = settled(motion)
        return max(0.0, stop - DECAY_SHOWN * unit), stop
    if motion.overturning is None:
        return max(0.0, motion.duration - CYCLES_SHOWN * unit), motion.duration
    start = max(0.0, motion.overturning.time - CYCLES_SHOWN * unit)
    flat = time_of_fall(motion, motion.overturning, block.angle(degrees=90))
    return start, flat + ROOM * (flat - start)


def _moving(motion: Motion, block: Block) -> tuple[float, float]:
    """Return the part of a motion under a base motion of finite length from just before the block lifts off to its end."""
    stop = motion.duration
    if motion.overturning is not None:
        stop = time_of_fall(motion, motion.overturning, block.angle(degrees=90))
    elif motion.outcome is Outcome.AT_REST:
        stop = settled(motion)
    first = float(motion.events["time"][0]) if len(motion.events) else 0.0
    start = max(0.0, first - ROOM * (stop - first))
    return start, stop + (ROOM * (stop - start) if motion.overturning is not None else 0.0)


class _Film:
    """Frames of a motion at the instants `times` (τ): a scene above the time history, with a moving dot."""

    def __init__(self, motion: Motion, block: Block | None, times: NDArray, seconds: float) -> None:
        body = block or NOMINAL
        self.times, self.shown = times, quantities(block)
        flat = body.angle(degrees=90)
        # a fallen block stays down: the motion is evaluated only up to the end of the fall
        end = (
            times[-1]
            if motion.overturning is None
            else min(times[-1], time_of_fall(motion, motion.overturning, flat))
        )
        self.angles = np.clip(motion.at(np.minimum(times, end))[0], -flat, flat)
        self.figure = Figure(SIZE, dpi=DOTS)
        self.figure.set_layout_engine("constrained", rect=(0.0, 0.0, 1.0, 0.9))
        above, below = self.figure.subplots(2, 1, height_ratios=(2.6, 1))
        notes = self._scene(above, motion.system, body, to_scale=block is not None)
        draw_history(below, motion, times[0], end, block)
        if motion.overturning is not None:
            (curve,) = (line for line in below.lines if line.get_gid() == "motion")
            time, angle = (np.append(column, column[-1]) for column in curve.get_data())
            time[-1] = self.shown.time(times[-1])
            curve.set_data(time, np.clip(angle, self.shown.angle(-flat), self.shown.angle(flat)))
            below.set_xlim(self.shown.time(times[0]), time[-1])
            most = 1.5 * min(max(motion.peak, 1.0), flat)
            below.set_ylim(self.shown.angle(-most), self.shown.angle(most))
        self.cursor = below.axvline(0.0, color=style.IMPACT, linewidth=style.LINE, animated=True)
        (self.dot,) = below.plot([], [], "o", color=style.IMPACT, markersize=7, animated=True, zorder=5)
        self.reading = self._write(0.02, "", style.TEXT + 4, ha="left", animated=True)
        interval = float(self.shown.time(times[1] - times[0]))
        self.digits = max(1, math.ceil(-math.log10(interval)))
        self.number = _number(float(self.shown.angle(np.abs(self.angles).max())))
        pace = interval * (len(times) - 1) / seconds
        notes += f"\n1 s of film is {pace:.3g} {self.shown.time_unit}"
        self._write(0.98, notes, style.SMALL, ha="right")

    def _write(self, place: float, text: str, size: float, **how) -> Text:
        return self.figure.text(place, 0.98, text, fontsize=size, va="top", color=style.INK, **how)

    def _scene(self, ax: Axes, system: System, block: Block, *, to_scale: bool) -> str:
        """Draw block, braces and base, each with visible motion; return a note on the factors of angle and displacement."""
        limit = float(np.abs(self.angles).max()) if system.braces is None else system.braces.angle
        factor = 1.0 if limit == 0 or limit > 0.35 else _round(0.35 / limit)
        brace = None if system.braces is None else factor * block.radians(limit)
        moved, far, drift = base_displacement(system.forcing, block, self.times)
        largest = far / block.height
        base_factor = 1.0 if largest == 0 else _round(min(max(largest, 0.08), 0.3) / largest)
        self.scene = Scene(ax, block, factor * block.radians(self.angles), base_factor * moved, brace)
        moves = f"displacement of the base {_said(base_factor)}"
        if drift is not None:
            size = f"{drift:.2g} m" if to_scale else f"{drift / block.height:.2g} heights"
            moves = f"base displacement {_said(base_factor)}, drift {size} at the end".replace("-", "−")
        return f"block {block.height / block.width:.3g} : 1, angle {_said(factor)}\n{moves}"

    def frames(self) -> Iterator[NDArray]:
        """Yield the frames as RGB arrays; only moving parts are drawn again."""
        canvas = FigureCanvasAgg(self.figure)
        canvas.draw()
        still = canvas.copy_from_bbox(self.figure.bbox)
        shown_times, shown_angles = self.shown.time(self.times), self.shown.angle(self.angles)
        for frame, (time, angle) in enumerate(zip(shown_times, shown_angles, strict=True)):
            canvas.restore_region(still)
            self.dot.set_data([time], [angle])
            self.cursor.set_xdata([time, time])
            reading = self.shown.reading.format(time, self.digits, angle, self.number)
            self.reading.set_text(reading.replace("-", "−"))
            for part in (*self.scene.move(frame), self.cursor, self.dot, self.reading):
                self.figure.draw_artist(part)
            yield np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _number(largest: float) -> str:
    """Return the format of angles up to `largest`: three significant digits, and zero without a minus sign."""
    if 0 < largest < 1e-6:
        return "+.2e"
    return f"+z.{max(2, 2 - math.floor(math.log10(largest))) if largest else 2}f"


def _round(factor: float) -> float:
    """Return the nearest of 1, 2 and 5 times a power of ten."""
    decade = 10.0 ** math.floor(math.log10(factor))
    return decade * min((1.0, 2.0, 5.0, 10.0), key=lambda step: abs(math.log(factor / (decade * step))))


def _said(factor: float) -> str:
    return "to scale" if factor == 1 else f"× {factor:.6g}"
