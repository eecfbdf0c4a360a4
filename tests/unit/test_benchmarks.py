"""Benchmarks time the computation that users run."""

import numpy as np
import pytest

import rocking as rk
from benchmarks import verdicts
from benchmarks.recorded_calls import record_calls
from rocking.kernels.classify import verdict_record


@pytest.mark.long
@pytest.mark.parametrize("restitution", [0.925, 1.0])
def test_map_of_the_bench_is_the_map(monkeypatch, restitution):
    monkeypatch.setattr(verdicts, "POINTS", 16)
    kinds, grounds, work, _ = verdicts.judged(restitution, 1_000)
    found = rk.parametric_map(
        amplitude=np.linspace(*verdicts.AMPLITUDES, 16),
        period=np.linspace(*verdicts.PERIODS, 16),
        restitution=restitution,
        max_cycles=1_000,
    ).transpose("period", "amplitude")
    assert len(set(kinds)) >= 3
    assert np.mean(kinds == found.kind.values.ravel()) > 0.98
    assert np.mean(grounds == found.evidence.values.ravel()) > 0.98
    assert (work[kinds == verdict_record.PERIODIC] > 0).all()


def test_calls_of_every_entry_point_are_recorded():
    assert [name for name, calls in record_calls().items() if not calls] == []
