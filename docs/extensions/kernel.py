"""Run of the blocks of a page as the cells of a notebook, in a kernel of Jupyter, with what each cell shows.

The kernel has the protocol of any notebook. A client of Jupyter is part of the package of the kernel, and no file of a notebook is made.
"""

import base64
import os
from contextlib import contextmanager
from tempfile import TemporaryDirectory

from docutils import nodes
from sphinx.errors import ExtensionError

LIMIT = 120  # longest time of a cell, s


def run(folder, cells, text, picture):
    """Return the nodes of the outputs of each cell; `text` and `picture` make the node of a text and of a picture."""
    with started(folder) as client:
        return [
            [
                node(bundle, folder / f"cell-{number}-{place}.png", text, picture)
                for place, bundle in enumerate(outputs(client, code), 1)
            ]
            for number, code in enumerate(cells, 1)
        ]


@contextmanager
def started(folder):
    """Start a kernel in a folder, and yield a client of it."""
    from jupyter_client.manager import KernelManager

    with TemporaryDirectory() as sockets:
        manager = KernelManager(kernel_name="python3", transport="ipc", ip=f"{sockets}/kernel")
        environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}
        manager.start_kernel(cwd=str(folder), env=environment)
        client = manager.client()
        try:
            client.start_channels()
            client.wait_for_ready(timeout=LIMIT)
            yield client
        finally:
            client.stop_channels()
            manager.shutdown_kernel(now=True)


def outputs(client, code):
    """Return what a cell shows, each as a map from the type of the data to the data; an output may be replaced by a later one."""
    shown, replaceable = [], {}

    def receive(message):
        kind, content = message["msg_type"], message["content"]
        if kind == "stream":
            shown.append({"text/plain": content["text"]})
        elif kind in ("display_data", "execute_result"):
            shown.append(dict(content["data"]))
            if name := content.get("transient", {}).get("display_id"):
                replaceable[name] = shown[-1]
        elif kind == "update_display_data":
            replaceable[content["transient"]["display_id"]].update(content["data"])

    reply = client.execute_interactive(code, allow_stdin=False, timeout=LIMIT, output_hook=receive)["content"]
    if reply["status"] != "ok":
        raise ExtensionError(f"a cell fails:\n{code}\n{reply.get('ename')}: {reply.get('evalue')}")
    return shown


def node(bundle, path, text, picture):
    """Return the node of an output, in the richest form that the data have."""
    if "text/html" in bundle:
        return nodes.raw("", f'<div class="shown">{bundle["text/html"]}</div>', format="html")
    if "image/png" in bundle:
        path.write_bytes(base64.b64decode(bundle["image/png"]))
        return picture(path)
    return text(bundle["text/plain"])
