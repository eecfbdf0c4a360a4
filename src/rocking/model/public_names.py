"""Public names of a package, imported at their first use, so that importing the package loads no numerical library.

The table of names is the typing stub of the package, `__init__.pyi`, which type checkers read too. As in all stubs, a name that is
imported `as` itself is exported, and one that is not can be used, but is no part of `__all__`.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from pkgutil import get_data
from typing import Any


def imported(package: str) -> list[tuple[str, ast.alias]]:
    """Return the modules and the names that the stub of a package imports."""
    stub = ast.parse(get_data(package, "__init__.pyi") or b"")
    imports = [node for node in stub.body if isinstance(node, ast.ImportFrom)]
    return [(node.module or "", each) for node in imports for each in node.names]


def lazy(
    package: str, moved: Mapping[str, str] | None = None
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a package; `moved` holds the names that have left it, by their module."""
    imports = imported(package)
    table = {each.asname or each.name: (module, each.name) for module, each in imports}
    names = sorted(each.asname for _, each in imports if each.asname)

    def get(name: str) -> Any:
        if name not in table:
            for module, names_there in (moved or {}).items():
                if name in names_there.split():
                    raise AttributeError(f"{package}.{name} is {module}.{name} since version 0.2")
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
