"""The paper's claims: complete, each with a verdict from a computation, and none unexplained."""

import csv
import re
from types import SimpleNamespace

import pytest

import rocking as rk
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.report import claim
from rocking.papers.report.claim import Chapter, Finding, Standing
from rocking.papers.yim_lin_1991 import surveys

CHAPTERS = YIM_LIN_1991.chapters
PLACES = " | ".join(each.place for chapter in CHAPTERS for each in chapter)
EXPLAINED = {
    "equation_10": (Standing.MISPRINT, "A₁₁ + A₂₂"),
    "equation_16b": (Standing.MISPRINT, "αt + ln θcr"),
    "equation_17": (Standing.MISPRINT, "v/(αθcr)"),
    "equation_20a": (Standing.MISPRINT, "signs"),
    "equation_21": (Standing.MISPRINT, "minus"),
    "figure_2_caption": (Standing.MISPRINT, "velocity"),
    "figure_2c": (Standing.MISPRINT, "(2, 10)"),
    "zeros_19": (Standing.ERROR, "(k + ½)π"),
    "equation_13": (Standing.ERROR, "oppose"),
    "pairs": (Standing.ERROR, "only one"),
    "eigenvalues": (Standing.ERROR, "unit circle"),
    "no_periodic": (Standing.ERROR, "neutrally stable"),
    "damped_quasi_periodic": (Standing.ERROR, "contracts"),
    "dimension_chaotic": (Standing.ERROR, "fills an area"),
    "frequent_hits": (Standing.ERROR, "periodic in the end"),
    "no_zeros": (Standing.ERROR, "A*"),
    "sufficient": (Standing.ERROR, "necessary"),
    "asymmetric": (Standing.QUALIFIED, "begin at folds"),
    "chaos_against_losses": (Standing.QUALIFIED, "from 0.8 to 1"),
    "chaos_above_095": (Standing.QUALIFIED, "from 0.2 to 0.6"),
    "lower_orbit": (Standing.QUALIFIED, "half a forcing period"),
    "less_energy": (Standing.QUALIFIED, "|Θ| < 1"),
    "exponent_periodic": (Standing.QUALIFIED, "along the flow"),
    "figure_7b": (Standing.QUALIFIED, "three closed curves"),
    "figure_7c": (Standing.QUALIFIED, "nothing attracts"),
}
"""Claims that do not hold as printed: the verdict, and what the explanation must contain. Each has a computation of its own."""


def one(compute):
    (found,) = (each for chapter in CHAPTERS for each in chapter if each.compute.__name__ == compute)
    return found


@pytest.mark.parametrize("number", range(1, 23))
def test_every_equation_has_a_row(number):
    assert re.search(rf"\({number}[a-c]?\)", PLACES)


@pytest.mark.parametrize(
    "figure",
    [
        "1",
        "2a",
        "2b",
        "2c",
        "3",
        "4",
        "5",
        "6",
        "7a",
        "7b",
        "7c",
        "8a",
        "8b",
        "8c",
        *["9", "10", "11", "12", "13a", "13b"],
    ],
)
def test_every_figure_has_a_row(figure):
    assert re.search(rf"Figs?\. [^|]*\b{figure}", PLACES)


@pytest.mark.parametrize("conclusion", range(1, 5))
def test_every_numbered_conclusion_has_a_row(conclusion):
    assert re.search(rf"[Cc]onclusion {conclusion}", PLACES)


def test_there_are_at_least_sixty_rows_and_no_two_are_the_same():
    says = [each.says for chapter in CHAPTERS for each in chapter]
    assert len(says) == len(set(says)) >= 60
    assert all(each.place and len(each.says) > 10 for chapter in CHAPTERS for each in chapter)


@pytest.mark.parametrize("compute", EXPLAINED)
def test_verdict_of_a_claim_that_does_not_hold_has_its_class_and_its_explanation(compute):
    standing, text = EXPLAINED[compute]
    assert (one(compute).otherwise, text in one(compute).because) == (standing, True)


@pytest.mark.parametrize(
    "compute",
    sorted(
        EXPLAINED.keys()
        - {"frequent_hits", "sufficient", "dimension_chaotic", "chaos_against_losses", "chaos_above_095"}
    ),
)
def test_explanation_is_shown_by_its_computation(compute):
    verdict = one(compute).test()
    assert verdict.standing is EXPLAINED[compute][0], verdict.finding
    assert EXPLAINED[compute][1] in verdict.because


def test_misprints_errors_and_qualifications_are_told_apart():
    """Signs, factors and indices of formulas and captions are misprints; statements that are false are errors."""
    misprints = {
        each.compute.__name__
        for chapter in CHAPTERS
        for each in chapter
        if each.otherwise is Standing.MISPRINT
    }
    assert misprints == {name for name, (standing, _) in EXPLAINED.items() if standing is Standing.MISPRINT}


MACHINE = {
    "a hyphen for a minus sign": r"(?<![\w.–])-\d",
    "a power of ten as a machine writes it": r"\de[+-]?\d",
    "a list of Python": r"\[",
    "a truth value of Python": r"True|False|None",
    "an absolute value that is at most 0": r"≤ 0(?![.\d])",
    "decimals of what is none or all": r"(?<![\d.])0\.0 %|100\.0",
    "a power of e": r"e\^",
}
"""Machine output that a journal does not print, by name."""


@pytest.mark.parametrize(
    "compute",
    ["equation_2", "equation_3", "equation_6", "pairs", "lower_orbit", "exponent_periodic", "divergence", "asymmetric",
     "damped_quasi_periodic", "eigenvalues", "figure_7c", "exponent_quasi_periodic"],
)  # fmt: skip
def test_figures_of_a_claim_are_printed_as_in_a_journal(compute):
    figures = one(compute).test().finding.figures
    assert {name: figures for name, machine in MACHINE.items() if re.search(machine, figures)} == {}


def test_figures_of_all_claims_are_printed_as_in_a_journal(reproduced):
    with (reproduced.folder / "table-claims.csv").open(encoding="utf-8", newline="") as file:
        texts = [row["computed"] for row in csv.DictReader(file)]
    texts.append((reproduced.folder / "table-exponents.md").read_text(encoding="utf-8"))
    assert [
        (name, text) for text in texts for name, machine in MACHINE.items() if re.search(machine, text)
    ] == []


def test_numbers_are_typeset_and_words_are_not():
    text = "-1.5e-07 and 1e-12, A-4, 3-7, e = -0.5, (-2), 2e5 and 10⁻³"
    assert claim.typeset(text) == "−1.5·10⁻⁷ and 10⁻¹², A-4, 3-7, e = −0.5, (−2), 2e5 and 10⁻³"


@pytest.mark.parametrize(
    ("holds", "shown", "standing", "because"),
    [
        (True, False, Standing.CONFIRMED, ""),
        (False, True, Standing.QUALIFIED, "of this"),
        (False, False, Standing.NOT_CONFIRMED, "of this"),
    ],
)
def test_verdict_follows_from_what_was_computed(holds, shown, standing, because):
    chapter = Chapter("any")

    @chapter.claim("anywhere", qualified="of this")
    def anything():
        """Something."""
        return Finding(holds, "1", shown)

    verdict = chapter[0].test()
    assert (verdict.standing, verdict.because, verdict.claim.says) == (standing, because, "Something")


COUNTS = {
    0.2: 74,
    0.3: 70,
    0.4: 34,
    0.5: 15,
    0.6: 10,
    0.7: 3,
    0.8: 0,
    0.9: 0,
    0.925: 0,
    0.95: 0,
    0.97: 0,
    0.99: 1,
    1.0: 10,
}


@pytest.mark.parametrize(
    ("compute", "other"),
    [
        ("chaos_above_095", {0.3: 90}),  # does not fall
        ("chaos_above_095", {0.2: 130, 0.3: 120}),  # not about every fifth
        ("chaos_above_095", {0.6: 20, 0.5: 30}),  # one in twenty at 0.6
        ("chaos_above_095", {0.6: 0, 0.7: 0}),  # not at every e up to there
        ("chaos_above_095", {0.9: 1}),  # one in the range of figure 12
        ("chaos_against_losses", {0.7: 20}),  # does not fall
        ("chaos_against_losses", {0.97: 3}),  # does not rise
        ("chaos_against_losses", {1.0: 2}),  # not above that at 0.8
        ("rare", {0.2: 130}),
    ],
)
def test_what_is_said_of_the_share_of_chaos_stands_only_with_the_numbers_of_its_row(
    monkeypatch, compute, other
):
    def verdict(counts):
        found = SimpleNamespace(shares=[rk.Share(counts[e], 400) for e in surveys.RESTITUTIONS])
        monkeypatch.setattr(surveys, "chaos", lambda: found)
        return one(compute).test()

    assert verdict(COUNTS).standing is one(compute).otherwise
    assert verdict(COUNTS | other).standing is Standing.NOT_CONFIRMED


def test_claim_without_another_explanation_is_unexplained_when_it_does_not_hold():
    chapter = Chapter("any")

    @chapter.claim("anywhere")
    def anything():
        """Something."""
        return Finding(False, "1", explained=True)

    assert chapter[0].test().standing is claim.Standing.NOT_CONFIRMED
