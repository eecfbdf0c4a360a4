"""Verdicts over the values of one parameter: what `classify` judges by, computed as a survey that a store resumes."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.kernels import batch
from rocking.kernels.classify import verdict
from rocking.model.system import State, System
from rocking.model.verdict import Kind, Verdict
from rocking.motion.march_loop import start_march
from rocking.orbits.parameter import identity_of, with_value
from rocking.response.classify import budget, verdict_of
from rocking.survey.engine import Engine
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.run_survey import run_survey
from rocking.survey.spec import SurveySpec, Values
from rocking.survey.verdict_measures import meanings

TITLE = "Judgements on the responses of a free-standing block on a shaking base"
NORMALISED = "Attributes and coordinates are normalised as in Yim & Lin (1991), Eqs. (1)-(4)."


@frozen(eq=False)
class SystemSpec(SurveySpec):
    """Survey of one system over the values of a parameter, each motion from the same initial state."""

    comment = NORMALISED
    in_a_tile = 64

    system: System = field(kw_only=True)
    start: State = field(kw_only=True)

    def inputs(self, values: Values) -> tuple[list[System], State]:
        """Return the systems at n points, and their initial state."""
        ((name, each),) = values.items()
        return [with_value(self.system, name, value) for value in each.tolist()], self.start

    def described(self) -> dict[str, Any]:
        """Return the quantities that do not vary, by name."""
        start = {"angle": self.start.angle, "velocity": self.start.velocity}
        return identity_of(self.system, *self.axes) | start


def variable(name: str, dtype: np.dtype[Any]) -> Variable:
    """Return a variable of a survey that only this package reads."""
    fill = 255 if dtype == np.uint8 else -2 if dtype.kind == "i" else math.inf
    own = meanings(Kind) if name == "kind" else {}
    return Variable(name, dtype.name, fill, {"long_name": name.replace("_", " "), **own})


# The period of the response is no coordinate of the survey, as that of the forcing may be.
_NAMES = tuple({"period": "response_period"}.get(name, name) for name in verdict.ResultArrays._fields)
_BY_NAME = dict(zip(_NAMES, verdict.DTYPES, strict=True))
# The type of response is written last.
VARIABLES = tuple(variable(name, np.dtype(_BY_NAME[name])) for name in (*list(_BY_NAME)[1:], "kind"))


def judgements_at(
    inputs: tuple[list[System], State], options: Mapping[str, int], stop: np.ndarray
) -> Arrays | None:
    """Return the judgements on the motions of systems from one initial state; None if another thread sets `stop`."""
    systems, start = inputs
    rows = []
    for system in systems:
        if stop[0]:
            return None
        p, _ = start_march(system, start)
        rows.append(
            batch.classify_one(p, start.angle, start.velocity, options["max_cycles"], options["max_period"])
        )
    columns = zip(*rows, strict=True)
    return {
        name: np.array(column, dtype) for (name, dtype), column in zip(_BY_NAME.items(), columns, strict=True)
    }


def verdicts_over(
    system: System,
    start: State,
    parameter: str,
    values: np.ndarray,
    max_cycles: int,
    max_period: int,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    *,
    progress: bool = False,
    repair: bool = False,
) -> list[Verdict]:
    """Return the verdict of `classify` at each value of a parameter; the judgements are kept in the store."""
    limits = budget(max_cycles, max_period)
    spec = SystemSpec({parameter: values}, system=system, start=start)
    measure = Measurement(TITLE, judgements_at, VARIABLES, limits, batch.METHOD, batch=8)
    data = run_survey(spec, measure, store, executor, progress=progress, repair=repair).load()
    arrays = verdict.ResultArrays(*(data[name].values for name in _NAMES))
    systems, _ = spec.inputs({parameter: values})
    return [
        verdict_of(each, start, verdict.judgement_of(arrays, place), max_cycles, max_period)
        for place, each in enumerate(systems)
    ]
