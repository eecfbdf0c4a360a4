"""Beyond the paper: what it could not see, one picture a file, each with `draw` and a docstring that is its caption."""

NAMES = ("chaos", "cascade", "crisis", "threshold", "coexistence", "zoom")

__all__ = ["NAMES"]
