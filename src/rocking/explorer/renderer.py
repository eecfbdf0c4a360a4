"""Figures of one session: computed at once for each selection, then refined."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from attrs import field, frozen
from bokeh.document import Document

from rocking.explorer import bokeh_figures, figure_data, plane_axes, texts
from rocking.explorer.document_renderer import BREATH, DocumentRenderer
from rocking.explorer.page_channel import Link
from rocking.explorer.progressive_map import FIRST, Picture, Plane, Refinement
from rocking.explorer.view_state import POINTS, Span, ViewState
from rocking.explorer.worker_pools import Workers
from rocking.model.quantity import AMPLITUDE, ANGLE, PERIOD
from rocking.model.verdict import Kind, Verdict

BASIN_POINTS = 257
FIRST_HITS = 3e3
"""Maximum number of impacts per point of a first, coarse map."""
GROWTH = (1_000, 2_000, 7_000, 20_000, 30_000, 40_000)
"""Cycles added to a section, step by step: 10⁵ in total."""
MAP_FIRST = 1.0
"""Maximum delay of a basin map and of a longer section in favour of the map of responses, s."""
MAP_LIMITS = Span(*PERIOD.range), Span(0.0, AMPLITUDE.range[1])
BASIN_LIMITS = Span(-ANGLE.range[1], ANGLE.range[1]), Span(-ANGLE.range[1], ANGLE.range[1])
VARIED = {"amplitude": "amplitude A", "period": "period T"}


def _first(shown: ViewState) -> int:
    """Return the cycles per point of a first map; the estimate assumes that all points cost as much as the selected one."""
    return figure_data.affordable(shown, FIRST, FIRST_HITS)


def _silent() -> None:
    """Send nothing."""


@frozen(eq=False)
class Part:
    """New contents of figures, by name, and the function that sends the texts that belong to them."""

    figures: dict[str, dict[str, Any]]
    tell: Callable[[], None] = field(default=_silent)


class SessionRenderer(DocumentRenderer):
    """Figures of a document and the jobs that fill them. Results of an earlier selection are discarded."""

    def __init__(self, document: Document, link: Link, workers: Workers) -> None:
        super().__init__(document, link, workers)
        self.map, self.basin, self.diagram = (
            bokeh_figures.plane_of_systems(),
            bokeh_figures.plane_of_starts(),
            bokeh_figures.diagram(),
        )
        self.corner = self.basin_corner = plane_axes.Corner(0.0, 0.0)

    def attach(self) -> None:
        """Add the figures to the document. Event handlers must be attached before, or the document ignores the events."""
        others = (
            bokeh_figures.history(),
            bokeh_figures.portrait(),
            bokeh_figures.section(),
            bokeh_figures.spectrum(),
        )
        with self.document.models.freeze():  # otherwise the document visits all models once per root
            for root in (self.map, self.basin, self.diagram, *others, self.link):
                self.document.add_root(root)

    # axes and marks

    def place_map(self, shown: ViewState) -> None:
        """Set the ranges and labels of the map."""
        self.corner = plane_axes.corner_of(shown.periods, shown.amplitudes)
        plane_axes.place(self.map, self.corner, shown.periods, shown.amplitudes, MAP_LIMITS)
        plane_axes.label(self.map, self.corner, ("period T", "amplitude A"))
        plane_axes.metres(self.map, self.corner, shown, shown.block)

    def place_basin(self, shown: ViewState) -> None:
        """Set the ranges and labels of the basin map."""
        self.basin_corner = plane_axes.corner_of(shown.angles, shown.velocities)
        plane_axes.place(self.basin, self.basin_corner, shown.angles, shown.velocities, BASIN_LIMITS)
        plane_axes.label(self.basin, self.basin_corner, bokeh_figures.BASIN_LABELS)

    def mark(self, shown: ViewState) -> None:
        """Mark the selected point and draw the selected theoretical curves."""
        system = plane_axes.point(self.corner, shown.period, shown.amplitude)
        self.link.draw(
            map={"point": system, "curves": plane_axes.curves(shown, self.corner)},
            basin={"point": plane_axes.point(self.basin_corner, shown.angle, shown.velocity)},
            diagram={"here": getattr(shown, shown.vary)},
        )

    # the map

    async def refine_map(self, shown: ViewState, stop: np.ndarray) -> None:
        """Compute and draw the map, from coarse to fine."""
        plane = Plane(
            ("period", shown.periods),
            ("amplitude", shown.amplitudes),
            shown.fixed,
            POINTS,
            first=await self.workers.soon(partial(_first, shown)),
        )
        refinement = Refinement(plane, self.workers, stop)
        picture = await self.workers.soon(refinement.coarse)
        await self._draw(partial(self._draw_map, shown, picture))
        async for finer in refinement.finer():
            await self._draw(partial(self._draw_map, shown, finer))

    def _draw_map(self, shown: ViewState, picture: Picture) -> None:
        image = plane_axes.image(picture, self.corner, shown.periods, shown.amplitudes)
        self.link.draw(map=_with_answers({"image": image}, picture))
        self.link.send("legend", {"legend": texts.legend(picture.counts().sum(axis=0))})
        self.link.send("progress", texts.progress(picture))

    # one system

    async def respond(self, shown: ViewState, stop: np.ndarray) -> None:
        """Draw all figures of one system at once, then start their refinement."""
        section = figure_data.Section(shown)
        async with asyncio.TaskGroup() as group:  # if one of them fails, the others end
            verdict = group.create_task(self.workers.soon(partial(figure_data.verdict, shown)))
            basin = group.create_task(self.workers.soon(partial(self._first_basin, shown, stop)))
            parts = [
                self._traces(shown),
                self._spectrum(shown),
                self._section(section, verdict),
                self._basin_part(shown, basin),
                self._verdict(shown, verdict),
            ]
            tasks = [group.create_task(part) for part in parts]
        await self._draw(partial(self._draw_parts, [task.result() for task in tasks]))
        self.jobs.start("section", partial(self._grow, section, verdict.result().period))
        self.jobs.start("basin", partial(self._finish_basin, shown, basin.result()[0]))
        if verdict.result().kind is Kind.UNDETERMINED and not figure_data.crowded(shown):
            self.jobs.start("judge", partial(self._judge_longer, shown))

    def _draw_parts(self, parts: Sequence[Part]) -> None:
        self.link.draw(**{name: drawn for part in parts for name, drawn in part.figures.items()})
        for part in parts:
            part.tell()

    async def _traces(self, shown: ViewState) -> Part:
        found = await self.workers.soon(partial(figure_data.traces, shown))
        history = {"ranges": found.spans["history"], "line": found.history}
        portrait = {"ranges": found.spans["portrait"], "line": found.portrait, "hits": found.hits}
        return Part({"history": history, "portrait": portrait})

    async def _spectrum(self, shown: ViewState) -> Part:
        found = await self.workers.soon(partial(figure_data.spectrum, shown))
        return Part(
            {"spectrum": {"ranges": found.ranges, "line": found.line, "names": found.names, "why": found.why}}
        )

    async def _section(self, section: figure_data.Section, verdict: Awaitable[Verdict]) -> Part:
        """Return the first points; those of a periodic orbit are marked."""
        await self.workers.soon(partial(section.grow, GROWTH[0]))
        period = (await verdict).period
        return Part({"section": _drawn_section(await self.workers.soon(partial(section.drawn, period)))})

    async def _basin_part(self, shown: ViewState, basin: Awaitable[tuple[Refinement, Picture]]) -> Part:
        _, picture = await basin
        return Part({"basin": self._basin(shown, picture)}, partial(self._tell_attractors, picture))

    async def _verdict(self, shown: ViewState, verdict: Awaitable[Verdict]) -> Part:
        return Part({}, partial(self._tell_verdict, shown, await verdict))

    def _tell_verdict(self, shown: ViewState, verdict: Verdict) -> None:
        self.link.send("verdict", texts.verdict(verdict, shown.block))

    def _draw_section(self, drawn: figure_data.Drawn) -> None:
        self.link.draw(section=_drawn_section(drawn))

    async def _grow(self, section: figure_data.Section, period: int | None, stop: np.ndarray) -> None:
        await self.jobs.over("map", MAP_FIRST)
        for cycles in GROWTH[1:]:
            if section.ended or stop[0]:
                return
            await asyncio.sleep(BREATH)
            await self.workers.later(partial(section.grow, cycles))
            drawn = await self.workers.later(partial(section.drawn, period))
            await self._draw(partial(self._draw_section, drawn))

    async def _judge_longer(self, shown: ViewState, stop: np.ndarray) -> None:
        found = await self.workers.later(partial(figure_data.judge_longer, shown))
        await self._draw(partial(self._tell_verdict, shown, found))

    # the basin

    def _first_basin(self, shown: ViewState, stop: np.ndarray) -> tuple[Refinement, Picture]:
        """Return the refinement of the basin map and its first, coarse map."""
        fixed = shown.fixed | {"amplitude": shown.amplitude, "period": shown.period}
        del fixed["angle"], fixed["velocity"]
        reach = np.inf if shown.brace_angle is None else shown.brace_angle
        if figure_data.crowded(shown):
            reach = -1.0  # every initial state is too expensive
        plane = Plane(
            ("angle", shown.angles),
            ("velocity", shown.velocities),
            fixed,
            BASIN_POINTS,
            reach,
            _first(shown),
            with_attractors=shown.restitution < 1.0,  # an undamped motion has no attractor
        )
        basin = Refinement(plane, self.workers, stop)
        return basin, basin.coarse()

    async def refine_basin(self, shown: ViewState, stop: np.ndarray) -> None:
        """Compute and draw the basin map alone, from coarse to fine."""
        basin, picture = await self.workers.soon(partial(self._first_basin, shown, stop))
        await self._draw(partial(self._draw_basin, shown, picture))
        await self._finish_basin(shown, basin, stop)

    async def _finish_basin(self, shown: ViewState, basin: Refinement, stop: np.ndarray) -> None:
        basin.stop = stop
        await asyncio.sleep(BREATH)  # the page repaints before all cores are busy
        await self.jobs.over("map", MAP_FIRST)
        async for picture in basin.finer():
            await self._draw(partial(self._draw_basin, shown, picture))

    def _basin(self, shown: ViewState, picture: Picture) -> dict[str, Any]:
        return _with_answers(
            {"image": plane_axes.image(picture, self.basin_corner, shown.angles, shown.velocities)}, picture
        )

    def _draw_basin(self, shown: ViewState, picture: Picture) -> None:
        self.link.draw(basin=self._basin(shown, picture))
        self._tell_attractors(picture)

    def _tell_attractors(self, picture: Picture) -> None:
        self.link.send("basin", {"legend": texts.attractors(picture.counts())})

    # the diagram

    async def draw_diagram(self, shown: ViewState, stop: np.ndarray) -> None:
        """Draw the orbit diagram along an axis of the map, after the other figures of the selection."""
        await self.jobs.over("response")
        columns, ranges = await self.workers.later(partial(figure_data.diagram, shown, stop))
        drawn = {"ranges": ranges, "label": VARIED[shown.vary], "points": columns}
        await self._draw(partial(self.link.draw, diagram=drawn))


def _with_answers(drawn: dict[str, Any], picture: Picture) -> dict[str, Any]:
    """Add the results of a map for the readout and the table, if all its points are classified."""
    return drawn | {"answers": plane_axes.answers(picture)} if picture.settled == picture.of else drawn


def _drawn_section(drawn: figure_data.Drawn) -> dict[str, Any]:
    columns = {"points": drawn.points, "dense": drawn.dense, "orbit": drawn.orbit, "answers": drawn.all}
    return {"ranges": drawn.ranges, "label": drawn.label, **columns}
