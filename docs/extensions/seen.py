"""Check of the built pages in a browser, at two widths: no page is too wide, no picture is missing, no other host is contacted."""

from contextlib import contextmanager
from pathlib import Path

CHROMIUM = Path("/usr/bin/chromium")
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
SCREENS = ((1280, 800), (390, 844))
# MathJax sets formulas in the browser, and pictures far below are loaded late.
LOOK = """async () => {
    await window.MathJax?.startup?.promise;
    const pictures = [...document.images];
    for (const each of pictures) each.loading = 'eager';
    await Promise.all(pictures.map(each => each.decode().catch(() => null)));
    return {width: document.documentElement.scrollWidth,
            missing: pictures.filter(each => each.naturalWidth === 0).map(each => each.alt || each.src.slice(0, 80))};
}"""


@contextmanager
def chromium():
    """Start a browser without a window."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        yield browser
        browser.close()


def faults(browser, folder, note=lambda page: None):
    """Yield one sentence for each fault of the pages in a folder, at each width. Each page is noted before it is opened."""
    for width, height in SCREENS:
        with browser.new_context(viewport={"width": width, "height": height}) as context:
            page, heard = context.new_page(), []
            page.on("console", lambda said, heard=heard: heard.append((said.type, said.text)))
            page.on("pageerror", lambda error, heard=heard: heard.append(("error", str(error))))
            page.on("request", lambda request, heard=heard: heard.append(("asks", request.url)))
            for path in sorted(folder.resolve().rglob("*.html")):
                heard.clear()
                here = f"{path.relative_to(folder.resolve())} at {width} px"
                note(here)
                page.goto(path.as_uri())
                seen = page.evaluate(LOOK)
                if seen["width"] > width:
                    yield f"{here} is {seen['width']} px wide"
                yield from (f"{here} lacks the picture {name}" for name in seen["missing"])
                yield from (
                    f"{here} complains: {text}" for kind, text in heard if kind in ("error", "warning")
                )
                yield from (
                    f"{here} asks for {text}"
                    for kind, text in heard
                    if kind == "asks" and text.startswith("http")
                )


def look(app, failure):
    """Report each fault as a warning, which makes `make docs` fail; without a browser, do nothing."""
    from sphinx.util.logging import getLogger

    if failure is None and app.builder.format == "html" and CHROMIUM.exists():
        logger = getLogger(__name__)
        with chromium() as browser:
            for fault in faults(browser, Path(app.outdir), lambda page: logger.info("looking at %s", page)):
                logger.warning(fault)


def setup(app):
    app.connect("build-finished", look, priority=910)
