"""Frames as a GIF or an MP4, written completely or not at all."""

import errno
from collections.abc import Iterator
from contextlib import suppress
from itertools import combinations
from pathlib import Path

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray
from PIL import Image

from rocking.model.files import replacing
from rocking.plot.parts import style
from rocking.plot.parts.save import check_path

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
