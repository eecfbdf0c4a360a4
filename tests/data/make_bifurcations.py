"""Write `bifurcations.json`: symmetry breakings, period doublings and folds of orbits, half of them between braces.

`python tests/data/make_bifurcations.py` (seconds). Systems are drawn at random. Each periodic response is continued in
the amplitude, and the bifurcations on the way are kept until there are enough of each type. Newton's method alone decides
here what a bifurcation is. The verdicts that are tested on the table only find the first orbit.
"""

import json
import math
from collections import Counter
from pathlib import Path

import numpy as np

import rocking as rk

SEED = 5
MAX_SYSTEMS = 5_000
OF_EACH = 10  # of a kind, with braces and without
TO_START_WITH = 3_000  # cycles
RANGE = (0.5, 20.0)
KINDS = ("symmetry-breaking", "period-doubling", "fold")


def drawn(random, braced):
    """Return a random system."""
    amplitude, period, restitution, phase = random.uniform((0.5, 0.5, 0.5, 0.0), (10.0, 2.5, 0.95, math.tau))
    braces = rk.Braces(random.uniform(0.4, 1.2), random.choice([0.5, 0.7, 0.9])) if braced else None
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution, braces)


def bifurcations_of(system):
    """Yield every special point on the branch of the periodic response of a system, if it has one."""
    response = rk.classify(system, max_cycles=TO_START_WITH)
    if response.kind == "periodic" and not response.orbit.superstable:
        branch = rk.continue_orbit(response.orbit, "amplitude", RANGE, max_points=1_000)
        yield from (point for point in branch.special if point.kind in KINDS)


def row(point):
    """Return the numbers of a special point, as the table has them: at the phase at which its orbit starts."""
    orbit = point.orbit
    system, start = orbit.system, orbit.start
    forcing, braces = system.forcing, system.braces
    return {
        "kind": point.kind,
        "A": forcing.amplitude,
        "T": forcing.period,
        "e": system.restitution,
        "brace": braces and braces.angle,
        "r": braces and braces.restitution,
        "phi": math.remainder(forcing.phase, math.tau),
        "period": orbit.period,
        "Theta0": start.angle,
        "dTheta0": start.velocity,
    }


def main():
    random, taken, rows = np.random.default_rng(SEED), Counter(), []
    for number in range(MAX_SYSTEMS):
        if len(rows) == 2 * len(KINDS) * OF_EACH:
            break
        braced = number % 2 == 1
        try:
            points = list(bifurcations_of(drawn(random, braced)))
        except rk.NoOrbit:
            continue
        for point in points:
            given = row(point)
            mirrored = any(abs(given["A"] - other["A"]) < 1e-9 for other in rows)
            if not mirrored and taken[point.kind, braced] < OF_EACH:
                taken[point.kind, braced] += 1
                rows.append(given)
    Path(__file__).with_name("bifurcations.json").write_text(
        "[\n" + ",\n".join(json.dumps(each) for each in rows) + "\n]\n"
    )
    print(f"{len(rows)} points: {dict(taken)}")


if __name__ == "__main__":
    main()
