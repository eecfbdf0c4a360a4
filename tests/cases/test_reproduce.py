"""The paper's figures: complete, not blank, reproducible bit by bit, and in agreement with their captions."""

import csv
import io
import math
import re

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import rocking as rk
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.report import page, workers
from rocking.papers.report.claim import Standing
from rocking.papers.report.reproduce import reproduce
from rocking.papers.yim_lin_1991 import surveys

NAMES = ["01", "02", "03", "04", "05", "06", "07", "08", "09", "10", "11", "12", "13a", "13b"]
TABLES = [f"table-{name}{kind}" for name in ("exponents", "claims") for kind in (".csv", ".md")]
BEYOND = ["chaos", "cascade", "crisis", "threshold", "coexistence", "zoom", "bifurcations"]
PAGES = [
    "index.html",
    "figures.html",
    *(f"claims-{page.slug(chapter.title)}.html" for chapter in YIM_LIN_1991.chapters),
    "further-results.html",
    "verdicts.html",
]
PRINTED = ["index.pdf"] if page.can_print() else []


@pytest.fixture
def folder(reproduced):
    return reproduced.folder


def test_every_figure_table_and_page_is_written(reproduced):
    folder, paths = reproduced
    drawn = [*(f"figure-{name}" for name in NAMES), *(f"beyond-{name}" for name in BEYOND)]
    expected = [f"{name}{kind}" for name in drawn for kind in (".png", ".svg")] + TABLES + PAGES + PRINTED
    assert sorted(path.name for path in paths) == sorted(expected)
    assert sorted(folder.iterdir()) == sorted(paths)


def test_table_sets_the_papers_numbers_beside_ours(reproduced):
    """Typed numbers are the paper's; computed ones agree with tests/cases/test_exponents.py."""
    paths = [path for path in reproduced.paths if path.name.startswith("table-exponents")]
    with paths[0].open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["paper exponent"] for row in rows] == ["0", "0", "0.14", "not given"]
    assert [row["paper dimension"] for row in rows] == ["0", "2.0", "2.3", "not given"]
    assert float(rows[0]["exponent per cycle"].split()[0]) == pytest.approx(2 / 3 * math.log(0.925), abs=1e-4)
    sea, spread = (float(word) for word in re.findall(r"[\d.]+", rows[2]["exponent per cycle"]))
    assert (sea, spread) == (pytest.approx(0.15, abs=0.015), pytest.approx(0.036, abs=0.01))
    intervals = [
        [float(word) for word in re.findall(r"[\d.]+", row["section dimension"])] for row in rows[1:]
    ]
    for (low, high), known in zip(intervals, (1.0, 2.0, 1.55), strict=True):
        assert low <= known <= high
    assert rows[0]["section dimension"] == "0 (3 points)"
    # at the radii that a run of that length resolves, single runs give 2.3 or 2.4
    assert re.search(r"2\.[234] in the flow", rows[2]["why"])
    assert paths[1].read_text(encoding="utf-8").count("\n") == 6


def test_table_of_claims_holds_every_one_and_each_has_the_expected_verdict(folder):
    with (folder / "table-claims.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    claims = [each for chapter in YIM_LIN_1991.chapters for each in chapter]
    # of what holds nothing is said in its place, and what does not hold is shown to be otherwise
    expected = [each.otherwise if each.because else Standing.CONFIRMED for each in claims]
    assert [(row["place"], row["verdict"]) for row in rows] == [
        (each.place, standing) for each, standing in zip(claims, expected, strict=True)
    ]
    assert set(expected) == {Standing.CONFIRMED, Standing.QUALIFIED, Standing.MISPRINT, Standing.ERROR}
    assert all(bool(row["explanation"]) == (row["verdict"] != Standing.CONFIRMED) for row in rows)


def test_pages_hold_every_picture_and_claim_and_ask_for_nothing(folder):
    text = "".join((folder / name).read_text(encoding="utf-8") for name in PAGES)
    assert text.count('<img src="data:image/') == text.count("<img") == len(NAMES) + len(BEYOND)
    assert text.count('<tr id="claim-') == sum(map(len, YIM_LIN_1991.chapters))
    assert not re.search(r"""src=(?!["']?data:)|@import|url\(|<script""", text)
    links = set(re.findall(r'href="([^"#]*)', text)) - {""}
    assert links == {*PAGES, *PRINTED}


@pytest.mark.parametrize("name", NAMES)
def test_no_picture_is_blank_and_all_are_200_dots_per_inch(folder, name):
    with Image.open(folder / f"figure-{name}.png") as image:
        assert image.width in (700, 1440)
        assert image.info["dpi"] == pytest.approx((200, 200), rel=1e-3)
        assert np.asarray(image.convert("L")).std() > 10


def test_second_run_gives_the_same_bytes_under_any_settings(folder, tmp_path):
    with mpl.rc_context(
        {"axes.facecolor": "black", "font.size": 20, "lines.linestyle": "--", "svg.fonttype": "none"}
    ):
        again = reproduce(YIM_LIN_1991, tmp_path, figures=[1, 2, 4, 7, 9, 12, "13a", "threshold", "crisis"])
    assert all(path.read_bytes() == (folder / path.name).read_bytes() for path in again)


def test_figures_are_chosen_by_number(tmp_path):
    paths = reproduce(YIM_LIN_1991, tmp_path, figures=[4, "1"])
    assert [path.name for path in paths] == [
        "figure-04.png",
        "figure-04.svg",
        "figure-01.png",
        "figure-01.svg",
    ]


def test_unknown_figure_is_refused_before_anything_is_written(tmp_path):
    with pytest.raises(
        ValueError,
        match="^figures must be among 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13a, 13b, exponents, claims, "
        "chaos, cascade, crisis, threshold, coexistence, zoom, bifurcations; got '14'$",
    ):
        reproduce(YIM_LIN_1991, tmp_path / "new", figures=[1, 14])
    assert not list(tmp_path.iterdir())


def test_folder_that_is_a_file_is_refused_in_one_line(tmp_path):
    (tmp_path / "taken").touch()
    with pytest.raises(OSError, match="^folder must be a folder that can be written; got '.*taken'$"):
        reproduce(YIM_LIN_1991, tmp_path / "taken")


def test_interrupted_run_leaves_only_whole_files(tmp_path, monkeypatch):
    write = Figure.savefig

    def interrupted(self, target, **how):
        if how["format"] == "svg":
            target.write_bytes(b"half a picture")
            raise KeyboardInterrupt
        write(self, target, **how)

    monkeypatch.setattr(Figure, "savefig", interrupted)
    monkeypatch.setattr(workers, "cores", lambda: 1)
    with pytest.raises(KeyboardInterrupt):
        reproduce(YIM_LIN_1991, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["figure-01.png"]
    Image.open(io.BytesIO((tmp_path / "figure-01.png").read_bytes())).verify()


@pytest.mark.parametrize(
    ("case", "period", "impacts", "symmetric"),
    list(zip(surveys.PERIODIC, (1, 3, 10), (2, 2, 4), (True, True, False), strict=True)),
    ids=lambda value: getattr(value, "name", None),
)
def test_periodic_motions_repeat_within_the_cycles_shown(case, period, impacts, symmetric):
    motion = case.motion()
    first, last = case.cycles
    assert (last - first) % period == 0
    section = motion.section()[first : last + 1]
    # a difference of 1e-9 is a millionth of the thickness of a line
    assert np.abs(section[period:] - section[:-period]).max() < 1e-9
    shorter = [n for n in range(1, period) if np.abs(section[n:] - section[:-n]).max() < 1e-3]
    assert shorter == []
    time = motion.events["time"] / case.system.forcing.period
    assert ((time > last - period) & (time <= last)).sum() == impacts
    times = np.linspace(last - 2 * period, last - period, 101) * case.system.forcing.period
    half_later = motion.at(times + period / 2 * case.system.forcing.period)[0]
    assert (np.abs(motion.at(times)[0] + half_later).max() < 1e-9) == symmetric


def test_overturning_of_figure_4_comes_in_the_sixth_cycle_after_four_impacts():
    motion = surveys.OVERTURNING.motion()
    assert motion.outcome is rk.Outcome.OVERTURNED
    assert 5 <= motion.overturning.time / 2.0 < 6
    assert motion.impacts == 4


def test_undamped_motions_of_figures_5_and_6_stay_bounded():
    assert {case.motion().outcome for case in (surveys.QUASI_PERIODIC, surveys.CHAOTIC)} == {
        rk.Outcome.BOUNDED
    }


def test_neighbours_part_in_figure_6_and_not_in_figure_5():
    def spread(case):
        motion = case.motion()
        near = rk.simulate(case.system, rk.State(velocity=1e-9), cycles=motion.cycles)
        return np.abs(motion.section()[-1] - near.section()[-1]).max() / 1e-9

    assert spread(surveys.CHAOTIC) > 1e3 > spread(surveys.QUASI_PERIODIC)


def test_time_never_goes_back_between_the_braces():
    events = rk.simulate(surveys.BRACED, cycles=50_000).events
    assert (np.diff(events["time"]) > 0).all()
