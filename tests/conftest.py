"""The whole of the paper, made once for all that look at it; and what the tests look at in part, or with --exhaustive whole."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
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


def pytest_addoption(parser):
    what = "run those tests alone that look at a part of something, and have them look at the whole"
    parser.addoption("--exhaustive", action="store_true", help=what)


@pytest.fixture
def thin(request):
    """Take ``count`` of some items, evenly spread, or at random with a seed, which is printed; with --exhaustive all of them."""

    def take(items, count, seed=None):
        if request.config.getoption("exhaustive"):
            print(f"all {len(items)}")
            return items
        if seed is None:
            return items[:: max(len(items) // count, 1)]
        print(f"{count} of {len(items)}, seed {seed}")
        return [items[k] for k in np.random.default_rng(seed).choice(len(items), count, replace=False)]

    return take


@pytest.hookimpl(tryfirst=True)  # before items are chosen, and those of the workers grouped, by their marks
def pytest_collection_modifyitems(config, items):
    """Mark what looks at the whole of the paper: it takes minutes, and one worker runs it. Choose what --exhaustive asks for."""
    for item in items:
        if "reproduced" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.xdist_group("reproduced"))
            item.add_marker(pytest.mark.long)
            item.add_marker(pytest.mark.timeout(1200))
    if config.getoption("exhaustive"):
        rest = [item for item in items if "thin" not in getattr(item, "fixturenames", ())]
        config.hook.pytest_deselected(items=rest)
        items[:] = [item for item in items if item not in rest]
