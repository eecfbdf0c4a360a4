"""Output to files and to the console."""
