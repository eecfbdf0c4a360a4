"""Common to all tests: figures without a screen."""

import os
import signal

import pytest

os.environ["MPLBACKEND"] = "Agg"

# A process in the background ignores Ctrl-C, and so do the processes that it starts.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)  # before the items are grouped by their marks for the workers
def pytest_collection_modifyitems(items):
    """Run each example of the package once. An example of a public name is also found where it is public."""
    items[:] = [item for item in items if item.path.name != "__init__.py"]
