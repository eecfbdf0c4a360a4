"""Benchmarks time the computation that users run."""

import numpy as np
import pytest

import rocking as rk
from benchmarks import lanes, marching, verdicts
from benchmarks.recorded_calls import record_calls
from rocking.kernels.classify import verdict
from rocking.kernels.classify.cascade import make_workspace
from rocking.kernels.lanes.state import make_lane_workspace


@pytest.mark.long
@pytest.mark.parametrize("restitution", [0.925, 1.0])
def test_map_of_the_bench_is_the_map(monkeypatch, restitution):
    monkeypatch.setattr(verdicts, "POINTS", 16)
    kinds, grounds, work, _ = verdicts.judged(restitution, 1_000)
    found = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=restitution),
        amplitude=np.linspace(*verdicts.AMPLITUDES, 16),
        period=np.linspace(*verdicts.PERIODS, 16),
        max_cycles=1_000,
    ).dataset.transpose("period", "amplitude")
    assert len(set(kinds)) >= 3
    assert np.mean(kinds == found.kind.values.ravel()) > 0.98
    assert np.mean(grounds == found.evidence.values.ravel()) > 0.98
    assert (work[kinds == verdict.PERIODIC] > 0).all()


@pytest.mark.long
def test_marching_in_lanes_of_the_bench_counts_as_many_impacts_as_one_block_after_another():
    systems = lanes.systems_of(12)
    systems = systems[(systems[:, 0] > 1.0) & (systems[:, 0] < 6.0)]
    speeds = np.full(len(systems), 0.2)
    expected = marching.alone(systems, speeds, 50, make_workspace(50, 1))
    assert expected > 1000
    assert marching.in_lanes(systems, speeds, 50, make_lane_workspace(50, 1)) == expected


def test_calls_of_every_entry_point_are_recorded():
    assert [name for name, calls in record_calls().items() if not calls] == []
