"""`rocking explore`."""

from __future__ import annotations

from typing import Annotated

import typer

from rocking.cli.options import YourInput, number_option

PORT = 5006
MOST_PORT = 65_535


def explore(
    port: Annotated[
        int, number_option("--port", "Where on this machine the page is; 0: any port that is free.")
    ] = PORT,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only say where the page is.")] = False,
) -> None:
    """Open a page that shows a system from all sides.

    It is computed as you look.
    """
    from importlib.util import find_spec

    if find_spec("bokeh") is None:
        raise YourInput("the page needs the extra explorer: pip install 'rocking[explorer]'")
    if isinstance(port, float) or not 0 <= port <= MOST_PORT:
        raise YourInput(f"--port must be a whole number in [0, {MOST_PORT}]; got {port}")
    from rocking.explorer import serve

    try:
        server = serve(port)
    except OSError as error:
        raise YourInput(
            f"--port {port} cannot be listened at: {error.strerror or error} (give another, or 0)"
        ) from error
    address = f"http://localhost:{server.port}/"
    print(f"{address}  (for this machine alone; Ctrl-C ends it)", flush=True)
    server.start()
    if not no_browser:
        server.io_loop.add_callback(server.show, "/")
    try:
        server.io_loop.start()
    finally:
        server.stop()
