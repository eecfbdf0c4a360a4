"""METHOD identifies the results: if they change, the number changes."""

import json
import math

from data.make_method import TABLE, answers, differs
from rocking.kernels import batch

KEPT = json.loads(TABLE.read_text())
RAISE = "raise METHOD in kernels/batch.py, then write the table again: python tests/data/make_method.py"


def test_answers_are_those_of_the_method_that_the_table_names():
    """Counts exactly, numbers to 1e-9."""
    cases = [[float(value) for value in record["case"]] for record in KEPT["answers"]]
    changed = [
        f"{record['case']}: {name} was {record[name]}, is {now[name]}"
        for record, now in zip(KEPT["answers"], answers(cases), strict=True)
        if (name := differs(record, now, 1e-9))
    ]
    assert KEPT["method"] == batch.METHOD, "METHOD has been raised: write the table again"
    assert not changed, f"answers have changed ({RAISE}): " + "; ".join(changed)


def test_the_table_has_every_kind_of_answer_that_is_not_a_matter_of_chance():
    kinds = {record["kind"] for record in KEPT["answers"]}
    assert kinds == {0, 1, 2, 4}
    assert {record["ground"] for record in KEPT["answers"]} == {0, 1, 2, 3, 5}
    assert any(record["case"][4] != "inf" for record in KEPT["answers"])
    assert all(math.isfinite(record["peak"]) for record in KEPT["answers"])
