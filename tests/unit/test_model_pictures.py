"""Pictures of results in notebooks."""

import base64

import rocking as rk
from rocking.model import result


def test_text_below_a_picture_is_escaped_and_the_picture_is_a_png():
    shown = result.html(lambda: rk.plot.panels()[0], "2 < 3")
    assert shown.count("2 &lt; 3") == 2
    assert "2 < 3" not in shown
    png = shown.partition("base64,")[2].partition('"')[0]
    assert base64.b64decode(png).startswith(b"\x89PNG")
