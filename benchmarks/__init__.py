"""Benchmarks: cost of the engine, next to peers measured in the same run (`python -m benchmarks`)."""
