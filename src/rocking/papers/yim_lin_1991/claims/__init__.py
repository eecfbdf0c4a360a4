"""Every claim and number of the paper, each with the computation that judges it, a chapter a file."""

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
