"""Publication of the report of the paper: ``{report}`` links to it, or says how it is made.

``make reproduce`` takes minutes, so the pages do not make the report themselves. They take a copy of the one that is there.
"""

import shutil
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive
from executed import ROOT

MADE = ROOT / "results" / "yim-lin-1991"
PAGE, TWIN = "index.html", "index.pdf"
PUBLISHED = "yim-lin-1991"  # folder in the built pages


def found():
    """Return the files of the report that are there, page first; none without the page."""
    return [MADE / name for name in (PAGE, TWIN) if (MADE / name).exists()] if (MADE / PAGE).exists() else []


class Report(Directive):
    """Links to the report, as page and as PDF."""

    def run(self):
        environment = self.state.document.settings.env
        environment.note_dependency(str(MADE / PAGE))
        files = found()
        paragraph = nodes.paragraph(classes=["report"])
        if not files:
            paragraph += [
                nodes.Text("These pages were built without the report. Run "),
                nodes.literal("", "make site"),
                nodes.Text(" to make the report and build the pages with it."),
            ]
        for path, title in zip(files, ("Open the report", "Open the PDF"), strict=False):
            paragraph += [nodes.Text(" · ")] if len(paragraph) else []
            paragraph += nodes.reference("", title, internal=True, refuri=f"{PUBLISHED}/{path.name}")
        return [paragraph]


def publish(app, failure):
    """Copy the report into the built pages, and remove the copy of a report that is no longer there."""
    if failure is None and app.builder.format == "html":
        folder = Path(app.outdir) / PUBLISHED
        shutil.rmtree(folder, ignore_errors=True)
        for path in found():
            folder.mkdir(exist_ok=True)
            shutil.copy2(path, folder)


def setup(app):
    app.add_directive("report", Report)
    app.connect("build-finished", publish, priority=800)  # before the pages are checked
