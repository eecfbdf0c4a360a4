"""Block without the small-angle approximation: steps by Taylor series, with the same forcings as the slender block."""
