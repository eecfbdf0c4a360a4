"""The whole of the paper, made once for all that look at it."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pytest

from rocking.papers.yim_lin_1991 import reproduce


class Reproduced(NamedTuple):
    """As `make reproduce` makes it: where it is, what was written, and how far it said to be."""

    folder: Path
    paths: Sequence[Path]
    calls: Sequence[tuple[int, int, str]]


@pytest.fixture(scope="session")
def reproduced(tmp_path_factory):
    folder, calls = tmp_path_factory.mktemp("figures") / "made" / "here", []
    paths = reproduce(folder, progress=lambda *call: calls.append(call))
    return Reproduced(folder, paths, calls)


@pytest.hookimpl(tryfirst=True)  # before items are chosen, and those of the workers grouped, by their marks
def pytest_collection_modifyitems(items):
    """It takes minutes, and one worker runs all that look at it."""
    for item in items:
        if "reproduced" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.xdist_group("reproduced"))
            item.add_marker(pytest.mark.long)
            item.add_marker(pytest.mark.timeout(1200))
