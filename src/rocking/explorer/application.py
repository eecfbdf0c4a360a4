"""Explorer application: the page and its server."""

from __future__ import annotations

import gc
import json
from importlib.resources import files

from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from bokeh.document import Document

from rocking.explorer import plane_axes, presets
from rocking.explorer.field_readers import WORDS
from rocking.explorer.ground_motion.page import page as ground_page
from rocking.explorer.ground_motion.session import GroundSession
from rocking.explorer.server import LocalServer, local_server
from rocking.explorer.session import Session
from rocking.explorer.worker_pools import Workers
from rocking.model.forcing import Harmonic
from rocking.model.package import VERSION
from rocking.model.system import System
from rocking.model.verdict import Criterion
from rocking.motion.simulate import simulate
from rocking.plot import palette, style

GROUND_ADDRESS = "/ground-motion"
FIELDS = (
    ("amplitude", "A", "Amplitude A of the base acceleration, in units of g θcr"),
    ("period", "T", "Forcing period T, in units of 1/α"),
    ("restitution", "e", "Coefficient of restitution e of base impacts, 0 to 1"),
    ("phase", "φ", "Forcing phase φ at the start of the motion, rad"),
    ("angle", "Θ₀", "Initial angle Θ₀, in units of θcr"),
    ("velocity", "Θ′₀", "Initial angular velocity Θ′₀, in units of α θcr"),
    ("brace_angle", "Θb", "Brace angle Θb, in units of θcr; empty for no braces"),
    ("brace_restitution", "r", "Coefficient of restitution r of brace impacts, 0 to 1"),
    (
        "critical_angle",
        "θcr",
        "Critical angle θcr in rad, for the full equation of motion; empty for a slender block and small angles",
    ),
    ("first", "", "First forcing cycle shown in the time history and the phase portrait"),
    ("cycles", "", "Number of forcing cycles shown in the time history and the phase portrait"),
)


def serve(port: int = 0) -> LocalServer:
    """Create the local server of the explorer; `run_until_shutdown` starts it, and `link` is the address that opens it.

    Parameters
    ----------
    port : int
        Port, in [0, 65535]. Default: 0, which selects a free port.

    Returns
    -------
    LocalServer
        Server, not yet started.

    Raises
    ------
    OSError
        If the port cannot be opened.
    ImportError
        If the compiled kernels cannot be used.
    """
    simulate(System(Harmonic(0.0, period=1.0), 0.0), cycles=1)  # opens the kernels before a page is shown
    workers = Workers()

    def open_visit(document: Document) -> None:
        document.title = "rocking explorer"
        document.template = _text("page.html")  # type: ignore[assignment]  # the type hint lacks the text that the setter accepts
        document.template_variables.update(_page())
        Session(document, workers)

    def open_ground(document: Document) -> None:
        document.title = "rocking explorer: ground motion"
        document.template = ground["template"]  # type: ignore[assignment]  # as above
        document.template_variables.update(ground)
        GroundSession(document, workers)

    ground = _ground_page()
    addresses = {"/": open_visit, GROUND_ADDRESS: open_ground}
    pages = {address: Application(FunctionHandler(visit)) for address, visit in addresses.items()}
    server = local_server(pages, port)
    gc.freeze()  # each closed session triggers a full collection; permanent objects need not be searched
    return server


def _ground_page() -> dict[str, object]:
    """Return the template of the page of ground motions and its variables, with the parts of all pages."""
    own = ground_page()
    return own | {
        "style": f"{_style()}{own['style']}",
        "script": f"{_text('shared.js')}{own['script']}",
    }


def _style() -> str:
    """Return the style of all pages, with those colours that figures have, too."""
    colours = {
        "motion-light": palette.MOTION,
        "motion-dark": palette.DARK_MOTION,
        "block": palette.BLOCK,
        "edge": palette.INK,
    }
    rules = " ".join(f"--{name}: {colour};" for name, colour in colours.items())
    return f":root {{ {rules} }}\n{_text('page.css')}"


def _text(name: str) -> str:
    return files("rocking.explorer").joinpath(name).read_text(encoding="utf-8")


def _page() -> dict[str, object]:
    """Return the variables of the page template, equal for all sessions."""
    given = {
        "looks": [look.name for look in style.LOOKS],
        "colours": [look.colour for look in style.LOOKS],
        "grounds": [each.brief for each in Criterion],
        "levels": [each.level for each in Criterion],
    }
    groups: dict[str, list[presets.Case]] = {}
    for case in presets.CASES:
        groups.setdefault(case.group, []).append(case)
    return {
        "style": _style(),
        "script": _text("shared.js") + _text("page.js"),
        "given": json.dumps(given, ensure_ascii=False).replace("<", "\\u003c"),
        "fields": FIELDS,
        "words": WORDS,
        "curves": plane_axes.NAMES,
        "groups": groups,
        "version": VERSION,
    }
