"""Verdicts against labels from independent methods: long brute-force recurrence, many digits, averages, exponents.

`data/make_verdicts.py` writes `data/verdicts.json`. `data/labels.json` was labelled elsewhere by the same methods. A
verdict may be undetermined, rarely; it is never wrong.
"""

import json
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

import rocking as rk

DATA = Path(__file__).resolve().parents[1] / "data"
TABLES = {name: json.loads((DATA / f"{name}.json").read_text()) for name in ("verdicts", "labels")}
CASES = [
    pytest.param(name, number, id=f"{name}-{number}-{case['kind']}-{case.get('family', '')}")
    for name, table in TABLES.items()
    for number, case in enumerate(table)
]
FACTORS = (1.0, 1.0 - 1e-10, 1.0 + 1e-10)
LEVELS = {
    "rest": ["exact"],
    "overturned": ["exact"],
    "periodic": ["verified", "exact"],
    "quasi-periodic": ["statistical"],
    "chaotic": ["statistical"],
    "undetermined": ["none"],
}


@cache
def verdict(name, number, factor):
    """The verdict on a case of a table, its amplitude times a factor, within the cycles that the case allows."""
    case = TABLES[name][number]
    braces = None if case["brace"] is None else rk.Braces(angle=case["brace"], restitution=case["r"])
    forcing = rk.Harmonic(amplitude=case["A"] * factor, period=case["T"], phase=case["phi"])
    start = rk.State(case["Theta0"], case["dTheta0"])
    budget = case.get("max_cycles", 100_000)
    return rk.classify(rk.System(forcing, case["e"], braces), start, max_cycles=budget)


def differing(found, case):
    """Return the differences of a verdict from the table, as {name: (said, true)}; infinitely many hits are None."""
    if found.kind != case["kind"]:
        return {"kind": (str(found.kind), case["kind"])}
    names = {"period", "impacts_per_period", "brace_hits_per_period", "symmetric"} & case.keys()
    pairs = {name: (getattr(found, name), case[name]) for name in sorted(names)}
    return {name: (said, true) for name, (said, true) in pairs.items() if said != true}


@pytest.mark.parametrize("name, number", CASES)
def test_verdict_is_right_here_and_at_amplitudes_a_hair_beside_and_its_evidence_of_the_level_of_its_kind(
    name, number
):
    case = TABLES[name][number]
    for factor in FACTORS:
        found = verdict(name, number, factor)
        if found.kind != "undetermined":
            assert differing(found, case) == {}, f"at A x {factor!r}: {found}"
        assert found.evidence.level in LEVELS[found.kind]
        assert found.cycles <= case.get("max_cycles", 100_000)


def test_less_than_one_in_a_hundred_is_undetermined():
    undetermined = [case.id for case in CASES if verdict(*case.values, 1.0).kind == "undetermined"]
    assert len(undetermined) < 0.01 * len(CASES), undetermined


def test_the_table_covers_every_kind_and_what_is_hard_about_it():
    table = TABLES["verdicts"]
    kinds = Counter(case["kind"] for case in table)
    periodic = [case for case in table if case["kind"] == "periodic"]
    assert len(table) >= 220
    assert kinds["periodic"] >= 120
    assert kinds["overturned"] >= 25
    assert min(kinds["rest"], kinds["quasi-periodic"]) >= 15
    assert kinds["chaotic"] >= 20
    assert sum(case["period"] > 2 for case in periodic) >= 25
    assert sum(case["brace"] is not None for case in periodic) >= 15
    assert sum(case["chatter"] and case["brace"] is None for case in periodic) >= 20
    assert sum(case["kind"] == "overturned" and case["A"] < 1 for case in table) >= 5
    assert sum(case["kind"] == "chaotic" and case["brace"] is None and case["e"] < 1 for case in table) >= 8
    assert {1, 2, 4} <= {case["period"] for case in periodic if not case["symmetric"]}
    assert max(case["period"] for case in periodic) >= 27
    assert all(case["robust"] for case in table)
