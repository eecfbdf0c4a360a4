"""Write `method.json`: results of the surveys' method for some systems, all of them far from any boundary.

Run `python tests/data/make_method.py` after METHOD in `kernels/batch.py` was raised. A case is rejected if its counts
change with the last digits of the amplitude, or if its numbers change by more than these digits.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np

from rocking.kernels import batch

TABLE = Path(__file__).with_name("method.json")
MAX_CYCLES, MAX_PERIOD = 20_000, 64
WHOLE = ("kind", "ground", "period", "symmetric", "impacts", "brace_hits", "transient", "cycles")
REAL = ("exponent", "peak")
BESIDE = 1e-12
# A, T, φ, e, Θb, r, Θ, Θ'
CASES = [
    (0.9, 1.0, 0.0, 0.9, math.inf, 1.0, 0.0, 0.0),  # never moves
    (0.5, 1.0, 0.3, 0.8, math.inf, 1.0, 0.1, 0.05),  # comes to rest
    (0.5, 2.0, 0.0, 0.9, 1.0, 0.5, 0.5, 1.0),  # comes to rest, or leans
    (0.2, 2.0, 0.0, 0.9, 1.5, 0.5, 1.2, 0.5),  # leans on a brace
    (2.0, 1.0, 0.0, 0.925, math.inf, 1.0, 0.0, 0.0),
    (2.0, 1.0, 1.0, 0.925, math.inf, 1.0, 0.2, -0.1),
    (6.5, 0.4, 0.0, 0.925, math.inf, 1.0, 0.0, 0.0),
    (5.5, 0.5, 1.8, 0.925, math.inf, 1.0, 0.0, 0.15),  # period 10
    (1.5, 0.5, 0.0, 0.8, math.inf, 1.0, 0.0, 0.0),
    (1.2, 1.5, 0.0, 0.9, math.inf, 1.0, 0.0, 0.0),
    (1.1, 0.7, 0.0, 0.5, math.inf, 1.0, 0.0, 0.0),  # rests in every period
    (9.0, 1.6, 0.0, 0.8, math.inf, 1.0, 0.0, 0.0),
    (9.0, 1.721328, 0.0, 0.8, math.inf, 1.0, 0.0, 0.0),  # asymmetric
    (12.0, 1.0, 0.0, 0.95, math.inf, 1.0, 0.0, 0.0),
    (3.0, 0.6, 0.5, 0.7, math.inf, 1.0, 0.0, 0.0),
    (4.0, 0.3, 0.0, 0.0, math.inf, 1.0, 0.0, 0.0),  # falls dead
    (1.75, 2.0, 0.0, 0.95, math.inf, 1.0, 0.0, 0.0),  # overturns
    (8.0, 2.5, 0.0, 0.9, math.inf, 1.0, 0.0, 0.0),
    (0.3, 3.0, 0.0, 0.9, math.inf, 1.0, 0.8, 0.6),
    (4.0, 0.4, 0.0, 1.0, math.inf, 1.0, 0.0, 0.0),  # a torus
    (0.1, 1.0, 0.0, 0.9, 1.5, 1.0, 1.3, 0.0),  # a torus that meets only a brace
    (15.0, 1.0, 0.0, 0.9, 1.0, 0.8, 0.0, 0.0),
    (12.0, 1.5, 0.0, 0.925, 1.0, 1.0, 0.0, 0.0),
    (3.0, 1.0, 0.0, 0.8, 0.5, 0.5, 0.0, 0.0),
    (2.0, 3.0, 0.0, 0.9, 1.2, 0.9, 0.0, 0.0),
]


def answers(cases):
    """Return one record per case: whole numbers, and floats with None for missing values."""
    table = np.array(cases)
    systems = np.column_stack(
        [table[:, 0], math.tau / table[:, 1], table[:, 1:6], np.zeros(len(table))]
    )  # of slender blocks
    told = batch.classify_batch(systems, table[:, 6:8], MAX_CYCLES, MAX_PERIOD, np.zeros(1, np.int64))
    return [
        {name: int(getattr(told, name)[k]) for name in WHOLE}
        | {name: _real(float(getattr(told, name)[k])) for name in REAL}
        for k in range(len(cases))
    ]


def _real(value):
    """As JSON has it, to twelve digits: None for what there is not, a word for what is infinite."""
    return None if math.isnan(value) else float(f"{value:.12g}") if math.isfinite(value) else str(value)


def differs(one, other, tolerance):
    """The name of an answer in which two records differ; None if there is none."""
    for name in WHOLE:
        if one[name] != other[name]:
            return name
    for name in REAL:
        pair = one[name], other[name]
        both = all(isinstance(value, float) for value in pair)
        if (abs(pair[0] - pair[1]) > tolerance * max(1.0, abs(pair[0]))) if both else pair[0] != pair[1]:
            return name
    return None


def main():
    records = answers(CASES)
    for factor in (1 - BESIDE, 1 + BESIDE):
        beside = answers([(case[0] * factor, *case[1:]) for case in CASES])
        for case, one, other in zip(CASES, records, beside, strict=True):
            if name := differs(one, other, 1e-10):
                sys.exit(f"{case}: {name} hangs on the last digits")
    cases = [["inf" if value == math.inf else value for value in case] for case in CASES]
    rows = [json.dumps({"case": case} | record) for case, record in zip(cases, records, strict=True)]
    body = ",\n".join(rows)
    TABLE.write_text(f'{{"method": {batch.METHOD}, "answers": [\n{body}\n]}}\n')


if __name__ == "__main__":
    main()
