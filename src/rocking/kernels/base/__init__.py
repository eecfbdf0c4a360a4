"""Motions of the base: a cosine, a pulse, and samples."""
