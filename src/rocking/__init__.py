"""Exact simulation and nonlinear dynamics of free-standing blocks on a shaking base.

A public name is imported on first use, so that `import rocking` loads no numerical library. The names stand in `__init__.pyi`.
"""

from __future__ import annotations

import ast
from importlib import import_module
from pkgutil import get_data
from typing import Any


def _places() -> dict[str, tuple[str, str]]:
    """Return the module of each public name, and its name there, from the table that type checkers read too."""
    table = ast.parse(get_data(__name__, "__init__.pyi") or b"")
    imports = [node for node in table.body if isinstance(node, ast.ImportFrom)]
    return {
        each.asname or each.name: (node.module or "", each.name) for node in imports for each in node.names
    }


_PLACES = _places()
__all__ = sorted(_PLACES)  # noqa: PLE0605


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import_module("rocking.model.result").fill_at_first_use(lambda: import_module("rocking.plot"))
    module, there = _PLACES[name]
    if module == __name__:
        globals()[name] = import_module(f"{module}.{there}")
    else:
        globals()[name] = getattr(import_module(module), there)
        import_module("rocking.model.validation").explain(globals(), [name])
    return globals()[name]


def __dir__() -> list[str]:
    return __all__
