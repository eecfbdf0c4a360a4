"""The explorer in a real browser: time from a click to all figures, and from a new map to its first and last image."""

import subprocess
import sys
import time
from statistics import median

from benchmarks.table import Figure
from docs.extensions import seen

CLICKS = [(across / 7, up / 5) for across in range(1, 7) for up in range(1, 5)]
RESTITUTIONS = 0.92, 0.91, 0.9
PATIENCE = 60_000
APART = 500
"""Milliseconds between two clicks; a shorter interval makes a double click."""
WATCH = """() => {
  window.seen = {};
  const painted = name => requestAnimationFrame(() => requestAnimationFrame(() => { seen[name] ??= performance.now(); }));
  document.addEventListener("pointerdown", () => { window.seen = { begun: performance.now() }; }, true);
  link.properties.verdict.change.connect(() => painted("pictures"));
  link.properties.legend.change.connect(() => painted("first"));
  link.properties.progress.change.connect(() => { if (JSON.parse(link.progress).done) painted("last"); });
}"""
PLACE = """() => {
  const view = Bokeh.index.find_one(models.map), box = view.el.getBoundingClientRect(), inner = view.frame.bbox;
  return [box.left + inner.left, box.top + inner.top, inner.width, inner.height];
}"""


def page():
    """Time the page; no result without a browser."""
    if not seen.CHROMIUM.exists():
        return
    command = [sys.executable, "-m", "rocking", "explore", "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        try:
            address = server.stdout.readline().split()[0]
            with seen.chromium() as browser:
                yield from _figures(browser, address)
        finally:
            server.terminate()


def _figures(browser, address):
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(PATIENCE)
    page.goto(address)
    page.wait_for_selector("body[data-ready]")
    until(page, "document.body.dataset.map === 'done'")
    page.evaluate(WATCH)
    left, top, width, height = page.evaluate(PLACE)

    def click(across, up):
        page.wait_for_timeout(APART)
        page.mouse.click(left + across * width, top + (1 - up) * height)
        return waited(page, "pictures")

    def asked(restitution):
        page.evaluate(
            "e => { window.seen = { begun: performance.now() }; ask('fields', { restitution: e }); }",
            str(restitution),
        )
        return waited(page, "last"), waited(page, "first")

    click(0.5, 0.5)
    times = [click(*place) for place in CLICKS]
    yield Figure("a click, to all pictures", median(times), "ms", 150, note=f"slowest {max(times):.0f} ms")
    asked(0.93)
    last, first = zip(*map(asked, RESTITUTIONS), strict=True)
    yield Figure("a new map, to its first picture", median(first) / 1e3, "s", 0.3)
    yield Figure("  to 513 × 513 points, e < 1", median(last) / 1e3, "s", 0.5)
    last, first = asked(1.0)
    yield Figure("  e = 1, to its first picture", first / 1e3, "s", 0.3)
    yield Figure("  e = 1, to 513 × 513 points", last / 1e3, "s", 6.0)


def until(page, condition, arg=None):
    """Wait until a condition holds. Playwright's own function does it with `eval`, which the pages forbid."""
    last = time.monotonic() + PATIENCE / 1000
    while not page.evaluate(condition, arg):
        assert time.monotonic() < last, condition
        page.wait_for_timeout(10)


def waited(page, name):
    """Return the milliseconds from a request to the painting of its result."""
    until(page, "name => name in window.seen", name)
    return page.evaluate("name => window.seen[name] - window.seen.begun", name)
