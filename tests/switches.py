"""Switches of the outcome: scales of a base motion between which a block begins to overturn.

A case has ``motion(scale)``, ``falls(scale)``, whether it overturns at a scale, and ``falls_exactly(scale)``, by 50 digits.
"""

import pytest


def switch(case, scales):
    """Return the two neighbouring scales of the first switch of the outcome of a case among ``scales``; None if there is none."""
    fell = [case.falls(scale) for scale in scales]
    if fell[0] or not any(fell):
        return None
    place = fell.index(True)
    low, high = scales[place - 1], scales[place]
    while low < 0.5 * (low + high) < high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if case.falls(middle) else (middle, high)
    return low, high


def with_switches(cases, scales):
    """Yield the cases that have a switch, and its two scales."""
    for case in cases:
        found = switch(case, scales)
        if found is not None:
            yield case, found


def compare_beside_switches(cases, scales, count, compare):
    """Compare ``count`` motions at either side of switches, at 1e-5 of the scale. ``compare`` returns whether the block overturned."""
    compared = 0
    for case, (low, high) in with_switches(cases, scales):
        assert not compare(case, low * (1 - 1e-5))
        assert compare(case, high * (1 + 1e-5))
        compared += 2
        if compared == count:
            return
    raise AssertionError(f"{compared} of {count} motions next to a switch")


def near_switches(cases, scales, count, powers):
    """Yield ``count`` cases and scales that differ from a switch by 10^-power of it, at either side."""
    left = count
    for case, (_, high) in with_switches(cases, scales):
        for power in powers:
            for sign in (-1, 1):
                yield case, high * (1 + sign * 10.0**-power)
                left -= 1
                if left == 0:
                    return


def agrees(motion, found, unit=1.0):
    """Return whether the block overturned, after a comparison of outcome and peak with another method, in units of that method."""
    fell = motion.outcome == "overturned"
    assert found.overturned == fell
    assert fell or found.peak == pytest.approx(unit * motion.peak, rel=0, abs=1e-6)
    return fell


def certified_near_switches(cases, scales, count, powers, least):
    """Return the cases near a switch with a certified outcome, after a comparison; most are certified, at least a share ``least``."""
    sure, fallen = [], 0
    for case, scale in near_switches(cases, scales, count, powers):
        motion = case.motion(scale)
        if motion.certified:
            exact = case.falls_exactly(scale)
            assert exact == (motion.outcome == "overturned")
            sure, fallen = [*sure, case], fallen + exact
    assert least * count < len(sure) < count
    assert 0 < fallen < len(sure)
    return sure


def check_margins_near_switches(cases, scales, count=24, powers=(5, 7)):
    """Check that the margin has the sign of the outcome, and vanishes at a switch."""
    motions = [case.motion(scale) for case, scale in near_switches(cases, scales, count, powers)]
    assert len(motions) == count
    for motion in motions:
        assert (motion.margin > 0) == (motion.outcome == "overturned")
        assert abs(motion.margin) < 1e-2
