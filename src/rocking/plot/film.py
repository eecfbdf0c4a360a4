"""Frames into a GIF or an MP4: whole or not at all."""

from collections.abc import Iterator
from pathlib import Path

from numpy.typing import NDArray
from PIL import Image

from rocking.model import check_writable, replacing


def check_film(path: str | Path) -> Path:
    """Refuses, in one line and before any work, a path that cannot become a film."""
    return check_writable("path", path, suffixes=tuple(WRITERS))


def write_film(path: Path, frames: Iterator[NDArray], fps: float) -> Path:
    """Writes RGB frames (height, width, 3; both multiples of 16) to `path`, whose suffix chooses between .gif and .mp4.

    A GIF counts time in hundredths of a second, so it runs at exactly `fps` only if that divides 100.
    """
    with replacing(path) as partial:
        WRITERS[path.suffix.lower()](partial, frames, fps)
    return path


def _gif(path: Path, frames: Iterator[NDArray], fps: float) -> None:
    first = Image.fromarray(next(frames))
    # One palette for all frames: nothing flickers, and what does not move costs nothing.
    palette = first.quantize(64, method=Image.Quantize.MAXCOVERAGE)
    rest = (Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    # Opened here, because Pillow leaves a file open when it is interrupted.
    with path.open("wb") as file:
        palette.save(
            file, format="GIF", save_all=True, append_images=rest, duration=10 * round(100 / fps), loop=0
        )


def _mp4(path: Path, frames: Iterator[NDArray], fps: float) -> None:
    from imageio_ffmpeg import write_frames

    first = next(frames)
    height, width, _ = first.shape
    writer = write_frames(str(path), (width, height), fps=fps, quality=7, ffmpeg_log_level="error")
    try:
        writer.send(None)
        writer.send(first.tobytes())
        for frame in frames:
            writer.send(frame.tobytes())
    finally:
        writer.close()


WRITERS = {".gif": _gif, ".mp4": _mp4}
