"""Two halves of a branch, followed in both directions from the same point, as one branch."""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeVar

Point = TypeVar("Point")


class Half(NamedTuple, Generic[Point]):
    """Branch in one direction from its first point."""

    points: list[Point]
    specials: list[tuple[str, Point, int]]  # kind, point, and index of the point after it
    end: str


def joined(back: Half[Point], on: Half[Point]) -> tuple[tuple[Point, ...], list[tuple[str, Point, int]]]:
    """Return the points of a branch in order, and its special points with their indices there."""
    last = len(back.points) - 1
    specials = [(kind, point, last + 1 - index) for kind, point, index in reversed(back.specials)]
    specials += [(kind, point, last + index) for kind, point, index in on.specials]
    return (*reversed(back.points), *on.points[1:]), specials
