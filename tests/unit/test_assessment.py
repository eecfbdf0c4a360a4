"""Assessment: rows that agree with single motions and with the fragility, a page that stands alone, tables, and its file."""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import rocking as rk
from docs.extensions import checked
from rocking.assessment.assess import block_digest
from rocking.assessment.drawing import block_to_scale, scale_of
from rocking.assessment.page import page, write_page
from rocking.assessment.sentences import NO_DIRECTION, answers_of, rate_notes
from rocking.assessment.shown import block_table, record_table, rule_table
from rocking.assessment.tables import TABLES, tables, write_csv, write_xlsx
from rocking.cli.assessment_file import read_case

G = 9.80665
CABINET = rk.Block(2.0, 0.6)
LEVELS = [0.3, 0.6, 0.9, 1.2]
RECORDS = rk.RecordSet(
    [motion.scaled(1.5) for motion in rk.synthetic_ground_motions(4, seed=1)], {"M": [6.1, 6.5, 7.0, np.nan]}
)
HAZARD = ([0.05, 0.2, 0.8, 3.0], [1e-2, 1e-3, 5e-5, 1e-6])


@pytest.fixture(scope="module")
def assessed():
    return rk.assess(
        RECORDS, CABINET, LEVELS, level=0.6, limits=0.5, friction=0.35, hazard=HAZARD, name="A & <b>"
    )


def test_rows_are_those_of_single_motions_by_both_equations(assessed):
    assert assessed.dataset.pga.values / G == pytest.approx(0.6)
    for place, motion in enumerate(RECORDS):
        row = assessed.dataset.isel(record=place)
        ground = motion.scaled(pga=0.6 * G)
        exact, slender = (rk.simulate(CABINET.system(ground, model=model)) for model in ("full", "slender"))
        fell = exact.outcome is rk.Outcome.OVERTURNED
        assert (row.outcome.item(), row.overturned.item()) == (str(exact.outcome), fell)
        assert row.peak.item() == (np.inf if fell else exact.peak)
        assert row.margin.item() == exact.margin
        assert row.friction.item() == exact.validity(CABINET).friction
        assert row.slides.item() == (row.friction.item() > 0.35)
        assert row.other_overturned.item() == (slender.outcome is rk.Outcome.OVERTURNED)
        if not row.other_overturned.item():
            assert row.other_peak.item() == pytest.approx(slender.peak, rel=1e-9)
        assert row.pgv.item() == ground.pgv
        assert row.sa.item() == ground.response_spectrum(1.0)
        pga, pgv = rk.theory.ishiyama_levels(CABINET)
        assert row.ishiyama.item() == (ground.pga > pga and ground.pgv > pgv)
        assert row.fema_356.item() == pytest.approx(rk.theory.design_angle(ground, CABINET), nan_ok=True)


def test_rows_and_surveys_agree_at_the_level(assessed):
    """The survey and the single runs are different code for the same question."""
    share = assessed.fragility.dataset.fraction.sel(limit=np.inf, level=0.6)
    assert 0.0 < share.item() == assessed.dataset.overturned.values.mean()
    fell = [
        bool(((bands[:, 0] <= 0.6) & (bands[:, 1] >= 0.6)).any())
        for bands in map(assessed.overturning_set.intervals, range(len(RECORDS)))
    ]
    assert fell == assessed.dataset.overturned.values.tolist()
    assert assessed.rate.rate == rk.overturning_rate(assessed.fragility, HAZARD).rate


def test_level_between_two_levels_is_added_and_rows_are_otherwise_as_recorded():
    result = rk.assess(RECORDS[:2], CABINET, [0.3, 0.6], level=0.45)
    assert result.fragility.dataset.level.values.tolist() == [0.3, 0.45, 0.6]
    result = rk.assess(RECORDS[:2], CABINET, [0.3, 0.6])
    assert result.dataset.pga.values.tolist() == [motion.pga for motion in RECORDS[:2]]
    assert result.dataset.attrs["level"] is None
    assert str(result).startswith("0 of 2 records as recorded overturn the block; ")


def test_unequal_sides_take_the_worse_direction():
    block = rk.Block(2.0, 0.6, offset=0.08)
    ground = RECORDS[0].scaled(pga=0.45 * G)
    result = rk.assess([ground], block, [0.3, 0.6])
    both = [rk.simulate(block.system(each)) for each in (ground, ground.reversed())]
    assert both[0].peak != both[1].peak
    worst = max(both, key=lambda motion: (motion.outcome == "overturned", motion.peak))
    assert result.dataset.margin.item() == worst.margin
    assert result.dataset.attrs["polarity"] == "worse"
    assert np.isnan(result.dataset.fema_356.item())
    assert "symmetric blocks only" in page([result], "t", "")


def test_block_against_a_wall_takes_the_worse_direction_and_says_what_it_leaves_out():
    block = rk.Block(2.0, 0.6, wall=rk.Wall(0.4))
    ground = RECORDS[1].scaled(pga=0.7 * G)
    result = rk.assess([ground], block, [0.3, 0.7], friction=0.4)
    both = [rk.simulate(block.system(each)) for each in (ground, ground.reversed())]
    assert both[0].peak != both[1].peak
    assert result.dataset.peak.item() == max(motion.peak for motion in both)
    assert result.dataset.friction.item() == max(motion.validity(block).friction for motion in both)
    assert result.dataset.slides.item() == (result.dataset.friction.item() > 0.4)
    text = page([result], "t", "")
    assert dict(block_table(block).rows)["restitution e_w of the wall"] == "0.4"
    assert "0.300 g, away from the wall" in text
    assert "symmetric blocks only" in text
    assert "It stands against a wall on the side θ &lt; 0" in text
    assert text.count("impacts against the wall") == 2
    free = page([rk.assess([ground], CABINET, [0.3, 0.7])], "t", "")
    assert "wall" not in free


@pytest.mark.parametrize("offset, rocks", [(0.1, True), (-0.1, False)])
def test_block_against_a_wall_slides_by_the_angle_of_its_free_side(offset, rocks):
    block = rk.Block(2.0, 0.6, offset=offset, wall=rk.Wall(0.4))
    result = rk.assess(RECORDS[:1], block, [0.3, 0.7], friction=0.3)
    assert ("does not rock" in str(result)) == (not rocks)


@pytest.mark.parametrize("polarity", ["worse", "+"])
def test_friction_is_that_of_all_directions_that_count(polarity):
    """The direction with the larger angle here needs less friction than the other one."""
    block = rk.Block(2.0, 0.6, offset=0.08)
    ground = RECORDS[1].scaled(pga=0.45 * G)
    both = [rk.simulate(block.system(each)) for each in (ground, ground.reversed())]
    needs = [motion.validity(block).friction for motion in both]
    assert both[0].peak > both[1].peak
    assert needs[0] < needs[1]
    result = rk.assess([ground], block, [0.3, 0.6], friction=sum(needs) / 2, polarity=polarity)
    assert result.dataset.friction.item() == (max(needs) if polarity == "worse" else needs[0])
    assert result.dataset.slides.item() == (polarity == "worse")
    said = {"worse": "both directions, of which the worse one counts", "+": "not in the opposite one"}
    assert said[polarity] in next(answers_of(result))


@pytest.mark.parametrize(
    "restitution, left, warnings",
    [(None, None, 0), (0.6, None, 2), (None, 0.6, 1)],
)
def test_restitution_of_each_side_is_compared_with_its_own_value(restitution, left, warnings):
    law = {"restitution": restitution, "left_restitution": left}
    block = rk.Block(2.0, 0.6, offset=0.08, **{name: value for name, value in law.items() if value})
    notes = rk.assess(RECORDS[:1], block, [0.3, 0.6]).notes
    assert sum("less than Housner's" in note for note in notes) == warnings


def test_friction_is_said_for_the_level_of_the_rows_only(assessed):
    enough = rk.assess(RECORDS[:2], CABINET, [0.3, 0.6], level=0.45, friction=0.9)
    *_, said, _ = answers_of(enough)
    assert "0.9 is available, so that no record at PGA = 0.45 g makes the block slide." in said
    assert said.endswith("overturning levels, the sensitivity and the annual rate do not consider friction.")
    count = int(assessed.dataset.slides.sum())
    assert 0 < count < len(RECORDS)
    assert f"under {count} of the 4 it slides before" in next(answers_of(assessed))
    assert f"{count} of all make it slide before: no verdict" in str(assessed)
    assert "the block slides and does not rock" not in str(assessed)
    assert page([assessed], "t", "").count("sliding is not considered") == 3


@pytest.mark.parametrize("friction, rocks", [(0.3, False), (0.300001, True)])
def test_block_on_a_smooth_base_slides_and_has_no_verdict(friction, rocks):
    result = rk.assess(RECORDS[:2], CABINET, [0.3, 1.2], level=1.2, friction=friction)
    first, second = list(answers_of(result))[:2]
    assert result.overturned > 0
    assert result.dataset.slides.all()
    assert ("the block slides and does not rock" in first) == ("does not rock" in str(result)) == (not rocks)
    assert (first if rocks else second).startswith(f"{result.overturned} of 2 records")
    rows = record_table(result).rows
    assert all(row[4].startswith("slides (") and row[-1] == "no verdict" for row in rows)


def test_probability_of_an_uncertain_block_says_so(assessed):
    result = rk.assess(
        RECORDS[:2], CABINET, [0.3, 0.6], level=0.6, uncertain={"samples": 2, "width_spread": 0.1}
    )
    (said,) = (line for line in answers_of(result) if line.startswith("Probability"))
    assert "the block is uncertain in it, in its width (spread 0.1)" in said
    assert not any("uncertain" in line for line in answers_of(assessed))


class Tags(HTMLParser):
    """Tags of a page, with those that are open, and the cells of its tables."""

    def __init__(self, text):
        super().__init__()
        self.open, self.seen, self.cells = [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.seen.add(tag)
        if tag not in ("meta", "img", "wbr"):
            self.open.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_startendtag(self, tag, attributes):
        self.seen.add(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] in ("td", "th"):
            self.cells[-1] += data


def test_page_stands_alone_and_escapes_names(assessed, tmp_path):
    path = write_page(
        tmp_path / "a.html", [assessed], title='Cabinets "1 & 2" <b>', by="me\\", notes=["x < y"]
    )
    text = path.read_text(encoding="utf-8")
    found = Tags(text)
    assert found.open == []
    assert not found.seen & {"script", "link", "iframe", "object", "b"}
    loads = checked.Page(text).loads
    assert [each.partition(",")[0] for each in loads] == 3 * ["data:image/svg+xml;base64"]
    assert "@page { size: A4" in text
    assert "A &amp; &lt;b&gt;" in text
    assert "x &lt; y" in text
    assert 'content: "Cabinets  1 & 2   b  · me  · rocking' in text
    assert {RECORDS.digest, block_digest(CABINET)} <= set(re.findall(r"[0-9a-f]{64}", text))
    assert page([assessed], "t", "") == page([assessed], "t", "")


def test_page_shows_what_was_computed(assessed):
    text = page([assessed], "t", "")
    cells = Tags(text).cells
    rows = assessed.dataset
    for place, name in enumerate(RECORDS.names):
        row = cells[cells.index(name) : cells.index(name) + 11]
        angle = np.degrees(CABINET.critical_angle) * rows.peak.values[place]
        shown = "overturns" if np.isinf(angle) else f"{angle:.2f}°" if angle < 10 else f"{angle:.1f}°"
        assert row[5] == (f"slides ({shown})" if rows.slides.values[place] else shown)
        assert row[10] == ("no verdict" if rows.slides.values[place] else "yes")
        assert row[1] == ("6.1", "6.5", "7.0", "–")[place]
        assert row[2] == "0.600"
        needed = f"{rows.friction.values[place]:.3f}"
        assert row[9] == (f"slides: {needed}" if rows.slides.values[place] else needed)
    low, high = (
        float(assessed.fragility.dataset[f"fraction_{end}"].sel(limit=np.inf, level=0.6))
        for end in ("low", "high")
    )
    share = assessed.overturned / len(RECORDS)
    said = re.search(r"overturning at PGA = 0.6 g: ([\d.]+) % \(([\d.]+)–([\d.]+) %\)", text)
    assert [float(each) for each in said.groups()] == pytest.approx(
        [100 * share, 100 * low, 100 * high], abs=0.05
    )
    assert f"probability in 50 years {assessed.rate.probability(50)}" in text
    notes = list(rate_notes(assessed.rate))
    assert notes
    assert all(text.count(note) == 1 for note in notes)
    assert text.count(NO_DIRECTION) == 2


def test_rules_are_counted_and_shown_for_few_records(assessed, monkeypatch):
    few = rule_table(assessed).rows
    assert [row[0] for row in few] == ["number that overturn", *RECORDS.names]
    for place in (1, 2, 3, 4):
        assert few[0][place] == f"{sum(row[place] == 'overturns' for row in few[1:])} of 4"
    monkeypatch.setattr("rocking.assessment.shown.LONG", 3)
    assert rule_table(assessed).rows == few[:1]


@pytest.mark.parametrize(
    "block",
    [CABINET, rk.Block(0.3, 0.1), rk.Block(9.6, 1.6, offset=0.1), rk.Block(2.0, 0.6, wall=rk.Wall(0.4))],
)
def test_drawing_is_to_scale(block):
    drawing = block_to_scale(block)
    scale = scale_of(block)
    assert f"1 : {scale:,};" in drawing.text
    (width,) = re.findall(r'<svg [^>]*width="([\d.]+)pt"', drawing.svg)
    assert float(width) * 25.4 / 72 == pytest.approx(drawing.width, rel=1e-4)
    corners = re.search(r'<g id="patch_3">\s*<path d="([^"]+)"', drawing.svg)[1]
    x, y = np.array(re.findall(r"([\d.]+) ([\d.]+)", corners), float).T
    paper = np.ptp(x) * 25.4 / 72, np.ptp(y) * 25.4 / 72
    assert paper == pytest.approx((1e3 * block.width / scale, 1e3 * block.height / scale), rel=1e-4)
    assert max(paper) <= 60.001
    assert ('id="wall"' in drawing.svg) == ("wall" in drawing.text) == (block.wall is not None)


def test_tables_hold_the_results_in_files_that_excel_reads(assessed, tmp_path):
    paths = write_csv(tmp_path / "a", [assessed])
    assert [path.name for path in paths] == [f"a-{name}.csv" for name in TABLES]
    assert all(path.read_bytes().startswith(b"\xef\xbb\xbf") for path in paths)
    rows = pd.read_csv(paths[0])
    assert rows["name"].tolist() == list(RECORDS.names)
    assert rows["pga [m/s²]"].to_numpy() == pytest.approx(assessed.dataset.pga.values)
    assert rows["peak [rad]"].to_numpy() == pytest.approx(
        CABINET.critical_angle * assessed.dataset.peak.values
    )
    levels = np.linspace(0.1, 1.0, 10)
    assert (levels != levels.round(12)).any()
    many = rk.assess(RECORDS[:1], CABINET, levels)
    assert set(tables([many])["fragility"]["level [g]"]) == {place / 10 for place in range(1, 11)}
    bands = pd.read_csv(paths[2])
    assert bands["name"].tolist()[0] == RECORDS.names[0]
    both = tables([assessed, rk.assess(RECORDS[:2], CABINET, [0.3, 0.6])])
    assert both["records"]["block"].tolist() == ["A & <b>"] * 4 + ["Block 2"] * 2
    assert len(both["rate"]) == 1


def test_workbook_has_a_sheet_per_table(assessed, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.load_workbook(write_xlsx(tmp_path / "a.xlsx", [assessed]))
    assert book.sheetnames == list(TABLES)
    sheet = book["records"]
    assert [cell.value for cell in sheet[1]][:3] == ["record", "name", "factor"]
    assert [row[1].value for row in sheet.iter_rows(min_row=2)] == list(RECORDS.names)


def test_json_holds_all_results(assessed):
    found = assessed.to_dict()
    assert [row["name"] for row in found["record"]] == list(RECORDS.names)
    assert found["rate"]["rate"] == assessed.rate.rate
    assert len(found["sensitivity"]["change"]) == 5
    assert found["level"] == 0.6


def test_what_the_records_do_not_determine_is_said():
    result = rk.assess(RECORDS[:2], rk.Block(2.0, 0.6, 1.0), [0.05, 0.1], level=0.1, hazard=HAZARD)
    assert result.rate is result.sensitivity is None
    few, *others = result.notes
    assert few == "2 records can hardly say how much records differ: use 10 or more"
    assert [each.partition(":")[0] for each in others] == [
        "the sensitivity to small changes was not computed",
        "the annual rate was not computed",
    ]
    text = page([result], "t", "")
    assert all(note.partition(":")[0] in text for note in result.notes)
    assert "not determined by these records and levels" in text
    assert tables([result]).keys() == set(TABLES) - {"rate"}
    assert tables([result])["sensitivity"].iloc[0, 0] == "not computed"
    cells = record_table(result).rows[0]
    assert cells[4:6] == ("stands still", "stands still")


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"level": 2.0}, "level must lie within the levels, 0.3 to 1.2; got 2.0"),
        ({"friction": -0.1}, r"friction must lie in \[0, 10\]; got -0.1"),
        ({"polarity": "both"}, 'polarity must be "\\+", "-" or "worse"; got \'both\''),
        ({"hazard": ([0.1, 0.2], [1e-4, 1e-3])}, "hazard rates must be positive and descending"),
        ({"years": 0.0}, "years must lie in"),
        ({"sa_period": 0.0}, "sa_period must lie in"),
        ({"intensity": "pgx"}, "intensity must be one of"),
    ],
)
def test_invalid_arguments_are_refused_before_the_computation(monkeypatch, arguments, message):
    monkeypatch.setattr("rocking.assessment.assess.fragility", None)
    with pytest.raises(ValueError, match=message):
        rk.assess(RECORDS, CABINET, LEVELS, **arguments)


# The file.


CASE = """
[block]
height_mm = 2000
width_mm = 600
[records]
source = "set"
[levels]
pga_g = [0.5, 1.0]
"""
pytestmark = pytest.mark.usefixtures("records")


def typed(rocking, text, line="assess case.toml"):
    Path("case.toml").write_text(text, encoding="utf-8")
    return rocking(line)


def test_file_gives_a_page_and_tables(rocking, monkeypatch):
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    code, message, out = typed(rocking, CASE)
    names = ["case.html", *(f"case-{name}.csv" for name in TABLES if name != "rate")]
    assert (code, message) == (0, "")
    last = "case.xlsx was not written: XLSX files need openpyxl: run pip install '.[excel]' in a copy of the repository"
    assert out.splitlines()[-len(names) - 1 :] == [*(f"wrote {name}" for name in names), last]
    assert out.startswith("2 of 2 records") or " of 2 records as recorded overturn the block" in out
    assert "a.AT2" in Path("case.html").read_text(encoding="utf-8")
    code, message, out = typed(rocking, CASE, "assess case.toml --output new --json")
    assert (code, message) == (0, "")
    assert {path.name for path in Path("new").iterdir()} == set(names)


@pytest.mark.parametrize("unit, factor", [("m", 1.0), ("cm", 100.0), ("mm", 1000.0)])
def test_sizes_have_their_unit_in_the_key(unit, factor):
    sizes = {"height": 2.0, "width": 0.6, "offset": 0.05, "centre_height": 0.9, "radius_of_gyration": 0.6}
    lines = "".join(f"{name}_{unit} = {value * factor:g}\n" for name, value in sizes.items())
    Path("case.toml").write_text(re.sub(r"height_mm.*\nwidth_mm.*\n", lines, CASE))
    (only,) = read_case(Path("case.toml")).blocks
    assert only.block == rk.Block(2.0, 0.6, offset=0.05, centre_height=0.9, radius_of_gyration=0.6)


def test_wall_is_read_and_the_page_is_written(rocking):
    code, message, out = typed(rocking, CASE.replace("width_mm", "wall = 0.4\nwidth_mm"))
    assert (code, message) == (0, "")
    (only,) = read_case(Path("case.toml")).blocks
    assert only.block == rk.Block(2.0, 0.6, wall=rk.Wall(0.4))
    assert "both directions, of which the worse one counts" in out


def test_several_blocks_limits_levels_and_hazard_are_read():
    Path("hazard.csv").write_text("PGA (g),rate\n0.1,1e-2\n0.5,1e-3\n")
    text = CASE.replace(
        "[block]", "limits_deg = 8.349622\nlimits = [0.2]\n[[block]]\nname = 'a'\nfriction = 0.3"
    )
    text += (
        "design = 0.7\n[hazard]\nfile = 'hazard.csv'\nyears = 10\n[[block]]\nheight_m = 1\nwidth_m = 0.3\n"
    )
    Path("case.toml").write_text(text)
    case = read_case(Path("case.toml"))
    assert [each.name for each in case.blocks] == ["a", ""]
    assert [each.friction for each in case.blocks] == [0.3, None]
    assert case.limits_of(CABINET) == pytest.approx([0.2, 0.5], rel=1e-6)
    assert (case.level, case.others) == (0.7, {"hazard": Path("hazard.csv"), "years": 10})
    assert case.levels.tolist() == [0.5, 1.0]


@pytest.mark.parametrize(
    "old, new, message",
    [
        ('"set"', '"sets"', "records: sets: cannot be read: No such file or directory; check the path"),
        ("height_mm", "hieght_mm", "unknown 'hieght_mm' in [block] (did you mean 'height_mm'?); height_mm missing in [block]"),
        ("height_mm", "height", "'height' in [block] needs its unit: write one of height_m, height_cm, height_mm"),
        ("600", "-600", "width_mm in [block] must lie in [0.001, 1000] m; got -600 mm"),
        ("600", '"600"', "width_mm in [block] must be a number; got '600' (write a number without quotation marks)"),
        ("pga_g", "pga", "'pga' in [levels] needs its unit: write pga_m_per_s2 or pga_g"),
        ("[0.5, 1.0]", "0.5", "pga_g in [levels] must hold two levels at least; got 0.5"),
        ("[0.5, 1.0]", "[0.5, 1.0]\ndesign = 3", "design in [levels] must lie within the levels, 0.5 to 1; got 3.0"),
        ("[levels]", "[level]", "unknown 'level' (did you mean 'levels'?); [levels] is missing: give the levels of an"),
        ('source = "set"', "", "[records] must state its source: a folder, a table or files, such as source = \"motions\""),
        ('source = "set"', "synthetic = 0", "records: synthetic in [records] must be a whole number in [1,"),
        ("height_mm", "offset_cm = 40\nheight_mm", "offset_cm in [block] must lie between -0.3 and 0.3 m, so that the"),
        ("width_mm", "friction = 11\nwidth_mm", "friction in [block] must lie in [0, 10]; got 11"),
        ("width_mm", "wall = 1.4\nwidth_mm", "wall in [block] must lie in [0, 1]; got 1.4"),
        ("width_mm", "wall = 'hard'\nwidth_mm", "wall in [block] must be a number; got 'hard'"),
        ("width_mm", "wall = true\nwidth_mm", "wall in [block] must be a number; got True"),
        ("width_mm", "wall = 0.4\nrestitution = 0.9\nwidth_mm", "give restitution or wall in [block], not both"),
        ("width_mm", "wall = 0.4\nrestitution_factor = 0.9\nwidth_mm", "give restitution_factor or wall in [block], not both"),
        ("width_mm", "mass = 600\nrestrainer_stiffness = 9e4\nwidth_mm", "restrainer_stiffness in [block] must be omitted: an"),
        ("[0.5, 1.0]", "[0.5, 1.0]\ndesing = 0.7", "unknown 'desing' in [levels] (did you mean 'design'?)"),
        ("[0.5, 1.0]", "[0.5, 1.0]\npgv_m_per_s = 0.7", "give exactly one of scale, pga_m_per_s2, pga_g, "),
        ('"set"', '"set"\ncomponent = "second"', "records: component in [records] must be one of 'all', 'first', 'larger'"),
        ("width_mm", "width_m = 1\nwidth_mm", "give width_m or width_mm in [block], not both"),
        ("[levels]", "[hazard]\nfile = 'none.csv'\n[levels]", "file in [hazard] must name a table of levels and annual rates; got"),
        ("[levels]", "[hazard]\nlevels = [1]\n[levels]", "give file, or levels and rates_per_year, in [hazard]"),
        ("[levels]", "[uncertain]\nsample = 3\n[levels]", "unknown 'sample' in [uncertain] (did you mean 'samples'?)"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_the_file_is_one_sentence_with_its_key(rocking, old, new, message):
    before = set(Path().iterdir())
    code, told, out = typed(rocking, CASE.replace(old, new, 1), "assess case.toml --output new")
    assert (code, out) == (2, "")
    assert told.startswith(f"case.toml: {message}")
    assert set(Path().iterdir()) - before == {Path("case.toml")}


def test_what_was_typed_is_shown_with_its_unit(rocking):
    told = typed(rocking, CASE.replace("height_mm", "offset_cm = 40\nheight_mm"))[1]
    assert told.endswith("; got 40 cm")


def test_all_errors_of_a_file_are_told_together(rocking):
    told = typed(rocking, "colour = 1\n[block]\nwidth_mm = 'x'\n[levels]\npga_g = [1]\ndesign = 'y'\n")[1]
    assert told == (
        "case.toml: unknown 'colour' (keys are title, by, limits, limits_deg, sa_period_s, polarity, model, seed, block, records, "
        "levels, uncertain, hazard); width_mm in [block] must be a number; got 'x'; height_mm missing in [block]; design in [levels] "
        "must be a number; got 'y'; [records] must state its source: a folder, a table or files, such as source = \"motions\""
    )


def test_ranges_are_checked_with_the_rest_and_before_the_records_are_read(rocking, monkeypatch):
    monkeypatch.setattr("rocking.cli.assessment_file.read_record_set", None)
    text = CASE.replace("height_mm", "friction = 11\nheight_mm") + (
        "design = 3\n[hazard]\nlevels = [0.1, 0.2]\nrates_per_year = [1e-4, 1e-3]\nyears = -1\n"
    )
    assert typed(rocking, "sa_period_s = 90\n" + text)[1] == (
        "case.toml: friction in [block] must lie in [0, 10]; got 11; design in [levels] must lie within the levels, 0.5 to 1; got 3.0; "
        "years in [hazard] must lie in [1e-09, 1e+06]; got -1; sa_period_s must lie in [0.01, 10] s; got 90; rates_per_year in "
        "[hazard] must be positive and descending, one per level; got [0.0001, 0.001] (they are annual rates of exceedance: that of a "
        "return period T in years is 1/T)"
    )


def test_advice_on_components_of_a_station_can_be_typed(rocking):
    one, other = ([0.0, 2.0, -1.0, 0.0], [0.0, 3.0, 1.0, 0.0])
    rows = "\n".join(
        f"{0.1 * place:.1f},{a},{b}" for place, (a, b) in enumerate(zip(one, other, strict=True))
    )
    Path("both.csv").write_text(f"time (s),NS (m/s2),EW (m/s2)\n{rows}\n")
    text = CASE.replace("[0.5, 1.0]", "[0.1, 0.3]").replace('"set"', '["both.csv"]')
    code, message, out = typed(rocking, text)
    assert (code, message) == (0, "")
    assert 'for example component = "first" in [records]' in out
    followed = text.replace("[levels]", 'component = "first"\n[levels]')
    code, message, out = typed(rocking, followed)
    assert (code, message) == (0, "")
    assert "of 1 record as recorded" in out
    assert "component" not in out
    ida = "ida both.csv --height 2 --width 0.6 --pga-g 0.1:0.3:2"
    assert "for example --component='first'" in rocking(ida)[2]
    assert "--component" not in rocking(f"{ida} --component=first")[2]


def test_name_with_dots_stays_whole(rocking):
    Path("a.v2.toml").write_text(CASE)
    assert rocking("assess a.v2.toml")[0] == 0
    assert {path.name for path in Path().glob("a.*html")} == {"a.v2.html"}
    assert Path("a.v2-records.csv").exists()


def test_outputs_replace_no_input(rocking):
    Path("case-records.csv").write_text(Path("push.csv").read_text())
    code, told, _ = typed(rocking, CASE.replace('"set"', '"case-records.csv"'))
    assert (code, told) == (
        2,
        "'case-records.csv' is an input and would be overwritten: give another folder by --output",
    )
