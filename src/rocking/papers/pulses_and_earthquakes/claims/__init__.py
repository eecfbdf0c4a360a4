"""All rows of the report, each with the computation that tests it; one file for each paper, and one for further findings."""

from rocking.papers.pulses_and_earthquakes.claims import (
    findings,
    housner,
    makris_konstantinidis,
    makris_roussos,
    zhang_makris,
)

CHAPTERS = tuple(
    chapter.CHAPTER for chapter in (housner, makris_roussos, zhang_makris, makris_konstantinidis, findings)
)

__all__ = ["CHAPTERS"]
