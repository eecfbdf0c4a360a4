"""State of the page: to an address and back; invalid input does no harm; its images are those of the map."""

import asyncio
import itertools
import json
import math
import re
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial

import attrs
import numpy as np
import pytest
from bokeh.document import Document
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking.explorer import figures, harmonic_maps, harmonic_motion, presets, refinement, texts
from rocking.explorer.fields import Refused, Span, written
from rocking.explorer.figures import Axes
from rocking.explorer.harmonic_maps import Attractors, Basins, Orbits, Responses, colours, counts
from rocking.explorer.harmonic_page import HarmonicSession
from rocking.explorer.harmonic_units import without_g
from rocking.explorer.harmonic_view import DEFAULT, POINTS, HarmonicView, closest, nearby
from rocking.explorer.jobs import Jobs, Workers
from rocking.explorer.refinement import AHEAD, START, Picture, Refinement
from rocking.explorer.session import message
from rocking.model.text import percent
from rocking.model.verdict import Criterion, Kind
from rocking.plot import style
from rocking.plot.palette import LOOKS, NONE, looks
from rocking.survey import attractors
from rocking.survey.engine import cores
from surveyed import system_with

ASYMMETRIC = 2
"""Place in `LOOKS` of an asymmetric response of period 1."""
numbers = st.floats(allow_nan=False, allow_infinity=False)


def inside(low, high):
    return st.floats(low, high).map(lambda value: value + 0.0)


def spans(low, high):
    pairs = st.tuples(inside(low, high), inside(low, high)).map(sorted).map(lambda ends: Span(*ends))
    return pairs.filter(lambda span: span.width > closest(span))


SHOWN = st.builds(
    HarmonicView,
    amplitude=inside(0, 1000),
    period=inside(0.01, 6000),
    restitution=inside(0, 1),
    phase=inside(-1000, 1000),
    velocity=inside(-1000, 1000),
    brace_angle=st.none() | inside(1e-3, 1.2),
    critical_angle=st.none() | inside(1e-3, 1.2),
    amplitudes=spans(0, 1000),
    periods=spans(0.01, 6000),
    angles=spans(-1000, 1000),
    vary=st.sampled_from(["amplitude", "period"]),
    first=st.integers(0, 100_000),
    curves=st.sampled_from([(), ("melnikov",), ("existence-3", "heteroclinic")]),
    height=st.none() | inside(1e-3, 1e3),
)


@given(SHOWN)
def test_address_gives_back_every_digit(shown):
    again, refused = HarmonicView.from_address("?" + shown.address)
    assert refused == {}
    # what is as at the beginning is left out, and a zero has one sign
    assert again == shown


@settings(deadline=None)
@given(st.dictionaries(st.sampled_from([*HarmonicView.declared(), "version", "x"]), st.text(max_size=30)))
def test_any_address_shows_something_that_can_be_shown(typed):
    from urllib.parse import urlencode

    shown, refused = HarmonicView.from_address("?" + urlencode(typed))
    assert rk.simulate(shown.system, shown.start, cycles=1, record="none").cycles <= 1
    assert all(text for text in refused.values())
    assert HarmonicView.from_address(shown.address) == (shown, {})


@given(st.text(max_size=300))
def test_any_text_is_an_address(text):
    assert isinstance(HarmonicView.from_address(text)[0], HarmonicView)


PART = st.none() | numbers | st.text(max_size=5) | st.lists(st.text(max_size=5))
JSON = st.dictionaries(
    st.sampled_from(["what", "fields", "x"]), PART | st.dictionaries(st.text(max_size=5), PART)
).map(json.dumps)


@settings(deadline=None)
@given(st.text(max_size=100) | JSON)
def test_any_message_is_heard_or_refused(text):
    with suppress(Refused):
        asked = message(text)
        assert all(isinstance(each, str) for each in (asked["what"], *asked["fields"].values()))


@pytest.mark.parametrize(
    "typed, field, sentence",
    [
        ({"amplitude": "x"}, "amplitude", "amplitude must be a number in [0, 1000]; got 'x'"),
        ({"restitution": "1.2"}, "restitution", "restitution must be a number in [0, 1]; got '1.2'"),
        ({"period": "nan"}, "period", "period must be a number in [0.00628319, 6283.19]; got 'nan'"),
        ({"cycles": "1.5"}, "cycles", "cycles must be a whole number in [1, 200]; got '1.5'"),
        ({"cycles": "²"}, "cycles", "cycles must be a whole number in [1, 200]; got '²'"),
        ({"amplitude": ""}, "amplitude", "give the amplitude"),
        ({"cycles": " "}, "cycles", "give the cycles"),
        ({"brace_angle": "x"}, "brace_angle", "brace angle must be a number in [0.001, 1000]; got 'x'"),
        ({"first": "-1"}, "first", "first cycle must be a whole number in [0, 100000]; got '-1'"),
        ({"critical_angle": "2"}, "critical_angle", "critical angle must be a number in [0.001, 1.2]; got '2'"),
        ({"critical_angle": "0.5", "brace_angle": "4"}, "brace_angle",
         "brace angle must be below 3.14159, where a block with critical angle 0.5 lies flat; got 4.0"),
        ({"vary": "phase"}, "vary", "vary must be one of amplitude, period; got 'phase'"),
        ({"brace_angle": "0.5", "angle": "0.9"}, "angle", "angle must lie between the braces, in [-0.5, 0.5]; got 0.9"),
        ({"periods": "2:1"}, "periods", "periods must be LOW:HIGH, with LOW < HIGH and a range that double precision resolves; got '2:1'"),
    ],
)  # fmt: skip
def test_field_is_refused_in_one_sentence(typed, field, sentence):
    with pytest.raises(Refused) as refusal:
        DEFAULT.changed(typed)
    assert refusal.value.fields == {field: sentence}


SQUAT = "restitution must lie in [0, 1]; got -0.429 by Housner's formula for a block 2 m high and 9 m wide"


def in_si(view=DEFAULT, **typed):
    """Return the view of a block of 2 m × 0.5 m with Housner's coefficient of restitution, and of fields in SI."""
    return view.changed({"height": "2", "width": "1"}).changed({"width": "0.5"} | typed)


def test_fields_of_a_block_in_metres_are_those_of_the_package():
    shown = in_si(amplitude="3", frequency_hz="1.2", angle="-2", velocity="5", brace_angle="4")
    block = rk.Block(2.0, 0.5)
    system = block.system(acceleration=3.0, frequency_hz=1.2, braces=rk.Braces(block.angle(degrees=4.0)))
    assert (shown.amplitude, shown.period) == (system.forcing.amplitude, system.forcing.period)
    assert shown.system.braces == system.braces
    assert shown.start == rk.State(block.angle(degrees=-2.0), block.velocity(np.radians(5.0)))
    assert (shown.restitution, shown.block.critical_angle) == (block.restitution, block.critical_angle)
    written = {"amplitude": "3", "frequency_hz": "1.2", "angle": "-2", "velocity": "5", "brace_angle": "4"}
    assert {name: shown.shown[name] for name in written} == written
    assert (
        in_si(amplitude="0.3 g").system.forcing.amplitude
        == block.system(acceleration_g=0.3, period_s=1).forcing.amplitude
    )


def test_first_block_keeps_the_motion_and_another_one_the_values_in_si():
    first = DEFAULT.changed({"height": "2", "width": "0.5"})
    assert first.system == DEFAULT.system
    assert first.address.startswith(DEFAULT.address)
    again, refused = HarmonicView.from_address(first.address)
    assert (again, refused) == (first, {})
    second = first.changed({"amplitude": "3", "frequency_hz": "1.2", "angle": "-2"}).changed({"height": "4"})
    assert {name: second.shown[name] for name in ("amplitude", "frequency_hz", "angle", "width")} == {
        "amplitude": "3", "frequency_hz": "1.2", "angle": "-2", "width": "0.5",
    }  # fmt: skip
    assert second.restitution == rk.Block(4.0, 0.5).restitution
    assert second.period == pytest.approx(rk.Block(4.0, 0.5).time(1 / 1.2))
    normalised = second.changed({"height": "", "width": ""})
    assert normalised.system == second.system
    assert normalised.shown == normalised.fields


@pytest.mark.parametrize("name", ["height", "width"])
def test_emptied_side_of_a_block_is_asked_for_and_does_not_change_the_units(name):
    with pytest.raises(Refused) as refusal:
        in_si().changed({name: " "})
    assert refusal.value.fields == {name: f"give the {name}"}


def test_acceleration_may_be_given_in_g():
    assert float(without_g("0.3 g")) == float(without_g(".3g ")) == 0.3 * 9.80665
    for text in ("3", "x g", "g", "1 gal", ""):
        assert without_g(text) == text


SI = st.builds(
    HarmonicView,
    amplitude=st.just(0.0) | inside(1e-9, 1000),
    period=inside(0.01, 6000),
    velocity=st.just(0.0) | inside(1e-9, 1000),
    amplitudes=spans(0, 1000),
    periods=spans(0.01, 6000),
    height=inside(0.01, 100),
    width=inside(0.01, 100),
)


@given(SI)
def test_texts_in_si_give_the_values_back(view):
    """To the last places: 17 digits do not always give back what is converted twice."""
    again = view.changed(
        {name: view.shown[name] for name in ("amplitude", "frequency_hz", "velocity", "brace_angle")}
    )
    for name in ("amplitude", "period", "velocity"):
        assert getattr(again, name) == pytest.approx(getattr(view, name), rel=8 * 2**-53, abs=0.0)
    for each, span in ((view.map_axes.across, view.periods), (view.map_axes.up, view.amplitudes)):
        assert each.low <= each.high
        assert (each.high > each.low) == (span.high > span.low)


@given(SI, st.sampled_from(["amplitudes", "periods", "angles", "velocities"]))
def test_narrowest_zoom_of_a_block_is_accepted(view, name):
    low = view.units.shown(name, getattr(view, name)).low
    again = view.changed({name: f"{low!r}:{low + view.narrowest(name)!r}"})
    assert np.unique(np.linspace(getattr(again, name).low, getattr(again, name).high, POINTS)).size == POINTS


def test_figures_and_tables_of_a_block_are_in_si():
    shown, block = in_si(amplitude="4", frequency_hz="2.5"), rk.Block(2.0, 0.5)
    plain, units = attrs.evolve(shown, height=None, width=None), shown.units
    traces, others = harmonic_motion.traces(shown)["history"], harmonic_motion.traces(plain)["history"]
    drawn = units.contents("history", traces, "amplitude")
    assert plain.units.contents("history", others, "amplitude") is others
    assert drawn["line"]["time"] == pytest.approx(block.seconds(others["line"]["time"]))
    assert drawn["line"]["angle"] == pytest.approx(block.degrees(others["line"]["angle"]))
    assert drawn["line"]["velocity"] == pytest.approx(
        np.degrees(block.radians_per_second(others["line"]["velocity"]))
    )
    assert drawn["ranges"] == pytest.approx(
        (*block.seconds(others["ranges"][:2]), *block.degrees(others["ranges"][2:]))
    )
    spectrum = units.contents("spectrum", harmonic_motion.spectrum(shown), "amplitude")
    assert spectrum["names"]["frequency"][0] == pytest.approx(2.5, rel=0.02)
    assert [units.label(name) for name in ("time", "angle", "velocity", "frequency", "amplitude", "period")] == [
        "time t (s)", "angle θ (°)", "velocity θ̇ (°/s)", "frequency (Hz)", "amplitude aₓ (m/s²)", "period (s)",
    ]  # fmt: skip
    assert [plain.units.label(name) for name in ("time", "angle", "velocity", "amplitude", "period")] == [
        "time τ", "angle Θ", "velocity Θ′", "amplitude A", "period T",
    ]  # fmt: skip
    assert units.factor("exponent") == pytest.approx(1 / block.seconds(1.0))
    assert plain.units.factor("exponent") == 1.0
    assert units.headings("amplitude")["value"] == "value [m/s²]"
    assert plain.units.headings("amplitude") == {}


def test_click_on_the_map_of_a_block_selects_its_forcing():
    async def run():
        workers = Workers()
        session = HarmonicSession(Document(), workers)
        session.view = in_si(amplitude="4", frequency_hz="2.5")
        fields = session._map_point("map", 0.5, 10.0)
        workers.close()
        return session.view.changed(fields)

    clicked = alone(run())
    assert clicked.block.acceleration(clicked.amplitude) == pytest.approx(10.0, rel=5e-3)
    assert clicked.block.seconds(clicked.period) == pytest.approx(0.5, rel=5e-3)


def test_case_of_the_gallery_keeps_the_block_of_the_view():
    async def run():
        workers = Workers()
        session = HarmonicSession(Document(), workers)
        session.view = in_si()
        case, _ = session.answer("case", {"name": "figure-2b"})
        workers.close()
        return case

    case = alone(run())
    assert case.system == presets.BY_NAME["figure-2b"].view.system
    assert (case.height, case.width) == (2.0, 0.5)


def test_moving_block_is_drawn_in_metres():
    shown, block = in_si(amplitude="4", frequency_hz="2.5"), rk.Block(2.0, 0.5)
    scene = harmonic_motion.scene(shown)
    assert scene["base"] == pytest.approx(4.0 / (2 * math.pi * 2.5) ** 2)
    assert (scene["frequency"], scene["critical"]) == pytest.approx((2 * math.pi * 2.5, block.critical_angle))
    assert scene["unit"] * block.degrees(0.5) == pytest.approx(0.5)
    assert harmonic_motion.scene(DEFAULT)["unit"] == 1.0


@pytest.mark.parametrize(
    "typed, field, sentence",
    [
        ({"frequency_hz": ""}, "frequency_hz", "give the frequency"),
        ({"frequency_hz": "soon"}, "frequency_hz", "frequency must be a number in [0.000425137, 425.137]; got 'soon'"),
        ({"frequency_hz": "1e5"}, "frequency_hz", "frequency must be a number in [0.000425137, 425.137]; got '1e5'"),
        ({"amplitude": "1e5"}, "amplitude", "acceleration must be a number in [0, 2402.42]; got '1e5'"),
        ({"amplitude": "x g"}, "amplitude", "acceleration must be a number in [0, 2402.42]; got 'x g'"),
        (
            {"width": "600 mm"},
            "width",
            "width must be a number in [0.001, 1000]; got '600 mm' (write the number alone, in the unit beside the field)",
        ),
        ({"width": "x"}, "width", "width must be a number in [0.001, 1000]; got 'x'"),
        ({"width": "9"}, "width", f"{SQUAT} (make the block narrower or taller)"),
        ({"angle": "9", "brace_angle": "5"}, "angle",
         "angle must lie between the braces, in [-0.356221, 0.356221]; got 0.6411971992766763, in units of the critical angle"),
    ],
)  # fmt: skip
def test_block_in_metres_is_refused_in_the_words_of_its_fields(typed, field, sentence):
    with pytest.raises(Refused) as refusal:
        in_si().changed(typed)
    assert refusal.value.fields == {field: sentence}


def test_block_in_metres_stays_in_the_commands(rocking):
    shown = in_si(amplitude="0.3 g", frequency_hz="1.9")
    forced = "--height 2 --width 0.5 --acceleration 2.941995 --frequency-hz 1.9"
    point, motion, plane = texts.commands(shown).splitlines()
    assert point == f"rocking classify {forced}"
    assert motion == f"rocking simulate {forced} --cycles 30 --plot motion.png"
    assert plane.startswith("rocking map --height 2 --width 0.5 --acceleration 0:")
    for line in (point, motion, plane):
        code, message, out = rocking(line.removeprefix("rocking ").replace(":101", ":3"))
        assert (code, message) == (0, "")
        assert "m/s²" in out
    other = attrs.evolve(shown, restitution=0.9, angle=-0.1)
    assert (
        texts.commands(other).splitlines()[0] == f"rocking classify {forced} --restitution=0.9 --angle=-0.1"
    )


def made_by_code(view):
    """Return what the Python code of a view makes, with three values along each axis."""
    names = {}
    exec(texts.python(view).replace("101)", "3)"), names)
    return names


@pytest.mark.parametrize("units", [lambda view: view, in_si], ids=["normalised", "SI"])
@pytest.mark.parametrize(
    "window, angles", [((-1.2, 1.2), [-0.8, 0, 0.8]), ((0.2, 1.5), [0.2, 0.5, 0.8]), ((0.9, 1.2), None)]
)
def test_code_leaves_out_starts_beyond_the_braces(units, window, angles):
    view = attrs.evolve(units(DEFAULT), brace_angle=0.8, angles=Span(*window))
    basin = made_by_code(view).get("basin")
    assert basin is None if angles is None else basin.dataset.angle.values == pytest.approx(angles)


def test_full_block_is_in_the_link_the_code_and_the_commands(rocking):
    shown = DEFAULT.changed({"critical_angle": "0.25"})
    assert shown.system == rk.System(rk.Harmonic(2.0, period=1.0), 0.925, critical_angle=0.25)
    assert "critical_angle=0.25" in shown.address
    for line in texts.commands(shown).splitlines():
        assert line.count("--critical-angle=0.25") == 1
        code, message, _ = rocking(line.removeprefix("rocking ").replace(":101", ":3"))
        assert (code, message) == (0, "")
    names = made_by_code(shown)
    assert names["system"] == shown.system
    assert names["responses"].dataset.attrs["critical_angle"] == 0.25


def test_full_block_in_metres_has_the_critical_angle_of_its_size():
    shown = in_si(DEFAULT.changed({"critical_angle": "0.3"}))
    assert shown.critical_angle == rk.Block(2.0, 0.5).critical_angle
    assert all(line.count("--model full") == 1 for line in texts.commands(shown).splitlines())
    assert in_si().critical_angle is None
    assert shown.changed({"critical_angle": "0.245"}) == shown
    assert shown.changed({"critical_angle": ""}).system.critical_angle is None
    with pytest.raises(Refused) as refusal:
        shown.changed({"critical_angle": "0.3"})
    sentence = "critical angle must be 0.245, that of the block in SI units, or empty; got 0.3"
    assert refusal.value.fields == {"critical_angle": sentence}
    free = shown.changed({"critical_angle": "0.3", "height": "", "width": ""})
    assert (free.block, free.critical_angle) == (None, 0.3)


def test_block_in_metres_is_refused_if_its_braces_are_where_it_lies_flat():
    shown = DEFAULT.changed({"critical_angle": "0.3", "brace_angle": "4"})
    with pytest.raises(Refused) as refusal:
        shown.changed({"height": "2", "width": "1.9"})
    assert list(refusal.value.fields) == ["brace_angle"]


def test_link_with_one_unfit_field_keeps_the_others():
    shown, refused = HarmonicView.from_address("?version=1&critical_angle=0.3&brace_angle=6&amplitude=5")
    assert (shown.amplitude, shown.critical_angle, shown.brace_angle) == (5.0, 0.3, None)
    assert list(refused) == ["brace_angle"]
    shown, refused = HarmonicView.from_address("?version=1&brace_angle=0.5&angle=0.9&amplitude=5")
    assert (shown.amplitude, shown.brace_angle, shown.angle, list(refused)) == (5.0, 0.5, 0.0, ["angle"])


def option(line, name):
    return line.split(f"--{name} ")[1].split()[0]


@given(inside(0.01, 10), inside(0.01, 10), st.just(0.0) | inside(1e-9, 1000), inside(0.01, 6000))
def test_commands_in_si_are_of_the_system_shown(height, width, amplitude, period):
    """To the last places: no quantity is rounded more than eight times on its way out and back."""
    shown = attrs.evolve(DEFAULT, height=height, width=width, amplitude=amplitude, period=period)
    point, _, plane = texts.commands(shown).splitlines()
    acceleration, hertz = (float(option(point, name)) for name in ("acceleration", "frequency-hz"))
    block = shown.block
    near = partial(pytest.approx, rel=8 * 2**-53, abs=0.0)
    assert block.amplitude(acceleration) == near(amplitude)
    assert math.tau / block.frequency(hertz) == near(period)
    for name, turn, span in (
        ("acceleration", block.amplitude, shown.amplitudes),
        ("period-s", block.time, shown.periods),
    ):
        low, high, points = option(plane, name).split(":")
        assert (turn(float(low)), turn(float(high)), points) == (near(span.low), near(span.high), "101")


def test_verdict_on_a_block_is_in_si():
    shown = in_si(amplitude="4", frequency_hz="2.5")
    verdict = rk.classify(shown.system)
    facts = dict(texts.verdict(verdict, shown.block)["facts"])
    assert facts["forcing"] == "4 m/s² (0.4079 g), 0.4 s (2.5 Hz)"
    assert facts["block"] == "2 m × 0.5 m, θcr 14.04°, Housner’s e 0.9118"
    assert facts["largest |θ|"].startswith(f"{shown.block.degrees(verdict.peak):.4g}° (")
    assert facts["period"].endswith(f"symmetric ({0.4 * verdict.period:.4g} s)")
    assert "forcing" not in dict(texts.verdict(verdict, None)["facts"])


@pytest.mark.parametrize(
    "middle, width", [(1.3, 1e-3), (1.3, 1e-9), (1.3, 4e-12), (15.9, 1e-10), (1e3, 1e-8), (0.0, 1e-12)]
)
def test_deep_views_are_drawn_as_differences_without_loss(middle, width):
    span = Span(middle, middle + width)
    base = figures.base_of(span)
    low, high = span.low - base, span.high - base
    # what the browser adds again are the ends themselves
    assert (base + low, base + high) == (span.low, span.high)
    assert max(abs(low), abs(high)) * 2**-52 < (high - low) / (POINTS - 1) / 100
    assert len(written(base)) <= 20


def test_points_of_a_picture_are_the_middles_of_its_cells():
    across, up = Span(0.2, 3.0), Span(0.0, 16.0)
    drawn = Axes(across, up).image(np.zeros((5, 5), np.uint8))
    for begin, length, span in (("x", "w", across), ("y", "h", up)):
        middles = drawn[begin][0] + (np.arange(5) + 0.5) * drawn[length][0] / 5
        np.testing.assert_allclose(middles, np.linspace(span.low, span.high, 5), atol=1e-14)


def test_stripes_lie_on_undetermined_points_alone():
    undetermined = next(number for number, look in enumerate(LOOKS) if look.name == "undetermined")
    looks = np.full((9, 9), undetermined)
    looks[:, :4] = 0
    fields = {"look": looks, "orbit": np.zeros((9, 9), int)}
    drawn = colours(Picture(fields, points=9, settled=81, of=81))
    assert set(drawn[:, :4].ravel().tolist()) == {0}
    assert {harmonic_maps.PALETTE[number] for number in set(drawn[:, 4:].ravel().tolist())} == {
        harmonic_maps.SHADED[undetermined],
        style.INK,
    }


def test_undetermined_points_are_blank_and_called_undecided_until_the_map_is_done():
    """Few cycles classify no undamped motion: a quarter of a first map would be hatched."""
    axes = ("period", Span(0.2, 3.0)), ("amplitude", Span(0.0, 16.0))
    first, *_ = refined(Responses(*axes, {"restitution": 1.0}, 33))
    assert np.mean(first.fields["kind"] == Kind.UNDETERMINED.code) > 0.2
    drawn = colours(first)
    assert harmonic_maps.HATCH not in drawn
    assert np.mean(drawn == harmonic_maps.NOTHING) > 0.2
    number = counts(first).sum(axis=0)
    names = [each["name"] for each in texts.legend(number, done=False)]
    assert ("not yet decided" in names, "undetermined" in names) == (True, False)
    assert "undetermined" in [each["name"] for each in texts.legend(number)]


def test_narrowest_view_still_has_a_double_for_every_point():
    for middle in (0.2, 1.0, 3.0, 16.0, 999.0):
        span = Span(middle, middle + closest(Span(middle, middle)))
        steps = np.diff(np.linspace(span.low, span.high, POINTS))
        assert steps.min() >= 4 * math.ulp(middle)


def alone(coroutine):
    """Run a coroutine in a new thread, because a browser leaves an event loop in this one."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, coroutine).result()


def refined(measure):
    async def run():
        workers = Workers()
        refinement = Refinement(measure, workers, np.zeros(1, np.int64))
        pictures = [refinement.coarse()]
        pictures += [picture async for picture in refinement.finer()]
        workers.close()
        return pictures

    return alone(run())


@pytest.mark.parametrize("block", [{}, {"critical_angle": 0.25}])
def test_refined_map_is_the_packages_map(block):
    measure = Responses(
        ("period", Span(0.2, 3.0)), ("amplitude", Span(0.0, 16.0)), {"restitution": 0.925} | block, 33
    )
    pictures = refined(measure)
    axes = {"period": np.linspace(0.2, 3, 33), "amplitude": np.linspace(0, 16, 33)}
    found = rk.parametric_map(system_with(restitution=0.925, **block), **axes).dataset
    names = "kind", "response_period", "symmetric"
    assert (pictures[-1].fields["look"] == looks(*(found[name].values for name in names))).all()
    assert [picture.side for picture in (pictures[0], pictures[-1])] == [5, 33]
    assert [picture.done for picture in pictures] == [False] * (len(pictures) - 1) + [True]
    assert colours(pictures[-1]).shape == (33, 33)


def test_maps_under_way_show_classified_points_and_neighbours_of_the_others(monkeypatch):
    measure = Responses(
        ("period", Span(0.2, 3.0)), ("amplitude", Span(0.0, 16.0)), {"restitution": 0.925}, 33
    )
    monkeypatch.setattr(refinement, "SHOWN_EVERY", 0.0)
    monkeypatch.setattr(refinement, "FASTER", 1)
    first, *others, last = refined(measure)
    sides = [picture.side for picture in others]
    assert sides == sorted(sides)
    assert {9, 17, 33} == set(sides)
    for picture in others:
        side = picture.side
        stride, even = 32 // (side - 1), np.arange(side) // 2 * 2
        right = picture.fields["look"] == last.fields["look"][::stride, ::stride]
        right[::2, ::2] |= (
            (picture.fields["look"][::2, ::2] == first.fields["look"]) if stride == 4 else False
        )
        assert picture.settled <= picture.of
        assert right[::2, ::2].all()
        assert (right | (picture.fields["look"] == picture.fields["look"][np.ix_(even, even)])).all()


def test_map_without_valid_points_is_complete_at_once():
    fixed = {"amplitude": 2.0, "period": 1.0, "restitution": 0.9}
    measure = Basins(Span(-1.0, 1.0), Span(-1.0, 1.0), fixed, 17, reach=-1.0)
    *_, last = refined(measure)
    assert last.done
    assert (last.fields["look"] == NONE).all()


def pieces(monkeypatch, seconds):
    """Return the numbers of points in the pieces of a refinement, if each point takes ``seconds``."""
    measure = Responses(
        ("period", Span(0.2, 3.0)), ("amplitude", Span(0.0, 16.0)), {"restitution": 0.925}, 33
    )
    sizes, judge = [], Refinement._timed

    def timed(refinement, places):
        sizes.append(places.size)
        return judge(refinement, places)[0], seconds * places.size

    monkeypatch.setattr(Refinement, "_timed", timed)
    refined(measure)
    return sizes


def test_pieces_have_one_point_where_points_are_dear_and_many_where_they_are_cheap(monkeypatch):
    """Threads can change to other work, and results appear early, however long one point takes."""
    costly = pieces(monkeypatch, 1.0)
    assert costly[0] == START
    assert set(costly[AHEAD * cores() :]) == {1}
    monkeypatch.undo()
    assert max(pieces(monkeypatch, 1e-6)) > 8 * START


def test_coarse_map_calls_undetermined_what_it_cannot_know():
    """Chaos needs 10,000 cycles: what has fewer says that it does not know."""
    measure = Responses(("period", Span(1.1, 1.2)), ("amplitude", Span(6.95, 7.05)), {"restitution": 0.3}, 9)
    chaotic = [look.name for look in LOOKS].index("chaotic")
    first, *_, last = refined(measure)
    assert (first.fields["kind"] == Kind.UNDETERMINED.code).any()
    assert not (first.fields["look"] == chaotic).any()
    assert (last.fields["look"] == chaotic).any()
    # the open points of the coarse map are classified again
    axes = {"period": np.linspace(1.1, 1.2, 9), "amplitude": np.linspace(6.95, 7.05, 9)}
    found = rk.parametric_map(system_with(restitution=0.3), **axes).dataset
    names = "kind", "response_period", "symmetric"
    assert (last.fields["look"] == looks(*(found[name].values for name in names))).all()


def test_starts_beyond_the_braces_are_no_starts():
    fixed = {"amplitude": 2.0, "period": 1.0, "restitution": 0.9, "brace_angle": 0.5}
    measure = Basins(Span(-1.0, 1.0), Span(-1.0, 1.0), fixed, 17, reach=0.5)
    last = refined(measure)[-1]
    outside = np.abs(np.linspace(-1, 1, 17)) > 0.5
    assert (last.fields["look"][:, outside] == NONE).all()
    assert not (last.fields["look"][:, ~outside] == NONE).any()


def test_mirror_images_have_shades_of_their_own():
    fixed = {"amplitude": 14.0, "period": 1.35, "restitution": 0.925}
    measure = Attractors(Span(-0.5, 0.5), Span(-0.5, 0.5), fixed, 17)
    *_, last = refined(measure)
    starts = np.linspace(-0.5, 0.5, 17)
    system = rk.System(rk.Harmonic(14.0, period=1.35), 0.925)
    found = rk.basin_map(system, angle=starts, velocity=starts, boundary_runs=0)
    attractor = found.dataset.attractor.transpose("velocity", "angle").values
    twins = last.fields["look"] == ASYMMETRIC
    pairs = set(zip(attractor[twins].tolist(), last.fields["orbit"][twins].tolist(), strict=True))
    assert len(pairs) == len(set(attractor[twins].tolist())) == 2
    assert {number for _, number in pairs} == {0, 1}
    shades = [set(colours(last)[twins & (last.fields["orbit"] == number)].tolist()) for number in (0, 1)]
    assert [len(shade) for shade in shades] == [1, 1]
    drawn = {harmonic_maps.PALETTE[number] for shade in shades for number in shade}
    assert len(drawn) == 2
    entries = texts.attractors(counts(last))
    assert [each["name"] for each in entries] == [LOOKS[ASYMMETRIC].name, "another orbit", "overturned"]
    assert {each["colour"] for each in entries[:2]} == drawn
    assert sorted(each["share"] for each in entries) == sorted(
        percent(share.value) for share in found.fractions
    )


def test_orbits_keep_their_numbers_and_too_many_have_none():
    orbits = Orbits()
    looks, states = np.array([3, 1, 3, 3]), np.array([[0.5, 1.0], [0.5, 1.0], [-0.5, 2.0], [np.nan, np.nan]])
    assert orbits.numbers(looks, states).tolist() == [0, 0, 1, 0]
    assert orbits.numbers(looks[::-1], states[::-1] + 1e-7).tolist() == [0, 1, 0, 0]
    many = np.column_stack([np.arange(40.0), np.zeros(40)])
    assert orbits.numbers(np.full(40, 7), many).tolist() == [*range(16), *[0] * 24]


def test_orbits_are_those_that_a_basin_map_tells_apart():
    """States 5e-6 apart are two attractors of a basin map, and two orbits of the page; 5e-7 apart one of either."""
    looks = np.array([3, 3])
    for apart, numbers in ((5e-6, [0, 1]), (5e-7, [0, 0])):
        states = np.array([[0.5, 1.0], [0.5, 1.0 + apart]])
        assert Orbits().numbers(looks, states).tolist() == numbers
        answers = {name: np.zeros(2) for name in attractors.CLASS} | {
            "orbit_angle": states[:, 0], "orbit_velocity": states[:, 1],
            "mean_angle": np.full(2, np.nan), "mean_angle_error": np.full(2, np.nan),
        }  # fmt: skip
        assert attractors.label_attractors(DEFAULT.system, answers)[0].tolist() == numbers


def test_start_far_beyond_return_is_drawn_as_far_as_doubles_hold():
    typed = {
        "amplitude": "0.0004",
        "period": "2420",
        "restitution": "0",
        "phase": "-1000",
        "angle": "-1000",
        "cycles": "1",
    }
    shown = DEFAULT.changed(typed)
    drawn = harmonic_motion.traces(shown)
    assert np.isfinite([*drawn["history"]["ranges"], *drawn["portrait"]["ranges"]]).all()
    assert drawn["history"]["line"]["angle"][0] == -1000.0


def test_motion_that_becomes_faster_than_any_start_is_drawn():
    """Beyond return a block gains speed until a brace sends it back."""
    typed = {
        "amplitude": "0",
        "period": "0.00628318530717959",
        "velocity": "1000",
        "brace_angle": "1000",
        "first": "100",
    }
    shown = DEFAULT.changed(typed)
    assert len(harmonic_motion.traces(shown)["history"]["line"]["time"]) > 2
    section = harmonic_motion.Section(shown)
    section.grow(100)
    assert section.ended == "too fast"


@pytest.mark.parametrize(
    "typed, label",
    [
        ({}, "angle Θ, cycles 201–1,000"),
        ({"restitution": "1", "period": "0.4"}, "angle Θ, cycles 1–1,000"),
        ({"restitution": "1", "brace_angle": "0.5", "brace_restitution": "0.9"}, "angle Θ, cycles 201–1,000"),
        ({"amplitude": "1.75", "period": "2", "restitution": "0.95"}, "angle Θ, cycles 1–5, overturned"),
        ({"amplitude": "0", "angle": "0.3"}, "angle Θ, cycles 1–1,000, at rest"),
    ],
)
def test_section_omits_the_transient_of_a_damped_motion_that_goes_on(typed, label):
    section = harmonic_motion.Section(DEFAULT.changed(typed))
    section.grow(1_000)
    assert section.drawn(None)["label"] == label


def test_legends_have_no_number_and_no_attractor_below_a_hundredth_of_a_percent():
    counts = np.zeros((3, len(LOOKS)), int)
    counts[0, 1], counts[0, 10], counts[1, 1] = 99_990, 10, 9
    assert [each["name"] for each in texts.attractors(counts)] == ["period 1"]
    shares = {each["name"]: each["share"] for each in texts.legend(counts.sum(axis=0))}
    assert len(shares) == len(LOOKS)
    assert {name for name, share in shares.items() if share} == {"period 1"}


def test_names_of_a_spectrum_do_not_run_into_each_other():
    """Lines at thirds of the forcing's frequency, of much the same height."""
    names = harmonic_motion.spectrum(HarmonicView(amplitude=10.103037, period=1.721328, restitution=0.8))[
        "names"
    ]
    places = list(zip(names["frequency"], np.log10(names["density"]), strict=True))
    assert names["name"][:2] == ["f", "f/3"]
    for (across, up), (other_across, other_up) in itertools.combinations(places, 2):
        assert abs(across - other_across) > 0.45 or abs(up - other_up) > 1.2


def test_motion_of_too_many_events_has_no_pictures(monkeypatch):
    monkeypatch.setattr(harmonic_motion, "SOON_HITS", 5.0)
    shown = DEFAULT.changed({"amplitude": "2.0078125", "restitution": "0.98", "brace_angle": "0.01"})
    assert harmonic_motion.crowded(shown)
    assert harmonic_motion.spectrum(shown)["why"] == harmonic_motion.NO_SPECTRUM
    assert (
        len(harmonic_motion.traces(shown)["history"]["line"]["time"])
        == len(harmonic_motion.diagram(shown, np.zeros(1, np.int64))["points"]["angle"])
        == 0
    )


def test_map_that_is_no_longer_wanted_ends():
    async def run():
        workers, stop = Workers(), np.zeros(1, np.int64)
        measure = Responses(
            ("period", Span(0.2, 3.0)), ("amplitude", Span(1.0, 16.0)), {"restitution": 1.0}, POINTS
        )
        refinement = Refinement(measure, workers, stop)
        refinement.coarse()
        stop[0] = 1
        with pytest.raises(asyncio.CancelledError):
            async for _ in refinement.finer():
                pass
        workers.close()

    alone(run())


def test_what_is_under_way_for_one_system_ends_when_another_is_chosen():
    """Else the verdict on the system before could come last."""

    async def run():
        stops, workers = {}, Workers()
        visit = HarmonicSession(Document(), workers)
        visit.hear(json.dumps({"what": "open", "fields": {}}))

        async def endless(name, stop):
            stops[name] = stop
            await asyncio.Event().wait()

        for name in ("response", "section", "basin", "verdict", "diagram"):
            visit.jobs.start(name, partial(endless, name))
        await asyncio.sleep(0)
        visit.hear(json.dumps({"what": "fields", "fields": {"period": "1.5"}}))
        ended = {name: int(stop[0]) for name, stop in stops.items()}
        visit.jobs.end_all()
        workers.close()
        return ended

    assert alone(run()) == {"response": 1, "section": 1, "basin": 1, "verdict": 1, "diagram": 1}


@pytest.mark.parametrize(
    "fields, started",
    [
        ({"amplitude": "3"}, ["response"]),
        ({"period": "1.5"}, ["response", "diagram"]),
        ({"restitution": "0.8"}, ["map", "response", "diagram"]),
        ({"restitution": "0.8", "angles": "-1:1"}, ["map", "response", "diagram"]),
        ({"amplitudes": "0:8"}, ["map", "diagram"]),
        ({"periods": "1:2"}, ["map"]),
        ({"angles": "-1:1"}, ["basin"]),
        ({"first": "3"}, ["response"]),
        ({"vary": "period"}, ["diagram"]),
        ({"curves": "melnikov"}, []),
    ],
)
def test_jobs_start_whose_fields_have_changed(fields, started, monkeypatch):
    async def run():
        workers = Workers()
        session = HarmonicSession(Document(), workers)
        names = []
        monkeypatch.setattr(session.jobs, "start", lambda name, *_: names.append(name))
        session.hear(json.dumps({"what": "open", "fields": {}}))
        assert names == ["map", "response", "diagram"]
        names.clear()
        session.hear(json.dumps({"what": "fields", "fields": fields}))
        workers.close()
        return names, json.loads(session.link.view)

    names, view = alone(run())
    assert names == started
    assert view["moved"] == ("response" in started)
    renewed = {"map": ["map"], "response": ["basin", "section"], "basin": ["basin"], "diagram": []}
    assert view["renewed"] == sorted(itertools.chain(*(renewed[name] for name in started)))


def test_job_waits_for_another_however_that_ends():
    async def run():
        jobs, told = Jobs(), []

        async def first(stop):
            try:
                await asyncio.sleep(0.05)
            finally:
                told.append("first")

        async def second(stop):
            await jobs.over("first")
            told.append("second")

        for early in (False, True):
            jobs.start("first", first)
            jobs.start("second", second)
            await asyncio.sleep(0.01)
            if early:
                jobs.end("first")
            await jobs.over("second")
        return told

    assert alone(run()) == ["first", "second"] * 2


def test_diagram_that_is_no_longer_wanted_ends_midway(monkeypatch):
    stop, done = np.zeros(1, np.int64), []

    def piece(system, start, **named):
        stop[0] = 1
        done.append(len(named[DEFAULT.vary]))
        return rk.orbit_diagram(system, start, **named)

    monkeypatch.setattr(harmonic_motion, "orbit_diagram", piece)
    monkeypatch.setattr(harmonic_motion, "PIECE_HITS", 5e3)
    with pytest.raises(asyncio.CancelledError):
        harmonic_motion.diagram(DEFAULT, stop)
    assert len(done) == 1
    assert done[0] < harmonic_motion.VALUES


def test_diagram_that_is_no_longer_wanted_ends_while_its_cost_is_looked_for(monkeypatch):
    """A cycle may have ten million events."""
    stop, looked = np.zeros(1, np.int64), []

    def hits(system, start):
        stop[0] = 1
        looked.append(system)
        return 1.0

    monkeypatch.setattr(harmonic_motion, "hits_per_cycle", hits)
    with pytest.raises(asyncio.CancelledError):
        harmonic_motion.diagram(DEFAULT, stop)
    assert len(looked) == 1


def test_diagram_costs_what_its_dearest_values_cost(monkeypatch):
    """The one selected may be cheap."""
    asked = []
    monkeypatch.setattr(
        harmonic_motion,
        "orbit_diagram",
        lambda *given, **named: asked.append(given) or rk.orbit_diagram(*given, **named),
    )
    monkeypatch.setattr(harmonic_motion, "SOON_HITS", 5.0)
    shown = DEFAULT.changed({"amplitude": "0", "restitution": "0.98", "brace_angle": "0.01"})
    assert not harmonic_motion.crowded(shown)
    assert len(harmonic_motion.diagram(shown, np.zeros(1, np.int64))["points"]["angle"]) == len(asked) == 0


def test_pieces_of_a_diagram_are_the_whole(monkeypatch):
    stop = np.zeros(1, np.int64)
    whole = harmonic_motion.diagram(DEFAULT, stop)["points"]
    monkeypatch.setattr(harmonic_motion, "PIECE_HITS", 5e3)
    pieces = harmonic_motion.diagram(DEFAULT, stop)["points"]
    assert all((whole[name] == pieces[name]).all() for name in ("value", "angle"))


@given(st.floats(-1000, 1000), st.integers(-11, 3), st.floats(0, 1))
def test_click_selects_a_short_number_nearer_than_the_next_point(low, power, share):
    span = Span(low, low + 10.0**power)
    at = low + share * span.width
    chosen = nearby(at, span)
    assert abs(chosen - at) <= 0.5001 * span.width / (POINTS - 1) + math.ulp(at)
    assert span.low <= chosen <= span.high
    assert chosen in (span.low, span.high) or len(written(chosen).lstrip("-")) <= 8 + max(0, -power)


def test_curve_of_a_mode_is_dotted_on_the_page_where_the_mode_is_not_admissible():
    shown = DEFAULT.changed({"curves": "symmetry-breaking-3,melnikov"})
    drawn = harmonic_maps.curves(shown, shown.map_axes)
    assert drawn["dash"] == [
        harmonic_maps.DASHES["symmetry-breaking-3"],
        harmonic_maps.DOTTED,
        harmonic_maps.DASHES["melnikov"],
    ]
    for periods, heights, holds in zip(drawn["xs"][:2], drawn["ys"][:2], (True, False), strict=True):
        inner = np.flatnonzero(np.isfinite(heights))[1:-1]
        modes = [rk.theory.symmetric_modes(heights[k] * (1 + 1e-12), periods[k], 0.925, 3)[0] for k in inner]
        assert {mode.admissible for mode in modes} == {holds}


@pytest.mark.parametrize("block", [{"brace_angle": "1"}, {"critical_angle": "0.25"}])
def test_curves_of_a_slender_block_without_braces_are_not_drawn_over_the_map_of_another(block):
    shown = DEFAULT.changed({"curves": "melnikov"} | block)
    assert harmonic_maps.curves(shown, shown.map_axes)["xs"] == []


KINDS = {
    "figure-2a": ("periodic", 1), "figure-2b": ("periodic", 3), "figure-2c": ("periodic", 10), "figure-4": ("overturned", None),
    "figure-5": ("quasi-periodic", None), "figure-6": ("chaotic or undetermined", None), "figure-11": ("periodic", 1),
    "figure-13a": ("chaotic", None),
    "coexisting": ("periodic", 3), "fractal": ("periodic", 1), "cascade": ("chaotic", None), "chaos-more-loss": ("chaotic", None),
    "crisis": ("chaotic", None),
}  # fmt: skip


CASES = pytest.mark.parametrize("case", presets.CASES, ids=lambda case: case.name)


@CASES
def test_case_of_the_gallery_is_what_it_says(case):
    """One run in six in the chaotic sea of figure 6, with phases that differ by rounding, stays near an island for long."""
    verdict = rk.classify(case.view.system, case.view.start)
    kinds, period = KINDS[case.name]
    assert verdict.kind in kinds.split(" or ")
    assert verdict.period == period


@CASES
def test_case_of_the_gallery_has_a_picture_of_its_phase_portrait(case):
    drawn = harmonic_motion.pictures()[case.name]
    assert re.fullmatch(r"M\d+ \d+(L\d+ \d+)*", drawn)
    places = np.array([each.split() for each in drawn[1:].split("L")], int)
    assert places.min() >= 0
    assert (places.max(axis=0) <= harmonic_motion.PICTURE).all()
    assert (np.ptp(places, axis=0) > 0.8 * np.array(harmonic_motion.PICTURE)).all()
    portrait = harmonic_motion.traces(case.view)["portrait"]
    left, right, bottom, top = portrait["ranges"]
    start = (
        (portrait["line"]["angle"][0] - left) / (right - left),
        (top - portrait["line"]["velocity"][0]) / (top - bottom),
    )
    assert places[0] == pytest.approx(np.array(start) * harmonic_motion.PICTURE, abs=0.51)


@CASES
def test_case_of_the_gallery_has_an_address_and_lines_of_python(case):
    assert HarmonicView.from_address(case.view.address) == (case.view, {})
    assert made_by_code(case.view)["system"] == case.view.system


def test_codes_of_criteria_in_a_map_have_the_level_that_classify_gives():
    found = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925), amplitude=[0.5, 2.0], period=[1.0, 2.0]
    ).dataset
    for amplitude, period in ((0.5, 1.0), (2.0, 1.0), (2.0, 2.0)):
        verdict = rk.classify(rk.System(rk.Harmonic(amplitude, period=period), 0.925))
        assert (
            Criterion(int(found.evidence.sel(amplitude=amplitude, period=period))).level
            == verdict.evidence.level
        )


def test_multipliers_are_told_as_a_pair():
    def told_of(amplitude, period):
        verdict = rk.classify(rk.System(rk.Harmonic(amplitude, period=period), 0.925))
        return verdict.multipliers, dict(texts.verdict(verdict, None)["facts"])["Floquet multipliers"]

    (complex_one, _), text = told_of(2.0, 1.0)
    assert text == f"−{-complex_one.real:.4g} ± {abs(complex_one.imag):.4g}i"
    assert told_of(1.0111, 4.7531) == ((0j, 0j), "0 and 0")


def test_response_that_forgets_is_told_in_the_words_of_the_command_line(rocking):
    code, _, out = rocking("classify --amplitude 0.5 --period 1 --restitution 0.925")
    verdict = rk.classify(rk.System(rk.Harmonic(0.5, period=1.0), 0.925))
    facts = dict(texts.verdict(verdict, None)["facts"])
    assert (code, facts["largest Lyapunov exponent λ₁"]) == (0, "−∞ (superstable)")
    assert facts["largest Lyapunov exponent λ₁"] in out


@pytest.mark.parametrize(
    "system, sentence",
    [
        (system_with(amplitude=0.5, restitution=0.925), "The block stands at rest."),
        (
            system_with(amplitude=2.0, restitution=0.925),
            "The block keeps moving and repeats its motion every cycle of the base.",
        ),
        (
            system_with(amplitude=6.5, period=0.4, restitution=0.925),
            "The block keeps moving and repeats its motion every 3 cycles of the base.",
        ),
        (system_with(amplitude=12.0, period=2.5, restitution=0.925), "The block falls over."),
    ],
)
def test_verdict_says_in_plain_words_what_the_block_does(system, sentence):
    assert texts.verdict(rk.classify(system), None)["sentence"] == sentence


def test_each_response_has_a_sentence():
    assert set(texts.SENTENCES) | {rk.Kind.PERIODIC} == set(rk.Kind)
