"""The page of ground motions in a real browser."""

import json
import math
import re
import urllib.error
import urllib.request

import numpy as np
import pytest
import xarray as xr

import record_files as write
import rocking as rk


@pytest.fixture
def ground(visit):
    """Open the page of ground motions in a new session."""

    def come(query="", **size):
        visitor = visit(**size)
        visitor.open("ground-motion" + query)
        return visitor

    return come


def figure(visitor, name):
    """Return the columns of the first source of a figure."""
    return {key: np.array(values) for key, values in json.loads(visitor.data(name))[0]}


def facts(visitor, name="facts"):
    return dict(re.findall(r"(.+)\n(.+)", visitor.text(name)))


def settled(visitor, act):
    """Act, and wait until the address has changed and the new motion is there."""
    before = visitor.page.url
    act()
    visitor.until("before => location.href !== before", arg=before)
    visitor.judged()


def block_of(visitor):
    height, width = (
        float(re.search(rf"{name}=([\d.]+)", visitor.page.url)[1]) for name in ("height", "width")
    )
    return rk.Block(height, width)


TITLE_WIDTH = """() => {
    const drawn = document.createElement("canvas").getContext("2d");
    drawn.font = "bold 12px system-ui, sans-serif";
    return drawn.measureText(models.base.title.text).width;
}"""
"""Width of the title above the base acceleration."""


@pytest.mark.parametrize(
    "width, height, scheme", [(1280, 800, "light"), pytest.param(360, 740, "dark", marks=pytest.mark.long)]
)
def test_page_opens_without_complaint_and_asks_no_other_host(ground, width, height, scheme):
    visitor = ground(width=width, height=height, scheme=scheme)
    visitor.finished()
    assert visitor.page.evaluate("document.documentElement.scrollWidth") <= width
    assert visitor.text("kind") == "rocks and stands"
    assert visitor.text("pga") == "PGA 0.532 g"
    assert visitor.text("sentence").endswith("The base accelerates 5 times as much as in the record.")
    assert visitor.text("ground-name") == "5 × San Francisco, 1295 Shafter, F 360°"
    title = visitor.page.evaluate("models.base.title.text")
    full = "Acceleration of the base: 5 × San Francisco, 1295 Shafter, F 360°"
    assert title == full or (width < 500 and title.endswith("…") and full.startswith(title[:-1]))
    assert visitor.page.evaluate(TITLE_WIDTH) < visitor.page.evaluate("find('base').clientWidth - 10")
    visitor.see(f"ground-{width}-{scheme}")
    visitor.is_content()


@pytest.mark.long
def test_pages_link_to_each_other(visit):
    visitor = visit()
    visitor.open()
    visitor.page.click("text=Ground motion")
    visitor.page.wait_for_selector("#ground")
    visitor.judged()
    assert "/ground-motion" in visitor.page.url
    visitor.page.click("text=Harmonic motion")
    visitor.page.wait_for_selector("#basin")
    visitor.judged()
    assert "/ground-motion" not in visitor.page.url
    visitor.is_content()


def test_click_on_the_map_shows_the_motion_of_that_block(ground):
    visitor = ground()
    settled(visitor, lambda: visitor.click("map", 0.3, 0.1))
    block = block_of(visitor)
    assert math.log(block.radius / 0.2) == pytest.approx(0.3 * math.log(50), abs=0.02)
    assert block.degrees(1.0) == pytest.approx(5.7, abs=0.1)
    motion = rk.simulate(block.system(rk.example_ground_motion().scaled(5.0)))
    assert motion.outcome == "overturned"
    assert visitor.text("kind") == "overturns"
    assert facts(visitor)["impacts"] == str(motion.impacts)
    drawn = figure(visitor, "history")
    angle, _ = motion.at(block.time(drawn["time"]))
    assert drawn["angle"] == pytest.approx(block.degrees(angle), abs=1e-6)
    visitor.see("ground-clicked")
    visitor.is_content()


@pytest.mark.long
def test_point_of_the_map_tells_the_block_under_the_pointer(ground):
    visitor = ground()
    visitor.finished()
    visitor.page.mouse.move(*visitor.place("map", 0.3, 0.1))
    visitor.until("document.getElementById('readout').textContent.startsWith('Height')")
    size, angle = 0.2 * 50**0.3, math.radians(5.7)
    height = float(re.search(r"Height ([\d.]+) m", visitor.text("readout"))[1])
    assert height == pytest.approx(2 * size * math.cos(angle), rel=0.02)
    assert "overturns" in visitor.text("readout")


@pytest.mark.long
def test_slider_scales_the_motion_and_the_map(ground):
    visitor = ground()
    visitor.finished()
    before = visitor.data("map")
    visitor.page.evaluate(
        """() => { const slider = document.getElementById('slider'); slider.value = 300;
                 slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change')); }"""
    )
    visitor.until("!location.search.includes('scale=5&')")
    visitor.finished()
    scale = float(re.search(r"scale=([\d.]+)", visitor.page.url)[1])
    assert scale == pytest.approx(0.1 * 200**0.3, rel=0.01)
    assert visitor.data("map") != before
    pga = rk.example_ground_motion().pga * scale / 9.80665
    assert float(re.search(r"PGA ([\d.]+) g", visitor.text("pga"))[1]) == pytest.approx(pga, rel=0.01)
    assert np.abs(figure(visitor, "base")["acceleration"]).max() == pytest.approx(pga, rel=1e-6)
    visitor.is_content()


@pytest.mark.long
def test_pulse_is_chosen_and_drawn(ground):
    visitor = ground()
    settled(visitor, lambda: visitor.page.select_option("#source", "pulse"))
    for name, value in (("amplitude", "0.4"), ("duration", "0.8"), ("scale", "2")):
        visitor.page.fill(f"#{name}", value)
        settled(visitor, lambda name=name: visitor.page.press(f"#{name}", "Enter"))
    block = block_of(visitor)
    pulse = rk.Pulse("one-sine", amplitude=2 * 0.4 * 9.80665, duration=0.8)
    motion = rk.simulate(block.system(pulse))
    assert facts(visitor)["impacts"] == str(motion.impacts)
    assert np.abs(figure(visitor, "base")["acceleration"]).max() == pytest.approx(0.8, rel=1e-6)
    visitor.page.wait_for_timeout(300)
    visitor.see("ground-pulse")
    visitor.is_content()


@pytest.mark.long
def test_synthetic_motion_is_that_of_the_package(ground):
    visitor = ground()
    settled(visitor, lambda: visitor.page.select_option("#source", "synthetic-2"))
    motion = rk.synthetic_ground_motions(3, seed=1)[1]
    for factor, name, words in (("5", "5 × synthetic 2", True), ("1", "synthetic 2", False)):
        visitor.page.fill("#scale", factor)
        settled(visitor, lambda: visitor.page.press("#scale", "Enter"))
        drawn = figure(visitor, "base")["acceleration"]
        assert np.abs(drawn).max() == pytest.approx(float(factor) * motion.pga / 9.80665, rel=1e-9)
        assert visitor.text("ground-name") == name
        assert ("times" in visitor.text("sentence")) == words


def drop(visitor, name, data):
    visitor.page.set_input_files("#file", {"name": name, "mimeType": "text/plain", "buffer": data})


def test_file_is_read_shown_and_not_part_of_the_link(ground):
    visitor = ground()
    samples = np.sin(np.arange(400) / 9) * np.exp(-np.arange(400) / 99)
    data = "\n".join(write.peer(0.3 * samples)).encode()
    settled(visitor, lambda: drop(visitor, "town.AT2", data))
    assert "town.AT2, PEER AT2" in visitor.text("ground-facts")
    assert np.abs(figure(visitor, "base")["acceleration"]).max() == pytest.approx(
        0.3 * np.abs(samples).max(), rel=1e-5
    )
    visitor.see("ground-file")
    visitor.page.reload()
    visitor.page.wait_for_selector("body[data-ready]")
    visitor.until("document.getElementById('file-refused').textContent !== ''")
    assert "not part of the link" in visitor.text("file-refused")
    visitor.is_content()


@pytest.mark.long
def test_file_may_be_dropped_on_the_page(ground):
    visitor = ground()

    def let_fall():
        visitor.page.evaluate(
            """text => { const carried = new DataTransfer();
                carried.items.add(new File([text], 'fallen.csv'));
                for (const type of ['dragover', 'drop']) document.body.dispatchEvent(
                    new DragEvent(type, { dataTransfer: carried, bubbles: true, cancelable: true })); }""",
            "time (s), acceleration (g)\n0, 0\n0.5, 0.3\n1, 0\n",
        )

    settled(visitor, let_fall)
    assert "fallen.csv" in visitor.text("ground-facts")
    assert np.abs(figure(visitor, "base")["acceleration"]).max() == pytest.approx(0.3)
    visitor.is_content()


@pytest.mark.long
def test_file_without_units_asks_for_them(ground):
    visitor = ground(width=360, height=740)
    drop(visitor, "bare.txt", "\n".join(f"{value:.5f}" for value in np.sin(np.arange(300) / 9)).encode())
    visitor.until("document.getElementById('file-refused').textContent !== ''")
    refused = visitor.text("file-refused")
    assert refused.endswith("the file does not state the unit of its samples; give it, for example m/s²")
    visitor.see("ground-units")
    visitor.page.select_option("#units-of-file", "m/s²")
    visitor.until("document.getElementById('file-refused').textContent.includes('step')")
    visitor.page.fill("#step", "0.02")
    settled(visitor, lambda: visitor.page.press("#step", "Enter"))
    assert visitor.text("file-refused") == ""
    assert figure(visitor, "base")["time"][-1] == pytest.approx(299 * 0.02)
    visitor.is_content()


@pytest.mark.long
def test_file_that_is_no_record_or_too_large_is_refused_in_one_line(ground):
    visitor = ground()
    drop(visitor, "letter.txt", b"some words\nin a letter\n")
    visitor.until("document.getElementById('file-refused').textContent !== ''")
    assert visitor.text("file-refused").startswith("letter.txt: neither a record nor a table")
    assert visitor.text("kind") == "rocks and stands"
    visitor.page.evaluate("() => give(new File([new Uint8Array(50_000_001)], 'big.at2'))")
    visitor.until("document.getElementById('file-refused').textContent.startsWith('big')")
    assert visitor.text("file-refused") == "big.at2: larger than 50 MB"
    assert visitor.page.evaluate("link.file") is None


@pytest.mark.long
def test_largest_file_arrives(ground):
    """Fifty megabytes of blanks around one small record fit into a message."""
    visitor = ground()
    visitor.page.evaluate(
        """() => { const bytes = new Uint8Array(50_000_000).fill(32);
                 bytes.set(new TextEncoder().encode('time (s), acceleration (g)\\n0, 0\\n0.5, 0.3\\n1, 0\\n'));
                 return give(new File([bytes], 'largest.csv')); }"""
    )
    visitor.until(
        "location.search.includes('source=file') || document.getElementById('file-refused').textContent"
    )
    assert visitor.text("file-refused") == ""
    assert "largest.csv" in visitor.text("ground-facts")
    visitor.is_content()


@pytest.mark.long
def test_link_gives_the_same_view_and_undo_the_one_before(ground):
    visitor = ground()
    settled(visitor, lambda: visitor.page.select_option("#source", "synthetic-3"))
    settled(visitor, lambda: visitor.click("map", 0.6, 0.5))
    link, kind = visitor.page.url, visitor.text("facts")
    other = ground("?" + link.partition("?")[2])
    assert (other.page.url, other.text("facts")) == (link, kind)
    visitor.page.click("#undo")
    visitor.until("document.getElementById('height').value === '2'")
    assert "height=2&width=0.5" in visitor.page.url


@pytest.mark.long
def test_zoom_computes_a_part_of_the_map_again(ground):
    visitor = ground()
    settled(visitor, lambda: visitor.page.click("[data-zoom='2']"))
    low, high = map(float, re.search(r"sizes=([\d.]+):([\d.]+)", visitor.page.url).groups())
    assert (low * high, high / low) == pytest.approx((2.0, math.sqrt(50)), rel=1e-9)
    visitor.finished()
    assert dict(json.loads(visitor.data("map"))[0])["w"][0] == pytest.approx(high - low, rel=0.05)
    settled(visitor, lambda: visitor.page.click("#whole"))
    assert "sizes" not in visitor.page.url


@pytest.mark.long
def test_map_is_saved_alike_in_both_formats(ground, tmp_path):
    visitor = ground()
    visitor.finished()
    visitor.page.click("[data-opens=take]")
    for control, name in (("[data-save=csv]", "map.csv"), ("#netcdf", "map.nc")):
        with visitor.page.expect_download() as waited:
            visitor.page.click(control)
        waited.value.save_as(tmp_path / name)
    rows = (tmp_path / "map.csv").read_text().splitlines()
    data = xr.open_dataset(tmp_path / "map.nc", engine="h5netcdf")
    assert len(rows) == data.outcome.size + 1
    last, corner = rows[-1].split(","), data.isel(size=-1, slenderness=-1)
    assert float(last[2]) == pytest.approx(float(corner.height), rel=1e-9)
    assert float(last[5]) == pytest.approx(float(corner.peak), rel=1e-6)
    visitor.see("ground-export")
    visitor.is_content()


def test_columns_of_saved_figures_have_units(ground, tmp_path):
    visitor = ground()
    visitor.page.click("[data-opens=take]")
    for name, columns in (("history", "time [s],angle [°]"), ("base", "time [s],acceleration [g]")):
        visitor.page.select_option("#which", name)
        with visitor.page.expect_download() as download:
            visitor.page.click("[data-save=csv]")
        download.value.save_as(tmp_path / name)
        assert (tmp_path / name).read_text().splitlines()[0] == columns
    visitor.is_content()


def test_page_answers_only_on_this_machine(running):
    request = urllib.request.Request(
        running.address + "ground-motion", headers=running.cookie | {"Host": "evil.com"}
    )
    with pytest.raises(urllib.error.HTTPError) as caught:
        urllib.request.urlopen(request)
    assert caught.value.code == 403
    caught.value.close()


@pytest.mark.long
def test_restrainer_takes_effect_with_the_mass(ground):
    visitor = ground()

    def told(act, words):
        act()
        visitor.until(
            "words => document.getElementById('stiffness-refused').textContent.includes(words)", words
        )

    def fill(name, value):
        visitor.page.fill(f"#{name}", value)
        visitor.page.press(f"#{name}", "Enter")

    told(lambda: fill("stiffness", "2e4"), "needs the mass")
    settled(visitor, lambda: fill("mass", "600"))
    assert "stiffness=20000&mass=600" in visitor.page.url
    assert "unstable balance θu" not in facts(visitor)
    settled(visitor, lambda: visitor.page.select_option("#model", "slender"))
    assert "stiffness=20000&mass=600&model=slender" in visitor.page.url
    block = rk.Block(2.0, 0.5, normalised_by="balance").restrained(2e4, mass=600.0)
    assert facts(visitor)["unstable balance θu"] == f"{block.degrees(1.0):.4g}°"
    settled(visitor, lambda: visitor.page.select_option("#model", "full"))
    settled(visitor, lambda: fill("stiffness", ""))
    assert "stiffness" not in visitor.page.url
    assert "model" not in visitor.page.url
    visitor.see("ground-restrained")
    visitor.is_content()


@pytest.mark.long
def test_vertical_channel_and_friction_change_the_verdict_and_not_the_map(ground):
    visitor = ground()
    assert not visitor.page.is_visible("#vertical")
    wave = 0.4 * np.sin(0.08 * np.arange(400)) * np.exp(-np.arange(400) / 150)
    lines = "\n".join(write.csmip_v1([wave, -wave, 0.5 * wave[::-1]])).replace("270 Deg", "Up")
    settled(visitor, lambda: drop(visitor, "three.v1", lines.encode()))
    visitor.finished()
    before = visitor.data("map")
    assert visitor.page.inner_text("#vertical") == "none\n3: Up"
    settled(visitor, lambda: visitor.page.select_option("#vertical", "3"))
    assert "vertical=3" in visitor.page.url
    ground, _, up = rk.read_ground_motions(lines.encode(), name="three.v1")
    motion = rk.simulate(rk.Block(2.0, 0.5).system(ground, vertical=up))
    angle = figure(visitor, "history")["angle"]
    assert np.abs(angle).max() == pytest.approx(math.degrees(math.atan(0.25)) * motion.peak, rel=1e-4)

    def fill(name, value):
        visitor.page.fill(f"#{name}", value)
        visitor.page.press(f"#{name}", "Enter")

    settled(visitor, lambda: fill("friction", "0.2"))
    assert visitor.text("kind") == "slides"
    refusal = motion.validity(rk.Block(2.0, 0.5), friction=0.2).refusal
    assert visitor.text("sentence").startswith(f"S{refusal[1:]}.")
    assert visitor.text("left-out") == "The map is computed without vertical motion and friction."
    assert (visitor.data("map"), visitor.page.get_attribute("body", "data-map")) == (before, "done")
    visitor.see("ground-vertical")
    settled(visitor, lambda: fill("friction", "0.8"))
    assert "; 0.8 suffices." in visitor.text("evidence")
    settled(visitor, lambda: fill("mass", "600"))
    fill("prestress", "800")
    visitor.until("document.getElementById('friction-refused').textContent !== ''")
    assert visitor.text("vertical-refused") == "vertical must be omitted for a restrained block"
    fill("friction", "")
    visitor.until("document.getElementById('friction-refused').textContent === ''")
    settled(visitor, lambda: visitor.page.select_option("#vertical", ""))
    assert "prestress=800&mass=600" in visitor.page.url
    assert visitor.text("left-out") == visitor.text("vertical-refused") == ""
    settled(visitor, lambda: fill("scale", "50"))
    settled(visitor, lambda: fill("prestress", ""))
    settled(visitor, lambda: visitor.page.select_option("#vertical", "3"))
    assert visitor.text("kind") == "not computed"
    assert "the block leaves the base" in visitor.text("sentence")
    visitor.is_content()


@pytest.mark.long
def test_block_against_a_wall_moves_to_one_side(ground):
    visitor = ground("?version=1&wall=0.5")
    assert facts(visitor)["e"] == "0.5 (wall)"
    assert figure(visitor, "history")["angle"].min() == 0.0
    visitor.see("ground-wall")
    visitor.is_content()


@pytest.mark.long
def test_full_equation_of_motion_changes_the_map_and_the_verdict(ground):
    visitor = ground("?version=1&source=pulse&amplitude=0.35&duration=0.6&scale=1")
    visitor.finished()
    assert "Certified" in visitor.text("evidence")
    assert "overestimates" not in visitor.text("evidence")
    block = block_of(visitor)
    pulse = rk.Pulse("one-sine", amplitude=0.35 * 9.80665, duration=0.6)
    motion = rk.simulate(block.system(pulse, model="full"))
    angle = figure(visitor, "history")["angle"]
    assert np.abs(angle).max() == pytest.approx(block.degrees(motion.peak), rel=1e-4)
    assert not visitor.page.is_visible("#normalised_by")
    visitor.see("ground-full")
    settled(visitor, lambda: visitor.page.select_option("#model", "slender"))
    assert "model=slender" in visitor.page.url
    assert "overestimates" in visitor.text("evidence")
    for by in ("tangent", "angle"):
        if by == "angle":
            settled(visitor, lambda: visitor.page.select_option("#normalised_by", "angle"))
        motion = rk.simulate(block.system(pulse, model="slender", normalised_by=by))
        angle = figure(visitor, "history")["angle"]
        assert np.abs(angle).max() == pytest.approx(block.degrees(motion.peak), rel=1e-4)
    assert "normalised_by=angle" in visitor.page.url
    visitor.see("ground-slender")
    visitor.is_content()
