"""Static pages in a browser: the report on the paper. Those of `docs` are tested where they are built."""

import pytest

from docs.extensions import checked, seen


def test_report_can_be_read_on_a_desk_and_on_a_phone(browser, reproduced):
    assert list(checked.faults(reproduced.folder)) == []
    assert list(seen.faults(browser, reproduced.folder)) == []


@pytest.mark.long
def test_sound_page_has_no_faults(browser, tmp_path):
    (tmp_path / "a.html").write_text(
        '<p>a</p><div style="overflow-x: auto"><pre style="width: 2000px">b</pre></div>'
        '<img alt="c" src="data:image/gif;base64,R0lGODlhAQABAAAAACwAAAAAAQABAAA=">'
    )
    assert list(seen.faults(browser, tmp_path)) == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('<pre style="width: 800px">a</pre>', ["a.html at 390 px is 808 px wide"]),
        (
            '<img alt="b" loading="lazy" src="data:image/png;base64,AA==">',
            ["a.html at 1280 px lacks the picture b", "a.html at 390 px lacks the picture b"],
        ),
        (
            '<script>innerWidth < 400 && console.warn("narrow")</script>',
            ["a.html at 390 px complains: narrow"],
        ),
        (
            "<script>innerWidth < 400 && lost()</script>",
            ["a.html at 390 px complains: lost is not defined"],
        ),
        (
            '<script>innerWidth < 400 && fetch("http://localhost:9/x").catch(() => null)</script>',
            ["a.html at 390 px asks for http://localhost:9/x"],
        ),
    ],
)
@pytest.mark.long
def test_each_fault_is_said(browser, tmp_path, text, said):
    (tmp_path / "a.html").write_text('<meta name="viewport" content="width=device-width">' + text)
    found = list(seen.faults(browser, tmp_path))
    assert [fault for fault in found if "ERR_" not in fault and "CORS" not in fault] == said
