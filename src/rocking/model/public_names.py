"""Public names of a package, imported at their first use, so that importing the package loads no numerical library.

The table of names is the typing stub of the package, `__init__.pyi`, which type checkers read too.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from importlib import import_module
from pkgutil import get_data
from typing import Any


def places(package: str) -> dict[str, tuple[str, str]]:
    """Return the module of each public name of a package, and its name there."""
    table = ast.parse(get_data(package, "__init__.pyi") or b"")
    imports = [node for node in table.body if isinstance(node, ast.ImportFrom)]
    return {
        each.asname or each.name: (node.module or "", each.name) for node in imports for each in node.names
    }


def lazy(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a package."""
    table = places(package)
    names = sorted(table)

    def get(name: str) -> Any:
        if name not in table:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        namespace = vars(sys.modules[package])
        module, there = table[name]
        if module == package:
            namespace[name] = import_module(f"{module}.{there}")
        else:
            namespace[name] = getattr(import_module(module), there)
            import_module("rocking.model.validation").explain(namespace, [name])
        return namespace[name]

    return get, lambda: names, names
