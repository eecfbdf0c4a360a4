"""Base acceleration that is linear between equidistant samples, and 0 before the first and after the last."""
