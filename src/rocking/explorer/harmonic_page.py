"""Page of blocks on a harmonically shaken base: figures of one system, computed at once for each selection, then refined."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from functools import partial
from typing import Any

import attrs
import numpy as np

from rocking.explorer import figures, harmonic_maps, presets, texts
from rocking.explorer import harmonic_motion as motion
from rocking.explorer.fields import Span, written
from rocking.explorer.figures import Axes
from rocking.explorer.harmonic_maps import Attractors, Basins, Responses
from rocking.explorer.harmonic_units import CONVERTED, Contents, axes_of
from rocking.explorer.harmonic_view import DEFAULT, POINTS, HarmonicView, nearby
from rocking.explorer.page import Page
from rocking.explorer.refinement import Picture, Refinement
from rocking.explorer.session import Job, Session
from rocking.model.verdict import Criterion, Kind, Verdict
from rocking.plot import palette

BASIN_POINTS = 257
FIRST_HITS = 3e3
"""Maximum number of impacts per point of a first, coarse map."""
GROWTH = (1_000, 2_000, 7_000, 20_000, 30_000, 40_000)
"""Cycles added to a section, step by step: 10⁵ in total."""
BREATH = 0.2
"""Pause between two steps of a refinement, s, so that the page can repaint."""
MAP_FIRST = 1.0
"""Maximum delay of a basin map and of a longer section in favour of the map of responses, s."""
MAPS = {"map": ("period", "amplitude"), "basin": ("angle", "velocity")}
"""Quantities of the axes of the maps."""
RANGES = {"map": ("periods", "amplitudes"), "basin": ("angles", "velocities")}
"""Fields of their ranges."""
SHAKEN = (
    "restitution",
    "phase",
    "angle",
    "velocity",
    "brace_angle",
    "brace_restitution",
    "critical_angle",
    "offset",
)


class HarmonicSession(Session):
    """Session of the page. Results of an earlier selection are discarded."""

    VIEW = HarmonicView

    # figures and requests

    def figures(self) -> tuple[Any, ...]:
        """Make the figures, of which three can be clicked."""
        self.map = figures.plane_of_systems(harmonic_maps.PALETTE)
        self.basin = figures.plane("basin", "Basins of attraction", harmonic_maps.PALETTE)
        self.others = (
            figures.diagram(),
            figures.history(),
            figures.portrait(),
            figures.section(),
            figures.spectrum(),
        )
        self.select(self.map, partial(self._map_point, "map"))
        self.select(self.basin, partial(self._map_point, "basin"))
        self.select(self.others[0], lambda across, _: self._near(**{self.view.vary: (across, self._slider)}))
        return self.map, self.basin, *self.others

    def _map_point(self, name: str, across: float, up: float) -> dict[str, str]:
        """Return the fields of a click on a map."""
        axes = self._axes(name)
        (dx, dy), (x, y) = axes.base, MAPS[name]
        return self._near(**{x: (dx + across, axes.across), y: (dy + up, axes.up)})

    def _near(self, **places: tuple[float, Span]) -> dict[str, str]:
        """Return the fields of a click, given per field as its coordinate and the range of the axis."""
        return {name: written(nearby(at, span)) for name, (at, span) in places.items()}

    def _axes(self, name: str) -> Axes:
        return self.view.map_axes if name == "map" else self.view.basin_axes

    @property
    def _slider(self) -> Span:
        return self.view.units.shown(self.view.vary, self.view.varied)

    def answer(self, what: str, typed: dict[str, str]) -> tuple[Any, dict[str, str]]:
        """Return the requested view, or None; requests of this page are a case of the gallery, and its pictures."""
        if what == "gallery":
            self.jobs.start("gallery", self._send_pictures)
            return None, {}
        if what == "case" and typed.get("name") in presets.BY_NAME:
            case, shown = presets.BY_NAME[typed["name"]].view, self.view
            return attrs.evolve(case, height=shown.height, width=shown.width), {}
        return super().answer(what, typed)

    async def _send_pictures(self, stop: np.ndarray) -> None:
        pictures = await self.workers.later(motion.pictures)
        await self.change(lambda: self.link.send("gallery", {"pictures": pictures}))

    # axes and marks

    def place(self, changed: Callable[..., bool]) -> None:
        """Set ranges and labels of the figures, mark the selected point and draw the selected theoretical curves."""
        view, units, sizes = self.view, self.view.units, ("height", "width")
        for name, made in (("map", self.map), ("basin", self.basin)):
            if changed(*RANGES[name], *sizes):
                limits = [units.shown(each, Span(*CONVERTED[each][0].range)) for each in MAPS[name]]
                labels = [
                    units.label(each) if name == "map" else units.start_label(each) for each in MAPS[name]
                ]
                self._axes(name).place(made, labels, limits, [view.narrowest(each) for each in RANGES[name]])
        if changed(*sizes):
            for made in self.others:
                made.below[0].axis_label, made.left[0].axis_label = map(
                    units.label, axes_of(made.name, view.vary)
                )
        x, y, angle, velocity = (
            units.shown(each, getattr(view, each)) for each in CONVERTED if each != "brace_angle"
        )
        self.link.draw(
            map={"point": view.map_axes.point(y, x), "curves": harmonic_maps.curves(view, view.map_axes)},
            basin={"point": view.basin_axes.point(angle, velocity)},
            diagram={"here": units.shown(view.vary, getattr(view, view.vary))},
        )

    def description(self) -> dict[str, Any]:
        """Return the units, the ranges of maps and slider, the moving block, and the code and the commands for this view."""
        view, units, slider = self.view, self.view.units, self._slider
        whole = attrs.evolve(
            DEFAULT, height=view.height, width=view.width, offset=view.offset, restitution=view.restitution
        ).shown
        return {
            "si": view.block is not None,
            "full": "" if view.block is None else written(view.block.critical_angle),
            "planes": {name: self._plane(name) for name in MAPS},
            "whole": {name: {each: whole[each] for each in ranges} for name, ranges in RANGES.items()},
            "slider": [slider.low, slider.high, units.shown(view.vary, getattr(view, view.vary))],
            "headings": units.headings(view.vary),
            "scene": motion.scene(view),
            "python": texts.python(view),
            "commands": texts.commands(view),
        }

    def _plane(self, name: str) -> dict[str, Any]:
        """Return offsets and ranges of a map, and whether it is at the zoom limit of double precision."""
        axes, narrowest = self._axes(name), map(self.view.narrowest, RANGES[name])
        deepest = any(
            span.width <= least * 1.01 for span, least in zip((axes.across, axes.up), narrowest, strict=True)
        )
        return {"base": list(axes.base), "ranges": list(axes.ranges), "deepest": deepest}

    def _draw(self, view: HarmonicView, **contents: Contents) -> None:
        """Draw the contents of figures in the units of the view."""
        self.link.draw(
            **{name: view.units.contents(name, each, view.vary) for name, each in contents.items()}
        )

    # the map

    async def refine_map(self, view: HarmonicView, stop: np.ndarray) -> None:
        """Compute and draw the map, from coarse to fine."""
        first = await self.workers.soon(_first, view)

        def draw(picture: Picture) -> None:
            self.link.draw(map=_drawn_map(picture, view, view.map_axes))
            counts = harmonic_maps.counts(picture).sum(axis=0)
            self.link.send("legend", {"legend": texts.legend(counts, done=picture.done)})
            self.link.send("progress", picture.progress())

        across, up = ("period", view.periods), ("amplitude", view.amplitudes)
        measure = Responses(across, up, view.fixed, POINTS, first)
        await self.refine(Refinement(measure, self.workers, stop), draw)

    # one system

    async def respond(self, view: HarmonicView, stop: np.ndarray) -> None:
        """Draw all figures of one system at once, then start their refinement."""
        section, soon = motion.Section(view), self.workers.soon
        async with asyncio.TaskGroup() as group:  # if one of them fails, the others end
            verdict = group.create_task(soon(motion.verdict, view))
            basin = group.create_task(soon(self._first_basin, view, stop))
            traces = group.create_task(soon(motion.traces, view))
            spectrum = group.create_task(soon(motion.spectrum, view))
            points = group.create_task(self._first_points(section, verdict))

        def draw() -> None:
            picture = basin.result()[1]
            drawn = {"spectrum": spectrum.result(), "section": points.result()}
            self._draw(view, **traces.result(), **drawn)
            self.link.draw(basin=_drawn_map(picture, view, view.basin_axes))
            self._send_attractors(picture)
            self._send_verdict(view, verdict.result())

        await self.change(draw)
        self.jobs.start("section", self._grow, section, verdict.result().period)
        self.jobs.start("basin", self._finish_basin, view, basin.result()[0])
        if verdict.result().kind is Kind.UNDETERMINED and not motion.crowded(view):
            self.jobs.start("verdict", self._continue_verdict, view)

    async def _first_points(self, section: motion.Section, verdict: Awaitable[Verdict]) -> Contents:
        """Return the first points of a section; those of a periodic orbit are marked."""
        await self.workers.soon(section.grow, GROWTH[0])
        return await self.workers.soon(section.drawn, (await verdict).period)

    def _send_verdict(self, view: HarmonicView, verdict: Verdict) -> None:
        self.link.send("verdict", texts.verdict(verdict, view.block))

    async def _grow(self, section: motion.Section, period: int | None, stop: np.ndarray) -> None:
        view = section.view
        await self.jobs.over("map", MAP_FIRST)
        for cycles in GROWTH[1:]:
            if section.ended or stop[0]:
                return
            await asyncio.sleep(BREATH)
            await self.workers.later(section.grow, cycles)
            drawn = await self.workers.later(section.drawn, period)
            await self.change(lambda drawn: self._draw(view, section=drawn), drawn)

    async def _continue_verdict(self, view: HarmonicView, stop: np.ndarray) -> None:
        await self.change(self._send_verdict, view, await self.workers.later(motion.longer_verdict, view))

    # the basin

    def _first_basin(self, view: HarmonicView, stop: np.ndarray) -> tuple[Refinement, Picture]:
        """Return the refinement of the basin map and its first, coarse map."""
        fixed = view.fixed | {"amplitude": view.amplitude, "period": view.period}
        del fixed["angle"], fixed["velocity"]
        reach = np.inf if view.brace_angle is None else view.brace_angle
        if motion.crowded(view):
            reach = -1.0  # every initial state is too expensive
        kind = Attractors if view.restitution < 1.0 else Basins  # an undamped motion has no attractor
        measure = kind(view.angles, view.velocities, fixed, BASIN_POINTS, _first(view), reach)
        basin = Refinement(measure, self.workers, stop)
        return basin, basin.coarse()

    async def refine_basin(self, view: HarmonicView, stop: np.ndarray) -> None:
        """Compute and draw the basin map alone, from coarse to fine."""
        basin, picture = await self.workers.soon(self._first_basin, view, stop)
        await self.change(self._draw_basin, view, picture)
        await self._finish_basin(view, basin, stop)

    async def _finish_basin(self, view: HarmonicView, basin: Refinement, stop: np.ndarray) -> None:
        basin.stop = stop
        await asyncio.sleep(BREATH)  # the page repaints before all cores are busy
        await self.jobs.over("map", MAP_FIRST)
        async for picture in basin.finer():
            await self.change(self._draw_basin, view, picture)

    def _draw_basin(self, view: HarmonicView, picture: Picture) -> None:
        self.link.draw(basin=_drawn_map(picture, view, view.basin_axes))
        self._send_attractors(picture)

    def _send_attractors(self, picture: Picture) -> None:
        entries = texts.attractors(harmonic_maps.counts(picture), done=picture.done)
        self.link.send("basin", {"legend": entries})

    # the diagram

    async def draw_diagram(self, view: HarmonicView, stop: np.ndarray) -> None:
        """Draw the orbit diagram along an axis of the map, after the other figures of the selection."""
        await self.jobs.over("response")
        drawn = await self.workers.later(motion.diagram, view, stop)
        await self.change(lambda: self._draw(view, diagram=drawn))

    JOBS = (
        Job("map", refine_map, ("periods", "amplitudes", *SHAKEN, "height", "width"), ("map",)),
        Job(
            "response",
            respond,
            ("amplitude", "period", *SHAKEN, "first", "cycles", "height", "width"),
            ("section", "basin", "verdict"),
            ends=("section", "basin", "verdict"),
        ),
        Job("basin", refine_basin, ("angles", "velocities"), ("basin",), within="response"),
        Job("diagram", draw_diagram, ("vary", "varied", "other", *SHAKEN, "height", "width")),
    )


def _first(view: HarmonicView) -> int:
    """Return the cycles per point of a first map; the estimate assumes that all points cost as much as the selected one."""
    return motion.affordable(view, harmonic_maps.FIRST, FIRST_HITS)


def _drawn_map(picture: Picture, view: HarmonicView, axes: Axes) -> dict[str, Any]:
    """Return the image of a map, and its results for readout and table if they can be read at each point."""
    drawn: dict[str, Any] = {"image": axes.image(harmonic_maps.colours(picture))}
    rate = view.units.factor("exponent")
    return drawn | ({"answers": harmonic_maps.answers(picture, rate)} if picture.whole else {})


PAGE = Page(
    "harmonic",
    "rocking explorer",
    HarmonicSession,
    constants={
        "looks": [look.name for look in palette.LOOKS],
        "grounds": [each.brief for each in Criterion],
        "levels": [each.level for each in Criterion],
    },
    variables={
        "fields": HarmonicView.groups(),
        "curves": harmonic_maps.NAMES,
        "groups": presets.GROUPS,
    },
)
