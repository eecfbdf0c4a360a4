"""Files are complete and reproducible bit by bit, and the user's settings do not change."""

import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import rocking as rk

SYSTEM = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0))


def draw():
    motion = rk.simulate(SYSTEM, cycles=3000)
    figure, (left, right) = rk.plot.panels(columns=2)
    rk.plot.phase_portrait(motion, left, cycles=(0, 10))
    rk.plot.section(motion, right)
    return figure


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf", ".SVG"])
def test_same_figure_gives_same_bytes(tmp_path, suffix):
    first = rk.plot.save(draw(), tmp_path / f"a{suffix}").read_bytes()
    second = rk.plot.save(draw(), tmp_path / f"b{suffix}").read_bytes()
    assert first == second
    assert len(first) > 10_000


def test_png_has_the_resolution_asked_for(tmp_path):
    path = rk.plot.save(draw(), tmp_path / "a.png", dpi=100)
    with Image.open(path) as image:
        assert image.size == (720, 240)
        assert np.asarray(image.convert("L")).std() > 10


def test_axes_are_saved_with_their_whole_figure(tmp_path):
    figure = draw()
    whole = rk.plot.save(figure, tmp_path / "a.png").read_bytes()
    assert rk.plot.save(figure.axes[1], tmp_path / "b.png").read_bytes() == whole


def test_settings_of_the_user_stay_as_they_are(tmp_path):
    before = mpl.rcParams.copy()
    rk.plot.save(draw(), tmp_path / "a.svg")
    rk.plot.schematic()
    rk.plot.animation(rk.simulate(SYSTEM, cycles=5), tmp_path / "a.gif", seconds=0.1)
    assert dict(mpl.rcParams) == dict(before)


def test_no_window_system_is_asked_for():
    code = "import sys, rocking as rk; rk.plot.schematic(); sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_interrupted_write_leaves_what_was_there(tmp_path, monkeypatch):
    path = tmp_path / "a.png"
    path.write_bytes(b"old")

    def interrupted(self, target, **how):
        target.write_bytes(b"half a picture")
        raise KeyboardInterrupt

    monkeypatch.setattr(Figure, "savefig", interrupted)
    with pytest.raises(KeyboardInterrupt):
        rk.plot.save(Figure(), path)
    assert [file.name for file in tmp_path.iterdir()] == ["a.png"]
    assert path.read_bytes() == b"old"
