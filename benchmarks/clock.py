"""How times are taken: medians of several runs, warmed up once; or the quickest of them."""

from statistics import median
from time import perf_counter, thread_time


def seconds(repeats, work, *arguments, clock=perf_counter):
    """Median time of `work(*arguments)` over the runs after one that does not count, and what it returned last."""
    work(*arguments)
    times = []
    for _ in range(repeats):
        begun = clock()
        result = work(*arguments)
        times.append(clock() - begun)
    return median(times), result


def quickest(repeats, work, clock=perf_counter):
    """Time of the quickest run of `work()`, and what the last returned."""
    times = []
    for _ in range(repeats):
        begun = clock()
        result = work()
        times.append(clock() - begun)
    return min(times), result


def nanoseconds_per_impact(repeats, march, *arguments):
    """Of a march on one thread, in processor time: whatever else the machine does counts as little as it can."""
    time, (impacts, _) = seconds(repeats, march, *arguments, clock=thread_time)
    return 1e9 * time / impacts
