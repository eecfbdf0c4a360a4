"""A real browser and the page's server, each in a separate process; screenshots go into `results`."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

import pytest

from docs.extensions import seen

SEEN = Path(__file__).parents[2] / "results" / "browser"
PATIENCE = 180_000
"""Milliseconds to wait for what takes at most fifteen seconds on two free cores. It only ends a test that would never end."""


@pytest.hookimpl(tryfirst=True)  # before the workers' items are grouped by their marks
def pytest_collection_modifyitems(items):
    """Let one worker run all tests of the page, with one server and one browser; tests of the report run where it is made."""
    for item in items:
        if item.path.parent == Path(__file__).parent and "reproduced" not in item.fixturenames:
            item.add_marker(pytest.mark.xdist_group("browser"))


class Running(NamedTuple):
    """The explorer in a separate process."""

    link: str
    process: subprocess.Popen

    @property
    def address(self):
        return self.link.partition("?")[0]

    @property
    def cookie(self):
        """Headers of its user."""
        token = self.link.partition("token=")[2]
        return {"Cookie": f"rocking-{urlsplit(self.link).port}={token}"}


@pytest.fixture(scope="session")
def running():
    """Run an explorer that must end without messages."""
    command = [sys.executable, "-m", "rocking", "explore", "--port", "0", "--no-browser"]
    # A pipe that nobody reads stops the server when it is full: Bokeh notes each message to a visit that is gone.
    with (
        tempfile.TemporaryFile("w+") as errors,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True) as process,
    ):
        try:
            line = process.stdout.readline()
            yield Running(line.split()[0], process)
        finally:
            process.terminate()
            process.wait()
        errors.seek(0)
        assert "Traceback" not in errors.read()


@pytest.fixture(scope="session")
def browser():
    if not seen.CHROMIUM.exists():
        pytest.skip(f"there is no {seen.CHROMIUM}: scripts/debian.sh chromium")
    with seen.chromium() as browser:
        yield browser


class Visitor:
    """Page with the errors that it logged and the hosts that it contacted."""

    def __init__(self, context, running):
        self.running, self.complaints, self.hosts = running, [], set()
        self.page = context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.page.on("console", self._heard)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.hosts.add(urlsplit(request.url).hostname))
        self.page.on("websocket", lambda socket: self.hosts.add(urlsplit(socket.url).hostname))

    def _heard(self, message):
        if message.type in ("error", "warning"):
            self.complaints.append(message.text)

    def open(self, query=""):
        """Open an address with the token, as the user does."""
        token = self.running.link.partition("?")[2]
        self.page.goto(f"{self.running.address}{query}{'&' if '?' in query else '?'}{token}")
        self.page.wait_for_selector("body[data-ready]")
        self.judged()

    def judged(self):
        """Wait for the verdict on the selected system."""
        self.page.wait_for_selector("#verdict:not(.stale)")

    def finished(self):
        """Wait until the map is complete."""
        self.until("document.body.dataset.map === 'done'")

    def until(self, condition, arg=None):
        """Wait until a condition holds. Playwright's own function does it with `eval`, which the pages forbid."""
        last = time.monotonic() + PATIENCE / 1000
        while not self.page.evaluate(condition, arg):
            assert time.monotonic() < last, condition
            self.page.wait_for_timeout(20)

    def text(self, name):
        """Return the text of an element; what is folded is unfolded."""
        self.page.evaluate(
            "name => { const folded = document.getElementById(name).closest('details'); if (folded) folded.open = true; }",
            name,
        )
        return self.page.inner_text(f"#{name}")

    def data(self, name):
        """A fingerprint of what the figure `name` draws."""
        return self.page.evaluate(
            """name => { const figure = Bokeh.documents[0].get_model_by_name(name);
                 const told = value => ArrayBuffer.isView(value) ? Array.from(value) : Array.isArray(value) ? value.map(told) : value;
                 return JSON.stringify(figure.renderers.map(each => {
                     const data = each.data_source.data;
                     return [...(data instanceof Map ? data : Object.entries(data))].map(([key, values]) => [key, told(values)]); })); }""",
            name,
        )

    def place(self, name, across, up):
        """Return the page coordinates of a point in a figure, given as fractions of its frame."""
        left, top, width, height = self.page.evaluate(
            """name => { const view = Bokeh.index.find_one(Bokeh.documents[0].get_model_by_name(name));
                 const box = view.el.getBoundingClientRect(), inner = view.frame.bbox;
                 return [box.left + inner.left, box.top + inner.top, inner.width, inner.height]; }""",
            name,
        )
        return left + across * width, top + (1 - up) * height

    def click(self, name, across, up):
        self.page.mouse.click(*self.place(name, across, up))

    def wheel(self, name, across, up, turns):
        self.page.mouse.move(*self.place(name, across, up))
        self.page.mouse.wheel(0, turns)

    def see(self, name):
        """Save a screenshot of the page."""
        SEEN.mkdir(parents=True, exist_ok=True)
        self.page.screenshot(path=SEEN / f"{name}.png")

    def is_content(self):
        assert self.complaints == []
        assert self.hosts <= {"localhost", ""}


@pytest.fixture
def visit(browser, running):
    """Open the page in a new session with the given width, height and colour scheme."""
    contexts = []

    def come(width=1280, height=800, scheme="light"):
        contexts.append(browser.new_context(viewport={"width": width, "height": height}, color_scheme=scheme))
        return Visitor(contexts[-1], running)

    yield come
    for context in contexts:
        context.close()
