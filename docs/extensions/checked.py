"""Check of the built pages: every link within them has a target, and nothing is loaded from another host.

Links to other hosts are checked in form only, because the network is not needed to build the pages.
"""

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

LOADED = {
    "script": "src",
    "img": "src",
    "iframe": "src",
    "source": "src",
    "video": "src",
    "audio": "src",
    "object": "data",
}
LOADED_LINKS = {
    "stylesheet",
    "icon",
    "preload",
    "prefetch",
    "preconnect",
    "dns-prefetch",
    "manifest",
    "modulepreload",
}
IN_STYLES = re.compile(r"""(?:url\(|@import\s)\s*["']?([^"')\s;]+)""")


ELSEWHERE = re.compile(
    r"https://(?:doi\.org/10\.\d{4,9}/|(?!doi\.org)[a-z0-9-]+(?:\.[a-z0-9-]+)*\.[a-z]{2,}(?:/|$))[^\s<>\"]*"
)
"""Address at another host; one of a DOI has its prefix and its suffix."""


class Page(HTMLParser):
    """Parsed page: its anchors (`ids`), the addresses it links to (`links`) and those it loads (`loads`)."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.loads = (
            set(),
            [],
            IN_STYLES.findall("".join(re.findall(r"<style.*?</style>", text, re.DOTALL))),
        )
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        found = {name: value or "" for name, value in attributes}
        self.ids |= {found[name] for name in ("id", "name") if name in found}
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        elif tag == "link" and LOADED_LINKS & set(found.get("rel", "").split()):
            self.loads.append(found.get("href", ""))
        elif LOADED.get(tag) in found:
            self.loads.append(found[LOADED[tag]])


def is_elsewhere(address):
    """Return whether an address names another host."""
    return bool(urlsplit(address).netloc)


def faults(folder):
    """Yield one sentence for each dead link and each request to another host in the pages and styles of a folder."""
    folder = folder.resolve()
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(folder.rglob("*.html"))}
    for path, page in pages.items():
        here = path.relative_to(folder)
        for address in page.links + page.loads:
            if is_elsewhere(address):
                if address in page.loads:
                    yield f"{here} asks another host for {address}"
                elif not ELSEWHERE.fullmatch(address):
                    yield f"{here} points at {address}, which is no address"
                continue
            if urlsplit(address).scheme:  # data:, mailto:
                continue
            name, anchor = urldefrag(address)
            target = (path.parent / unquote(urlsplit(name).path)).resolve() if name else path
            if not target.exists():
                yield f"{here} points at {address}, which is not there"
            elif anchor and target.suffix == ".html" and unquote(anchor) not in pages[target].ids:
                yield f"{here} points at {address}, and there is no such place on that page"
    for path in sorted(folder.rglob("*.css")):
        for address in filter(is_elsewhere, IN_STYLES.findall(path.read_text(encoding="utf-8"))):
            yield f"{path.relative_to(folder)} asks another host for {address}"


def check(app, failure):
    """Report each fault as a warning, which makes `make docs` fail."""
    from sphinx.util.logging import getLogger

    if failure is None and app.builder.format == "html":
        for fault in faults(Path(app.outdir)):
            getLogger(__name__).warning(fault)


def setup(app):
    app.connect("build-finished", check, priority=900)
