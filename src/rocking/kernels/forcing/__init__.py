"""Motion of the base: its forcing term, the response to it and the sign changes."""
