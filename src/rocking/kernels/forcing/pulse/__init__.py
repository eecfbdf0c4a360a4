"""Base acceleration that is a piece of a cosine: a pulse."""
