"""All claims and numbers of the paper, each with the computation that tests it; one file per chapter."""

from rocking.papers.yim_lin_1991.claims import (
    braced,
    conclusions,
    damped,
    identification,
    losses,
    melnikov,
    model,
    periodic,
    responses,
    undamped,
)

CHAPTERS = tuple(
    chapter.CHAPTER
    for chapter in (
        model,
        responses,
        identification,
        periodic,
        melnikov,
        undamped,
        damped,
        losses,
        braced,
        conclusions,
    )
)

__all__ = ["CHAPTERS"]
