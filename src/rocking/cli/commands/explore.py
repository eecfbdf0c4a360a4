"""`rocking explore`."""

from __future__ import annotations

import signal
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import typer

from rocking.cli.option_names import YourInput

if TYPE_CHECKING:
    from tornado.ioloop import IOLoop

PORT = 5006
MAX_PORT = 65_535


def port_number(text: str | int) -> int:
    """Return the port number in a text."""
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
            help="Port of the local server; 0 selects a free port.",
        ),
    ] = PORT,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Print the address without opening a browser.")
    ] = False,
) -> None:
    """Open the interactive explorer in the browser.

    Shows a map of responses. For each point of the map: time history, Poincaré section, spectrum, basins and verdict.
    Other users of the computer cannot open the page: its address contains a token. The server runs until Ctrl-C.
    """
    from rocking.explorer import serve

    try:
        server = serve(port)
    except OSError as error:
        raise YourInput(
            f"cannot listen on --port {port}: {error.strerror or error} (give another port, or --port 0 for a free one)"
        ) from error
    _end_on_control_c(server.io_loop)
    print(f"{server.link}  (opens on this computer only; press Ctrl-C to stop)", flush=True)
    server.start()
    with TemporaryDirectory(prefix="rocking-") as folder:  # only this user can read it
        if not no_browser:
            server.io_loop.add_callback(_open, Path(folder, "open.html"), server.link)
        try:
            server.io_loop.start()
        finally:
            server.stop()


def _open(page: Path, address: str) -> None:
    """Open a page that leads to an address. All users of the computer see the arguments of the browser."""
    import webbrowser

    page.write_text(f'<meta http-equiv="refresh" content="0; url={address}">\n', encoding="utf-8")
    webbrowser.open(page.as_uri(), new=2)


def _end_on_control_c(loop: IOLoop) -> None:
    """Stop the server on Ctrl-C with exit code 0; a second Ctrl-C interrupts at once."""
    at_once = signal.getsignal(signal.SIGINT)

    def end(*_: object) -> None:
        signal.signal(signal.SIGINT, at_once)
        loop.asyncio_loop.call_soon_threadsafe(loop.stop)  # type: ignore[attr-defined]

    signal.signal(signal.SIGINT, end)
