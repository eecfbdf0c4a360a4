"""Publication of the reports: ``{report} NAME`` links to one of them, or says how it is made.

``make reproduce`` takes minutes, so the pages do not make the reports themselves. They take copies of those that are there.
"""

import shutil
from pathlib import Path

from checked import Page
from docutils import nodes
from docutils.parsers.rst import Directive
from executed import ROOT

from rocking.papers.catalogue import PAPERS

MADE = ROOT / "results"
PAGE, TWIN = "index.html", "index.pdf"
REPORTS = tuple(PAPERS)  # names of folders, also in the built pages


def found(report):
    """Return the first page and the PDF of a report, as far as they are there; none without the page."""
    folder = MADE / report
    return (
        [folder / name for name in (PAGE, TWIN) if (folder / name).exists()]
        if (folder / PAGE).exists()
        else []
    )


def pages(report):
    """Return the pages of a report to which its first page links."""
    folder = MADE / report
    links = Page((folder / PAGE).read_text(encoding="utf-8")).links
    return sorted({folder / link.partition("#")[0] for link in links if ".html" in link})


class Report(Directive):
    """Links to a report, as pages and as PDF."""

    required_arguments = 1

    def run(self):
        environment = self.state.document.settings.env
        (report,) = self.arguments
        if report not in REPORTS:
            raise self.error(f"{report} is not among the reports {', '.join(REPORTS)}")
        environment.note_dependency(str(MADE / report / PAGE))
        files = found(report)
        paragraph = nodes.paragraph(classes=["report"])
        if not files:
            paragraph += [
                nodes.Text("These pages were built without the report. Run "),
                nodes.literal("", "make site"),
                nodes.Text(" to make the report and build the pages with it."),
            ]
        for path, title in zip(files, ("Open the report", "Open the PDF"), strict=False):
            paragraph += [nodes.Text(" · ")] if len(paragraph) else []
            paragraph += nodes.reference("", title, internal=True, refuri=f"{report}/{path.name}")
        return [paragraph]


def publish(app, failure):
    """Copy the reports into the built pages, and remove the copy of a report that is no longer there."""
    if failure is None and app.builder.format == "html":
        for report in REPORTS:
            folder = Path(app.outdir) / report
            shutil.rmtree(folder, ignore_errors=True)
            if files := found(report):
                folder.mkdir(exist_ok=True)
                for path in [*files, *pages(report)]:
                    shutil.copy2(path, folder)


def setup(app):
    app.add_directive("report", Report)
    app.connect("build-finished", publish, priority=800)  # before the pages are checked
