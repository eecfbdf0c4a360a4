"""Films show what the motion does: every frame there, the block at its angle, the base where its acceleration puts it."""

import itertools
import math
import subprocess

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image, ImageSequence

import rocking as rk
from rocking.plot.geometry import corners
from rocking.plot.scene import Scene

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
BRACED = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0))
FALLING = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
SCENE_ROWS = slice(60, 350)


def gif_frames(path):
    with Image.open(path) as film:
        return [np.asarray(frame.convert("RGB"), dtype=int) for frame in ImageSequence.Iterator(film)]


def mp4_frames(path):
    decode = [
        imageio_ffmpeg.get_ffmpeg_exe(),
        "-v",
        "error",
        "-i",
        path,
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-",
    ]
    raw = subprocess.run(decode, check=True, capture_output=True).stdout
    return list(np.frombuffer(raw, np.uint8).reshape(-1, 560, 640, 3))


def pixels(frame, red, green, blue, rows=SCENE_ROWS):
    """Columns and rows (upward) of the scene's pixels near a colour."""
    distance = np.abs(frame[rows] - (red, green, blue)).sum(axis=2)
    y, x = np.nonzero(distance < 40)
    return x, -y


def wood(frame):
    return pixels(frame, 0xE8, 0xC0, 0x7D)


def lean(frame):
    """Angle of the block from the vertical, clockwise, by the longest axis of its pixels."""
    _, vectors = np.linalg.eigh(np.cov(*wood(frame)))
    x, y = vectors[:, 1]
    return math.atan(x / y)


@pytest.mark.parametrize("read", [gif_frames, mp4_frames])
def test_film_has_every_frame_and_each_differs_from_the_one_before(tmp_path, read):
    path = tmp_path / f"a.{read.__name__[:3]}"
    assert rk.plot.animation(rk.simulate(SYSTEM, cycles=20), path, seconds=1.2, fps=20) == path
    frames = read(path)
    assert len(frames) == 24
    assert {frame.shape for frame in frames} == {(560, 640, 3)}
    assert all(frame.std() > 10 for frame in frames)
    assert all((one != other).any() for one, other in itertools.pairwise(frames))


def test_film_lasts_as_long_as_asked(tmp_path):
    motion = rk.simulate(SYSTEM, cycles=20)
    _, seconds = imageio_ffmpeg.count_frames_and_secs(
        str(rk.plot.animation(motion, tmp_path / "a.mp4", seconds=1.5))
    )
    assert seconds == pytest.approx(1.5, abs=0.03)
    with Image.open(rk.plot.animation(motion, tmp_path / "a.gif", seconds=1.5, fps=20)) as film:
        assert sum(frame.info["duration"] for frame in ImageSequence.Iterator(film)) == 1500


def test_block_leans_as_the_motion_says(tmp_path):
    motion = rk.simulate(BRACED, cycles=30)
    block = rk.Block(height=2.0, width=0.6)
    path = rk.plot.animation(motion, tmp_path / "a.gif", block, seconds=1.6, cycles=(10, 14))
    expected = np.arctan(0.3) * motion.at(np.linspace(20, 28, 40))[0]
    seen = [lean(frame) for frame in gif_frames(path)]
    # a side of the block is some 250 pixels long
    np.testing.assert_allclose(seen, expected, rtol=0, atol=1 / 250)


def test_base_moves_against_its_acceleration(tmp_path):
    motion = rk.simulate(BRACED, cycles=30)
    frames = gif_frames(rk.plot.animation(motion, tmp_path / "a.gif", seconds=1.6, cycles=(10, 14)))
    place = np.array([pixels(frame, 0xD5, 0x5E, 0x00)[0].mean() for frame in frames])
    acceleration = np.cos(np.pi * np.linspace(20, 28, 40))
    assert np.corrcoef(place, -acceleration)[0, 1] > 0.999
    assert np.ptp(place) > 20


def test_displacement_of_the_base_is_to_scale_where_the_picture_says_so():
    # amplitude a_x/ω² = 0.5 m, a quarter of the block's height: no factor is needed
    block = rk.Block(height=2.0, width=0.5)
    from rocking.plot.animation import _Film

    motion = rk.simulate(block.system(displacement=0.5, frequency_hz=0.5), cycles=4)
    film = _Film(motion, block, np.linspace(0, motion.duration, 200), 1.0)
    assert "displacement of the base to scale" in film.figure.texts[1].get_text()
    assert np.abs(film.scene.base).max() == pytest.approx(0.5, rel=1e-3)


def test_small_angles_are_exaggerated_and_the_picture_says_by_how_much():
    from rocking.plot.animation import NOMINAL, _Film

    motion = rk.simulate(rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925), cycles=60)
    film = _Film(motion, None, np.linspace(50, 60, 500), 1.0)
    assert "angle × 5" in film.figure.texts[1].get_text()
    largest = 5 * float(np.abs(motion.at(film.times)[0]).max()) * NOMINAL.critical_angle
    expected = max(corners(NOMINAL.height, NOMINAL.width, angle)[:, 1].max() for angle in (largest, -largest))
    assert film.scene.outlines[..., 1].max() == pytest.approx(expected)


def test_fall_is_shown_until_the_block_lies_flat(tmp_path):
    block = rk.Block(height=2.0, width=0.5)
    frames = gif_frames(
        rk.plot.animation(rk.simulate(FALLING, cycles=50), tmp_path / "a.gif", block, seconds=2)
    )
    x, y = wood(frames[-1])
    # the outline takes up to 4 of the block's 63 pixels across
    assert np.ptp(x) / np.ptp(y) == pytest.approx(4.0, rel=4 / 63)
    assert abs(lean(frames[0])) < 0.05


def test_block_that_starts_beyond_the_fall_lies_flat_at_once(tmp_path):
    motion = rk.simulate(FALLING, rk.State(angle=7.0), cycles=5)
    x, y = wood(gif_frames(rk.plot.animation(motion, tmp_path / "a.gif", seconds=0.2))[0])
    assert np.ptp(x) > 3 * np.ptp(y)


@pytest.mark.parametrize("side", [-1, 1])
def test_block_touches_the_brace_with_its_upper_corner(side):
    block = rk.Block(height=2.0, width=0.5)
    figure, (ax,) = rk.plot.panels()
    scene = Scene(ax, block, np.array([side * 0.2]), np.zeros(1), brace=0.2)
    figure.canvas.draw()
    posts = [part for part in scene.parts if getattr(part, "get_height", lambda: 0)() > block.height]
    faces = {
        -1: max(post.get_x() + post.get_width() for post in posts if post.get_x() < 0),
        1: max(p.get_x() for p in posts),
    }
    reach = scene.outlines[0][:, 0].max() if side > 0 else scene.outlines[0][:, 0].min()
    assert reach == pytest.approx(faces[side])


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_interrupted_film_leaves_what_was_there(tmp_path, monkeypatch, suffix):
    path = tmp_path / f"a.{suffix}"
    path.write_bytes(b"old")
    move = Scene.move

    def interrupted(self, frame):
        if frame == 5:
            raise KeyboardInterrupt
        return move(self, frame)

    monkeypatch.setattr(Scene, "move", interrupted)
    with pytest.raises(KeyboardInterrupt):
        rk.plot.animation(rk.simulate(SYSTEM, cycles=5), path, seconds=1)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == b"old"


@pytest.mark.parametrize(
    ("name", "how", "message"),
    [
        ("a.avi", {}, r"^path must end in \.gif, \.mp4; got '.*a\.avi'$"),
        ("a.gif", {"seconds": 0}, r"^seconds must lie in \[0\.1, 600\]; got 0$"),
        ("a.gif", {"fps": 1000}, r"^fps must lie in \[1, 100\]; got 1000$"),
        ("a.gif", {"cycles": (3, 9)}, r"^cycles must lie in \[0, 5\]; got 9$"),
    ],
)
def test_wrong_wishes_are_refused_in_one_line(tmp_path, name, how, message):
    with pytest.raises(ValueError, match=message):
        rk.plot.animation(rk.simulate(SYSTEM, cycles=5), tmp_path / name, **how)
    assert not list(tmp_path.iterdir())
