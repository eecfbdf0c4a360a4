"""Page of blocks on a harmonically shaken base: figures of one system, computed at once for each selection, then refined."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np

from rocking.explorer import figures, harmonic_maps, presets, texts
from rocking.explorer import harmonic_motion as motion
from rocking.explorer.fields import Span, written
from rocking.explorer.figures import Axes
from rocking.explorer.harmonic_maps import Attractors, Basins, Responses
from rocking.explorer.harmonic_view import POINTS, HarmonicView, closest, in_metres, nearby
from rocking.explorer.page import Page
from rocking.explorer.refinement import Picture, Refinement
from rocking.explorer.session import Job, Session
from rocking.model.quantity import AMPLITUDE, ANGLE, PERIOD, VELOCITY
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
MAP_LIMITS = Span(*PERIOD.range), Span(*AMPLITUDE.range)
BASIN_LIMITS = Span(*ANGLE.range), Span(*VELOCITY.range)
MAP_LABELS = "period T", "amplitude A"
BASIN_LABELS = "initial angle Θ₀", "initial velocity Θ′₀"
SHAKEN = ("restitution", "phase", "angle", "velocity", "brace_angle", "brace_restitution", "critical_angle")


class HarmonicSession(Session):
    """Session of the page. Results of an earlier selection are discarded."""

    VIEW = HarmonicView

    # figures and requests

    def figures(self) -> tuple[Any, ...]:
        """Make the figures, of which three can be clicked."""
        self.map = figures.plane_of_systems(harmonic_maps.PALETTE)
        self.basin = figures.plane("basin", "Basins of attraction", *BASIN_LABELS, harmonic_maps.PALETTE)
        diagram = figures.diagram()
        self.select(self.map, self._system_at)
        self.select(self.basin, self._start_at)
        self.select(diagram, lambda across, _: self._near(**{self.view.vary: (across, self.view.varied)}))
        others = figures.history(), figures.portrait(), figures.section(), figures.spectrum()
        return self.map, self.basin, diagram, *others

    def _system_at(self, across: float, up: float) -> dict[str, str]:
        dx, dy = self.view.map_axes.base
        return self._near(period=(dx + across, self.view.periods), amplitude=(dy + up, self.view.amplitudes))

    def _start_at(self, across: float, up: float) -> dict[str, str]:
        dx, dy = self.view.basin_axes.base
        return self._near(angle=(dx + across, self.view.angles), velocity=(dy + up, self.view.velocities))

    def _near(self, **places: tuple[float, Span]) -> dict[str, str]:
        """Return the fields of a click, given per field as its coordinate and the range of the axis."""
        return {name: written(nearby(at, span)) for name, (at, span) in places.items()}

    def answer(self, what: str, typed: dict[str, str]) -> tuple[Any, dict[str, str]]:
        """Return the requested view; requests of this page are a block in SI units and a case of the gallery."""
        if what == "metres":
            return in_metres(self.view, typed), {}
        if what == "case" and typed.get("name") in presets.BY_NAME:
            return presets.BY_NAME[typed["name"]].view, {}
        return super().answer(what, typed)

    # axes and marks

    def place(self, changed: Callable[..., bool]) -> None:
        """Set ranges and labels of the maps, mark the selected point and draw the selected theoretical curves."""
        view, axes, basin = self.view, self.view.map_axes, self.view.basin_axes
        if changed("periods", "amplitudes", "height", "width", "restitution"):
            axes.place(self.map, MAP_LABELS, MAP_LIMITS, closest)
            self._place_metres()
        if changed("angles", "velocities"):
            basin.place(self.basin, BASIN_LABELS, BASIN_LIMITS, closest)
        point, curves = axes.point(view.period, view.amplitude), harmonic_maps.curves(view, axes)
        self.link.draw(
            map={"point": point, "curves": curves},
            basin={"point": basin.point(view.angle, view.velocity)},
            diagram={"here": getattr(view, view.vary)},
        )

    def _place_metres(self) -> None:
        """Set the SI axes of the map above and at the right; they are visible only with a block."""
        block, (above,), (right,) = self.view.block, self.map.above, self.map.right
        above.visible = right.visible = block is not None
        if block is None:
            return
        ranges, base = self.view.map_axes.ranges, self.view.map_axes.base
        for axis, across, ends, offset, factor, name in (
            (above, self.map.extra_x_ranges, ranges[:2], base[0], block.seconds(1.0), "period (s)"),
            (
                right,
                self.map.extra_y_ranges,
                ranges[2:],
                base[1],
                block.acceleration(1.0),
                "acceleration (m/s²)",
            ),
        ):
            across["si"].update(start=ends[0] * factor, end=ends[1] * factor)
            axis.axis_label = f"{name} − {offset * factor:.9g}" if offset else name

    def description(self) -> dict[str, Any]:
        """Return the ranges of maps and slider, and the code and the commands for this view."""
        view = self.view
        return {
            "planes": {"map": _plane(view.map_axes), "basin": _plane(view.basin_axes)},
            "slider": [view.varied.low, view.varied.high, getattr(view, view.vary)],
            "python": texts.python(view),
            "commands": texts.commands(view),
        }

    # the map

    async def refine_map(self, view: HarmonicView, stop: np.ndarray) -> None:
        """Compute and draw the map, from coarse to fine."""
        first = await self.workers.soon(_first, view)

        def draw(picture: Picture) -> None:
            self.link.draw(map=_drawn_map(picture, view.map_axes))
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
            self.link.draw(**traces.result(), **drawn, basin=_drawn_map(picture, view.basin_axes))
            self._send_attractors(picture)
            self._send_verdict(view, verdict.result())

        await self.change(draw)
        self.jobs.start("section", self._grow, section, verdict.result().period)
        self.jobs.start("basin", self._finish_basin, view, basin.result()[0])
        if verdict.result().kind is Kind.UNDETERMINED and not motion.crowded(view):
            self.jobs.start("verdict", self._continue_verdict, view)

    async def _first_points(self, section: motion.Section, verdict: Awaitable[Verdict]) -> motion.Contents:
        """Return the first points of a section; those of a periodic orbit are marked."""
        await self.workers.soon(section.grow, GROWTH[0])
        return await self.workers.soon(section.drawn, (await verdict).period)

    def _send_verdict(self, view: HarmonicView, verdict: Verdict) -> None:
        self.link.send("verdict", texts.verdict(verdict, view.block))

    async def _grow(self, section: motion.Section, period: int | None, stop: np.ndarray) -> None:
        await self.jobs.over("map", MAP_FIRST)
        for cycles in GROWTH[1:]:
            if section.ended or stop[0]:
                return
            await asyncio.sleep(BREATH)
            await self.workers.later(section.grow, cycles)
            drawn = await self.workers.later(section.drawn, period)
            await self.change(self._draw_section, drawn)

    def _draw_section(self, drawn: motion.Contents) -> None:
        self.link.draw(section=drawn)

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
        self.link.draw(basin=_drawn_map(picture, view.basin_axes))
        self._send_attractors(picture)

    def _send_attractors(self, picture: Picture) -> None:
        entries = texts.attractors(harmonic_maps.counts(picture), done=picture.done)
        self.link.send("basin", {"legend": entries})

    # the diagram

    async def draw_diagram(self, view: HarmonicView, stop: np.ndarray) -> None:
        """Draw the orbit diagram along an axis of the map, after the other figures of the selection."""
        await self.jobs.over("response")
        drawn = await self.workers.later(motion.diagram, view, stop)
        await self.change(self._draw_diagram, drawn)

    def _draw_diagram(self, drawn: motion.Contents) -> None:
        self.link.draw(diagram=drawn)

    JOBS = (
        Job("map", refine_map, ("periods", "amplitudes", *SHAKEN), ("map",)),
        Job(
            "response",
            respond,
            ("amplitude", "period", *SHAKEN, "first", "cycles", "height", "width"),
            ("section", "basin", "verdict"),
            ends=("section", "basin", "verdict"),
        ),
        Job("basin", refine_basin, ("angles", "velocities"), ("basin",), within="response"),
        Job("diagram", draw_diagram, ("vary", "varied", "other", *SHAKEN)),
    )


def _first(view: HarmonicView) -> int:
    """Return the cycles per point of a first map; the estimate assumes that all points cost as much as the selected one."""
    return motion.affordable(view, harmonic_maps.FIRST, FIRST_HITS)


def _plane(axes: Axes) -> dict[str, Any]:
    """Return offsets and ranges of a map, and whether it is at the zoom limit of double precision."""
    deepest = any(span.width <= closest(span) * 1.01 for span in (axes.across, axes.up))
    return {"base": list(axes.base), "ranges": list(axes.ranges), "deepest": deepest}


def _drawn_map(picture: Picture, axes: Axes) -> dict[str, Any]:
    """Return the image of a map, and its results for readout and table if they can be read at each point."""
    drawn: dict[str, Any] = {"image": axes.image(harmonic_maps.colours(picture))}
    return drawn | ({"answers": harmonic_maps.answers(picture)} if picture.whole else {})


PAGE = Page(
    "harmonic",
    "rocking explorer",
    HarmonicSession,
    constants={
        "looks": [look.name for look in palette.LOOKS],
        "colours": [look.colour for look in palette.LOOKS],
        "grounds": [each.brief for each in Criterion],
        "levels": [each.level for each in Criterion],
    },
    variables={
        "fields": HarmonicView.groups(),
        "labels": HarmonicView.labels(),
        "curves": harmonic_maps.NAMES,
        "groups": presets.GROUPS,
    },
)
