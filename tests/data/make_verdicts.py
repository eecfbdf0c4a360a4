"""Write `verdicts.json`: the types of many responses, each from an independent method (`oracles.recurrence`).

`python tests/data/make_verdicts.py` (many minutes). Families of systems are drawn at random; of each family at most a
few responses of each type, period and symmetry are kept, so that common ones do not displace rare ones. Cases that the
method cannot establish are rejected and counted.
"""

import json
import os
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from data.verdict_cases import chosen, found, near_bifurcations  # noqa: E402
from data.verdict_families import drawn  # noqa: E402
from oracles.long_runs import Unsettled, run, start_of, system_of  # noqa: E402
from oracles.recurrence import GLANCE, established, judge  # noqa: E402

PROCESSES = min(2, os.cpu_count() or 1)


def on_its_orbit(numbers):
    """Return the system with an initial state on its orbit, because basins of long periods are small."""
    _, reached, _, _ = run(system_of(numbers), start_of(numbers), 100_000)
    state = {"Theta0": round(reached.angle, 6), "dTheta0": round(reached.velocity, 6)}
    return numbers | {"family": "on its orbit"} | state


def long_periods(candidates, looks):
    """Starts on the longest periods met, two a period."""
    taken = Counter()
    for (numbers, _), (label, _) in zip(candidates, looks, strict=True):
        period = label["period"] if label else None
        if period is not None and period >= 9 and not label["chatter"]:
            taken[period] += 1
            if taken[period] <= 2:
                yield on_its_orbit(numbers)


def tried(numbers, settle):
    """Return the label or None, and the reason if it is None."""
    try:
        return settle(numbers), None
    except Unsettled as error:
        return None, str(error)


def first_look(numbers):
    """A label from doubles alone: what is kept of a family."""
    return tried(numbers, lambda given: judge(given, confirm=False, chaos_cycles=GLANCE))


def in_full(numbers):
    return tried(numbers, established)


def select(candidates, looks):
    """The first few of each kind, period and symmetry of a family; counts of what no look could settle."""
    taken, kept, thrown = Counter(), [], Counter()
    for (numbers, most), (label, reason) in zip(candidates, looks, strict=True):
        if label is None:
            thrown[(numbers["family"], "at first look: " + reason)] += 1
            continue
        what = (numbers["family"], label["kind"], label["period"], label["symmetric"], label["chatter"])
        taken[what] += 1
        if taken[what] <= most:
            kept.append(numbers)
    return kept, thrown


def settle_all(pool, cases):
    """Return the records and the numbers of rejected cases."""
    records, thrown = [], Counter()
    for numbers, (record, reason) in zip(cases, pool.map(in_full, cases), strict=True):
        if record is None:
            thrown[(numbers["family"], reason)] += 1
            print("thrown:", reason, numbers, flush=True)
        else:
            records.append(record)
    return records, thrown


def write(path, records):
    text = "[\n" + ",\n".join(json.dumps(record) for record in records) + "\n]\n"
    partial = path.with_suffix(".partial")
    partial.write_text(text)
    partial.replace(path)


def main():
    with ProcessPoolExecutor(PROCESSES) as pool:
        candidates = list(drawn(1991))
        looks = list(pool.map(first_look, [numbers for numbers, _ in candidates], chunksize=4))
        kept, unclear = select(candidates, looks)
        records, thrown = settle_all(
            pool, [*chosen(), *near_bifurcations(), *found(), *kept, *long_periods(candidates, looks)]
        )
    write(HERE / "verdicts.json", records)
    print(len(candidates), "drawn,", len(records), "kept;", dict(Counter(r["kind"] for r in records)))
    for (family, reason), count in sorted((unclear + thrown).items()):
        print(f"{count} {family}: {reason}")


if __name__ == "__main__":
    main()
