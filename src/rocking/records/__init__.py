"""Ground motions from record files, one that comes with the package, and synthetic ones."""
