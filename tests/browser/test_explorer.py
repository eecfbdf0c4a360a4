"""The explorer in a real browser."""

import csv
import io
import itertools
import json
import re
import subprocess
import sys
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from PIL import Image

import rocking as rk
from rocking.papers.yim_lin_1991.surveys import PERIODIC
from rocking.plot.palette import LOOKS

PICTURES = ("history", "portrait", "section", "spectrum", "basin")
# amplitude, period, restitution, and the known verdict
KNOWN = [
    ((2.0, 1.0, 0.925), "periodic", "1 cycle, symmetric", "impacts per period\n2\n"),
    ((6.5, 0.4, 0.925), "periodic", "3 cycles, symmetric", "impacts per period\n2\n"),
    ((1.75, 2.0, 0.95), "overturned", None, None),
]


@pytest.mark.parametrize(
    "width, height, scheme",
    [(1280, 800, "light"), pytest.param(390, 844, "dark", marks=pytest.mark.long)],
)
def test_page_opens_without_complaint_and_asks_no_other_host(visit, width, height, scheme):
    visitor = visit(width, height, scheme)
    visitor.open()
    visitor.finished()
    assert visitor.text("kind") == "periodic"
    assert visitor.page.evaluate("document.documentElement.scrollWidth") <= width
    visitor.see(f"open-{width}-{scheme}")
    visitor.is_content()


@pytest.mark.long
def test_click_changes_every_picture(visit):
    visitor = visit()
    visitor.open()
    before = {name: visitor.data(name) for name in PICTURES}
    visitor.click("map", 0.2, 0.9)
    visitor.until("document.getElementById('undo').disabled === false")
    visitor.judged()
    assert [name for name in PICTURES if visitor.data(name) == before[name]] == []
    typed = [visitor.page.input_value(f"#{name}") for name in ("amplitude", "period")]
    assert max(map(len, typed)) <= 5, "a click selects what the field has room to show"
    assert f"amplitude={typed[0]}&period={typed[1]}&" in visitor.page.url
    visitor.see("clicked")
    visitor.is_content()


def test_numbers_typed_give_the_known_verdict(visit):
    visitor = visit()
    visitor.open("?version=1&amplitude=3&period=0.7&restitution=0.9")
    for (amplitude, period, restitution), kind, symmetry, impacts in KNOWN:
        for name, value in (("amplitude", amplitude), ("period", period), ("restitution", restitution)):
            visitor.page.fill(f"#{name}", str(value))
            visitor.page.press(f"#{name}", "Enter")
        visitor.until(
            f"location.search === '?version=1&amplitude={amplitude:g}&period={period:g}&restitution={restitution:g}'"
        )
        visitor.judged()
        assert visitor.text("kind") == kind
        assert visitor.text("sentence").startswith("The block ")
        for words in filter(None, (symmetry, impacts)):
            assert words in visitor.text("facts")
    visitor.is_content()


def picture_of(visitor):
    """Return the colours of the map, upward axis first, and its ranges."""
    columns = dict(json.loads(visitor.data("map"))[0])
    image = np.array(columns["image"][0]).reshape(513, 513)
    return image, [columns[name][0] for name in ("x", "y", "w", "h")]


@pytest.mark.long
def test_zooming_to_the_overturning_boundary_shows_new_detail(visit):
    visitor = visit()
    visitor.open("?version=1&amplitude=4&period=1.3&restitution=0.925")
    visitor.finished()
    before, (x, y, wide, high) = picture_of(visitor)
    for _ in range(3):
        view = visitor.page.url
        visitor.wheel("map", 0.4, 0.25, -240)
        visitor.until("view => location.href !== view", arg=view)
        visitor.finished()
    after, (left, bottom, width, height) = picture_of(visitor)
    assert width < wide / 2
    assert height < high / 2
    # what the picture before showed there, magnified
    columns = ((left + width * (np.arange(513) + 0.5) / 513 - x) / wide * 513).astype(int)
    rows = ((bottom + height * (np.arange(513) + 0.5) / 513 - y) / high * 513).astype(int)
    magnified = before[np.ix_(rows, columns)]
    overturned = 10
    assert 0.01 < np.mean((after == overturned) != (magnified == overturned)) < 0.5
    assert 0.05 < np.mean(after == overturned) < 0.95
    visitor.see("zoomed")
    visitor.is_content()


@pytest.mark.long
def test_map_stops_and_says_so_where_double_precision_ends(visit):
    visitor = visit()
    low, high = 1.3, 1.3 + 1e-12
    visitor.open(
        f"?version=1&amplitude=4&period=1.3&restitution=0.925&periods={low!r}:{high!r}&amplitudes=4:{4 + 4e-12!r}"
    )
    visitor.finished()
    for _ in range(4):
        visitor.page.focus("#map")
        visitor.page.keyboard.press("+")
        visitor.page.wait_for_timeout(400)
    visitor.finished()
    assert visitor.text("depth") == "Zoom limit of double precision"
    low, high = map(float, re.search(r"periods=([^&:]*):([^&]*)", visitor.page.url).groups())
    assert 0 < high - low < 1e-12
    assert np.unique(np.linspace(low, high, 513)).size == 513
    visitor.see("deepest")
    visitor.is_content()


@pytest.mark.long
def test_case_of_the_paper_shows_its_figure(visit):
    case = PERIODIC[1]
    visitor = visit()
    visitor.open()
    visitor.page.click("text=Gallery")
    visitor.until("[...document.querySelectorAll('.cases path')].every(each => each.getTotalLength() > 100)")
    visitor.see("gallery")
    visitor.page.click("[data-case=figure-2b]")
    visitor.until("location.search.includes('first=600')")
    visitor.judged()
    assert "3 cycles, symmetric" in visitor.text("facts")
    columns = dict(json.loads(visitor.data("history"))[0])
    times = np.array(columns["time"])
    first, last = case.cycles
    period = case.system.forcing.period
    assert times[[0, -1]] == pytest.approx([first * period, last * period])
    angles, _ = case.motion().at(times[::50])
    assert np.array(columns["angle"])[::50] == pytest.approx(angles, abs=1e-9)
    visitor.see("figure-2b")
    visitor.is_content()


@pytest.mark.long
def test_shared_link_gives_the_same_view_and_back_the_one_before(visit):
    one, other = visit(), visit()
    one.open()
    one.page.fill("#amplitude", "6.5")
    one.page.press("#amplitude", "Enter")
    one.until("location.search.includes('amplitude=6.5')")
    one.page.click("text=Melnikov")
    one.until("location.search.includes('curves=melnikov')")
    one.judged()
    one.finished()
    other.open(one.page.url.removeprefix(one.running.address))
    other.finished()
    assert other.text("evidence") == one.text("evidence")
    for name in ("map", "history", "portrait"):
        assert other.data(name) == one.data(name)
    one.page.go_back()
    one.until("!location.search.includes('curves')")
    one.page.go_back()
    one.until("location.search.includes('amplitude=2&')")
    one.until("document.getElementById('amplitude').value === '2'")
    one.page.click("#redo")
    one.until("location.search.includes('amplitude=6.5')")
    one.judged()
    one.is_content()
    other.is_content()


def test_bad_number_is_refused_at_its_field_and_changes_nothing(visit):
    visitor = visit()
    visitor.open()
    before = visitor.page.url, visitor.data("history")
    wrong = {"amplitude": "-1", "period": "soon", "restitution": "1.2", "cycles": "1e9", "angle": "nan"}
    for name, typed in wrong.items():
        visitor.page.fill(f"#{name}", typed)
        visitor.page.press(f"#{name}", "Enter")
        visitor.page.wait_for_selector(f"#{name}[aria-invalid=true]")
        refusal = rf"{name} must be a (whole )?number in \[.*\]; got '{typed}'"
        assert re.match(refusal, visitor.text(f"{name}-refused"))
        assert (visitor.page.url, visitor.data("history")) == before
    visitor.see("refused")
    visitor.is_content()


@pytest.mark.long
def test_bad_address_opens_with_a_word_on_what_is_wrong(visit):
    visitor = visit()
    visitor.open("?version=1&amplitude=12&period=-3&restitution=0.9")
    assert "period must be a number in" in visitor.text("period-refused")
    assert visitor.page.input_value("#amplitude") == "12"
    visitor.is_content()


NAMED = (
    "[...document.querySelectorAll('#attractors li')].map(each => each.childNodes[1].textContent).join('; ')"
)


@pytest.mark.long
def test_basin_has_a_legend_of_its_attractors_mirror_images_apart(visit):
    visitor = visit(390, 844, "dark")
    visitor.open("?version=1&amplitude=14&period=1.35&restitution=0.925")
    visitor.until(f"{NAMED} === 'overturned; {LOOKS[2].name}; another orbit'")
    shares = re.findall(r"([\d.]+) %", visitor.text("attractors"))
    assert sum(map(float, shares)) == pytest.approx(100, abs=0.2)
    colours = visitor.page.evaluate(
        "[...document.querySelectorAll('#attractors i')].map(each => each.style.background)"
    )
    assert len(set(colours)) == 3
    visitor.finished()
    image = np.array(dict(json.loads(visitor.data("basin"))[0])["image"][0])
    asymmetric = 2
    assert {asymmetric, asymmetric + len(LOOKS)} <= set(image.ravel().tolist())
    visitor.page.locator("#basin-picture").scroll_into_view_if_needed()
    visitor.see("twins")
    visitor.page.fill("#amplitude", "2")
    visitor.page.press("#amplitude", "Enter")
    visitor.until(f"!{NAMED}.includes('another')")
    visitor.is_content()


@pytest.mark.long
def test_two_visitors_do_not_disturb_each_other(visit):
    one, other = visit(), visit()
    one.open("?version=1&amplitude=6.5&period=0.4&restitution=0.925")
    other.open("?version=1&amplitude=1.75&period=2&restitution=0.95")
    one.click("map", 0.3, 0.5)
    other.click("map", 0.7, 0.9)
    for visitor in (one, other):
        visitor.until("document.getElementById('undo').disabled === false")
        visitor.judged()
        visitor.finished()
    assert "restitution=0.925" in one.page.url
    assert "restitution=0.95" in other.page.url
    assert (one.text("kind"), other.text("kind")) == ("periodic", "overturned")
    one.is_content()
    other.is_content()


LABELS = """[...document.querySelectorAll(".plot")].map(({ id }) => {
    const { below, left } = models[id]; return [id, below[0].axis_label, left[0].axis_label]; })"""


@pytest.mark.long
def test_units_of_fields_figures_tables_and_link_are_those_chosen_at_the_top(visit, tmp_path):
    visitor = visit()
    visitor.open()
    before = dict(json.loads(visitor.data("history"))[0])
    visitor.page.select_option("#units", "si")
    visitor.until("location.search.includes('height=2&width=0.5')")
    visitor.judged()
    visitor.finished()
    block = rk.Block(2.0, 0.5)
    drawn = dict(json.loads(visitor.data("history"))[0])
    assert drawn["angle"] == pytest.approx(block.degrees(before["angle"]))
    assert drawn["time"] == pytest.approx(block.seconds(before["time"]))
    labels = visitor.page.locator("#fields label:visible").all_inner_texts()
    assert [" ".join(label.split()) for label in labels if "equation" not in label] == [
        "H height m", "B width m", "d offset m", "e restitution", "f frequency Hz", "a acceleration m/s²", "φ phase rad",
        "θ₀ initial angle °", "θ̇₀ initial velocity °/s", "θb brace angle °", "r restitution", "first cycle", "cycles",
    ]  # fmt: skip
    for name, value in (("width", "0.6"), ("amplitude", "0.4 g"), ("frequency_hz", "1.2")):
        visitor.page.fill(f"#{name}", value)
        visitor.page.press(f"#{name}", "Enter")
        visitor.page.wait_for_selector(f"#{name}:not([data-typing])")
    visitor.until("shown.fields.frequency_hz === '1.2'")
    visitor.judged()
    visitor.finished()
    assert float(visitor.page.input_value("#restitution").strip("≈")) == pytest.approx(
        rk.Block(2.0, 0.6).restitution, rel=1e-3
    )
    assert "forcing\n3.923 m/s² (0.4 g), 0.8333 s (1.2 Hz)" in visitor.text("facts")
    assert visitor.page.evaluate(LABELS) == [
        ["map", "period (s)", "amplitude aₓ (m/s²)"],
        ["history", "time t (s)", "angle θ (°)"],
        ["portrait", "angle θ (°)", "velocity θ̇ (°/s)"],
        ["section", visitor.page.evaluate("models.section.below[0].axis_label"), "velocity θ̇ (°/s)"],
        ["basin", "initial angle θ₀ (°)", "initial velocity θ̇₀ (°/s)"],
        ["spectrum", "frequency (Hz)", "density S (°²/Hz)"],
        ["diagram", "amplitude aₓ (m/s²)", "angle θ (°)"],
    ]
    visitor.click("map", 0.5, 0.5)
    visitor.until("shown.fields.frequency_hz !== '1.2'")
    visitor.judged()
    x_range, y_range = (visitor.page.evaluate(f"models.map.{name}.end") for name in ("x_range", "y_range"))
    low = visitor.page.evaluate("models.map.x_range.start")
    assert visitor.page.evaluate("Number(shown.fields.period)") == pytest.approx(
        (low + x_range) / 2, rel=0.02
    )
    assert visitor.page.evaluate("Number(shown.fields.amplitude)") == pytest.approx(y_range / 2, rel=0.02)
    assert re.search(r"[\d.]+ s \([\d.]+ Hz\), [\d.]+ m/s²: ", visitor.text("readout"))
    visitor.page.click("[data-opens=take]")
    visitor.page.select_option("#which", "map")
    with visitor.page.expect_download() as download:
        visitor.page.click("[data-save=csv]")
    download.value.save_as(tmp_path / "map.csv")
    assert (tmp_path / "map.csv").read_text().startswith("period [s],amplitude [m/s²],response,")
    assert "block.system(acceleration=" in visitor.text("python")
    visitor.page.keyboard.press("Escape")
    visitor.see("si")
    other = visit()
    other.open(visitor.page.url.removeprefix(visitor.running.address))
    assert other.page.input_value("#units") == "si"
    assert other.data("history") == visitor.data("history")
    visitor.page.select_option("#units", "")
    visitor.until("!location.search.includes('height')")
    visitor.judged()
    assert visitor.page.evaluate("models.history.below[0].axis_label") == "time τ"
    visitor.page.select_option("#units", "si")
    visitor.until("location.search.includes('height=2&width=0.6')")
    visitor.is_content()
    other.is_content()


# Controls whose middle belongs to something else
COVERED = """within => [...document.querySelector(within).querySelectorAll("button, input, select")].filter(each => {
    if (!each.checkVisibility()) return false;
    each.scrollIntoView({ block: "center" });
    const box = each.getBoundingClientRect();
    return document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2) !== each;
}).map(each => each.outerHTML)"""
CUT = """() => [...document.querySelectorAll("#fields label > *")].filter(each => each.scrollWidth > each.clientWidth)
    .map(each => each.value ?? each.textContent)"""
SCREENS = pytest.mark.parametrize("width, height", [(1280, 800), (390, 844)])


@SCREENS
@pytest.mark.long
def test_block_in_metres_that_cannot_be_is_refused_without_covering_anything(visit, width, height):
    visitor = visit(width, height)
    visitor.open("?version=1&height=2&width=0.5")
    for name, text in (("width", "9"), ("frequency_hz", "soon")):
        visitor.page.fill(f"#{name}", text)
        visitor.page.press(f"#{name}", "Enter")
        visitor.page.wait_for_selector(f"#{name}[aria-invalid=true]")
    assert visitor.text("frequency_hz-refused").endswith("; got 'soon'")
    assert visitor.page.evaluate("document.documentElement.scrollWidth") <= width
    visitor.see(f"metres-refused-{width}")
    visitor.page.locator("#frequency_hz").press_sequentially("1")
    assert not visitor.page.is_visible("#frequency_hz-refused")
    visitor.page.select_option("#model", "full")
    visitor.until("location.search.includes('critical_angle=0.2449')")
    visitor.is_content()


@SCREENS
@pytest.mark.long
def test_fields_have_words_beside_their_symbols_and_room_for_what_they_hold(visit, width, height):
    visitor = visit(width, height)
    visitor.open(
        "?version=1&amplitude=1.2487408494631143&period=2.2260119362057162&restitution=0.9117647058823529"
        "&angle=-0.12345678&velocity=0.000123456789"
    )
    labels = visitor.page.locator("#fields label:visible").all_inner_texts()
    assert [" ".join(label.split()) for label in labels] == [
        "e restitution", "θcr critical angle rad", "A amplitude g θcr", "T period 1/α", "φ phase rad", "Θ₀ initial angle θcr",
        "Θ′₀ initial velocity α θcr", "Θb brace angle θcr", "r restitution", "first cycle", "cycles",
    ]  # fmt: skip
    headings = visitor.page.locator("#fields legend").all_inner_texts()
    assert headings == ["Block", "Base motion", "Start", "Braces", "Cycles shown"]
    assert (
        visitor.page.evaluate(
            "[...document.querySelectorAll('#fields label')].filter(each => !each.title && !each.querySelector('[title]'))"
        )
        == []
    )
    assert visitor.page.evaluate(CUT) == []
    assert visitor.page.evaluate("document.documentElement.scrollWidth") <= width
    visitor.page.fill("#velocity", "x")
    visitor.page.press("#velocity", "Enter")
    visitor.page.wait_for_selector("#velocity[aria-invalid=true]")
    assert visitor.text("velocity-refused").endswith("; got 'x'"), (
        "what is typed takes the place of all digits"
    )
    assert visitor.page.evaluate(COVERED, "#fields") == []
    assert visitor.page.evaluate(COVERED, "#map-picture .tools") == []
    visitor.see(f"fields-{width}")
    visitor.is_content()


@pytest.mark.long
def test_critical_angle_selects_the_full_block(visit):
    visitor = visit()
    visitor.open("?version=1&curves=melnikov")
    before = visitor.data("history")
    assert visitor.page.is_enabled("#curves input[name=melnikov]")
    visitor.page.fill("#critical_angle", "0.25")
    visitor.page.press("#critical_angle", "Enter")
    visitor.until("location.search.includes('critical_angle=0.25')")
    visitor.judged()
    assert visitor.data("history") != before
    assert not visitor.page.is_enabled("#curves input[name=melnikov]")
    assert "critical_angle=0.25" in visitor.page.text_content("#python")
    visitor.see("full-block")
    visitor.is_content()


@pytest.mark.long
def test_what_is_taken_along_gives_the_same(visit, tmp_path):
    visitor = visit()
    visitor.open("?version=1&amplitude=6.5&period=0.4&restitution=0.925")
    visitor.finished()
    visitor.page.click("text=Export")
    visitor.see("take")
    evidence = visitor.text("evidence")
    (tmp_path / "lines.py").write_text(visitor.text("python"))
    told = subprocess.run(
        [sys.executable, tmp_path / "lines.py"], capture_output=True, text=True, check=True, timeout=120
    )
    assert told.stdout == f"periodic: {evidence}\n"
    command = visitor.text("commands").splitlines()[0]
    done = subprocess.run(
        [sys.executable, "-m", *command.split()], capture_output=True, text=True, check=True, timeout=120
    )
    assert evidence in " ".join(done.stdout.split())
    visitor.is_content()


PAGES = {
    "": {
        "map": ["period", "amplitude", "response", "response_period", "evidence", "exponent"],
        "history": ["time", "angle", "velocity"],
        "portrait": ["angle", "velocity"],
        "section": ["angle", "velocity"],
        "spectrum": ["frequency", "density"],
        "basin": ["angle", "velocity", "response", "response_period", "evidence", "exponent", "orbit"],
        "diagram": ["value", "angle"],
    },
    "ground-motion": {
        "map": [
            "size_m",
            "critical_angle_deg",
            "height_m",
            "width_m",
            "outcome",
            "peak",
            "margin",
            "certified",
        ],
        "history": ["time [s]", "angle [°]"],
        "base": ["time [s]", "acceleration [g]"],
    },
}
"""Columns of the table of each figure, by the addresses of the pages."""
MAPS = ("map", "basin")


@pytest.mark.parametrize("page, scheme", [("", "dark"), ("ground-motion", "light")])
@pytest.mark.long
def test_each_figure_is_saved_in_each_format(visit, tmp_path, page, scheme):
    visitor = visit(scheme=scheme)
    visitor.open(page)
    visitor.finished()
    visitor.until("!models.basin || answers.basin")
    visitor.page.click("[data-opens=take]")
    offered = visitor.page.eval_on_selector_all("#which option", "options => options.map(each => each.value)")
    assert offered == list(PAGES[page])
    for figure, columns in PAGES[page].items():
        visitor.page.select_option("#which", figure)
        saved = {}
        for kind in ("png", "svg", "csv"):
            with visitor.page.expect_download() as download:
                visitor.page.click(f"[data-save={kind}]")
            assert download.value.suggested_filename == f"rocking-{figure}.{kind}"
            saved[kind] = tmp_path / f"{figure}.{kind}"
            download.value.save_as(saved[kind])
        with Image.open(saved["png"]) as picture:
            assert len(picture.convert("RGB").getcolors(picture.width * picture.height)) > 5, figure
        drawn = [each.tag.rpartition("}")[2] for each in ET.parse(saved["svg"]).iter()]
        assert drawn.count("text") >= 6, (figure, "the labels of the axes")
        assert drawn.count("path") >= 10, (figure, "axes, ticks and contents")
        assert figure not in MAPS or "image" in drawn
        names, *rows = csv.reader(saved["csv"].read_text().splitlines())
        assert names == columns
        assert rows
        assert {len(row) for row in rows} == {len(names)}
        words = {"response", "evidence", "outcome"}
        numbers = [name not in words for name in names]
        assert len([float(text) for text in itertools.compress(rows[-1], numbers)]) >= 2
    visitor.is_content()


@pytest.mark.long
def test_pointing_at_the_map_tells_kind_period_evidence_and_exponent(visit):
    visitor = visit()
    visitor.open()
    visitor.finished()
    visitor.page.mouse.move(*visitor.place("map", 0.05, 0.35))
    told = visitor.text("readout")
    assert re.search(
        r"T = 0\.3\d*, A = 5\.\d*: period 3; repeats after 3 cycles, 2 impacts; .*\(verified\); λ₁ = −0\.\d+ per τ",
        told,
    )
    visitor.is_content()


OTHER = {"": ("restitution", "0.8"), "ground-motion": ("scale", "0.5")}
"""Field of each page, and a value that gives another system."""


LATE = """async () => {
    for (let each; (each = held.shift()); await new Promise(requestAnimationFrame)) drawing(each);
    window.draw = drawing;
}"""
"""Draw what was held back, one message after another."""


@pytest.mark.parametrize("page", OTHER)
@pytest.mark.long
def test_readout_table_and_verdict_belong_to_the_system_shown(visit, page):
    visitor = visit()
    visitor.open(page)
    visitor.finished()
    place = visitor.place("map", 0.12, 0.3)
    visitor.page.mouse.move(*place)
    before = visitor.text("readout")
    assert "Hover" not in before
    visitor.page.evaluate(
        "window.drawing = draw; window.held = []; window.draw = drawn => held.push(drawn); 0"
    )
    name, value = OTHER[page]
    visitor.page.fill(f"#{name}", value)
    visitor.page.press(f"#{name}", "Enter")
    visitor.until(f"location.search.includes('{name}={value}')")
    assert visitor.text("readout") == "Computing …", "as long as the new map is not there"
    visitor.page.click("[data-opens=take]")
    visitor.page.click("[data-save=csv]")
    assert visitor.text("notice") == "The figure is not computed yet: save it when it is."
    visitor.page.keyboard.press("Escape")
    visitor.page.evaluate(LATE)
    visitor.finished()
    after = visitor.text("readout")
    assert after.partition(":")[0] == before.partition(":")[0]
    assert after != before
    visitor.page.mouse.move(place[0] + 40, place[1])
    visitor.page.mouse.move(*place)
    assert visitor.text("readout") == after
    visitor.judged()
    assert visitor.text("facts")
    visitor.page.evaluate("outdate({ renewed: [], moved: true })")
    visitor.until("document.getElementById('kind').textContent === '…'")
    assert visitor.text("facts") + visitor.text("evidence") == ""
    visitor.is_content()


@pytest.mark.long
def test_page_asks_for_the_token_and_its_link_holds_none(browser, running, tmp_path):
    """Other pages and files lead to the page, too; the browser then keeps the cookie back at first."""
    here, token = running.link.split("?token=")
    view = "?version=1&amplitude=3&period=0.7&restitution=0.9"
    with browser.new_context() as context:
        page = context.new_page()
        for leads in (view, f"{view}&token=wrong"):
            assert page.goto(here + leads).status == 403
        assert page.inner_text("[role=alert]") == "This is not the token of this page."
        page.fill("#token", running.link)
        page.click("button")
        page.wait_for_selector("body[data-ready]")
        page.wait_for_selector("#verdict:not(.stale)")
        assert page.url == here + view
        page.click("[data-opens=take]")
        assert page.inner_text("#link-text") == here + view
        assert token not in page.content() + page.evaluate("document.cookie + JSON.stringify(localStorage)")
        [cookie] = context.cookies()
        assert (cookie["httpOnly"], cookie["sameSite"]) == (True, "Strict")
    for leads, second in ((running.link, here), (running.link, here + view)):
        with browser.new_context() as context:
            page = context.new_page()
            for number, address in enumerate((leads, second)):
                way = tmp_path / f"{number}.html"
                way.write_text(f'<meta http-equiv="refresh" content="0; url={address}">')
                page.goto(way.as_uri())
                page.wait_for_selector("body[data-ready]")
            assert token not in page.url


@pytest.mark.long
def test_section_grows_to_a_hundred_thousand_points(visit):
    visitor = visit()
    visitor.open("?version=1&amplitude=10.103037&period=1.721328&restitution=0.8")
    label = "Bokeh.documents[0].get_model_by_name('section').below[0].axis_label"
    first = int(visitor.page.evaluate(label).partition("–")[2].replace(",", ""))
    visitor.until(f"{label} === 'angle Θ, cycles 10,001–100,000'")
    assert first < 100_000
    visitor.see("chaotic")
    visitor.is_content()


STOPS = """() => {
  const stops = [...document.querySelectorAll("header button, header select, main button, main input, main select, #map, #basin")]
    .filter(each => each.checkVisibility());
  stops.forEach((each, n) => { each.disabled = false; each.dataset.stop = n; });
  document.activeElement.blur();
  return stops.length;
}"""
NAMELESS = """() => {
  const named = each => each.getAttribute("aria-label") || each.textContent.trim() || each.closest("label")?.textContent.trim();
  const pictures = [...document.querySelectorAll(".plot, canvas#block")].filter(each => each.getAttribute("role") !== "img");
  return [...document.querySelectorAll("button, input, select, [role=img]")].filter(each => !named(each)).concat(pictures)
    .map(each => each.outerHTML);
}"""


@pytest.mark.long
def test_every_control_is_reached_by_the_keyboard_and_has_a_name(visit):
    visitor = visit()
    visitor.open()
    visitor.finished()
    wanted, reached = visitor.page.evaluate(STOPS), set()
    for _ in range(wanted + 20):
        visitor.page.keyboard.press("Tab")
        reached.add(visitor.page.evaluate("document.activeElement?.dataset?.stop"))
    assert {str(stop) for stop in range(wanted)} <= reached
    assert visitor.page.evaluate(NAMELESS) == []


CONTRAST = """() => {
  const channel = value => { value /= 255; return value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4; };
  const parse = text => text.match(/[\\d.]+/g).map(Number);
  const light = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
  const behind = node => {
    for (; node; node = node.parentElement) {
      const colour = parse(getComputedStyle(node).backgroundColor);
      if (colour.length < 4 || colour[3] > 0) return colour;
    }
    return [255, 255, 255];
  };
  const written = node => [...node.childNodes].some(each => each.nodeType === 3 && each.textContent.trim());
  const poor = [];
  for (const dialog of document.querySelectorAll("dialog")) dialog.show();
  for (const node of document.querySelectorAll("header *, main *, dialog *")) {
    if (node.closest(":disabled") || !written(node)) continue;
    const [one, other] = [light(parse(getComputedStyle(node).color)), light(behind(node))];
    const ratio = (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
    if (ratio < 4.5) poor.push([node.tagName, node.textContent.trim().slice(0, 30), ratio]);
  }
  return poor;
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.long
def test_text_stands_out_from_its_ground(visit, scheme):
    visitor = visit(1280, 800, scheme)
    visitor.open()
    visitor.finished()
    assert visitor.page.evaluate(CONTRAST) == []


EDGES = """() => [...document.querySelectorAll(".plot")].map(each => each.getBoundingClientRect())
    .map(({ left, top, width, height }) => [left, top, width, height])"""


SLENDER = "ground-motion?version=1&source=example&scale=5&height=2&width=0.5&model=slender"
"""Page of ground motions with slender blocks, whose map takes a second or two."""


@pytest.mark.parametrize("page", ["", SLENDER], ids=["harmonic", "ground-motion"])
def test_change_of_colours_leaves_no_line_at_the_edges_of_a_figure(visit, page):
    visitor = visit(1280, 1600)
    visitor.open(page)
    visitor.finished()
    visitor.page.click("#theme")
    visitor.page.wait_for_timeout(500)
    screen = Image.open(io.BytesIO(visitor.page.screenshot())).convert("RGB")
    paper = screen.getpixel((2, 1590))
    for left, top, _, height in visitor.page.evaluate(EDGES):
        column = [screen.getpixel((round(left) + across, round(top + height) - 12)) for across in (0, 1)]
        row = [screen.getpixel((round(left) + 3, round(top) + down)) for down in (0, 1)]
        assert set(column + row) == {paper}
    visitor.is_content()


PLACES = """Object.fromEntries(["verdict", "scene", "map", "fields", "block"].map(name => {
    const { left, top, right, bottom } = document.getElementById(name).getBoundingClientRect();
    return [name, { left, top, right, bottom, high: bottom - top, wide: right - left }]; }))"""


def test_first_screen_of_a_phone_has_the_verdict_in_words_and_the_moving_block(visit):
    visitor = visit(390, 844)
    visitor.open()
    places = visitor.page.evaluate(PLACES)
    assert places["verdict"]["bottom"] <= places["scene"]["top"] < places["scene"]["bottom"] <= 844
    assert places["scene"]["bottom"] <= places["map"]["top"] < 844
    assert places["map"]["bottom"] <= places["fields"]["top"]
    assert visitor.page.is_visible("#sentence")


@pytest.mark.parametrize("page", ["", SLENDER], ids=["harmonic", "ground-motion"])
def test_moving_block_is_as_large_as_the_map_and_beside_it(visit, page):
    visitor = visit()
    visitor.open(page)
    visitor.finished()  # the legend is complete, and with it the height of the row
    places = visitor.page.evaluate(PLACES)
    assert (
        places["fields"]["right"] <= places["map"]["left"] < places["map"]["right"] <= places["scene"]["left"]
    )
    assert places["block"]["high"] >= 0.9 * places["map"]["high"]
    assert places["scene"]["wide"] >= 0.9 * places["map"]["wide"]
    assert places["scene"]["bottom"] <= 800


@pytest.mark.parametrize("page", ["", "ground-motion"])
def test_numbers_of_a_verdict_are_folded_behind_its_sentence_and_not_clipped(visit, page):
    visitor = visit()
    visitor.open(page)
    assert not visitor.page.is_visible("#facts")
    assert visitor.page.inner_text("#sentence").startswith("The block ")
    assert re.fullmatch(r"Numbers and evidence: (verified|certified)", visitor.page.inner_text("summary"))
    visitor.page.click("summary")
    assert visitor.page.is_visible("#evidence")
    assert (
        visitor.page.evaluate(
            "(({ scrollHeight, clientHeight }) => scrollHeight - clientHeight)(document.getElementById('verdict'))"
        )
        == 0
    )
    visitor.see(f"numbers-{page}")
