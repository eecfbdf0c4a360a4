"""Run of a survey from its specification to its dataset, in memory or in a store."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rocking.model.package import require_extra
from rocking.model.progress import Bar
from rocking.model.text import shown_path
from rocking.model.validation import Refusal, instance
from rocking.survey.engine.cost import cost
from rocking.survey.engine.progress import Watcher
from rocking.survey.engine.tile_loop import cores, run
from rocking.survey.measurement import Measurement
from rocking.survey.spec import SurveySpec
from rocking.survey.store.memory import Memory, check_fits

if TYPE_CHECKING:
    import xarray as xr

    from rocking.survey.store.store import Store


def run_survey(
    asked: SurveySpec,
    measure: Measurement,
    store: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    *,
    progress: bool = False,
    repair: bool = False,
) -> xr.Dataset:
    """Run a survey, or resume it in a store; return its dataset."""
    if executor is not None:
        instance("executor", executor, Executor)
    instance("progress", progress, bool)
    instance("repair", repair, bool)
    if store is None and repair:
        raise Refusal("repair", "be used with {store}, whose damaged tiles it recomputes")
    if store is None:
        check_fits(asked, measure)
        results = Memory(asked, measure)
        _carry_out(
            results, executor, progress, "no results are kept (with store, running it again would resume it)"
        )
        return results.dataset()
    require_extra("store")
    from rocking.survey.store.store import opened

    with opened(store, asked, measure, repair=repair) as kept:
        _carry_out(
            kept, executor, progress, f"completed tiles are in {shown_path(store)}; run it again to resume"
        )
    with _noted(f"The survey is complete in {shown_path(store)}; run it again to read the results."):
        return kept.dataset()


def _carry_out(results: Memory | Store, executor: Executor | None, progress: bool, interrupted: str) -> None:
    with _noted(f"The survey was interrupted; {interrupted}."):
        if not progress:
            run(results, executor)
            return
        planned = cost(results.asked, results.measure, results.levels, results.done)
        title = planned.describe(cores() if executor is None else None)
        with Bar(planned.points, title=title, unit="points") as bar:
            run(results, executor, Watcher(bar, results.measure))


@contextmanager
def _noted(note: str) -> Iterator[None]:
    """Add a note to KeyboardInterrupt that states the consequence for the survey."""
    try:
        yield
    except KeyboardInterrupt as error:
        error.add_note(note)
        raise
