"""Animations: all frames, the block at its angle, and the base at the displacement of its acceleration."""

import itertools
import math
import re
import subprocess

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image, ImageSequence

import rocking as rk
from drawn import points
from rocking.plot import palette
from rocking.plot.film import NOMINAL, Scene, _Film, _window, corners

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
BRACED = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0))
FALLING = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
FREE = rk.System(rk.Harmonic(amplitude=0.0, period=1.0), restitution=0.9)
PUSHED = rk.System(rk.PiecewiseLinear([3.0, 3.0], step=2.0), restitution=0.9)
BLOCK = rk.Block(height=2.0, width=0.5)
FAST = rk.System(rk.Harmonic(amplitude=1000.0, period=0.0063), restitution=0.9)
SCENE_ROWS = slice(60, 350)


def gif_frames(path):
    with Image.open(path) as film:
        return [np.asarray(frame.convert("RGB"), dtype=int) for frame in ImageSequence.Iterator(film)]


def mp4_frames(path):
    how = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    decode = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-i", path, *how]
    raw = subprocess.run(decode, check=True, capture_output=True).stdout
    return list(np.frombuffer(raw, np.uint8).reshape(-1, 560, 640, 3))


def film_of(motion, block=None, count=200):
    window = _window(motion, block or NOMINAL, None)
    return window, _Film(motion, block, np.linspace(*window, count), 1.0)


def flat(frame):
    """How much wider than high the block is."""
    x, y = wood(frame)
    return np.ptp(x) / np.ptp(y)


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
def test_film_has_every_frame_lasts_as_requested_and_each_frame_differs_from_the_one_before(tmp_path, read):
    path = tmp_path / f"a.{read.__name__[:3]}"
    assert rk.plot.animation(rk.simulate(SYSTEM, cycles=20), path, seconds=1.2, fps=20) == path
    frames = read(path)
    assert len(frames) == 24
    assert {frame.shape for frame in frames} == {(560, 640, 3)}
    assert all(frame.std() > 10 for frame in frames)
    assert all((one != other).any() for one, other in itertools.pairwise(frames))
    assert seconds_of(path) == pytest.approx(1.2, abs=0.03)


def seconds_of(path):
    if path.suffix == ".mp4":
        return imageio_ffmpeg.count_frames_and_secs(str(path))[1]
    with Image.open(path) as film:
        return sum(frame.info["duration"] for frame in ImageSequence.Iterator(film)) / 1000


def test_block_leans_as_the_motion_says_and_the_base_moves_against_its_acceleration(tmp_path):
    motion, times = rk.simulate(BRACED, cycles=30), np.linspace(20, 28, 40)
    block = rk.Block(height=2.0, width=0.6)
    frames = gif_frames(rk.plot.animation(motion, tmp_path / "a.gif", block, seconds=1.6, cycles=(10, 14)))
    # a side of the block is some 250 pixels long
    expected = np.arctan(0.3) * motion.at(times)[0]
    np.testing.assert_allclose([lean(frame) for frame in frames], expected, rtol=0, atol=1 / 250)
    place = np.array([pixels(frame, *bytes.fromhex(palette.IMPACT[1:]))[0].mean() for frame in frames])
    assert np.corrcoef(place, -np.cos(np.pi * times))[0, 1] > 0.999
    assert np.ptp(place) > 20


def test_displacement_of_the_base_is_to_scale_where_the_picture_says_so():
    # amplitude a_x/ω² = 0.5 m, a quarter of the block's height: no factor is needed
    motion = rk.simulate(BLOCK.system(displacement=0.5, frequency_hz=0.5), cycles=4)
    film = _Film(motion, BLOCK, np.linspace(0, motion.duration, 200), 1.0)
    assert "displacement of the base to scale" in film.figure.texts[1].get_text()
    assert np.abs(film.scene.base).max() == pytest.approx(0.5, rel=1e-3)


def test_small_angles_are_exaggerated_and_the_picture_says_by_how_much():
    motion = rk.simulate(SYSTEM, cycles=60)
    film = _Film(motion, None, np.linspace(50, 60, 500), 1.0)
    assert "angle × 5" in film.figure.texts[1].get_text()
    largest = 5 * float(np.abs(motion.at(film.times)[0]).max()) * NOMINAL.critical_angle
    expected = max(corners(NOMINAL.height, NOMINAL.width, angle)[:, 1].max() for angle in (largest, -largest))
    assert film.scene.outlines[..., 1].max() == pytest.approx(expected)


@pytest.mark.parametrize("block", [None, BLOCK])
def test_film_of_a_block_against_a_wall_shows_the_wall_and_one_side(block):
    base = rk.PiecewiseLinear([-3.0, -3.0], step=2.0)
    motion = rk.simulate(rk.System(base, restitution=0.5, left=rk.Wall(0.5)))
    _, film = film_of(motion, block, count=20)
    assert [part.get_gid() for part in film.scene.parts].count("wall") == 1
    below = film.figure.axes[1]
    guides = [line.get_ydata()[0] for line in below.lines if line.get_gid() == "critical angle"]
    assert guides == [film.units.angle(1.0)]
    assert -0.15 < below.get_ylim()[0] / below.get_ylim()[1] < 0.0


@pytest.mark.parametrize("motion", [rk.simulate(FALLING, cycles=50), rk.simulate(PUSHED)])
def test_fall_is_shown_until_the_block_lies_flat(tmp_path, motion):
    frames = gif_frames(rk.plot.animation(motion, tmp_path / "a.gif", BLOCK, seconds=2, fps=10))
    # the outline takes up to 4 of the block's 63 pixels across
    assert flat(frames[-1]) == pytest.approx(4.0, rel=4 / 63)
    assert abs(lean(frames[0])) < 0.05


def test_block_that_starts_beyond_the_fall_lies_flat_at_once(tmp_path):
    motion = rk.simulate(FALLING, rk.State(angle=7.0), cycles=5)
    assert flat(gif_frames(rk.plot.animation(motion, tmp_path / "a.gif", seconds=0.2))[0]) > 3


@pytest.mark.parametrize("angle", [1.2, 5.0, 7.0])
def test_dot_lies_on_the_curve_of_a_block_that_starts_beyond_return(angle):
    motion = rk.simulate(
        rk.System(rk.Harmonic(amplitude=1.0, period=1.0), restitution=0.9), rk.State(angle=angle), cycles=50
    )
    _, film = film_of(motion, count=10)
    below = film.figure.axes[1]
    curve = points(below, "motion").T
    drawn = [(*film.dot.get_xdata(), *film.dot.get_ydata()) for _ in film.frames()]
    for time, height in drawn:
        assert height == pytest.approx(np.interp(time, *curve), abs=1e-3)
    assert 0 < drawn[0][1] < below.get_ylim()[1]


@pytest.mark.parametrize(
    ("motion", "window"),
    [
        (rk.simulate(FREE, rk.State(angle=0.5), cycles=200), (0.0, 21.296805)),
        (rk.simulate(FREE, rk.State(angle=0.5), cycles=10), (0.0, 10.0)),
        (rk.simulate(FREE, cycles=200), (170.0, 200.0)),
        (rk.simulate(SYSTEM, cycles=30), (20.0, 30.0)),
        (rk.simulate(FAST, cycles=200), (1.197, 1.26)),
    ],
    ids=["decay", "before rest", "still", "shaken", "fast"],
)
def test_film_shows_the_end_of_the_motion_unless_told_otherwise(motion, window):
    assert _window(motion, NOMINAL, None) == pytest.approx(window)


@pytest.mark.parametrize(
    ("system", "start"),
    [(FREE, 0.0), (FREE, 0.5), (rk.System(rk.Harmonic(1.0, period=1.0), 0.9), 5.0), (BRACED, 0.0)],
)
def test_colours_are_exact_and_the_same_in_every_frame(tmp_path, system, start):
    motion = rk.simulate(system, rk.State(angle=start), cycles=10)
    frames = gif_frames(rk.plot.animation(motion, tmp_path / "a.gif", seconds=2, fps=10))
    assert len(frames) == 20
    for frame in frames:
        whites = (frame == 255).all(axis=2)
        nearly = (frame > 245).all(axis=2) & ~whites
        assert whites.mean() > 0.6
        assert not nearly.any()
        for red, green, blue in [(0xE8, 0xC0, 0x7D), (0xCF, 0xCF, 0xCF)]:
            assert (frame == (red, green, blue)).all(axis=2).sum() > 2000


@pytest.mark.parametrize(
    ("system", "start", "block", "reading"),
    [
        (FAST, 0.0, None, "Θ = −0.00190"),
        (FREE, 0.5, None, "Θ = −0.098"),
        (FREE, 0.0, None, "Θ = +0.00"),
        (FREE, 1e-8, None, "Θ = −4.33e−09"),
        (BRACED, 0.0, BLOCK, "°"),
    ],
)
def test_reading_has_three_figures_of_the_largest_angle(system, start, block, reading):
    motion = rk.simulate(system, rk.State(angle=start), cycles=200)
    _, film = film_of(motion, block, count=5)
    said = [film.reading.get_text() for _ in film.frames()]
    assert any(reading in text for text in said)
    assert not any(text.rstrip("°").endswith(("−0.00", "−0.000")) for text in said)


@pytest.mark.parametrize("side", [-1, 1])
def test_block_touches_the_brace_with_its_upper_corner(side):
    figure, (ax,) = rk.plot.panels()
    scene = Scene(ax, BLOCK, np.array([side * 0.2]), np.zeros(1), brace=0.2)
    figure.canvas.draw()
    posts = [part for part in scene.parts if getattr(part, "get_height", lambda: 0)() > BLOCK.height]
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


def test_base_moves_as_the_record_integrated_twice():
    ground = rk.GroundMotion([0.0, 4.0, -5.0, 3.0, 0.0], step=0.2)
    motion = rk.simulate(BLOCK.system(ground, model="slender"))
    forcing, unit = motion.system.forcing, motion.block.acceleration(1.0) / BLOCK.frequency_parameter**2
    samples = forcing.step * np.arange(5)
    np.testing.assert_allclose(
        unit * forcing.displacement(samples), ground.displacement, rtol=1e-12, atol=1e-15
    )
    _, film = film_of(motion, BLOCK)
    moved = unit * forcing.displacement(film.times)
    factor = film.scene.base[-1] / moved[-1]
    np.testing.assert_allclose(film.scene.base, factor * moved, rtol=1e-12, atol=1e-12)
    drift = f"{ground.displacement[-1]:.2g}".replace("-", "−")
    assert f"drift {drift} m at the end" in film.figure.texts[1].get_text()


def test_displacement_between_the_samples_is_that_of_the_straight_segments():
    forcing = rk.PiecewiseLinear([0.5, 2.0, -1.0, 0.3], step=0.7, scale=1.3)
    times = np.linspace(0.0, 3.0, 200_001)
    base = np.where(times > forcing.duration, 0.0, forcing.acceleration(times))
    h = times[1]
    velocity = np.concatenate(([0.0], np.cumsum((base[1:] + base[:-1]) / 2 * h)))
    place = np.concatenate(([0.0], np.cumsum((velocity[1:] + velocity[:-1]) / 2 * h)))
    np.testing.assert_allclose(forcing.displacement(times), place, rtol=0, atol=1e-4)
    assert forcing.displacement(-1.0) == 0.0
    assert np.ptp(np.diff(forcing.displacement([2.1, 3.1, 4.1, 5.1]))) == pytest.approx(0.0, abs=1e-12)


def test_film_of_a_record_begins_before_the_lift_off_and_ends_after_rest():
    motion = rk.simulate(BLOCK.system(rk.example_ground_motion().scaled(pga=6.0), model="slender"))
    (start, stop), _ = film_of(motion, BLOCK, count=5)
    first, last = motion.events["time"][[0, -1]]
    assert 0 < start < first
    assert last < stop < motion.duration


def test_film_of_a_record_without_block_gives_the_drift_in_heights():
    _, film = film_of(rk.simulate(PUSHED))
    assert re.search(r"base displacement .*, drift \d\S* heights at the end", film.figure.texts[1].get_text())


def test_block_that_never_moves_under_a_record_is_filmed_for_its_length():
    motion = rk.simulate(BLOCK.system(rk.example_ground_motion(), model="slender"))
    window, film = film_of(motion, BLOCK, count=5)
    assert window == (0.0, motion.duration)
    assert not film.angles.any()
