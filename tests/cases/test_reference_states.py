"""Final states and event counts against a many-digit brute-force simulation (`data/states.json`, `data/states_own.json`)."""

import json
from pathlib import Path

import numpy as np
import pytest

import rocking as rk

DATA = Path(__file__).resolve().parents[1] / "data"
KINDS = {
    "impacts": "impact",
    "brace_hits": "brace",
    "rests": "rest",
    "lift_offs": "lift-off",
    "leans": "lean",
    "leaves": "leave",
}


TABLES = {name: json.loads((DATA / name).read_text()) for name in ("states.json", "states_own.json")}
CASES = [
    pytest.param(case, id=f"{name}-{number}-{case.get('kind', '')}")
    for name, table in TABLES.items()
    for number, case in enumerate(table)
]


def simulate(case, record):
    """Run a case of the tables."""
    braces = None if case["brace"] is None else rk.Braces(angle=case["brace"], restitution=case["r"])
    system = rk.System(
        rk.Harmonic(amplitude=case["A"], period=case["T"], phase=case["phi"]), case["e"], braces
    )
    return rk.simulate(system, rk.State(case["Theta0"], case["dTheta0"]), cycles=case["N"], record=record)


@pytest.mark.parametrize("record", ["none", "section", "all"])
@pytest.mark.parametrize("case", CASES)
def test_final_state_to_1e12_times_the_growth_of_errors(case, record):
    final = simulate(case, record).final
    error = np.abs([final.angle - float(case["Theta"]), final.velocity - float(case["dTheta"])])
    allowed = 1e-12 * max(1.0, case["growth"])
    assert error.max() <= allowed, f"off by {error} where {allowed:.2g} is allowed"


@pytest.mark.parametrize("case", CASES)
def test_events_are_as_many_as_in_the_brute_force_run(case):
    """Counts that are infinite (chatter) are left out; what happens at the very start is no event of the motion."""
    motion = simulate(case, "all")
    kinds = motion.events["kind"][motion.events["time"] > 0]
    found = {name: int(np.sum(kinds == kind)) for name, kind in KINDS.items() if case.get(name) is not None}
    assert found == {name: case[name] for name in found}


@pytest.mark.parametrize("case", CASES)
def test_counters_agree_between_records(case):
    """`impacts` and `brace_hits` do not depend on what is kept, but for chatter, which is cut short where nothing is kept."""
    kept, bare = simulate(case, "all"), simulate(case, "none")
    if case["impacts"] is not None:
        assert kept.impacts == bare.impacts == case["impacts"]
    if case["brace_hits"] is not None:
        assert kept.brace_hits == bare.brace_hits == case["brace_hits"]


def test_the_tables_cover_every_kind_of_event_and_limit():
    cases = [case for table in TABLES.values() for case in table]
    assert len(cases) >= 73
    for name in KINDS:
        assert sum(bool(case.get(name)) for case in cases) >= 10, name
    for limit in ({"e": 0.0}, {"e": 1.0}, {"r": 0.0}, {"r": 1.0}):
        assert sum(limit.items() <= case.items() for case in cases) >= 2, limit
    assert sum(case["A"] <= 1 for case in cases) >= 8
    assert sum(case["brace"] is not None for case in cases) >= 30
