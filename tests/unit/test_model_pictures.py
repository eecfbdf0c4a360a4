"""Results show themselves by renderers that a higher package registers, imported only when the first is shown."""

import base64

import pytest

from rocking.model import result as registry


class Result:
    def __str__(self):
        return "2 < 3"


@pytest.fixture(autouse=True)
def empty_registry(monkeypatch):
    monkeypatch.setattr(registry, "_draws", {})
    monkeypatch.setattr(registry, "_fills", [])


def test_result_without_a_picture_shows_its_line_alone():
    assert registry.html(Result()) is None


def test_registry_is_filled_once_and_only_when_a_result_is_shown():
    filled = []

    def fill():
        filled.append(1)
        registry.register(Result, lambda result: b"png")

    registry.fill_at_first_use(fill)
    assert not filled
    shown = [registry.html(Result()) for _ in range(2)]
    assert filled == [1]
    assert shown[0] == shown[1]
    assert base64.b64encode(b"png").decode() in shown[0]
    assert "2 &lt; 3" in shown[0]
