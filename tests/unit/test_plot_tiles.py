"""Tiles: one pixel per point of the map, every second one in coarser images; the page needs no other file."""

import json
import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from PIL import Image

import rocking as rk
from rocking.plot.palette import LOOKS, NONE, looks
from rocking.plot.zoomable_map import Pyramid

UP, ACROSS = 700, 300
EDGE = 256


def scattered(rows=UP, columns=ACROSS, seed=5):
    """A map in which every kind, odd and even periods, both symmetries and points not computed are found everywhere."""
    draw = np.random.default_rng(seed)
    shape = rows, columns
    kinds = draw.choice([0, 1, 2, 3, 4, 5, 255], shape).astype(np.uint8)
    fields = {
        "kind": kinds,
        "response_period": draw.integers(1, 9, shape).astype(np.int32),
        "symmetric": draw.integers(0, 2, shape).astype(np.uint8),
    }
    axes = {"amplitude": np.linspace(0.0, 16.0, rows), "period": np.linspace(0.2, 3.0, columns)}
    variables = {name: (("amplitude", "period"), values) for name, values in fields.items()}
    return xr.Dataset(variables, axes, {"restitution": 0.925})


@pytest.fixture(scope="module")
def found():
    return scattered()


@pytest.fixture(scope="module")
def page(found, tmp_path_factory):
    return rk.plot.tiles(found, tmp_path_factory.mktemp("tiles") / "map")


def image_of(page, level, suffix=""):
    """Return the tiles of a level as one RGBA image."""
    names = [
        re.fullmatch(rf"(\d+)-(\d+){suffix}", path.stem)
        for path in (page.parent / "tiles" / str(level)).iterdir()
    ]
    parts = {tuple(map(int, name.groups())): name[0] for name in names if name}
    rows, columns = (1 + max(place[axis] for place in parts) for axis in (0, 1))
    read = [
        [np.asarray(Image.open(page.parent / "tiles" / str(level) / f"{row}-{column}{suffix}.png").convert("RGBA"))
         for column in range(columns)]
        for row in range(rows)
    ]  # fmt: skip
    assert all(part.shape[0] == EDGE for row in read[:-1] for part in row)
    assert all(part.shape[1] == EDGE for row in read for part in row[:-1])
    return np.vstack([np.hstack(row) for row in read])


def colours_of(found):
    """Return the map's colours as an image, largest amplitude on top; missing points are transparent."""
    codes = looks(*(found[name].values for name in ("kind", "response_period", "symmetric")))[::-1]
    table = np.zeros((NONE + 1, 4), np.uint8)
    for number, look in enumerate(LOOKS):
        table[number] = (*(round(255 * part) for part in to_rgb(look.colour)), 255)
    return codes, table[codes]


@pytest.mark.parametrize("level, step", [(2, 1), (1, 2), (0, 4)])
def test_every_level_is_every_nth_point_in_the_maps_colours(found, page, level, step):
    _, colours = colours_of(found)
    expected, drawn = colours[::step, ::step], image_of(page, level)
    assert drawn.shape == expected.shape
    opaque = expected[..., 3] == 255
    assert (drawn[..., 3] == expected[..., 3]).all()
    assert (drawn[opaque] == expected[opaque]).all()


def test_masks_are_where_the_looks_are_hatched(found, page):
    codes, _ = colours_of(found)
    numbers = [number for number, look in enumerate(LOOKS) if look.hatch == "#262626"]
    assert len(numbers) == 1
    assert ((image_of(page, 2, "-dark")[..., 3] == 255) == np.isin(codes, numbers)).all()


def test_masks_that_the_page_asks_for_are_those_that_are_there(page):
    view = json.loads(re.search(r'id="view">(.*?)</script>', page.read_text(), re.DOTALL)[1])
    asked = {f"{name}-{hatch}" for hatch, names in view["hatched"].items() for name in names}
    there = page.parent.rglob("*-*-*.png")
    assert asked == {path.relative_to(page.parent / "tiles").with_suffix("").as_posix() for path in there}


def test_page_says_the_axes_the_shares_and_what_is_fixed(found, page):
    text = page.read_text(encoding="utf-8")
    view = json.loads(re.search(r'id="view">(.*?)</script>', text, re.DOTALL)[1])
    assert view["deepest"] == 2
    for name, part in (("amplitude", "up"), ("period", "across")):
        np.testing.assert_allclose(view[part]["values"], found[name], rtol=1e-8)
    counts = np.bincount(colours_of(found)[0].ravel(), minlength=NONE + 1)
    shares = dict(re.findall(r"<span>([^<]*)</span><span>([\d.]+) %", text))
    assert len(shares) == len(LOOKS) + 1
    for number, look in enumerate(LOOKS):
        assert float(shares[look.name]) == pytest.approx(100 * counts[number] / counts.sum(), abs=0.051)
    assert "<dt>restitution</dt><dd>0.925</dd>" in text
    assert "700 × 300" in text


def test_page_and_its_folder_have_no_address_of_another_host(page):
    """Nothing but pictures and the page itself; in it no scheme but data, no import, and nothing fetched."""
    assert {path.suffix for path in page.parent.rglob("*.*")} == {".html", ".png"}
    text = page.read_text(encoding="utf-8")
    assert not re.search(r"https?:|//\w+\.\w|@import|fetch\(|XMLHttp|import\(", text)
    assert set(re.findall(r'(?:src|href)\s*=\s*"([^"]*)"', text)) == {"data:,"}


def test_axes_in_si_are_the_blocks(found, tmp_path):
    block = rk.Block(2.0, 0.5)
    text = rk.plot.tiles(found, tmp_path / "map", block).read_text(encoding="utf-8")
    view = json.loads(re.search(r'id="view">(.*?)</script>', text, re.DOTALL)[1])
    np.testing.assert_allclose(view["up"]["values"], block.acceleration(found.amplitude.values), rtol=1e-8)
    assert view["across"]["name"] == "period (s)"


@pytest.mark.parametrize("rows, columns, deepest", [(2, 2, 0), (256, 256, 0), (257, 2, 1), (512, 513, 2)])
def test_map_of_any_size_fits_its_coarsest_level_in_one_tile(tmp_path, rows, columns, deepest):
    few = scattered(rows, columns)
    page = rk.plot.tiles(few, tmp_path / "map")
    assert {path.name for path in (page.parent / "tiles").iterdir()} == {
        str(level) for level in range(deepest + 1)
    }
    _, colours = colours_of(few)
    assert (image_of(page, deepest)[..., 3] == colours[..., 3]).all()
    assert image_of(page, 0).shape[:2] == colours[:: 2**deepest, :: 2**deepest].shape[:2]
    assert max(image_of(page, 0).shape) <= EDGE


def test_images_do_not_depend_on_how_many_rows_come_at_a_time(tmp_path):
    codes = np.random.default_rng(2).integers(0, NONE + 1, (600, 4)).astype(np.uint8)
    images = []
    for at_once in (600, 7):
        pyramid = Pyramid(tmp_path / str(at_once), *codes.shape)
        for first in range(0, 600, at_once):
            pyramid.add(codes[first : first + at_once])
        pyramid.finish()
        images.append(
            {path.relative_to(pyramid.folder): path.read_bytes() for path in pyramid.folder.rglob("*.png")}
        )
    assert len(images[0]) > 3
    assert images[0] == images[1]


def test_folder_of_an_earlier_export_is_replaced_as_a_whole(tmp_path):
    rk.plot.tiles(scattered(600, 2), tmp_path / "map")
    rk.plot.tiles(scattered(3, 2), tmp_path / "map")
    assert [path.name for path in (tmp_path / "map" / "tiles").iterdir()] == ["0"]
    assert [path.name for path in tmp_path.iterdir()] == ["map"]


def test_what_fails_leaves_what_was_there(tmp_path, monkeypatch):
    page = rk.plot.tiles(scattered(3, 2), tmp_path / "map")
    before = page.read_bytes()

    def fails(*_, **__):
        raise OSError("no space left")

    monkeypatch.setattr(Image.Image, "save", fails)
    with pytest.raises(OSError, match="no space left"):
        rk.plot.tiles(scattered(5, 2), tmp_path / "map")
    assert page.read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["map"]


def test_folder_with_something_else_is_refused(tmp_path):
    (tmp_path / "notes.txt").touch()
    with pytest.raises(
        OSError,
        match="folder must be new, empty, or hold only an earlier index.html with its files; got '.*'",
    ):
        rk.plot.tiles(scattered(3, 2), tmp_path)
    with pytest.raises(OSError, match="folder must be a folder that can be written; got '.*notes.txt'"):
        rk.plot.tiles(scattered(3, 2), tmp_path / "notes.txt")
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


@pytest.mark.parametrize(
    "own", ["thesis.tex", "index.html", "tiles", "tiles/thesis.tex", "tiles/0/thesis.png"]
)
def test_nothing_of_somebody_elses_is_replaced(tmp_path, own):
    """A file beside an earlier export or within; a page of that name which this has not written; tiles whose page is gone."""
    folder = rk.plot.tiles(scattered(3, 2), tmp_path / "map").parent
    if own == "tiles":
        (folder / "index.html").unlink()
    else:
        (folder / own).write_text("mine")
    before = sorted((path, path.stat().st_mtime_ns) for path in folder.rglob("*"))
    with pytest.raises(FileExistsError, match="which holds other files"):
        rk.plot.tiles(scattered(5, 2), folder)
    assert sorted((path, path.stat().st_mtime_ns) for path in folder.rglob("*")) == before


def test_folder_that_this_runs_in_is_refused(tmp_path, monkeypatch):
    (tmp_path / "deep").mkdir()
    monkeypatch.chdir(tmp_path / "deep")
    for folder in (".", "..", tmp_path):
        with pytest.raises(OSError, match="folder must not contain the working directory; got"):
            rk.plot.tiles(scattered(3, 2), folder)
    assert (tmp_path / "deep").is_dir()
