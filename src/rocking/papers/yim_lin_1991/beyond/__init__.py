"""Additional figures beyond the paper; each module has `draw`, and its docstring is the caption."""
