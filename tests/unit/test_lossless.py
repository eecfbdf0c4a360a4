"""How long a motion that loses nothing is followed between two looks."""

import pytest
from numba import njit

from rocking.kernels import lossless
from rocking.kernels.desk import LEG
from rocking.kernels.elementary import COMPILED


@njit(**COMPILED)
def asked_next(growth, cycle, max_cycles, rows):
    return lossless.asked_next(growth, cycle, max_cycles, rows)


@njit(**COMPILED)
def may_be_asked_for(growth, target, max_cycles, rows):
    return lossless.may_be_asked_for(growth, target, max_cycles, rows)


@pytest.mark.parametrize("growth", [0.0, lossless.OUTGROWN, lossless.OUTGROWN + 1.0])
@pytest.mark.parametrize("rows", [129, 257, 4001])
@pytest.mark.parametrize("max_cycles", [100, 129, 300, 640, 10_000, 150_000])
@pytest.mark.parametrize("batch", [1, 78, 781, 10**9])
def test_leg_whose_states_are_kept_is_short_and_the_last_states_are_kept(growth, rows, max_cycles, batch):
    cycle, longest, kept = 14, 0, 0
    while cycle < max_cycles:
        target = min(asked_next(growth, cycle, max_cycles, rows), cycle + batch, max_cycles)
        assert target > cycle
        wanted = may_be_asked_for(growth, target, max_cycles, rows)
        assert not wanted or target - cycle <= LEG
        kept = kept + target - cycle if wanted else 0
        cycle, longest = target, max(longest, target - cycle)
    assert kept >= min(rows, max_cycles - 14)
    assert (longest > LEG) == (growth > lossless.OUTGROWN and batch > LEG and max_cycles - rows - 14 > LEG)
