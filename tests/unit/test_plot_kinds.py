"""Every outcome and type has one colour in all figures, a colour of its own, also for readers who cannot see red or green."""

import re
from importlib.resources import files
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from attrs import evolve
from matplotlib.colors import to_hex, to_rgb

import rocking as rk
from rocking.explorer import ground_maps, texts
from rocking.explorer.refinement import Picture
from rocking.plot import palette
from rocking.plot.palette import COLOURS, LOOKS, looks

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


JUST_SEEN = 2.3
"""Difference in CIE L*a*b* that is just noticeable."""
OUTCOMES = {
    *(shade for look in LOOKS for shade in look.shades),
    *(palette.STANDS, *palette.OVERTURNED_AFTER, palette.UNCERTAIN),
}


def closest(who, some, others=None):
    """Least difference between two colours, or between one of some and one of others."""
    pairs = combinations(some, 2) if others is None else ((one, other) for one in some for other in others)
    return min(np.linalg.norm(lab(SEEN[who], one) - lab(SEEN[who], other)) for one, other in pairs)


@pytest.mark.parametrize("who", SEEN)
def test_colours_of_all_outcomes_shades_and_series_differ(who):
    assert closest(who, OUTCOMES) > 5 * JUST_SEEN
    assert closest(who, palette.SERIES) > 5 * JUST_SEEN
    pulse = [*palette.REST, palette.STANDS, *palette.OVERTURNED_AFTER]
    assert closest(who, [*pulse, *palette.UNDETERMINED]) > 7 * JUST_SEEN
    lightness = sorted(lab(SEEN[who], colour)[0] for colour in pulse)
    assert min(np.diff(lightness)) > JUST_SEEN  # in print without colours


def test_no_line_of_data_has_the_colour_of_an_outcome():
    assert closest("all colours", palette.SERIES, OUTCOMES) > 4 * JUST_SEEN


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_colours_stand_out_from_both_pages_of_the_explorer(theme):
    rules = files("rocking.explorer").joinpath("common.css").read_text(encoding="utf-8")
    (paper,) = {
        dark: each
        for dark, each in zip(("light", "dark"), re.findall(r"--paper: (#\w{6})", rules), strict=True)
        if dark == theme
    }.values()
    shown = {look.colour for look in LOOKS} | {palette.STANDS, *palette.OVERTURNED_AFTER[:2]}
    assert closest("all colours", [paper], shown) > 7 * JUST_SEEN
    assert (
        closest("all colours", [paper], [{"light": palette.MOTION, "dark": palette.DARK_MOTION}[theme]]) > 50
    )


def drawn_legends():
    """The name and the colour of every outcome in the legends of one figure of each kind, and of both pages of the explorer."""
    axes = {"amplitude": np.linspace(0.5, 14.0, 30), "period": np.linspace(0.3, 3.0, 30)}
    system, square = rk.System(rk.Harmonic(5.5, period=0.5), 0.925), np.linspace(-1, 1, 40)
    found = rk.parametric_map(system, **axes).dataset
    pulse = {"amplitude": np.linspace(0.5, 10, 30), "frequency": np.linspace(0.5, 8, 30)}
    records, block = rk.synthetic_ground_motions(3, seed=1), rk.Block(2.0, 0.5)
    doubling = rk.System(rk.Harmonic(10.0, period=1.721328), 0.8)
    values = np.linspace(9.0, 11.5, 30)
    sizes = {"size": np.geomspace(0.3, 6, 20), "slenderness": np.radians(np.linspace(5, 40, 20))}
    kinds = {"amplitude": np.linspace(1, 13, 8), "period": np.linspace(0.5, 2, 8)}
    figures = {
        "map": rk.plot.parametric_map(found),
        "marks": rk.plot.parametric_map(found, symbols="kinds"),
        "basins": rk.plot.basins(rk.basin_map(system, angle=square, velocity=square, boundary_runs=0)),
        "pulse": rk.plot.overturning_spectrum(
            rk.overturning_spectrum(
                rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), 0.9), **pulse
            )
        ),
        "set": rk.plot.overturning_set(
            rk.overturning_set(records, block, np.linspace(2, 20, 40), model="slender")
        ),
        "sizes": rk.plot.rocking_spectrum(
            rk.rocking_spectrum(records[:1], **sizes, levels=1.5, model="slender")
        ),
        "repeatability": rk.plot.repeatability_map(rk.repeatability_map(system, **kinds, samples=4)),
        "response": rk.plot.frequency_response(
            rk.frequency_response(
                evolve(system, forcing=rk.Harmonic(3.0, period=1.0)), period=np.linspace(0.5, 3, 20)
            )
        ),
        "diagram": rk.plot.orbit_diagram(rk.orbit_diagram(doubling, amplitude=values, sweep="both")),
        "exponents": rk.plot.response_diagram(rk.response_diagram(doubling, amplitude=values)).axes[-1],
    }
    for figure, ax in figures.items():
        legend = ax.get_legend()
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True):
            patch = hasattr(handle, "get_facecolor")
            yield figure, text.get_text(), to_hex(handle.get_facecolor() if patch else shown_colour(handle))
    for entry in texts.legend(np.arange(1, len(LOOKS) + 1)):
        yield "explorer", entry["name"], entry["colour"].lower()
    still = {name: np.zeros((2, 2)) for name in ("outcome", "certified", "peak", "margin")}
    for name, entry in ground_maps.legend(Picture(still, 2, 4, 4)).items():
        if isinstance(entry, dict):
            told = {"stands": "no motion", "rocks": "stands"}.get(name, name)
            yield "ground motions", told, entry.get("colour", entry.get("colours", [""])[0]).lower()


def shown_colour(line):
    """The colour of a line, or of its mark: of the edge of a hollow mark or of strokes."""
    if line.get_marker() in ("", "None", "none", None):
        return line.get_color()
    strokes = line.get_marker() in ("x", "+", "_") or line.get_markerfacecolor() in ("white", "none")
    return line.get_markeredgecolor() if strokes else line.get_markerfacecolor()


MEANINGS = {
    "no motion": "rest",
    "overturns": "overturned",
    "undecided": "undetermined",
    "periodic": "period 1",  # of any period
}


def meaning(name):
    """The outcome that a legend names, without its fraction, its letter and its number."""
    name = re.sub(r"^from rest: | \(.*|, up$|, down$", "", name).removesuffix(", symmetric")
    number = re.fullmatch(r"period (\d+)(, asymmetric)?", name)
    if number and int(number[1]) % 2 == 0:
        return "even period"
    if number and int(number[1]) > 3:
        return "5, 7, …, asymmetric" if number[2] else "period 5, 7, …"
    return MEANINGS.get(name, name)


def test_no_outcome_has_two_colours_and_no_colour_two_outcomes():
    first = {look.shade(number).lower(): look.colour.lower() for look in LOOKS for number in range(16)}
    lines = {colour.lower() for colour in (*palette.SERIES, palette.INK, palette.GUIDE)}
    colours, names, seen = {}, {}, set()
    for figure, name, colour in drawn_legends():
        if colour not in lines:
            colours.setdefault(meaning(name), set()).add(first.get(colour, colour))
            names.setdefault(first.get(colour, colour), set()).add(meaning(name))
            seen.add(figure)
    assert {name: each for name, each in colours.items() if len(each) > 1} == {}
    assert {colour: each for colour, each in names.items() if len(each) > 1} == {}
    assert len(seen) == 12
    assert {"rest", "period 1", "overturned", "stands", "falls, 1 impact", "not certain"} <= colours.keys()


STATED = re.compile(r"#[0-9A-Fa-f]{6}\b")


def test_no_other_file_states_a_colour_of_the_palette():
    """Greys of lines and pages that are no outcomes may stand in style sheets."""
    own = {colour.upper() for colour in (*OUTCOMES, *palette.SERIES)} - {palette.INK}
    elsewhere = {}
    for part in ("plot", "explorer", "papers", "cli"):
        for path in (Path(rk.__file__).parent / part).rglob("*"):
            if path.suffix in (".py", ".css", ".js", ".html") and path.name != "palette.py":
                stated = own & {colour.upper() for colour in STATED.findall(path.read_text(encoding="utf-8"))}
                elsewhere |= {path.name: stated} if stated else {}
    assert elsewhere == {}


def test_looks_differ_in_colour_and_in_mark():
    assert len({look.colour for look in LOOKS}) == len(LOOKS)
    assert len({(look.marker, look.hollow) for look in LOOKS}) == len(LOOKS)


def test_every_kind_period_and_symmetry_has_its_look():
    kinds = np.arange(len(rk.Kind), dtype=np.uint8)
    no = np.zeros(len(kinds), int)
    names = [LOOKS[number].name for number in looks(kinds, no + 1, no + 1)]
    assert names == ["period 1" if kind == "periodic" else kind for kind in rk.Kind]
    assert looks(np.array([255], np.uint8), no[:1], no[:1]) == 255
