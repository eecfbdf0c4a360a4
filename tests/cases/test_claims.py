"""The paper's claims: all of them are there, each judged by a computation, and none is left unexplained."""

import re

import pytest

from rocking.papers.yim_lin_1991 import claim
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
"""Where the paper slips, by what must be said in its place: THEORY's list, each shown by a computation of its own."""


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


def test_claim_without_another_explanation_is_unexplained_when_it_does_not_hold():
    chapter = Chapter("any")

    @chapter.claim("anywhere")
    def anything():
        """Something."""
        return Finding(False, "1", shown=True)

    assert chapter[0].judged().standing is claim.Standing.UNEXPLAINED
