"""Progress bar on stderr while a command waits for machine code."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress

# Shorter waits show no bar.
PATIENCE = 1.0


class CompileBar:
    """Listener of the kernels: a bar for each wait that takes longer than a second."""

    def __init__(self) -> None:
        self._since: dict[str, float] = {}
        self._bar: Progress | None = None

    def __call__(self, name: str, fraction: float) -> None:
        """Show the fraction that is done; 1 removes the bar."""
        since = self._since.setdefault(name, time.monotonic())
        if fraction >= 1.0:
            self.close()
        elif self._bar is not None:
            self._bar.update(self._bar.task_ids[0], completed=fraction)
        elif time.monotonic() - since >= PATIENCE:
            from rich.console import Console
            from rich.progress import Progress

            self._bar = Progress(console=Console(stderr=True), transient=True)
            self._bar.add_task("compiling", total=1.0)
            self._bar.start()

    def close(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.stop()
            self._bar = None
