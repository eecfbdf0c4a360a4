"""Assessment of a block under a set of records, for a client: results, one page, and tables."""
