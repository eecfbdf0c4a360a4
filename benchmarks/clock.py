"""How times are taken: medians of several runs, warmed up once."""

from statistics import median
from time import perf_counter


def seconds(repeats, work, *arguments):
    """Median wall time of `work(*arguments)` over the runs after one that does not count, and what it returned last."""
    work(*arguments)
    times = []
    for _ in range(repeats):
        begun = perf_counter()
        result = work(*arguments)
        times.append(perf_counter() - begun)
    return median(times), result
