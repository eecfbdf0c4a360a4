"""The first event of an arc under a sampled base acceleration against an oracle that proves it in ball arithmetic."""

import math

import numpy as np
import pytest
from flint import arb

from oracles.segment_arcs import AMBIGUOUS, ROUNDING, Arc, arcs, first_events, lowest_dip, size, state_at
from rocking.kernels import event_kinds
from rocking.kernels.arc.search_samples import first_event
from rocking.kernels.arc.slender_samples import arc_at_place
from rocking.kernels.base.samples import SampledDrive, tables_of
from rocking.kernels.library.kernel import kernel
from rocking.kernels.system import sampled_system, slender_block

# 22,000 arcs; 50 times as many in the long test.
COUNTS = {
    "generic": 6_000,
    "touching": 5_000,
    "grazing_start": 5_000,
    "long": 2_000,
    "grazing_brace": 2_000,
    "coarse": 2_000,
}
LONG = ("long", "touching", "grazing_start")
LONG_CHUNKS = 50
KINDS = {event_kinds.IMPACT: "base", event_kinds.BRACE: "brace", event_kinds.NONE: "none"}


@kernel
def event_of(p, side, index, offset, angle, velocity):
    coming, extremes = first_event(
        p, arc_at_place(p, side, 0.0, angle, velocity, SampledDrive(index, offset))
    )
    return (
        coming.event,
        coming.drive.index,
        coming.drive.offset,
        coming.velocity,
        coming.wait,
        extremes.dip,
        extremes.dip_time,
        extremes.low,
    )


def search_from(arc):
    p = sampled_system(slender_block(0.9, arc.brace), tables_of(arc.values, arc.step), 1.0, 64 * arc.step)
    return event_of(p, arc.side, arc.index, arc.offset, arc.angle, arc.velocity)


def found_by_package(arc):
    """Return kind, sample and time after it, and u' there."""
    kind, *place, velocity, _, _, _, _ = search_from(arc)
    return KINDS[kind], *place, velocity


def agrees(arc, event, found):
    """Return whether the package found this event: kind, distance zero to rounding, time near, speed."""
    kind, index, offset, velocity = found
    if event.kind == "none" or kind != event.kind:
        return kind == event.kind
    u, v, time = state_at(arc, index, offset)
    terms = AMBIGUOUS * ROUNDING * size(arc, time)
    slip = 4 * ROUNDING * (time + offset)
    height = u - (arb(arc.brace) if kind == "brace" else 0)
    # Where the block only just arrives, a rounding of u changes the speed by that over the speed.
    largest = 2 + float(np.abs(arc.values).max())
    slow = terms * largest / abs(v) + 4 * terms * arb.exp(time) + slip * largest
    return bool(
        abs(height) <= terms + slip * abs(v)
        and abs(time - event.time) <= event.time / 50 + slip
        and abs(v - velocity) <= slow + 4 * AMBIGUOUS * ROUNDING * (abs(v) + time * largest)
    )


def wrong_in(family, count, seed):
    """Return the arcs whose first event the package misses or misreads."""
    wrong = []
    for arc in arcs(family, count, seed):
        events, found = first_events(arc), found_by_package(arc)
        if not any(agrees(arc, event, found) for event in events):
            wrong.append((arc, found, [(event.kind, float(event.time), event.definite) for event in events]))
    return wrong


def check(family, count, seed):
    wrong = wrong_in(family, count, seed)
    assert not wrong, f"{len(wrong)} of {count} wrong; the first: {wrong[0]}"


@pytest.mark.parametrize(
    "family", [pytest.param(each, marks=pytest.mark.long) if each in LONG else each for each in COUNTS]
)
def test_no_first_event_is_missed_or_misread(family):
    check(family, COUNTS[family] // 5, 0)


@pytest.mark.long
@pytest.mark.parametrize("chunk", range(LONG_CHUNKS))
@pytest.mark.parametrize("family", COUNTS)
def test_no_first_event_is_missed_or_misread_in_a_million_arcs(family, chunk):
    check(family, COUNTS[family], 1000 + chunk)


@pytest.mark.parametrize("family", ["touching", "long"])
def test_lowest_dip_before_the_event_is_found(family):
    """A dip that spans no sample may be missed only above the distance that proves its interval to contain no event."""
    checked = 0
    for arc in arcs(family, 1_000, 5):
        *_, wait, angle, time, _ = search_from(arc)
        lowest, when = lowest_dip(arc, wait)
        if lowest > arc.step**2 / 8:
            continue
        assert abs(lowest - angle) <= AMBIGUOUS * ROUNDING * size(arc, when)
        assert abs(when - time) <= 1e-6 * when
        checked += 1
    assert checked > 100


def test_dips_of_the_arcs_are_shallow():
    """Among the arcs that come back from a dip, many have one within a billionth of the base."""
    dips = [first_events(arc) for arc in arcs("touching", 300, 2)]
    hidden = sum(not events[0].definite for events in dips)
    assert 5 < hidden < 200
    assert sum(math.isfinite(float(events[-1].time)) for events in dips) > 100


@pytest.mark.parametrize("step", [0.005, 0.01, 0.02, 0.05])
@pytest.mark.parametrize("side", [-1, 1])
def test_minimum_within_a_stride_lies_above_its_bound(side, step):
    """Pushed upwards, a falling block turns before it reaches the base. Its minimum is not searched."""
    for fall in np.linspace(0.3, 1.0, 40):
        values = np.full(int(2.0 / step), -2.0 * side)
        arc = Arc(values, step, side, 0, 0.3 * step, 0.6, -float(fall), math.inf)
        *_, wait, angle, _, low = search_from(arc)
        lowest, _ = lowest_dip(arc, wait)
        assert angle == wait == math.inf
        assert lowest - 0.12**2 / 2 < low < lowest


@pytest.mark.parametrize("side", [-1, 1])
def test_strides_that_only_rise_have_no_bound(side):
    values = np.full(100, -2.0 * side)
    *_, wait, angle, _, low = search_from(Arc(values, 0.01, side, 0, 0.0, 0.6, 3.0, math.inf))
    assert angle == wait == low == math.inf


@pytest.mark.parametrize(("step", "intervals"), [(1e-4, 64), (0.007, 16), (0.03, 4), (0.2, 1)])
def test_a_stride_is_its_intervals_one_after_another(step, intervals):
    tables = tables_of(np.random.default_rng(4).normal(size=200), step)
    assert tables.stride == intervals
    growth, decay = arb(step).exp(), (-arb(step)).exp()
    for first in range(0, 200 - intervals, 7):
        ahead, behind = arb(0), arb(0)
        for k in range(first, first + intervals):
            start, end = (arb(float(a)) for a in tables.samples[k : k + 2])
            mean = (growth - 1) / step
            ahead = growth * ahead + start * (growth - mean) + end * (mean - 1)
            mean = (1 - decay) / step
            behind = decay * behind + start * (mean - decay) + end * (1 - mean)
        row, size = tables.strides[first], 4 * ROUNDING * intervals**2 * step
        assert abs(ahead - float(row["ahead"])) < size
        assert abs(behind - float(row["behind"])) < size
