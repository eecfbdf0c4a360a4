"""Additional figures beyond the paper; each module has `draw`, and its docstring is the caption."""

NAMES = ("chaos", "cascade", "crisis", "threshold", "coexistence", "zoom")

__all__ = ["NAMES"]
