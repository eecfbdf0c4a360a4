"""Write `states_own.json`: final states of many motions by the brute-force oracle, each run twice.

`python tests/data/make_states.py` (minutes). A state is kept as printed only if 40 more digits and three times the samples
give the same 30 digits and the same events.
"""

import json
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from oracles.motion import simulate  # noqa: E402

COUNTS = {
    "impact": "impacts",
    "brace": "brace_hits",
    "rest": "rests",
    "lift-off": "lift_offs",
    "lean": "leans",
    "leave": "leaves",
}
MAX_GROWTH = 1e6


def case(kind, A, T, e, N, phi=0.0, start=(0.0, 0.0), brace=None, r=None):
    """One motion in the form of `states.json`, with what it is there for."""
    numbers = {
        "A": A,
        "T": T,
        "e": e,
        "phi": phi,
        "Theta0": start[0],
        "dTheta0": start[1],
        "brace": brace,
        "r": r,
    }
    return (
        {"kind": kind}
        | {name: None if value is None else float(value) for name, value in numbers.items()}
        | {"N": N}
    )


def chosen():
    """Motions picked by hand, a kind of event or a limit each."""
    yield case("rest and lift-off", 1.05, 1.3, 0.6, 5)
    yield case("rest and lift-off", 1.2, 2.5, 0.3, 6, phi=0.4)
    yield case("rest and lift-off", 1.016, 0.7, 0.8, 4)
    yield case("rest and lift-off", 1.4, 0.25, 0.5, 9, phi=2.0)
    yield case("rest and lift-off, held at first", 2.0, 1.0, 0.5, 7, phi=1.3)
    yield case("end within chatter", 1.06, 0.8, 0.8, 3, phi=0.7)
    yield case("end within chatter", 1.06, 0.8, 0.8, 3, phi=1.1)
    yield case("end within chatter", 1.06, 0.8, 0.8, 3, phi=1.16)
    yield case("A below 1, rest for ever", 0.4, 1.0, 0.5, 12, start=(0.2, -0.3))
    yield case("A = 1, rest for ever", 1.0, 1.5, 0.3, 8, start=(-0.4, 0.1))
    yield case("A = 1, in motion", 1.0, 1.5, 0.5, 8, start=(-0.4, 0.1))
    yield case("A below 1, in motion", 0.7, 2.0, 0.6, 12, start=(0.2, -0.3))
    yield case("A below 1, in motion", 0.9, 1.1, 0.95, 4, start=(0.6, 0.0), phi=1.0)
    yield case("A below 1, in motion", 0.5, 3.0, 0.99, 3, start=(0.0, 0.7), phi=4.0)
    yield case("A below 1, e = 1", 0.4, 0.8, 1.0, 12, start=(0.3, 0.2))
    yield case("free", 0.0, 1.0, 0.9, 6, start=(0.5, 0.0))
    yield case("free", 0.0, 0.5, 0.5, 9, start=(-0.99, 0.0))
    yield case("free, to rest", 0.0, 0.5, 0.5, 24, start=(-0.99, 0.0))
    yield case("free, e = 1", 0.0, 2.0, 1.0, 9, start=(0.3, -0.1))
    yield case("e = 0", 2.0, 1.0, 0.0, 7)
    yield case("e = 0", 6.5, 0.4, 0.0, 9, phi=0.7)
    yield case("e = 0", 3.0, 1.5, 0.0, 6, phi=1.0)
    yield case("e = 0", 1.5, 1.0, 0.0, 8)
    yield case("e = 0, braced", 12.0, 1.8, 0.0, 6, brace=0.6, r=0.5)
    yield case("e = 1", 4.0, 0.4, 1.0, 12)
    yield case("e = 1", 2.0, 0.4, 1.0, 12)
    yield case("e = 1, on the island", 4.0, 0.4, 1.0, 30, start=(0.04, 0.19))
    yield case("brace, r = 0", 8.0, 1.5, 0.9, 6, brace=0.4, r=0.0)
    yield case("brace, r = 0", 20.0, 0.8, 0.7, 8, brace=0.15, r=0.0, phi=1.0)
    yield case("brace, r = 1", 15.0, 2.0, 0.925, 4, brace=1.0, r=1.0)
    yield case("brace, r = 1", 5.0, 0.6, 0.8, 8, brace=0.05, r=1.0)
    yield case("brace beyond 1", 9.0, 2.4, 0.9, 6, brace=1.7, r=0.6)
    yield case("brace beyond 1", 14.0, 1.5, 0.85, 6, brace=2.0, r=0.9, phi=3.0)
    yield case("brace, leaning by chatter", 12.0, 2.5, 0.8, 6, brace=0.3, r=0.4)
    yield case("brace, leaning by chatter", 30.0, 1.2, 0.925, 6, brace=0.1, r=0.6, phi=0.5)
    yield case("brace, leaning by chatter", 6.0, 3.0, 0.5, 6, brace=0.8, r=0.2)
    yield case("brace, end while leaning", 12.0, 2.5, 0.8, 4, brace=0.3, r=0.4, phi=1.6)
    yield case("leaning at the start", 4.0, 1.7, 0.8, 6, phi=2.5, start=(0.5, 0.0), brace=0.5, r=0.5)
    yield case("leaning at the start", 7.0, 1.1, 0.9, 6, phi=-0.4, start=(-0.2, 0.0), brace=0.2, r=0.7)
    yield case("leaning at the start, for ever", 0.3, 1.0, 0.9, 6, start=(1.5, 0.0), brace=1.5, r=0.5)
    yield case("leaning for ever by chatter", 0.2, 1.3, 0.9, 9, start=(1.1, 0.9), brace=1.6, r=0.5)
    yield case("released from the brace", 9.0, 1.1, 0.9, 6, start=(0.3, 0.0), brace=0.3, r=0.7)
    yield case("brace and grazing", 1.08, 3.0, 0.4, 5, start=(0.1, 0.2), brace=0.12, r=0.5)
    yield case("fast shaking", 90.0, 0.0314159, 0.7, 60)
    yield case("fast shaking", 40.0, 0.05, 0.925, 60, phi=1.0)
    yield case("fast shaking, rest", 1.2, 0.035, 0.4, 30)
    yield case("fast shaking, rest", 1.12, 0.035, 0.5, 30)
    yield case(
        "slow shaking, rest and leaning", 1.01, 120.0, 0.5, 1, phi=4.0, start=(0.1, 0.0), brace=0.5, r=0.3
    )
    yield case("slow shaking, to rest", 0.6, 60.0, 0.7, 2, start=(0.1, 0.0))
    yield case("slow shaking", 3.0, 25.0, 0.8, 1, phi=2.0, brace=0.8, r=0.5)
    yield case("second dip", 10.412698412698411, 1.7111111111111108, 0.925, 8)
    yield case("many cycles", 2.0, 1.0, 0.925, 60)
    yield case("many cycles", 6.5, 0.4, 0.925, 90)


def drawn(kind, count, seed, braced, most_growth, restitution):
    """Random motions that do not overturn and whose tangent vectors grow by at most ``most_growth``."""
    rng = np.random.default_rng(seed)
    while count:
        T, e = round(float(np.exp(rng.uniform(np.log(0.1), np.log(4)))), 4), float(rng.choice(restitution))
        A = round(
            float(
                rng.uniform(0.3, 0.45) * (1 + (2 * np.pi / T) ** 2)
                if rng.random() < 0.4
                else rng.uniform(1.2, 12)
            ),
            4,
        )
        brace = round(float(np.exp(rng.uniform(np.log(0.03), np.log(2)))), 4) if braced else None
        reach = min(brace or 1.0, 1.0)
        start = (round(float(rng.uniform(-0.9, 0.9)) * reach, 4), round(float(rng.uniform(-0.5, 0.5)), 4))
        numbers = case(
            kind, A, T, e, int(rng.integers(3, 13)), round(float(rng.uniform(0, 6.28)), 3), start, brace,
            float(rng.choice([0.2, 0.5, 0.8, 0.95, 1.0])) if braced else None,
        )  # fmt: skip
        result = simulate(numbers)
        lost = brace is None and simulate(numbers | {"N": numbers["N"] + 12}).overturned
        if not lost and most_growth / 1e6 <= result.growth <= most_growth:
            count -= 1
            yield numbers


def settle(numbers):
    """The record of a motion, checked at 40 more digits and thrice the samples."""
    result, finer = simulate(numbers), simulate(numbers, digits=120, scan=3)
    if result.counts != finer.counts or result.overturned:
        raise SystemExit(
            f"the scan misses an event, or it overturns: {numbers} {result.counts} {finer.counts}"
        )
    if not max(abs(result.angle - finer.angle), abs(result.velocity - finer.velocity)) < 1e-23 * finer.growth:
        raise SystemExit(f"digits lost: {numbers}")
    counts = {name: result.counts[event] for event, name in COUNTS.items()}
    if counts["rests"]:
        counts["impacts"] = None
    if counts["leans"]:
        counts["brace_hits"] = None
    state = {"Theta": finer.angle.str(20, radius=False), "dTheta": finer.velocity.str(20, radius=False)}
    return numbers | state | counts | {"growth": float(f"{max(1.0, finer.growth):.3g}")}


def main():
    motions = [
        *chosen(),
        *drawn("random", 16, 1, False, MAX_GROWTH, (0.3, 0.5, 0.8, 0.925, 0.95, 1.0)),
        *drawn("random, braced", 16, 2, True, MAX_GROWTH, (0.3, 0.5, 0.8, 0.925, 1.0)),
        *drawn("random, sensitive", 4, 3, True, 1e10, (0.8, 0.925, 1.0)),
    ]
    with ProcessPoolExecutor() as pool:
        records = list(pool.map(settle, motions))
    text = "[\n" + ",\n".join(json.dumps(record) for record in records) + "\n]\n"
    partial = HERE / "states_own.json.partial"
    partial.write_text(text)
    partial.replace(HERE / "states_own.json")
    print(len(records), "states; largest growth", max(record["growth"] for record in records))


if __name__ == "__main__":
    main()
