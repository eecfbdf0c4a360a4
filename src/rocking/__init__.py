"""Exact simulation and nonlinear dynamics of free-standing blocks on a shaking base.

A public name is imported on first use, so that `import rocking` loads no numerical library. The names stand in `__init__.pyi`.
"""

from rocking.model.public_names import lazy

__getattr__, __dir__, __all__ = lazy(__name__)
