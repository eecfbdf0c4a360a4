"""Results of a survey: in memory, in a Zarr store, or exported."""
