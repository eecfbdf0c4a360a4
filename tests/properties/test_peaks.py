"""The largest angle of a run is the maximum over its arcs, by a plain search over all of them."""

import numpy as np
import pytest

import rocking as rk

SYSTEMS = 250
CYCLES = 12


def system_at(random):
    """Amplitudes and periods of the maps, all restitutions, half of the starts moving, half at a crest of the forcing."""
    phase = random.choice([0.0, random.uniform(0, 6.28)])
    forcing = rk.Harmonic(random.uniform(0.2, 16.0), period=random.uniform(0.15, 4.0), phase=phase)
    start = (
        rk.State(random.uniform(-0.9, 0.9), random.uniform(-1.0, 1.0))
        if random.random() < 0.5
        else rk.State()
    )
    return rk.System(forcing, random.choice([1.0, 0.95, random.uniform(0.0, 1.0)])), start


@pytest.mark.parametrize("seed", range(4))
def test_the_peak_is_the_largest_angle_of_the_motion(seed):
    random = np.random.default_rng(seed)
    for _ in range(SYSTEMS):
        system, start = system_at(random)
        motion = rk.simulate(system, start, cycles=CYCLES)
        period = system.forcing.period
        duration = CYCLES * period if motion.overturning is None else motion.overturning.time
        times = np.linspace(0.0, duration, 6_000)
        angles, _ = motion.at(times)
        largest = np.abs(angles).max()
        # between samples |Θ| rises by no more than half a step at the speed left, bent by at most |Θ''|
        step = times[1]
        bend = largest + 1.0 + system.forcing.amplitude
        assert largest <= motion.peak * (1 + 1e-12) + 1e-15
        assert motion.peak <= largest + bend * step**2
