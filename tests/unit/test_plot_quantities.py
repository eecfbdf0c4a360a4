"""Axis labels: one quantity has the same label in all figures."""

import numpy as np
import pytest

import rocking as rk

PERIODS = np.linspace(0.5, 2.0, 4)
BLOCK = rk.Block(height=2.0, width=0.5)


def labels(ax):
    return {ax.get_xlabel(), ax.get_ylabel()}


def pictures(block):
    """Axes over the period, over the amplitude or over both."""
    system = rk.System(rk.Harmonic(amplitude=5.0, period=1.0), restitution=0.8)
    found = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.8),
        amplitude=[4.0, 5.0],
        period=[1.0, 1.1],
        max_cycles=200,
    ).dataset
    return {
        "thresholds": rk.plot.thresholds(PERIODS, {"any": PERIODS}, block=block),
        "map": rk.plot.parametric_map(found, block=block),
        "modes": rk.plot.modes(1.0, 0.8, block=block),
        "branch": rk.plot.branch(
            rk.continue_orbit(rk.classify(system).orbit, "amplitude", (4.9, 5.1)), block=block
        ),
        "diagram": rk.plot.orbit_diagram(
            rk.orbit_diagram(system, amplitude=[4.9, 5.0], transient=50, cycles=2), block=block
        ),
        "response": rk.plot.frequency_response(rk.frequency_response(system, period=[0.9, 1.0]), block=block),
    }


@pytest.mark.parametrize("block", [None, BLOCK], ids=["normalised", "si"])
def test_period_and_amplitude_have_one_label_each(block):
    found = pictures(block)
    used = {name: labels(ax) for name, ax in found.items()}
    for word, users in (
        ("period", ("thresholds", "map", "response")),
        ("amplitude", ("thresholds", "map", "modes", "branch", "diagram")),
    ):
        seen = {name: {label for label in used[name] if label.startswith(word)} for name in users}
        assert all(seen.values()), seen
        assert len(set.union(*seen.values())) == 1, seen
