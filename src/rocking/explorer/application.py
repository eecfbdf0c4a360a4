"""The page's server: on this machine alone, a document a visitor."""

from __future__ import annotations

import gc
import json
from importlib.resources import files

import numpy as np
from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from bokeh.document import Document
from bokeh.server.server import BaseServer

from rocking.explorer import figure_data, plane_axes, presets
from rocking.explorer.form_fields import WORDS
from rocking.explorer.progressive_map import COARSEST, Plane, Refinement
from rocking.explorer.server import local_server
from rocking.explorer.session import Session
from rocking.explorer.view_state import DEFAULT
from rocking.explorer.worker_pools import Workers
from rocking.model import VERSION, Criterion
from rocking.plot.parts import legend

FIELDS = (
    ("amplitude", "A", "amplitude of the base, in g θcr"),
    ("period", "T", "period of the base, in 1/α"),
    ("restitution", "e", "restitution at an impact"),
    ("phase", "φ", "phase of the base, rad"),
    ("angle", "Θ₀", "angle at the start, in θcr"),
    ("velocity", "Θ′₀", "velocity at the start, in α θcr"),
    ("brace_angle", "Θb", "angle of the braces; empty: none"),
    ("brace_restitution", "r", "restitution at a brace"),
    ("first", "", "first cycle drawn"),
    ("cycles", "", "cycles drawn"),
)


def serve(port: int = 0) -> BaseServer:
    """A server that is ready to be started (`run_until_shutdown`), for this machine alone; port 0: any that is free.

    Raises OSError where the port cannot be listened at.
    """
    workers = Workers()

    def open_visit(document: Document) -> None:
        document.title = "rocking explorer"
        document.template = _text("page.html")  # type: ignore[assignment]  # its hint forgets the text that its setter takes
        document.template_variables.update(_page())
        Session(document, workers)

    server = local_server(Application(FunctionHandler(open_visit)), port)
    warm_up()
    gc.freeze()  # whenever a visit is dropped all garbage is looked for: not among what stays for ever
    return server


def warm_up() -> None:
    """Compile, or load, what every visit needs, before any thread does: a process that ends while one compiles may crash."""
    figure_data.response(DEFAULT)
    figure_data.spectrum(DEFAULT)
    figure_data.diagram(DEFAULT, np.zeros(1, np.int64))
    figure_data.Section(DEFAULT).grow(2)
    for restitution in (DEFAULT.restitution, 1.0):  # without loss blocks march in lanes
        plane = Plane(
            ("period", DEFAULT.periods),
            ("amplitude", DEFAULT.amplitudes),
            DEFAULT.fixed | {"restitution": restitution},
            COARSEST + 1,
            apart=True,
        )
        Refinement(plane, Workers(), np.zeros(1, np.int64)).coarse()


def _text(name: str) -> str:
    return files("rocking.explorer").joinpath(name).read_text(encoding="utf-8")


def _page() -> dict[str, object]:
    """What the page is filled with: the same for everybody."""
    given = {
        "looks": [look.name for look in legend.LOOKS],
        "colours": [look.colour for look in legend.LOOKS],
        "grounds": [each.brief for each in Criterion],
        "levels": [each.level for each in Criterion],
    }
    groups: dict[str, list[presets.Case]] = {}
    for case in presets.CASES:
        groups.setdefault(case.group, []).append(case)
    return {
        "style": _text("page.css"),
        "script": _text("page.js"),
        "given": json.dumps(given, ensure_ascii=False).replace("<", "\\u003c"),
        "fields": FIELDS,
        "words": WORDS,
        "curves": plane_axes.NAMES,
        "groups": groups,
        "version": VERSION,
    }
