"""Where the results of a survey are kept: in memory, in a Zarr store, or exported."""
