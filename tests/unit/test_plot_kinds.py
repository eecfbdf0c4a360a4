"""Every response type has a distinct colour, also for readers who cannot see red or green."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb

import rocking as rk
from rocking.plot.parts.legend import COLOURS, LOOKS, looks

# Machado, Oliveira and Fernandes (2009), IEEE Trans. Vis. Comput. Graph. 15: at full severity, on linear RGB.
SEEN = {
    "all colours": np.eye(3),
    "no red": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "no green": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
}
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def lab(seen, colour):
    """CIE L*a*b* of an sRGB colour."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    xyz = XYZ @ np.clip(seen @ linear, 0, 1) / XYZ.sum(axis=1)
    x, y, z = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def test_every_kind_has_a_colour():
    assert set(COLOURS) == set(rk.Kind)


@pytest.mark.parametrize("who", SEEN)
def test_no_two_colours_are_closer_than_ten_times_what_can_just_be_told(who):
    """A difference of 2.3 is just noticeable."""
    colours = {*COLOURS.values(), *(look.colour for look in LOOKS)}
    seen = [lab(SEEN[who], colour) for colour in colours]
    assert min(np.linalg.norm(one - other) for one, other in combinations(seen, 2)) > 23


def test_looks_differ_in_colour_and_in_mark():
    assert len({look.colour for look in LOOKS}) == len(LOOKS)
    assert len({(look.marker, look.hollow) for look in LOOKS}) == len(LOOKS)


def test_every_kind_period_and_symmetry_has_its_look():
    kinds = np.arange(len(rk.Kind), dtype=np.uint8)
    no = np.zeros(len(kinds), int)
    names = [LOOKS[number].name for number in looks(kinds, no + 1, no + 1)]
    assert names == ["period 1" if kind == "periodic" else kind for kind in rk.Kind]
    assert looks(np.array([255], np.uint8), no[:1], no[:1]) == 255
