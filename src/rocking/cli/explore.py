"""`rocking explore`: the local server of the explorer."""

from __future__ import annotations

import signal
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from rocking.cli.options import InvalidInput
from rocking.model.package import require_extra

if TYPE_CHECKING:
    from tornado.ioloop import IOLoop


def explore(port: int, no_browser: bool) -> None:
    """Serve the explorer until Ctrl-C, and open its page in the browser."""
    require_extra("explorer")
    from rocking.explorer.server import serve

    try:
        server = serve(port)
    except OSError as error:
        raise InvalidInput(
            f"cannot listen on --port {port}: {error.strerror or error} (give another port, or --port 0 for a free one)"
        ) from error
    end_on_control_c(server.io_loop)
    print(f"{server.link}  (opens on this computer only; press Ctrl-C to stop)", flush=True)
    server.start()
    with TemporaryDirectory(prefix="rocking-") as folder:  # only this user can read it
        if not no_browser:
            server.io_loop.add_callback(open_page, Path(folder, "open.html"), server.link)
        try:
            server.io_loop.start()
        finally:
            server.stop()


def open_page(page: Path, address: str) -> None:
    """Open a page that leads to an address. All users of the computer see the arguments of the browser."""
    import webbrowser

    page.write_text(f'<meta http-equiv="refresh" content="0; url={address}">\n', encoding="utf-8")
    webbrowser.open(page.as_uri(), new=2)


def end_on_control_c(loop: IOLoop) -> None:
    """Stop the server on Ctrl-C with exit code 0; a second Ctrl-C interrupts at once."""
    at_once = signal.getsignal(signal.SIGINT)

    def end(*_: object) -> None:
        signal.signal(signal.SIGINT, at_once)
        loop.asyncio_loop.call_soon_threadsafe(loop.stop)  # type: ignore[attr-defined]

    signal.signal(signal.SIGINT, end)
