"""The paper's claims: complete, each with a verdict from a computation, and none unexplained."""

import csv
import re
from types import SimpleNamespace

import pytest

import rocking as rk
from rocking.papers.yim_lin_1991 import cached_surveys, claim
from rocking.papers.yim_lin_1991.claim import Chapter, Finding, Standing
from rocking.papers.yim_lin_1991.claims import CHAPTERS

PLACES = " | ".join(each.place for chapter in CHAPTERS for each in chapter)
SLIPS = {
    "equation_10": "A₁₁ + A₂₂",
    "zeros_19": "(k + ½)π",
    "equation_16b": "αt + ln θcr",
    "equation_17": "v/(αθcr)",
    "equation_13": "oppose",
    "equation_20a": "signs",
    "equation_21": "minus",
    "lower_orbit": "half a forcing period",
    "figure_2c": "(2,10)",
    "less_energy": "|Θ| < 1",
    "pairs": "one",
    "eigenvalues": "unit circle",
    "no_periodic": "neutrally stable",
    "exponent_periodic": "along the flow",
    "figure_7b": "three closed curves",
    "figure_7c": "nothing attracts",
    "damped_quasi_periodic": "contracts",
    "frequent_hits": "periodic in the end",
    "no_zeros": "A*",
    "sufficient": "necessary",
}
"""Claims of the paper that are errors, with the words required in the correction; each error is shown by a computation."""


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


@pytest.mark.parametrize("compute", [name for name in SLIPS if name not in {"frequent_hits", "sufficient"}])
def test_slip_of_the_paper_is_shown_by_its_computation(compute):
    judged = one(compute).judged()
    assert judged.standing is Standing.SLIPS, judged.finding
    assert SLIPS[compute] in judged.because


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
    ["equation_2", "equation_3", "equation_6", "pairs", "lower_orbit", "exponent_periodic", "divergence", "unsymmetric",
     "damped_quasi_periodic", "eigenvalues", "figure_7c", "exponent_quasi_periodic"],
)  # fmt: skip
def test_figures_of_a_claim_are_printed_as_in_a_journal(compute):
    figures = one(compute).judged().finding.figures
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
        (True, False, Standing.REPRODUCED, ""),
        (False, True, Standing.DIFFERS, "of this"),
        (False, False, Standing.UNEXPLAINED, "of this"),
    ],
)
def test_verdict_follows_from_what_was_computed(holds, shown, standing, because):
    chapter = Chapter("any")

    @chapter.claim("anywhere", differs="of this")
    def anything():
        """Something."""
        return Finding(holds, "1", shown)

    judged = chapter[0].judged()
    assert (judged.standing, judged.because, judged.claim.says) == (standing, because, "Something")


COUNTS = {
    0.2: 74,
    0.3: 70,
    0.4: 35,
    0.5: 15,
    0.6: 10,
    0.7: 3,
    0.8: 0,
    0.9: 0,
    0.925: 0,
    0.95: 0,
    0.97: 0,
    0.99: 1,
    1.0: 9,
}


@pytest.mark.parametrize(
    ("compute", "other"),
    [
        ("chaos_above_095", {0.3: 90}),  # does not fall
        ("chaos_above_095", {0.2: 130, 0.3: 120}),  # not about every fifth
        ("chaos_above_095", {0.6: 20, 0.5: 30}),  # one in twenty at 0.6
        ("chaos_above_095", {0.6: 0, 0.7: 0}),  # not at every e up to there
        ("chaos_against_losses", {0.7: 20}),
        ("rare", {0.2: 130}),
    ],
)
def test_what_is_said_of_the_share_of_chaos_stands_only_with_the_numbers_of_its_row(
    monkeypatch, compute, other
):
    def judged(counts):
        found = SimpleNamespace(shares=[rk.Share(counts[e], 400) for e in cached_surveys.RESTITUTIONS])
        monkeypatch.setattr(cached_surveys, "chaos", lambda: found)
        return one(compute).judged()

    assert judged(COUNTS).standing is one(compute).otherwise
    assert judged(COUNTS | other).standing is Standing.UNEXPLAINED


def test_claim_without_another_explanation_is_unexplained_when_it_does_not_hold():
    chapter = Chapter("any")

    @chapter.claim("anywhere")
    def anything():
        """Something."""
        return Finding(False, "1", shown=True)

    assert chapter[0].judged().standing is claim.Standing.UNEXPLAINED
