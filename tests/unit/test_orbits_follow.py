"""The loop that follows a branch point by point: its steps, its special points, and its ends."""

from typing import NamedTuple

import pytest
from attrs import field, frozen

import rocking as rk
from rocking.orbits.branch import ENDS
from rocking.orbits.event_chain import End
from rocking.orbits.follow import Passage, Problem, follow

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.9)


class Place(NamedTuple):
    """Point of a line."""

    value: float


@frozen
class Line(Problem[Place]):
    """The points of a line, where no step may cross a gap; a test function changes its sign at 0.25."""

    gap: float
    opens: bool
    lengths: list[float] = field(factory=list)

    SHORTEST = 0.1
    GROWTH = 2.0

    def value(self, point):
        return point.value

    def corrected(self, here, length):
        self.lengths.append(length)
        there = Place(here.value + length)
        return End.LOST if here.value < self.gap <= there.value else there

    def tests(self, here, there):
        return [("zero", Place(0.25))] if here.value < 0.25 <= there.value else []

    def obstacle(self, here, length, reason):
        if not self.opens:
            return Passage([], end=ENDS[reason])
        last, there = Place(self.gap), Place(self.gap + length)
        return Passage([last, there], [("gap", last, 1)])

    def end(self, points):
        return End.RANGE if points[-1].value >= self.high else None

    def at_value(self, here, there, share, value):
        return Place(value)


def line(*, opens, longest=0.125):
    return Line(SYSTEM, "amplitude", 1, 0.0, 1.0, longest, gap=0.7, opens=opens)


def test_a_step_that_fails_is_halved_and_grows_again_after_the_obstacle():
    problem = line(opens=True)
    half = follow(problem, Place(0.0), 100)
    # halved from 0.125, the last step that is not below a tenth of it
    assert min(problem.lengths) == 0.015625
    assert max(problem.lengths) == problem.longest
    after = problem.lengths[problem.lengths.index(0.015625) + 1 :]
    assert after[-1] == problem.longest
    assert half.end == ENDS[End.RANGE]


def test_a_special_point_lies_between_the_points_before_and_at_its_index():
    half = follow(line(opens=True), Place(0.0), 100)
    assert [kind for kind, *_ in half.specials] == ["zero", "gap"]
    for _, point, index in half.specials:
        assert half.points[index - 1].value <= point.value <= half.points[index].value


def test_a_branch_ends_at_an_obstacle_that_does_not_open():
    half = follow(line(opens=False), Place(0.0), 100)
    assert half.end == ENDS[End.LOST]
    assert half.points[-1].value < 0.7


@pytest.mark.parametrize("most", range(1, 12))
def test_a_branch_has_at_most_the_points_wanted(most):
    half = follow(line(opens=True), Place(0.0), most)
    assert len(half.points) == most
    assert half.end == ENDS[End.MANY]
