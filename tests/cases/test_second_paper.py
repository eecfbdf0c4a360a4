"""Report on pulses and earthquakes: every row computed, none unexplained, its numbers those that others found, its pages complete."""

import csv
import math
import re

import mpmath as mp
import numpy as np
import pytest
from PIL import Image

import rocking as rk
from rocking.papers.catalogue import PULSES_AND_EARTHQUAKES
from rocking.papers.pulses_and_earthquakes import runge_kutta, surveys, thresholds
from rocking.papers.report import page
from rocking.papers.report.claim import Standing
from rocking.papers.report.reproduce import reproduce

CHAPTERS = PULSES_AND_EARTHQUAKES.chapters
FIGURES = ["01", "02", "03", "04", "05"]
PAGES = [
    "index.html",
    "figures.html",
    *(f"claims-{page.slug(chapter.title)}.html" for chapter in CHAPTERS),
    "verdicts.html",
]
ROWS = {(chapter.title, claim.compute.__name__): claim for chapter in CHAPTERS for claim in chapter}
ZHANG, MAKRIS, ROUSSOS, HOUSNER = (
    "Zhang & Makris (2001)",
    "Makris & Konstantinidis (2003)",
    "Shi et al. (1996) and Makris & Roussos (2000)",
    "Housner (1963)",
)


@pytest.fixture(scope="module")
def verdicts():
    return {name: claim.test() for name, claim in ROWS.items()}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    lines = []
    reproduce(PULSES_AND_EARTHQUAKES, folder, summary=lines.append)
    return folder, lines


def test_every_row_is_computed_and_has_the_expected_verdict(verdicts):
    for claim, found in zip(ROWS.values(), verdicts.values(), strict=True):
        expected = claim.otherwise if claim.because else Standing.CONFIRMED
        assert found.standing is expected, (claim.place, found.finding)
        assert re.search(r"\d", found.finding.figures)


def test_no_row_is_unexplained(verdicts):
    for found in verdicts.values():
        assert bool(found.because) == (found.standing is not Standing.CONFIRMED)
    assert {found.standing for found in verdicts.values()} == {
        Standing.CONFIRMED,
        Standing.QUALIFIED,
        Standing.ERROR,
        Standing.UNTESTED,
    }


def test_what_is_not_judged_needs_another_record(verdicts):
    reasons = {found.because for found in verdicts.values() if found.standing is Standing.UNTESTED}
    assert reasons == {surveys.NO_RECORD}


def test_rows_of_the_full_equation_are_judged(verdicts):
    full = {
        claim.compute.__name__: verdicts[name].standing
        for name, claim in ROWS.items()
        if re.search(r"[Ff]ull equation", claim.says)
    }
    assert full == {
        "fast_mode_1": Standing.CONFIRMED,
        "highest_frequency_full": Standing.QUALIFIED,
        "figure_4": Standing.CONFIRMED,
        "figure_4_peaks": Standing.QUALIFIED,
        "script": Standing.QUALIFIED,
    }
    assert verdicts[ROUSSOS, "figure_11"].standing is Standing.QUALIFIED


RECALLED = "Ishiyama|Purvance|Dimitrakopoulos|Giouvanidis|Kazantzi|Kavvadias|ASCE|Anooshehpoor|Yim|Vassiliou|Kalliontzis"
"""Sources whose formulas or numbers were recalled and not read: no row may rest on them."""


def test_no_row_rests_on_a_source_that_was_not_read():
    texts = [
        f"{chapter.title} {claim.place} {claim.says} {claim.because} {claim.source}"
        for chapter in CHAPTERS
        for claim in chapter
    ]
    assert [text for text in texts if re.search(RECALLED, text)] == []


@pytest.mark.parametrize("paper", ["Housner", "Shi", "Roussos", "Zhang", "Konstantinidis"])
def test_every_paper_has_rows(paper):
    assert any(paper in chapter.title and len(chapter) > 2 for chapter in CHAPTERS)


def test_no_two_rows_are_the_same():
    says = [(claim.place, claim.says) for claim in ROWS.values()]
    assert len(says) == len(set(says)) == len(ROWS) == 32


# (row, values that were computed with SciPy's DOP853 at rtol 1e-12 or with 40 digits; their error). The first of figure_4 is that of
# the slender block, the second that of the full equation.
KNOWN = [
    (ZHANG, "mode_1_begins", 3.018600, 5e-7),
    (ZHANG, "mode_1_ends", 6.318071, 5e-7),
    (ZHANG, "mode_2_begins", 7.168129, 5e-7),
    (ZHANG, "mode_2", 7.16812879707078524, 1e-12),
    (ZHANG, "fast_mode_2", 3.230104, 5e-7),
    (ZHANG, "fast_mode_1", 2.223222, 1.1e-6),
    (ZHANG, "highest_frequency_full", 7.51496, 1.1e-5),
    (MAKRIS, "figure_4", 0.3078506737, 1.5e-10),
    (MAKRIS, "figure_4", 0.3150340182, 1.1e-10),
    (MAKRIS, "script", 0.3150340182, 1.1e-10),
]


@pytest.mark.parametrize(("paper", "row", "known", "error"), KNOWN, ids=str)
def test_computed_number_is_that_of_another_method(verdicts, paper, row, known, error):
    numbers = [float(word) for word in re.findall(r"\d+\.\d{5,}", verdicts[paper, row].finding.figures)]
    assert min(abs(number - known) for number in numbers) <= error


@pytest.mark.parametrize(
    ("kind", "height", "width", "duration", "known"),
    [
        ("half-sine", 1.2, 0.4, 0.5, 0.554586),
        ("one-sine", 3.0, 1.0, 1.0, 0.451540),
        ("one-cosine", 3.0, 1.0, 1.0, 0.595894),
    ],
)
def test_accelerations_are_those_of_another_method_at_its_value_of_g(kind, height, width, duration, known):
    """Figs. 2, 9 and 11 of Makris & Roussos: computed with DOP853 and g = 9.81 m/s², to six digits."""
    angle, parameter = math.atan2(width, height), math.sqrt(3 * 9.81 / (2 * math.hypot(height, width)))
    frequency = thresholds.TURNS[kind] / (parameter * duration)
    restitution = 1 - 1.5 * math.sin(angle) ** 2
    found = angle * thresholds.threshold(
        kind, frequency, restitution, (known - 0.005) / angle, (known + 0.01) / angle
    )
    assert found == pytest.approx(known, abs=5.1e-7)


def test_phases_of_the_pulses_are_those_of_forty_digits(verdicts):
    with mp.workdps(40):
        known = [
            mp.findroot(lambda phi, n=n: mp.tan(phi) * ((2 * n + 1) * mp.pi - 2 * phi) - 2, 0.1) / mp.pi
            for n in (1, 2)
        ]
    found = [float(word) for word in re.findall(r"(\d\.\d{6})π", verdicts[ROUSSOS, "phases"].finding.figures)]
    # half a unit of the last digit shown
    assert found == pytest.approx([float(value) for value in known], abs=5.1e-7)


@pytest.mark.parametrize("rate", [0.5, 1.0, 2.0, 3.0, 5.0])
def test_housners_formula_for_the_half_sine_lies_above_a_motion_that_overturns(rate):
    """The error of the paper, from an integration that shares nothing with the engine."""
    amplitude = 0.5 * (math.sqrt(1 + rate**2) + rk.theory.half_sine_pulse_amplitude(math.pi / rate))
    times = np.linspace(0.0, math.pi / rate, 2_001)
    samples = amplitude * np.sin(rate * times)[:, None]
    assert runge_kutta.overturned(samples, times[1], 0.9, 1, interpolated=True).all()


@pytest.mark.parametrize("interpolated", [False, True])
def test_runge_kutta_converges_to_the_exact_verdicts_where_no_chaos_is(interpolated):
    amplitudes = np.linspace(1.5, 9.0, 60)
    times = np.linspace(0.0, math.tau / 5, 2_001)
    found = runge_kutta.overturned(
        np.outer(np.sin(5 * times), amplitudes), times[1], 0.9, 1, interpolated=interpolated
    )
    exact = [thresholds.falls("one-sine", amplitude, 5.0, 0.9) for amplitude in amplitudes]
    assert found.tolist() == exact


def test_step_of_runge_kutta_is_of_fourth_order():
    """Against cosh: halving the step divides the error by 16."""

    def error(step):
        angle, velocity = np.array([0.5]), np.array([0.0])
        for _ in range(round(1 / step)):
            angle, velocity = runge_kutta._step(angle, velocity, np.zeros(1), 0.0, 0.0, step)
        return abs(angle[0] - 0.5 * math.cosh(1.0))

    assert error(0.05) / error(0.025) == pytest.approx(16, rel=0.1)


def test_scales_that_overturn_are_those_of_single_motions(thin):
    record, found = rk.example_ground_motion(), surveys.scales()
    block = rk.Block(
        height=2 * surveys.SIZE * math.cos(surveys.SLENDERNESS),
        width=2 * surveys.SIZE * math.sin(surveys.SLENDERNESS),
    )
    sure = np.flatnonzero(found.certified.values)
    for number in thin(sure, 12, seed=5):
        motion = rk.simulate(
            block.system(
                record.scaled(float(found["level"][number])), model="slender", normalised_by="angle"
            ),
            record="none",
        )
        assert (motion.outcome is rk.Outcome.OVERTURNED) == surveys.fallen(found)[number]


def test_bisection_that_brackets_nothing_is_not_a_number():
    assert math.isnan(thresholds.bisected(lambda value: value > 2.0, 0.0, 1.0))
    assert thresholds.bisected(lambda value: value > 2.0, 0.0, 3.0) == pytest.approx(2.0, rel=1e-12, abs=0)


def test_distance_from_a_printed_pair_is_zero_between_its_numbers():
    assert thresholds.outside(3.005, 3.00, 3.01) == thresholds.outside(3.005, 3.01, 3.00) == 0.0
    assert thresholds.outside(3.02, 3.00, 3.01) == pytest.approx(0.01)
    assert thresholds.outside(2.98, 3.00, 3.01) == pytest.approx(0.02)


@pytest.mark.long
def test_report_has_all_figures_the_table_and_the_pages(folder):
    folder, lines = folder
    pdf = ["index.pdf"] if page.can_print() else []
    expected = [f"figure-{name}{kind}" for name in FIGURES for kind in (".png", ".svg")]
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        [*expected, "table-claims.csv", "table-claims.md", *PAGES, *pdf]
    )
    (line,) = lines
    assert line.startswith(f"{len(ROWS)} claims of the papers: confirmed (")
    with (folder / "table-claims.csv").open(encoding="utf-8", newline="") as file:
        assert len(list(csv.DictReader(file))) == len(ROWS)


@pytest.mark.long
def test_pages_show_every_row_and_figure_and_load_nothing(folder):
    text = "".join((folder[0] / name).read_text(encoding="utf-8") for name in PAGES)
    assert text.count("<img") == text.count('<img src="data:image/') == len(FIGURES)
    assert text.count('<tr id="claim-') == len(ROWS)
    assert not re.search(r"""src=(?!["']?data:)|@import|url\(|<script""", text)
    pdf = ["index.pdf"] if page.can_print() else []
    assert set(re.findall(r'href="([^"#]*)', text)) - {""} == {*PAGES, *pdf}


@pytest.mark.long
@pytest.mark.parametrize("name", FIGURES)
def test_no_picture_is_blank(folder, name):
    with Image.open(folder[0] / f"figure-{name}.png") as image:
        assert np.asarray(image.convert("L")).std() > 10


@pytest.mark.long
def test_figures_have_the_same_bytes_each_time(folder, tmp_path):
    again = reproduce(PULSES_AND_EARTHQUAKES, tmp_path, figures=[2, 3])
    assert all(path.read_bytes() == (folder[0] / path.name).read_bytes() for path in again)


def test_unknown_figure_is_refused(tmp_path):
    with pytest.raises(ValueError, match="^figures must be among 1, 2, 3, 4, 5, claims; got '6'$"):
        reproduce(PULSES_AND_EARTHQUAKES, tmp_path / "new", figures=[6])
    assert not list(tmp_path.iterdir())
