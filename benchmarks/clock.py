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


def quickest_in_turn(turns, ways, clock=perf_counter):
    """``quickest`` of each of several ways, run one after another in every turn: none alone meets a bad moment of the machine."""
    runs = [[quickest(1, way, clock) for way in ways] for _ in range(turns)]
    return [min(of_one, key=lambda run: run[0]) for of_one in zip(*runs, strict=True)]


def nanoseconds_per_impact(repeats, march, *arguments):
    """Of a march on one thread, in processor time: whatever else the machine does counts as little as it can."""
    time, (impacts, _) = seconds(repeats, march, *arguments, clock=thread_time)
    return 1e9 * time / impacts
