"""`rocking explore`."""

from __future__ import annotations

import signal
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated

import typer

from rocking.cli.option_names import YourInput

if TYPE_CHECKING:
    from tornado.ioloop import IOLoop

PORT = 5006
MAX_PORT = 65_535


def port_number(text: str | int) -> int:
    """A port as it is typed."""
    with suppress(ValueError):
        if 0 <= int(text) <= MAX_PORT:
            return int(text)
    raise YourInput(f"--port must be a whole number in [0, {MAX_PORT}]; got {text}")


def explore(
    port: Annotated[
        int,
        typer.Option(
            "--port",
            parser=port_number,
            metavar="NUMBER",
            help="Where on this machine the page is; 0: any port that is free.",
        ),
    ] = PORT,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only say where the page is.")] = False,
) -> None:
    """Open a page that shows a system from all sides.

    It is computed as you look.
    """
    from importlib.util import find_spec

    if find_spec("bokeh") is None:
        raise YourInput(
            "the page needs the extra explorer: pip install '.[explorer]' in a copy of the repository"
        )
    from rocking.explorer import serve

    try:
        server = serve(port)
    except OSError as error:
        raise YourInput(
            f"--port {port} cannot be listened at: {error.strerror or error} (give another, or 0, which takes any that is free)"
        ) from error
    _end_on_control_c(server.io_loop)
    address = f"http://localhost:{server.port}/"
    print(f"{address}  (for this machine alone; Ctrl-C ends it)", flush=True)
    server.start()
    if not no_browser:
        server.io_loop.add_callback(server.show, "/")
    try:
        server.io_loop.start()
    finally:
        server.stop()


def _end_on_control_c(loop: IOLoop) -> None:
    """Ctrl-C is how a page ends that is served, and no failure; a second one ends it where it is."""
    at_once = signal.getsignal(signal.SIGINT)

    def end(*_: object) -> None:
        signal.signal(signal.SIGINT, at_once)
        loop.asyncio_loop.call_soon_threadsafe(loop.stop)  # type: ignore[attr-defined]

    signal.signal(signal.SIGINT, end)
