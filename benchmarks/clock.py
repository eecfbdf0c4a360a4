"""Timing: medians of several runs after a warm-up run, or the quickest of them."""

from statistics import median
from time import perf_counter, thread_time


def seconds(repeats, work, *arguments, clock=perf_counter):
    """Return the median time of `work(*arguments)` after a warm-up run, and its last result."""
    work(*arguments)
    times = []
    for _ in range(repeats):
        begun = clock()
        result = work(*arguments)
        times.append(clock() - begun)
    return median(times), result


def quickest(repeats, work, clock=perf_counter):
    """Return the time of the quickest run of `work()`, and its last result."""
    times = []
    for _ in range(repeats):
        begun = clock()
        result = work()
        times.append(clock() - begun)
    return min(times), result


def quickest_in_turn(turns, ways, clock=perf_counter):
    """Return ``quickest`` of several functions, run alternately, so that load on the machine affects all of them."""
    runs = [[quickest(1, way, clock) for way in ways] for _ in range(turns)]
    return [min(of_one, key=lambda run: run[0]) for of_one in zip(*runs, strict=True)]


def nanoseconds_per_impact(repeats, march, *arguments):
    """Time a march on one thread in processor time, which depends least on other load."""
    time, (impacts, _) = seconds(repeats, march, *arguments, clock=thread_time)
    return 1e9 * time / impacts
