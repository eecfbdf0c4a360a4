"""Cost of the closed forms of the theory, over arrays and one by one."""

from time import thread_time

import numpy as np

import rocking as rk
from benchmarks.clock import quickest
from benchmarks.table import Figure

COUNT = 1_000_000
RUNS = 5


def amplitudes():
    """Time closed forms at a million periods and restitutions, and the modes of single systems."""
    random = np.random.default_rng(1984)
    periods, e = random.uniform(0.2, 3.0, COUNT), random.uniform(0.1, 1.0, COUNT)
    for name in ("existence", "symmetry_breaking", "melnikov", "heteroclinic"):
        function = getattr(rk.theory, f"{name}_amplitude")
        more = (3,) if name in ("existence", "symmetry_breaking") else ()
        seconds, _ = quickest(RUNS, lambda f=function, m=more: f(periods, e, *m), thread_time)
        yield Figure(f"10⁶ {name} amplitudes", seconds, "s", 0.2)
    rk.theory.symmetric_modes(2.0, 1.0, 0.925, 1)
    shaken = np.linspace(0.5, 16.0, 2_000)
    seconds, _ = quickest(
        RUNS, lambda: [rk.theory.symmetric_modes(a, 1.0, 0.925, 1) for a in shaken.tolist()], thread_time
    )
    yield Figure("modes of a system, proof that they are admissible included", seconds / 2e-3, "µs")
