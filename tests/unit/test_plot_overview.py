"""A notebook shows a motion as a figure above its printed line, for every type of recording."""

import base64
import io
import re

import numpy as np
import pytest
from PIL import Image

import rocking as rk

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
FALLING = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
FREE = rk.System(rk.Harmonic(amplitude=0.0, period=1.0), restitution=0.9)


@pytest.mark.parametrize("record", ["all", "section", "none"])
@pytest.mark.parametrize("system", [SYSTEM, FALLING])
def test_notebook_shows_a_picture_that_is_not_blank(system, record):
    html = rk.simulate(system, cycles=60, record=record)._repr_html_()
    (encoded,) = re.findall(r'src="data:image/png;base64,([^"]+)"', html)
    image = Image.open(io.BytesIO(base64.b64decode(encoded)))
    assert image.format == "PNG"
    assert np.asarray(image.convert("L")).std() > 10


def test_long_bounded_motion_is_shown_by_its_last_cycles():
    history, _ = rk.plot.overview(rk.simulate(SYSTEM, cycles=200)).axes
    assert history.get_xlim() == (170.0, 200.0)


def test_overturning_is_shown_from_the_start():
    history, _ = rk.plot.overview(rk.simulate(FALLING, cycles=200)).axes
    assert history.get_xlim()[0] == 0.0


def test_block_gives_si_axes():
    figure = rk.plot.overview(rk.simulate(SYSTEM, cycles=20), rk.Block(height=2.0, width=0.5))
    assert [ax.get_xlabel()[-4:] for ax in figure.axes] == [" (s)", " (°)"]


@pytest.mark.parametrize("cycles", [200, 10_000])
def test_decay_is_shown_until_shortly_after_its_last_impact(cycles):
    motion = rk.simulate(FREE, rk.State(angle=0.5), cycles=cycles)
    last = motion.events["time"][-1]
    history, _ = rk.plot.overview(motion).axes
    assert history.get_xlim() == pytest.approx((0.0, 1.15 * last))


def test_rest_under_a_shaken_base_is_shown_for_a_cycle_at_least():
    shaken = rk.System(rk.Harmonic(amplitude=0.3, period=6.0), restitution=0.5)
    motion = rk.simulate(shaken, rk.State(angle=0.1), cycles=50)
    last = motion.events["time"][-1]
    assert motion.outcome == "at-rest"
    history, _ = rk.plot.overview(motion).axes
    assert history.get_xlim() == pytest.approx((0.0, last + 6.0))


def test_block_that_never_rocks_is_shown_whole():
    history, portrait = rk.plot.overview(rk.simulate(FREE, cycles=5)).axes
    assert history.get_xlim() == (0.0, 5.0)
    assert portrait.lines


RECORD = rk.System(rk.PiecewiseLinear([0.0, 1.5, -1.5, 0.0], step=0.4), restitution=0.9)


def test_record_stands_below_the_time_history_beside_the_phase_portrait():
    motion = rk.simulate(RECORD)
    above, below, right = rk.plot.overview(motion).axes
    assert [ax.get_title(loc="left") for ax in (above, below, right)] == ["(a)", "(b)", "(c)"]
    assert above.get_xlim() == below.get_xlim() == (0.0, motion.duration)
    assert right.get_xlabel() == r"angle $\Theta = \theta/\theta_\mathrm{cr}$"


@pytest.mark.parametrize("record", ["all", "none"])
def test_notebook_shows_a_motion_under_a_record(record):
    assert "data:image/png;base64," in rk.simulate(RECORD, record=record)._repr_html_()
