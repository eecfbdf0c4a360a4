"""Additional figures beyond the paper; each module has `draw`, and its docstring is the caption."""

NAMES = ("chaos", "cascade", "crisis", "threshold", "coexistence", "zoom", "bifurcations")

__all__ = ["NAMES"]
