"""Drawing of the block on its base, its animation, and the files of films."""

from __future__ import annotations

import errno
import math
from collections.abc import Iterator
from contextlib import suppress
from itertools import combinations
from pathlib import Path

import numpy as np
from attrs import evolve
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Arc, Polygon, Rectangle
from matplotlib.text import Text
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray
from PIL import Image

from rocking.model.block import Block
from rocking.model.files import replacing
from rocking.model.result import in_units_of
from rocking.model.system import System
from rocking.model.validation import instance, refuse_if, within
from rocking.model.verdict import Outcome
from rocking.motion.motion import Motion, has_cycles, time_of_fall
from rocking.plot import palette, style
from rocking.plot.axes import units_of
from rocking.plot.figures import check_path
from rocking.plot.motions import base_displacement, draw_history, settled, window


class Scene:
    """Block on a moving table, drawn frame by frame.

    Parameters
    ----------
    ax : Axes
        Axes to draw into; they get equal scales and no frame.
    block : Block
        Block that gives the proportions.
    angles, base : arrays of shape (frames,)
        Angle of the block (rad, clockwise positive) and displacement of the table (m), as drawn.
    brace : float, optional
        Angle (rad) at which the braces stop the block, as drawn. Default: no braces.
    """

    def __init__(
        self, ax: Axes, block: Block, angles: NDArray, base: NDArray, brace: float | None = None
    ) -> None:
        self.base = base
        self.outlines = np.array([corners(block.height, block.width, angle) for angle in angles])
        deep, post = 0.1 * block.height, 0.03 * block.height
        contact = None if brace is None else block.width / 2 + block.height * math.sin(brace)
        reach = np.abs([self.outlines[..., 0].min(), self.outlines[..., 0].max()])
        left, right = np.maximum(reach, (contact or 0.0) + post) + 0.15 * block.height
        far = float(np.abs(base).max())
        self.shift = Affine2D()
        self.body = Polygon(
            self.outlines[0], facecolor=style.BLOCK, edgecolor=style.INK, linewidth=style.LINE
        )
        self.parts: list[Artist] = [
            Rectangle((-left, -deep), left + right, deep, facecolor=style.TABLE),
            self.body,
        ]
        if block.wall is not None:
            self.parts.append(wall_of(block))
        if contact is not None:
            for side in (-contact - post, contact):
                self.parts.append(Rectangle((side, 0), post, 1.04 * block.height, facecolor=style.BRACE))
        # This mark passes the marks on the ground and shows the motion of the table.
        self.parts.append(Line2D([0], [-0.6 * deep], marker="v", color=style.IMPACT, markersize=8))
        self.centres = np.array([mass_centre(block, outline) for outline in self.outlines])
        self.centre = Line2D(*self.centres[:1].T, marker="o", color=style.MOTION, markersize=6)
        if block.is_unsymmetric:
            self.parts.append(self.centre)
        feet = self.outlines[:, :2].mean(axis=1)
        self.restrainers = np.stack([np.zeros_like(feet) - (0.0, deep), feet], axis=1)
        self.restrainer = restrainer_of(*self.restrainers[0])
        if block.restrainer is not None:
            self.parts.append(self.restrainer)
        for part in self.parts:
            ax.add_artist(part)
            part.set_transform(self.shift + ax.transData)
            part.set_animated(True)
        _ground(ax, deep, 10 * block.height)
        top = 1.02 * max(float(self.outlines[..., 1].max()), 1.04 * block.height)
        ax.margins(0)
        ax.update_datalim([(-left - far, -2 * deep), (right + far, top)])
        ax.set_aspect("equal", adjustable="datalim")
        ax.set_axis_off()

    def move(self, frame: int) -> list[Artist]:
        """Place block and table for a frame; return the artists in the order in which they are drawn."""
        self.shift.clear().translate(self.base[frame], 0.0)
        self.body.set_xy(self.outlines[frame])
        self.centre.set_data(*self.centres[frame : frame + 1].T)
        self.restrainer.set_data(*self.restrainers[frame].T)
        return self.parts


def wall_of(block: Block) -> Rectangle:
    """Return the wall beside a block, hatched."""
    thick = 0.06 * block.height
    corner = -block.width / 2 - thick, 0.0
    return Rectangle(
        corner,
        thick,
        1.04 * block.height,
        facecolor=style.TABLE,
        edgecolor=style.INK,
        hatch="////",
        linewidth=style.THIN,
        gid="wall",
    )


def restrainer_of(anchor: NDArray, foot: NDArray) -> Line2D:
    """Return the restrainer between its anchor in the base and the middle of the foot of a block, (x, y) in m each."""
    return Line2D(*np.array([anchor, foot]).T, color=style.BRACE, linewidth=2 * style.LINE, gid="restrainer")


def _ground(ax: Axes, deep: float, far: float) -> None:
    """Draw the ground with a mark at each tenth of the block's height; the mark at the origin is longer."""
    ax.axhline(-deep, color=style.INK, linewidth=style.LINE)
    marks = np.arange(-far, far, deep)
    lengths = np.where(np.abs(marks) < deep / 2, 0.7, 0.3) * deep
    lines = [[(mark, -deep - length), (mark, -deep)] for mark, length in zip(marks, lengths, strict=True)]
    ax.add_collection(LineCollection(lines, color=style.INK, linewidth=style.THIN), autolim=False)


def corners(height: float, width: float, angle: float) -> NDArray:
    """Return the corners of a block tilted by `angle` (rad, clockwise positive).

    Positive angles turn the block about its right corner O, negative angles about its left corner O' (Eqs. (1a), (1b) of
    Yim & Lin 1991). The origin is the middle of the foot at rest.

    Returns
    -------
    array of shape (4, 2)
        Foot left O', foot right O, top right and top left, m.
    """
    upright = np.array([[-width / 2, 0.0], [width / 2, 0.0], [width / 2, height], [-width / 2, height]])
    pivot = upright[1] if angle >= 0 else upright[0]
    cosine, sine = np.cos(angle), np.sin(angle)
    return pivot + (upright - pivot) @ np.array([[cosine, -sine], [sine, cosine]])


def mass_centre(block: Block, outline: NDArray) -> NDArray:
    """Return the mass centre (2,) of a block whose corners are those of `corners`, m."""
    left, right, _, top = outline
    along, up = (right - left) / block.width, (top - left) / block.height
    return np.asarray((left + right) / 2 + block.offset * along + block.centre_height * up)


COLOURS = ("white", style.INK, style.TABLE, style.BLOCK, style.IMPACT, style.BRACE, style.MOTION, style.GUIDE)


def check_film(path: str | Path) -> Path:
    """Return `path` if it can become an animation; raise before any computation otherwise."""
    return check_path(path, tuple(WRITERS))


def write_film(path: Path, frames: Iterator[NDArray], fps: float) -> Path:
    """Write RGB frames to `path`, whose suffix selects .gif or .mp4.

    Frames have the shape (height, width, 3); height and width are multiples of 16. A GIF counts time in hundredths of a
    second, so that it runs at exactly `fps` only if `fps` divides 100.
    """
    with replacing(path) as partial:
        WRITERS[path.suffix.lower()](partial, frames, fps)
    return path


def _gif(path: Path, frames: Iterator[NDArray], fps: float) -> None:
    # One palette for all frames avoids flicker, and unchanged regions need no space.
    palette = _palette()
    images = (Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    # The file is opened here because Pillow leaves a file open when it is interrupted.
    with path.open("wb") as file:
        next(images).save(
            file, format="GIF", save_all=True, append_images=images, duration=10 * round(100 / fps), loop=0
        )


def _palette() -> Image.Image:
    """Return the palette of an animation: its exact colours, and blends of two of them, as at the edges of shapes.

    Pillow rounds red, green and blue down to multiples of 4 before it looks for the nearest colour. Each is therefore
    off by up to 3. Blends more than twice as far from every colour leave the colours exact.
    """
    colours = [np.round(255 * np.array(to_rgb(colour))) for colour in COLOURS]
    exact = np.array(colours)
    for one, other in combinations(exact, 2):
        blends = (np.round(one + share * (other - one)) for share in np.linspace(0, 1, 9)[1:-1])
        colours += [blend for blend in blends if np.linalg.norm(exact - blend, axis=1).min() > 11]
    palette = Image.new("P", (1, 1))
    palette.putpalette(np.array(colours, dtype=np.uint8).tobytes())
    return palette


def _mp4(path: Path, frames: Iterator[NDArray], fps: float) -> None:
    from imageio_ffmpeg import count_frames_and_secs, write_frames

    first = next(frames)
    height, width, _ = first.shape
    writer = write_frames(str(path), (width, height), fps=fps, quality=7, ffmpeg_log_level="fatal")
    sent = 1
    try:
        writer.send(None)
        writer.send(first.tobytes())
        for frame in frames:
            writer.send(frame.tobytes())
            sent += 1
    except OSError as error:
        raise OSError(errno.EIO, "ffmpeg has ended") from error
    finally:
        writer.close()
    # the exit code of ffmpeg is not available; on a full disk it leaves an incomplete file
    with suppress(RuntimeError):
        if count_frames_and_secs(str(path))[0] == sent:
            return
    raise OSError(errno.EIO, "ffmpeg has not written every frame")


WRITERS = {".gif": _gif, ".mp4": _mp4}


STOUT = Block(height=2.0, width=1.0)
# Base motion and angle: readable on the colour of the block.
SHAKEN = palette.SERIES[3]


def schematic(ax: Axes | None = None, block: Block | None = None, *, lean: float = 0.5) -> Axes:
    """Draw the block of Eq. (1) (Yim & Lin 1991) tilted about its corner O, with H, B, R, θ, θcr, O, O' and the base motion.

    Parameters
    ----------
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block that gives the proportions. Default: a stout block of 2 to 1, whose angles are large enough to see.
    lean : float
        Angle drawn, as a fraction of the critical angle, in [−1, 1]. Default: 0.5.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If `lean` lies outside its range.

    See Also
    --------
    animation : Animate a motion of the block.

    Notes
    -----
    Angles and the base acceleration a_g are positive as drawn: clockwise, and to the right. A base accelerated to the
    right therefore tilts the block to the left.

    Examples
    --------
    >>> import rocking as rk
    >>> ax = rk.plot.schematic(block=rk.Block(height=3.0, width=1.0))
    >>> ax.get_aspect()
    1.0
    """
    block = STOUT if block is None else instance("block", block, Block)
    height, width = block.height, block.width
    lean = within("lean", lean, -1.0, 1.0)
    angle = lean * block.critical_angles[lean < 0]
    if block.wall is not None:
        refuse_if(lean < 0.0, "lean", "be 0 or more for a block against a wall", lean)
    tilted = corners(height, width, angle)
    ax = style.own(ax, height=3.6)
    _base(ax, height, width)
    if block.wall is not None:
        ax.add_patch(wall_of(block))
    ax.add_patch(
        Polygon(tilted, facecolor=style.BLOCK, edgecolor=style.INK, linewidth=style.LINE, gid="block")
    )
    if block.restrainer is not None:
        ax.add_line(restrainer_of(np.array([0.0, -0.16 * height]), tilted[:2].mean(axis=0)))
    _sides(ax, tilted, height, right=block.wall is not None)
    _centre(ax, tilted, mass_centre(block, tilted), height, both=block.is_unsymmetric)
    _angles(ax, tilted, height, block, angle)
    for corner, name in ((tilted[1], "$O$"), (tilted[0], "$O'$")):
        ax.plot(*corner, "o", color=style.INK, markersize=3.5)
        _write(ax, name, (corner[0], -0.08 * height))
    ax.set_aspect("equal")
    ax.set_axis_off()
    return ax


def _base(ax: Axes, height: float, width: float) -> None:
    half, deep = width / 2 + 0.45 * height, 0.16 * height
    ax.add_patch(Rectangle((-half, -deep), 2 * half, deep, facecolor=style.TABLE, edgecolor="none"))
    ax.plot([-half, half], [0, 0], color=style.INK, linewidth=style.LINE)
    ax.set_xlim(-half, half)
    ax.set_ylim(-2.5 * deep, 1.3 * height)
    _arrow(ax, (-0.22 * height, -1.4 * deep), (0.22 * height, -1.4 * deep), SHAKEN, "-|>")
    _write(ax, r"$a_g = a_x \cos(\omega t + \varphi)$", (0.0, -2.1 * deep), SHAKEN)


def _sides(ax: Axes, tilted: NDArray, height: float, *, right: bool) -> None:
    """Draw the dimension lines: H along the left or the right side of the block, B above its top."""
    foot_left, foot_right, top_right, top_left = tilted
    gap = 0.08 * height
    side = (foot_right, top_right, foot_left) if right else (foot_left, top_left, foot_right)
    for first, last, opposite, name in (
        (*side, "$H$"),
        (top_left, top_right, foot_left, "$B$"),
    ):
        outward = (first - opposite) / np.linalg.norm(first - opposite)
        _arrow(ax, first + gap * outward, last + gap * outward, style.INK, "<|-|>")
        _write(ax, name, (first + last) / 2 + 1.9 * gap * outward)


def _centre(ax: Axes, tilted: NDArray, centre: NDArray, height: float, *, both: bool) -> None:
    """Draw the centre of mass, its distance R from the corner O, for unequal sides also that from O', and the weight."""
    pivot = tilted[1]
    for corner in (tilted[1], tilted[0])[: 1 + both]:
        ax.plot(*zip(corner, centre, strict=True), color=style.MOTION, linewidth=style.LINE)
    if both:
        _write(
            ax,
            "$R_2$",
            tilted[0] + 0.4 * (centre - tilted[0]) + (0.04 * height, -0.05 * height),
            style.MOTION,
        )
    _write(
        ax, "$R_1$" if both else "$R$", pivot + 0.4 * (centre - pivot) - (0.06 * height, 0.0), style.MOTION
    )
    _arrow(ax, centre, centre - (0.0, 0.22 * height), style.INK, "-|>")
    _write(ax, "$Mg$", centre - ((0.0, -0.08 * height) if both else (0.09 * height, 0.17 * height)))
    ax.plot(*centre, "o", color=style.MOTION, markersize=4)


def _angles(ax: Axes, tilted: NDArray, height: float, block: Block, angle: float) -> None:
    """Draw θ between the vertical through O and the tilted side, and θcr between that side and the line to the centre of mass.

    For unequal sides also θcr of the other side, at O'.
    """
    pivot = tilted[1]
    ax.plot(
        [pivot[0]] * 2,
        [0.0, 1.1 * height],
        color=style.INK,
        linestyle="dotted",
        linewidth=style.LINE,
    )
    side = 90.0 - math.degrees(angle)
    right, left = map(math.degrees, block.critical_angles)
    own = r"\theta_{\mathrm{cr},1}" if block.is_unsymmetric else r"\theta_\mathrm{cr}"
    arcs = [
        (pivot, 0.72 * height, side, 90.0, r"$\theta$", SHAKEN),
        (pivot, 0.36 * height, side, side + right, f"${own}$", style.MOTION),
    ]
    if block.is_unsymmetric:
        arcs.append((tilted[0], 0.36 * height, side - left, side, r"$\theta_{\mathrm{cr},2}$", style.MOTION))
    for pivot, radius, side, last, name, colour in arcs:
        ax.add_patch(
            Arc(
                tuple(pivot),
                2 * radius,
                2 * radius,
                theta1=side,
                theta2=last,
                color=colour,
                linewidth=style.LINE,
            )
        )
        middle = math.radians((side + last) / 2)
        _write(
            ax,
            name,
            pivot + (radius + 0.08 * height) * np.array([math.cos(middle), math.sin(middle)]),
            colour,
            style.BLOCK,
        )


def _arrow(ax: Axes, tail, head, colour: str, shape: str) -> None:
    how = {"arrowstyle": shape, "color": colour, "linewidth": style.LINE, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", head, tail, arrowprops=how | {"mutation_scale": 8})


def _write(ax: Axes, text: str, place, colour: str = style.INK, behind: str = "none") -> None:
    box = {"facecolor": behind, "edgecolor": "none", "pad": 0.5}
    ax.text(
        place[0], place[1], text, color=colour, fontsize=style.TEXT + 1, ha="center", va="center", bbox=box
    )


NOMINAL = Block(height=2.0, width=0.5)
CYCLES_SHOWN, DECAY_SHOWN = 10, 30
# Time before the lift-off and after the fall, as a share of the time between.
ROOM = 0.08
SIZE, DOTS = (6.4, 5.6), 100


def animation(
    result: Motion,
    path: str | Path,
    block: Block | None = None,
    *,
    seconds: float = 10.0,
    fps: float = 25.0,
    cycles: tuple[float, float] | None = None,
) -> Path:
    """Animate the block on its moving base, above its time history, as a GIF or an MP4.

    Parameters
    ----------
    result : Motion
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
    A block in the film never slides. `Motion.validity` states the friction that this needs.

    Examples
    --------
    >>> import rocking as rk, tempfile
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     rk.plot.animation(rk.simulate(system, cycles=20), f"{folder}/block.gif", seconds=0.4).name
    'block.gif'
    """
    instance("result", result, Motion)
    body = NOMINAL if block is None else instance("block", block, Block)
    path = check_film(path)
    count = max(2, round(within("seconds", seconds, 0.1, 600.0) * within("fps", fps, 1.0, 100.0)))
    start, stop = _window(result, body, cycles)
    return write_film(path, _Film(result, block, np.linspace(start, stop, count), seconds).frames(), fps)


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
        body = evolve(block or in_units_of(motion.block, NOMINAL), wall=motion.system.wall)
        self.times, self.units = times, units_of(block)
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
            time[-1] = self.units.time(times[-1])
            curve.set_data(time, np.clip(angle, self.units.angle(-flat), self.units.angle(flat)))
            below.set_xlim(self.units.time(times[0]), time[-1])
            most = 1.5 * min(max(motion.peak, 1.0), flat)
            least = -most if motion.system.wall is None else -0.05 * most
            below.set_ylim(self.units.angle(least), self.units.angle(most))
        self.cursor = below.axvline(0.0, color=style.IMPACT, linewidth=style.LINE, animated=True)
        (self.dot,) = below.plot([], [], "o", color=style.IMPACT, markersize=7, animated=True, zorder=5)
        self.reading = self._write(0.02, "", style.TEXT + 4, ha="left", animated=True)
        interval = float(self.units.time(times[1] - times[0]))
        self.digits = max(1, math.ceil(-math.log10(interval)))
        self.number = _number(float(self.units.angle(np.abs(self.angles).max())))
        pace = interval * (len(times) - 1) / seconds
        notes += f"\n1 s of film is {pace:.3g} {self.units.time_unit}"
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
        shown_times, shown_angles = self.units.time(self.times), self.units.angle(self.angles)
        for frame, (time, angle) in enumerate(zip(shown_times, shown_angles, strict=True)):
            canvas.restore_region(still)
            self.dot.set_data([time], [angle])
            self.cursor.set_xdata([time, time])
            reading = self.units.reading.format(time, self.digits, angle, self.number)
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
