"""Pages of a report: complete, linked with each other, with findings that follow from the verdicts and addresses that stay."""

import re
from pathlib import Path

import pytest

import rocking as rk
from docs.extensions import checked
from rocking.papers.catalogue import PAPERS
from rocking.papers.report import page
from rocking.papers.report.claim import Finding, Standing
from rocking.papers.report.paper import Paper
from rocking.papers.report.reproduce import reproduce


def figure():
    """Line: a figure.

    Its caption.
    """
    drawn, (ax,) = rk.plot.panels()
    ax.plot([0.0, 1.0])
    return drawn


def small(third=True):
    """Return a report with a figure of each kind and four claims in two chapters; the computation supports `third` or does not."""
    paper = Paper("small", "small", "A small report", "About {version}.", "nothing", (), (), 0.1)
    paper.figure("1", cost=0.1)(figure)
    paper.additional("more", cost=0.1)(figure)

    def first_claim():
        """One is one."""
        return Finding(True, "1")

    def second_claim():
        """Two is one & less than θcr."""
        return Finding(False, "2", explained=True)

    def third_claim():
        """Three is one."""
        return Finding(False, "3", explained=third)

    def fourth_claim():
        """Four is one."""
        return Finding(False, "4", explained=True)

    one, other = paper.chapter("Numbers, (1) to (3)"), paper.chapter("Another & last")
    one.claim("Eq. (1)", main=True)(first_claim)
    one.claim("Eq. (2)", error="two is two")(second_claim)
    one.claim("Eq. (3)", error="three is three", main=True)(third_claim)
    other.claim("Eq. (4)", misprint="four is four")(fourth_claim)
    return paper


PAGES = [
    "figures.html",
    "claims-numbers-1-to-3.html",
    "claims-another-last.html",
    "further-results.html",
    "verdicts.html",
]
ROWS = {
    "claim-first-claim": "claims-numbers-1-to-3.html",
    "claim-second-claim": "claims-numbers-1-to-3.html",
    "claim-third-claim": "claims-numbers-1-to-3.html",
    "claim-fourth-claim": "claims-another-last.html",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("small")
    reproduce(small(), folder)
    return folder


def read(path):
    return path.read_text(encoding="utf-8")


def links(path):
    return checked.Page(read(path)).links


def part(text, start, end):
    """Return the part of a page from one text to another, without tags and line breaks."""
    return " ".join(re.sub(r"<[^>]*>", "", text.partition(start)[2].partition(end)[0]).split())


def test_every_link_and_every_anchor_of_the_pages_has_a_target(folder):
    assert sorted(path.name for path in folder.glob("*.html")) == sorted([*PAGES, "index.html"])
    assert list(checked.faults(folder)) == []
    addresses = [address for path in folder.glob("*.html") for address in links(path)]
    assert len(addresses) > 40
    assert [address for address in addresses if ":" in address or address.startswith("/")] == []


def test_a_lost_page_or_row_would_be_noticed(folder, tmp_path):
    (tmp_path / "index.html").write_text(read(folder / "index.html"), encoding="utf-8")
    (tmp_path / "verdicts.html").touch()
    found = set(checked.faults(tmp_path))
    assert "index.html points at figures.html, which is not there" in found
    assert "index.html points at verdicts.html#error, and there is no such place on that page" in found


def test_first_page_leads_to_all_others_and_each_of_them_to_it_and_to_its_neighbours(folder):
    first = links(folder / "index.html")
    assert [name for name in first if name in PAGES] == PAGES
    for number, name in enumerate(PAGES):
        there = set(links(folder / name))
        assert "index.html" in there
        assert set(PAGES[max(number - 1, 0) : number + 2]) - {name} <= there


def test_each_counter_leads_to_the_rows_that_it_counts(folder):
    counters = re.findall(
        r'<li><a class="[\w-]+" href="verdicts.html#([\w-]+)">(.+?) \(<b>(\d+)</b>\)</a>',
        read(folder / "index.html"),
    )
    assert counters == [("confirmed", "Confirmed", "1"), ("misprint", "Misprint", "1"), ("error", "Error in the paper", "2")]  # fmt: skip
    text = read(folder / "verdicts.html")
    rows = {
        key: re.findall(r'<li><a href="(.+?)#(.+?)"', text.partition(f'id="{key}"')[2].partition("</ul>")[0])
        for key, _, _ in counters
    }
    assert [len(found) for found in rows.values()] == [int(count) for *_, count in counters]
    assert {anchor: name for found in rows.values() for name, anchor in found} == ROWS
    assert [anchor for _, anchor in rows["error"]] == ["claim-second-claim", "claim-third-claim"]


def test_each_row_has_an_address_that_other_verdicts_do_not_change(folder, tmp_path):
    reproduce(small(third=False), tmp_path)
    for anchor, name in ROWS.items():
        for made in (folder, tmp_path):
            text = read(made / name)
            assert text.count(f'<tr id="{anchor}">') == 1
            assert f'href="#{anchor}"' in text


@pytest.mark.parametrize("name", PAPERS)
def test_no_two_claims_of_a_report_have_the_same_address_and_some_are_main_findings(name):
    claims = [claim for chapter in PAPERS[name].chapters for claim in chapter]
    assert len({claim.anchor for claim in claims}) == len(claims)
    assert 4 < sum(claim.main for claim in claims) < 12


def test_findings_follow_from_the_verdicts(folder, tmp_path):
    found = part(read(folder / "index.html"), "Main findings", '<ul class="counts">')
    assert found == (
        "The report has 4 claims. 1 is confirmed as it stands. 1 contains a misprint. 2 are errors in the paper. Where a claim that "
        "is judged does not hold as it stands, the computation supports the explanation."
    )
    reproduce(small(third=False), tmp_path)
    found = part(read(tmp_path / "index.html"), "Main findings", '<ul class="counts">')
    assert found == (
        "The report has 4 claims. 1 is confirmed as it stands. 1 contains a misprint. 1 is an error in the paper. 1 is not confirmed."
    )


def test_main_claims_stand_on_the_first_page_with_their_verdicts(folder):
    found = part(read(folder / "index.html"), "The main claims, by verdict:", "</ul>")
    assert found == (
        "Eq. (1) (Numbers, (1) to (3)): One is one.confirmed "
        "Eq. (3) (Numbers, (1) to (3)): Three is one.error in the paper: three is three"
    )


def test_table_in_markdown_keeps_its_columns_where_a_text_has_a_bar(tmp_path):
    comma, bars = page.write_table(tmp_path, "sides", ["side", "angle"], [["left", "|Θ| < 1e-07"]])
    assert read(comma).splitlines()[1] == "left,|Θ| < 1e-07"
    assert read(bars).splitlines()[2] == r"| left | \|Θ\| < 10⁻⁷ |"


@pytest.mark.parametrize("standing", Standing)
def test_each_verdict_has_a_sentence_for_one_claim_and_for_several(standing):
    one, several = page.PREDICATES[standing]
    assert re.match(r"(is|contains) ", one)
    assert re.match(r"(are|contain) ", several)


def test_pages_hold_every_figure_claim_and_text_and_load_nothing(folder):
    text = "".join(read(folder / name) for name in [*PAGES, "index.html"])
    assert text.count('<img src="data:image/') == text.count("<img") == 2
    assert text.count("<figcaption><b>Line: a figure.</b>") == text.count("<p>Its caption.</p>") == 2
    assert "<td>Two is one &amp; less than θ<sub>cr</sub></td>" in text
    assert "return Finding(False, &#34;2&#34;, explained=True)" in text
    assert not re.search(r"@import|url\(|<script|src=(?!\"data:)", text)


def test_printed_report_is_one_document_with_all_parts(folder, tmp_path, monkeypatch):
    printed = []
    monkeypatch.setattr(page, "can_print", lambda: True)
    monkeypatch.setattr(page, "_print", lambda path, text: printed.append(text) or path)
    reproduce(small(), tmp_path)
    (text,) = printed
    document = checked.Page(text)
    assert {address for address in document.links if not address.startswith("#")} == set()
    assert {address[1:] for address in document.links} <= document.ids
    assert ROWS.keys() | {Path(name).stem for name in PAGES} <= document.ids
    assert len(re.findall(r'\bid="', text)) == len(document.ids - {"viewport"})  # a name, not a place
    assert text.count("<img") == 2


def test_first_page_is_written_last(tmp_path, monkeypatch):
    write = page._write_text

    def fail(path, text):
        if path.name == "verdicts.html":
            raise KeyboardInterrupt
        return write(path, text)

    monkeypatch.setattr(page, "_write_text", fail)
    with pytest.raises(KeyboardInterrupt):
        reproduce(small(), tmp_path)
    assert sorted(path.name for path in tmp_path.glob("*.html")) == sorted(PAGES[:-1])
    assert not list(tmp_path.glob(".*"))
