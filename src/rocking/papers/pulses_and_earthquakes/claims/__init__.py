"""All rows of the report, each with the computation that tests it."""
