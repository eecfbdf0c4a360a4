"""Registry of orbits: each state finds the orbit that is nearest to it."""

import numpy as np

import rocking as rk
from rocking.orbits.find_orbits import SAME, OrbitRegistry


def test_states_belong_to_the_nearest_known_orbit_within_the_tolerance():
    random = np.random.default_rng(4)
    registry = OrbitRegistry(rk.System(rk.Harmonic(2.0, period=1.0), 0.9), 0.0)
    # many rows share an angle, as those of orbits that are at the base at the phase of the section
    rows = np.column_stack([random.choice([0.0, 0.1, -0.3], 150), random.uniform(-1.0, 1.0, 150)])
    # each row has another one closer than the tolerance
    registry.rows = np.concatenate([rows, rows + 0.5 * SAME * random.uniform(-1.0, 1.0, (150, 2))])
    registry.owner = random.integers(0, 40, 300)
    away = SAME * random.uniform(-1.5, 1.5, (2000, 2))
    states = registry.rows[random.integers(0, 300, 2000)] + away
    distances = np.linalg.norm(states[:, None] - registry.rows, axis=2)
    nearest = distances.argmin(axis=1)
    expected = np.where(distances.min(axis=1) <= SAME, registry.owner[nearest], -1)
    assert 200 < np.count_nonzero(expected < 0) < 1800
    assert np.array_equal(registry._owners(states), expected)


def test_no_state_belongs_to_an_orbit_before_one_is_known():
    registry = OrbitRegistry(rk.System(rk.Harmonic(2.0, period=1.0), 0.9), 0.0)
    assert registry._owners(np.zeros((3, 2))).tolist() == [-1, -1, -1]
    assert registry._owners(np.zeros((0, 2))).tolist() == []
